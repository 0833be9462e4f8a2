//! `farsa live`: an interactive page that runs an agent.

use std::collections::BTreeSet;
use std::path::Path;

use farsa_view::{LivePage, View};
use serde::Serialize;

use crate::error::Error;
use crate::experiment::settings::Value;
use crate::live::champion::champion;
use crate::live::page_run::{PageIndividual, PageRun};
use crate::live::request::EpisodeRequest;
use crate::live::row::Row;
use crate::live::run_state::RunState;
use crate::live::session::{LiveSession, json};
use crate::run::begin;
use crate::run::config_file::MAX_BYTES;
use crate::run::laboratory::Laboratory;
use crate::run::plan::Plan;
use crate::run::record_file::RunRecord;
use crate::run::records::Checkpoint;
use crate::store::bounded;
use crate::store::directory::Directory;
use crate::store::own_output::{refuse_other, write_outputs};
use crate::strategy::settings::GENERATIONS;

/// Steps of a trial at which a page compares its episode with the run's.
const DIGESTS_PER_TRIAL: usize = 100;
/// Points of the fitness curve of a page.
const CURVE_POINTS: usize = 400;
/// Most bytes of a run's state in a page.
const MAX_STATE_BYTES: usize = 400_000;

/// Description of an agent for the viewer.
#[derive(Debug, Serialize)]
struct About {
    /// Number of kinds of trials.
    trials: usize,
    /// True if bodies can be moved.
    displaces: bool,
    /// True if bodies can be pushed.
    pushes: bool,
    /// Names of the robots that can be recorded.
    robots: Vec<String>,
    /// Names of the populations, none of a single one.
    populations: Vec<String>,
    individuals: Vec<AboutIndividual>,
    /// Best and mean fitness of generations of the run.
    history: Vec<Row>,
    /// Reason why evolution cannot continue in the page, if it cannot.
    standstill: Option<String>,
    /// Name of the run at the server, part of the address of its events.
    #[serde(skip_serializing_if = "Option::is_none")]
    run: Option<String>,
}

#[derive(Debug, Serialize)]
struct AboutIndividual {
    generation: u32,
    individual: u32,
    trials: Vec<AboutTrial>,
}

/// Result of a trial of the run.
#[derive(Debug, Serialize)]
struct AboutTrial {
    steps: u32,
    fitness: f64,
    success: Option<bool>,
    /// Number of steps from one digest to the next.
    stride: usize,
    digests: Vec<u32>,
}

/// Content of a written page.
#[derive(Debug, Serialize)]
pub(crate) struct LiveSummary {
    directory: String,
    file: String,
    generations: Vec<u32>,
    bytes: usize,
    /// Summary as one line of text.
    pub(crate) summary: String,
}

/// Individuals of a page.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Chosen<'g> {
    /// Their generations, by default the champion's.
    pub(crate) generations: &'g [u32],
    /// Number in each generation, by default that of the best.
    pub(crate) individual: Option<u32>,
}

/// Purpose of a page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Use<'r> {
    /// A file in which evolution can continue.
    File,
    /// Page of `farsa serve`, which follows a run with this name at the server.
    Served { run: &'r str },
}

/// Text of a page and the generations in it.
pub(crate) struct PageText {
    pub(crate) html: String,
    generations: Vec<u32>,
}

/// Writes an interactive page of an individual of each generation given, by default of the champion.
///
/// # Errors
/// Errors of [`html`] and [`write_outputs`].
pub(crate) fn page(
    laboratory: &Laboratory<'_>,
    (plan, directory): (&Plan<'_>, &Directory),
    chosen: Chosen<'_>,
    module: &[u8],
    path: &Path,
) -> Result<LiveSummary, Error> {
    refuse_other(path)?;
    let PageText { html, generations } = html(laboratory, (plan, directory), chosen, module, Use::File)?;
    let bytes = write_outputs(&[(path.into(), html)])?;
    let (directory, file) = (directory.path().display().to_string(), path.display().to_string());
    let summary = format!("{file}: {bytes} bytes, {} individuals of {directory}", generations.len());
    Ok(LiveSummary { directory, file, generations, bytes, summary })
}

/// Returns the interactive page of an individual of each generation given, by default of the champion.
///
/// # Errors
/// Errors of [`champion`], and [`Error::Usage`] for an experiment that needs files.
pub(crate) fn html(
    laboratory: &Laboratory<'_>,
    (plan, directory): (&Plan<'_>, &Directory),
    Chosen { generations, individual }: Chosen<'_>,
    module: &[u8],
    used: Use<'_>,
) -> Result<PageText, Error> {
    if let Some(file) = plan.experiment.files(&plan.condition, &plan.settings)?.first() {
        return Err(Error::Usage(format!("a page cannot read files, and the run needs {}", file.display())));
    }
    let chosen: BTreeSet<Option<u32>> = generations.iter().copied().map(Some).collect();
    let chosen = if chosen.is_empty() { BTreeSet::from([None]) } else { chosen };
    let (mut individuals, mut from_above) = (Vec::new(), false);
    for generation in chosen {
        let (individual, view) = champion(plan, directory, [generation, individual])?;
        from_above = view == View::Top;
        individuals.push(individual);
    }
    let config = bounded::read_regular_text(&directory.config(), MAX_BYTES)?;
    let generations = individuals.iter().map(|individual| individual.generation).collect();
    let (history, state) = run_so_far(plan, directory)?;
    let (state, served) = match used {
        Use::File => (state, None),
        Use::Served { run } => (Err("the run continues in its own process".into()), Some(run.to_owned())),
    };
    let (state, standstill) = state.map_or_else(|why| (None, Some(why)), |state| (Some(state), None));
    let run = PageRun { config, individuals, newcomer: false, state: None };
    let script = json(&run)?;
    let about = json(&About { history, standstill, run: served.clone(), ..about(laboratory, &run, &script)? })?;
    let state = state.map(|state| json(&state)).transpose()?;
    let page = LivePage {
        title: plan.name(),
        from_above,
        module: module.into(),
        served: served.is_some(),
        state,
        about,
        script,
    };
    let html = page.html().map_err(|error| Error::Other(error.to_string()))?;
    Ok(PageText { html, generations })
}

/// Returns the fitness curve of a run, and its state or the reason why evolution cannot continue from it.
fn run_so_far(plan: &Plan<'_>, directory: &Directory) -> Result<(Vec<Row>, Result<RunState, String>), Error> {
    if !directory.checkpoint().is_file() {
        return Ok((Vec::new(), Err("these genotypes were not made by evolution".into())));
    }
    // One generation without variation, such as that of a vehicle wired by hand.
    if plan.settings.find("live", GENERATIONS).is_ok_and(|setting| setting.is_fixed_to(&Value::Whole(1))) {
        return Ok((Vec::new(), Err("nothing evolves in this experiment".into())));
    }
    let checkpoint = Checkpoint::read(plan, directory)?;
    let record = RunRecord::read(plan, directory, &checkpoint)?;
    let stride = record.lines.len().div_ceil(CURVE_POINTS).max(1);
    let last = record.lines.len().saturating_sub(1);
    let lines = record.lines.iter().enumerate().filter(|(at, _)| at % stride == 0 || *at == last);
    let lines = lines.map(|(at, line)| Row::new(at, line.row)).collect();
    let evaluator = plan.evaluator()?;
    let genotype = plan.genotype(evaluator.as_ref());
    let mut search = begin::search_state(plan, directory, &checkpoint, &record, &genotype)?;
    let state = RunState::of(&mut search).ok_or("the strategy cannot save its state".to_owned());
    let bounded = |state: RunState| match state.size() {
        bytes if bytes > MAX_STATE_BYTES => {
            Err(format!("the state of the run takes {bytes} bytes, and a page holds at most {MAX_STATE_BYTES}"))
        }
        _ => Ok(state),
    };
    Ok((lines, state.and_then(bounded)))
}

/// Runs every trial, so that the page can compare its own episodes.
fn about(laboratory: &Laboratory<'_>, run: &PageRun, script: &str) -> Result<About, Error> {
    let mut session = LiveSession::open(laboratory, script)?;
    let kinds = session.trials();
    let mut about = About {
        trials: kinds,
        displaces: session.displaces(),
        pushes: session.pushes(),
        robots: session.robots(),
        populations: session.populations(),
        individuals: Vec::new(),
        history: Vec::new(),
        standstill: None,
        run: None,
    };
    for (index, PageIndividual { generation, individual, .. }) in run.individuals.iter().enumerate() {
        let mut trials = Vec::new();
        for trial in 0..kinds as u32 {
            let episode = session.episode(&EpisodeRequest::of_run(index, trial))?;
            let stride = episode.digests.len().div_ceil(DIGESTS_PER_TRIAL).max(1);
            let last = episode.digests.len().saturating_sub(1);
            let compared =
                episode.digests.iter().enumerate().filter(|(tick, _)| (tick + 1) % stride == 0 || *tick == last);
            let digests = compared.map(|(_, digest)| *digest).collect();
            let (steps, fitness, success) = (episode.steps, episode.fitness, episode.success);
            trials.push(AboutTrial { steps, fitness, success, stride, digests });
        }
        about.individuals.push(AboutIndividual { generation: *generation, individual: *individual, trials });
    }
    Ok(about)
}
