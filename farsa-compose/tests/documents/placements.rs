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

/// A Khepera has a radius of 35 mm, and the wall a thickness of 20 mm.
#[test]
fn a_start_of_a_robot_or_a_block_inside_a_thing_is_refused() {
    let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("inside.toml");
    let fixed = |place: &str, at: [f64; 2]| format!("{{ place = \"{place}\", at = \"fixed\", point = {at:?} }}");
    let alone = |at| format!("robot = {{ kind = \"khepera\" }}\nstart = [{}]\n", fixed("robot", at));
    let post = "[[objects]]\nkind = \"cylinder\"\nname = \"post\"\nradius = 0.1\nat = [1.0, 1.0]\n";
    let shelf = "[[objects]]\nkind = \"wall\"\nname = \"shelf\"\nsize = [0.6, 0.02]\nat = [1.0, 0.5]\n";
    let block = "[[objects]]\nkind = \"block\"\nname = \"crate\"\nsize = [0.4, 0.1, 0.1]\nmass = 0.1\n";
    let block = format!("{post}{shelf}{block}");
    let placed = |robot, at, heading| {
        let block = fixed("crate", at).replace(" }", &format!(", heading = {heading} }}"));
        format!("robot = {{ kind = \"khepera\" }}\nstart = [{block}, {}]\n", fixed("robot", robot))
    };
    let cases = [
        (alone([1.0, 0.864]), post, None),
        (alone([1.0, 0.88]), post, Some("`start.1`: `robot` is inside `post` at the start of trial 1")),
        (alone([0.036, 1.0]), "", None),
        (alone([0.02, 1.0]), "", Some("`robot` is inside a wall at the start of trial 1")),
        (alone([1.0, 0.5]), shelf, Some("`robot` is inside a wall")),
        (placed([0.5, 1.59], [0.4, 1.5], 0), &block, None),
        (placed([0.5, 1.57], [0.4, 1.5], 0), &block, Some("`start.2`: `robot` is inside `crate`")),
        (placed([1.5, 1.5], [1.0, 0.57], 0), &block, None),
        (placed([1.5, 1.5], [1.0, 0.57], 90), &block, Some("`start.1`: `crate` is inside a wall")),
        (placed([1.5, 1.5], [1.0, 0.55], 0), &block, Some("`start.1`: `crate` is inside a wall")),
        (placed([1.5, 1.5], [1.0, 1.16], 0), &block, None),
        (placed([1.5, 1.5], [1.0, 1.22], 45), &block, None),
        (placed([1.5, 1.5], [1.0, 1.2], 45), &block, Some("`start.1`: `crate` is inside `post`")),
    ];
    for (start, objects, expected) in cases {
        let engine = if objects.contains("block") { ", engine = \"rapier\"" } else { "" };
        let parts = PARTS.replacen(" }", &format!("{engine} }}"), 1);
        let text = format!("{parts}reward = [{{ kind = \"time\" }}]\n{start}{objects}");
        std::fs::write(&path, &text).expect("a file");
        let read = ComposedExperiment::from_file(&path, farsa_lab::strategy::strategies());
        let error = read.err().map(|error| error.to_string());
        match expected {
            None => assert_eq!(error, None, "{text}"),
            Some(expected) => assert!(error.as_deref().is_some_and(|e| e.contains(expected)), "{error:?}\n{text}"),
        }
    }
}
