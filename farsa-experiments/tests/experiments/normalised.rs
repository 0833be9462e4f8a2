//! Normalised observations in every experiment whose controllers observe something, alone and in lanes.

use farsa_evo::ObservationStatistics;
use farsa_evo::words::randomize;
use farsa_lab::advanced::{Genotype, Lanes, Value};
use farsa_lab::{EpisodeId, Evaluation, Evaluator, Experiment, Outcome, Settings};
use farsa_num::{Domain, Instructions, Stream};

const TRIALS: u32 = 11;

/// Parameters of random genes, others for each number.
fn random(experiment: &dyn Experiment, evaluator: &dyn Evaluator, number: u32) -> Vec<f32> {
    let genotype = Genotype::new(&evaluator.info().parameters, experiment.gene_bits());
    let mut genes = vec![0; genotype.genes()];
    randomize(&mut genes, &mut Stream::new(5, Domain::InitialGenome, 0, number, 0));
    for gene in &mut genes {
        *gene &= genotype.largest();
    }
    genotype.decode(&genes).unwrap()
}

/// Checks an experiment under a condition, and returns the number of channels that its controllers observe. `None` for several
/// populations.
fn check(experiment: &dyn Experiment, condition: &str) -> Option<usize> {
    let mut settings = Settings::new(experiment.settings(condition)).unwrap();
    // Some have no such setting, or need more.
    let _ = settings.set("", "trial.steps", Value::Whole(60));
    let mut evaluator = experiment.prepare(condition, &settings).unwrap();
    let channels = evaluator.info().observations;
    if channels == 0 || evaluator.info().populations.len() > 1 {
        return None;
    }
    let name = experiment.name();
    let parameters: Vec<Vec<f32>> = (0..TRIALS).map(|number| random(experiment, evaluator.as_ref(), number)).collect();
    let id = |trial| EpisodeId { seed: 3, generation: 1, individual: 0, trial };
    let mut run = |trial: u32, normalisation| {
        let plain = Evaluation::new(&parameters[trial as usize], id(trial));
        evaluator.evaluate(Evaluation { normalisation, ..plain }, None)
    };
    let nothing = ObservationStatistics::new(channels).unwrap();
    let (mut all, mut terms) = (nothing.clone(), Vec::new());
    for trial in 0..TRIALS {
        let plain = run(trial, None);
        assert!(plain.is_finite() && plain.observed.is_none(), "{name}: {plain:?}");
        // Nothing has been observed yet: the same trial, with the observations in its outcome.
        let mut first = run(trial, Some(&nothing));
        let observed = first.observed.take().unwrap();
        assert_eq!(first, plain, "{name}");
        let steps = u64::from(plain.steps);
        // The step in which a pole falls is not in balance. Every robot of a team observes.
        let made = if name == "double-pole" { steps + 1 } else { steps };
        assert!(made > 1 && observed.count() >= made && observed.count().is_multiple_of(made), "{name}");
        all.merge(&observed).unwrap();
        terms.push(plain.terms);
    }
    let other = ObservationStatistics::new(channels + 1).unwrap();
    assert!(!run(0, Some(&other)).is_finite(), "{name}: other channels");
    let normalised: Vec<Outcome> = (0..TRIALS).map(|trial| run(trial, Some(&all))).collect();
    assert!(normalised.iter().all(|outcome| outcome.is_finite() && outcome.observed.is_some()), "{name}");
    // An agent with other numbers acts otherwise, and observes something else where that depends on its actions.
    let mut again = nothing.clone();
    for outcome in &normalised {
        again.merge(outcome.observed.as_ref().unwrap()).unwrap();
    }
    let otherwise = normalised.iter().zip(&terms).any(|(one, terms)| one.terms != *terms);
    assert!(again != all || otherwise, "{name}");
    if let Some(lanes) = evaluator.in_lanes() {
        lanes.use_lanes(Lanes::new(8, Instructions::detect()).unwrap()).unwrap();
        let evaluation = |number: u32| Evaluation {
            number: number as usize,
            normalisation: Some(&all),
            ..Evaluation::new(&parameters[number as usize], id(number))
        };
        let (mut rest, mut found) = ((0..TRIALS).map(evaluation), vec![None; TRIALS as usize]);
        lanes.run_in_lanes(&mut || rest.next(), &mut |number, outcome| found[number] = Some(outcome));
        assert!(found.into_iter().eq(normalised.into_iter().map(Some)), "{name}: in lanes");
    }
    Some(channels)
}

#[test]
fn every_controller_that_observes_can_be_given_normalised_observations() {
    let mut found = Vec::new();
    for experiment in farsa_experiments::all() {
        let conditions = experiment.conditions();
        for condition in conditions.iter().copied().chain(conditions.is_empty().then_some("")) {
            if let Some(channels) = check(experiment, condition) {
                found.push((experiment.name(), channels));
            }
        }
    }
    found.dedup();
    for expected in [
        ("aggregation", 13),
        ("body-evolution", 6),
        ("discrimination", 6),
        ("discrimination-cylinders", 8),
        ("discrimination-cylinders", 6),
        ("double-pole", 6),
        ("double-pole", 3),
        ("foraging", 14),
        ("icub-reach", 3),
        ("minimal-cognition", 7),
        ("reach-grasp-lift", 29),
        ("reach-grasp-lift", 26),
    ] {
        assert!(found.contains(&expected), "{expected:?} is none of {found:?}");
    }
}
