//! Fitness of a generation from the trials of all individuals.

use std::sync::atomic::{AtomicBool, AtomicU32, AtomicUsize, Ordering};

use farsa_evo::{EvoError, ObservationStatistics, ScoreShape, Scores};
use farsa_num::Digest;

use crate::error::Error;
use crate::experiment::episode::EpisodeId;
use crate::experiment::evaluator::{Evaluation, Evaluator};
use crate::experiment::outcome::Outcome;
use crate::run::catch_panic::catch_panic;
use crate::run::evaluation_backend::{EvaluationBackend, Unfinished};
use crate::store::failures::FailedEvaluation;

/// Opponents of a generation's evaluations, in order, with the same number for each.
#[derive(Clone, Copy, Default)]
pub(crate) struct Opponents<'g> {
    pub(crate) parameters: &'g [&'g [f32]],
    pub(crate) each: usize,
    /// Number of opponents that take turns, for a strategy with fitness against each of them.
    pub(crate) told_apart: Option<usize>,
}

/// A generation to evaluate.
#[derive(Clone, Copy)]
pub(crate) struct Generation<'g> {
    /// Parameters of every individual.
    pub(crate) parameters: &'g [Vec<f32>],
    pub(crate) opponents: Opponents<'g>,
    /// Observation statistics of the previous generations, where observations are normalized.
    pub(crate) normalisation: Option<&'g ObservationStatistics>,
    /// Seed, generation, and the number of the first individual. The other numbers and the trial are set for each evaluation.
    pub(crate) id: EpisodeId,
    /// Flag that ends running trials.
    pub(crate) stop: Option<&'static AtomicBool>,
}

/// Scores of a generation.
pub(crate) struct Judged {
    pub(crate) judgements: Scores,
    pub(crate) failed: Vec<FailedEvaluation>,
    /// The observation statistics of the generation, without failed individuals, where observations are normalized. Individuals
    /// and trials are added in order.
    pub(crate) observed: Option<ObservationStatistics>,
}

impl Generation<'_> {
    /// Returns a fingerprint of the individuals, their opponents and the normalization.
    fn fingerprint(&self) -> u64 {
        let mut digest = Digest::new();
        let opponents = self.opponents.parameters.iter().copied();
        for row in self.parameters.iter().map(Vec::as_slice).chain(opponents) {
            digest.add_f32s(row);
        }
        if let Some(statistics) = self.normalisation {
            digest.add_u64(statistics.count());
            digest.add_f64s(statistics.mean());
            digest.add_f64s(statistics.squares());
        }
        digest.finish()
    }
}

impl<'g> Opponents<'g> {
    /// Returns the opponents of the evaluation with a number.
    pub(crate) fn get(&self, number: usize) -> &'g [&'g [f32]] {
        self.parameters.get(number * self.each..(number + 1) * self.each).unwrap_or_default()
    }
}

/// Evaluates all trials of all individuals and returns their scores and the failures. `advance` is called after each individual.
///
/// A failed trial makes its individual the worst, whatever its other trials return.
pub(crate) fn judgements_of_all(
    by: &mut dyn EvaluationBackend,
    batch: Generation<'_>,
    shape: ScoreShape,
    advance: &(dyn Fn() + Sync),
) -> Result<Judged, Unfinished> {
    let trials = by.info().trials;
    let ended = AtomicUsize::new(0);
    let done = |_: Option<&Outcome>| {
        if (ended.fetch_add(1, Ordering::Relaxed) + 1).is_multiple_of(trials) {
            advance();
        }
    };
    let individuals = individuals(by, batch, shape, done)?;
    let (mut all, mut failed) = (Vec::with_capacity(individuals.len() * shape.width()), Vec::new());
    let empty =
        |before: &ObservationStatistics| ObservationStatistics::new(before.channels()).map_err(|error| other(&error));
    let mut observed = batch.normalisation.map(empty).transpose()?;
    for (individual, found) in (batch.id.individual..).zip(individuals) {
        match found {
            Ok((mut row, outcomes)) => {
                all.append(&mut row);
                if let Some(observed) = &mut observed {
                    add_observed(observed, &outcomes)?;
                }
            }
            Err((trial, why)) => {
                all.extend((0..shape.width()).map(|_| f64::NAN));
                failed.push(FailedEvaluation { generation: batch.id.generation, individual, trial, why });
            }
        }
    }
    let judgements = Scores::nan_as_failed(shape, all).map_err(|error| other(&error))?;
    Ok(Judged { judgements, failed, observed })
}

/// Evaluates all trials of all individuals. Returns the scores and trials of each, or its first failed trial with the reason.
/// `done` is called after each trial.
pub(crate) fn individuals(
    by: &mut dyn EvaluationBackend,
    batch: Generation<'_>,
    shape: ScoreShape,
    done: impl Fn(Option<&Outcome>) + Sync,
) -> Result<Vec<Result<Individual, FailedTrial>>, Unfinished> {
    let count = batch.parameters.len();
    let mut outcomes = run_generation(by, batch, done)?;
    let (evaluator, names) = (by.evaluator(), &by.info().terms);
    let row = |outcomes: &[Outcome]| row(evaluator, shape, batch.opponents.told_apart, outcomes);
    let scores =
        |individual| judged(outcomes.iter_mut().skip(individual).step_by(count).map(Option::take), names, &row);
    Ok((0..count).map(scores).collect())
}

/// Converts an error of farsa-evo.
fn other(error: &EvoError) -> Error {
    Error::Other(error.to_string())
}

/// Adds the observations in the trials of an individual.
///
/// # Errors
/// [`Error::Other`] for an outcome without observations, or with other channels.
fn add_observed(all: &mut ObservationStatistics, trials: &[Outcome]) -> Result<(), Error> {
    for outcome in trials {
        let Some(own) = &outcome.observed else {
            let why = "observations are to be normalised, and an outcome does not say what was observed";
            return Err(Error::Other(why.into()));
        };
        all.merge(own).map_err(|error| Error::Other(format!("what was observed: {error}")))?;
    }
    Ok(())
}

/// Lists the objectives, the fitness first, and then the measures of an individual. With opponents in turn, the other
/// objectives are the fitness against each.
fn row(
    evaluator: &dyn Evaluator,
    shape: ScoreShape,
    told_apart: Option<usize>,
    trials: &[Outcome],
) -> Result<Vec<f64>, String> {
    let fitness = evaluator.fitness(trials);
    if !fitness.is_finite() {
        return Err(format!("the fitness of its trials is {fitness}"));
    }
    let mut row = vec![fitness];
    if let Some(count) = told_apart {
        for opponent in 0..count {
            let own: Vec<Outcome> = trials.iter().skip(opponent).step_by(count).cloned().collect();
            let fitness = evaluator.fitness(&own);
            if !fitness.is_finite() {
                return Err(format!("the fitness of its trials against opponent {opponent} is {fitness}"));
            }
            row.push(fitness);
        }
    } else if let Some(behaviour) = evaluator.behavior().filter(|_| shape != ScoreShape::FITNESS) {
        let names: Vec<String> = behaviour
            .objectives()
            .into_iter()
            .chain(behaviour.measures().into_iter().map(|measure| measure.name))
            .collect();
        let described = behaviour.describe(trials);
        let (expected, found) = (names.len(), described.len());
        if expected != found {
            return Err(format!("its behaviour is described by {found} numbers where {expected} are named"));
        }
        if let Some((name, x)) = names.iter().zip(&described).find(|(_, x)| !x.is_finite()) {
            return Err(format!("`{name}` of its behaviour is {x}"));
        }
        // A strategy may use fewer objectives than there are. It uses all measures or none.
        let objectives = behaviour.objectives().len();
        row.extend(described.iter().take(objectives.min(shape.objectives.saturating_sub(1))));
        row.extend(described.iter().skip(objectives).take(shape.measures));
    }
    let (expected, found) = (shape.width(), row.len());
    if expected == found { Ok(row) } else { Err(format!("{found} numbers where the strategy wants {expected}")) }
}

/// A function from the trials of an individual to its scores.
type Row<'r> = dyn Fn(&[Outcome]) -> Result<Vec<f64>, String> + 'r;

/// Scores of an individual, and its trials.
pub(crate) type Individual = (Vec<f64>, Vec<Outcome>);

/// First failed trial of an individual, with the reason. `None` for a failure of the fitness.
pub(crate) type FailedTrial = (Option<u32>, String);

/// Returns the scores of an individual, or its first failed trial with the reason.
fn judged(
    trials: impl Iterator<Item = Option<Outcome>>,
    names: &[String],
    row: &Row<'_>,
) -> Result<Individual, FailedTrial> {
    let mut outcomes = Vec::new();
    for (trial, outcome) in (0..).zip(trials) {
        // Only trials after a failed trial are left out.
        let Some(outcome) = outcome else { return Err((Some(trial), "it was left out".into())) };
        if let Some(why) = outcome.why_failed(names) {
            return Err((Some(trial), why));
        }
        outcomes.push(outcome);
    }
    match catch_panic(|| row(&outcomes)) {
        Ok(row) => row.map(|row| (row, outcomes)).map_err(|why| (None, why)),
        Err(why) => Err((None, format!("its fitness panicked: {why}"))),
    }
}

/// Evaluates all trials of all individuals, trial by trial: trial t of individual i has number t x individuals + i. `done` is
/// called after each of them.
///
/// Episodes in lanes are fastest when they are alike, so the same trial of several individuals runs together. Trials after the
/// first failed trial of an individual are left out. Earlier trials never are, so that the first failure does not depend on the
/// number of threads.
pub(crate) fn run_generation(
    by: &mut dyn EvaluationBackend,
    batch: Generation<'_>,
    done: impl Fn(Option<&Outcome>) + Sync,
) -> Result<Vec<Option<Outcome>>, Unfinished> {
    let Generation { parameters, opponents, normalisation, id, stop } = batch;
    let (count, trials) = (parameters.len(), by.info().trials);
    by.compare(id.generation, &|| batch.fingerprint());
    let failed: Vec<AtomicU32> = parameters.iter().map(|_| AtomicU32::new(u32::MAX)).collect();
    let task = |number: usize| {
        let (individual, trial) = (number % count, (number / count) as u32);
        let id = EpisodeId { individual: id.individual + individual as u32, trial, ..id };
        let alive = trial < failed[individual].load(Ordering::Relaxed);
        let opponents = opponents.get(number);
        let own = parameters.get(individual).filter(|_| alive);
        own.map(|parameters| Evaluation { number, opponents, normalisation, stop, ..Evaluation::new(parameters, id) })
    };
    let heard = |number: usize, outcome: Option<&Outcome>| {
        if outcome.is_some_and(|outcome| !outcome.is_finite()) {
            failed[number % count].fetch_min((number / count) as u32, Ordering::Relaxed);
        }
        done(outcome);
    };
    by.evaluate(count * trials, &task, &heard)
}
