//! `farsa live`: a page that runs an agent by itself.

use std::collections::BTreeSet;
use std::path::Path;

use farsa_view::{LivePage, View};
use serde::Serialize;

use crate::error::Error;
use crate::live::champion::champion;
use crate::live::request::Film;
use crate::live::row::Row;
use crate::live::script::{Evolved, Script};
use crate::live::session::{LiveSession, json};
use crate::live::standing::Standing;
use crate::run::begin;
use crate::run::config_file::MAX_BYTES;
use crate::run::laboratory::Laboratory;
use crate::run::plan::Plan;
use crate::run::record_file::RunRecord;
use crate::run::records::Checkpoint;
use crate::store::bounded;
use crate::store::directory::Directory;
use crate::store::replace::write_page;

/// Most generations of a page.
const MOST_GENERATIONS: usize = 100;
/// Most steps of a trial that a page can compare with the run's.
const MOST_DIGESTS: usize = 100;

/// Most generations of the run whose fitness a page shows.
const MOST_HISTORY: usize = 400;
/// Most bytes of where a run stands in a page that can go on with it.
const MOST_STANDING: usize = 400_000;

/// What the viewer is told of an agent before it runs.
#[derive(Debug, Serialize)]
struct About {
    /// Kinds of trials.
    trials: usize,
    /// Whether bodies can be put elsewhere.
    displaces: bool,
    pushes: bool,
    /// The robots of which any can be recorded.
    robots: Vec<String>,
    /// Of several populations, their names.
    populations: Vec<String>,
    individuals: Vec<AboutIndividual>,
    /// Generations of the run with the fitness of their best and their mean.
    history: Vec<Row>,
    /// Why evolution cannot go on in the page, if it cannot.
    standstill: Option<String>,
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

/// What a page is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Use {
    /// A file, in which evolution goes on.
    File,
    /// A server that tells what the run comes to.
    Served,
}

/// A page and what is in it.
pub(crate) struct Found {
    pub(crate) html: String,
    generations: Vec<u32>,
}

/// Writes a page in which the best individual of each of some generations, by default the champion, runs by `module`.
///
/// # Errors
/// Those of [`html`], and [`Error::Io`].
pub(crate) fn page(
    laboratory: &Laboratory<'_>,
    (plan, directory): (&Plan<'_>, &Directory),
    generations: &[u32],
    module: &[u8],
    path: &Path,
) -> Result<LiveSummary, Error> {
    let Found { html, generations } = html(laboratory, (plan, directory), generations, module, Use::File)?;
    write_page(path, &html)?;
    let (directory, file) = (directory.path().display().to_string(), path.display().to_string());
    let summary = format!("{file}: {} bytes, {} individuals of {directory}", html.len(), generations.len());
    Ok(LiveSummary { directory, file, generations, bytes: html.len(), summary })
}

/// The page in which the best individual of each of some generations, by default the champion, runs by `module`.
///
/// # Errors
/// Those of [`champion`], [`Error::Usage`] for an experiment that needs files and for too many generations.
pub(crate) fn html(
    laboratory: &Laboratory<'_>,
    (plan, directory): (&Plan<'_>, &Directory),
    generations: &[u32],
    module: &[u8],
    used: Use,
) -> Result<Found, Error> {
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
        let (individual, view) = champion(plan, directory, generation)?;
        from_above = view == View::Top;
        individuals.push(individual);
    }
    let config = bounded::read_regular_text(&directory.config(), MAX_BYTES)?;
    let generations = individuals.iter().map(|individual| individual.generation).collect();
    let (history, standing) = run_so_far(plan, directory)?;
    let standing = match used {
        Use::File => standing,
        Use::Served => Err("the run goes on where it was started".into()),
    };
    let (standing, standstill) = standing.map_or_else(|why| (None, Some(why)), |standing| (Some(standing), None));
    let script = Script { config, individuals, standing: None };
    let text = json(&script)?;
    let about = json(&About { history, standstill, ..about(laboratory, &script, &text)? })?;
    let standing = standing.map(|standing| json(&standing)).transpose()?;
    let page = LivePage {
        title: plan.name(),
        from_above,
        module: module.into(),
        served: used == Use::Served,
        standing,
        about,
        script: text,
    };
    let html = page.html().map_err(|error| Error::Other(error.to_string()))?;
    Ok(Found { html, generations })
}

/// What a run has come to, and where it stands, or why evolution cannot go on from there in a page.
fn run_so_far(plan: &Plan<'_>, directory: &Directory) -> Result<(Vec<Row>, Result<Standing, String>), Error> {
    if !directory.checkpoint().is_file() {
        return Ok((Vec::new(), Err("no evolution has made these genotypes".into())));
    }
    let checkpoint = Checkpoint::read(plan, directory)?;
    let told = RunRecord::read(plan, directory, &checkpoint)?;
    let stride = told.lines.len().div_ceil(MOST_HISTORY).max(1);
    let last = told.lines.len().saturating_sub(1);
    let lines = told.lines.iter().enumerate().filter(|(at, _)| at % stride == 0 || *at == last);
    let lines = lines.map(|(at, line)| Row::new(at, line.row)).collect();
    let evaluator = plan.evaluator()?;
    let genotype = plan.genotype(evaluator.as_ref());
    let mut progression = begin::search_state(plan, directory, &checkpoint, &told, &genotype)?;
    let standing = Standing::of(&mut progression).ok_or("the strategy cannot save its state".to_owned());
    let bounded = |standing: Standing| match standing.size() {
        bytes if bytes > MOST_STANDING => {
            Err(format!("where the run stands takes {bytes} bytes, and a page has room for {MOST_STANDING}"))
        }
        _ => Ok(standing),
    };
    Ok((lines, standing.and_then(bounded)))
}

/// Runs every trial here, so that the page can compare its own.
fn about(laboratory: &Laboratory<'_>, script: &Script, text: &str) -> Result<About, Error> {
    let mut session = LiveSession::open(laboratory, text)?;
    let kinds = session.trials();
    let mut told = About {
        trials: kinds,
        displaces: session.displaces(),
        pushes: session.pushes(),
        robots: session.robots(),
        populations: session.populations(),
        individuals: Vec::new(),
        history: Vec::new(),
        standstill: None,
    };
    for (place, Evolved { generation, individual, .. }) in script.individuals.iter().enumerate() {
        let mut trials = Vec::new();
        for trial in 0..kinds as u32 {
            let found = session.film(&Film::of_run(place, trial))?;
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
