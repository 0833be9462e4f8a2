//! A few lessons of `kinesthetic-grasp`: the arm is led to a grasp, the network comes nearer to what its motors should do, and
//! both are the same whoever asks.
#![allow(missing_docs, clippy::unwrap_used)]

use farsa_experiments::kinesthetic_grasp::{Config, Lessons, Lives};
use farsa_experiments::reach_grasp_lift::Config as Reach;
use farsa_experiments::{Error, Experiment, Job, KinestheticGrasp, Lesson, Settings, Setup, Tape, Value};

const SEED: u64 = 3;

/// Lessons small enough for a test.
fn lives(demonstrations: u32, own_say: u32) -> Lives {
    let lessons = Lessons { demonstrations, passes: 6, batch: 2, own_say, ..Lessons::default() };
    Lives::new(Config { lessons, ..Config::default() }).unwrap()
}

fn taught(lives: &mut Lives, lessons: u32) -> (Vec<f64>, Vec<Lesson>) {
    let mut words = lives.first_words(SEED);
    let lessons = (0..lessons).map(|generation| lives.lesson(&mut words, SEED, generation).unwrap()).collect();
    (words, lessons)
}

#[test]
fn led_by_the_script_alone_every_demonstration_succeeds() {
    let (words, lessons) = taught(&mut lives(8, 0), 3);
    println!("{lessons:?}");
    assert!(lessons.iter().all(|lesson| lesson.successes == 1.0), "{lessons:?}");
    assert!(lessons.iter().all(|lesson| lesson.after < lesson.before), "{lessons:?}");
    // Demonstrations are new in every lesson: what was learned holds for others, too.
    assert!(lessons[2].before < 0.7 * lessons[0].before, "{lessons:?}");
    assert!(words.iter().all(|word| word.is_finite()));
}

#[test]
fn a_lesson_depends_on_words_seed_and_generation_alone() {
    let (mut one, mut other) = (lives(2, 1), lives(2, 1));
    let (words, lessons) = taught(&mut one, 2);
    let (mut again, first) = taught(&mut other, 1);
    assert_eq!(lessons[0], first[0]);
    // Another lesson in between, and a life.
    other.lesson(&mut again.clone(), 9, 5).unwrap();
    let genes = other.learned(&again);
    other.live(&genes, Job { seed: SEED, trial: 2, ..Job::default() }, &mut Tape::off());
    assert_eq!(other.lesson(&mut again, SEED, 1).unwrap(), lessons[1]);
    assert_eq!(again, words);
    assert!(other.lesson(&mut again[1..], SEED, 1).is_none());
}

#[test]
fn genes_are_the_parameters_to_half_a_unit() {
    let lives = lives(1, 0);
    let words = lives.first_words(SEED);
    let genes = lives.learned(&words);
    assert_eq!(genes.len(), lives.genes());
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
        let mut lives = Lives::new(Config { lessons, ..Config::default() }).unwrap();
        let (words, _) = taught(&mut lives, 1);
        (lives.genes(), lives.learned(&words), words)
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
    assert_eq!(lives(2, 0).learned(&words), mean);
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
