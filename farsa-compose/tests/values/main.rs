//! Values of reward terms, sensors, motors and wrappers of files, each computed by hand.
//!
//! No two quantities of a scene are equal: wheel speeds, sides, weights, time step, distance and height differ. A
//! robot begins away from the origin at an odd heading.

// Expected values do not depend on farsa-num.
#![allow(clippy::disallowed_methods)]

#[cfg(feature = "rapier")]
mod blocks;
mod drives;
mod exports;
mod formulas;
mod joints;
mod kinds;
mod postures;
mod recordings;
mod senses;
mod starts;
mod surroundings;
mod teams;
mod totals;
mod wheels;
mod wrappers;

use farsa_compose::ComposedExperiment;
use farsa_lab::advanced::Recording;
use farsa_lab::{EpisodeId, Error, Evaluation, Evaluator, Experiment as _, Outcome, Settings};

/// Builds the evaluator of a file.
fn made(text: &str) -> Result<Box<dyn Evaluator>, Error> {
    let made = ComposedExperiment::from_text("values.toml", text, farsa_lab::strategy::strategies())?;
    made.prepare("", &Settings::new(made.settings(""))?)
}

/// Returns the error of a wrong file.
fn refused(text: &str) -> String {
    made(text).err().unwrap_or_else(|| panic!("nothing is wrong with\n{text}")).to_string()
}

/// A recorded trial of a network without searched parameters.
struct Trial {
    outcome: Outcome,
    recording: Recording,
}

impl Trial {
    fn new(text: &str) -> Self {
        let mut evaluator = made(text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        let parameters = vec![0.0; evaluator.info().parameters.len()];
        let mut recording = Recording::new(evaluator.info().schema);
        let outcome = evaluator.evaluate(Evaluation::new(&parameters, EpisodeId::default()), Some(&mut recording));
        assert!(outcome.is_finite(), "{outcome:?}\n{text}");
        Self { outcome, recording }
    }

    /// Returns a column after each step.
    fn column(&self, name: &str) -> Vec<f64> {
        let columns = self.recording.schema().columns();
        let place = columns.iter().position(|column| column == name);
        let place = place.unwrap_or_else(|| panic!("no `{name}` in {columns:?}"));
        let ticks = 0..self.recording.times().len();
        ticks.map(|tick| self.recording.row(tick).nth(place).unwrap_or(f64::NAN)).collect()
    }

    /// Returns the channels of a sensor as it was read in a step, from 1.
    fn sensor(&self, name: &str, step: usize) -> Vec<f64> {
        let columns = self.recording.schema().columns();
        let values = columns.iter().zip(self.recording.row(step - 1));
        let of_sensor = |column: &str| {
            let rest = column.strip_prefix("sensor.").and_then(|column| column.strip_prefix(name));
            rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(' '))
        };
        let values: Vec<f64> = values.filter(|(column, _)| of_sensor(column)).map(|(_, value)| value).collect();
        assert!(!values.is_empty(), "no sensor `{name}` in {columns:?}");
        values
    }
}

/// Compares two numbers.
#[track_caller]
fn close(found: f64, wanted: f64, tolerance: f64, what: &str) {
    assert!((found - wanted).abs() <= tolerance, "{what}: {found} where {wanted} is wanted");
}

/// Compares two lists of numbers.
#[track_caller]
fn all_close(found: &[f64], wanted: &[f64], tolerance: f64, what: &str) {
    assert_eq!(found.len(), wanted.len(), "{what}: {found:?} where {wanted:?} is wanted");
    for (number, (found, wanted)) in found.iter().zip(wanted).enumerate() {
        close(*found, *wanted, tolerance, &format!("{what} [{number}]"));
    }
}

fn yes(flag: bool) -> f64 {
    f64::from(u8::from(flag))
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}
