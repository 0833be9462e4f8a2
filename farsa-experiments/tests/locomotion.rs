//! Robots of Gymnasium and the Playground: models from other files, and rewards at rest.
#![allow(missing_docs, clippy::unwrap_used)]

use std::fs;
use std::path::PathBuf;

use farsa_experiments::{GO1_JOYSTICK, HALF_CHEETAH, HOPPER, ModelExperiment};
use farsa_lab::advanced::Value;
use farsa_lab::{EpisodeId, Error, Evaluation, Evaluator, Experiment as _, Outcome, Settings};

fn with_model(experiment: &ModelExperiment, path: &str) -> Result<Box<dyn Evaluator>, Error> {
    let condition = experiment.conditions().first().copied().unwrap_or_default();
    let mut settings = Settings::new(experiment.settings(condition))?;
    settings.set("", "robot.model", Value::Word(path.into()))?;
    settings.set("", "episode.steps", Value::Whole(100))?;
    experiment.prepare(condition, &settings)
}

/// A trial with motors that are at rest: all genes in the middle.
fn at_rest(evaluator: &mut dyn Evaluator) -> Outcome {
    let parameters = vec![0.0; evaluator.info().parameters.len()];
    evaluator.evaluate(Evaluation::new(&parameters, EpisodeId::default()), None)
}

fn model(name: &str) -> String {
    format!("{}/experiments/locomotion/{name}.xml", env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn a_model_from_a_file_replaces_the_embedded_one() {
    let embedded = at_rest(with_model(&HALF_CHEETAH, "").unwrap().as_mut());
    assert_eq!(at_rest(with_model(&HALF_CHEETAH, &model("half-cheetah")).unwrap().as_mut()), embedded);
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
    let text = fs::read_to_string(model("half-cheetah")).unwrap();
    // A file with an included one: both are files of the run.
    let [outer, inner] = ["outer.xml", "inner.xml"].map(|name| folder.join(name));
    fs::write(&inner, text.replace("gear=\"120\"", "gear=\"60\"")).unwrap();
    fs::write(&outer, "<mujoco><include file=\"inner.xml\"/></mujoco>").unwrap();
    let mut settings = Settings::new(HALF_CHEETAH.settings("way")).unwrap();
    settings.set("", "robot.model", Value::Word(outer.display().to_string())).unwrap();
    let files = HALF_CHEETAH.files("way", &settings).unwrap();
    assert_eq!(files.len(), 2, "{files:?}");
    assert!(HALF_CHEETAH.prepare("way", &settings).is_ok());
}

#[test]
fn a_model_that_does_not_fit_is_refused() {
    for (experiment, path, why) in [
        (&HOPPER, model("walker2d"), "joint"),
        (&HOPPER, model("ant"), "unknown joint `rootz`"),
        (&GO1_JOYSTICK, model("g1-walk"), "unknown body `trunk`"),
        (&HOPPER, "nothing.xml".into(), "nothing.xml"),
    ] {
        let made = with_model(experiment, &path);
        if let Some(error) = made.err() {
            assert!(error.to_string().contains("robot.model") && error.to_string().contains(why), "{error}");
        } else {
            // Two legs are more than one, and all names of the hopper are there.
            assert!(path.ends_with("walker2d.xml"), "{path}");
        }
    }
}

/// Without torques a cheetah rests on its feet, a hopper earns its bonus, and a quadruped keeps its posture.
#[test]
fn robots_at_rest_earn_what_the_reward_says() {
    let term = |outcome: &Outcome, number: usize| outcome.terms[number];
    let cheetah = at_rest(with_model(&HALF_CHEETAH, "").unwrap().as_mut());
    // Control has no price at the middle of the motors, and a fall is no way.
    assert!(cheetah.steps == 100 && term(&cheetah, 1) == 0.0 && term(&cheetah, 0).abs() < 20.0, "{cheetah:?}");
    let hopper = at_rest(with_model(&HOPPER, "").unwrap().as_mut());
    assert!(term(&hopper, 1) == f64::from(hopper.steps) && term(&hopper, 2) == 0.0, "{hopper:?}");
    let standing = at_rest(with_model(&GO1_JOYSTICK, "").unwrap().as_mut());
    // Terms of a step are at most 1/500, 0.25/500, 0.5/500 and 0.25/500.
    assert!(standing.steps == 100 && standing.terms.iter().sum::<f64>() <= 2.0 * 100.0 / 500.0, "{standing:?}");
    // Neither moves to the side nor loses the height of its posture.
    assert!([1, 3].into_iter().all(|number| term(&standing, number) > 0.8 * 0.25 * 100.0 / 500.0), "{standing:?}");
}
