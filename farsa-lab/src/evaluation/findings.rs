//! Summary of the trials of a test.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde::{Serialize, Serializer};

use crate::evaluation::trials::NO_VALUE;
use crate::experiment::outcome::NO_CRITERION;
use crate::figures::significant::significant;

/// Summary of the trials of a test.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Findings {
    pub(crate) trials: usize,
    /// `None` without a criterion of success.
    pub(crate) successes: Option<usize>,
    /// Share of the trials that succeeded. NaN if all broke down, and without a criterion of success.
    pub(crate) rate: f64,
    /// Interval of the share of 95 %, by Wilson's score. NaN without a share.
    pub(crate) interval: [f64; 2],
    /// Trials whose numbers were not finite.
    pub(crate) broken_down: usize,
    /// Mean fitness of the trials that did not break down, NaN without any.
    pub(crate) fitness: f64,
    /// Bootstrap interval of the mean of 95 %. NaN for fewer than two trials.
    pub(crate) fitness_interval: [f64; 2],
    /// By the number of the experiment's trial.
    pub(crate) by_trial: BTreeMap<u32, Share>,
    /// By the name of the note, in the order of the table.
    #[serde(serialize_with = "as_map")]
    pub(crate) notes: Vec<(String, Finding)>,
}

/// Successes among trials.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub(crate) struct Share {
    pub(crate) successes: usize,
    pub(crate) of: usize,
    /// Trials that broke down, which are no successes.
    pub(crate) broken_down: usize,
}

impl Share {
    /// Computes the share of successes, NaN if every trial broke down.
    pub(crate) fn rate(self) -> f64 {
        if self.of > self.broken_down { self.successes as f64 / self.of as f64 } else { f64::NAN }
    }
}

/// Summary of a note.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Finding {
    /// Mean of a quantity over the trials that have it, NaN without any.
    Mean(f64),
    /// Count of each word.
    Counts(BTreeMap<String, usize>),
}

impl Finding {
    pub(super) fn from_fields(fields: Vec<String>) -> Self {
        if fields.iter().all(|field| field.is_empty() || field.parse::<f64>().is_ok()) {
            return Self::Mean(mean(&fields));
        }
        let mut counts = BTreeMap::new();
        for field in fields.into_iter().filter(|field| !field.is_empty()) {
            *counts.entry(field).or_default() += 1;
        }
        Self::Counts(counts)
    }
}

impl Findings {
    /// Formats the share of successes, the mean fitness, and the notes' counts and means, a line each.
    pub(crate) fn text(&self) -> String {
        let share = |n: usize| format!("{n} of {} ({:.1} %)", self.trials, 100.0 * self.part(n));
        // Writing into a string cannot fail.
        let mut text = String::new();
        let mean = |x: f64| if x.is_finite() { format!("mean {}", significant(x)) } else { NO_VALUE.into() };
        let _ = writeln!(text, "success: {}", self.success());
        if self.broken_down > 0 {
            let _ = writeln!(text, "broken down: {}", share(self.broken_down));
        }
        let [low, high] = self.fitness_interval.map(significant);
        let interval =
            if self.fitness_interval[0].is_nan() { String::new() } else { format!(" (95 % interval {low} to {high})") };
        let _ = writeln!(text, "fitness of a trial: {}{interval}", mean(self.fitness));
        for (name, finding) in &self.notes {
            let _ = match finding {
                Finding::Mean(x) => writeln!(text, "{name}: {}", mean(*x)),
                Finding::Counts(counts) => {
                    let counts: Vec<String> =
                        counts.iter().map(|(word, &count)| format!("{word} {}", share(count))).collect();
                    writeln!(text, "{name}: {}", counts.join(", "))
                }
            };
        }
        text
    }

    /// Formats the successes, with their share and its interval.
    fn success(&self) -> String {
        let Some(successes) = self.successes else { return NO_CRITERION.into() };
        if self.rate.is_nan() {
            return NO_VALUE.into();
        }
        let [rate, low, high] = [self.rate, self.interval[0], self.interval[1]].map(|share| 100.0 * share);
        format!("{successes} of {} ({rate:.1} %, 95 % interval {low:.1} to {high:.1} %)", self.trials)
    }

    /// Returns the share of a number of trials.
    pub(crate) fn part(&self, trials: usize) -> f64 {
        trials as f64 / self.trials.max(1) as f64
    }
}

/// Serializes notes by their names.
pub(super) fn as_map<S: Serializer>(notes: &[(String, Finding)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(notes.iter().map(|(name, finding)| (name, finding)))
}

/// Parses the finite numbers of a column.
pub(super) fn numbers(fields: &[String]) -> Vec<f64> {
    fields.iter().filter_map(|field| field.parse().ok()).filter(|x: &f64| x.is_finite()).collect()
}

/// Computes the mean of the finite numbers of a column, NaN without any.
pub(super) fn mean(fields: &[String]) -> f64 {
    let finite = numbers(fields);
    if finite.is_empty() { f64::NAN } else { finite.iter().sum::<f64>() / finite.len() as f64 }
}
