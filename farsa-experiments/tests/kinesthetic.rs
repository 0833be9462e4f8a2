//! A few lessons of `kinesthetic-grasp`: the arm is led to a grasp, the network comes nearer to what its motors should do, and
//! both are the same whoever asks.
#![allow(missing_docs, clippy::unwrap_used)]

use farsa_experiments::KinestheticGrasp;
use farsa_experiments::kinesthetic_grasp::{Config, Lessons, Trainee};
use farsa_experiments::reach_grasp_lift::Config as Reach;
use farsa_lab::{
    EpisodeId, Error, Evaluation, Evaluator as _, Experiment as _, Genotype, Learner, Lesson, Settings, Task as _,
    Value,
};

const SEED: u64 = 3;

/// Lessons small enough for a test.
fn trainee(demonstrations: u32, own_say: u32) -> Trainee {
    let lessons = Lessons { demonstrations, passes: 6, batch: 2, own_say, ..Lessons::default() };
    Trainee::new(Config { lessons, ..Config::default() }).unwrap()
}

fn learner(trainee: &mut Trainee) -> &mut dyn Learner {
    trainee.learner().unwrap()
}

fn taught(trainee: &mut Trainee, lessons: u32) -> (Vec<f64>, Vec<Lesson>) {
    let learner = learner(trainee);
    let mut words = learner.first_words(SEED);
    let lessons = (0..lessons).map(|generation| learner.lesson(&mut words, SEED, generation).unwrap()).collect();
    (words, lessons)
}

#[test]
fn led_by_the_script_alone_every_demonstration_succeeds() {
    let (words, lessons) = taught(&mut trainee(8, 0), 3);
    println!("{lessons:?}");
    assert!(lessons.iter().all(|lesson| lesson.successes == 1.0), "{lessons:?}");
    assert!(lessons.iter().all(|lesson| lesson.after < lesson.before), "{lessons:?}");
    // Demonstrations are new in every lesson: what was learned holds for others, too.
    assert!(lessons[2].before < 0.7 * lessons[0].before, "{lessons:?}");
    assert!(words.iter().all(|word| word.is_finite()));
}

#[test]
fn a_lesson_depends_on_words_seed_and_generation_alone() {
    let (mut one, mut other) = (trainee(2, 1), trainee(2, 1));
    let (words, lessons) = taught(&mut one, 2);
    let (mut again, first) = taught(&mut other, 1);
    assert_eq!(lessons[0], first[0]);
    // Another lesson in between, and a trial.
    learner(&mut other).lesson(&mut again.clone(), 9, 5).unwrap();
    let genes = learner(&mut other).learned(&again);
    let parameters = Genotype::new(&other.parameters(), KinestheticGrasp.gene_bits()).decode(&genes).unwrap();
    let id = EpisodeId { seed: SEED, trial: 2, ..EpisodeId::default() };
    other.evaluate(Evaluation { number: 0, parameters: &parameters, opponents: &[], id }, None);
    assert_eq!(learner(&mut other).lesson(&mut again, SEED, 1).unwrap(), lessons[1]);
    assert_eq!(again, words);
    assert!(learner(&mut other).lesson(&mut again[1..], SEED, 1).is_none());
}

#[test]
fn genes_are_the_parameters_to_half_a_unit() {
    let mut trainee = trainee(1, 0);
    let words = learner(&mut trainee).first_words(SEED);
    let genes = learner(&mut trainee).learned(&words);
    assert_eq!(genes.len(), trainee.parameters().len());
    let layout = Config::default().reach.layout();
    let unit = 40.0 / 65535.0;
    for (index, (gene, word)) in genes.iter().zip(&words).enumerate() {
        let gene = f64::from(*gene);
        // Weights of what is told in centimetres are learned in units of 10, those of labels in units of the label.
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
fn who_lives_is_the_mean_over_the_steps() {
    let after_a_lesson = |mean| {
        let lessons = Lessons { demonstrations: 2, passes: 6, batch: 2, mean, ..Lessons::default() };
        let mut trainee = Trainee::new(Config { lessons, ..Config::default() }).unwrap();
        let (words, _) = taught(&mut trainee, 1);
        (trainee.parameters().len(), learner(&mut trainee).learned(&words), words)
    };
    // The same is learned from what the script shows, and the one that lives is another.
    let (count, latest, mut words) = after_a_lesson(1);
    let (_, mean, others) = after_a_lesson(50);
    assert_eq!(words[..count], others[..count]);
    let apart = latest.iter().zip(&mean).filter(|(latest, mean)| latest != mean).count();
    assert!(apart > count / 2, "{apart} of {count}");
    // It is the one whose parameters stand last.
    let tail = words.len() - count;
    words[tail..].copy_from_slice(&others[others.len() - count..]);
    assert_eq!(learner(&mut trainee(2, 0)).learned(&words), mean);
}

#[test]
fn the_arm_is_led_in_our_world_alone() {
    let mut settings = Settings::new(KinestheticGrasp.settings("")).unwrap();
    assert_eq!(Config::read(&settings).unwrap(), Config::default());
    settings.set("", "lessons.batch", Value::Whole(7)).unwrap();
    assert_eq!(Config::read(&settings).unwrap().lessons.batch, 7);
    settings.set("", "world.engine", Value::Word("rapier".into())).unwrap();
    let refused = KinestheticGrasp.prepare("", &settings).err().unwrap();
    assert!(matches!(&refused, Error::Setting { .. }), "{refused}");
    assert_eq!(Reach::default().hidden, 12);
}
