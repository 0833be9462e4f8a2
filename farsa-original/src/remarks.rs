//! What cannot be carried over, and why.

use std::collections::{BTreeMap, BTreeSet};

use farsa_lab::{Error, LeftOut};

use crate::ini::{Entry, Group, Ini};

/// The most remarks of each sort; what is beyond them is counted. Each repeats the name of its group, which may be a hundred times as
/// long as a line.
const MOST_REMARKS: usize = 400;

/// Remarks on lines, collected while a configuration is read.
#[derive(Debug, Default)]
pub(super) struct Remarks {
    /// What is other here than it was there.
    pub(super) left: Vec<LeftOut>,
    /// What changes nothing that comes out.
    pub(super) idle: Vec<LeftOut>,
    /// How many more there are of both.
    pub(super) more: [usize; 2],
    /// Lines of which something has become, if only a remark.
    taken: BTreeSet<usize>,
    /// The keys that were asked for in each group, by the line where it begins.
    asked: BTreeMap<usize, Vec<&'static str>>,
}

impl Remarks {
    /// Notes that a group is a part that is known, and a key of it.
    pub(super) fn ask(&mut self, group: &Group, key: &'static str) {
        let asked = self.asked.entry(group.line).or_default();
        if !asked.contains(&key) {
            asked.push(key);
        }
    }

    /// Whether a key of a group has been asked for.
    pub(super) fn is_asked(&self, group: &Group, key: &str) -> bool {
        self.asked.get(&group.line).is_some_and(|asked| asked.contains(&key))
    }

    /// Notes that something has become of a line.
    pub(super) fn take(&mut self, entry: &Entry) {
        self.taken.insert(entry.line);
    }

    /// A line whose meaning is lost, or whose nearest meaning here is another.
    pub(super) fn lost(&mut self, group: &Group, entry: &Entry, why: &str) {
        self.take(entry);
        self.leave(|| remark(group, entry, why));
    }

    /// A line that changes nothing here.
    pub(super) fn idle(&mut self, group: &Group, entry: &Entry, why: &str) {
        self.take(entry);
        add(&mut self.idle, &mut self.more[1], || remark(group, entry, why));
    }

    /// How many lines and defaults have another meaning here, or none.
    pub(super) fn count_left(&self) -> usize {
        self.left.len() + self.more[0]
    }

    fn leave(&mut self, remark: impl FnOnce() -> LeftOut) {
        add(&mut self.left, &mut self.more[0], remark);
    }

    /// What a group does not say, and what the original takes for it, which cannot be carried over either.
    pub(super) fn unsaid(&mut self, group: &Group, key: &str, value: &str, why: &str) {
        let key = format!("{}/{key}", group.path);
        self.leave(|| LeftOut { line: None, key, value: value.into(), why: why.into() });
    }

    /// A line whose meaning is lost, or the default that is taken where there is none.
    pub(super) fn lost_or_default(&mut self, group: &Group, entry: Option<&Entry>, [key, value]: [&str; 2], why: &str) {
        match entry {
            Some(entry) => self.lost(group, entry, why),
            None => self.unsaid(group, key, value, why),
        }
    }

    /// Remarks on every line that nobody has asked for; all in the order of lines.
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

/// Takes up a remark where there is room.
fn add(list: &mut Vec<LeftOut>, more: &mut usize, remark: impl FnOnce() -> LeftOut) {
    if list.len() < MOST_REMARKS {
        list.push(remark());
    } else {
        *more += 1;
    }
}

/// Why nothing comes of a line that nobody has asked for.
fn unread(entry: &Entry, known: bool, asked: &[&'static str]) -> String {
    match known.then(|| nearest(&entry.key, asked)) {
        None => "its group is not carried over".into(),
        Some(None) => "is no key of this part that is known here".into(),
        Some(Some(near)) => {
            format!("is no key of this part that is known here; the nearest that is known is `{near}`")
        }
    }
}

/// A remark on a whole line.
fn of_line(line: usize, key: String, why: &str) -> LeftOut {
    LeftOut { line: Some(line), key, value: String::new(), why: why.into() }
}

fn remark(group: &Group, entry: &Entry, why: &str) -> LeftOut {
    let key = format!("{}/{}", group.path, entry.key);
    LeftOut { line: Some(entry.line), key, value: entry.value.clone(), why: why.into() }
}

/// The key that looks most like one that is not known, if it begins and ends much like it.
fn nearest(key: &str, known: &[&'static str]) -> Option<String> {
    // Most keys are like none, and need not be compared letter by letter.
    if !known.iter().any(|known| is_like(key, known)) {
        return None;
    }
    match Error::unknown("", "key", key, known.iter().copied()) {
        Error::Unknown { nearest: Some(near), .. } if is_like(key, &near) => Some(near),
        _ => None,
    }
}

/// Whether two keys begin and end alike: with three quarters of the longer one.
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
