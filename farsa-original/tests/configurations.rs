//! Conversion of configurations: golden texts, results of each line, damaged files.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use farsa_compose::ComposedExperiment;
use farsa_lab::advanced::ImportedFile;
use farsa_lab::{EpisodeId, Evaluation, Experiment as _, Settings};
use farsa_original::from_original;
use proptest::prelude::*;

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures").join(name)
}

fn text(name: &str) -> String {
    std::fs::read_to_string(fixture(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn imported(text: &str) -> ImportedFile {
    from_original("x.ini", "x.toml", text).unwrap_or_else(|error| panic!("{error}"))
}

fn error(text: &str) -> String {
    match from_original("x.ini", "x.toml", text) {
        Ok(made) => panic!("{}", made.text),
        Err(error) => error.to_string(),
    }
}

/// Returns the number of parameters, and the fitness of one trial with parameters of 0.3.
fn lived(text: &str) -> (usize, f64) {
    let made = ComposedExperiment::from_text("x.toml", text, farsa_lab::strategy::strategies()).expect("an experiment");
    let settings = Settings::new(made.settings("")).expect("settings");
    let mut evaluator = made.prepare("", &settings).expect("an evaluator");
    let parameters: Vec<f32> =
        evaluator.info().parameters.iter().map(|one| (0.7 * one.ends[0] + 0.3 * one.ends[1]) as f32).collect();
    let outcome = evaluator.evaluate(Evaluation::new(&parameters, EpisodeId { seed: 3, ..EpisodeId::default() }), None);
    (parameters.len(), outcome.terms.iter().sum())
}

#[test]
fn each_configuration_comes_to_its_golden_text() {
    for name in ["stay", "team"] {
        let made = from_original(&format!("{name}.ini"), &format!("{name}.toml"), &text(&format!("{name}.ini")));
        let made = made.unwrap_or_else(|error| panic!("{name}: {error}")).text;
        assert_eq!(made, text(&format!("{name}.toml")), "{name}");
    }
}

#[test]
fn the_discrimination_experiment_is_the_one_that_is_kept_as_a_file() {
    let kept = Path::new(env!("CARGO_MANIFEST_DIR")).join("../experiments/discrimination.toml");
    let kept = std::fs::read_to_string(kept).expect("the file");
    let made = imported(&text("stay.ini"));
    // 12 weights and 2 biases, and the bits of a trial.
    let (genes, fitness) = lived(&made.text);
    assert_eq!(genes, 14);
    assert_eq!((genes, fitness.to_bits()), (lived(&kept).0, lived(&kept).1.to_bits()));
    let keys: Vec<&str> = made.left.iter().map(|left| &*left.key).collect();
    assert_eq!(keys, ["Component/GA/Experiment/AGENT/SENSOR:0/type"]);
}

/// Returns a configuration with these lines added to its groups.
fn with(group: &str, lines: &str) -> String {
    let parts = [
        ("GA", "type = Evoga"),
        ("GA/Experiment", "type = X"),
        ("GA/Experiment/ROBOT", "type = Epuck\nkinematicRobot = true"),
        ("GA/Experiment/NET", "type = Evonet"),
        ("GA/Experiment/Arena", "type = Arena"),
        ("GA/Experiment/World", ""),
        ("GA/Experiment/Sensor:0", "type = EpuckProximityIRSensor"),
        ("GA/Experiment/Motor:0", "type = EpuckWheelVelocityMotor"),
    ];
    let mut text = String::new();
    for (name, own) in parts {
        let more = if name.ends_with(group) { lines } else { "" };
        let _ = write!(text, "[Component/{name}]\n{own}\n{more}\n");
    }
    text
}

/// Returns the converted lines, without the head.
fn body(text: &str) -> Vec<String> {
    imported(text).text.lines().filter(|line| !line.starts_with('#')).map(str::to_owned).collect()
}

/// Returns keys and reasons of lost lines, except those of the empty configuration.
fn lost(text: &str) -> Vec<String> {
    let without = imported(&with("none", "")).left;
    let new =
        |left: &farsa_lab::advanced::LeftOut| !without.iter().any(|old| (&old.key, &old.why) == (&left.key, &left.why));
    imported(text).left.iter().filter(|left| new(left)).map(ToString::to_string).collect()
}

#[test]
fn values_have_the_sense_that_they_had() {
    for (group, lines, expected) in [
        // Rates from 1 on are percentages.
        ("GA", "mutation_rate = 3\nnreproducing = 4\nnoffspring = 1", "mutation_rate = 0.03"),
        ("GA", "mutation_rate = 0.3\nnreproducing = 4\nnoffspring = 1", "mutation_rate = 0.3"),
        // The steady state evaluates mutants and parents.
        ("GA", "nreproducing = 4\nnoffspring = 3", "population = 24"),
        ("GA", "nreproducing = 4\nnoffspring = 3", "parents = 12"),
        ("GA", "evolutionType = generational\nnreproducing = 4\nnoffspring = 3", "population = 12"),
        ("GA", "evolutionType = generational\nnreproducing = 4\nnoffspring = 1", "population = 8"),
        ("GA", "evolutionType = generational\nnreproducing = 4\nnoffspring = 1", "parents = 4"),
        ("GA", "nreproducing = 1\nnoffspring = 1\ninitial_mutation = 0.4", "first_rate = 0.4"),
        ("GA", "nreproducing = 1\nnoffspring = 1\nmutation_decay = 0.02", "rate_step = 0.02"),
        // The defaults of the 2013 program.
        ("GA", "", "generations = 100"),
        ("GA", "", "population = 200"),
        ("Experiment", "", "steps = 1"),
        ("World", "", "time_step = 0.05"),
        ("World", "timestep = 0.1", "time_step = 0.1"),
        ("Arena", "planeWidth = 2\nplaneHeight = 3", "size = [2.0, 3.0]"),
        ("Arena", "", "size = [2.5, 2.5]"),
        ("Experiment", "nagents = 3", "count = 3"),
        ("Experiment", "ntrials = 30", "trials = 30"),
        ("NET", "weightRange = 10", "weights = [10.0, -10.0]"),
        ("NET", "biasOnOutputNeurons = true", "kind = \"perceptron\""),
        ("NET", "biasOnOutputNeurons = true\nbiasRange = 2", "largest_bias = 2.0"),
        ("NET", "", "output_biases = false"),
        ("NET", "nHiddens = 3", "kind = \"evonet\""),
        ("NET", "nHiddens = 3\nrecurrentHiddens = true", "recurrent_hidden = true"),
        ("NET", "nHiddens = 3\ninputOutputConnections = true", "direct = true"),
        ("NET", "nHiddens = 3\nhiddenNeuronType = logistic+delta", "hidden_neurons = \"leaky\""),
        ("NET", "nHiddens = 3\nhiddenNeuronType = binary", "hidden_neurons = \"binary\""),
        ("NET", "nHiddens = 3\nbiasOnHiddenNeurons = true", "hidden_biases = true"),
        ("NET", "outputNeuronType = with_delta", "output_leaks = true"),
        ("NET", "recurrentOutputs = true", "recurrent_outputs = true"),
        // Noise extends half its range to both sides, or has a quarter of it as deviation.
        (
            "Sensor:0",
            "noiseType = Uniform\nnoiseRange = 0.1",
            "wrappers = [{ kind = \"uniform-noise\", amplitude = 0.05 }, { kind = \"saturate\", low = 0.0, high = 1.0 }]",
        ),
        (
            "Motor:0",
            "noiseType = gaussian\nnoiseRange = 0.2",
            "wrappers = [{ kind = \"normal-noise\", deviation = 0.05 }]",
        ),
        ("Sensor:0", "name = Front IR", "name = \"front-ir\""),
    ] {
        let text = with(group, lines);
        assert!(body(&text).iter().any(|line| line == expected), "{lines}: no {expected}: {}", imported(&text).text);
    }
}

#[test]
fn lines_that_mean_something_else_here_are_named() {
    for (group, lines, why) in [
        ("GA", "nreplcations = 3", "the nearest that is known is `nreplications`"),
        ("GA", "ngenerations = many", "`Component/GA/ngenerations = many`: is no whole number from 1 to"),
        ("GA", "seed = 1\nseed = 2", "line 3: `Component/GA/seed = 1`: stands twice"),
        ("GA", "limitRetention = true", "limits how many offspring stay"),
        ("GA", "evolutionType = xnes", "is no type of evolution"),
        ("GA", "include other.ini", "line 3: `include other.ini`: is neither"),
        ("GA", "include = ../../etc/passwd", "is no key of this part"),
        ("Experiment", "sameRandomSequence = true", "each individual has starts of its own"),
        ("Experiment", "nfoods = 3", "is a key of the plugin"),
        ("ROBOT", "kinematicRobot = false", "without forces"),
        ("ROBOT", "color = red", "hulls here"),
        ("NET", "netFile = ../a.net", "networks of `.net` files"),
        ("NET", "nHiddens = 2\nhiddenNeuronType = logistic_0.2", "the slope of hidden neurons is 1 here"),
        ("NET", "nHiddens = 2\nhiddenNeuronType = tanh", "is no type of neurons"),
        ("NET", "inputNeuronType = with_delta", "inputs have no leaks"),
        ("Sensor:0", "activeSensors = 10111100", "those between read 0 here"),
        ("Sensor:0", "activeSensors = 101", "is not a 0 or a 1 for each of 8 sensors"),
        ("Sensor:0", "noiseType = pink", "is no type of noise"),
        ("Motor:0", "noisType = Uniform", "the nearest that is known is `noiseType`"),
        ("Arena", "z = 1", "the ground here is at height 0"),
        ("World", "gravity = 0", "is no key of this part"),
    ] {
        let lost = lost(&with(group, lines));
        assert!(lost.iter().any(|remark| remark.contains(why)), "{lines}: no {why}: {lost:#?}");
    }
    // Defaults of missing keys.
    let defaults: Vec<String> = imported(&with("none", "")).left.iter().map(ToString::to_string).collect();
    for key in ["initial_mutation = 0.5", "mutation_decay = 0.01", "averageIndividualFitnessOverGenerations = true"] {
        let found = defaults.iter().any(|line| line.starts_with("by default: ") && line.contains(key));
        assert!(found, "{key}: {defaults:#?}");
    }
}

#[test]
fn what_is_no_experiment_of_wheeled_robots_is_refused() {
    let without = |part: &str| with("none", "").replace(part, "[Component/Other");
    for (text, why) in [
        (String::new(), "x.ini: no `[GROUP]`"),
        ("[Component]\n".into(), "x.ini: no group `[Component/GA/Experiment]`"),
        (without("[Component/GA/Experiment/ROBOT"), "x.ini: no group `[Component/GA/Experiment/ROBOT]`"),
        (with("none", "").replace("Epuck\n", "iCub\n"), "x.ini line 8: unknown wheeled robot `iCub`"),
        (without("[Component/GA/Experiment/Sensor:0"), "x.ini: no sensor of it can be carried over"),
        (with("none", "").replace("EpuckWheelVelocityMotor", "FakeMotor"), "x.ini: no motor of it can be carried over"),
        (with("NET", "nHiddens = 999"), "x.ini: a network of 1009 neurons"),
        (with("GA", "nreproducing = 1000\nnoffspring = 1000"), "x.ini: a population of 1000000"),
        (
            with("Motor:0", "[Component/GA/Experiment/Motor:1]\ntype = MarXbotAttachmentDeviceMotor"),
            "x.ini: what comes out of it cannot be: x.toml",
        ),
    ] {
        let said = error(&text);
        assert!(said.contains(why), "{why}: {said}");
    }
    let deep: Vec<String> = (0..20)
        .map(|n| format!("[Component/GA/Experiment/Sensor:0{}]\ntype = NoisyInput\n", "/Input".repeat(n)))
        .collect();
    let deep = deep.concat();
    let said = error(&format!("{}{deep}", without("[Component/GA/Experiment/Sensor:0")));
    assert!(said.contains("more than 8 devices within each other"), "{said}");
}

#[test]
fn large_texts_are_bounded() {
    let mut groups = with("none", "");
    let mut parts = groups.clone();
    let mut keys = groups.clone();
    let mut noisy = groups.clone();
    // Each remark repeats the name of the group.
    let mut named = format!("{groups}[{}]\n", "a".repeat(200));
    for n in 0..4000 {
        let _ = writeln!(named, "b=1");
        let _ = writeln!(groups, "[{n}]");
        let _ = writeln!(keys, "noisRange{n} = 1");
    }
    for n in 0..1000 {
        let _ = writeln!(parts, "[Component/GA/Experiment/Sensor:{n}]\ntype = EpuckGroundIRSensor");
        let _ = writeln!(noisy, "[Component/GA/Experiment/Sensor:{n}]\ntype = NoisyInput");
    }
    let made = imported(&groups);
    assert!(made.text.len() < 100_000, "{}", made.text.len());
    for text in [groups, keys, named] {
        let ImportedFile { left, more_left, text, .. } = imported(&text);
        assert_eq!(left.len(), 400);
        assert!((3600..3700).contains(&more_left), "{more_left}");
        assert!(text.contains(&format!("\n# - and {} more\n", 200 + more_left)), "the file does not count them");
        assert!(left.iter().map(|left| left.key.len()).sum::<usize>() < 100_000);
    }
    let said = error(&format!("{}{}", with("none", ""), "a=1\n".repeat(5000)));
    assert!(said.contains("more than 5000 lines"), "{said}");
    for text in [parts, noisy] {
        let said = error(&text);
        assert!(said.contains("sensors, where 100 are the most"), "{said}");
    }
}

/// Draws a configuration with parts of the 2013 program and any values.
fn configurations() -> impl Strategy<Value = String> {
    let robots = prop::sample::select(vec!["Khepera", "Epuck", "MarXbot"]);
    let sensors = prop::sample::select(vec![
        "KheperaProximityIRSensor",
        "KheperaSampledProximityIRSensor",
        "KheperaSampledLightSensor",
        "KheperaGroundSensor",
        "MarXbotWheelSpeedsSensor",
        "EpuckLinearCameraSensor",
        "MarXbotLinearCameraSensorNew",
        "MarXbotLaserFrontDistanceSensor",
        "MarXbotLaserOmniDistanceSensor",
        "MarXbotTractionSensor",
        "FakeSensor",
    ]);
    let motors = prop::sample::select(vec!["KheperaWheelVelocityMotor", "MarXbotWheelVelOrient"]);
    let values = prop::sample::select(vec![
        "0", "1", "2", "12", "0.05", "-1", "true", "false", "Uniform", "1e9", "nan", "", "x\u{1b}",
    ]);
    let keys = prop::sample::select(vec![
        "nHiddens",
        "weightRange",
        "recurrentHiddens",
        "recurrentOutputs",
        "biasOnOutputNeurons",
        "nreproducing",
        "noffspring",
        "mutation_rate",
        "initial_mutation",
        "ntrials",
        "nsteps",
        "nagents",
        "planeWidth",
        "planeHeight",
        "timestep",
        "numReceptors",
        "aperture",
        "maxDistance",
        "noiseType",
        "noiseRange",
        "name",
        "useRedChannel",
        "useGreenChannel",
        "useBlueChannel",
        "mode",
        "ngenerations",
        "seed",
    ]);
    let kinds = prop::sample::select(vec!["X", "KheperaDiscriminationExperiment"]);
    let lines = prop::collection::vec((0usize..7, keys, values), 0..30);
    (robots, prop::collection::vec(sensors, 1..4), motors, kinds, lines).prop_map(
        |(robot, sensors, motor, kind, lines)| {
            let mut groups = vec![
                ("GA".to_owned(), "Evoga"),
                ("GA/Experiment".into(), kind),
                ("GA/Experiment/Arena".into(), "Arena"),
                ("GA/Experiment/ROBOT".into(), robot),
                ("GA/Experiment/NET".into(), "Evonet"),
                ("GA/Experiment/World".into(), "World"),
                ("GA/Experiment/Motor:0".into(), motor),
            ];
            groups.extend(sensors.iter().enumerate().map(|(n, sensor)| (format!("GA/Experiment/Sensor:{n}"), *sensor)));
            let mut text = String::new();
            for (number, (path, kind)) in groups.iter().enumerate() {
                let _ = write!(text, "[Component/{path}]\ntype = {kind}\n");
                for (_, key, value) in
                    lines.iter().filter(|(group, ..)| *group == number || (*group == 6 && number > 6))
                {
                    let _ = writeln!(text, "{key} = {value}");
                }
            }
            text
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn configurations_of_known_parts_become_files_that_are_right(text in configurations()) {
        match from_original("x.ini", "x.toml", &text) {
            Ok(made) => {
                let (genes, fitness) = lived(&made.text);
                prop_assert!(genes > 0 && fitness.is_finite(), "{}", made.text);
                // Remarks name all differences: always for invalid values, but a name may be any word.
                let odd = text.lines().filter(|line| line.contains("= nan") && !line.starts_with("name")).count();
                prop_assert!(made.left.iter().filter(|left| left.value == "nan").count() + made.idle.len() >= odd);
            }
            Err(error) => {
                let error = error.to_string();
                let known = ["can be carried over", "neurons", "what comes out of it cannot be: x.toml"];
                prop_assert!(known.iter().any(|known| error.contains(known)), "{error}\n{text}");
            }
        }
    }

    #[test]
    fn damaged_texts_are_read_or_refused(
        text in configurations(),
        cuts in prop::collection::vec((0usize..2000, "\\PC{0,6}|[\\[\\]/=:#;\\\\\n]{1,4}"), 0..8),
    ) {
        let mut signs: Vec<char> = text.chars().collect();
        for (at, other) in cuts {
            let at = at % signs.len();
            let end = (at + other.chars().count()).min(signs.len());
            signs.splice(at..end, other.chars());
        }
        let text: String = signs.into_iter().collect();
        if let Ok(made) = from_original("x.ini", "x.toml", &text) {
            let read = ComposedExperiment::from_text("x.toml", &made.text, farsa_lab::strategy::strategies());
            prop_assert!(read.is_ok(), "{:?}\n{}", read.err().map(|error| error.to_string()), made.text);
        }
    }

    #[test]
    fn any_text_is_read_or_refused(text in "\\PC{0,200}|[\\[\\]/=:# a\n]{0,200}") {
        let _ = from_original("x.ini", "x.toml", &text);
    }
}
