//! Trials of a test, and their outcomes in numbers and words.

use farsa_evo::Fitness;
use farsa_view::readable;

use crate::experiment::episode::EpisodeId;
use crate::experiment::evaluator::Evaluator;
use crate::experiment::outcome::{Note, Outcome};
use crate::run::plan::MAX_SEED;

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

/// Returns success and fitness of a trial as text.
pub(crate) fn came_to(evaluator: &dyn Evaluator, outcome: &Outcome) -> String {
    let success = if outcome.success { "success" } else { "no success" };
    format!("{success}, {}", readable(fitness(evaluator, std::slice::from_ref(outcome))))
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
    let summary = [
        ("fitness of the trial alone".to_owned(), readable(fitness)),
        ("success".to_owned(), if outcome.success { "yes" } else { "no" }.to_owned()),
        ("steps".to_owned(), outcome.steps.to_string()),
    ];
    summary.into_iter().chain(terms).chain(notes).collect()
}
