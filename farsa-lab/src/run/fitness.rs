//! What a generation comes to: all trials of all individuals, their fitness and behaviour, and which of them failed.

use std::sync::atomic::{AtomicU32, AtomicUsize, Ordering};

use farsa_evo::{EvoError, ObservationStatistics, ScoreShape, Scores};
use farsa_num::Digest;

use crate::error::Error;
use crate::experiment::episode::EpisodeId;
use crate::experiment::evaluator::{Evaluation, Evaluator};
use crate::experiment::outcome::Outcome;
use crate::run::catch_panic::catch_panic;
use crate::run::evaluation_backend::{EvaluationBackend, Unfinished};
use crate::store::failures::FailedEvaluation;

/// The opponents of a generation's evaluations, in their order, so many for each.
#[derive(Clone, Copy, Default)]
pub(crate) struct Opponents<'g> {
    pub(crate) parameters: &'g [&'g [f32]],
    pub(crate) each: usize,
    /// How many opponents are met in turn, where the strategy is told what was earned against each.
    pub(crate) told_apart: Option<usize>,
}

/// A generation that is evaluated.
#[derive(Clone, Copy)]
pub(crate) struct Generation<'g> {
    /// Those of every individual.
    pub(crate) parameters: &'g [Vec<f32>],
    pub(crate) opponents: Opponents<'g>,
    /// What was observed in the generations before, where observations are normalised.
    pub(crate) normalisation: Option<&'g ObservationStatistics>,
    /// Seed, generation, and the number of the first individual; the others' and the trial are set for each evaluation.
    pub(crate) id: EpisodeId,
}

/// What a generation comes to.
pub(crate) struct Judged {
    pub(crate) judgements: Scores,
    pub(crate) failed: Vec<FailedEvaluation>,
    /// What was observed in it, individual after individual and trial after trial, where observations are normalised; those of
    /// individuals that failed are left out.
    pub(crate) observed: Option<ObservationStatistics>,
}

impl Generation<'_> {
    /// A fingerprint of individuals, those that they meet, and what their observations are normalised by.
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
    /// Those of the evaluation with a number.
    pub(crate) fn get(&self, number: usize) -> &'g [&'g [f32]] {
        self.parameters.get(number * self.each..(number + 1) * self.each).unwrap_or_default()
    }
}

/// Evaluates all trials of all individuals and says what each comes to, as many numbers as are asked for, and which failed.
/// `advance` hears of every individual that ends.
///
/// A trial that failed makes its individual the worst, whatever comes of the others.
pub(crate) fn judgements_of_all(
    by: &mut dyn EvaluationBackend,
    of: Generation<'_>,
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
    let individuals = individuals(by, of, shape, done)?;
    let (mut all, mut failed) = (Vec::with_capacity(individuals.len() * shape.width()), Vec::new());
    let empty = |before: &ObservationStatistics| ObservationStatistics::new(before.channels()).map_err(other);
    let mut observed = of.normalisation.map(empty).transpose()?;
    for (individual, found) in (of.id.individual..).zip(individuals) {
        match found {
            Ok((mut row, outcomes)) => {
                all.append(&mut row);
                if let Some(observed) = &mut observed {
                    add_observed(observed, &outcomes)?;
                }
            }
            Err((trial, why)) => {
                all.extend((0..shape.width()).map(|_| f64::NAN));
                failed.push(FailedEvaluation { generation: of.id.generation, individual, trial, why });
            }
        }
    }
    let judgements = Scores::nan_as_failed(shape, all).map_err(other)?;
    Ok(Judged { judgements, failed, observed })
}

/// Evaluates all trials of all individuals and says what each comes to, by as many numbers as are asked for, with its trials, or
/// its first trial that failed and why. `done` hears of every trial that ends.
pub(crate) fn individuals(
    by: &mut dyn EvaluationBackend,
    of: Generation<'_>,
    shape: ScoreShape,
    done: impl Fn(Option<&Outcome>) + Sync,
) -> Result<Vec<Result<Individual, FailedTrial>>, Unfinished> {
    let count = of.parameters.len();
    let mut outcomes = run_generation(by, of, done)?;
    let (evaluator, names) = (by.evaluator(), &by.info().terms);
    let row = |outcomes: &[Outcome]| row(evaluator, shape, of.opponents.told_apart, outcomes);
    let one = |individual| judged(outcomes.iter_mut().skip(individual).step_by(count).map(Option::take), names, &row);
    Ok((0..count).map(one).collect())
}

/// An error of farsa-evo.
fn other(error: EvoError) -> Error {
    Error::Other(error.to_string())
}

/// Adds what was observed in the trials of an individual.
///
/// # Errors
/// [`Error::Other`] for an outcome that does not say it, or of other channels.
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

/// The objectives, the fitness first, and then the descriptor values of an individual, or what is wrong with them. Where
/// opponents are told apart, the objectives behind the fitness are that of the trials against each.
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
    } else if let Some(behaviour) = evaluator.behaviour().filter(|_| shape != ScoreShape::FITNESS) {
        let names: Vec<String> =
            behaviour.objectives().into_iter().chain(behaviour.descriptors().into_iter().map(|one| one.name)).collect();
        let described = behaviour.describe(trials);
        let (expected, found) = (names.len(), described.len());
        if expected != found {
            return Err(format!("its behaviour is described by {found} numbers where {expected} are named"));
        }
        if let Some((name, x)) = names.iter().zip(&described).find(|(_, x)| !x.is_finite()) {
            return Err(format!("`{name}` of its behaviour is {x}"));
        }
        // A strategy may want fewer objectives than there are, and wants all descriptor values or none.
        let objectives = behaviour.objectives().len();
        row.extend(described.iter().take(objectives.min(shape.objectives.saturating_sub(1))));
        row.extend(described.iter().skip(objectives).take(shape.measures));
    }
    let (expected, found) = (shape.width(), row.len());
    if expected == found { Ok(row) } else { Err(format!("{found} numbers where the strategy wants {expected}")) }
}

/// The numbers that an individual comes to by its trials, or what is wrong with them.
type Row<'r> = dyn Fn(&[Outcome]) -> Result<Vec<f64>, String> + 'r;

/// The numbers that an individual comes to, and its trials.
pub(crate) type Individual = (Vec<f64>, Vec<Outcome>);

/// The first trial of an individual that failed, if it is a trial, and why.
pub(crate) type FailedTrial = (Option<u32>, String);

/// What an individual comes to, or its first trial that failed and why.
fn judged(
    trials: impl Iterator<Item = Option<Outcome>>,
    names: &[String],
    row: &Row<'_>,
) -> Result<Individual, FailedTrial> {
    let mut outcomes = Vec::new();
    for (trial, outcome) in (0..).zip(trials) {
        // Only what comes after a trial that failed is left out.
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

/// Evaluates all trials of all individuals, the first of all before the second of any: trial t of individual i has number
/// t x individuals + i. `done` hears of every one that ends.
///
/// Episodes side by side cost least when they are alike. What an individual has left after the first of its trials that failed is
/// left out; those before it never are, so that it is the first on any number of threads.
pub(crate) fn run_generation(
    by: &mut dyn EvaluationBackend,
    of: Generation<'_>,
    done: impl Fn(Option<&Outcome>) + Sync,
) -> Result<Vec<Option<Outcome>>, Unfinished> {
    let Generation { parameters, opponents, normalisation, id } = of;
    let (count, trials) = (parameters.len(), by.info().trials);
    by.compare(id.generation, &|| of.fingerprint());
    let failed: Vec<AtomicU32> = parameters.iter().map(|_| AtomicU32::new(u32::MAX)).collect();
    let task = |number: usize| {
        let (individual, trial) = (number % count, (number / count) as u32);
        let id = EpisodeId { individual: id.individual + individual as u32, trial, ..id };
        let alive = trial < failed[individual].load(Ordering::Relaxed);
        let opponents = opponents.get(number);
        let own = parameters.get(individual).filter(|_| alive);
        own.map(|parameters| Evaluation { number, opponents, normalisation, ..Evaluation::new(parameters, id) })
    };
    let heard = |number: usize, outcome: Option<&Outcome>| {
        if outcome.is_some_and(|outcome| !outcome.is_finite()) {
            failed[number % count].fetch_min((number / count) as u32, Ordering::Relaxed);
        }
        done(outcome);
    };
    by.evaluate(count * trials, &task, &heard)
}
