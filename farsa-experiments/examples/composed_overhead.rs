//! What an experiment from a file costs over the same one built in, bit for bit.
//!
//! `composed_overhead discrimination file` and `... built-in` do the trials in a function `measured` for callgrind:
//! `valgrind --tool=callgrind --collect-atstart=no --toggle-collect='*measured*'`. The other experiment is `foraging`.

use std::path::Path;

use farsa_compose::ComposedExperiment;
use farsa_experiments::{Discrimination, Foraging};
use farsa_lab::{EpisodeId, Evaluation, Evaluator, Experiment, Settings};
use farsa_num::{Domain, Stream};

#[inline(never)]
fn measured(evaluator: &mut dyn Evaluator, jobs: &[Evaluation<'_>]) -> u64 {
    jobs.iter().map(|job| u64::from(evaluator.evaluate(*job, None).steps)).sum()
}

fn evaluator(experiment: &dyn Experiment) -> Result<Box<dyn Evaluator>, farsa_lab::Error> {
    let condition = experiment.conditions().first().copied().unwrap_or_default();
    experiment.prepare(condition, &Settings::new(experiment.settings(condition))?)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut words = std::env::args().skip(1);
    let (name, from) = (words.next().unwrap_or_default(), words.next().unwrap_or_default());
    let (built_in, individuals): (&dyn Experiment, u32) = match name.as_str() {
        "discrimination" => (&Discrimination, 20),
        "foraging" => (&Foraging, 1),
        other => return Err(format!("`{other}` is neither discrimination nor foraging").into()),
    };
    let mut evaluator = match from.as_str() {
        "built-in" => evaluator(built_in)?,
        "file" => {
            let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../experiments");
            evaluator(&ComposedExperiment::from_file(&folder.join(format!("{name}.toml")), farsa_lab::strategies())?)?
        }
        other => return Err(format!("`{other}` is neither file nor built-in").into()),
    };
    // Small weights make slow robots, whose trials are long: what counts is the step.
    let of_individual = |individual: u32| -> Vec<f32> {
        let mut draw = Stream::new(1, Domain::InitialGenome, 0, individual, 0);
        evaluator
            .parameters()
            .iter()
            .map(|parameter| 0.05 * draw.range_f64(parameter.ends[0], parameter.ends[1]) as f32)
            .collect()
    };
    let parameters: Vec<Vec<f32>> = (0..individuals).map(of_individual).collect();
    let jobs: Vec<Evaluation<'_>> = (0..individuals)
        .map(|individual| {
            Evaluation::new(&parameters[individual as usize], EpisodeId { seed: 1, individual, ..EpisodeId::default() })
        })
        .collect();
    println!("{} steps", measured(evaluator.as_mut(), &jobs));
    Ok(())
}
