//! Several things of one name, drawn headings, and ends of trials.

use farsa_body::ports::BodyId;
use farsa_compose::ComposedExperiment;
use farsa_lab::{EpisodeId, Evaluation, Evaluator, Experiment as _, Note, Outcome, Settings};
use farsa_view::Recording;

const PARTS: &str = "world = { size = [2.0, 2.0] }\nsensors = [{ kind = \"constant\", value = 1.0 }]\n\
    motors = [{ kind = \"wheels\" }]\nnetwork = { kind = \"perceptron\" }\n";

fn made(text: &str) -> Result<Box<dyn Evaluator>, farsa_lab::Error> {
    let made = ComposedExperiment::from_text("places.toml", text, farsa_lab::strategy::strategies())?;
    made.prepare("", &Settings::new(made.settings(""))?)
}

fn refused(text: &str) -> String {
    made(text).err().unwrap_or_else(|| panic!("nothing is wrong with\n{text}")).to_string()
}

/// A trial of robots that rest, and the places of these bodies.
fn rested(evaluator: &mut dyn Evaluator, trial: u32, bodies: u16) -> (Outcome, Vec<[f32; 2]>) {
    let parameters = vec![0.0; evaluator.info().parameters.len()];
    let mut recording = Recording::new(evaluator.info().schema);
    let id = EpisodeId { seed: 4, trial, ..EpisodeId::default() };
    let outcome = evaluator.evaluate(Evaluation::new(&parameters, id), Some(&mut recording));
    let place = |body| recording.pose_at(0, BodyId(body)).unwrap_or_else(|| panic!("body {body}")).position;
    (outcome, (0..bodies).map(|body| [place(body)[0], place(body)[1]]).collect())
}

fn far(a: [f32; 2], b: [f32; 2]) -> f32 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// They are placed in turn, by the distances of their centers, and count as one area.
#[test]
fn several_things_have_one_name() {
    let text = |nest: &str, term: &str| {
        format!(
            "{PARTS}robot = {{ kind = \"e-puck\" }}\nepisode = {{ steps = 3, trials = 1 }}\n\
             objects = [{{ name = \"nest\", {nest}, kind = \"disc\", radius = 0.4, color = [0.4, 0.4, 0.4] }}]\n\
             start = [{{ place = \"nest\", at = \"anywhere\", walls = 0.3, apart = 0.7, centers = true }}]\n\
             reward = [{{ kind = \"in-area\", area = \"nest\", over = \"end\" }}, \
             {{ kind = \"fullest-area\", area = \"nest\", over = \"end\", weight = 0.0 }}{term}]\n"
        )
    };
    let mut task = made(&text("count = 3", "")).unwrap_or_else(|error| panic!("{error}"));
    for trial in 0..20 {
        let (outcome, places) = rested(task.as_mut(), trial, 4);
        let (robot, nests) = (places[0], &places[1..]);
        for (number, at) in nests.iter().enumerate() {
            assert!(at.iter().all(|x| (0.3..=1.7).contains(x)), "{trial}: {at:?}");
            assert!(nests[..number].iter().all(|other| far(*at, *other) >= 0.7 - 1e-6), "{trial}: {nests:?}");
        }
        let inside = f64::from(u8::from(nests.iter().any(|at| far(*at, robot) <= 0.4)));
        assert_eq!((&outcome.terms[..], &outcome.notes[0].1), (&[inside][..], &Note::from(inside)), "{trial}");
    }
    let error = refused(&text("count = 3", ", { kind = \"distance\", object = \"nest\" }"));
    assert!(error.contains("`nest` names several things"), "{error}");
    let error = refused(&text("count = 3, at = [1.0, 1.0]", ""));
    assert!(error.contains("is for things that a trial places"), "{error}");
}

/// A contact ends a trial, and is a success of one group and not of the other.
#[test]
fn contacts_end_trials() {
    let text = |at: f64| {
        format!(
            "{PARTS}episode = {{ steps = 8, trials = 1 }}\nteam = {{ coevolution = true, common_starts = true }}\n\
             robots = [{{ name = \"hunter\", kind = \"e-puck\" }}, {{ name = \"prey\", kind = \"e-puck\" }}]\n\
             start = [{{ place = \"hunter\", at = \"fixed\", point = [1.0, 1.0], drawn_heading = true }}, \
             {{ place = \"prey\", at = \"fixed\", point = [{at}, 1.0] }}]\n\
             reward = [{{ kind = \"time-left\", rest = \"prey\", over = \"end\" }}, \
             {{ kind = \"contact\", of = \"hunter\", object = \"prey\", within = 0.01, over = \"end\", weight = 0.0 }}, \
             {{ kind = \"gap\", of = \"hunter\", object = \"prey\", over = \"end\", weight = 0.0 }}]\n\
             end = [{{ term = \"contact\", above = 0.5 }}]\n\
             success = [{{ term = \"contact\", of = \"hunter\", above = 0.5 }}, \
             {{ term = \"contact\", of = \"prey\", below = 0.5 }}]\n"
        )
    };
    for (at, met, steps) in [(1.075, true, 1), (1.09, false, 8)] {
        let made = ComposedExperiment::from_text("chase.toml", &text(at), farsa_lab::strategy::strategies());
        let made = made.unwrap_or_else(|error| panic!("{error}"));
        let mut settings = made.settings("");
        settings.push(farsa_lab::Setting::whole("evolution.population", 2, 1..=100));
        let mut task = Settings::new(settings).and_then(|settings| made.prepare("", &settings)).expect("a task");
        let parameters = vec![0.0; task.info().parameters.len()];
        let (opponents, left) = ([&parameters[..]], 1.0 - f64::from(steps) / 8.0);
        for (individual, success, reward) in [(0, met, left), (2, !met, 1.0 - left)] {
            let id = EpisodeId { individual, ..EpisodeId::default() };
            let evaluation = Evaluation { opponents: &opponents, ..Evaluation::new(&parameters, id) };
            let outcome = task.evaluate(evaluation, None);
            assert_eq!((outcome.steps, outcome.success, &outcome.terms[..]), (steps, success, &[reward][..]), "{at}");
            let [(_, contact), (_, Note::Number(gap))] = &outcome.notes[..] else { panic!("{outcome:?}") };
            assert_eq!(contact, &Note::from(f64::from(u8::from(met))));
            assert!((gap - (at - 1.07)).abs() < 1e-6, "{gap}");
        }
    }
    let error = refused(&format!("protocols = [\"team-size\"]\n{}", text(1.5)));
    assert!(error.contains("has `team-size`, which is for one group of robots"), "{error}");
}

#[test]
fn trials_of_the_template_begin_away_from_the_lamp() {
    let text = farsa_compose::FILES.templates[0].text.replace("steps = 400", "steps = 1");
    let mut evaluator = made(&text).expect("an experiment");
    let near = |trial: &u32| rested(&mut *evaluator, *trial, 0).0.terms[0] > 0.0;
    assert_eq!((0..200).filter(near).count(), 0);
}
