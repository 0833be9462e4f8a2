//! Quantities of the channels of exported controllers, and the robots and options that are exported with them.

use farsa_lab::Evaluator;
use farsa_lab::exports::{Exports, MotorDrive, SensorReading};

use crate::made;

/// Replaces the wired network of a file, which no export has, by a perceptron.
fn searched(text: &str) -> String {
    let line = |line: &str| match line.split_once(" = ") {
        Some(("network", _)) => "network = { kind = \"perceptron\" }\n".to_owned(),
        _ => format!("{line}\n"),
    };
    text.lines().map(line).collect()
}

/// Describes the channels of sensors and of motors: quantity, unit, and the values at 0 and 1 unless they are 0 and 1.
fn channels(evaluator: &dyn Evaluator) -> [Vec<String>; 2] {
    let parameters = vec![0.0; evaluator.info().parameters.len()];
    let export = evaluator.exports().and_then(|exports| exports.controller(&parameters)).expect("a controller");
    let between = |ends: [f64; 2]| match ends {
        [0.0, 1.0] => String::new(),
        [zero, one] => format!(", {zero:.3} to {one:.3}"),
    };
    let sensor = |reads: &SensorReading| match reads {
        SensorReading::Quantity { quantity, unit, zero, one, linear } => {
            format!("{quantity}, {unit}{}{}", between([*zero, *one]), if *linear { "" } else { ", curved" })
        }
        other => panic!("{other:?}"),
    };
    let motor = |drives: &MotorDrive| match drives {
        MotorDrive::Quantity { quantity, unit, zero, one } => format!("{quantity}, {unit}{}", between([*zero, *one])),
        other => panic!("{other:?}"),
    };
    [
        export.sensors.iter().map(|channel| sensor(&channel.reads)).collect(),
        export.motors.iter().map(|channel| motor(&channel.drives)).collect(),
    ]
}

/// Compares channels with texts, in which `{a|b}` is short for one text with a and one with b.
#[track_caller]
fn check(found: &[String], wanted: &[&str], what: &str) {
    let spread = |text: &&str| {
        let Some((before, rest)) = text.split_once('{') else { return vec![(*text).to_owned()] };
        let (words, after) = rest.split_once('}').expect("an end");
        words.split('|').map(|word| format!("{before}{word}{after}")).collect()
    };
    assert_eq!(found, wanted.iter().flat_map(spread).collect::<Vec<String>>(), "{what}");
}

/// The channels of one sensor of an e-puck.
fn sensed(keys: &str) -> Vec<String> {
    let text = format!(
        "robot = {{ kind = \"e-puck\" }}\nsensors = [{{ {keys} }}]\nmotors = [{{ kind = \"wheels\" }}]\n\
         network = {{ kind = \"perceptron\" }}\nepisode = {{ steps = 3, trials = 1 }}\nreward = [{{ kind = \"steps\" }}]\n\
         objects = [{{ name = \"lamp\", kind = \"cylinder\", radius = 0.02, at = [0.5, 0.4] }}, \
         {{ name = \"nest\", kind = \"disc\", radius = 0.1, at = [0.3, 0.2], color = [0, 0, 0] }}]\n\
         foraging = {{ nest = \"nest\" }}\n[files]\n\"wall.sam\" = '''{TABLE}'''\n"
    );
    let [sensors, _] = channels(made(&text).unwrap_or_else(|error| panic!("{error}\n{text}")).as_ref());
    sensors
}

const TABLE: &str = "8 4 1 0 50\nTURN 0\n512 64 512 64 512 64 0 0\n0 256 0 256 0 256 0 256\n\
    16 32 48 80 96 112 128 144\n256 0 256 0 256 0 256 0\nEND\n";

/// Infrared sensors and lights are at 90, 54, 18, -18, -54, -90, -150 and 150 degrees. Sensors end 0.05 m from the hull.
#[test]
fn rings_of_sensors_are_described_by_their_directions() {
    let near = |degrees: i32, ends: &str| {
        format!("distance of what is near, at {degrees} degrees to the left of ahead, m, {ends}")
    };
    let angles = [90, 54, 18, -18, -54, -90, -150, 150];
    // The formula reads 0 at 33 mm from a wall and 1 at 13 mm.
    assert_eq!(sensed("kind = \"infrared\""), angles.map(|angle| near(angle, "0.033 to 0.013, curved")));
    assert_eq!(
        sensed("kind = \"infrared\", first = 2"),
        [near(90, "0.033 to 0.013, curved"), near(54, "0.033 to 0.013, curved")]
    );
    let rays = "kind = \"infrared\", model = \"rays\"";
    assert_eq!(sensed(rays), angles.map(|angle| near(angle, "0.050 to 0.000")));
    let group = |degrees: i32| {
        format!(
            "distance of what is near, the nearest of 2 sensors around {degrees} degrees to the left of ahead, m, 0.050 to 0.000"
        )
    };
    assert_eq!(sensed(&format!("{rays}, groups = 4")), [90, 18, -54, -150].map(group));
    let tables = "kind = \"infrared\", model = \"tables\", tables = { walls = \"wall.sam\" }";
    assert_eq!(sensed(tables), angles.map(|angle| near(angle, "0.050 to 0.000, curved")));
    let light = |degrees: i32| format!("light, at {degrees} degrees to the left of ahead, 1");
    assert_eq!(sensed("kind = \"light\""), angles.map(light));
}

/// A file may change the reach of infrared sensors.
#[test]
fn infrared_sensors_reach_as_far_as_the_file_says() {
    let text = "robot = { kind = \"e-puck\", infrared_range = 0.12 }\nsensors = [{ kind = \"infrared\", model = \"rays\", first = 1 }]\n\
        motors = [{ kind = \"wheels\" }]\nnetwork = { kind = \"perceptron\" }\nreward = [{ kind = \"steps\" }]\n";
    let [sensors, _] = channels(made(text).unwrap_or_else(|error| panic!("{error}")).as_ref());
    assert_eq!(sensors, ["distance of what is near, at 90 degrees to the left of ahead, m, 0.120 to 0.000"]);
}

/// The largest speed of a wheel is 0.144 / 0.0205 rad/s.
#[test]
fn sensors_of_wheeled_robots_are_described() {
    for (keys, wanted) in [
        ("kind = \"ground-color\"", &["grey of the ground at place {1|2|3}, 1"][..]),
        ("kind = \"ground-color\", middle = true", &["grey of the ground under the middle, 1"]),
        (
            "kind = \"ground-color\", rgb = true, first = 2",
            &["{red|green|blue} of the ground at place 1, 1", "{red|green|blue} of the ground at place 2, 1"],
        ),
        (
            "kind = \"laser-distance\", beams = 2, field_of_view = 90, range = 0.22",
            &["distance along beam {1|2} from the left, m, 0.000 to 0.220"],
        ),
        (
            "kind = \"camera\", field_of_view = 96, sectors = 2, rays = 3, range = 1.2, colors = [\
             { name = \"blue\", low = [0, 0, 0.5], high = [0.3, 0.3, 1] }, { name = \"red\", low = [0.7, 0.1, 0], high = [0.9, 0.3, 0.2] }]",
            &[
                "share of sector 1 from the left that is {blue|red}, 1",
                "share of sector 2 from the left that is {blue|red}, 1",
            ],
        ),
        ("kind = \"wheel-speed\"", &["speed of the {left|right} wheel, rad/s, -7.024 to 7.024"]),
        ("kind = \"wheel-speed\", signed = true", &["speed of the {left|right} wheel, rad/s, 0.000 to 7.024"]),
        (
            "kind = \"traction\", largest = 0.3",
            &[
                "speed at which the robot is pulled ahead, m/s, 0.000 to 0.300",
                "speed at which the robot is pulled to the left, m/s, 0.000 to 0.300",
            ],
        ),
        ("kind = \"signal\", range = 1.0, sectors = 2", &["signal in sector {1|2} counter-clockwise from ahead, 1"]),
        ("kind = \"attachment\"", &["whether something is held, 1"]),
        ("kind = \"touch\"", &["whether something is touched, 1"]),
        ("kind = \"contact-force\"", &["force, N"]),
        (
            "kind = \"target-position\", target = \"lamp\", scale = 4.0",
            &["{x|y|z} of the way to lamp, m, 0.000 to 0.250"],
        ),
        (
            "kind = \"body-velocity\"",
            &["{x|y|z} of the robot's velocity, m/s", "{x|y|z} of the robot's angular velocity, rad/s"],
        ),
        ("kind = \"body-pose\"", &["{x|y|z} of the robot, m", "{x|y|z|w} of the robot's orientation, 1"]),
        ("kind = \"height\"", &["height of the robot, m"]),
        (
            "kind = \"joint-position\", from = -1.0, to = 4.0",
            &["angle of the {left|right} wheel, rad, -1.000 to 4.000"],
        ),
        ("kind = \"joint-speed\", joints = [\"right-wheel\"]", &["speed of the right wheel, rad/s"]),
        ("kind = \"energy\"", &["energy, 0 dead, 1"]),
        ("kind = \"carried\"", &["whether food is carried, 1"]),
        ("kind = \"constant\", value = 0.3", &["always 0.3, 1"]),
        // Wrappers of sensors act in their order.
        (
            "kind = \"touch\", wrappers = [{ kind = \"scale\", gain = 2.0 }, { kind = \"delay\", steps = 3 }]",
            &["whether something is touched, with a factor of 2, then a delay of 3 steps, 1"],
        ),
    ] {
        check(&sensed(keys), wanted, keys);
    }
    // A scale of 0 has no end.
    let none = sensed("kind = \"target-position\", target = \"lamp\", scale = 0.0");
    assert_eq!(none[1], "y of the way to lamp, m");
}

/// The wheels of a `MarXbot` turn at up to 10 rad/s.
#[test]
fn motors_of_wheeled_robots_are_described() {
    for (keys, wanted) in [
        ("kind = \"wheels\"", &["speed of the {left|right} wheel, rad/s, -10.000 to 10.000"][..]),
        (
            "kind = \"speed-and-turn\"",
            &[
                "s, the mean of the wheels' speeds, rad/s, -10.000 to 10.000",
                "t: the left wheel turns at s - t, the right one at s + t, rad/s, -10.000 to 10.000",
            ],
        ),
        (
            "kind = \"speed-and-turn\", forwards = true",
            &[
                "s, the mean of the wheels' speeds, rad/s, 0.000 to 10.000",
                "t: the left wheel turns at s - t, the right one at s + t, rad/s, -10.000 to 10.000",
            ],
        ),
        ("kind = \"leds\", colors = [\"blue\", \"red\"]", &["brightness of the {blue|red} LED, 1"]),
        ("kind = \"signal\"", &["what is signalled, 1"]),
        ("kind = \"attachment\"", &["the attachment device: more than 1/2 holds, 1"]),
        // The last wrapper of a motor is applied first.
        (
            "kind = \"signal\", wrappers = [{ kind = \"scale\", gain = 2.0 }, { kind = \"delay\", steps = 3 }]",
            &["what is signalled, with a delay of 3 steps, then a factor of 2, 1"],
        ),
    ] {
        let text = format!(
            "robot = {{ kind = \"marxbot\" }}\nsensors = [{{ kind = \"touch\" }}]\nmotors = [{{ {keys} }}]\n\
             network = {{ kind = \"perceptron\" }}\nreward = [{{ kind = \"steps\" }}]\n"
        );
        let [_, motors] = channels(made(&text).unwrap_or_else(|error| panic!("{error}\n{text}")).as_ref());
        check(&motors, wanted, keys);
    }
}

/// Each group has the quantities of its kind of robot: 7.024 rad/s of an e-puck and 10 of a `MarXbot`.
#[test]
fn populations_have_the_quantities_of_their_robots() {
    let text = "team = { coevolution = true }\n\
        robots = [{ name = \"a\", kind = \"e-puck\", count = 2 }, { name = \"b\", kind = \"marxbot\" }]\n\
        sensors = [{ kind = \"wheel-speed\" }]\nmotors = [{ kind = \"wheels\" }]\n\
        network = { kind = \"perceptron\" }\nreward = [{ kind = \"steps\" }]\n";
    let strategies = farsa_lab::strategy::strategies();
    let made = farsa_compose::ComposedExperiment::from_text("values.toml", text, strategies).expect("an experiment");
    let mut settings = farsa_lab::Experiment::settings(&made, "");
    settings.push(farsa_lab::Setting::whole("evolution.population", 4, 1..=100));
    let settings = farsa_lab::Settings::new(settings).expect("settings");
    let evaluator = farsa_lab::Experiment::prepare(&made, "", &settings).expect("an evaluator");
    let parameters = vec![0.0; evaluator.info().parameters.len()];
    for (population, largest) in [(0, 0.144 / 0.0205), (1, 10.0)] {
        let exports = evaluator.exports().expect("exports");
        let export = exports.controller_of(population, &parameters).expect("a controller");
        let SensorReading::Quantity { zero, one, .. } = export.sensors[1].reads else { panic!("{export:?}") };
        assert_eq!([zero, one], [-largest, largest]);
        let MotorDrive::Quantity { zero, one, .. } = export.motors[1].drives else { panic!("{export:?}") };
        assert_eq!([zero, one], [-largest, largest]);
    }
}

const BALL: &str = "[[objects]]\nname = \"ball\"\nkind = \"ball\"\nradius = 0.1\nmass = 0.3\nat = [1.4, 0.2, 0.8]\n\
    [[objects]]\nname = \"mark\"\nkind = \"marker\"\nat = [1.0, 0.2, 0.3]\n";

#[test]
fn sensors_of_robots_with_joints_are_described() {
    let eye = "eye = { columns = 2, rows = 3, field_of_view = 60, range = 1.0 }";
    let pixel = |column: usize, row: usize| {
        ["red", "green", "blue"].map(|color| format!("{color} of the pixel in column {column}, row {row}, 1"))
    };
    let pixels: Vec<String> = (0..3).flat_map(|row| (0..2).flat_map(move |column| pixel(column, row))).collect();
    let pixels: Vec<&str> = pixels.iter().map(String::as_str).collect();
    for (keys, wanted) in [
        (
            "kind = \"joint-position\"".to_owned(),
            &["position of hinge, rad, -2.000 to 2.400", "position of rail, m, -0.500 to 0.700"][..],
        ),
        (
            "kind = \"joint-position\"\njoints = [\"rail\"]\nfrom = 0.4\nto = -0.2".into(),
            &["position of rail, m, 0.400 to -0.200"],
        ),
        (
            "kind = \"joint-speed\"\njoints = [\"rail\", \"hinge\"]".into(),
            &["speed of rail, m/s", "speed of hinge, rad/s"],
        ),
        ("kind = \"touch\"".into(), &["whether something is touched, 1"]),
        ("kind = \"contact-force\"".into(), &["force, N"]),
        (
            "kind = \"target-position\"\ntarget = \"mark\"\nbody = \"sled\"\nscale = -2.0".into(),
            &["{x|y|z} of the way from sled to mark, m, 0.000 to -0.500"],
        ),
        (
            "kind = \"body-pose\"\nbody = \"bar\"".into(),
            &["{x|y|z} of bar, m", "{x|y|z|w} of the orientation of bar, 1"],
        ),
        (
            "kind = \"body-velocity\"\nbody = \"bar\"".into(),
            &[
                "{x|y|z} of the velocity of bar in its axes, m/s",
                "{x|y|z} of the angular velocity of bar in its axes, rad/s",
            ],
        ),
        ("kind = \"height\"\nbody = \"sled\"".into(), &["height of sled, m"]),
        ("kind = \"constant\"\nvalue = -0.2".into(), &["always -0.2, 1"]),
        (format!("kind = \"camera-image\"\n{eye}"), &pixels),
        (
            format!(
                "kind = \"color-blobs\"\n{eye}\ncolors = [{{ name = \"blue\", low = [0, 0, 0.5], high = [0.3, 0.3, 1] }}, {{ name = \"red\", low = [0.7, 0, 0], high = [1, 0.3, 0.2] }}]"
            ),
            &[
                "halves of the image's width that blue is to the left, 1",
                "halves of the image's width that blue is upwards, 1",
                "share of the pixels that are blue, 1",
                "halves of the image's width that red is to the left, 1",
                "halves of the image's width that red is upwards, 1",
                "share of the pixels that are red, 1",
            ],
        ),
        (
            format!("kind = \"visual-offset\"\n{eye}\nof = \"ball\"\nfrom = \"sled\""),
            &[
                "widths of the image that ball is to the left of sled, 1",
                "widths of the image that ball is above of sled, 1",
            ],
        ),
    ] {
        let rest = format!("{BALL}[[sensors]]\nname = \"own\"\n{keys}\n[[reward]]\nkind = \"steps\"\n");
        let text = searched(&crate::joints::pair("kind = \"joint-torque\"", &[0.5, 0.5], 2, &rest));
        let [sensors, _] = channels(made(&text).unwrap_or_else(|error| panic!("{error}\n{text}")).as_ref());
        // The first four channels are those of other sensors.
        check(&sensors[4..], wanted, &keys);
    }
}

#[test]
fn motors_of_robots_with_joints_are_described() {
    for (keys, wanted) in [
        // The limits of the model are 4 N m and 5 N.
        (
            "kind = \"joint-torque\"",
            &["torque of hinge, N m, -4.000 to 4.000", "torque of rail, N, -5.000 to 5.000"][..],
        ),
        (
            "kind = \"joint-torque\", largest = 2.0, joints = [\"rail\", \"hinge\"]",
            &["torque of rail, N, -2.000 to 2.000", "torque of hinge, N m, -2.000 to 2.000"],
        ),
        (
            "kind = \"joint-velocity\", largest = 3.0, gain = 1.7",
            &["speed of hinge, rad/s, -3.000 to 3.000", "speed of rail, m/s, -3.000 to 3.000"],
        ),
        (
            "kind = \"servo\", stiffness = 40.0",
            &["position of hinge, rad, -2.000 to 2.400", "position of rail, m, -0.500 to 0.700"],
        ),
        (
            "kind = \"servo\", stiffness = 40.0, from = 0.3, to = -0.4, together = true",
            &["position of hinge and all with it, rad, 0.300 to -0.400"],
        ),
        (
            "kind = \"muscles\", tension = 60.0, moment_arm = 0.05",
            &[
                "activation of the {agonist|antagonist} of hinge, 1",
                "activation of the {agonist|antagonist} of rail, 1",
            ],
        ),
    ] {
        let text = searched(&crate::joints::pair(keys, &[], 2, "[[reward]]\nkind = \"steps\"\n"));
        let [_, motors] = channels(made(&text).unwrap_or_else(|error| panic!("{error}\n{text}")).as_ref());
        check(&motors, wanted, keys);
    }
}

/// Without names, a motor drives the joints with an actuator of its kind.
#[test]
fn motors_of_a_model_drive_the_joints_of_their_kind() {
    let body = |name: &str| {
        format!(
            "<body name=\"{name}\"><joint name=\"to-{name}\" axis=\"0 0 1\" range=\"-100 50\"/><inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"1 1 1\"/></body>"
        )
    };
    let bodies = ["a", "b", "c"].map(body).concat();
    let model = format!(
        "<mujoco><worldbody>{bodies}</worldbody><actuator><position joint=\"to-a\" kp=\"7\"/>\
         <motor joint=\"to-b\" ctrllimited=\"true\" ctrlrange=\"-4 4\"/><velocity joint=\"to-c\" kv=\"3\"/></actuator></mujoco>"
    );
    for (keys, wanted) in [
        ("kind = \"joint-torque\"", "torque of to-b, N m, -4.000 to 4.000"),
        ("kind = \"joint-velocity\", largest = 0.5", "speed of to-c, rad/s, -0.500 to 0.500"),
        ("kind = \"servo\"", "position of to-a, rad, -1.745 to 0.873"),
    ] {
        let text = format!(
            "world = {{ engine = \"articulated\", time_step = 0.06, substeps = 4, gravity = [0.1, 0.2, -0.3] }}\n\
             robot = {{ kind = \"model\", file = \"abc.xml\" }}\nsensors = [{{ kind = \"joint-speed\" }}]\nmotors = [{{ {keys} }}]\n\
             network = {{ kind = \"perceptron\" }}\nreward = [{{ kind = \"steps\" }}]\n[files]\n\"abc.xml\" = '''{model}'''\n"
        );
        let evaluator = made(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        let [sensors, motors] = channels(evaluator.as_ref());
        check(&motors, &[wanted], keys);
        assert_eq!(sensors.len(), 3);
        // MuJoCo makes the steps of the dynamics.
        let options = evaluator.exports().and_then(Exports::mjcf_options).expect("options");
        assert_eq!((options.time_step, options.gravity), (0.06 / 4.0, [0.1, 0.2, -0.3]));
    }
}
