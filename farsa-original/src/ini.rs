//! The INI format of the 2013 program.

use std::collections::BTreeMap;

use farsa_lab::Error;

/// Most bytes of a text.
const MAX_BYTES: usize = 1_000_000;
/// Most lines of a text, because a line takes more memory than its text.
const MAX_LINES: usize = 5000;
/// Most bytes of the name of a group with its parents, because remarks repeat it.
const MAX_OF_A_PATH: usize = 200;

/// Groups of keys with values.
///
/// Source: the reader of \[FARSA2\]. A line that begins with `#` or `;` is a comment, `[A/B]` begins group `B` in
/// group `A`, and all other lines are `key = value`. `\` escapes a character. There are no include lines.
///
/// Deviations, which files of FARSA 1 need: white space around a line, a key and a value is dropped, and the spaces
/// around `=` are optional. A `#` after a value begins a comment. Duplicate keys are not an error.
#[derive(Debug, Default)]
pub(super) struct Ini {
    groups: Vec<Group>,
    /// Index of each group, by its path in lower case.
    places: BTreeMap<String, usize>,
    /// Lines outside groups, and lines that are not `key = value`.
    pub(super) stray: Vec<Stray>,
}

/// A line without meaning.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Stray {
    pub(super) line: usize,
    pub(super) text: String,
    pub(super) why: &'static str,
}

/// A group of keys.
#[derive(Debug)]
pub(super) struct Group {
    /// Path of the group, such as `Component/GA`.
    pub(super) path: String,
    /// Its first line.
    pub(super) line: usize,
    pub(super) entries: Vec<Entry>,
}

/// A key with its value.
#[derive(Debug)]
pub(super) struct Entry {
    pub(super) line: usize,
    pub(super) key: String,
    pub(super) value: String,
}

impl Ini {
    /// Reads a text.
    ///
    /// # Errors
    /// [`Error::Usage`] for more than a megabyte, 5000 lines or a long name, and for a text without groups.
    pub(super) fn from_text(file: &str, text: &str) -> Result<Self, Error> {
        if text.len() > MAX_BYTES {
            return Err(Error::Usage(format!("{file}: {} bytes where {MAX_BYTES} are the most", text.len())));
        }
        let mut ini = Self::default();
        let mut group = None;
        // Skips a byte order mark.
        for (index, line) in text.trim_start_matches('\u{feff}').lines().enumerate() {
            let (line, text) = (index + 1, line.trim());
            if line > MAX_LINES {
                return Err(Error::Usage(format!("{file}: more than {MAX_LINES} lines, which are the most")));
            }
            if text.is_empty() || text.starts_with(['#', ';']) {
                continue;
            }
            if let Some(path) = text.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')) {
                let path = unescaped(path.trim().trim_matches('/'));
                if path.len() > MAX_OF_A_PATH {
                    let length = path.len();
                    let why = format!("a group with a name of {length} bytes where {MAX_OF_A_PATH} are the most");
                    return Err(Error::Usage(format!("{file} line {line}: {why}")));
                }
                group = Some(ini.index(&path, line));
                continue;
            }
            let stray = |why| Stray { line, text: text.into(), why };
            let Some((key, value)) = text.split_once('=').filter(|(key, _)| !key.trim().is_empty()) else {
                ini.stray
                    .push(stray("is neither `[GROUP]` nor `key = value`; the original reads a value without a key"));
                continue;
            };
            let Some(group) = group.and_then(|index: usize| ini.groups.get_mut(index)) else {
                ini.stray.push(stray("stands before the first group, where no part of the original looks"));
                continue;
            };
            let (key, value) = (unescaped(key.trim()), unescaped(without_comment(value).trim()));
            group.entries.push(Entry { line, key, value });
        }
        if ini.groups.is_empty() {
            return Err(Error::Usage(format!("{file}: no `[GROUP]`: is no configuration of the original")));
        }
        Ok(ini)
    }

    /// Returns the index of a group, and adds it if it is new.
    fn index(&mut self, path: &str, line: usize) -> usize {
        let next = self.groups.len();
        let place = *self.places.entry(path.to_ascii_lowercase()).or_insert(next);
        if place == next {
            self.groups.push(Group { path: path.into(), line, entries: Vec::new() });
        }
        place
    }

    /// Returns all groups, in the order of the text.
    pub(super) fn groups(&self) -> &[Group] {
        &self.groups
    }

    /// Returns a group by path. The versions of the program differ in upper and lower case.
    pub(super) fn group(&self, path: &str) -> Option<&Group> {
        self.groups.get(*self.places.get(&path.to_ascii_lowercase())?)
    }

    /// Returns the groups `NAME`, `NAME:0`, `NAME:1` and so on in a group, by number.
    pub(super) fn numbered(&self, within: &str, name: &str) -> Vec<&Group> {
        let mut groups: Vec<(Option<u64>, &Group)> = Vec::new();
        for group in &self.groups {
            let Some((above, last)) = group.path.rsplit_once('/') else { continue };
            let (word, number) = last.split_once(':').map_or((last, None), |(word, number)| (word, Some(number)));
            let number = number.map(str::parse::<u64>);
            if above.eq_ignore_ascii_case(within) && word.eq_ignore_ascii_case(name) && !matches!(number, Some(Err(_)))
            {
                groups.push((number.and_then(Result::ok), group));
            }
        }
        groups.sort_by_key(|(number, _)| *number);
        groups.into_iter().map(|(_, group)| group).collect()
    }
}

/// Returns the text before a comment: a `#` after white space, as in FARSA 1, unless it begins the value, as in
/// colors.
fn without_comment(value: &str) -> &str {
    let value = value.trim();
    let comment = value.match_indices('#').find(|(at, _)| value[..*at].ends_with(char::is_whitespace));
    comment.map_or(value, |(at, _)| &value[..at])
}

/// Removes escapes from a name or a value. Line breaks become spaces.
fn unescaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut signs = text.chars();
    while let Some(sign) = signs.next() {
        match sign {
            '\\' => match signs.next() {
                Some('n' | 'r') => out.push(' '),
                Some(other) => out.push(other),
                None => {}
            },
            other => out.push(other),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_keys_and_comments_are_told_apart() {
        let text = "; a\n# b\nlost = 1\n[A]\nx = 1\n[A/B:1]\r\n y=2 # two\n[a]\nz = \\#FF\\=\\[0\\]\ncolor = #00FF00\n= 3\nx x\n";
        let ini = Ini::from_text("x.ini", text).unwrap();
        let all: Vec<(&str, usize, &str, &str)> = ini
            .groups()
            .iter()
            .flat_map(|group| group.entries.iter().map(|e| (&*group.path, e.line, &*e.key, &*e.value)))
            .collect();
        let expected =
            [("A", 5, "x", "1"), ("A", 9, "z", "#FF=[0]"), ("A", 10, "color", "#00FF00"), ("A/B:1", 7, "y", "2")];
        assert_eq!(all, expected);
        assert_eq!(ini.stray.iter().map(|stray| stray.line).collect::<Vec<_>>(), [3, 11, 12]);
    }

    #[test]
    fn numbers_order_the_groups_of_a_name() {
        let ini = Ini::from_text("x.ini", "[A/S:10]\n[A/S:2]\n[A/s]\n[A/S:x]\n[A/T:1]\n[B/S:1]\n[S:0]\n").unwrap();
        let paths: Vec<&str> = ini.numbered("a", "S").iter().map(|group| &*group.path).collect();
        assert_eq!(paths, ["A/s", "A/S:2", "A/S:10"]);
        assert!(ini.group("a/t:1").is_some() && ini.group("A/U").is_none());
    }

    #[test]
    fn texts_without_groups_and_long_texts_are_refused() {
        for (text, why) in [
            ("x = 1".into(), "x.ini: no `[GROUP]`"),
            ("#".repeat(1_000_001), "x.ini: 1000001 bytes"),
            (format!("\n[{}]", "a/".repeat(300)), "x.ini line 2: a group with a name of 599 bytes"),
        ] {
            let error = Ini::from_text("x.ini", &text).unwrap_err().to_string();
            assert!(error.starts_with(why), "{error}");
        }
    }
}
