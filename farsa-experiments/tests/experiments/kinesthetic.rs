//! A few iterations of `kinesthetic-grasp`: the arm is guided to a grasp, the network comes nearer to what its motors
//! should do, and both are the same for every caller.

use farsa_experiments::kinesthetic_grasp::{Config, KinestheticGrasp, Trainee, Training};
use farsa_experiments::reach_grasp_lift::Config as Reach;
use farsa_lab::advanced::{Genotype, Iteration, Learner, Value};
use farsa_lab::{EpisodeId, Error, Evaluation, Evaluator as _, Experiment as _, Settings, Task as _};

const SEED: u64 = 3;

/// Training small enough for a test.
fn trainee(demonstrations: u32, mixing: u32) -> Trainee {
    let training = Training { demonstrations, epochs: 6, batch: 2, mixing, ..Training::default() };
    Trainee::new(Config { training, ..Config::default() }).unwrap()
}

fn learner(trainee: &mut Trainee) -> &mut dyn Learner {
    trainee.learner().unwrap()
}

/// The genotype of the parameters.
fn genotype(trainee: &Trainee) -> Genotype {
    Genotype::new(&trainee.info().parameters, KinestheticGrasp.gene_bits())
}

/// The learned parameters in a state, as genes.
fn genes(trainee: &mut Trainee, state: &[f64]) -> Vec<u16> {
    let learned = learner(trainee).learned(state);
    genotype(trainee).encode(&learned).unwrap()
}

fn taught(trainee: &mut Trainee, iterations: u32) -> (Vec<f64>, Vec<Iteration>) {
    let learner = learner(trainee);
    let mut state = learner.initial_state(SEED);
    let iterations = (0..iterations).map(|generation| learner.iterate(&mut state, SEED, generation).unwrap()).collect();
    (state, iterations)
}

#[test]
fn guided_by_the_script_alone_every_demonstration_succeeds() {
    let (state, iterations) = taught(&mut trainee(8, 0), 3);
    println!("{iterations:?}");
    assert!(iterations.iter().all(|iteration| iteration.successes == 1.0), "{iterations:?}");
    assert!(iterations.iter().all(|iteration| iteration.after < iteration.before), "{iterations:?}");
    // Demonstrations are new in every iteration: what was learned holds for others, too.
    assert!(iterations[2].before < 0.7 * iterations[0].before, "{iterations:?}");
    assert!(state.iter().all(|word| word.is_finite()));
}

#[test]
fn an_iteration_depends_on_words_seed_and_generation_alone() {
    let (mut one, mut other) = (trainee(2, 1), trainee(2, 1));
    let (state, iterations) = taught(&mut one, 2);
    let (mut again, first) = taught(&mut other, 1);
    assert_eq!(iterations[0], first[0]);
    // Another iteration in between, and a trial.
    learner(&mut other).iterate(&mut again.clone(), 9, 5).unwrap();
    let parameters = genotype(&other).decode(&genes(&mut other, &again)).unwrap();
    let id = EpisodeId { seed: SEED, trial: 2, ..EpisodeId::default() };
    other.evaluate(Evaluation::new(&parameters, id), None);
    assert_eq!(learner(&mut other).iterate(&mut again, SEED, 1).unwrap(), iterations[1]);
    assert_eq!(again, state);
    assert!(learner(&mut other).iterate(&mut again[1..], SEED, 1).is_none());
}

#[test]
fn genes_are_the_parameters_to_half_a_unit() {
    let mut trainee = trainee(1, 0);
    let state = learner(&mut trainee).initial_state(SEED);
    let genes = genes(&mut trainee, &state);
    assert_eq!(genes.len(), trainee.info().parameters.len());
    let layout = Config::default().reach.layout();
    let unit = 40.0 / 65535.0;
    for (index, (gene, word)) in genes.iter().zip(&state).enumerate() {
        let gene = f64::from(*gene);
        // Weights of inputs in centimeters are learned in units of 10, those of labels in units of the label.
        let (found, exact) = match index / layout.hidden() {
            0..23 => (gene * unit - 20.0, *word),
            23..26 => (gene * unit - 20.0, word / 10.0),
            26..29 => (gene * unit - 20.0, word / 50.0),
            _ if index >= layout.parameter_count() - layout.hidden() => (gene / 65535.0 * unit, word * unit),
            _ => (gene * unit - 20.0, *word),
        };
        assert!((found - exact).abs() <= 0.501 * unit, "{index}: {found} is not {exact}");
    }
}

#[test]
fn the_network_is_the_mean_over_the_steps() {
    let after_an_iteration = |averaging| {
        let training = Training { demonstrations: 2, epochs: 6, batch: 2, averaging, ..Training::default() };
        let mut trainee = Trainee::new(Config { training, ..Config::default() }).unwrap();
        let (state, _) = taught(&mut trainee, 1);
        (trainee.info().parameters.len(), genes(&mut trainee, &state), state)
    };
    // The same is learned from what the script shows, and the network that is evaluated is another.
    let (count, latest, mut state) = after_an_iteration(1);
    let (_, mean, others) = after_an_iteration(50);
    assert_eq!(state[..count], others[..count]);
    let apart = latest.iter().zip(&mean).filter(|(latest, mean)| latest != mean).count();
    assert!(apart > count / 2, "{apart} of {count}");
    // It is the one with the last parameters.
    let tail = state.len() - count;
    state[tail..].copy_from_slice(&others[others.len() - count..]);
    assert_eq!(genes(&mut trainee(2, 0), &state), mean);
}

#[test]
fn the_arm_is_guided_in_our_world_alone() {
    let mut settings = Settings::new(KinestheticGrasp.settings("")).unwrap();
    assert_eq!(Config::read(&settings).unwrap(), Config::default());
    settings.set("", "lessons.batch", Value::Whole(7)).unwrap();
    assert_eq!(Config::read(&settings).unwrap().training.batch, 7);
    settings.set("", "world.engine", Value::Word("rapier".into())).unwrap();
    let refused = KinestheticGrasp.prepare("", &settings).err().unwrap();
    assert!(matches!(&refused, Error::Setting { .. }), "{refused}");
    assert_eq!(Reach::default().hidden, 12);
}
