//! Lines that cannot be converted, with reasons.

use std::collections::{BTreeMap, BTreeSet};

use farsa_lab::advanced::{LeftOut, nearest_name};

use crate::ini::{Entry, Group, Ini};

/// Most remarks of each sort. Further ones are counted, because each repeats the name of its group.
const MAX_REMARKS: usize = 400;

/// Remarks on the lines of a configuration.
#[derive(Debug, Default)]
pub(super) struct Remarks {
    /// Lines with another meaning in the experiment file.
    pub(super) left: Vec<LeftOut>,
    /// Lines without effect.
    pub(super) idle: Vec<LeftOut>,
    /// Numbers of further remarks of both sorts.
    pub(super) more: [usize; 2],
    /// Lines that have been converted or have a remark.
    taken: BTreeSet<usize>,
    /// Keys that have been read from each group, by the first line of the group.
    asked: BTreeMap<usize, Vec<&'static str>>,
}

impl Remarks {
    /// Records that a key of a group has been read.
    pub(super) fn ask(&mut self, group: &Group, key: &'static str) {
        let asked = self.asked.entry(group.line).or_default();
        if !asked.contains(&key) {
            asked.push(key);
        }
    }

    /// Returns true if a key of a group has been read.
    pub(super) fn is_asked(&self, group: &Group, key: &str) -> bool {
        self.asked.get(&group.line).is_some_and(|asked| asked.contains(&key))
    }

    /// Records that a line has been converted.
    pub(super) fn take(&mut self, entry: &Entry) {
        self.taken.insert(entry.line);
    }

    /// Adds a line whose meaning is lost or different.
    pub(super) fn lost(&mut self, group: &Group, entry: &Entry, why: &str) {
        self.take(entry);
        self.leave(|| remark(group, entry, why));
    }

    /// Adds a line without effect.
    pub(super) fn idle(&mut self, group: &Group, entry: &Entry, why: &str) {
        self.take(entry);
        add(&mut self.idle, &mut self.more[1], || remark(group, entry, why));
    }

    /// Returns the number of lines and defaults with another meaning.
    pub(super) fn count_left(&self) -> usize {
        self.left.len() + self.more[0]
    }

    fn leave(&mut self, remark: impl FnOnce() -> LeftOut) {
        add(&mut self.left, &mut self.more[0], remark);
    }

    /// Adds a default of the 2013 program that cannot be converted.
    pub(super) fn unsaid(&mut self, group: &Group, key: &str, value: &str, why: &str) {
        let key = format!("{}/{key}", group.path);
        self.leave(|| LeftOut { line: None, key, value: value.into(), why: why.into() });
    }

    /// Adds a line whose meaning is lost, or the default of a missing line.
    pub(super) fn lost_or_default(&mut self, group: &Group, entry: Option<&Entry>, [key, value]: [&str; 2], why: &str) {
        match entry {
            Some(entry) => self.lost(group, entry, why),
            None => self.unsaid(group, key, value, why),
        }
    }

    /// Adds remarks on all unread lines, and sorts all by line.
    pub(super) fn finish(&mut self, ini: &Ini) {
        for group in ini.groups() {
            let (known, asked) =
                (self.asked.contains_key(&group.line), self.asked.remove(&group.line).unwrap_or_default());
            if !known {
                let why = "is a part that no kinematic experiment here has";
                self.leave(|| of_line(group.line, format!("[{}]", group.path), why));
            }
            for entry in &group.entries {
                if !self.taken.contains(&entry.line) {
                    self.leave(|| remark(group, entry, &unread(entry, known, &asked)));
                }
            }
        }
        for stray in &ini.stray {
            self.leave(|| of_line(stray.line, stray.text.clone(), stray.why));
        }
        for list in [&mut self.left, &mut self.idle] {
            list.sort_by_key(|left| left.line.unwrap_or(usize::MAX));
        }
    }
}

/// Adds a remark if there is capacity.
fn add(list: &mut Vec<LeftOut>, more: &mut usize, remark: impl FnOnce() -> LeftOut) {
    if list.len() < MAX_REMARKS {
        list.push(remark());
    } else {
        *more += 1;
    }
}

/// Returns the reason for an unread line.
fn unread(entry: &Entry, known: bool, asked: &[&'static str]) -> String {
    match known.then(|| nearest(&entry.key, asked)) {
        None => "its group is not carried over".into(),
        Some(None) => "is no key of this part that is known here".into(),
        Some(Some(near)) => {
            format!("is no key of this part that is known here; the nearest that is known is `{near}`")
        }
    }
}

/// Returns a remark on a whole line.
fn of_line(line: usize, key: String, why: &str) -> LeftOut {
    LeftOut { line: Some(line), key, value: String::new(), why: why.into() }
}

fn remark(group: &Group, entry: &Entry, why: &str) -> LeftOut {
    let key = format!("{}/{}", group.path, entry.key);
    LeftOut { line: Some(entry.line), key, value: entry.value.clone(), why: why.into() }
}

/// Returns the nearest key if it begins and ends like an unread one.
fn nearest(key: &str, known: &[&'static str]) -> Option<String> {
    // Skips the edit distance for keys that are clearly different.
    if !known.iter().any(|known| is_like(key, known)) {
        return None;
    }
    nearest_name(key, known.iter().copied()).filter(|near| is_like(key, near)).map(str::to_owned)
}

/// Returns true if common beginning and end are at least three quarters of the longer key.
fn is_like(key: &str, known: &str) -> bool {
    let letters = |text| str::chars(text).flat_map(char::to_lowercase);
    let alike = |(a, b): &(char, char)| a == b;
    let same = letters(key).zip(letters(known)).take_while(alike).count()
        + letters(key).rev().zip(letters(known).rev()).take_while(alike).count();
    4 * same >= 3 * letters(key).count().max(letters(known).count())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_keys_that_are_alike_are_offered() {
        let known = ["mutation_rate", "nreplications", "elitism"];
        for (key, near) in [
            ("mutationRate", Some("mutation_rate")),
            ("nreplcations", Some("nreplications")),
            ("fitNoise", None),
            ("", None),
        ] {
            assert_eq!(nearest(key, &known).as_deref(), near, "{key}");
        }
        assert_eq!(nearest("x", &[]), None);
    }
}
