//! Settings of the values of a file: keys, defaults, units, descriptions and allowed values.

use farsa_compose::ComposedExperiment;
use farsa_lab::advanced::Value;
use farsa_lab::{Experiment as _, Setting, Settings};

use crate::steps::Steps;

const TEXT: &str = r#"[world]
size = [1.5, 2.5]
[[objects]]
name = "lamp"
kind = "cylinder"
radius = 0.02
lamp = 0.7
[robot]
kind = "e-puck"
[[sensors]]
kind = "body-pose"
wrappers = [{ kind = "lesion", channels = [0, 1] }, { kind = "scale", gain = 2.0 }, { kind = "scale", gain = 3.0 }]
[[sensors]]
kind = "constant"
value = 0.4
[[sensors]]
kind = "constant"
value = 0.6
[[motors]]
kind = "wheels"
[network]
kind = "wired"
bias = [0.5, 0.5]
wires = [{ name = "one", from = ["constant"], to = "wheels left", weight = 0.1 }]
[episode]
steps = 4
trials = 2
[[start]]
place = "lamp"
at = "fixed"
point = [0.4, 0.3]
[[start]]
place = "robot"
at = "fixed"
point = [0.8, 1.1]
heading = 37
[[reward]]
kind = "approach"
object = "lamp"
[[success]]
term = "approach"
above = 0.1
[strategy]
name = "truncation"
[evolution]
population = 20
parents = 4
[[conditions]]
name = "plain"
[[conditions]]
name = "slow"
settings = { "world.time_step" = 0.02, "evolution.parents" = 2 }
"#;

fn made(text: &str) -> ComposedExperiment {
    let made = ComposedExperiment::from_text("own.toml", text, farsa_lab::strategy::strategies());
    made.unwrap_or_else(|error| panic!("{error}"))
}

fn setting(made: &ComposedExperiment, condition: &str, key: &str) -> Setting {
    let settings = made.settings(condition);
    let keys: Vec<String> = settings.iter().map(|setting| setting.key().to_owned()).collect();
    let found = settings.into_iter().find(|setting| setting.key() == key);
    found.unwrap_or_else(|| panic!("no `{key}` in {keys:?}"))
}

#[test]
fn values_of_a_file_are_settings() {
    let made = made(TEXT);
    for (key, default, unit, allowed) in [
        ("world.size", Value::Numbers(vec![1.5, 2.5]), "", "2 numbers, each 0.05 to 1000.0"),
        ("world.walls", Value::Flag(true), "", "true or false"),
        ("world.time_step", Value::Number(0.05), "s", "0.001 to 0.2"),
        ("world.engine", Value::Word("arena".into()), "", "arena, rapier or articulated"),
        ("world.gravity", Value::Numbers(vec![0.0, 0.0, -9.81]), "", "3 numbers, each -1000.0 to 1000.0"),
        ("objects.lamp.radius", Value::Number(0.02), "m", "0.0001 to 100.0"),
        (
            "sensors.body-pose.wrappers.lesion.channels",
            Value::Numbers(vec![0.0, 1.0]),
            "",
            "2 numbers, each 0.0 to 65535.0",
        ),
        ("sensors.body-pose.wrappers.scale.gain", Value::Number(2.0), "", "-1000000.0 to 1000000.0"),
        ("sensors.body-pose.wrappers.scale-2.gain", Value::Number(3.0), "", "-1000000.0 to 1000000.0"),
        ("sensors.constant.value", Value::Number(0.4), "", ""),
        ("sensors.constant-2.value", Value::Number(0.6), "", ""),
        ("network.wires.one.weight", Value::Number(0.1), "", ""),
        ("episode.steps", Value::Whole(4), "", "1 to 1000000"),
        ("start.robot.heading", Value::Number(37.0), "deg", "-360.0 to 360.0"),
        ("start.lamp.point", Value::Numbers(vec![0.4, 0.3]), "m", "2 numbers, each -1000.0 to 1000.0"),
        ("reward.approach.over", Value::Word("mean".into()), "", "mean, sum, end or most"),
        ("success.approach.above", Value::Number(0.1), "", ""),
        ("evolution.parents", Value::Whole(4), "", ""),
    ] {
        let found = setting(&made, "plain", key);
        assert_eq!((found.default_value(), found.unit_name()), (&default, unit), "{key}");
        if !allowed.is_empty() {
            assert_eq!(found.allowed(), allowed, "{key}");
        }
        assert!(!found.doc_text().is_empty() && !found.doc_text().ends_with(" [m]"), "{key}: {}", found.doc_text());
    }
    assert_eq!(setting(&made, "", "world.time_step").doc_text(), "Control step");
    let keys: Vec<String> = made.settings("plain").iter().map(|setting| setting.key().to_owned()).collect();
    // Names, kinds and tables that name other things are no settings.
    for key in [
        "robot.kind",
        "objects.lamp.name",
        "objects.lamp.kind",
        "summary",
        "conditions",
        "strategy.name",
        "genome.bits",
    ] {
        let inside = format!("{key}.");
        let found: Vec<&String> = keys.iter().filter(|known| *known == key || known.starts_with(&inside)).collect();
        assert_eq!(key == "robot.kind", !found.is_empty(), "{key}: {found:?}");
    }
    let sorted = keys.iter().collect::<std::collections::BTreeSet<_>>().len();
    assert_eq!(sorted, keys.len(), "each key is there once");
}

/// A condition changes the defaults of some settings, and is the place of the new defaults.
#[test]
fn conditions_have_their_own_defaults() {
    let made = made(TEXT);
    assert_eq!(made.conditions(), ["plain", "slow"]);
    for (condition, step, parents, place) in
        [("plain", 0.05, 4, "own.toml line 47"), ("slow", 0.02, 2, "own.toml line 52")]
    {
        assert_eq!(setting(&made, condition, "world.time_step").default_value(), &Value::Number(step), "{condition}");
        let parents_of = setting(&made, condition, "evolution.parents");
        assert_eq!((parents_of.default_value(), parents_of.place()), (&Value::Whole(parents), place), "{condition}");
        let settings = Settings::new(made.settings(condition)).expect("settings");
        let evaluator = made.prepare(condition, &settings).expect("an evaluator");
        assert_eq!(evaluator.info().description.step_seconds, step, "{condition}");
    }
    assert_eq!(
        (made.gene_bits(), made.strategy("").name(), made.strategy_place()),
        (16, "truncation", "own.toml line 44".into())
    );
    let twelve = ComposedExperiment::from_text(
        "own.toml",
        &format!("{TEXT}[genome]\nbits = 12\n"),
        farsa_lab::strategy::strategies(),
    );
    assert_eq!(twelve.expect("an experiment").gene_bits(), 12);
}

/// Set values replace those of the file: lists of whole numbers, numbers, flags and words.
#[test]
fn set_values_replace_those_of_the_file() {
    let made = made(TEXT);
    let recorded = |changes: &[(&str, Value)]| {
        let mut settings = Settings::new(made.settings("plain")).expect("settings");
        for (key, value) in changes {
            settings.set("own", key, value.clone()).unwrap_or_else(|error| panic!("{error}"));
        }
        let mut evaluator = made.prepare("plain", &settings).unwrap_or_else(|error| panic!("{error}"));
        let parameters = vec![0.0; evaluator.info().parameters.len()];
        let mut steps = Steps::default();
        let id = farsa_lab::EpisodeId::default();
        let outcome = evaluator.evaluate(farsa_lab::Evaluation::new(&parameters, id), Some(&mut steps));
        (outcome, steps.all[0].clone())
    };
    // x = 0.8 and y = 1.1 times 6, or 0 where they are cut.
    let (outcome, [x, y]) = recorded(&[]);
    assert_eq!((outcome.steps, &x[..2], &x[7..], &y[..]), (4, &[0.0, 0.0][..], &[0.4, 0.6][..], &[0.54, 0.5][..]));
    let channels = ("sensors.body-pose.wrappers.lesion.channels", Value::Numbers(vec![1.0, 2.0]));
    let (outcome, [x, y]) = recorded(&[
        channels,
        ("sensors.body-pose.wrappers.scale.gain", Value::Number(0.5)),
        ("sensors.constant-2.value", Value::Number(-0.3)),
        ("network.wires.one.weight", Value::Number(0.25)),
        ("episode.steps", Value::Whole(3)),
        ("reward.approach.over", Value::Word("end".into())),
        ("start.robot.point", Value::Numbers(vec![0.9, 1.3])),
        ("world.walls", Value::Flag(false)),
    ]);
    assert!((x[0] - 0.9 * 1.5).abs() < 1e-6, "{x:?}");
    assert_eq!((outcome.steps, x[1], &x[7..], &y[..]), (3, 0.0, &[0.4, -0.3][..], &[0.6, 0.5][..]));
    for (key, value) in [
        ("world.time_step", Value::Number(0.3)),
        ("episode.steps", Value::Whole(0)),
        ("episode.steps", Value::Number(2.5)),
        ("reward.approach.over", Value::Word("ends".into())),
        ("world.size", Value::Numbers(vec![1.0])),
    ] {
        let mut settings = Settings::new(made.settings("plain")).expect("settings");
        assert!(settings.set("own", key, value).is_err(), "{key}");
    }
}

/// A joint of a model may have any name. One that is no part of a key has the number of its placement.
#[test]
fn joints_with_other_names_are_numbered() {
    let joints = ["left.knee", "Right knee", "a..b", ".", "hip-1_x"];
    let links: Vec<String> = (0..joints.len())
        .map(|number| {
            format!(
                "<link name=\"l{number}\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>\
                 <joint name=\"{}\" type=\"revolute\"><parent link=\"base\"/><child link=\"l{number}\"/><axis xyz=\"0 0 1\"/><limit lower=\"-1\" upper=\"1\" effort=\"1\" velocity=\"1\"/></joint>",
                joints[number]
            )
        })
        .collect();
    let starts: Vec<String> = joints
        .iter()
        .map(|joint| format!("[[start]]\nplace = \"{joint}\"\nat = \"turned\"\nlow = -0.5\nhigh = 0.5\n"))
        .collect();
    let (links, starts) = (links.concat(), starts.concat());
    let text = format!(
        "world = {{ engine = \"articulated\" }}\nrobot = {{ kind = \"model\", file = \"legs.urdf\" }}\n\
         sensors = [{{ kind = \"joint-speed\" }}]\nmotors = [{{ kind = \"joint-torque\" }}]\nnetwork = {{ kind = \"perceptron\" }}\n\
         reward = [{{ kind = \"steps\" }}]\n{starts}[files]\n\"legs.urdf\" = '''<robot name=\"r\"><link name=\"base\"/>{links}</robot>'''\n"
    );
    let keys: Vec<String> = made(&text).settings("").iter().map(|setting| setting.key().to_owned()).collect();
    let found: Vec<&str> = keys.iter().filter_map(|key| key.strip_prefix("start.")?.strip_suffix(".low")).collect();
    assert_eq!(found, ["left.knee", "2", "3", "4", "hip-1_x"]);
}

/// Values that a file leaves out, as the guide has them.
#[test]
fn values_left_out_are_those_of_the_guide() {
    let wheels = made(
        "world = { engine = \"rapier\" }\nrobot = { kind = \"e-puck\" }\nmotors = [{ kind = \"wheels\" }]\nreward = [{ kind = \"steps\" }]\n\
         sensors = [{ kind = \"light\" }, { kind = \"laser-distance\", beams = 3, field_of_view = 90, range = 0.3 }, { kind = \"signal\", range = 0.4 }, \
         { kind = \"camera\", field_of_view = 90, sectors = 2, range = 0.3, colors = [{ name = \"red\", low = [0.5, 0, 0], high = [1, 1, 1] }] }]\n\
         network = { kind = \"blocks\", links = [{ from = \"sensors\", to = \"motors\" }], clusters = [{ name = \"a\", neurons = 2 }] }\n\
         objects = [{ name = \"post\", kind = \"cylinder\", radius = 0.1, at = [0.5, 0.5] }, \
         { name = \"bar\", kind = \"wall\", size = [0.1, 0.1], at = [0.2, 0.5] }, \
         { name = \"crate\", kind = \"block\", size = [0.1, 0.1, 0.1], mass = 0.3, at = [0.8, 0.5] }]\n",
    );
    let evonet = made(
        "robot = { kind = \"e-puck\" }\nmotors = [{ kind = \"wheels\" }]\nsensors = [{ kind = \"touch\" }]\nreward = [{ kind = \"steps\" }]\n\
         network = { kind = \"evonet\" }\n",
    );
    let joints = made(
        "world = { engine = \"articulated\" }\nrobot = { kind = \"arm-and-hand\" }\nmotors = [{ kind = \"muscles\" }]\n\
         sensors = [{ kind = \"joint-speed\" }]\nreward = [{ kind = \"steps\" }]\nnetwork = { kind = \"perceptron\" }\n\
         objects = [{ name = \"ball\", kind = \"ball\", radius = 0.1, mass = 0.3, at = [5, 5, 5] }, { name = \"mark\", kind = \"marker\", at = [1, 1, 1] }]\n",
    );
    let number = Value::Number;
    let gray = || Value::Numbers(vec![0.5; 3]);
    for (file, key, default) in [
        (&wheels, "objects.post.height", number(0.1)),
        (&wheels, "objects.post.color", gray()),
        (&wheels, "objects.bar.height", number(0.1)),
        (&wheels, "objects.crate.friction", number(0.5)),
        (&wheels, "sensors.light.reference", number(0.25)),
        (&wheels, "sensors.laser-distance.height", number(0.02)),
        (&wheels, "sensors.signal.sectors", Value::Whole(4)),
        (&wheels, "sensors.camera.rays", Value::Whole(9)),
        (&wheels, "network.weights", Value::Numbers(vec![-5.0, 5.0])),
        (&wheels, "network.leaks", Value::Numbers(vec![0.0, 1.0])),
        (&wheels, "network.clusters.a.slope", number(1.0)),
        (&wheels, "network.output_biases", Value::Flag(true)),
        (&wheels, "robot.count", Value::Whole(1)),
        (&wheels, "reward.steps.weight", number(1.0)),
        (&evonet, "network.largest_bias", number(5.0)),
        (&evonet, "network.largest_gain", number(5.0)),
        (&joints, "objects.ball.friction", number(0.5)),
        (&joints, "objects.mark.radius", number(0.02)),
        (&joints, "objects.mark.color", gray()),
    ] {
        assert_eq!(setting(file, "", key).default_value(), &default, "{key}");
    }
}
