//! `farsa replay`: a life of the run again, step by step.

use std::io::{self, Write};

use farsa_evo::Fitness;

use crate::directory::Directory;
use crate::error::Error;
use crate::experiment::{Outcome, Tape};
use crate::life::Job;
use crate::plan::Plan;
use crate::records::{self, Ancestry};

/// Which lives to live again.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Which {
    /// The generation; the last finished one if none is named.
    pub(crate) generation: Option<u32>,
    /// The individual; the best of the generation if none is named.
    pub(crate) individual: Option<u32>,
    /// The trial; all of them if none is named.
    pub(crate) trial: Option<u32>,
}

/// Writes the lives as CSV: `trial,step` and the experiment's columns, a line per step. Returns a line about them.
///
/// A value that single precision can hold is written with the digits that single precision needs.
pub(crate) fn replay(
    plan: &Plan<'_>,
    directory: &Directory,
    which: Which,
    out: &mut dyn Write,
) -> Result<String, Error> {
    let path = directory.lineage();
    let Ancestry { identity, lineage } = records::read(&path, plan, directory.path())?;
    identity.same_values(&plan.identity(), &path)?;
    let finished = lineage.latest();
    let generation = which.generation.unwrap_or(finished.saturating_sub(1));
    let Some(&best) = lineage.selected(generation).and_then(<[u32]>::first) else {
        return Err(Error::Usage(format!(
            "{}: generation {generation} of {finished} finished ones (the first is 0)",
            directory.path().display()
        )));
    };
    let individual = which.individual.unwrap_or(best);
    let genes = lineage
        .genome_of(generation, individual as usize)
        .map_err(|error| Error::Usage(format!("generation {generation}: {error}")))?;
    let mut setup = plan.setup()?;
    if genes.len() != setup.genes() {
        return Err(Error::damaged(&path, "its genomes are not those of the experiment"));
    }
    let trials = 0..setup.trials() as u32;
    let trials = match which.trial {
        None => trials,
        Some(trial) if trials.contains(&trial) => trial..trial + 1,
        Some(trial) => {
            return Err(Error::Usage(format!("trial {trial} of {} (the first is 0)", trials.end)));
        }
    };

    let mut table = csv::Writer::from_writer(out);
    let columns = setup.columns();
    let failed = |error: csv::Error| {
        let why = error.to_string();
        let source = match error.into_kind() {
            csv::ErrorKind::Io(source) => source,
            _ => io::Error::other(why),
        };
        Error::Io { doing: "write", path: "the replay".into(), source }
    };
    let head = ["trial", "step"].into_iter().map(str::to_owned).chain(columns.iter().cloned());
    table.write_record(head).map_err(failed)?;
    let mut outcomes: Vec<Outcome> = Vec::new();
    for trial in trials.clone() {
        let mut written = Ok(());
        let mut step = 0_u32;
        let mut row = |values: &[f64]| {
            if written.is_ok() {
                let fields = [trial.to_string(), step.to_string()].into_iter().chain(values.iter().map(|&x| digits(x)));
                written = table.write_record(fields);
            }
            step += 1;
        };
        let job = Job { seed: plan.seed, generation, individual, trial };
        outcomes.push(setup.live(&genes, job, &mut Tape::to(&mut row)));
        written.map_err(failed)?;
    }
    table.flush().map_err(|error| failed(error.into()))?;

    let finite = outcomes.iter().all(Outcome::is_finite);
    let fitness = if finite { Fitness::nan_as_failed(setup.fitness(&outcomes)) } else { Fitness::WORST };
    let what = which.trial.map_or_else(|| format!("{} trials", trials.len()), |trial| format!("trial {trial}"));
    let steps: u32 = outcomes.iter().map(|outcome| outcome.steps).sum();
    Ok(format!(
        "individual {individual} of generation {generation}, {what}: {steps} steps, fitness {:?}",
        fitness.get()
    ))
}

/// The shortest digits that read back as the same number in the precision that holds it.
fn digits(x: f64) -> String {
    let single = x as f32;
    if f64::from(single) == x { format!("{single:?}") } else { format!("{x:?}") }
}

/// Whether nobody reads the output any more, as after `| head`.
pub(crate) fn reader_left(error: &Error) -> bool {
    matches!(error, Error::Io { source, .. } if source.kind() == io::ErrorKind::BrokenPipe)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_in_the_precision_they_have() {
        assert_eq!(digits(f64::from(0.1_f32)), "0.1");
        assert_eq!(digits(0.1), "0.1");
        assert_eq!(digits(0.1 + 0.2), "0.30000000000000004");
        assert_eq!(digits(-0.0), "-0.0");
        assert_eq!(digits(f64::NAN), "NaN");
    }
}
