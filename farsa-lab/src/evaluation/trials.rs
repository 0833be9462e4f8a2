//! Trials of a test, and their outcomes in numbers and words.

use farsa_evo::Fitness;
use farsa_view::readable;

use crate::experiment::episode::EpisodeId;
use crate::experiment::evaluator::Evaluator;
use crate::experiment::outcome::{NO_CRITERION, Note, Outcome};
use crate::run::plan::MAX_SEED;

/// Text of a mean or share over no trials.
pub(crate) const NO_VALUE: &str = "no value";

/// Returns the episode of a test trial, numbered through all trials, for the first individual. `kinds` is the
/// experiment's number of trials.
pub(crate) fn episode(trial: usize, kinds: usize, seed: u64) -> EpisodeId {
    let kinds = kinds.max(1);
    let (generation, trial) = ((trial / kinds) as u32, (trial % kinds) as u32);
    EpisodeId { seed: seed | !MAX_SEED, generation, individual: 0, trial }
}

/// Computes the fitness of trials. That of a failed trial is the worst.
pub(crate) fn fitness(evaluator: &dyn Evaluator, outcomes: &[Outcome]) -> f64 {
    let finite = outcomes.iter().all(Outcome::is_finite);
    let fitness = if finite { Fitness::nan_as_failed(evaluator.fitness(outcomes)) } else { Fitness::WORST };
    fitness.get()
}

/// Finds the reason for which a trial broke down.
pub(crate) fn why_failed(evaluator: &dyn Evaluator, outcome: &Outcome) -> Option<String> {
    outcome.why_failed(&evaluator.info().terms).or_else(|| {
        let fitness = evaluator.fitness(std::slice::from_ref(outcome));
        (!fitness.is_finite()).then(|| format!("its fitness is {fitness}"))
    })
}

/// Gets the success of a trial, `None` for a task without a criterion of success.
pub(crate) fn success(evaluator: &dyn Evaluator, outcome: &Outcome) -> Option<bool> {
    evaluator.info().has_success.then(|| outcome.success && why_failed(evaluator, outcome).is_none())
}

/// Returns success and fitness of a trial as text, or the reason for which it broke down.
pub(crate) fn came_to(evaluator: &dyn Evaluator, outcome: &Outcome) -> String {
    if let Some(why) = why_failed(evaluator, outcome) {
        return format!("broken down: {why}");
    }
    let fitness = readable(fitness(evaluator, std::slice::from_ref(outcome)));
    match success(evaluator, outcome) {
        Some(true) => format!("success, {fitness}"),
        Some(false) => format!("no success, {fitness}"),
        None => format!("fitness {fitness}"),
    }
}

/// Returns the outcome of a trial by name.
pub(crate) fn facts(evaluator: &dyn Evaluator, outcome: &Outcome) -> Vec<(String, String)> {
    let fitness = fitness(evaluator, core::slice::from_ref(outcome));
    let terms = evaluator.info().terms.into_iter().zip(outcome.terms.iter().map(|term| readable(*term)));
    let notes = outcome.notes.iter().map(|(name, note)| {
        let value = match note {
            Note::Number(x) => readable(*x),
            Note::Text(text) => text.clone(),
        };
        ((*name).to_owned(), value)
    });
    let why = why_failed(evaluator, outcome);
    let success = success(evaluator, outcome).map_or_else(|| NO_CRITERION.into(), |success| success.to_string());
    let summary = match why {
        Some(why) => [("broken down".to_owned(), why), ("fitness of the trial".to_owned(), NO_VALUE.into())],
        None => [("fitness of the trial".to_owned(), readable(fitness)), ("success".to_owned(), success)],
    };
    let steps = ("steps".to_owned(), outcome.steps.to_string());
    summary.into_iter().chain([steps]).chain(terms).chain(notes).collect()
}
