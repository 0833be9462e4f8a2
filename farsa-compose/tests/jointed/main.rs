//! Robots with joints, from files: motors, falling things, errors.

mod eyes;
mod merged;
mod refusals;
mod settings;

use std::path::Path;

use farsa_compose::ComposedExperiment;
use farsa_lab::{EpisodeId, Evaluation, Evaluator, Experiment as _, Note, Outcome, Settings};

/// A bar that turns about the vertical: 1 kg, half a metre from the axis, 0.26 kg m2 about it.
const BAR: &str = r#"<robot name="bar"><link name="base"/>
<link name="rod"><inertial><origin xyz="0.5 0 0"/><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><origin xyz="0.5 0 0"/><geometry><sphere radius="0.1"/></geometry></collision></link>
<joint name="hinge" type="revolute"><parent link="base"/><child link="rod"/><origin xyz="0 0 1"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="2" velocity="3"/></joint></robot>"#;

/// A file about the bar: with these lines of the table `world`, motor, objects and rewards.
fn file(world: &str, motor: &str, rest: &str) -> String {
    format!(
        "[world]\nengine = \"articulated\"\ntime_step = 0.01\n{world}\n[robot]\nkind = \"model\"\nfile = \"bar.urdf\"\n\
         [[sensors]]\nkind = \"joint-position\"\nfrom = 0.0\nto = 1.0\n[[motors]]\n{motor}\n\
         [network]\nkind = \"perceptron\"\n[episode]\nsteps = 100\ntrials = 1\n{rest}\n\
         [files]\n\"bar.urdf\" = '''{BAR}'''\n"
    )
}

fn made(text: &str) -> Result<Box<dyn Evaluator>, farsa_lab::Error> {
    let made = ComposedExperiment::from_text("bar.toml", text, farsa_lab::strategy::strategies())?;
    made.prepare("", &Settings::new(made.settings(""))?)
}

fn refused(text: &str) -> String {
    made(text).err().unwrap_or_else(|| panic!("nothing is wrong with\n{text}")).to_string()
}

/// A trial in which the motors get this value all the time.
fn outcome(text: &str, y: f64) -> Outcome {
    let mut evaluator = made(text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let bias = farsa_num::ln(y / (1.0 - y));
    let names = evaluator.info().parameters.into_iter().map(|parameter| parameter.name);
    let parameters: Vec<f32> = names.map(|name| if name.starts_with("bias") { bias as f32 } else { 0.0 }).collect();
    evaluator.evaluate(Evaluation::new(&parameters, EpisodeId::default()), None)
}

/// Returns a term at the end.
fn measured(outcome: &Outcome, term: &str) -> f64 {
    let found = outcome.notes.iter().find(|(name, _)| *name == format!("measured {term}"));
    match found {
        Some((_, Note::Number(value))) => *value,
        other => panic!("{other:?}"),
    }
}

fn close(found: f64, wanted: f64, far: f64) {
    assert!((found - wanted).abs() <= far, "{found} where {wanted} is wanted");
}

const SPEED: &str = "[[reward]]\nkind = \"joint-speed\"\nover = \"end\"\nweight = 0.0";
const FELT: &str = "[[reward]]\nkind = \"sensor\"\nsensor = \"joint-position\"\nover = \"end\"\nweight = 0.0";

#[test]
fn joints_turn_as_fast_as_they_are_told() {
    let text = file("", "kind = \"joint-velocity\"\nlargest = 2.0\ngain = 50.0", SPEED);
    for (y, speed) in [(0.75, 1.0), (0.25, 1.0), (0.6, 0.4), (0.5, 0.0)] {
        close(measured(&outcome(&text, y), "joint-speed"), speed, 1e-3);
    }
    // The missing speed decays with the rate gain / inertia. After a time constant 1 - 1/e of the speed is reached.
    let slow = file("", "kind = \"joint-velocity\"\nlargest = 2.0\ngain = 0.26", SPEED);
    close(measured(&outcome(&slow, 0.75), "joint-speed"), 1.0 - farsa_num::exp(-1.0_f64), 5e-3);
}

#[test]
fn motors_of_speeds_have_no_more_torque_than_their_limit() {
    // 0.13 N m on 0.26 kg m2 add half a rad/s in each second, up to the commanded speed.
    let text = file("", "kind = \"joint-velocity\"\nlargest = 2.0\ngain = 50.0\nlimit = 0.13", SPEED);
    for (steps, speed) in [(50, 0.25), (100, 0.5), (180, 0.9), (300, 1.0)] {
        let text = text.replace("steps = 100", &format!("steps = {steps}"));
        close(measured(&outcome(&text, 0.75), "joint-speed"), speed, 5e-3);
    }
    let why = refused(&text.replace("gain = 50.0\n", "joints = [\"hinge\"]\n"));
    assert!(why.contains("lacks the key `gain`"), "{why}");
    let why = refused(&text.replace("limit = 0.13", "limit = -1.0"));
    assert!(why.contains("limit"), "{why}");
    assert!(refused(&text.replace("limit = 0.13", "limt = 1.0")).contains("`limit`"));
}

#[test]
fn torques_are_newton_s() {
    // 2 N m of the model's own motor, half of them for a second.
    let text = file("", "kind = \"joint-torque\"", SPEED).replace("steps = 100", "steps = 50");
    close(measured(&outcome(&text, 0.75), "joint-speed"), 0.5 / 0.26, 0.01);
    let more = file("", "kind = \"joint-torque\"\nlargest = 1.0", SPEED).replace("steps = 100", "steps = 50");
    close(measured(&outcome(&more, 0.75), "joint-speed"), 0.25 / 0.26, 0.01);
}

#[test]
fn servos_come_to_their_positions() {
    let motor = "kind = \"servo\"\nfrom = -1.0\nto = 1.0\nstiffness = 100.0\ndamping = 10.0\nlimit = 100.0";
    for (y, position) in [(0.75, 0.5), (0.9, 0.8)] {
        let found = outcome(&file("", motor, FELT).replace("steps = 100", "steps = 300"), y);
        close(measured(&found, "sensor"), position, 1e-3);
    }
}

#[test]
fn muscles_pull_against_each_other() {
    let motor = "kind = \"muscles\"\ntension = 100.0\nmoment_arm = 0.05";
    let text = file("", motor, &FELT.replace("over = \"end\"", "over = \"most\""));
    let mut evaluator = made(&text).expect("an evaluator");
    let names: Vec<String> = evaluator.info().parameters.into_iter().map(|parameter| parameter.name).collect();
    assert!(names.contains(&"bias of muscles 2".into()), "{names:?}");
    let mut pulled = |second: f32| {
        let own = |name: &String| match name.as_str() {
            "bias of muscles 1" => -second,
            "bias of muscles 2" => second,
            _ => 0.0,
        };
        let parameters: Vec<f32> = names.iter().map(own).collect();
        measured(&evaluator.evaluate(Evaluation::new(&parameters, EpisodeId::default()), None), "sensor")
    };
    // The agonist pulls towards the lower end.
    assert!(pulled(3.0) > 0.2, "{}", pulled(3.0));
    assert_eq!(pulled(-3.0), 0.0);
}

/// A ball falls by Newton's law, then rests on the floor, on a block, and next to a wall.
#[test]
fn things_fall_and_lie() {
    let motor = "kind = \"joint-velocity\"\nlargest = 1.0\ngain = 10.0";
    let ball = "[[objects]]\nname = \"ball\"\nkind = \"ball\"\nradius = 0.05\nmass = 0.2\nat = [2.0, 0.0, 1.05]";
    let moved = "[[reward]]\nkind = \"moved\"\nobject = \"ball\"\nover = \"end\"\nweight = 0.0";
    let fallen = |steps: u32, more: &str, world: &str| {
        let text = file(world, motor, &format!("{ball}\n{more}\n{moved}"));
        measured(&outcome(&text.replace("steps = 100", &format!("steps = {steps}")), 0.5), "moved")
    };
    close(fallen(40, "", ""), 0.5 * 9.81 * 0.16, 5e-3);
    close(fallen(300, "", ""), 1.0, 2e-3);
    close(fallen(40, "", "gravity = [0.0, 0.0, -1.62]"), 0.5 * 1.62 * 0.16, 1e-3);
    let block = "[[objects]]\nname = \"block\"\nkind = \"block\"\nsize = [0.4, 0.4, 0.3]\nmass = 5.0\nat = [2.0, 0.0]";
    close(fallen(300, block, ""), 0.7, 4e-3);
    let wall = "[[objects]]\nname = \"shelf\"\nkind = \"wall\"\nsize = [0.4, 0.4]\nheight = 0.5\nat = [2.0, 0.0]";
    close(fallen(300, wall, ""), 0.5, 2e-3);
    assert!(fallen(300, "", "floor = false") > 10.0);
}

/// The rod pushes a ball along, feels it, and ends the trial where that is asked for.
#[test]
fn what_is_in_the_way_is_pushed_and_felt() {
    let motor = "kind = \"joint-velocity\"\nlargest = 1.0\ngain = 50.0";
    let rest = "[[objects]]\nname = \"ball\"\nkind = \"ball\"\nradius = 0.1\nmass = 0.2\nat = [0.4, 0.4, 1.0]\n\
                [[reward]]\nkind = \"moved\"\nobject = \"ball\"\nover = \"end\"\nweight = 0.0\n\
                [[reward]]\nkind = \"touch\"\nbodies = [\"rod\"]\nwith = \"ball\"\nover = \"most\"\nweight = 0.0";
    let text = file("gravity = [0.0, 0.0, 0.0]", motor, rest);
    let pushed = outcome(&text, 0.9);
    assert!(measured(&pushed, "moved") > 0.05 && measured(&pushed, "touch") == 1.0, "{pushed:?}");
    let left = outcome(&text, 0.1);
    assert!(measured(&left, "moved") == 0.0 && measured(&left, "touch") == 0.0, "{left:?}");
    let ended = outcome(&text.replace("trials = 1", "trials = 1\nends = [\"collision\"]"), 0.9);
    assert!(ended.steps < pushed.steps && pushed.steps == 100, "{ended:?}");
}

#[test]
fn places_and_ways_are_those_of_the_point() {
    let motor = "kind = \"joint-velocity\"\nlargest = 1.0\ngain = 50.0";
    let rest = "[[objects]]\nname = \"there\"\nkind = \"marker\"\nat = [1.0, 0.0, 1.0]\n\
                [[start]]\nplace = \"hinge\"\nat = \"turned\"\nlow = 1.0\nhigh = 1.0\n\
                [[reward]]\nkind = \"distance\"\nobject = \"there\"\nbody = \"rod\"\npoint = [1.0, 0.0, 0.0]\nover = \"end\"\nweight = 0.0\n\
                [[reward]]\nkind = \"height\"\nbody = \"rod\"\npoint = [0.0, 0.0, 0.25]\nover = \"end\"\nweight = 0.0\n\
                [[reward]]\nname = \"up\"\nkind = \"position\"\nalong = [0.0, 0.0, 0.5]\nbody = \"rod\"\npoint = [0.0, 0.0, 0.25]\nover = \"end\"\nweight = 0.0\n\
                [[reward]]\nname = \"slanting\"\nkind = \"position\"\nalong = [0.6, 0.8, 0.0]\nbody = \"rod\"\npoint = [1.0, 0.0, 0.0]\nover = \"end\"\nweight = 0.0\n\
                [[reward]]\nkind = \"upright\"\nbody = \"rod\"\nover = \"end\"\nweight = 0.0\n\
                [[reward]]\nkind = \"near\"\nobject = \"there\"\nbody = \"rod\"\npoint = [1.0, 0.0, 0.0]\nwithin = 0.5\nweight = 0.0";
    let still = outcome(&file("", motor, rest), 0.5);
    // The chord of an angle of 1 rad.
    close(measured(&still, "distance"), 2.0 * farsa_num::sin_cos(0.5_f64).0, 1e-4);
    close(measured(&still, "height"), 1.25, 1e-4);
    assert_eq!(measured(&still, "up"), measured(&still, "height"));
    let [sine, cosine] = <[f64; 2]>::from(farsa_num::sin_cos(1.0_f64));
    close(measured(&still, "slanting"), 0.6 * cosine + 0.8 * sine, 1e-4);
    close(measured(&still, "upright"), 1.0, 1e-6);
    assert_eq!(measured(&still, "near"), 0.0);
    // It passes 0 within two thirds of the time without a stop, and continues to -0.5.
    let turned = outcome(&file("", motor, rest).replace("steps = 100", "steps = 300"), 0.25);
    close(measured(&turned, "distance"), 2.0 * farsa_num::sin_cos(0.25_f64).0, 0.02);
    close(measured(&turned, "near"), 1.0 / 1.5, 0.03);
}

/// A trial ends where a condition of failure holds, and does not succeed.
#[test]
fn failure_ends_a_trial() {
    let motor = "kind = \"joint-velocity\"\nlargest = 1.0\ngain = 50.0";
    let rest = format!(
        "{FELT}\n[[reward]]\nkind = \"steps\"\n[[success]]\nterm = \"steps\"\nabove = 0.5\n\
         [[failure]]\nterm = \"sensor\"\nabove = 0.2"
    );
    let text = file("", motor, &rest);
    let ended = outcome(&text, 0.9);
    assert!((20..30).contains(&ended.steps) && !ended.success, "{ended:?}");
    let lasted = outcome(&text, 0.5);
    assert!(lasted.steps == 100 && lasted.success, "{lasted:?}");
}

#[test]
fn what_breaks_down_has_failed() {
    let text =
        file("", "kind = \"joint-torque\"\nlargest = 1e6\n", SPEED).replace("effort=\"2\"", "effort=\"1000000\"");
    let broken = outcome(&text.replace("lower=\"-3\" upper=\"3\"", "lower=\"-1e8\" upper=\"1e8\""), 0.9);
    assert!(!broken.is_finite() && broken.steps < 5, "{broken:?}");
}

#[test]
fn lanes_have_the_same_bits_as_one_world() {
    // Arms with balls are among the files of tests/random.rs. These are the remaining ones.
    for file in ["reaching.toml", "hand-eye.toml"] {
        shown_in_lanes(file);
    }
}

fn shown_in_lanes(file: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../experiments").join(file);
    let made = ComposedExperiment::from_file(&path, farsa_lab::strategy::strategies()).expect("an experiment");
    let settings = Settings::new(made.settings("")).expect("settings");
    assert!(made.definition().is_some_and(|text| text.contains("<robot name=\"arm\">")));
    // The text of a run needs no other file.
    let kept = ComposedExperiment::from_text(
        "kept.toml",
        made.definition().expect("the text"),
        farsa_lab::strategy::strategies(),
    )
    .expect("an experiment");
    let mut evaluators =
        [made.prepare("", &settings).expect("an evaluator"), kept.prepare("", &settings).expect("an evaluator")];
    let parameters = vec![0.3; evaluators[0].info().parameters.len()];
    let [one, other] = &mut evaluators;
    for trial in 0..3 {
        let id = EpisodeId { seed: 3, trial, ..EpisodeId::default() };
        let found = [&mut *one, other].map(|evaluator| evaluator.evaluate(Evaluation::new(&parameters, id), None));
        assert_eq!(found[0], found[1]);
        let mut in_lanes = Vec::new();
        let lanes = one.in_lanes().expect("lanes");
        lanes.use_lanes(farsa_lab::advanced::Lanes::best()).expect("a batch");
        let mut next = Some(Evaluation::new(&parameters, id));
        lanes.run_in_lanes(&mut || next.take(), &mut |_, outcome| in_lanes.push(outcome));
        assert_eq!(in_lanes, [found[0].clone()]);
    }
}

#[cfg(feature = "rapier")]
#[test]
fn rapier_moves_the_same_robot() {
    let motor = "kind = \"joint-velocity\"\nlargest = 2.0\ngain = 50.0";
    let text = file("", motor, SPEED).replace("\"articulated\"", "\"rapier\"");
    close(measured(&outcome(&text, 0.75), "joint-speed"), 1.0, 0.02);
}

/// Models that are hostile are refused in bounded time.
#[test]
fn hostile_models_are_refused() {
    let motor = "kind = \"joint-velocity\"\nlargest = 1.0\ngain = 50.0";
    let right = file("", motor, "[[reward]]\nkind = \"steps\"");
    let text = right.split("[files]").next().expect("a beginning");
    for name in ["../bar.urdf", "/etc/passwd", "a/../../bar.urdf", "a\\\\bar.urdf"] {
        let found = refused(&text.replace("bar.urdf", name));
        assert!(found.contains("is not in the table `files`, and a text that is no file reads no others"), "{found}");
    }
    let with = |model: &str| format!("{text}[files]\n\"bar.urdf\" = '''{model}'''\n");
    let links = "<link name=\"l\"/>".repeat(30_000);
    let entity = "<!DOCTYPE x [<!ENTITY a \"aaaaaaaa\"><!ENTITY b \"&a;&a;&a;&a;\">]><robot name=\"&b;\"/>";
    for model in [&format!("<robot name=\"x\">{links}</robot>"), &"<a>".repeat(30_000), entity, "", "<robot/>"] {
        let found = refused(&with(model));
        assert!(found.contains("`robot.file`: bar.urdf"), "{found:.300}");
    }
    // Meshes are left out, and their files not opened.
    assert!(made(&with(&BAR.replace("<sphere radius=\"0.1\"/>", "<mesh filename=\"/etc/passwd\"/>"))).is_ok());
    let huge = right.replace("mass value=\"1\"", "mass value=\"1e300\"");
    assert!(made(&huge).is_err() || !outcome(&huge, 0.9).is_finite());
}

#[test]
fn what_is_wrong_is_said() {
    let motor = "kind = \"joint-velocity\"\nlargest = 1.0\ngain = 50.0";
    let right = file("", motor, "[[reward]]\nkind = \"steps\"");
    let with = |reward: &str| file("", motor, &format!("[[reward]]\n{reward}"));
    let ball = "[[objects]]\nname = \"ball\"\nkind = \"ball\"\nradius = 0.1\nmass = 0.2";
    let object = |object: &str| file("", motor, &format!("[[objects]]\n{object}\n[[reward]]\nkind = \"steps\""));
    let start = |start: &str| file("", motor, &format!("{ball}\n[[start]]\n{start}\n[[reward]]\nkind = \"steps\""));
    let motor_of = |motor: &str| file("", motor, "[[reward]]\nkind = \"steps\"");
    for (text, why) in [
        (
            right.replace("\"articulated\"", "\"arena\""),
            "line 2: `world.engine`: `arena` is for robots on wheels; this one has joints",
        ),
        (
            right.replace("kind = \"model\"\nfile = \"bar.urdf\"", "kind = \"e-puck\""),
            "line 2: `world.engine`: `articulated` is for robots with joints",
        ),
        (right.replace("file = \"bar.urdf\"\n", ""), "`robot`: lacks the key `file`, that of the model"),
        (
            right
                .replace("[files]", "[files]\n\"other\" = \"\"")
                .replace("file = \"bar.urdf\"", "file = \"baar.urdf\""),
            "unknown file `baar.urdf`; the nearest is `bar.urdf`",
        ),
        (right.replace("<axis", "<axes"), "`robot.file`: bar.urdf: text line 4: unknown element of joint `axes`"),
        (right.replace("<robot name=\"bar\">", "<robot>"), "ok"),
        (right.replace("kind = \"model\"", "kind = \"model\"\ncount = 2"), "`robot.count`: is for robots on wheels"),
        (with("kind = \"distance\"\nobject = \"bal\""), "unknown object `bal`; the nearest is `base`"),
        (with("kind = \"height\"\nbody = \"rodd\""), "unknown body `rodd`; the nearest is `rod`"),
        (with("kind = \"held\""), "is for robots on wheels; this one has joints"),
        (with("kind = \"joint-speed\"\njoints = [\"hing\"]"), "unknown joint `hing`; the nearest is `hinge`"),
        (with("kind = \"progress\"\nalong = [0.0, 0.0, 0.0]"), "points nowhere"),
        (with("kind = \"position\"\nalong = [0.0, 0.0, 0.0]"), "points nowhere"),
        (
            with("kind = \"position\"\nalong = [1.0, 0.0, 0.0]\nbody = \"rodd\""),
            "unknown body `rodd`; the nearest is `rod`",
        ),
        (with("kind = \"touch\"\nbodies = [\"base\"]"), "can touch nothing"),
        (object("name = \"floor\"\nkind = \"marker\"\nat = [0.0, 0.0]"), "`floor` names something else already"),
        (object("name = \"rod\"\nkind = \"marker\"\nat = [0.0, 0.0]"), "`rod` names something else already"),
        (
            object("name = \"disc\"\nkind = \"disc\"\nradius = 1.0\ncolor = [0.0, 0.0, 0.0]"),
            "is for robots on wheels; next to one with joints are",
        ),
        (
            object("name = \"ball\"\nkind = \"ball\"\nradius = 0.1\nmass = 0.2"),
            "lacks the key `at`, and no `[[start]]` places it",
        ),
        (
            start("place = \"ball\"\nat = \"anywhere\""),
            "is for robots on wheels; next to one with joints it is `in-box` or `fixed`",
        ),
        (start("place = \"ball\"\nat = \"turned\"\nlow = 0.0\nhigh = 1.0"), "is for joints; this is none"),
        (start("place = \"hinge\"\nat = \"fixed\"\npoint = [0.0, 0.0, 0.0]"), "a joint is `turned`"),
        (start("place = \"hinge\"\nat = \"turned\"\nlow = 1.0\nhigh = 0.0"), "from 1 to 0 runs backwards"),
        (start("place = \"ball\"\nat = \"fixed\"\npoint = [0.0, 0.0]"), "has 2 values where 3 are wanted"),
        (start("place = \"robot\"\nat = \"fixed\"\npoint = [0.0, 0.0, 0.0]"), "`robot` stands in the world"),
        (
            start("place = \"ball\"\nat = \"in-box\"\nlow = [0.0, 0.0, 1.0]\nhigh = [1.0, 1.0, 0.0]"),
            "has a `low` above its `high`",
        ),
        (motor_of("kind = \"wheels\""), "is for robots on wheels; this one has joints"),
        (motor_of("kind = \"servo\""), "is for joints that the robot does not have"),
        (
            motor_of("kind = \"servo\"\njoints = [\"hinge\"]"),
            "lacks the key `stiffness`: `hinge` has no such motor of its own",
        ),
        (motor_of("kind = \"servo\"\njoints = [\"hinge\"]\ndamping = 1.0"), "lacks the key `stiffness`"),
        (motor_of("kind = \"muscles\"\ntension = 10.0"), "has one of `tension` and `moment_arm`, which go together"),
        (
            motor_of("kind = \"joint-torque\"\n[[motors]]\nkind = \"joint-torque\""),
            "`hinge` has a motor of this kind already",
        ),
    ] {
        if why == "ok" {
            assert!(made(&text).is_ok());
            continue;
        }
        let found = refused(&text);
        assert!(found.contains(why) && found.starts_with("bar.toml"), "{found}\nwhere\n{why}\nis wanted of\n{text}");
    }
    let start = "place = \"ball\"\nat = \"in-box\"\nlow = [0.0, 0.0, 0.0]\nhigh = [0.1, 0.1, 0.1]\napart = 1.0";
    let two = format!(
        "{ball}\n{}\n[[start]]\nplace = \"bull\"\nat = \"fixed\"\npoint = [0.0, 0.0, 0.0]\n[[start]]\n{start}\n[[reward]]\nkind = \"steps\"",
        ball.replace("\"ball\"\nkind", "\"bull\"\nkind")
    );
    assert!(refused(&file("", motor, &two)).contains("finds no free place after a thousand tries"));
}

#[test]
fn a_marker_follows_the_choice_of_another() {
    let marker = |name: &str, z: f64, like: &str| {
        format!(
            "[[objects]]\nname = \"{name}\"\nkind = \"marker\"\n[[start]]\nplace = \"{name}\"\nat = \"one-of\"\n\
             points = [[1, 0, {z}], [2, 0, {z}], [3, 0, {z}]]\n{like}[[reward]]\nname = \"{name}\"\nkind = \"distance\"\n\
             object = \"{name}\"\nover = \"end\"\n"
        )
    };
    let motor = "kind = \"joint-torque\"";
    let text = file("", motor, &[marker("sign", 1.0, ""), marker("goal", 2.0, "like = \"sign\"\n")].concat());
    let mut evaluator = made(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let still = vec![0.0; evaluator.info().parameters.len()];
    let mut seen = [false; 3];
    for trial in 0..40 {
        let id = EpisodeId { seed: 1, trial, ..EpisodeId::default() };
        let terms = evaluator.evaluate(Evaluation::new(&still, id), None).terms;
        let [sign, goal] = [terms[0] * terms[0] - 1.0, terms[1] * terms[1] - 4.0];
        assert!((sign - goal).abs() < 1e-4, "{terms:?}");
        seen[sign.sqrt().round() as usize - 1] = true;
    }
    assert_eq!(seen, [true; 3]);
}
