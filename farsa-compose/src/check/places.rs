//! Where in a text each value stands.

use std::collections::BTreeMap;

use farsa_lab::Error;

/// The lines of values by their paths: `/sensors/0/range`.
#[derive(Clone, Debug, Default)]
pub(crate) struct Places {
    file: String,
    lines: BTreeMap<String, usize>,
    /// Parts that stand in other files, by the beginning of their paths.
    others: Vec<(String, Self)>,
}

impl Places {
    /// Nothing of a file yet.
    pub(crate) fn new(file: &str) -> Self {
        Self { file: file.into(), lines: BTreeMap::new(), others: Vec::new() }
    }

    pub(crate) fn put(&mut self, path: &str, line: usize) {
        self.lines.insert(path.into(), line);
    }

    /// Says that what begins with a path stands elsewhere, under `own` there.
    pub(crate) fn put_elsewhere(&mut self, path: &str, own: &str, places: &Self) {
        let lines = places
            .lines
            .iter()
            .filter_map(|(known, line)| Some((format!("{path}{}", known.strip_prefix(own)?), *line)));
        let other = Self { file: places.file.clone(), lines: lines.collect(), others: Vec::new() };
        self.others.push((path.into(), other));
    }

    /// The place of a line.
    pub(crate) fn of_line(&self, line: usize) -> String {
        format!("{} line {line}", self.file)
    }

    /// Where a value stands, or what it is in.
    pub(crate) fn of(&self, path: &str) -> String {
        let within = |own: &str| path.strip_prefix(own).is_some_and(|rest| rest.is_empty() || rest.starts_with('/'));
        if let Some((_, other)) = self.others.iter().find(|(own, _)| within(own)) {
            return other.of(path);
        }
        let mut path = path;
        loop {
            if let Some(&line) = self.lines.get(path) {
                return self.of_line(line);
            }
            match path.rsplit_once('/') {
                Some((above, _)) => path = above,
                None => return self.file.clone(),
            }
        }
    }

    /// What is wrong with a value.
    pub(crate) fn wrong(&self, path: &str, why: impl std::fmt::Display) -> Error {
        Error::Setting { place: self.of(path), key: key(path), why: why.to_string() }
    }
}

/// A path as a person reads it, lists counted from 1: `sensors.1.range`.
pub(crate) fn key(path: &str) -> String {
    let parts = path.split('/').skip(1).map(|part| match part.parse::<usize>() {
        Ok(index) => (index + 1).to_string(),
        Err(_) => part.chars().take(60).collect(),
    });
    parts.collect::<Vec<_>>().join(".")
}

/// Where the lines of a text begin.
pub(crate) struct Lines(Vec<usize>);

impl Lines {
    pub(crate) fn new(text: &str) -> Self {
        Self(std::iter::once(0).chain(text.match_indices('\n').map(|(end, _)| end + 1)).collect())
    }

    /// The line of a byte, from 1.
    pub(crate) fn of(&self, offset: usize) -> usize {
        self.0.partition_point(|&start| start <= offset)
    }
}
