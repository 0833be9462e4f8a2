//! Warnings about parts of a file that the robot does not have.

use std::collections::BTreeMap;

use crate::error::SourceLocation;

/// Warning about a part of a file that was omitted or replaced.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Warning {
    /// Location of the first occurrence.
    pub place: SourceLocation,
    /// Name of the element. If the warning is about one of its attributes, this includes the attribute.
    pub what: String,
    /// Description of the treatment and its reason.
    pub why: String,
    /// Number of occurrences.
    pub count: usize,
}

impl std::fmt::Display for Warning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { place, what, why, count } = self;
        match count {
            1 => write!(f, "{place}: {what}: {why}"),
            _ => write!(f, "{place} and {} more: {what}: {why}", count - 1),
        }
    }
}

/// Warnings, equal ones counted.
#[derive(Default)]
pub(crate) struct Warnings {
    all: BTreeMap<(String, String), (SourceLocation, usize)>,
}

impl Warnings {
    pub(crate) fn add(&mut self, place: SourceLocation, what: impl Into<String>, why: impl Into<String>) {
        self.all.entry((what.into(), why.into())).or_insert((place, 0)).1 += 1;
    }

    /// All of them, in alphabetical order.
    pub(crate) fn list(self) -> Vec<Warning> {
        let warning = |((what, why), (place, count))| Warning { place, what, why, count };
        self.all.into_iter().map(warning).collect()
    }
}
