//! `farsa replay`: a trial of the run again, step by step.

use std::fmt::Write as _;
use std::io::{self, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};

use farsa_body::Recorder;
use farsa_evo::ObservationStatistics;
use farsa_view::{Page, Recording, Schema, Table};
use serde::Serialize;

use crate::error::Error;
use crate::evaluation::memory_budget::MemoryUse;
use crate::evaluation::replayed::{self, InWords, Replayed, run_in_words};
use crate::evaluation::trial_changes::TrialChanges;
use crate::evaluation::trials::{came_to, facts, fitness, success, why_failed};
use crate::experiment::Anatomy;
use crate::experiment::disturbances::Disturbances;
use crate::experiment::episode::EpisodeId;
use crate::experiment::evaluator::{Bodies, Evaluation, Evaluator};
use crate::experiment::intervention::Intervention;
use crate::experiment::outcome::Outcome;
use crate::figures::significant::{remark, scored};
use crate::run::catch_panic::catch_printed_panic;
use crate::run::plan::Plan;
use crate::run::record_file::history;
use crate::store::directory::Directory;
use crate::strategy::any_strategy::Genome;
use crate::strategy::history::History;
use crate::strategy::opponents;

/// Which trials of an individual.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) enum TrialSelector {
    #[default]
    All,
    /// The one of this number.
    Number(u32),
    /// The one that earns most.
    Best,
}

/// Selection of trials. Individuals are numbered through all populations.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Selection {
    /// Generation. By default the champion's, or with an individual the last finished one.
    pub(crate) generation: Option<u32>,
    /// Individual. By default the best of the first population.
    pub(crate) individual: Option<u32>,
    /// Which of its trials.
    pub(crate) trial: TrialSelector,
}

/// Where an individual of a run is.
pub(crate) struct LocatedIndividual<'p> {
    pub(crate) history: History<'p>,
    /// File that the history is from.
    pub(crate) path: PathBuf,
    pub(crate) generation: u32,
    /// Counted through all populations.
    pub(crate) individual: u32,
}

impl<'p> LocatedIndividual<'p> {
    /// Looks for an individual of a run.
    ///
    /// # Errors
    /// [`Error::Usage`] for one that the run does not have, [`Error::File`], [`Error::Usage`] and whatever
    /// keeps the run of another version from being replayed.
    pub(crate) fn new(plan: &'p Plan<'_>, directory: &Directory, which: Selection) -> Result<Self, Error> {
        let (identity, history, path) = history(plan, directory)?;
        identity.same_values(&plan.identity()?, &path)?;
        let finished = history.finished();
        if finished == 0 {
            return Err(Error::damaged(&path, "no generation is finished yet"));
        }
        let by_default = match which.individual {
            None => history.champion_generation(),
            Some(_) => finished.saturating_sub(1),
        };
        let generation = which.generation.unwrap_or(by_default);
        let Some(best) = history.champion(0, generation) else {
            return Err(Error::Usage(format!(
                "{}: generation {generation} of {finished} finished ones (the first is 0)",
                directory.path().display()
            )));
        };
        let individual = which.individual.unwrap_or(best as u32);
        let individuals = history.populations() * history.size();
        if individual as usize >= individuals {
            return Err(Error::Usage(format!(
                "generation {generation}: individual {individual} of a population of {individuals}"
            )));
        }
        Ok(Self { history, path, generation, individual })
    }
}

/// An individual of a run, with all that a replay needs.
pub(crate) struct Replayable {
    pub(crate) evaluator: Box<dyn Evaluator>,
    pub(crate) genome: Genome,
    pub(crate) parameters: Vec<f32>,
    /// For every trial that was asked for.
    pub(crate) opponents: Vec<Vec<Vec<f32>>>,
    pub(crate) normalisation: Option<ObservationStatistics>,
    /// Change of the controller.
    intervention: Option<Intervention>,
    /// Bodies that are moved or pushed, with their numbers in the world.
    disturbances: Disturbances,
    seed: u64,
    pub(crate) generation: u32,
    pub(crate) individual: u32,
    /// Trials that were asked for.
    pub(crate) trials: Range<u32>,
}

impl Replayable {
    /// Finds an individual of a run and rebuilds its genes.
    ///
    /// # Errors
    /// [`Error::Usage`] for one that the run does not have, [`Error::File`], [`Error::Usage`] and whatever
    /// keeps the run of another version from being replayed.
    pub(crate) fn find(plan: &Plan<'_>, directory: &Directory, which: Selection) -> Result<Self, Error> {
        Self::rebuilt(plan, &LocatedIndividual::new(plan, directory, which)?, which.trial)
    }

    /// Gets the champions of a run, one of each population.
    ///
    /// # Errors
    /// As for [`find`](Self::find).
    pub(crate) fn champions(plan: &Plan<'_>, directory: &Directory) -> Result<Vec<Self>, Error> {
        let mut located = LocatedIndividual::new(plan, directory, Selection::default())?;
        let populations = 0..located.history.populations();
        let best = populations.filter_map(|population| located.history.champion(population, located.generation));
        let best: Vec<usize> = best.collect();
        let rebuilt = |individual: usize| {
            located.individual = individual as u32;
            Self::rebuilt(plan, &located, TrialSelector::All)
        };
        best.into_iter().map(rebuilt).collect()
    }

    /// Rebuilds the genes of an individual, for some of its trials.
    fn rebuilt(plan: &Plan<'_>, found: &LocatedIndividual<'_>, trial: TrialSelector) -> Result<Self, Error> {
        let LocatedIndividual { history, path, generation, individual } = found;
        let (generation, individual) = (*generation, *individual);
        let genes = history.genomes(&[(generation, individual as usize)])?;
        let evaluator = plan.evaluator()?;
        let genotype = plan.genotype(evaluator.as_ref());
        let others = || Error::damaged(path, "its genomes are not those of the experiment");
        let genome = genes.into_iter().next().ok_or_else(others)?;
        let parameters = genome.decode(&genotype).ok_or_else(others)?;
        let trials = 0..evaluator.info().trials as u32;
        let trials = match trial {
            TrialSelector::All | TrialSelector::Best => trials,
            TrialSelector::Number(trial) if trials.contains(&trial) => trial..trial + 1,
            TrialSelector::Number(trial) => {
                return Err(Error::Usage(format!("trial {trial} of {} (the first is 0)", trials.end)));
            }
        };
        let met =
            opponents::opponents_of(history, generation, individual as usize, trials.clone(), evaluator.info().trials)?;
        let decoded = |genes: &Vec<Genome>| genes.iter().map(|genes| genes.decode(&genotype)).collect::<Option<_>>();
        let opponents = met.iter().map(decoded).collect::<Option<_>>().ok_or_else(others)?;
        let normalisation = history.normalisation(generation).cloned();
        let seed = plan.seed;
        let mut replayable = Self {
            evaluator,
            genome,
            parameters,
            opponents,
            normalisation,
            intervention: None,
            disturbances: Disturbances::default(),
            seed,
            generation,
            individual,
            trials,
        };
        if trial == TrialSelector::Best {
            replayable.keep_best()?;
        }
        Ok(replayable)
    }

    /// Keeps the trial that earns most, the first of those that do.
    fn keep_best(&mut self) -> Result<(), Error> {
        let mut best: Option<(f64, u32)> = None;
        for trial in self.trials.clone() {
            let outcome = self.evaluate(trial, None)?;
            let fitness = self.fitness(std::slice::from_ref(&outcome));
            if best.is_none_or(|(other, _)| fitness > other) {
                best = Some((fitness, trial));
            }
        }
        if let Some((_, trial)) = best {
            let index = (trial - self.trials.start) as usize;
            self.opponents = self.opponents.drain(..).skip(index).take(1).collect();
            self.trials = trial..trial + 1;
        }
        Ok(())
    }

    /// Changes the controller and moves bodies in all trials that are replayed later.
    ///
    /// # Errors
    /// Errors of [`parts`], [`Anatomy::intervention`](crate::advanced::Anatomy::intervention) and [`Disturbances::in_world`].
    fn change(&mut self, plan: &Plan<'_>, changes: &TrialChanges) -> Result<(), Error> {
        let list = changes.lesion.as_ref();
        let parsed = |list: &String| parts(self.evaluator.as_ref(), plan)?.intervention(list);
        self.intervention = list.map(parsed).transpose()?;
        let name = plan.experiment.name();
        self.disturbances = changes.disturbances.in_world(self.evaluator.as_ref(), name, &self.schema())?;
        Ok(())
    }

    /// Builds the schema of its recordings.
    pub(crate) fn schema(&self) -> Schema {
        let with = |bodies: &dyn Bodies| bodies.schema_with(&self.parameters);
        self.evaluator.bodies().map_or_else(|| self.evaluator.info().schema, with)
    }

    /// Replays one of the trials that were asked for.
    ///
    /// # Errors
    /// [`Error::Other`] if the trial panics. The panic is printed with the user's backtrace setting.
    pub(crate) fn run(&mut self, trial: u32, recorder: &mut dyn Recorder) -> Result<Outcome, Error> {
        self.evaluate(trial, Some(recorder))
    }

    fn evaluate(&mut self, trial: u32, recorder: Option<&mut dyn Recorder>) -> Result<Outcome, Error> {
        let id = EpisodeId { seed: self.seed, generation: self.generation, individual: self.individual, trial };
        let opponents = self.opponents.get((trial - self.trials.start) as usize).map_or(&[][..], Vec::as_slice);
        let opponents: Vec<&[f32]> = opponents.iter().map(Vec::as_slice).collect();
        let (normalisation, intervention) = (self.normalisation.as_ref(), self.intervention.as_ref());
        let plain = Evaluation::new(&self.parameters, id);
        let Disturbances { moves: displacements, pushes } = &self.disturbances;
        let changed = Evaluation { intervention, displacements, pushes, ..plain };
        let evaluation = Evaluation { opponents: &opponents, normalisation, ..changed };
        let (generation, individual) = (self.generation, self.individual);
        let panicked =
            |()| Error::Other(format!("trial {trial} of individual {individual} of generation {generation} panicked"));
        catch_printed_panic(|| self.evaluator.evaluate(evaluation, recorder)).map_err(panicked)
    }

    /// Computes the fitness of the replayed trials.
    pub(crate) fn fitness(&self, outcomes: &[Outcome]) -> f64 {
        fitness(self.evaluator.as_ref(), outcomes)
    }

    /// The outcomes of the replayed trials, in the order of the requested ones.
    pub(crate) fn summary(&self, plan: &Plan<'_>, directory: &Directory, outcomes: &[Outcome]) -> ReplaySummary {
        ReplaySummary {
            directory: directory.path().display().to_string(),
            experiment: plan.experiment.name().into(),
            condition: plan.condition.clone(),
            seed: self.seed,
            generation: self.generation,
            individual: self.individual,
            trials: self.replayed(outcomes),
            steps: outcomes.iter().map(|outcome| outcome.steps).sum(),
            fitness: self.fitness(outcomes),
            success: self.success(outcomes),
            combined: self.evaluator.info().combined(),
            lesion: None,
        }
    }

    /// Summarizes each selected trial.
    fn replayed(&self, outcomes: &[Outcome]) -> Vec<ReplayedTrial> {
        let trials = self.trials.clone().zip(outcomes).map(|(trial, outcome)| ReplayedTrial {
            trial,
            steps: outcome.steps,
            fitness: self.fitness(std::slice::from_ref(outcome)),
            success: success(self.evaluator.as_ref(), outcome),
            failure: why_failed(self.evaluator.as_ref(), outcome),
        });
        trials.collect()
    }

    /// Checks if all trials succeeded. `None` for a task without a criterion of success.
    fn success(&self, outcomes: &[Outcome]) -> Option<bool> {
        let each = outcomes.iter().map(|outcome| success(self.evaluator.as_ref(), outcome));
        each.collect::<Option<Vec<_>>>().map(|each| each.into_iter().all(|success| success))
    }

    /// Summarizes the trials with these changes.
    fn lesioned(&self, changes: &TrialChanges, outcomes: &[Outcome]) -> Lesioned {
        let success = self.success(outcomes);
        Lesioned { list: changes.in_words(), trials: self.replayed(outcomes), fitness: self.fitness(outcomes), success }
    }
}

/// Gets the parts of the controller of a plan's experiment that can be changed.
///
/// # Errors
/// [`Error::Usage`] if none can be.
pub(crate) fn parts(evaluator: &dyn Evaluator, plan: &Plan<'_>) -> Result<Anatomy, Error> {
    evaluator.info().anatomy.ok_or_else(|| {
        let experiment = plan.experiment.name();
        Error::Usage(format!("--lesion: experiment `{experiment}` has no controller that can be changed"))
    })
}

/// Which trials were replayed and their outcomes. The fitness of a failed trial is no number in JSON.
#[derive(Debug, Serialize)]
pub(crate) struct ReplaySummary {
    directory: String,
    experiment: String,
    condition: String,
    seed: u64,
    generation: u32,
    individual: u32,
    trials: Vec<ReplayedTrial>,
    /// Steps of all trials.
    steps: u32,
    /// Fitness of the selected trials: that of the individual if all are selected.
    pub(crate) fitness: f64,
    /// True if all trials succeeded. `None` for a task without a criterion of success.
    success: Option<bool>,
    /// Combination of all trials of the individual into its fitness.
    #[serde(skip)]
    combined: String,
    /// The same trials with changes, where that was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    lesion: Option<Lesioned>,
}

/// Trials with a list of changes.
#[derive(Debug, Serialize)]
struct Lesioned {
    list: String,
    trials: Vec<ReplayedTrial>,
    fitness: f64,
    success: Option<bool>,
}

#[derive(Debug, Serialize)]
struct ReplayedTrial {
    trial: u32,
    steps: u32,
    /// Fitness of this trial alone.
    fitness: f64,
    success: Option<bool>,
    /// Why it failed, if it did.
    #[serde(skip_serializing_if = "Option::is_none")]
    failure: Option<String>,
}

/// Lists the trials that broke down with the reasons, each after a semicolon.
fn failures(trials: &[ReplayedTrial]) -> String {
    let failure =
        |trial: &ReplayedTrial| Some(format!("; trial {} broke down: {}", trial.trial, trial.failure.as_ref()?));
    trials.iter().filter_map(failure).collect()
}

impl InWords for ReplaySummary {
    /// A line, and one for the same with changes.
    fn text(&self) -> String {
        let Self { generation, individual, trials, steps, fitness, combined, lesion, .. } = self;
        let is_combined = trials.len() > 1 && fitness.is_finite();
        let combined = if is_combined { remark(combined) } else { String::new() };
        let what = match trials.as_slice() {
            [ReplayedTrial { trial, .. }] => format!("trial {trial}"),
            trials => format!("{} trials", trials.len()),
        };
        let individual = format!("individual {individual} of generation {generation}");
        let mut text =
            format!("{individual}, {what}: {steps} steps, {}{combined}{}", scored(*fitness), failures(trials));
        if let Some(Lesioned { list, trials, fitness, .. }) = lesion {
            let steps = trials.iter().map(|trial| trial.steps).sum::<u32>();
            // Writing into a string cannot fail.
            let _ = write!(text, "\nwith {list}: {steps} steps, {}{}", scored(*fitness), failures(trials));
        }
        text
    }
}

/// Writes the trials as CSV, one line per step. `out` opens the output after the trials were found. With
/// `changes`, the changed trials are written and both are summarized.
pub(crate) fn replay<W: Write>(
    plan: &Plan<'_>,
    directory: &Directory,
    which: Selection,
    changes: Option<&TrialChanges>,
    out: impl FnOnce() -> Result<W, Error>,
) -> Result<Replayed<ReplaySummary>, Error> {
    let mut replayable = Replayable::find(plan, directory, which)?;
    let mut intact = None;
    if let Some(changes) = changes {
        let trials = replayable.trials.clone();
        let outcomes = trials.map(|trial| replayable.evaluate(trial, None)).collect::<Result<Vec<_>, _>>()?;
        replayable.change(plan, changes)?;
        intact = Some((changes, outcomes));
    }
    let failed = |source: io::Error| Error::Io { doing: "write", path: "the replay".into(), source };
    let mut table = Table::new(out()?, &replayable.schema()).map_err(failed)?;
    let mut outcomes = Vec::new();
    let mut ended = Ok(());
    for trial in replayable.trials.clone() {
        table.begin(trial);
        match replayable.run(trial, &mut table) {
            Ok(outcome) => outcomes.push(outcome),
            Err(error) => {
                ended = Err(error);
                break;
            }
        }
    }
    // The steps before a panic are worth having.
    table.finish().map_err(failed)?;
    ended?;
    let replay = match intact {
        None => replayable.summary(plan, directory, &outcomes),
        Some((changes, intact)) => {
            let lesion = Some(replayable.lesioned(changes, &outcomes));
            ReplaySummary { lesion, ..replayable.summary(plan, directory, &intact) }
        }
    };
    Ok(Replayed::new(replay, None))
}

/// Writes a page for a browser with the trials, and the same selection of another run or with `changes`. The best trial
/// of each comes first, and the best of both are side by side.
pub(crate) fn page(
    plan: &Plan<'_>,
    directory: &Directory,
    which: Selection,
    changes: Option<&TrialChanges>,
    compare: Option<(&Plan<'_>, &Directory)>,
    path: &Path,
) -> Result<Replayed<ReplaySummary>, Error> {
    replayed::page((plan, directory), compare, "", path, |page, plan, directory| {
        let mut replayable = Replayable::find(plan, directory, which)?;
        let run = run_in_words(plan);
        let mut memory = MemoryUse::new(plan.limits);
        let (mut films, outcomes) = films(&mut replayable, &run, &mut memory)?;
        films.sort_by(|one, other| other.fitness.total_cmp(&one.fitness));
        let order: Vec<u32> = films.iter().map(|film| film.trial).collect();
        add(page, films);
        let mut summary = replayable.summary(plan, directory, &outcomes);
        if let Some(changes) = changes {
            replayable.change(plan, changes)?;
            let whose = format!("with {}; {run}", changes.in_words());
            let (mut changed, outcomes) = self::films(&mut replayable, &whose, &mut memory)?;
            // The intact trials.
            changed.sort_by_key(|film| order.iter().position(|trial| *trial == film.trial));
            page.open_beside(page.episodes());
            add(page, changed);
            summary.lesion = Some(replayable.lesioned(changes, &outcomes));
        }
        Ok(summary)
    })
}

/// A trial of a page.
struct FilmedTrial {
    trial: u32,
    fitness: f64,
    name: String,
    facts: Vec<(String, String)>,
    recording: Recording,
}

/// Runs and records the selected trials. `whose` ends their names.
fn films(
    replayable: &mut Replayable,
    whose: &str,
    kept: &mut MemoryUse,
) -> Result<(Vec<FilmedTrial>, Vec<Outcome>), Error> {
    let (mut outcomes, mut films) = (Vec::new(), Vec::new());
    for trial in replayable.trials.clone() {
        let mut recording = kept.recording(replayable.schema());
        let outcome = replayable.run(trial, &mut recording)?;
        kept.add(&recording)?;
        let Replayable { generation, individual, .. } = *replayable;
        // The differences come first, because a narrow screen cuts the rest.
        let came = came_to(replayable.evaluator.as_ref(), &outcome);
        let name = format!("trial {trial}: {came}; {whose}, generation {generation}, individual {individual}");
        let facts = facts(replayable.evaluator.as_ref(), &outcome);
        let fitness = replayable.fitness(std::slice::from_ref(&outcome));
        films.push(FilmedTrial { trial, fitness, name, facts, recording });
        outcomes.push(outcome);
    }
    Ok((films, outcomes))
}

fn add(page: &mut Page, films: Vec<FilmedTrial>) {
    for FilmedTrial { name, facts, recording, .. } in films {
        page.add(&name, facts, recording);
    }
}

/// Checks whether the reader closed the output, as in `| head`.
pub(crate) fn reader_left(error: &Error) -> bool {
    matches!(error, Error::Io { source, .. } if source.kind() == io::ErrorKind::BrokenPipe)
}
