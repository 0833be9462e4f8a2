//! What cannot be carried over, and why.

use std::collections::{BTreeMap, BTreeSet};

use farsa_lab::{Error, LeftOut};

use crate::original::ini::{Entry, Group, Ini};

/// Unknown keys beyond so many are named without the nearest one that is known.
const MOST_OFFERS: usize = 1000;

/// Remarks on lines, collected while a configuration is read.
#[derive(Debug, Default)]
pub(super) struct Remarks {
    /// What is other here than it was there.
    pub(super) left: Vec<LeftOut>,
    /// What changes nothing that comes out.
    pub(super) idle: Vec<LeftOut>,
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
        self.left.push(remark(group, entry, why));
    }

    /// A line that changes nothing here.
    pub(super) fn idle(&mut self, group: &Group, entry: &Entry, why: &str) {
        self.take(entry);
        self.idle.push(remark(group, entry, why));
    }

    /// What a group does not say, and what the original takes for it, which cannot be carried over either.
    pub(super) fn unsaid(&mut self, group: &Group, key: &str, value: &str, why: &str) {
        let key = format!("{}/{key}", group.path);
        self.left.push(LeftOut { line: None, key, value: value.into(), why: why.into() });
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
        let mut offers = MOST_OFFERS;
        for group in ini.groups() {
            let (known, asked) =
                (self.asked.contains_key(&group.line), self.asked.remove(&group.line).unwrap_or_default());
            let group_key = format!("[{}]", group.path);
            if !known {
                let why = "is a part that no kinematic experiment here has";
                self.left.push(LeftOut {
                    line: Some(group.line),
                    key: group_key,
                    value: String::new(),
                    why: why.into(),
                });
            }
            for entry in &group.entries {
                if self.taken.contains(&entry.line) {
                    continue;
                }
                let near = if offers > 0 && known { nearest(&entry.key, &asked) } else { None };
                offers = offers.saturating_sub(1);
                let why = match (known, near) {
                    (false, _) => "its group is not carried over".into(),
                    (true, Some(near)) => {
                        format!("is no key of this part that is known here; the nearest that is known is `{near}`")
                    }
                    (true, None) => "is no key of this part that is known here".into(),
                };
                self.lost(group, entry, &why);
            }
        }
        for stray in &ini.stray {
            let (key, why) = (stray.text.clone(), stray.why.into());
            self.left.push(LeftOut { line: Some(stray.line), key, value: String::new(), why });
        }
        for list in [&mut self.left, &mut self.idle] {
            list.sort_by_key(|left| left.line.unwrap_or(usize::MAX));
        }
    }
}

fn remark(group: &Group, entry: &Entry, why: &str) -> LeftOut {
    let key = format!("{}/{}", group.path, entry.key);
    LeftOut { line: Some(entry.line), key, value: entry.value.clone(), why: why.into() }
}

/// The key that looks most like one that is not known, if it begins and ends much like it.
fn nearest(key: &str, known: &[&'static str]) -> Option<String> {
    let Error::Unknown { nearest: Some(near), .. } = Error::unknown("", "key", key, known.iter().copied()) else {
        return None;
    };
    let [a, b] = [key, &*near].map(|key| key.to_lowercase().chars().collect::<Vec<char>>());
    let alike = |(a, b): &(&char, &char)| a == b;
    let same =
        a.iter().zip(&b).take_while(alike).count() + a.iter().rev().zip(b.iter().rev()).take_while(alike).count();
    (4 * same >= 3 * a.len().max(b.len())).then_some(near)
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
