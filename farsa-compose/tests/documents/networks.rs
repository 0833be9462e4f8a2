//! Networks of clusters and links, and networks of the original's files.

use std::collections::BTreeMap;
use std::path::Path;

use farsa_compose::ComposedExperiment;
use farsa_lab::{EpisodeId, Error, Evaluation, Evaluator, Experiment as _, Settings};
use farsa_num::{logistic, tanh};

use crate::steps::{Steps, drawn};

/// Line 15 is the first of what follows it.
const REST: &str = r#"[world]
size = [1.0, 1.0]
[robot]
kind = "e-puck"
[episode]
steps = 30
trials = 1
[[sensors]]
kind = "infrared"
model = "rays"
[[motors]]
kind = "wheels"
[[reward]]
kind = "steps"
"#;

fn made(text: &str, settings: &[(&str, bool)]) -> Result<Box<dyn Evaluator>, Error> {
    let made = ComposedExperiment::from_text("own.toml", text, farsa_lab::strategy::strategies())?;
    let mut own = Settings::new(made.settings(""))?;
    for (key, value) in settings {
        own.set("own", key, farsa_lab::advanced::Value::Flag(*value))?;
    }
    made.prepare("", &own)
}

fn evaluator(network: &str) -> Box<dyn Evaluator> {
    made(&format!("{REST}{network}"), &[]).unwrap_or_else(|error| panic!("{error}\n{network}"))
}

fn refused(network: &str) -> String {
    let text = format!("{REST}{network}");
    made(&text, &[]).err().unwrap_or_else(|| panic!("nothing is wrong with\n{text}")).to_string().replace('`', "")
}

fn names(evaluator: &dyn Evaluator) -> Vec<String> {
    evaluator.info().parameters.into_iter().map(|parameter| parameter.name).collect()
}

fn recorded(evaluator: &mut dyn Evaluator, parameters: &[f32], trial: u32) -> Vec<[Vec<f32>; 2]> {
    let mut steps = Steps::default();
    let id = EpisodeId { seed: 4, trial, ..EpisodeId::default() };
    evaluator.evaluate(Evaluation::new(parameters, id), Some(&mut steps));
    assert_eq!(steps.all.len(), 30);
    steps.all
}

const BLOCKS: &str = r#"[network]
kind = "blocks"
weights = [-3.0, 3.0]
leaks = [0.2, 0.6]
output_biases = false
output_leaks = true
clusters = [
    { name = "memory", neurons = 1, activation = "tanh", slope = 2.0, leaks = true },
    { name = "hidden", neurons = 3, biases = false },
    { name = "gate", neurons = 1, activation = "step" },
]
links = [
    { from = "hidden", to = "memory" },
    { from = "hidden", to = "memory", delay = 2 },
    { from = "infrared", to = "hidden" },
    { from = "memory", to = "hidden" },
    { from = "motors", to = "gate" },
    { from = "sensors", to = "gate", delay = 1 },
    { from = "hidden", to = "motors" },
    { from = "gate", to = "wheels" },
]
"#;

/// Links between neurons, with their delays, in the order of a step.
fn heard(neuron: &str) -> Vec<(&'static str, usize)> {
    let infrared = [1, 2, 3, 4, 5, 6, 7, 8].map(|number| &*format!("infrared {number}").leak());
    let hidden = ["hidden 1", "hidden 2", "hidden 3"];
    match neuron {
        "memory" => hidden.map(|name| (name, 0)).into_iter().chain(hidden.map(|name| (name, 2))).collect(),
        "gate" => {
            let motors = ["wheels left", "wheels right"].map(|name| (name, 0));
            motors.into_iter().chain(infrared.map(|name| (name, 1))).collect()
        }
        name if name.starts_with("hidden") => infrared.into_iter().chain(["memory"]).map(|name| (name, 0)).collect(),
        _ => hidden.into_iter().chain(["gate"]).map(|name| (name, 0)).collect(),
    }
}

/// A robot acts as its links determine, computed one by one from the names of parameters.
#[test]
fn clusters_and_links_do_what_they_say() {
    let mut blocks = evaluator(BLOCKS);
    let (names, mut parameters) = (names(blocks.as_ref()), drawn(blocks.as_ref()));
    // So that the gate is open at times.
    parameters[names.iter().position(|name| name == "bias of gate").expect("a bias")] = 1.6;
    assert_eq!(names.len(), 3 + 3 + 24 + 3 + 2 + 8 + 6 + 2 + 2 + 3);
    let own: BTreeMap<&str, f32> = names.iter().map(String::as_str).zip(parameters.iter().copied()).collect();
    assert_eq!(own.len(), names.len(), "every parameter has a name of its own");
    let of = |name: String| own.get(&*name).copied();
    let later = ["", " a step later", " 2 steps later"];
    let order = [&["memory"][..], &["hidden 1", "hidden 2", "hidden 3"], &["gate"], &["wheels left", "wheels right"]];
    let (mut sensed, mut gates) = (0.0, [false; 2]);
    for trial in 0..8 {
        // For each neuron what a link from it brought in each step that there was.
        let mut values: BTreeMap<String, f32> = BTreeMap::new();
        let mut sent: BTreeMap<(&str, &str, usize), Vec<f32>> = BTreeMap::new();
        for [x, y] in recorded(blocks.as_mut(), &parameters, trial) {
            values.extend(x.iter().enumerate().map(|(number, x)| (format!("infrared {}", number + 1), *x)));
            sensed += x.iter().sum::<f32>();
            for cluster in order {
                let mut new = Vec::new();
                for &neuron in cluster {
                    let mut net = of(format!("bias of {neuron}")).unwrap_or(0.0);
                    for (source, delay) in heard(neuron) {
                        let weight = of(format!("weight of {source} on {neuron}{}", later[delay]));
                        let before = sent.entry((source, neuron, delay)).or_default();
                        before.push(values.get(source).copied().unwrap_or(0.0));
                        let value = before.len().checked_sub(delay + 1).map_or(0.0, |place| before[place]);
                        net += value * weight.expect("a weight");
                    }
                    let response = match neuron {
                        "memory" => tanh(2.0 * net),
                        "gate" => f32::from(u8::from(net >= 0.0)),
                        _ => logistic(net),
                    };
                    let leak = of(format!("leak of {neuron}")).unwrap_or(1.0);
                    let old = values.get(neuron).copied().unwrap_or(0.0);
                    new.push((neuron, leak * response + (1.0 - leak) * old));
                }
                values.extend(new.into_iter().map(|(neuron, value)| (neuron.to_owned(), value)));
            }
            gates[usize::from(values["gate"] > 0.5)] = true;
            let expected = ["wheels left", "wheels right"].map(|name| values[name]);
            assert!(expected.iter().zip(&y).all(|(a, b)| (a - b).abs() < 1e-4), "{expected:?} {y:?}");
            assert_eq!(y.len(), 2);
            values.extend([("wheels left".to_owned(), y[0]), ("wheels right".to_owned(), y[1])]);
        }
    }
    assert!(sensed > 1.0 && gates == [true; 2], "{sensed} {gates:?}");
}

/// Elman's network as clusters and links has the same bits. `fixed` and `shared` take the names of clusters.
#[test]
fn elmans_network_is_one_of_blocks() {
    let links = "[[network.clusters]]\nname = \"hidden\"\nneurons = 3\n\
        [[network.links]]\nfrom = \"infrared\"\nto = \"hidden\"\n[[network.links]]\nfrom = \"hidden\"\nto = \"hidden\"\n\
        [[network.links]]\nfrom = \"hidden\"\nto = \"wheels\"\n";
    let mut elman = evaluator("[network]\nkind = \"elman\"\nhidden = 3\n");
    let mut blocks = evaluator(&format!("[network]\nkind = \"blocks\"\n{links}"));
    let parameters = drawn(elman.as_ref());
    let expected = recorded(elman.as_mut(), &parameters, 0);
    assert_eq!(recorded(blocks.as_mut(), &parameters, 0), expected);
    assert_ne!(recorded(blocks.as_mut(), &vec![0.3; parameters.len()], 0), expected);
    let all = names(blocks.as_ref());
    let given = "fixed = { \"bias of hidden 2\" = 0.5 }\n\
        shared = [[\"weight of hidden 1 on hidden 2\", \"weight of hidden 2 on hidden 1\"]]\n";
    let mut fewer = evaluator(&format!("[network]\nkind = \"blocks\"\n{given}{links}"));
    let of = |wanted: &str| all.iter().position(|name| name == wanted).expect("a parameter");
    let mut full = parameters.clone();
    full[of("bias of hidden 2")] = 0.5;
    full[of("weight of hidden 2 on hidden 1")] = full[of("weight of hidden 1 on hidden 2")];
    let searched: Vec<f32> = names(fewer.as_ref()).iter().map(|name| full[of(name)]).collect();
    assert_eq!(searched.len(), all.len() - 2);
    assert_eq!(recorded(fewer.as_mut(), &searched, 1), recorded(blocks.as_mut(), &full, 1));
    // Disabled sensors and motors have no links.
    let extra =
        "[[sensors]]\nkind = \"constant\"\nvalue = 0.7\n[[network.links]]\nfrom = \"constant\"\nto = \"hidden\"\n";
    let text = format!("{REST}[network]\nkind = \"blocks\"\n{links}{extra}");
    let with = made(&text, &[]).unwrap_or_else(|error| panic!("{error}"));
    let without = made(&text, &[("sensors.constant.enabled", false)]).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!([names(with.as_ref()).len(), names(without.as_ref()).len()], [all.len() + 3, all.len()]);
}

#[test]
fn clusters_and_links_that_cannot_be_are_refused() {
    let signals = "[[sensors]]\nkind = \"signal\"\nrange = 1.0\nsectors = 1\n[[motors]]\nkind = \"signal\"\n";
    for (old, new, message) in [
        (
            "from = \"memory\"",
            "from = \"memmory\"",
            "own.toml line 30: unknown end of a link memmory; the nearest is memory",
        ),
        (
            "to = \"gate\", delay",
            "to = \"gat\", delay",
            "own.toml line 32: unknown end of a link gat; the nearest is gate",
        ),
        ("to = \"wheels\"", "to = \"infrared\"", "own.toml line 34: network.links.8.to: infrared is what is sensed"),
        ("to = \"wheels\"", "to = \"sensors\"", "own.toml line 34: network.links.8.to: sensors is what is sensed"),
        (", delay = 2", "", "own.toml line 28: network.links.2: links hidden with memory, as link 1 does"),
        (
            "{ from = \"gate\", to = \"wheels\" }",
            "{ from = \"hidden\", to = \"wheels\" }",
            "own.toml line 34: network.links.8: links hidden with wheels, as link 7 does",
        ),
        (
            "name = \"gate\"",
            "name = \"wheels\"",
            "own.toml line 24: network.clusters.3.name: wheels names something else",
        ),
        (
            "name = \"gate\"",
            "name = \"memory\"",
            "own.toml line 24: network.clusters.3.name: memory names something else",
        ),
        (
            "name = \"gate\"",
            "name = \"motors\"",
            "own.toml line 24: network.clusters.3.name: motors names something else",
        ),
        ("name = \"gate\"", "name = \"The gate\"", "own.toml line 24: network.clusters.3.name: is not a name"),
        ("neurons = 3", "neurons = 0", "own.toml line 23: network.clusters.2.neurons: 0 is outside 1 to 10000"),
        ("activation = \"step\"", "activation = \"linear\"", "own.toml line 24: unknown choice linear"),
        ("delay = 2", "delay = 1001", "own.toml line 28: network.links.2.delay: 1001 is outside 0 to 1000"),
        ("leaks = [0.2, 0.6]", "leaks = [0.2, 1.6]", "own.toml line 18: network.leaks.2: 1.6 is outside 0 to 1"),
        (
            "output_leaks = true",
            "output_leaks = true\nfixed = { \"leak of memory\" = 1.5 }",
            "own.toml line 21: network.fixed: has values that the network cannot have",
        ),
    ] {
        assert_eq!(BLOCKS.matches(old).count(), 1, "{old}");
        let found = refused(&BLOCKS.replace(old, new));
        assert!(found.starts_with(message), "{new}\n  found:  {found}\n  wanted: {message}");
    }
    let large = BLOCKS.replace("neurons = 3", "neurons = 10000").replace("infrared\", to", "hidden\", to");
    let found = refused(&large);
    assert!(found.contains("network: has 100") && found.contains("parameters; at most 1000000 make"), "{found}");
    let large = BLOCKS.replace("neurons = 3", "neurons = 10000").replace("delay = 2", "delay = 1000");
    assert!(refused(&large).contains("values to remember; at most 1000000"), "{}", refused(&large));
    let found = refused("[network]\nkind = \"elman\"\nhidden = 10000\n");
    assert!(found.contains("own.toml line 15: network: has 100"), "{found}");
    let link = |ends: &str| refused(&format!("{signals}[network]\nkind = \"blocks\"\nlinks = [{{ {ends} }}]\n"));
    let found = link("from = \"signal\", to = \"wheels\"");
    assert!(found.contains("links.1.from: signal is a sensor and a motor: give one of them another name"), "{found}");
    let found = link("from = \"motors\", to = \"wheels\"");
    assert!(found.contains("links.1.from: signal is a sensor and a motor: give one of them another name"), "{found}");
    // A sensor cannot be meant where a link ends.
    evaluator(&format!("{signals}[network]\nkind = \"blocks\"\nlinks = [{{ from = \"sensors\", to = \"signal\" }}]\n"));
}

/// Eight inputs, two logistic neurons with links to each other, one of them with a leak, and two outputs.
const NET: &str = "ARCHITECTURE\nnneurons 12\nnsensors 8\nnmotors 2\nnblocks 6\n1 0 8 0 0 0 // inputs\n\
    0 8 2 0 8 0\n0 8 2 8 2 0\n1 8 2 0 0 0\n0 10 2 8 2 0\n1 10 2 0 0 0\nneurons bias, delta, gain, xy position, display\n\
    0 0 0 10 400 1\n0 0 0 20 400 1\n0 0 0 30 400 1\n0 0 0 40 400 1\n0 0 0 50 400 1\n0 0 0 60 400 1\n0 0 0 70 400 1\n\
    0 0 0 80 400 1\n1 1 0 10 200 1\n1 1 0 20 200 1\n1 0 0 10 50 1\n1 0 0 20 50 1\n";

const EVONET: &str = "[network]\nkind = \"evonet\"\nweights = [5.0, -5.0]\n";

/// The text with a network's file in it.
fn with_file(network: &str, content: &str) -> String {
    format!("{EVONET}file = \"own.net\"\n{network}\n[files]\n\"own.net\" = '''\n{content}'''\n")
}

/// A file and the equivalent flags give the same bits.
#[test]
fn a_file_of_the_original_is_a_network() {
    let net = format!("{NET}END\n");
    let flags = "hidden = 2\nhidden_neurons = \"leaky\"\nrecurrent_hidden = true\nlargest_bias = 2.5\n";
    let mut flags = evaluator(&format!("{EVONET}{flags}"));
    let mut file = evaluator(&with_file("largest_bias = 2.5", &net));
    let parameters = drawn(flags.as_ref());
    assert_eq!(names(file.as_ref()), names(flags.as_ref()));
    assert_eq!(parameters.len(), 4 + 16 + 4 + 2 + 4);
    for trial in 0..3 {
        let expected = recorded(flags.as_mut(), &parameters, trial);
        assert_eq!(recorded(file.as_mut(), &parameters, trial), expected);
    }
    // A gain of the first input is a separate parameter with the range of the file.
    let gain = net.replacen("0 0 0 10", "0 0 1 10", 1);
    let [mut one, mut two] = ["", "largest_gain = 10.0\n"].map(|range| evaluator(&with_file(range, &gain)));
    assert_eq!(names(one.as_ref())[0], "gain 1");
    let mut parameters = drawn(one.as_ref());
    parameters[0] = 2.0;
    let doubled = recorded(two.as_mut(), &parameters, 0);
    parameters[0] = -4.0;
    assert_eq!(recorded(one.as_mut(), &parameters, 0), doubled);
}

/// Numbers of a `.phe` file that never mutate are kept, all others are searched for.
#[test]
fn numbers_that_never_mutate_are_kept() {
    let number = |number: usize| match number {
        0 => "1.5 \t 0.0 \t bias h0\n",
        1 => "* \t 0.0 \t bias h1\n",
        2 => "2.0 \t * \t bias o0\n",
        29 => "-2.5 \t 0 \t weight o1 from h1\n",
        _ => "* \t * \t\n",
    };
    let numbers: String = (0..30).map(number).collect();
    let phe = format!("{NET}FREE PARAMETERS 30\n{numbers}END\n");
    let mut kept = evaluator(&with_file("", &phe));
    let mut all = evaluator(&with_file("", &format!("{NET}END\n")));
    let searched = names(kept.as_ref());
    assert_eq!((searched.len(), &*searched[0]), (28, "bias 2"));
    assert!(!searched.contains(&"weight 24".to_owned()), "{searched:?}");
    let parameters = drawn(kept.as_ref());
    let full: Vec<f32> = [1.5].into_iter().chain(parameters.iter().copied()).chain([-2.5]).collect();
    let searched = recorded(kept.as_mut(), &parameters, 0);
    assert_eq!(searched, recorded(all.as_mut(), &full, 0));
    let other = [&[1.0], &full[1..]].concat();
    assert_ne!(searched, recorded(all.as_mut(), &other, 0));
    // The document's word goes before the file's.
    let mut other_kept = evaluator(&with_file("fixed = { \"bias 1\" = 1.0 }\n", &phe));
    assert_eq!(recorded(other_kept.as_mut(), &parameters, 0), recorded(all.as_mut(), &other, 0));
}

#[test]
fn files_that_are_no_network_of_the_robot_are_refused() {
    let net = format!("{NET}END\n");
    let file = "own.toml line 18: network.file: own.net: ";
    for (old, new, message) in [
        ("nsensors 8", "nsensors 7", "has 7 sensors and 2 motors where the experiment's have 8 and 2 channels"),
        ("nmotors 2", "nmotors 3", "has 8 sensors and 3 motors where the experiment's have 8 and 2 channels"),
        ("0 8 2 8 2 0", "9 8 2 8 2 0", "line 8: expected a block"),
        ("0 8 2 8 2 0", "0 8 2 8 20 0", ""),
        ("0 10 2 8 2 0", "1 8 1 0 0 0", "updates a neuron with a leak twice in a step"),
        ("1 8 2 0 0 0", "1 8 1 0 0 0", "has a neuron with a leak that is never updated"),
        ("nneurons 12", "nneurons 4000000000", ""),
        ("END", "FREE PARAMETERS 4000000000000", ""),
        ("ARCHITECTURE", "{}", "line 1: expected ARCHITECTURE"),
    ] {
        assert_eq!(net.matches(old).count(), 1, "{old}");
        let found = refused(&with_file("", &net.replace(old, new)));
        assert!(found.starts_with(&format!("{file}{message}")), "{new}: {found}");
    }
    let many =
        net.replace("nblocks 6", "nblocks 1007").replace("1 10 2", &format!("{}1 10 2", "2 0 1 0 0 0\n".repeat(1001)));
    assert!(refused(&with_file("", &many)).contains("has 1007 blocks; at most 1000"));
    let found = refused(&with_file("hidden = 3", &net));
    assert!(found.starts_with("own.toml line 19: network.hidden: has no effect with file"), "{found}");
    let found = refused(&with_file("output_biases = false", &net));
    assert!(found.starts_with("own.toml line 19: network.output_biases: has no effect with file"), "{found}");
    let found = refused(&with_file("", &net).replace("file = \"own.net\"", "file = \"won.net\""));
    assert!(found.contains("unknown file won.net; the nearest is own.net"), "{found}");
}

/// The file is read from the folder of the experiment's, and the text that a run keeps has it.
#[test]
fn a_text_has_the_network_that_it_names() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("networks");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder");
    std::fs::write(folder.join("my.net"), format!("{NET}END\n")).expect("a network");
    let path = folder.join("own.toml");
    let read = |name: &str| {
        std::fs::write(&path, format!("{REST}{EVONET}file = \"{name}\"\n")).expect("a file");
        ComposedExperiment::from_file(&path, farsa_lab::strategy::strategies())
    };
    let own = read("my.net").unwrap_or_else(|error| panic!("{error}"));
    let kept = own.definition().expect("the text").to_owned();
    assert!(kept.contains("[files]") && kept.contains("nneurons 12"), "{kept}");
    let again = ComposedExperiment::from_text("elsewhere.toml", &kept, farsa_lab::strategy::strategies());
    let again = again.unwrap_or_else(|error| panic!("{error}"));
    let [a, b] = [&own, &again].map(|made| {
        let settings = Settings::new(made.settings("")).unwrap_or_else(|error| panic!("{error}"));
        let mut task = made.prepare("", &settings).unwrap_or_else(|error| panic!("{error}"));
        let parameters = drawn(task.as_ref());
        recorded(task.as_mut(), &parameters, 0)
    });
    assert_eq!(a, b);
    for name in ["../networks/my.net", "none.net"] {
        assert!(read(name).is_err(), "{name}");
    }
}

/// The guide's clusters and links are a valid network.
#[test]
fn the_guides_blocks_are_a_network() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/guide/experiment-file.md");
    let guide = std::fs::read_to_string(path).expect("the guide");
    let mut texts = guide.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next());
    let text = texts.find(|text| text.contains("kind = \"blocks\"")).expect("the network");
    let names = names(evaluator(text).as_ref());
    for name in ["weight of memory 1 on hidden 3", "bias of hidden 2", "leak of memory 1"] {
        assert!(names.iter().any(|known| known == name) && guide.contains(&format!("`{name}`")), "{name}");
    }
}

/// Eight inputs and two outputs. Numbers begin with 1 for each kind, and weights and time constants have their ranges.
#[test]
fn parameters_are_named_by_kind_and_number() {
    for (network, wanted) in [
        (
            "kind = \"ctrnn\"\nneurons = 3\ntime_constants = [0.25, 1.5]\n",
            &[("bias", 3), ("time constant", 3), ("weight", 9), ("weight of an input", 24)][..],
        ),
        ("kind = \"elman\"\nhidden = 2\n", &[("bias", 4), ("weight", 16 + 4 + 4)]),
        (
            "kind = \"evonet\"\nhidden = 2\nhidden_neurons = \"leaky\"\n",
            &[("bias", 4), ("leak", 2), ("weight", 16 + 4)],
        ),
    ] {
        let made = evaluator(&format!("[network]\nweights = [-3.0, 3.5]\n{network}"));
        let mut found: BTreeMap<String, usize> = BTreeMap::new();
        for parameter in made.info().parameters {
            let (kind, number) = parameter.name.rsplit_once(' ').expect("a number");
            let count = found.entry(kind.to_owned()).or_default();
            *count += 1;
            assert_eq!(number, count.to_string(), "{network}: {kind}");
            let ends = if kind == "time constant" { [0.25, 1.5] } else { [-3.0, 3.5] };
            assert_eq!(parameter.ends, ends, "{network}: {}", parameter.name);
        }
        let wanted: BTreeMap<String, usize> = wanted.iter().map(|(kind, count)| ((*kind).to_owned(), *count)).collect();
        assert_eq!(found, wanted, "{network}");
    }
}

/// Eight inputs, two neurons and two outputs: rows of weights from one source each, then biases and leaks.
#[test]
fn parameters_of_leaky_networks_are_named_by_their_ends() {
    let made = evaluator("[network]\nkind = \"leaky\"\nhidden = 2\nweights = [-3.0, 3.5]\nleaks = [0.25, 0.75]\n");
    let ends = |from: &[String], to: &[String]| {
        let row = |from: &String| to.iter().map(|to| format!("weight of {from} on {to}")).collect::<Vec<_>>();
        from.iter().flat_map(row).collect::<Vec<_>>()
    };
    let numbered = |name: &str, count: usize| (1..=count).map(|n| format!("{name} {n}")).collect::<Vec<_>>();
    let (inputs, neurons) = (numbered("infrared", 8), numbered("neuron", 2));
    let outputs = ["wheels left", "wheels right"].map(str::to_owned);
    let wanted = [
        ends(&inputs, &neurons),
        ends(&neurons, &neurons),
        ends(&neurons, &outputs),
        numbered("bias of neuron", 2),
        numbered("leak of neuron", 2),
    ];
    let (mut found, mut wanted) = (names(made.as_ref()), wanted.concat());
    // The order of kinds is that of the network's crate.
    found.sort();
    wanted.sort();
    assert_eq!(found, wanted);
    for parameter in made.info().parameters {
        let ends = if parameter.name.starts_with("leak") { [0.25, 0.75] } else { [-3.0, 3.5] };
        assert_eq!(parameter.ends, ends, "{}", parameter.name);
    }
}
