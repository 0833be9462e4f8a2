//! Formulas in whole trials: terms under their own names, conditions, behavior, and lanes.

use std::fmt::Write as _;

use farsa_compose::ComposedExperiment;
use farsa_lab::advanced::Lanes;
use farsa_lab::{EpisodeId, Evaluation, Evaluator, Experiment as _, Note, Outcome, Settings};
use farsa_num::Instructions;

use crate::wheels::{LAMP, NOTHING, OUTPUTS, TIME_STEP, file, step};
use crate::{Trial, close, distance, joints, made, refused, wheels};

/// Writes a term as a call, with its keys as arguments.
fn call(kind: &str, keys: &str) -> String {
    format!("{kind}({})", keys.replace('"', "'").replace('\n', ", "))
}

/// Appends three terms for each case: by its kind, as a formula, and as a part of a formula.
fn three_ways<'c>(cases: impl Iterator<Item = (&'c str, &'c str)>, over: &str) -> (String, Vec<String>) {
    let (mut text, mut names) = (String::new(), Vec::new());
    // The quantity `steps` would be confused with the number of the step.
    for (number, (kind, keys)) in cases.filter(|(kind, _)| !["steps", "formula"].contains(kind)).enumerate() {
        let call = call(kind, keys);
        let _ = writeln!(text, "[[reward]]\nname = \"kind{number}\"\nkind = \"{kind}\"\n{keys}\nover = \"{over}\"");
        for (name, formula) in [("alone", call.clone()), ("within", format!("if(1 < 2, {call}, 0)"))] {
            let _ = writeln!(text, "[[reward]]\nname = \"{name}{number}\"\nformula = \"{formula}\"\nover = \"{over}\"");
        }
        names.push(call);
    }
    (text, names)
}

fn check_three_ways(text: &str, calls: &[String]) {
    let trial = Trial::new(text);
    let bits = |values: Vec<f64>| values.into_iter().map(f64::to_bits).collect::<Vec<_>>();
    for (number, call) in calls.iter().enumerate() {
        let columns = ["kind", "alone", "within"].map(|name| bits(trial.column(&format!("{name}{number}"))));
        assert!(columns[0] == columns[1] && columns[0] == columns[2], "{call}: {columns:?}");
        let terms: Vec<u64> = trial.outcome.terms[3 * number..3 * number + 3].iter().map(|x| x.to_bits()).collect();
        assert!(terms.iter().all(|bits| *bits == terms[0]), "{call}");
    }
    assert!(calls.len() > 15, "{calls:?}");
}

/// A term has the same bits by its kind, as a formula and within a formula.
#[test]
fn each_term_on_wheels_is_a_quantity() {
    for over in ["sum", "end", "most"] {
        let (terms, calls) = three_ways(wheels::TERMS.iter().map(|(kind, keys, ..)| (*kind, *keys)), over);
        check_three_ways(&file(OUTPUTS, NOTHING, &terms), &calls);
    }
}

#[test]
fn each_term_of_joints_is_a_quantity() {
    for over in ["sum", "end", "most"] {
        // The robot has a hinge and a rail, so the mean speed of all its joints has no unit.
        let cases =
            joints::TERMS.iter().map(|(kind, keys, _)| (*kind, *keys)).filter(|(kind, _)| *kind != "joint-speed");
        let cases = cases.chain([("joint-speed", "joints = [\"rail\"]"), ("joint-speed", "joints = [\"hinge\"]")]);
        let (terms, calls) = three_ways(cases, over);
        check_three_ways(&joints::file(joints::NOTHING, &terms), &calls);
    }
}

/// Positional arguments and channels name the same quantities as keys.
#[test]
fn arguments_are_assigned_by_their_types() {
    let pairs = [
        ("near(lamp, 9 cm)", "near(object = lamp, within = 0.09)"),
        ("near(robot, lamp, 0.09 m)", "near(object = lamp, within = 0.09)"),
        ("distance(robot, lamp)", "distance(object = lamp)"),
        ("gap('lamp')", "gap(object = lamp)"),
        ("contact(robot, lamp, 0.09)", "contact(object = lamp, within = 0.09)"),
        ("in-area(yard, pond)", "in-area(area = yard, or = [pond])"),
        ("speed(robot)", "speed()"),
        ("touch", "touch()"),
        ("position([0, 1, 0])", "position(along = [0, 1, 0])"),
        ("max(constant)", "sensor(constant)"),
        ("constant", "sensor(constant)"),
        ("min(wheels)", "0.7"),
        ("'wheels left'", "max(wheels)"),
        ("signal - 0.1", "1 * signal - 0.1"),
        ("step * 0.16 s", "time"),
    ];
    let mut terms = String::new();
    for (number, (left, right)) in pairs.iter().enumerate() {
        for (name, formula) in [("left", left), ("right", right)] {
            let _ = writeln!(terms, "[[reward]]\nname = \"{name}{number}\"\nformula = \"{formula}\"");
        }
    }
    let trial = Trial::new(&file(OUTPUTS, NOTHING, &terms));
    for (number, (left, right)) in pairs.iter().enumerate() {
        let [found, wanted] = ["left", "right"].map(|name| trial.column(&format!("{name}{number}")));
        for (found, wanted) in found.iter().zip(&wanted) {
            close(*found, *wanted, 1e-7, &format!("{left} and {right}"));
        }
    }
    close(trial.column("left13")[3], 0.25, 1e-7, "signal - 0.1");
}

/// A text instead of a list is one term, as is a text in a list.
#[test]
fn a_reward_may_be_a_single_formula() {
    let text = "reward = \"max(0, 1 - distance(robot, lamp) / 0.3 m)\"\n";
    let wanted: Vec<f64> = (1..=20).map(|number| 1.0 - distance(step(number).at, LAMP) / 0.3).collect();
    for text in [text.to_owned(), text.replace("\"max", "[\"max").replace(")\"", ")\"]"), text.replace(" m)", ")")] {
        let trial = Trial::new(&(text + &file(OUTPUTS, NOTHING, "")));
        for (found, wanted) in trial.column("formula").iter().zip(&wanted) {
            close(*found, *wanted, 1e-5, "the formula");
        }
        close(trial.outcome.terms[0], wanted.iter().sum::<f64>() / 20.0, 1e-5, "its mean");
    }
    // A value of 0 / 0 fails the trial.
    let text = format!("reward = \"1 + 0 / 0\"\n{}", file(OUTPUTS, NOTHING, ""));
    let mut evaluator = made(&text).expect("an evaluator");
    assert!(!run(evaluator.as_mut(), 0).is_finite());
    let text = text.replace("0 / 0", "0 / 1");
    let mut evaluator = made(&text).expect("an evaluator");
    assert!(run(evaluator.as_mut(), 0).is_finite());
}

/// Runs a trial of an evaluator.
fn run(evaluator: &mut dyn Evaluator, trial: u32) -> Outcome {
    let parameters = vec![0.0; evaluator.info().parameters.len()];
    let id = EpisodeId { trial, ..EpisodeId::default() };
    evaluator.evaluate(Evaluation::new(&parameters, id), None)
}

fn outcome(conditions: &str) -> Outcome {
    let terms = "[[reward]]\nkind = \"time\"\n[[reward]]\nkind = \"distance\"\nobject = \"lamp\"\n";
    Trial::new(&format!("{conditions}{}", file(OUTPUTS, NOTHING, terms))).outcome
}

/// The time after step n is 0.16 n, of 20 steps. A condition as a formula equals one on a term.
#[test]
fn formulas_are_conditions() {
    let term = |list: &str, limit: &str| format!("{list} = [{{ term = \"time\", {limit} }}]\n");
    for (formula, limits) in [("time > 1.9", "above = 1.9"), ("time > 1.9 s and time < 2", "above = 1.9, below = 2")] {
        for list in ["success", "failure", "end"] {
            let [found, wanted] =
                [format!("{list} = \"{formula}\"\n"), term(list, limits)].map(|conditions| outcome(&conditions));
            assert_eq!(found, wanted, "{list}: {formula}");
        }
    }
    let ended = outcome("end = \"time > 1 and distance(robot, lamp) < 0.1\"\n");
    let first = (1..=20).find(|number| TIME_STEP * *number as f64 > 1.0 && distance(step(*number).at, LAMP) < 0.1);
    assert_eq!(Some(ended.steps as usize), first.filter(|first| (7..20).contains(first)));
    // Any of several ends a trial, and all of several are a success.
    assert_eq!(
        outcome("end = [\"step >= 9\", { formula = \"step == 7\" }, { term = \"time\", above = 2.0 }]\n").steps,
        7
    );
    let success = |conditions: &str| outcome(&format!("success = {conditions}\n")).success;
    assert!(success("[\"step == 20\", \"time > 3\"]") && !success("[\"step == 20\", \"time > 4\"]"));
    // Quantities of conditions are no terms.
    let mut evaluator = made(&format!(
        "success = \"gap(lamp) > 0\"\nend = \"step > 3 for 1 s\"\n{}",
        file(OUTPUTS, NOTHING, "[[reward]]\nkind = \"time\"\n")
    ))
    .expect("an evaluator");
    assert_eq!(evaluator.info().terms, ["time"]);
    let columns = evaluator.info().schema.columns();
    assert!(!columns.iter().any(|column| column.contains("gap")), "{columns:?}");
    assert_eq!(run(evaluator.as_mut(), 0).terms.len(), 1);
}

/// A second is 7 steps of 0.16 s, and 0.32 s are 2.
#[test]
fn conditions_hold_for_a_time() {
    let steps = |condition: &str| outcome(&format!("end = \"{condition}\"\n")).steps;
    assert_eq!([steps("step > 3"), steps("step > 3 for 1 s"), steps("step > 3 for 0.32 s")], [4, 10, 5]);
    assert_eq!([steps("step > 3 for 0.33"), steps("step > 3 for 10 ms"), steps("step > 3 for 0 s")], [6, 4, 4]);
    // A gap starts the time again: steps 4 to 8, then from 10 on.
    assert_eq!(steps("step > 3 and step != 9 for 1 s"), 16);
    assert_eq!(steps("step > 3 and step != 9 for 0.8 s"), 8);
    let failed = outcome("failure = \"step > 3 for 1 s\"\nsuccess = \"step > 1\"\n");
    assert_eq!((failed.steps, failed.success), (10, false));
    // Success is judged after the last step, or ends the trial.
    let success = |condition: &str| outcome(&format!("success = \"{condition}\"\n"));
    assert!(success("step > 13 for 1 s").success && !success("step > 14 for 1 s").success);
    assert!(!success("step < 20 for 1 s").success);
    let text = format!("success = \"step > 3 for 1 s\"\n{}", file(OUTPUTS, NOTHING, "[[reward]]\nkind = \"time\"\n"));
    let ended = Trial::new(&text.replace("trials = 1", "trials = 1, ends = [\"success\"]")).outcome;
    assert_eq!((ended.steps, ended.success), (10, true));
    // The time starts again in each trial.
    let mut evaluator =
        made(&format!("end = \"step > 0 for 1 s\"\n{}", file(OUTPUTS, NOTHING, "[[reward]]\nkind = \"time\"\n")))
            .expect("an evaluator");
    for trial in 0..3 {
        assert_eq!(run(evaluator.as_mut(), trial).steps, 7);
    }
    let long =
        made(&format!("end = \"step > 0 for 4 s\"\n{}", file(OUTPUTS, NOTHING, "[[reward]]\nkind = \"time\"\n")))
            .expect("an evaluator");
    assert!(long.info().warnings.iter().any(|warning| warning.contains("never holds")));
}

/// A formula may be an objective or a measure by its name.
#[test]
fn formulas_describe_behavior() {
    let terms = "[[reward]]\nname = \"closeness\"\nformula = \"1 - distance(lamp) / 0.3\"\nover = \"end\"\nweight = 0.0\n\
        [[reward]]\nkind = \"steps\"\n\
        [behaviour]\nobjectives = [{ term = \"closeness\" }]\ndescriptors = [{ term = \"closeness\", range = [0, 1] }]\n";
    let trial = Trial::new(&file(OUTPUTS, NOTHING, terms));
    let wanted = 1.0 - distance(step(20).at, LAMP) / 0.3;
    let note = trial.outcome.notes.iter().find(|(name, _)| *name == "measured closeness").map(|(_, note)| note.clone());
    assert!(matches!(note, Some(Note::Number(value)) if (value - wanted).abs() < 1e-5), "{note:?}");
    let evaluator = made(&file(OUTPUTS, NOTHING, terms)).expect("an evaluator");
    let behavior = evaluator.behavior().expect("a behavior");
    let described = behavior.describe(std::slice::from_ref(&trial.outcome));
    assert_eq!(behavior.objectives(), ["closeness"]);
    assert!(described.iter().all(|value| (value - wanted).abs() < 1e-5), "{described:?}");
}

/// Errors have file, line, key and column, and the nearest name.
#[test]
fn wrong_formulas_are_refused_at_their_place() {
    let on_wheels = |text: &str| refused(&format!("{text}\n{}", file(OUTPUTS, NOTHING, "")));
    for (text, wanted) in [
        (
            "reward = \"1 - distance(lmap)\"",
            "values.toml line 1, column 5 of the formula: `reward.1.formula`: unknown object `lmap`; the nearest is `lamp`",
        ),
        (
            "reward = [{ kind = \"time\" },\n{ formula = \"time + gap(lamp)\", over = \"end\" }]",
            "values.toml line 2, column 8 of the formula: `reward.2.formula`: s and m do not match",
        ),
        (
            "reward = \"time\"\nend = [\"time > 3\", \"gap(yard) < 1\"]",
            "values.toml line 2, column 1 of the formula: `end.2.formula`: `yard` is no cylinder",
        ),
        (
            "reward = \"time\"\nfailure = \"food > 1\"",
            "line 2, column 1 of the formula: `failure.1.formula`: needs the section `foraging`",
        ),
        (
            "reward = \"time\"\nsuccess = \"time\"",
            "line 2, column 1 of the formula: `success.1.formula`: the formula is a number",
        ),
        ("reward = \"height(lamp)\"", "is for robots with joints; this one is on wheels"),
        ("reward = \"sensor(constnt)\"", "unknown sensor `constnt`; the nearest is `constant`"),
        ("reward = [{ formula = \"time\", kind = \"near\" }]", "unknown key `formula`"),
        ("reward = [{ formula = \"time\", objet = \"lamp\" }]", "unknown key `objet`"),
        ("reward = [{ formula = 3 }]", "`reward.1.formula`: is not a text in quotes"),
        ("reward = 3", "is not a list"),
        (
            "reward = \"time\"\nend = [{ formula = \"time > 1\", above = 3 }]",
            "`end.1.above`: is for conditions without a `formula`",
        ),
        ("reward = \"time\"\nend = [{ above = 3 }]", "`end.1`: lacks the key `term`, or a `formula`"),
        ("reward = \"time\"\nend = [{ formula = \"time > 1\", of = \"prey\" }]", "unknown group of robots `prey`"),
    ] {
        let error = on_wheels(text);
        assert!(error.contains(wanted), "{text}: {error}");
    }
    let long = on_wheels(&format!("reward = \"{}time\"", "1 s + ".repeat(400)));
    assert!(long.contains("is longer than 2000 characters"), "{long}");
    let energy = file(OUTPUTS, "[[sensors]]\nname = \"touch\"\nkind = \"constant\"\nvalue = 0.3\n", "");
    let error = refused(&format!("reward = \"1 - touch\"\n{energy}"));
    assert!(error.contains("write `'touch'` or `touch()`"), "{error}");
    for (text, wanted) in [
        ("reward = \"joint-speed + 1 m/s\"", "mixes hinges and rails"),
        ("reward = \"joint-position(hinge) + joint-position(rail)\"", "rad and m do not match"),
        ("reward = \"height(bal)\"", "unknown body `bal`; the nearest is `ball`"),
        ("reward = \"distance(limb, mrk)\"", "unknown object `mrk`; the nearest is `mark`"),
        ("reward = \"joint-velocity(hing)\"", "unknown joint `hing`; the nearest is `hinge`"),
        ("reward = \"speed(mark)\"", "a marker, which has no speed"),
        ("reward = \"food\"", "is for robots on wheels; this one has joints"),
    ] {
        let error = refused(&format!("{text}\n{}", joints::file(joints::NOTHING, "")));
        assert!(error.contains(wanted), "{text}: {error}");
    }
    let fine = Trial::new(&format!(
        "reward = \"distance(limb, mark) + joint-position(rail)\"\n{}",
        joints::file(joints::NOTHING, "")
    ));
    assert_eq!(fine.outcome.steps, 12);
}

fn evaluator(text: &str) -> Box<dyn Evaluator> {
    let made = ComposedExperiment::from_text("lanes.toml", text, farsa_lab::strategy::strategies());
    let made = made.unwrap_or_else(|error| panic!("{error}\n{text}"));
    let settings = Settings::new(made.settings("")).expect("settings");
    made.prepare("", &settings).expect("an evaluator")
}

/// Outcomes of 20 trials of networks with random parameters, one after the other or in lanes.
fn outcomes(text: &str, lanes: Option<usize>) -> Vec<Outcome> {
    let mut evaluator = evaluator(text);
    let mut stream = farsa_num::Stream::from_seed(7);
    let ends: Vec<[f64; 2]> = evaluator.info().parameters.iter().map(|parameter| parameter.ends).collect();
    let parameters: Vec<Vec<f32>> =
        (0..5).map(|_| ends.iter().map(|[low, high]| stream.range_f64(*low, *high) as f32).collect()).collect();
    let jobs: Vec<Evaluation<'_>> = (0..20)
        .map(|number| {
            let id = EpisodeId { seed: 3, generation: 1, individual: number as u32 / 4, trial: number as u32 % 4 };
            Evaluation { number, ..Evaluation::new(&parameters[number / 4], id) }
        })
        .collect();
    let Some(lanes) = lanes else { return jobs.iter().map(|job| evaluator.evaluate(*job, None)).collect() };
    let in_lanes = evaluator.in_lanes().expect("lanes");
    in_lanes.use_lanes(Lanes::new(lanes, Instructions::detect()).expect("a number of lanes")).expect("a batch");
    let (mut next, mut found) = (jobs.iter(), vec![None; jobs.len()]);
    in_lanes.run_in_lanes(&mut || next.next().copied(), &mut |number, outcome| found[number] = Some(outcome));
    found.into_iter().map(|outcome| outcome.expect("an outcome")).collect()
}

const ARENA: &str = "world = { size = [1.5, 1.5] }\nrobot = { kind = \"e-puck\" }\n\
    objects = [{ name = \"lamp\", kind = \"cylinder\", radius = 0.03, lamp = 1.0 }]\n\
    sensors = [{ kind = \"infrared\" }, { kind = \"light\" }]\nmotors = [{ kind = \"wheels\" }]\n\
    network = { kind = \"leaky\", hidden = 3 }\nepisode = { steps = 150, trials = 4, ends = [\"collision\"] }\n\
    start = [{ place = \"lamp\", at = \"anywhere\", walls = 0.2 }, { place = \"robot\", at = \"anywhere\", apart = 0.1 }]\n";
const ARM: &str = "world = { engine = \"articulated\", time_step = 0.02 }\nrobot = { kind = \"arm-and-hand\" }\n\
    objects = [{ name = \"target\", kind = \"marker\" }, { name = \"ball\", kind = \"ball\", radius = 0.03, mass = 0.1 }]\n\
    sensors = [{ kind = \"joint-position\" }, { kind = \"target-position\", target = \"target\" }]\n\
    motors = [{ kind = \"muscles\" }]\nnetwork = { kind = \"leaky\", hidden = 3 }\nepisode = { steps = 60, trials = 4 }\n\
    start = [{ place = \"target\", at = \"in-box\", low = [0.1, -0.3, 0.3], high = [0.4, 0.3, 0.6] }, \
    { place = \"ball\", at = \"in-box\", low = [0.5, -0.3, 0.3], high = [0.8, 0.3, 0.6] }]\n";

/// Trials by kinds and conditions on terms, and by formulas, have the same bits alone and in 1, 8 and 16 lanes.
#[test]
fn formulas_have_the_bits_of_terms_in_lanes() {
    for (world, kinds, formulas) in [
        (
            ARENA,
            "reward = [{ kind = \"near\", object = \"lamp\", within = 0.3 }, { kind = \"forward\", over = \"sum\" }, \
             { kind = \"sensor\", sensor = \"infrared\", weight = -0.5 }, { kind = \"distance\", object = \"lamp\", over = \"end\" }]\n\
             success = [{ term = \"distance\", below = 0.4 }]\nend = [{ term = \"near\", above = 2 }]\n",
            "reward = [\"near(lamp, 0.3)\", { formula = \"forward\", over = \"sum\" }, \
             { formula = \"if(step > 0, max(infrared), 0)\", weight = -0.5 }, { formula = \"distance(robot, lamp)\", over = \"end\" }]\n\
             success = \"distance(lamp) < 0.4\"\nend = \"near(lamp, 0.3) > 2\"\n",
        ),
        (
            ARM,
            "reward = [{ kind = \"distance\", object = \"target\" }, { kind = \"approach\", object = \"target\", over = \"end\" }, \
             { kind = \"height\" }, { kind = \"joint-speed\", weight = -0.1 }, { kind = \"progress\", along = [0, 0, 1], over = \"sum\" }]\n\
             success = [{ term = \"distance\", below = 0.4 }]\nfailure = [{ term = \"joint-speed\", above = 9 }]\n",
            "reward = [\"if(1 < 2, distance(target), 0)\", { formula = \"approach(robot, target)\", over = \"end\" }, \
             \"height + 0 * time\", { formula = \"joint-speed\", weight = -0.1 }, \
             { formula = \"if(time < 0, 0, progress([0, 0, 1]))\", over = \"sum\" }]\n\
             success = \"distance(target) < 0.4 m\"\nfailure = \"joint-speed > 9 rad/s\"\n",
        ),
    ] {
        // `height + 0 * time` adds a length and a time.
        let formulas = formulas.replace("height + 0 * time", "height + 0 * time * 1 m/s");
        let bits = |outcome: &Outcome| {
            let terms: Vec<u64> = outcome.terms.iter().map(|term| term.to_bits()).collect();
            (terms, outcome.steps, outcome.success)
        };
        let wanted: Vec<_> = outcomes(&format!("{kinds}{world}"), None).iter().map(bits).collect();
        for lanes in [None, Some(1), Some(8), Some(16)] {
            let found: Vec<_> = outcomes(&format!("{formulas}{world}"), lanes).iter().map(bits).collect();
            assert_eq!(found, wanted, "lanes {lanes:?}\n{formulas}");
        }
        assert!(wanted.iter().all(|(terms, ..)| terms.len() > 3) && wanted.windows(2).all(|pair| pair[0] != pair[1]));
    }
}

/// The time of a condition is counted for each lane.
#[test]
fn conditions_over_time_have_their_steps_in_lanes() {
    let rest = "reward = \"1\"\nsuccess = \"near(lamp, 0.4) > 0 for 2 s\"\nend = \"max(infrared) > 0.05 for 300 ms\"\n";
    let text = format!("{rest}{ARENA}");
    let found = |lanes| outcomes(&text, lanes).iter().map(|trial| (trial.steps, trial.success)).collect::<Vec<_>>();
    let alone = found(None);
    for lanes in [1, 8, 16] {
        assert_eq!(found(Some(lanes)), alone, "{lanes} lanes");
    }
    assert!(alone.iter().any(|(_, success)| *success) && !alone.iter().all(|(_, success)| *success), "{alone:?}");
    let steps: std::collections::BTreeSet<u32> = alone.iter().map(|(steps, _)| *steps).collect();
    assert!(steps.len() > 3, "{steps:?}");
}

/// A reward of several robots is the mean of their values, and a condition is about the means of its quantities.
#[test]
fn formulas_of_several_robots_are_means() {
    let text = |rest: &str| {
        format!(
            "world = {{ size = [3.1, 2.3] }}\nrobot = {{ kind = \"e-puck\", count = 2 }}\n\
             sensors = [{{ kind = \"constant\", value = 1.0 }}]\nmotors = [{{ kind = \"wheels\" }}]\n\
             network = {{ kind = \"wired\", bias = [0.5, 0.5], wires = [] }}\nepisode = {{ steps = 3, trials = 1 }}\n\
             start = [{{ place = \"robot-1\", at = \"fixed\", point = [0.5, 0.5] }}, \
             {{ place = \"robot-2\", at = \"fixed\", point = [2.5, 0.5] }}]\n\
             [[objects]]\nname = \"nest\"\nkind = \"disc\"\nradius = 0.4\nat = [0.6, 0.5]\ncolor = [0.4, 0.6, 0.3]\n{rest}"
        )
    };
    let x = "position([1, 0, 0])";
    let trial = |rest: &str| Trial::new(&format!("{rest}\n{}", text(""))).outcome;
    let terms = trial(&format!("reward = [\"pow({x}, 2)\", \"robots-in-area(nest) * {x}\", \"in-area(nest)\"]")).terms;
    for (found, wanted) in terms.iter().zip([3.25, 1.5, 0.5]) {
        close(*found, wanted, 1e-6, "a mean");
    }
    assert_eq!(trial(&format!("reward = \"1\"\nend = \"pow({x}, 2) < 2.3 m * 1 m\"")).steps, 1);
    assert_eq!(trial(&format!("reward = \"1\"\nend = \"pow({x}, 2) < 2.2\"")).steps, 3);
    let of_second = trial(&format!("reward = [{{ formula = \"2 * {x}\", robot = 2 }}]")).terms;
    close(of_second[0], 5.0, 1e-6, "the second robot");
}

/// A group or a robot before the thing is the one that a quantity is about, in terms and in conditions.
#[test]
fn quantities_are_about_named_robots() {
    let text = "world = { size = [3.1, 2.3] }\n\
        robots = [{ name = \"hunters\", kind = \"e-puck\", count = 2 }, { name = \"prey\", kind = \"e-puck\" }]\n\
        sensors = [{ kind = \"constant\", value = 1.0 }]\nmotors = [{ kind = \"wheels\" }]\n\
        network = { kind = \"wired\", bias = [0.5, 0.5], wires = [] }\nepisode = { steps = 3, trials = 1 }\n\
        start = [{ place = \"robot-1\", at = \"fixed\", point = [0.5, 0.5] }, \
        { place = \"robot-2\", at = \"fixed\", point = [0.5, 1.5] }, { place = \"prey\", at = \"fixed\", point = [1.5, 0.5] }]\n\
        [[objects]]\nname = \"post\"\nkind = \"cylinder\"\nradius = 0.05\nat = [1.5, 1.5]\n";
    let far = f64::sqrt(2.0);
    for (formula, wanted) in [
        ("distance(hunters, prey)", f64::midpoint(1.0, far)),
        ("distance(robot-1, prey)", 1.0),
        ("2 * distance(body = robot-2, object = prey)", 2.0 * far),
        ("gap(prey, post) + 0.085", 1.0),
        ("angle(robot-1, prey) - angle(robot-1, prey)", 0.0),
        ("distance(post)", (far + 1.0 + 1.0) / 3.0),
        ("distance(robot, post)", (far + 1.0 + 1.0) / 3.0),
        ("position(prey, [1, 0, 0]) - position(hunters, [1, 0, 0])", 1.0),
        ("touch(prey)", 0.0),
    ] {
        close(Trial::new(&format!("reward = \"{formula}\"\n{text}")).outcome.terms[0], wanted, 1e-6, formula);
        let unit = if formula.contains("angle") { "rad" } else { "m" };
        let [low, high] = [wanted - 1e-4, wanted + 1e-4].map(|limit| format!("{limit:.5} {unit}"));
        let condition = format!("{formula} > {low} and {formula} < {high}");
        let condition = if formula.contains("touch") { "touch(prey) == 0".into() } else { condition };
        assert_eq!(
            Trial::new(&format!("reward = \"1\"\nend = \"{condition}\"\n{text}")).outcome.steps,
            1,
            "{condition}"
        );
    }
    let error = refused(&format!("reward = \"distance(huntrs, prey)\"\n{text}"));
    assert!(error.contains("column 1 of the formula") && error.contains("unknown group of robots `huntrs`"), "{error}");
    // A part of a robot with joints touches a thing.
    let by_kind = "[[reward]]\nname = \"kind\"\nkind = \"touch\"\nbodies = [\"limb\"]\nwith = \"ball\"\n";
    let by_formula = "[[reward]]\nname = \"formula\"\nformula = \"contact(limb, ball)\"\n";
    let trial = Trial::new(&joints::file(joints::NOTHING, &format!("{by_kind}{by_formula}")));
    assert_eq!(trial.column("kind"), trial.column("formula"));
    let error = refused(&joints::file(joints::NOTHING, "[[reward]]\nformula = \"contact(limp, ball)\"\n"));
    assert!(error.contains("unknown body `limp`; the nearest is `limb`"), "{error}");
}

/// The guide's formulas are terms and conditions of its first experiment.
#[test]
fn the_guides_formulas_are_valid() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/guide/experiment-file.md");
    let guide = std::fs::read_to_string(path).expect("the guide");
    let texts: Vec<&str> = guide.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    let experiment = texts[0].split("reward = [").next().expect("an experiment");
    let formulas = texts.iter().find(|text| text.contains("formula = ")).expect("the formulas");
    let evaluator = evaluator(&format!("{experiment}{formulas}"));
    assert_eq!(evaluator.info().terms, ["formula", "formula-2", "touch"]);
    assert!(evaluator.info().has_success);
    // The guide lists every function.
    for name in ["min", "max", "mean", "abs", "sign", "clamp", "sqrt", "exp", "log", "sin", "cos", "tanh", "pow", "if"]
    {
        let words = guide.split(|character: char| !character.is_ascii_alphanumeric());
        assert!(words.filter(|word| *word == name).count() > 0, "{name}");
    }
}
