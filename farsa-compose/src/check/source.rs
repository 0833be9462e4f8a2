//! Text of an experiment: lines of its values, names of its parts, limits of its sizes.

use std::collections::BTreeMap;

use farsa_lab::Error;
use serde_json::Value;

use crate::check::registry::Registry;
use crate::check::schema::Part;
use crate::check::settings::names;
use crate::limits::Limits;
use crate::part::network::NetworkText;

/// Text of an experiment, for errors with file, line and key.
#[derive(Clone, Debug, Default)]
pub(crate) struct Source {
    file: String,
    /// Lines of values by their paths, such as `/sensors/0/range`.
    lines: BTreeMap<String, usize>,
    /// Parts from other files, by the beginning of their paths.
    others: Vec<(String, Self)>,
    pub(crate) limits: Limits,
    pub(crate) names: Names,
    pub(crate) registry: Registry,
}

/// Names of parts, which no setting changes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Names {
    /// Name and description of each sensor.
    pub(crate) sensors: Vec<(String, String)>,
    /// Name and description of each motor.
    pub(crate) motors: Vec<(String, String)>,
    pub(crate) terms: Vec<String>,
}

impl Names {
    /// Names the parts of a document with this schema.
    pub(crate) fn new(document: &Value, schema: &Value) -> Self {
        let list = |key: &str| document[key].as_array().map_or(&[][..], Vec::as_slice);
        let root = Part::root(schema);
        let described = |key: &str| {
            let about =
                |part: &Value| root.map_or("", |root| root.about(key, part["kind"].as_str().unwrap_or_default()));
            let about = list(key).iter().map(about).map(str::to_owned);
            names(list(key)).into_iter().zip(about).collect()
        };
        Self { sensors: described("sensors"), motors: described("motors"), terms: names(list("reward")) }
    }
}

impl Source {
    /// A file without lines yet.
    pub(crate) fn new(file: &str) -> Self {
        Self { file: file.into(), ..Self::default() }
    }

    pub(crate) fn put(&mut self, path: &str, line: usize) {
        self.lines.insert(path.into(), line);
    }

    /// Takes the lines below `path` from those below `inner` in another file.
    pub(crate) fn include(&mut self, path: &str, inner: &str, other: &Self) {
        let lines = other.lines.iter();
        let lines = lines.filter_map(|(key, line)| Some((format!("{path}{}", key.strip_prefix(inner)?), *line)));
        let part = Self { lines: lines.collect(), ..Self::new(&other.file) };
        self.others.push((path.into(), part));
    }

    /// Formats the place of a line, as messages name it.
    pub(crate) fn of_line(&self, line: usize) -> String {
        format!("{} line {line}", self.file)
    }

    /// Formats the place of a value, or of the part around it.
    pub(crate) fn of(&self, path: &str) -> String {
        let within = |part: &str| path.strip_prefix(part).is_some_and(|rest| rest.is_empty() || rest.starts_with('/'));
        if let Some((_, other)) = self.others.iter().find(|(own, _)| within(own)) {
            return other.of(path);
        }
        let mut path = path;
        loop {
            if let Some(&line) = self.lines.get(path) {
                return self.of_line(line);
            }
            // A value may be a default that the file does not contain. Its nearest enclosing part has a line.
            match path.rsplit_once('/') {
                Some((above, _)) => path = above,
                None => return self.file.clone(),
            }
        }
    }

    /// Returns the number of a name among the valid ones. `what` describes an unknown one at a path.
    pub(crate) fn position<'n>(
        &self,
        names: impl Iterator<Item = &'n str> + Clone,
        (what, name): (&'static str, &str),
        path: &str,
    ) -> Result<usize, Error> {
        let number = names.clone().position(|other| other == name);
        number.ok_or_else(|| Error::unknown(&self.of(path), what, name, names))
    }

    /// Adds the place of a part to an error without one.
    pub(crate) fn at(&self, path: &str, error: Error) -> Error {
        if let Error::Other(why) = error { self.wrong(path, why) } else { error }
    }

    /// Creates the error of a value.
    pub(crate) fn wrong(&self, path: &str, why: impl std::fmt::Display) -> Error {
        Error::Setting { place: self.of(path), key: key(path), why: why.to_string() }
    }
}

impl NetworkText for Source {
    fn wrong(&self, key: &str, why: String) -> Error {
        Self::wrong(self, &format!("/network/{key}"), why)
    }

    fn unknown(&self, key: &str, (what, name): (&'static str, &str), names: &[&str]) -> Error {
        Error::unknown(&self.of(&format!("/network/{key}")), what, name, names.iter().copied())
    }

    fn check_network(&self, parameters: usize, memory: usize) -> Result<(), Error> {
        self.limits.check_network(parameters, memory)
    }
}

/// Returns a path as messages write it, with lists counted from 1: `sensors.1.range`.
pub(crate) fn key(path: &str) -> String {
    let parts = path.split('/').skip(1).map(|part| match part.parse::<usize>() {
        Ok(index) => (index + 1).to_string(),
        Err(_) => part.chars().take(60).collect(),
    });
    parts.collect::<Vec<_>>().join(".")
}

/// Offsets of the lines of a text.
pub(crate) struct Lines(Vec<usize>);

impl Lines {
    pub(crate) fn new(text: &str) -> Self {
        Self(std::iter::once(0).chain(text.match_indices('\n').map(|(end, _)| end + 1)).collect())
    }

    /// Gets the line of a byte, from 1.
    pub(crate) fn of(&self, offset: usize) -> usize {
        // The number of lines that start at or before the byte is its line, counted from 1.
        self.0.partition_point(|&start| start <= offset)
    }
}
