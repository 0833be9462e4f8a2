//! Trials that a caller steps are those of the evaluator: with the recorded actions, all observations and results are equal.

use farsa_body::Recorder;
use farsa_experiments::reach_grasp_lift::ReachGraspLift;
use farsa_experiments::{ANT, BRAITENBERG, DISCRIMINATION, FORAGING, GO1_JOYSTICK, HOPPER, PREDATOR_PREY, all};
use farsa_lab::advanced::{Lanes, StepResult, Value};
use farsa_lab::{EpisodeId, Evaluation, Evaluator, Experiment, Outcome, Settings};

/// Sensors and outputs of each step.
#[derive(Default)]
struct Steps(Vec<Vec<f32>>, Vec<Vec<f32>>);

impl Recorder for Steps {
    fn sensors(&mut self, x: &[f32]) {
        self.0.push(x.to_vec());
    }
    fn outputs(&mut self, y: &[f32]) {
        self.1.push(y.to_vec());
    }
    fn tick(&mut self, _: f64) {}
}

fn prepared(experiment: &dyn Experiment, steps: Option<(&str, i64)>) -> Box<dyn Evaluator> {
    let condition = experiment.conditions().first().copied().unwrap_or_default();
    let mut settings = Settings::new(experiment.settings(condition)).unwrap();
    if let Some((key, steps)) = steps {
        settings.set("", key, Value::Whole(steps)).unwrap();
    }
    experiment.prepare(condition, &settings).unwrap()
}

#[test]
fn recorded_actions_repeat_trials_in_one_world_and_in_lanes() {
    for (experiment, steps) in [
        (&DISCRIMINATION as &dyn Experiment, ("trial.steps", 60)),
        (&BRAITENBERG, ("trial.steps", 40)),
        (&HOPPER, ("episode.steps", 60)),
        (&ANT, ("episode.steps", 30)),
        (&GO1_JOYSTICK, ("episode.steps", 30)),
        (&ReachGraspLift, ("trial.steps", 20)),
    ] {
        let name = experiment.name();
        let mut evaluator = prepared(experiment, Some(steps));
        let middle =
            evaluator.info().parameters.iter().map(|p| (0.4 * p.ends[0] + 0.6 * p.ends[1]) as f32).collect::<Vec<_>>();
        // Trials that lanes run in another order and repeat.
        let ids = [0, 3, 1].map(|generation| EpisodeId { seed: 5, generation, ..EpisodeId::default() });
        let recorded = ids.map(|id| {
            let mut steps = Steps::default();
            let outcome = evaluator.evaluate(Evaluation::new(&middle, id), Some(&mut steps));
            (steps, outcome)
        });
        for lanes in [1, 8] {
            let lanes = Lanes::new(lanes, Lanes::best().instructions()).unwrap();
            let mut stepper = prepared(experiment, Some(steps)).into_stepper(lanes).unwrap();
            let ([inputs, outputs], worlds) = (stepper.channels(), stepper.worlds());
            assert_eq!(worlds, lanes.count());
            // Each world has its own trial, and begins the next when it ends.
            let mut trials: Vec<usize> = (0..worlds).map(|world| world % ids.len()).collect();
            let (mut at, mut sums) = (vec![0; worlds], vec![0.0; worlds]);
            let (mut actions, mut observations) = (vec![0.0; worlds * outputs], vec![0.0; worlds * inputs]);
            let mut results = vec![StepResult::default(); worlds];
            for (world, row) in observations.chunks_exact_mut(inputs).enumerate() {
                assert!(stepper.start(world, ids[trials[world]], row), "{name}");
                assert_eq!(row, recorded[trials[world]].0.0[0], "{name}");
            }
            let mut ended = 0;
            while ended < 2 * ids.len() {
                for (world, row) in actions.chunks_exact_mut(outputs).enumerate() {
                    row.copy_from_slice(&recorded[trials[world]].0.1[at[world]]);
                }
                stepper.step(&actions, &mut results, &mut observations);
                for world in 0..worlds {
                    let (steps, outcome) = &recorded[trials[world]];
                    let row = &mut observations[world * inputs..(world + 1) * inputs];
                    (at[world], sums[world]) = (at[world] + 1, sums[world] + results[world].reward);
                    assert_eq!(results[world].is_last(), at[world] == steps.0.len(), "{name} {world}");
                    assert!(!results[world].failed, "{name} {world}");
                    if !results[world].is_last() {
                        assert_eq!(row, steps.0[at[world]], "{name} {world}");
                        continue;
                    }
                    assert_same(outcome, &stepper.outcome(world));
                    // No term of a short trial is above its cap.
                    let fitness: f64 = outcome.terms.iter().sum();
                    assert!((sums[world] - fitness).abs() <= 1e-9 * fitness.abs().max(1.0), "{name}: {fitness}");
                    (ended, at[world], sums[world]) = (ended + 1, 0, 0.0);
                    trials[world] = (trials[world] + 1) % ids.len();
                    assert!(stepper.start(world, ids[trials[world]], row), "{name}");
                    assert_eq!(row, recorded[trials[world]].0.0[0], "{name}");
                }
            }
        }
    }
}

fn assert_same(one: &Outcome, other: &Outcome) {
    assert_eq!((&one.terms, one.steps, one.success), (&other.terms, other.steps, other.success));
    assert_eq!(one.notes, other.notes);
}

#[test]
fn a_world_that_has_ended_rests_until_its_next_start() {
    let mut stepper = prepared(&HOPPER, Some(("episode.steps", 3))).into_stepper(Lanes::one()).unwrap();
    let [inputs, outputs] = stepper.channels();
    let (actions, mut row, mut results) = (vec![0.5; outputs], vec![0.0; inputs], [StepResult::default()]);
    // No step before the first start.
    stepper.step(&actions, &mut results, &mut row);
    assert!(results[0] == StepResult::default() && row.iter().all(|x| *x == 0.0));
    stepper.start(0, EpisodeId::default(), &mut row);
    for step in 1..=3 {
        stepper.step(&actions, &mut results, &mut row);
        assert_eq!((results[0].truncated, results[0].terminated), (step == 3, false));
    }
    let last = row.clone();
    stepper.step(&actions, &mut results, &mut row);
    assert!(results[0] == StepResult::default() && row == last);
    // Actions beyond the range are its ends.
    let mut after = |action: f32| {
        stepper.start(0, EpisodeId::default(), &mut row);
        stepper.step(&vec![action; outputs], &mut results, &mut row);
        row.clone()
    };
    assert!(after(7.0) == after(1.0) && after(-f32::INFINITY) == after(0.0) && after(0.0) != after(1.0));
}

#[test]
fn experiments_that_cannot_be_stepped_say_why() {
    let why = |experiment: &dyn Experiment| {
        let error = prepared(experiment, None).into_stepper(Lanes::one()).err().map(|error| error.to_string());
        error.unwrap_or_default()
    };
    assert_eq!(why(&FORAGING), "this experiment cannot be stepped: it has 10 robots, and an action is for one");
    assert!(why(&PREDATOR_PREY).contains("it has 2 populations"), "{}", why(&PREDATOR_PREY));
    let stepped = all().into_iter().filter(|experiment| experiment.name() != "push-box" && why(*experiment).is_empty());
    assert!(stepped.count() >= 11);
}
