//! An experiment whose trials fail at a rate, in all ways in which a trial can: `quality/campaign` runs it for hours.

use std::process::ExitCode;

use farsa_body::Recorder;
use farsa_lab::advanced::record_row;
use farsa_lab::advanced::{Description, Schema};
use farsa_lab::{Error, Evaluation, Evaluator, Outcome, Parameter, Setting, Settings};
use farsa_lab::{SimpleExperiment, Task, TaskInfo, cli};
use farsa_num::{Domain, Stream};

fn settings(_: &str) -> Vec<Setting> {
    vec![
        Setting::whole("evolution.population", 20, 1..=1000).doc("Individuals of a generation."),
        Setting::whole("evolution.parents", 5, 1..=1000).doc("Those that have children."),
        Setting::number("fault.rate", 0.02, 0.0..=1.0).doc("Share of the trials that fail."),
        Setting::whole("trial.steps", 1000, 1..=1_000_000_000).doc("Steps of a trial."),
    ]
}

fn prepare(settings: &Settings) -> Result<Box<dyn Evaluator>, Error> {
    let (rate, steps) = (settings.number("fault.rate")?, settings.count("trial.steps")?);
    Ok(Box::new(Faulty { rate, steps: steps as u32 }))
}

/// Comes nearer to its parameter step by step.
struct Faulty {
    rate: f64,
    steps: u32,
}

impl Task for Faulty {
    fn info(&self) -> TaskInfo {
        TaskInfo {
            description: Description { parameters: 1, steps: self.steps as usize, ..Description::default() },
            trials: 3,
            ..TaskInfo::new(vec![Parameter::new("aim", [0.0, 1.0])], Schema::from_scalars(["place"]))
        }
    }
}

impl Evaluator for Faulty {
    fn evaluate(&mut self, evaluation: Evaluation<'_>, mut recorder: Option<&mut dyn Recorder>) -> Outcome {
        let Evaluation { parameters, id, .. } = evaluation;
        let mut stream = Stream::new(id.seed, Domain::Start, id.trial, id.individual, id.generation);
        let (mut place, fails) = (stream.uniform_f64(), stream.uniform_f64() < self.rate);
        for step in 1..=self.steps {
            place += 0.001 * (f64::from(parameters[0]) - place);
            record_row(&mut recorder, f64::from(step), &[place]);
        }
        let terms = match (fails, (stream.uniform_f64() * 5.0) as u32) {
            (false, _) => vec![place],
            (true, 0) => panic!("as planned"),
            (true, 1) => return Outcome::failed(),
            (true, 2) => vec![f64::NAN],
            (true, 3) => vec![f64::INFINITY],
            (true, _) => Vec::new(),
        };
        Outcome { terms, steps: self.steps, ..Outcome::default() }
    }
}

fn main() -> ExitCode {
    let (name, summary) = ("faulty", "comes nearer to a place, and fails at a rate");
    cli::main(&[&SimpleExperiment { name, summary, conditions: &[], settings, prepare }])
}
