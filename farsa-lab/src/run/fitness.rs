//! The fitness of a generation: all trials of all individuals, and which of them failed.

use std::sync::atomic::{AtomicBool, AtomicU32, AtomicUsize, Ordering};

use farsa_evo::Fitness;
use farsa_num::Digest;

use crate::experiment::episode::EpisodeId;
use crate::experiment::evaluator::Evaluation;
use crate::experiment::outcome::Outcome;
use crate::run::contained::contained;
use crate::run::pool::{Pool, Unfinished};
use crate::run::progress::Progress;
use crate::store::failures::FailedEvaluation;

/// The opponents of a generation's evaluations, in their order, so many for each.
#[derive(Clone, Copy, Default)]
pub(crate) struct Opponents<'g> {
    pub(crate) parameters: &'g [&'g [f32]],
    pub(crate) each: usize,
}

/// After so many generations ranks compare again what they evaluate.
const COMPARED: u32 = 10;

impl<'g> Opponents<'g> {
    /// A fingerprint of individuals and those that they meet.
    fn fingerprint(&self, parameters: &[Vec<f32>]) -> u64 {
        let mut digest = Digest::new();
        let opponents = self.parameters.iter().copied();
        for row in parameters.iter().map(Vec::as_slice).chain(opponents) {
            digest.add_f32s(row);
        }
        digest.finish()
    }

    /// Those of the evaluation with a number.
    fn get(&self, number: usize) -> &'g [&'g [f32]] {
        self.parameters.get(number * self.each..(number + 1) * self.each).unwrap_or_default()
    }
}

/// Evaluates all trials of all individuals and says what fitness each comes to, and which failed.
///
/// A trial that failed makes its individual the worst, whatever comes of the others.
pub(crate) fn fitness_of_all(
    pool: &mut Pool<'_>,
    parameters: &[Vec<f32>],
    opponents: Opponents<'_>,
    of: EpisodeId,
    stop: &AtomicBool,
    progress: &Progress,
) -> Result<(Vec<Fitness>, Vec<FailedEvaluation>), Unfinished> {
    let (count, trials) = (parameters.len(), pool.evaluator().trials());
    let ended = AtomicUsize::new(0);
    let done = |_: Option<&Outcome>| {
        if (ended.fetch_add(1, Ordering::Relaxed) + 1).is_multiple_of(trials) {
            progress.advance();
        }
    };
    let mut outcomes = evaluate_all(pool, parameters, opponents, of, stop, done)?;
    let evaluator = pool.evaluator();
    let names = evaluator.terms();
    let (mut all, mut failed) = (Vec::with_capacity(count), Vec::new());
    for individual in 0..count {
        let own = outcomes.iter_mut().skip(individual).step_by(count).map(Option::take);
        let found = fitness_of(own, &names, &|outcomes| evaluator.fitness(outcomes));
        all.push(found.as_ref().map_or(Fitness::WORST, |fitness| *fitness));
        if let Err((trial, why)) = found {
            let (generation, individual) = (of.generation, individual as u32);
            failed.push(FailedEvaluation { generation, individual, trial, why });
        }
    }
    Ok((all, failed))
}

/// The fitness of an individual from its trials, or its first trial that failed and why.
fn fitness_of(
    trials: impl Iterator<Item = Option<Outcome>>,
    names: &[String],
    fitness: &dyn Fn(&[Outcome]) -> f64,
) -> Result<Fitness, (Option<u32>, String)> {
    let mut outcomes = Vec::new();
    for (trial, outcome) in (0..).zip(trials) {
        // Only what comes after a trial that failed is left out.
        let Some(outcome) = outcome else { return Err((Some(trial), "it was left out".into())) };
        if let Some(why) = outcome.why_failed(names) {
            return Err((Some(trial), why));
        }
        outcomes.push(outcome);
    }
    match contained(|| fitness(&outcomes)) {
        Ok(fitness) if fitness.is_finite() => Ok(Fitness::nan_as_failed(fitness)),
        Ok(fitness) => Err((None, format!("the fitness of its trials is {fitness}"))),
        Err(why) => Err((None, format!("its fitness panicked: {why}"))),
    }
}

/// Evaluates all trials of all individuals, the first of all before the second of any: trial t of individual i has number
/// t x individuals + i. `of.trial` and `of.individual` are set for each; `done` hears of every one that ends.
///
/// Episodes side by side cost least when they are alike. What an individual has left after the first of its trials that failed is
/// left out; those before it never are, so that it is the first on any number of threads.
pub(crate) fn evaluate_all(
    pool: &mut Pool<'_>,
    parameters: &[Vec<f32>],
    opponents: Opponents<'_>,
    of: EpisodeId,
    stop: &AtomicBool,
    done: impl Fn(Option<&Outcome>) + Sync,
) -> Result<Vec<Option<Outcome>>, Unfinished> {
    let (count, trials) = (parameters.len(), pool.evaluator().trials());
    if !pool.exchange().is_alone() {
        pool.exchange().compare_first_and_every(of.generation, COMPARED, || opponents.fingerprint(parameters));
    }
    let failed: Vec<AtomicU32> = parameters.iter().map(|_| AtomicU32::new(u32::MAX)).collect();
    let task = |number: usize| {
        let (individual, trial) = (number % count, (number / count) as u32);
        let id = EpisodeId { individual: individual as u32, trial, ..of };
        let alive = trial < failed[individual].load(Ordering::Relaxed);
        let opponents = opponents.get(number);
        let own = parameters.get(individual).filter(|_| alive);
        own.map(|parameters| Evaluation { number, parameters, opponents, id })
    };
    let heard = |number: usize, outcome: Option<&Outcome>| {
        if outcome.is_some_and(|outcome| !outcome.is_finite()) {
            failed[number % count].fetch_min((number / count) as u32, Ordering::Relaxed);
        }
        done(outcome);
    };
    pool.evaluate(count * trials, stop, task, heard)
}
