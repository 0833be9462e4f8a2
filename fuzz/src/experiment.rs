//! The experiment whose runs the targets read: three genes are to match numbers.

use farsa_body::Recorder;
use farsa_compose::{ComposedExperiment, Limits};
use farsa_lab::advanced::{Behavior, ExperimentFiles, Iteration, Learner, NotedBehavior, ReadExperiment, Schema};
use farsa_lab::strategy::{StrategyDefinition, Truncation};
use farsa_lab::{
    Error, Evaluation, Evaluator, Experiment, Laboratory, Outcome, Parameter, Setting, Settings, Task, TaskInfo,
};
use farsa_num::{Domain, Stream};

/// Individuals of a population.
const SIZE: i64 = 10;

/// Numbers that are to be matched, alone or against those of another population.
pub struct Tune;

/// The only one.
pub static TUNE: Tune = Tune;

/// The command's, over this experiment and those of files.
pub fn laboratory() -> Laboratory<'static> {
    let read: ReadExperiment = |file, text, _, strategies| {
        Ok(Box::new(ComposedExperiment::from_text_within(limits(), file, text, strategies)?))
    };
    Laboratory::new(&[&TUNE]).with_files(ExperimentFiles { read, ..farsa_compose::FILES })
}

/// Limits of experiments that bound the memory of a target by the length of its input.
pub fn limits() -> Limits {
    let mut limits = Limits::default();
    (limits.network_values, limits.robots, limits.parts, limits.rays) = (2000, 100, 500, 4000);
    limits
}

impl Experiment for Tune {
    fn name(&self) -> &'static str {
        "tune"
    }
    fn summary(&self) -> &'static str {
        "three genes are to match numbers"
    }
    fn conditions(&self) -> &'static [&'static str] {
        &["alone", "chase"]
    }
    fn strategy(&self, _: &str) -> &'static dyn StrategyDefinition {
        &Truncation
    }
    fn settings(&self, _: &str) -> Vec<Setting> {
        vec![
            Setting::whole("evolution.population", SIZE, 1..=100),
            Setting::whole("evolution.parents", 2, 1..=100),
            Setting::number("tune.noise", 0.5, 0.0..=1.0).unit("m").doc("Of each trial."),
            Setting::word("tune.sign", "less", &["less", "more"]).doc("What counts."),
            Setting::flag("tune.exact", false).doc("Whether noise is left out."),
        ]
    }
    fn prepare(&self, condition: &str, settings: &Settings) -> Result<Box<dyn Evaluator>, Error> {
        let populations = if condition == "chase" { 2 } else { 1 };
        Ok(Box::new(Trial { populations, noise: settings.number("tune.noise")? }))
    }
    fn gene_bits(&self) -> u32 {
        8
    }
}

struct Trial {
    populations: usize,
    noise: f64,
}

static BEHAVIOUR: NotedBehavior =
    NotedBehavior { objectives: &[("distance", -1.0)], measures: &[("first", [0.0, 1.0]), ("second", [0.0, 1.0])] };

impl Task for Trial {
    fn info(&self) -> TaskInfo {
        TaskInfo {
            trials: 2,
            terms: vec!["near".into()],
            populations: (0..self.populations).map(|population| format!("kind {population}")).collect(),
            ..TaskInfo::new(
                ["first", "second", "third"].map(|name| Parameter::new(name, [0.0, 1.0])).into(),
                Schema::from_scalars(["first [m]"]),
            )
        }
    }

    fn behavior(&self) -> Option<&dyn Behavior> {
        Some(&BEHAVIOUR)
    }
}

impl Evaluator for Trial {
    fn evaluate(&mut self, evaluation: Evaluation<'_>, _: Option<&mut dyn Recorder>) -> Outcome {
        let Evaluation { parameters, opponents, id, .. } = evaluation;
        let noise = Stream::new(id.seed, Domain::Start, id.trial, id.individual, id.generation).uniform_f64();
        let aim = opponents.first().map_or(0.25, |other| f64::from(other[0]));
        let distance = (f64::from(parameters[0]) - aim).abs() + self.noise * noise;
        let [first, second] = [0, 1].map(|gene| f64::from(parameters[gene]));
        let notes = vec![("distance", distance.into()), ("first", first.into()), ("second", second.into())];
        Outcome { terms: vec![1.0 - distance], steps: 1, success: distance < 0.5, notes, ..Outcome::default() }
    }
    fn learner(&mut self) -> Option<&mut dyn Learner> {
        Some(self)
    }
}

impl Learner for Trial {
    fn initial_state(&self, _: u64) -> Vec<f64> {
        vec![0.0; 3]
    }
    fn iterate(&mut self, state: &mut [f64], _: u64, _: u32) -> Option<Iteration> {
        let before = state.iter().sum();
        state.iter_mut().for_each(|value| *value = 0.5 * (*value + 1.0));
        Some(Iteration { before, after: state.iter().sum(), successes: 1.0 })
    }
    fn learned(&self, state: &[f64]) -> Vec<f64> {
        state.to_vec()
    }
}
