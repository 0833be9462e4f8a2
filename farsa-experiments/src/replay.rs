//! `farsa replay`: a life of the run again, step by step.

use std::io::{self, Write};
use std::ops::Range;
use std::path::Path;

use farsa_body::Recorder;
use farsa_evo::Fitness;

use crate::directory::{Directory, create_result};
use crate::error::Error;
use crate::experiment::{Note, Outcome, Setup, Tape};
use crate::life::Job;
use crate::page::{Page, readable};
use crate::plan::Plan;
use crate::recording::Recording;
use crate::records::{self, Ancestry};
use crate::table::Table;

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

/// An individual of a run, with all that it needs to live again.
pub(crate) struct Relived {
    pub(crate) setup: Box<dyn Setup>,
    genes: Vec<u16>,
    seed: u64,
    pub(crate) generation: u32,
    pub(crate) individual: u32,
    /// The trials that were asked for.
    pub(crate) trials: Range<u32>,
}

impl Relived {
    /// Finds an individual of a run and rebuilds its genes.
    ///
    /// # Errors
    /// [`Error::Usage`] for one that the run does not have, [`Error::Damaged`], [`Error::OtherConfiguration`] and whatever
    /// keeps the run of another version from being lived again.
    pub(crate) fn find(plan: &Plan<'_>, directory: &Directory, which: Which) -> Result<Self, Error> {
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
        let setup = plan.setup()?;
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
        Ok(Self { setup, genes, seed: plan.seed, generation, individual, trials })
    }

    /// Lives one trial again.
    pub(crate) fn live(&mut self, trial: u32, recorder: &mut dyn Recorder) -> Outcome {
        let job = Job { seed: self.seed, generation: self.generation, individual: self.individual, trial };
        self.setup.live(&self.genes, job, &mut Tape::to(recorder))
    }

    /// What the trials that were lived earned, as a fitness.
    pub(crate) fn fitness(&self, outcomes: &[Outcome]) -> f64 {
        let finite = outcomes.iter().all(Outcome::is_finite);
        let fitness = if finite { Fitness::nan_as_failed(self.setup.fitness(outcomes)) } else { Fitness::WORST };
        fitness.get()
    }

    /// A line about the trials that were lived.
    fn summary(&self, outcomes: &[Outcome]) -> String {
        let Self { generation, individual, trials, .. } = self;
        let what =
            if trials.len() == 1 { format!("trial {}", trials.start) } else { format!("{} trials", trials.len()) };
        let steps: u32 = outcomes.iter().map(|outcome| outcome.steps).sum();
        let fitness = self.fitness(outcomes);
        format!("individual {individual} of generation {generation}, {what}: {steps} steps, fitness {fitness:?}")
    }
}

/// Writes the lives as CSV, a line per step. Returns a line about them.
pub(crate) fn replay(
    plan: &Plan<'_>,
    directory: &Directory,
    which: Which,
    out: &mut dyn Write,
) -> Result<String, Error> {
    let mut relived = Relived::find(plan, directory, which)?;
    let failed = |source: io::Error| Error::Io { doing: "write", path: "the replay".into(), source };
    let mut table = Table::new(out, &relived.setup.stage()).map_err(failed)?;
    let mut outcomes = Vec::new();
    for trial in relived.trials.clone() {
        table.begin(trial);
        outcomes.push(relived.live(trial, &mut table));
    }
    table.finish().map_err(failed)?;
    Ok(relived.summary(&outcomes))
}

/// Writes the lives, and those of the same choice in another run, as a page for a browser. Returns a line about them.
pub(crate) fn page(
    plan: &Plan<'_>,
    directory: &Directory,
    which: Which,
    compare: Option<(&Plan<'_>, &Directory)>,
    path: &Path,
) -> Result<String, Error> {
    let title = compare.map_or_else(|| plan.name(), |(other, _)| format!("{} and {}", plan.name(), other.name()));
    let mut page = Page::new(&title);
    let mut lines = Vec::new();
    for (plan, directory) in [(plan, directory)].into_iter().chain(compare) {
        let mut relived = Relived::find(plan, directory, which)?;
        let mut outcomes = Vec::new();
        for trial in relived.trials.clone() {
            let mut recording = Recording::new(relived.setup.stage());
            let outcome = relived.live(trial, &mut recording);
            let Relived { generation, individual, .. } = relived;
            // What tells lives apart comes first: a narrow screen cuts the rest.
            let run = [plan.condition.as_str(), "seed"].into_iter().find(|word| !word.is_empty()).unwrap_or_default();
            let name = format!("trial {trial}: {run} {}, generation {generation}, individual {individual}", plan.seed);
            page.add(&name, facts(&relived, &outcome), recording);
            outcomes.push(outcome);
        }
        lines.push(relived.summary(&outcomes));
    }
    let html = page.html();
    create_result(path)?.write_all(html.as_bytes()).map_err(Error::io("write", path))?;
    Ok(lines.join("\n"))
}

/// What came of a trial, by name.
fn facts(relived: &Relived, outcome: &Outcome) -> Vec<(String, String)> {
    let fitness = relived.fitness(core::slice::from_ref(outcome));
    let terms = relived.setup.terms().into_iter().zip(outcome.terms.iter().map(|term| readable(*term)));
    let notes = outcome.notes.iter().map(|(name, note)| {
        let value = match note {
            Note::Number(x) => readable(*x),
            Note::Text(text) => text.clone(),
        };
        ((*name).to_owned(), value)
    });
    let all = [
        ("fitness of the trial alone".to_owned(), readable(fitness)),
        ("success".to_owned(), if outcome.success { "yes" } else { "no" }.to_owned()),
        ("steps".to_owned(), outcome.steps.to_string()),
    ];
    all.into_iter().chain(terms).chain(notes).collect()
}

/// Whether nobody reads the output any more, as after `| head`.
pub(crate) fn reader_left(error: &Error) -> bool {
    matches!(error, Error::Io { source, .. } if source.kind() == io::ErrorKind::BrokenPipe)
}
