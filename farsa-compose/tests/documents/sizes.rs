//! Limits that are met exactly: what is one more is refused.

use farsa_compose::{ComposedExperiment, Limits};
use farsa_lab::{Experiment as _, Settings};
use farsa_nn::{CtrnnLayout, LeakyLayout};

const REST: &str = "robot = { kind = \"e-puck\" }\nreward = [{ kind = \"steps\" }]\n\
    sensors = [{ kind = \"wheel-speed\" }, { kind = \"constant\", value = 0.3 }]\nmotors = [{ kind = \"wheels\" }]\n";

fn made_within(limits: Limits, text: &str) -> Result<ComposedExperiment, String> {
    let made = ComposedExperiment::from_text_within(limits, "own.toml", text, farsa_lab::strategy::strategies());
    made.map_err(|error| error.to_string().replace('`', ""))
}

fn made(text: &str) -> Result<ComposedExperiment, String> {
    made_within(Limits::default(), text)
}

fn values(network_values: usize) -> Limits {
    let mut limits = Limits::default();
    limits.network_values = network_values;
    limits
}

/// Parameters and values of the state of networks with three inputs and two outputs.
fn networks() -> Vec<(&'static str, usize, usize)> {
    let (leaky, ctrnn) = (LeakyLayout::new(3, 4, 2), CtrnnLayout::new(3, 5, 2));
    assert_eq!((leaky.parameter_count(), ctrnn.parameter_count()), (12 + 16 + 8 + 4 + 4, 15 + 25 + 5 + 5 + 5));
    vec![
        ("kind = \"perceptron\"", 6 + 2, 0),
        ("kind = \"perceptron\", order = \"outputs\"", 6 + 2, 0),
        ("kind = \"leaky\", hidden = 4", 44, leaky.state_len()),
        ("kind = \"ctrnn\", neurons = 5, time_constants = [0.1, 1.0]", 55, ctrnn.state_len()),
        (
            "kind = \"wired\", bias = [0.5, 0.5], wires = [{ from = [\"constant\"], to = \"wheels left\", weight = 1.0 }]",
            3,
            0,
        ),
    ]
}

/// A network may have as many parameters as the limit, and all robots ten times as many values.
#[test]
fn networks_have_at_most_the_given_numbers_of_values() {
    for (network, parameters, state) in networks() {
        let text = |count: usize| {
            let rest = REST.replace("kind = \"e-puck\"", &format!("kind = \"e-puck\", count = {count}"));
            format!("{rest}network = {{ {network} }}\nworld = {{ size = [90.0, 90.0] }}\n")
        };
        let most = parameters.max(state);
        let wired = network.contains("wired");
        assert!(made_within(values(most), &text(1)).is_ok(), "{network}");
        if !wired {
            let error = made_within(values(most - 1), &text(1)).err().expect("an error");
            let why = format!("has {most} parameters; at most {} make a network", most - 1);
            assert!(error.contains(&why), "{network}: {error}");
        }
        // Three inputs, two outputs, the parameters and the state of each robot.
        let each = 3 + 2 + parameters + state;
        let count = 10 * most / each + 1;
        let limit = (count * each).div_ceil(10);
        assert!(made_within(values(limit), &text(count)).is_ok(), "{network} of {count}");
        let more = 10 * limit / each + 1;
        let error = made_within(values(limit), &text(more)).err().expect("an error");
        let why =
            format!("network: and what is before it keep {} values; at most {} in all robots", more * each, 10 * limit);
        assert!(error.contains(&why), "{network}: {error}");
    }
}

/// The state has six values per neuron, and for a link with a delay one and the delayed values of its sources.
#[test]
fn blocks_keep_their_neurons_and_delays() {
    let neurons = 6 * (3 + 4 + 2);
    for (network, state) in [
        ("kind = \"feed-forward\"\nhidden = 4\n", neurons),
        ("kind = \"elman\"\nhidden = 4\n", neurons),
        ("kind = \"jordan\"\nhidden = 4\n", neurons),
        (
            "kind = \"blocks\"\nclusters = [{ name = \"a\", neurons = 4 }]\nlinks = [{ from = \"sensors\", to = \"a\" }, { from = \"a\", to = \"motors\", delay = 3 }]\n",
            neurons + 1 + 3 * 4,
        ),
    ] {
        let text = format!("{REST}[network]\n{network}");
        let refused = |limit: usize| made_within(values(limit), &text).err();
        assert_eq!(refused(state), None, "{network}");
        let error = refused(state - 1).expect("an error");
        let message = format!("has {state} values to remember; at most {} make a network", state - 1);
        assert!(error.contains(&message), "{network}: {error}");
    }
}

/// Lists of 1000 items, texts of 1000 characters, names of 40 characters, and values of 1e6 are the longest.
#[test]
fn lists_texts_and_names_have_a_longest() {
    let right = format!("{REST}network = {{ kind = \"perceptron\" }}\n");
    let with = |more: &str| made(&format!("{right}{more}")).err();
    let summary = |count: usize| format!("summary = \"{}\"\n", "é".repeat(count));
    assert_eq!(with(&summary(1000)), None);
    let error = with(&summary(1001)).expect("an error");
    assert!(error.contains("line 6: summary: is longer than 1000 characters or has control characters"), "{error}");
    assert!(with("summary = \"a\\u0007b\"\n").expect("an error").contains("summary: is longer"));
    let failures = |count: usize| "[[failure]]\nterm = \"steps\"\nabove = 1.0\n".repeat(count);
    assert_eq!(with(&failures(1000)), None);
    let error = with(&failures(1001)).expect("an error");
    assert!(error.contains("failure: has 1001 values where 0 to 1000 are wanted"), "{error}");
    let files = |count: usize| {
        let lines: Vec<String> = (0..count).map(|number| format!("\"f{number}\" = \"\"\n")).collect();
        format!("[files]\n{}", lines.concat())
    };
    assert_eq!(with(&files(1000)), None);
    assert!(with(&files(1001)).expect("an error").contains("files: has 1001 keys; at most 1000"));
    let object =
        |name: &str| format!("[[objects]]\nname = \"{name}\"\nkind = \"cylinder\"\nradius = 0.1\nat = [0.5, 0.5]\n");
    for name in ["a".repeat(40), "0".into(), "a-b_9".into(), "9-".into()] {
        assert_eq!(with(&object(&name)), None, "{name}");
    }
    for name in ["a".repeat(41), String::new(), "-a".into(), "_a".into(), "A".into(), "a.b".into(), "ä".into()] {
        assert!(with(&object(&name)).expect("an error").contains("is not a name: 1 to 40"), "{name}");
    }
    for (file, wanted) in [("own.toml", true), ("Own.toml", false), ("-own.toml", false), ("a/own-2.toml", true)] {
        let made = ComposedExperiment::from_text(file, &right, farsa_lab::strategy::strategies());
        assert_eq!(made.is_ok(), wanted, "{file}");
    }
    let fixed = |value: &str| {
        format!("{REST}[network]\nkind = \"perceptron\"\nfixed = {{ \"bias of wheels left\" = {value} }}\n")
    };
    for (value, wanted) in [("1e6", true), ("-1e6", true), ("1000001.0", false), ("-1000001.0", false)] {
        assert_eq!(made(&fixed(value)).is_ok(), wanted, "{value}");
    }
    // An unknown key may have any length, and its first 60 characters are shown.
    let error = with(&format!("[strategy]\n\"{}\" = 1\n", "k".repeat(80))).expect("an error");
    assert!(error.contains(&"k".repeat(60)), "{error}");
}

/// Parameters may be only fixed or only shared, and each is then searched once.
#[test]
fn parameters_are_only_fixed_or_only_shared() {
    let names = |table: &str| {
        let made =
            made(&format!("{REST}[network]\nkind = \"perceptron\"\n{table}")).unwrap_or_else(|error| panic!("{error}"));
        let evaluator = made.prepare("", &Settings::new(made.settings("")).expect("settings")).expect("an evaluator");
        evaluator.info().parameters.into_iter().map(|parameter| parameter.name).collect::<Vec<String>>()
    };
    let all = names("");
    assert_eq!(all.len(), 8);
    let without = |left: &str| all.iter().filter(|name| *name != left).cloned().collect::<Vec<String>>();
    assert_eq!(names("fixed = { \"bias of wheels left\" = 0.5 }\n"), without("bias of wheels left"));
    assert_eq!(
        names("shared = [[\"bias of wheels left\", \"bias of wheels right\"]]\n"),
        without("bias of wheels right")
    );
    let every: Vec<String> = all.iter().map(|name| format!("\"{name}\" = 0.25")).collect();
    assert_eq!(names(&format!("fixed = {{ {} }}\n", every.join(", "))), ["none"]);
    for table in ["fixed = { \"bias\" = 0.5 }\n", "shared = [[\"bias\"]]\n"] {
        let error = made(&format!("{REST}[network]\nkind = \"perceptron\"\n{table}")).err().expect("an error");
        assert!(error.contains("unknown parameter bias; "), "{error}");
    }
}

/// A network file of the 2013 program has at most 1000 neurons and 1000 blocks, and replaces all flags.
#[test]
fn network_files_are_limited() {
    let net = |hidden: usize, blocks: usize| {
        let neurons = 3 + hidden + 2;
        let repeated = format!("0 3 {hidden} 0 3 0\n").repeat(blocks - 4);
        let lines = "0 0 0 10 400 1\n".repeat(neurons) + "END\n";
        format!(
            "ARCHITECTURE\nnneurons {neurons}\nnsensors 3\nnmotors 2\nnblocks {blocks}\n1 0 3 0 0 0 // inputs\n{repeated}\
             1 3 {hidden} 0 0 0\n0 {first} 2 3 {hidden} 0\n1 {first} 2 0 0 0\nneurons bias, delta, gain, xy position, display\n{lines}",
            first = 3 + hidden
        )
    };
    let with = |flags: &str, file: &str| {
        let network = format!("[network]\nkind = \"evonet\"\nweights = [5.0, -5.0]\nfile = \"own.net\"\n{flags}");
        made(&format!("{REST}{network}[files]\n\"own.net\" = '''\n{file}'''\n")).err()
    };
    assert_eq!(with("", &net(2, 5)), None);
    assert_eq!(with("", &net(995, 5)), None);
    assert!(with("", &net(996, 5)).expect("an error").contains("own.net: has 1001 neurons; at most 1000"));
    assert_eq!(with("", &net(2, 1000)), None);
    assert!(with("", &net(2, 1001)).expect("an error").contains("own.net: has 1001 blocks; at most 1000"));
    for flag in [
        "hidden = 2",
        "hidden_neurons = \"leaky\"",
        "hidden_biases = false",
        "output_biases = false",
        "recurrent_hidden = true",
        "recurrent_outputs = true",
        "direct = true",
        "output_leaks = true",
    ] {
        let (key, _) = flag.split_once(' ').expect("a key");
        let error = with(&format!("{flag}\n"), &net(2, 5)).expect("an error");
        assert!(error.contains(&format!("network.{key}: has no effect with file: own.net defines it")), "{error}");
    }
}

/// Beams, sectors times rays, and columns times rows. Infrared sensors send out five rays each, whatever their number.
#[test]
fn rays_of_sensors_are_counted() {
    let rest = "reward = [{ kind = \"steps\" }]\nnetwork = { kind = \"perceptron\" }\n";
    let wheels = format!("{rest}robot = {{ kind = \"e-puck\" }}\nmotors = [{{ kind = \"wheels\" }}]\n");
    let joints = format!(
        "{rest}robot = {{ kind = \"arm-and-hand\" }}\nmotors = [{{ kind = \"muscles\" }}]\nworld = {{ engine = \"articulated\" }}\n"
    );
    let eye = "eye = { columns = 3, rows = 4, field_of_view = 60, range = 1.0 }";
    let colors = "colors = [{ name = \"red\", low = [0.5, 0, 0], high = [1, 1, 1] }]";
    for (text, sensor, rays) in [
        (&wheels, "kind = \"laser-distance\"\nbeams = 6\nfield_of_view = 90\nrange = 1.0".to_owned(), 6),
        (&wheels, format!("kind = \"camera\"\nsectors = 2\nrays = 5\nfield_of_view = 90\nrange = 1.0\n{colors}"), 10),
        (&wheels, "kind = \"infrared\"\nmodel = \"rays\"\nfirst = 2".into(), 40),
        (&joints, format!("kind = \"camera-image\"\n{eye}"), 12),
        (&joints, format!("kind = \"color-blobs\"\n{eye}\n{colors}"), 12),
    ] {
        let limited = |most: usize| {
            let mut limits = Limits::default();
            limits.rays = most;
            made_within(limits, &format!("{text}[[sensors]]\n{sensor}\n")).err()
        };
        assert_eq!(limited(rays), None, "{sensor}");
        let error = limited(rays - 1).expect("an error");
        let why = format!("and those before it send out {rays} rays from 1 robots; at most {} in all", rays - 1);
        assert!(error.contains(&why), "{sensor}: {error}");
    }
}
