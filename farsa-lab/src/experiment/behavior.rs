//! Objectives and measures of an individual in addition to its fitness.

use crate::experiment::outcome::{Note, Outcome};
use crate::experiment::parameter::Parameter;

/// Objectives and measures of an individual in addition to its fitness, [`Task::behavior`](crate::Task::behavior).
/// NSGA-II searches for several objectives, MAP-Elites for individuals with different measures.
///
/// The fitness is the first objective of every strategy, and these follow. [`NotedBehavior`] builds them from a table
/// of [`Outcome::notes`].
pub trait Behavior {
    /// Lists the names of the further objectives, in order. More is better. By default none.
    fn objectives(&self) -> Vec<String> {
        Vec::new()
    }

    /// Lists the measures of a behavior, each with the range from low to high that an archive divides. A value beyond
    /// it counts as the nearest end. By default none.
    fn measures(&self) -> Vec<Parameter> {
        Vec::new()
    }

    /// Lists the objectives and then the measures of an individual, from its trials in order. A number that is not
    /// finite counts as a failure.
    fn describe(&self, trials: &[Outcome]) -> Vec<f64>;
}

/// A [`Behavior`] that averages [notes](Outcome::notes) over trials. These notes must be numbers.
///
/// ```
/// use farsa_lab::Outcome;
/// use farsa_lab::advanced::{Behavior, NotedBehavior};
///
/// static WALK: NotedBehavior = NotedBehavior {
///     objectives: &[("work [J]", -1.0)],
///     measures: &[("left foot on the ground", [0.0, 1.0])],
/// };
/// let trial = |work: f64, share: f64| Outcome {
///     notes: vec![("work [J]", work.into()), ("left foot on the ground", share.into())],
///     ..Outcome::default()
/// };
/// assert_eq!(WALK.describe(&[trial(3.0, 0.5), trial(4.0, 1.0)]), [-3.5, 0.75]);
/// assert_eq!(WALK.objectives(), ["minus work [J]"]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NotedBehavior {
    /// Names of all notes that are objectives. Use 1 if more is better, and -1 if less is better.
    pub objectives: &'static [(&'static str, f64)],
    /// Names of all notes that are measures, with their ranges from low to high.
    pub measures: &'static [(&'static str, [f64; 2])],
}

impl Behavior for NotedBehavior {
    fn objectives(&self) -> Vec<String> {
        let named = |(note, sign): &(&str, f64)| if *sign < 0.0 { format!("minus {note}") } else { (*note).into() };
        self.objectives.iter().map(named).collect()
    }

    fn measures(&self) -> Vec<Parameter> {
        self.measures.iter().map(|(note, ends)| Parameter::new(*note, *ends)).collect()
    }

    fn describe(&self, trials: &[Outcome]) -> Vec<f64> {
        let objectives = self.objectives.iter().map(|(note, sign)| sign * mean_of_note(trials, note));
        objectives.chain(self.measures.iter().map(|(note, _)| mean_of_note(trials, note))).collect()
    }
}

/// Computes the mean of a numeric note over all trials. If any trial lacks it, the mean is NaN.
pub fn mean_of_note(trials: &[Outcome], name: &str) -> f64 {
    let number = |outcome: &Outcome| match outcome.notes.iter().find(|(own, _)| *own == name) {
        Some((_, Note::Number(x))) => *x,
        _ => f64::NAN,
    };
    trials.iter().map(number).sum::<f64>() / trials.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_noted_is_no_number() {
        let trial = |x: Note| Outcome { notes: vec![("way", x)], ..Outcome::default() };
        assert_eq!(mean_of_note(&[trial(1.0.into()), trial(2.0.into())], "way"), 1.5);
        for trials in [vec![], vec![trial("far".into())], vec![trial(1.0.into()), Outcome::default()]] {
            assert!(mean_of_note(&trials, "way").is_nan(), "{trials:?}");
        }
    }
}
