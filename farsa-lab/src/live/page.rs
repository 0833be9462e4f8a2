//! `farsa live`: a page that runs an agent by itself.

use std::collections::BTreeSet;
use std::path::Path;

use farsa_evo::Snapshot as _;
use farsa_view::{LivePage, View};
use serde::Serialize;

use crate::error::Error;
use crate::evaluation::replay::{Replayable, Which};
use crate::live::request::Trial;
use crate::live::script::{Evolved, Script};
use crate::live::session::{LiveSession, json};
use crate::run::config_file::MOST_BYTES;
use crate::run::laboratory::Laboratory;
use crate::run::plan::Plan;
use crate::store::bounded;
use crate::store::directory::Directory;
use crate::store::replace::write_page;

/// Most generations of a page.
const MOST_GENERATIONS: usize = 100;
/// Most steps of a trial that a page can compare with the run's.
const MOST_DIGESTS: usize = 100;

/// What the viewer is told of an agent before it runs.
#[derive(Debug, Serialize)]
struct About {
    /// Kinds of trials.
    trials: usize,
    individuals: Vec<AboutIndividual>,
}

#[derive(Debug, Serialize)]
struct AboutIndividual {
    generation: u32,
    individual: u32,
    trials: Vec<AboutTrial>,
}

/// What a trial of the run came to.
#[derive(Debug, Serialize)]
struct AboutTrial {
    steps: u32,
    fitness: f64,
    success: bool,
    /// Every how many steps there is a digest, and the digests up to the end.
    stride: usize,
    digests: Vec<u32>,
}

/// What a page was made of.
#[derive(Debug, Serialize)]
pub(crate) struct LiveSummary {
    directory: String,
    file: String,
    generations: Vec<u32>,
    bytes: usize,
    /// The same in a line of words.
    pub(crate) summary: String,
}

/// Writes a page in which the best individual of each of some generations, by default of the last, runs by `module`.
///
/// # Errors
/// Those of [`Replayable::find`], [`Error::Usage`] for an experiment that needs files and for too many generations, [`Error::Io`].
pub(crate) fn page(
    laboratory: &Laboratory<'_>,
    (plan, directory): (&Plan<'_>, &Directory),
    generations: &[u32],
    module: &[u8],
    path: &Path,
) -> Result<LiveSummary, Error> {
    if let Some(file) = plan.experiment.files(&plan.condition, &plan.settings)?.first() {
        return Err(Error::Usage(format!("a page has no files, and the run needs {}", file.display())));
    }
    let wanted: BTreeSet<Option<u32>> = generations.iter().copied().map(Some).collect();
    if wanted.len() > MOST_GENERATIONS {
        return Err(Error::Usage(format!("{} generations; a page holds {MOST_GENERATIONS} at most", wanted.len())));
    }
    let wanted = if wanted.is_empty() { BTreeSet::from([None]) } else { wanted };
    let (mut individuals, mut from_above) = (Vec::new(), false);
    for generation in wanted {
        let found = Replayable::find(plan, directory, Which { generation, ..Which::default() })?;
        from_above = found.schema().view == View::Top;
        let Replayable { generation, individual, parameters, opponents, normalisation, .. } = found;
        let normalisation = normalisation.map(|statistics| statistics.save());
        individuals.push(Evolved { generation, individual, parameters, opponents, normalisation });
    }
    let config = bounded::read_own_text(&directory.config(), MOST_BYTES)?;
    let generations = individuals.iter().map(|individual| individual.generation).collect();
    let script = Script { config, individuals };
    let text = json(&script)?;
    let about = json(&about(laboratory, &script, &text)?)?;
    let page = LivePage { title: plan.name(), from_above, module: module.into(), about, script: text };
    let html = page.html().map_err(|error| Error::Other(error.to_string()))?;
    write_page(path, &html)?;
    let (directory, file) = (directory.path().display().to_string(), path.display().to_string());
    let summary = format!("{file}: {} bytes, {} individuals of {directory}", html.len(), script.individuals.len());
    Ok(LiveSummary { directory, file, generations, bytes: html.len(), summary })
}

/// Runs every trial here, so that the page can compare its own.
fn about(laboratory: &Laboratory<'_>, script: &Script, text: &str) -> Result<About, Error> {
    let mut session = LiveSession::open(laboratory, text)?;
    let kinds = session.trials();
    let mut told = About { trials: kinds, individuals: Vec::new() };
    for (place, Evolved { generation, individual, .. }) in script.individuals.iter().enumerate() {
        let mut trials = Vec::new();
        for trial in 0..kinds as u32 {
            let found = session.film(place, Trial::Number(trial), "")?;
            let stride = found.digests.len().div_ceil(MOST_DIGESTS).max(1);
            let last = found.digests.len().saturating_sub(1);
            let kept = found.digests.iter().enumerate().filter(|(tick, _)| (tick + 1) % stride == 0 || *tick == last);
            let digests = kept.map(|(_, digest)| *digest).collect();
            let (steps, fitness, success) = (found.steps, found.fitness, found.success);
            trials.push(AboutTrial { steps, fitness, success, stride, digests });
        }
        told.individuals.push(AboutIndividual { generation: *generation, individual: *individual, trials });
    }
    Ok(told)
}
