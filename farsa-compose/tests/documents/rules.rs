//! Rules of a file: fixed and shared parameters, wires, placements, food, behaviors.

use farsa_body::Recorder;
use farsa_compose::ComposedExperiment;
use farsa_lab::{EpisodeId, Evaluation, Evaluator, Experiment as _, Note, Outcome, Settings};

const WORLD: &str = "[world]\nsize = [2.0, 2.0]\n[robot]\nkind = \"marxbot\"\n";
const PARTS: &str = "[[sensors]]\nkind = \"infrared\"\nmodel = \"rays\"\ngroups = 8\n[[motors]]\nkind = \"wheels\"\n";
const REWARD: &str = "[[reward]]\nkind = \"steps\"\n";

fn made(text: &str) -> Result<Box<dyn Evaluator>, farsa_lab::Error> {
    let made = ComposedExperiment::from_text("rules.toml", text, farsa_lab::strategy::strategies())?;
    made.prepare("", &Settings::new(made.settings(""))?)
}

fn evaluator(text: &str) -> Box<dyn Evaluator> {
    made(text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn refused(text: &str) -> String {
    made(text).err().unwrap_or_else(|| panic!("nothing is wrong with\n{text}")).to_string()
}

fn names(evaluator: &dyn Evaluator) -> Vec<String> {
    evaluator.info().parameters.into_iter().map(|parameter| parameter.name).collect()
}

/// Sensor and motor values in each step, and places of bodies.
#[derive(Default)]
struct Steps {
    x: Vec<f32>,
    y: Vec<f32>,
    poses: Vec<[f32; 2]>,
    all: Vec<[Vec<f32>; 2]>,
    first: Vec<[f32; 2]>,
    rays: usize,
}

impl Recorder for Steps {
    fn pose(&mut self, body: farsa_body::ports::BodyId, pose: farsa_body::Pose) {
        self.poses.resize(self.poses.len().max(usize::from(body.0) + 1), [0.0; 2]);
        self.poses[usize::from(body.0)] = [pose.position[0], pose.position[1]];
    }
    fn ray(&mut self, _: [f32; 3], _: [f32; 3], _: bool) {
        self.rays += 1;
    }
    fn sensors(&mut self, values: &[f32]) {
        self.x = values.into();
    }
    fn outputs(&mut self, values: &[f32]) {
        self.y = values.into();
    }
    fn tick(&mut self, _: f64) {
        if self.all.is_empty() {
            self.first = self.poses.clone();
        }
        self.all.push([self.x.clone(), self.y.clone()]);
    }
}

fn recorded(evaluator: &mut dyn Evaluator, parameters: &[f32], trial: u32) -> (Outcome, Steps) {
    let mut steps = Steps::default();
    let id = EpisodeId { seed: 4, trial, ..EpisodeId::default() };
    let outcome = evaluator.evaluate(Evaluation::new(parameters, id), Some(&mut steps));
    (outcome, steps)
}

/// Where a robot ends, along any direction of the plane, is a term like others, and describes what it did.
#[test]
fn a_position_is_where_the_robot_is() {
    let along = |name: &str, along: [f64; 3]| {
        format!("[[reward]]\nname = \"{name}\"\nkind = \"position\"\nalong = {along:?}\nover = \"end\"\nweight = 0.0\n")
    };
    let rest = "[episode]\nsteps = 60\ntrials = 1\n[network]\nkind = \"perceptron\"\n[behaviour]\n\
        descriptors = [{ term = \"x\", range = [0, 2] }, { term = \"slanting\", range = [0, 2] }]\n";
    let terms = along("x", [0.2, 0.0, 0.0]) + &along("slanting", [-0.6, 0.8, 1.0]);
    let text = format!("{WORLD}{PARTS}{REWARD}{terms}{rest}");
    let mut task = evaluator(&text);
    let parameters: Vec<f32> = (0..18).map(|number| 0.3 * number as f32 - 2.0).collect();
    let mut ends = Vec::new();
    for trial in 0..5 {
        let (outcome, steps) = recorded(task.as_mut(), &parameters, trial);
        let robot = steps.poses.last().map(|at| at.map(f64::from)).expect("a robot");
        assert!(steps.poses.last() != steps.first.last(), "it moves");
        let [x, y] = robot;
        let found = task.behavior().expect("descriptors").describe(&[outcome]);
        assert_eq!(found[0], x);
        assert!((found[1] - (0.8 * y - 0.6 * x)).abs() < 1e-12, "{found:?} at {robot:?}");
        ends.push(x);
    }
    assert!(ends.iter().any(|x| *x != ends[0]), "starts differ");
    let nowhere = text.replace("along = [0.2, 0.0, 0.0]", "along = [0.0, 0.0, 1.0]");
    assert!(refused(&nowhere).contains("points nowhere in the plane"));
    let body = text.replace("along = [0.2, 0.0, 0.0]", "along = [1.0, 0.0, 0.0]\nbody = \"hand\"");
    assert!(refused(&body).contains("a robot on wheels is one body"));
}

/// A parameter that is fixed or shared does what the same number in its place does.
#[test]
fn parameters_are_fixed_and_shared() {
    let rest = format!("{PARTS}{REWARD}[episode]\nsteps = 40\ntrials = 1\n");
    let mut plain = evaluator(&format!("{WORLD}{rest}[network]\nkind = \"perceptron\"\n"));
    let all = names(plain.as_ref());
    assert_eq!(all.len(), 18);
    let [left, right] = ["weight of infrared 2 on wheels left", "weight of infrared 8 on wheels right"];
    let network = format!(
        "[network]\nkind = \"perceptron\"\nfixed = {{ \"bias of wheels left\" = 1.5, \"bias of wheels right\" = -0.25 }}\n\
         shared = [[\"{left}\", \"{right}\"]]\n"
    );
    let mut fewer = evaluator(&format!("{WORLD}{rest}{network}"));
    let searched = names(fewer.as_ref());
    assert_eq!(searched.len(), 15);
    assert!(searched.contains(&left.to_string()) && !searched.contains(&right.to_string()), "{searched:?}");
    let of = |name: &str| {
        let name = if name == right { left } else { name };
        match name {
            "bias of wheels left" => 1.5,
            "bias of wheels right" => -0.25,
            _ => searched.iter().position(|known| known == name).map_or(f32::NAN, |number| number as f32 * 0.3 - 2.0),
        }
    };
    let expected: Vec<f32> = all.iter().map(|name| of(name)).collect();
    let own: Vec<f32> = searched.iter().map(|name| of(name)).collect();
    let (mut sensed, mut rays) = (0.0, 0);
    for trial in 0..8 {
        let (_, expected) = recorded(plain.as_mut(), &expected, trial);
        let (_, found) = recorded(fewer.as_mut(), &own, trial);
        assert_eq!(expected.all, found.all);
        sensed += found.all.iter().flat_map(|[x, _]| x).sum::<f32>();
        rays += found.rays;
    }
    assert!(sensed > 1.0, "{sensed}");
    assert_eq!(rays, 8 * 40 * 24, "a ray for each sensor of the only robot in every step");
    let text = |network: &str| refused(&format!("{WORLD}{rest}{network}"));
    let found = text("[network]\nkind = \"perceptron\"\nfixed = { \"bias of wheel left\" = 1.5 }\n");
    assert!(found.contains("unknown parameter `bias of wheel left`; the nearest is `bias of wheels left`"), "{found}");
    let found = text("[network]\nkind = \"perceptron\"\nfixed = { \"bias of wheels left\" = 1e9 }\n");
    assert!(found.contains("1000000000 is outside"), "{found}");
    let twice = format!("[network]\nkind = \"perceptron\"\nshared = [[\"{left}\", \"{left}\"]]\n");
    assert!(text(&twice).contains("is shared or fixed already"), "{}", text(&twice));
    let found =
        text("[network]\nkind = \"leaky\"\nhidden = 2\nshared = [[\"bias of neuron 1\", \"leak of neuron 1\"]]\n");
    assert!(found.contains("has another range than those before it"), "{found}");
}

/// Wires add up what they name, in the network and in the layer that leaves.
#[test]
fn wires_do_what_they_say() {
    let rest = format!("{PARTS}{REWARD}[episode]\nsteps = 40\ntrials = 1\n");
    let wires = "wires = [\n\
        { name = \"near\", from = [\"infrared 1\", \"infrared 2\"], to = \"wheels left\", weight = -2.0, searched = true },\n\
        { from = [\"infrared 8\", \"infrared 1\"], to = \"wheels right\", weight = -0.5 },\n]\n";
    for activation in ["clamp", "logistic"] {
        let network = format!("[network]\nkind = \"wired\"\nactivation = \"{activation}\"\nbias = [0.7, 0.8]\n{wires}");
        let mut wired = evaluator(&format!("{WORLD}{rest}{network}"));
        assert_eq!(names(wired.as_ref()), ["weight of near"]);
        let weight = 1.25_f32;
        for trial in 0..8 {
            for [x, y] in recorded(wired.as_mut(), &[weight], trial).1.all {
                let sums = [0.7 + (weight * x[0] + weight * x[1]), 0.8 + (-0.5 * x[7] - 0.5 * x[0])];
                let expected =
                    sums.map(|sum| if activation == "clamp" { sum.clamp(0.0, 1.0) } else { farsa_num::logistic(sum) });
                assert_eq!(y, expected);
            }
        }
        let leaves = wired.exports().and_then(|exports| exports.controller(&[weight])).is_some();
        assert_eq!(leaves, activation == "logistic");
    }
    let text = |network: &str| refused(&format!("{WORLD}{rest}[network]\nkind = \"wired\"\n{network}"));
    assert!(text(&format!("bias = [0.5]\n{wires}")).contains("has 1 values where the motors want 2"));
    let found = text(&format!("bias = [0.5, 0.5]\n{}", wires.replace("infrared 8", "infrared 9")));
    assert!(found.contains("rules.toml line 21: unknown input `infrared 9`; the nearest is `infrared"), "{found}");
    assert!(
        text(&format!("bias = [0.5, 0.5]\n{}", wires.replace("wheels left", "wheel left"))).contains("unknown output")
    );
}

/// Descriptions list wrappers in the order of their application. Wrappers without channels change all of them.
#[test]
fn wrappers_are_told_as_they_act() {
    let rest = format!("{WORLD}{REWARD}[network]\nkind = \"perceptron\"\n[episode]\nsteps = 40\ntrials = 1\n");
    let text = |sensor: &str, motor: &str| {
        let sensors = format!("kind = \"infrared\"\nmodel = \"rays\"\ngroups = 8\nwrappers = [{sensor}]");
        format!("{rest}[[sensors]]\n{sensors}\n[[motors]]\nkind = \"wheels\"\nwrappers = [{motor}]\n")
    };
    let told = |sensor: &str, motor: &str| {
        let found = evaluator(&text(sensor, motor)).info().description;
        let after = |meaning: &str| meaning.split_once(" With ").map_or(String::new(), |(_, words)| words.into());
        [&found.sensors[0].meaning, &found.motors[0].meaning].map(|meaning| after(meaning))
    };
    for (wrapper, words) in [
        ("{ kind = \"uniform-noise\", amplitude = 0.5 }", "noise of at most 0.5"),
        ("{ kind = \"normal-noise\", deviation = 0.5 }", "normal noise of deviation 0.5"),
        ("{ kind = \"delay\", steps = 1 }", "a delay of 1 step"),
        ("{ kind = \"delay\", steps = 3 }", "a delay of 3 steps"),
        ("{ kind = \"scale\", gain = 2.0 }", "a factor of 2"),
        ("{ kind = \"scale\", gain = 2.0, offset = -1.0 }", "a factor of 2 and -1 added"),
        ("{ kind = \"saturate\", low = 0.25, high = 1.0 }", "ends at 0.25 and 1"),
        ("{ kind = \"threshold\", above = 0.5 }", "1 above 0.5 and 0 elsewhere"),
        ("{ kind = \"lesion\" }", "0"),
        ("{ kind = \"lesion\", channels = [1, 1] }", "0 in channel 1"),
        ("{ kind = \"stuck\", channels = [0, 1], after = 5 }", "no change in channels 0 to 1 after 5 steps"),
        ("{ kind = \"stuck\", value = 0.5 }", "0.5 after 0 steps"),
    ] {
        assert_eq!(told(wrapper, wrapper), [format!("{words}."), format!("{words}.")]);
    }
    assert_eq!(told("", ""), ["", ""]);
    let two = "{ kind = \"scale\", gain = 4.0, offset = 0.5 }, { kind = \"saturate\", low = 0.6, high = 1.0 }";
    let sensor = format!("{two}, {{ kind = \"stuck\", value = 0.25, after = 30 }}");
    let order = ["a factor of 4 and 0.5 added", "ends at 0.6 and 1"];
    assert_eq!(
        told(&sensor, two),
        [
            format!("{}, then {}, then 0.25 after 30 steps.", order[0], order[1]),
            format!("{}, then {}.", order[1], order[0])
        ]
    );
    let all_of = |sensor: &str| {
        let mut made = evaluator(&text(sensor, two));
        let parameters = vec![0.5; made.info().parameters.len()];
        recorded(made.as_mut(), &parameters, 3).1.all
    };
    let steps = all_of(&sensor);
    assert_eq!(steps.len(), 40);
    for (step, [x, _]) in steps.iter().enumerate() {
        let fits = |x: &f32| if step < 30 { (0.6..=1.0).contains(x) } else { *x == 0.25 };
        assert!(x.len() == 8 && x.iter().all(fits), "step {step}: {x:?}");
    }
    assert_eq!(steps, all_of(&sensor.replace("value = 0.25", "channels = [0, 7], value = 0.25")));
    assert!(refused(&text("{ kind = \"lesion\", channels = [0, 8] }", "")).contains("wrappers"));
}

/// Robots start near what they are to start near, and areas apart from each other.
#[test]
fn places_are_near_and_apart() {
    let objects = "[[objects]]\nname = \"a\"\nkind = \"disc\"\nradius = 0.3\ncolor = [0.2, 0.2, 0.2]\n\
        [[objects]]\nname = \"b\"\nkind = \"disc\"\nradius = 0.2\ncolor = [0.2, 0.2, 0.2]\n";
    let start = "[[start]]\nplace = \"a\"\nat = \"anywhere\"\nwalls = 0.1\n\
        [[start]]\nplace = \"b\"\nat = \"anywhere\"\nwalls = 0.1\napart = 0.15\n\
        [[start]]\nplace = \"robot\"\nat = \"near\"\nof = \"b\"\nwithin = 0.25\napart = 0.01\n";
    let world = WORLD.replace("kind = \"marxbot\"", "kind = \"khepera\"\ncount = 3");
    // Motors at rest: no robot moves.
    let network = "[network]\nkind = \"wired\"\nbias = [0.5, 0.5]\nwires = []\n[episode]\nsteps = 1\ntrials = 1\n";
    let text = format!("{world}{}{REWARD}{objects}{start}{network}", PARTS.replace("groups = 8\n", ""));
    let mut still = evaluator(&text);
    let length = |a: [f32; 2], b: [f32; 2]| {
        let [x, y] = [a[0] - b[0], a[1] - b[1]];
        (x * x + y * y).sqrt()
    };
    let mut far = 0.0_f32;
    for trial in 0..200 {
        let (_, steps) = recorded(still.as_mut(), &[0.5], trial);
        let [robots @ .., a, b] = &steps.first[..] else { panic!("{:?}", steps.first) };
        assert!(length(*a, *b) >= 0.65 - 1e-6, "{a:?} {b:?}");
        assert_eq!(robots.len(), 3);
        for robot in robots {
            assert!(length(*robot, *b) <= 0.25 + 1e-6);
            far = far.max(length(*robot, *b));
        }
    }
    assert!(far > 0.2, "{far}");
    let wrong = text.replace(
        "place = \"b\"\nat = \"anywhere\"\nwalls = 0.1\napart = 0.15\n",
        "place = \"b\"\nat = \"near\"\nof = \"c\"\nwithin = 1\n",
    );
    assert!(refused(&wrong).contains("unknown object `c`"));
    let late = text.replace(
        "place = \"a\"\nat = \"anywhere\"\nwalls = 0.1\n",
        "place = \"a\"\nat = \"near\"\nof = \"b\"\nwithin = 0.1\n",
    );
    assert!(refused(&late).contains("`b` has to be placed before"), "{}", refused(&late));
    assert!(refused(&text.replace("apart = 0.15", "apart = 1.5")).contains("start"), "no room");
}

const FORAGING: &str = "[[objects]]\nname = \"nest\"\nkind = \"disc\"\nradius = 0.2\ncolor = [0.4, 0.4, 0.4]\nat = [1.0, 1.0]\n\
    [foraging]\nnest = \"nest\"\ncells = 10\ncost = 0.05\n\
    [[sensors]]\nkind = \"energy\"\n[[sensors]]\nkind = \"carried\"\n[[motors]]\nkind = \"wheels\"\n\
    [[reward]]\nkind = \"food\"\nover = \"end\"\n[[reward]]\nkind = \"energy\"\nover = \"end\"\nweight = 0.0\n\
    [[reward]]\nkind = \"alive\"\nover = \"sum\"\nweight = 0.0\n";

/// Without the nest a robot is alive for twenty steps, senses its energy, and stops then.
#[test]
fn who_has_no_energy_is_dead() {
    let network = "[network]\nkind = \"wired\"\nbias = [0.7, 0.7]\nwires = []\n";
    let start = "[[start]]\nplace = \"robot\"\nat = \"fixed\"\npoint = [0.4, 0.4]\nheading = 180\n";
    let episode = "[episode]\nsteps = 60\ntrials = 1\n";
    let text = format!("{WORLD}{FORAGING}{network}{start}{episode}");
    let (outcome, steps) = recorded(evaluator(&text).as_mut(), &[0.5], 0);
    assert_eq!((outcome.terms[0], outcome.steps), (0.0, 60));
    let energy = |step: usize| steps.all[step][0][0];
    assert!((energy(10) - 0.5).abs() < 1e-6 && energy(19) > 0.0 && energy(20) == 0.0, "{}", energy(10));
    assert_eq!((steps.all[0][0][1], steps.all[5][0][1]), (0.0, 1.0), "the cell where it stands has food");
    assert_eq!((steps.all[10][1][0], steps.all[30][1][0]), (0.7, 0.5));
    assert!(
        outcome.notes.iter().any(|(name, note)| *name == "measured alive" && *note == Note::Number(19.0)),
        "{outcome:?}"
    );
    let text = text.replace("trials = 1\n", "trials = 1\nends = [\"death\"]\n");
    assert_eq!(recorded(evaluator(&text).as_mut(), &[0.5], 0).0.steps, 20);
    let without = text.replace("[foraging]\nnest = \"nest\"\ncells = 10\ncost = 0.05\n", "");
    assert!(refused(&without).contains("needs the section `foraging`"), "{}", refused(&without));
    assert!(refused(&text.replace("nest = \"nest\"", "nest = \"robot\"")).contains("unknown object `robot`"));
}

/// A term without weight is measured only. It is not part of the fitness, and a product is not 0 because of it.
#[test]
fn fitness_is_made_of_terms_with_a_weight() {
    let text = format!("{WORLD}{FORAGING}[network]\nkind = \"perceptron\"\n[episode]\nsteps = 30\ntrials = 1\n");
    let lived = |text: &str| {
        let mut task = evaluator(text);
        let parameters = vec![0.3; task.info().parameters.len()];
        let outcome = recorded(task.as_mut(), &parameters, 0).0;
        (task.info().terms, task.fitness(std::slice::from_ref(&outcome)), outcome)
    };
    let (terms, fitness, outcome) = lived(&text);
    assert_eq!((terms, &outcome.terms[..]), (vec!["food".to_owned()], &[fitness][..]));
    let notes: Vec<&str> = outcome.notes.iter().map(|(name, _)| *name).collect();
    assert_eq!(notes, ["measured energy", "measured alive"]);
    let paid = text.replace("kind = \"alive\"\nover = \"sum\"\nweight = 0.0", "kind = \"alive\"\nover = \"sum\"");
    let (terms, product, outcome) = lived(&format!("{paid}[fitness]\nproduct = true\n"));
    assert_eq!(terms, ["food", "alive"]);
    assert!(product == outcome.terms[0] * outcome.terms[1] && outcome.terms[1] > 1.0, "{outcome:?}");
    let (terms, fitness, outcome) =
        lived(&text.replace("over = \"end\"\n[[reward]]", "over = \"end\"\nweight = 0.0\n[[reward]]"));
    assert_eq!((terms.len(), fitness, outcome.notes.len()), (3, 0.0, 3), "where none has a weight");
}

/// Archives use the means of terms before their weights.
#[test]
fn behaviours_are_measures_of_terms() {
    let behaviour = "[behaviour]\nobjectives = [{ term = \"energy\", less = true }]\n\
        descriptors = [{ term = \"alive\", range = [0, 60] }]\n";
    let text =
        format!("{WORLD}{FORAGING}[network]\nkind = \"perceptron\"\n[episode]\nsteps = 60\ntrials = 2\n{behaviour}");
    let mut task = evaluator(&text);
    let parameters = vec![0.3; task.info().parameters.len()];
    let trials: Vec<Outcome> = (0..2).map(|trial| recorded(task.as_mut(), &parameters, trial).0).collect();
    let note = |outcome: &Outcome, wanted: &str| match outcome
        .notes
        .iter()
        .find(|(name, _)| name.strip_prefix("measured ") == Some(wanted))
    {
        Some((_, Note::Number(value))) => *value,
        other => panic!("{wanted}: {other:?}"),
    };
    let mean = |name: &str| trials.iter().map(|trial| note(trial, name)).sum::<f64>() / 2.0;
    let behaviour = task.behavior().expect("a behaviour");
    assert_eq!(behaviour.objectives(), ["minus energy"]);
    assert_eq!(behaviour.measures()[0].ends, [0.0, 60.0]);
    assert_eq!(behaviour.describe(&trials), [-mean("energy"), mean("alive")]);
    assert!(mean("alive") > 1.0);
    let wrong = text.replace("range = [0, 60]", "range = [60, 0]");
    assert!(refused(&wrong).contains("does not rise"));
    assert!(
        refused(&text.replace("term = \"alive\", range", "term = \"alife\", range")).contains("the nearest is `alive`")
    );
}

/// A table of eight sensors, four angles and one distance.
const TABLE: &str = "8 4 1 0 50\nTURN 0\n512 512 512 512 512 512 0 0\n0 256 0 256 0 256 0 256\n0 0 0 0 0 0 512 512\n\
    256 0 256 0 256 0 256 0\nEND\n";

/// Infrared tables come from files in the folder of the experiment, and the text of a run contains them.
#[test]
fn a_text_has_the_files_that_it_names() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("measured");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(folder.join("tables")).expect("a folder");
    std::fs::write(folder.join("tables/wall.sam"), TABLE).expect("a table");
    std::fs::write(folder.join("round.sam"), TABLE.replace("256", "300")).expect("a table");
    std::fs::write(folder.join("none.sam"), "no table").expect("a file");
    let tables = "tables = { walls = \"tables/wall.sam\", bodies = [{ file = \"round.sam\", radius = 0.02 }] }\n";
    let sensor = format!("[[sensors]]\nkind = \"infrared\"\nmodel = \"tables\"\n{tables}");
    let rest = format!("[[motors]]\nkind = \"wheels\"\n{REWARD}[network]\nkind = \"perceptron\"\n");
    let world = WORLD.replace("marxbot", "khepera");
    let text = format!("{world}{sensor}{rest}");
    let read = |text: &str| {
        let path = folder.join("measured.toml");
        std::fs::write(&path, text).expect("a file");
        ComposedExperiment::from_file(&path, farsa_lab::strategy::strategies())
    };
    let refused = |text: &str| read(text).err().unwrap_or_else(|| panic!("nothing is wrong with\n{text}")).to_string();
    let own = read(&text).unwrap_or_else(|error| panic!("{error}"));
    let kept = own.definition().expect("the text").to_owned();
    assert!(kept.starts_with(text.trim_end()) && kept.contains("[files]") && kept.contains("300"), "{kept}");
    // A text alone reads no file, neither from the folder of its name nor from the working directory.
    for name in [&*folder.join("measured.toml").display().to_string(), "measured.toml"] {
        for (text, word) in
            [(text.clone(), "tables/wall.sam"), (text.replace("tables/wall.sam", "Cargo.toml"), "Cargo.toml")]
        {
            let found = ComposedExperiment::from_text(name, &text, farsa_lab::strategy::strategies()).err();
            let found = found.unwrap_or_else(|| panic!("{name} has read {word}")).to_string();
            let why = format!("`{word}` is not in the table `files`, and a text that is no file reads no others");
            assert!(found.contains("line 8: `sensors.1.tables.walls`") && found.contains(&why), "{found}");
        }
    }
    // From the text alone, in another place.
    let again = ComposedExperiment::from_text("elsewhere.toml", &kept, farsa_lab::strategy::strategies());
    let again = again.unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(again.definition(), Some(kept.as_str()));
    let mut felt = 0.0;
    for trial in 0..20 {
        let prepared = |made: &ComposedExperiment| made.prepare("", &Settings::new(made.settings(""))?);
        let [mut a, mut b] = [&own, &again].map(|made| prepared(made).unwrap_or_else(|error| panic!("{error}")));
        let parameters = vec![0.4; 18];
        let [a, b] = [a.as_mut(), b.as_mut()].map(|task| recorded(task, &parameters, trial).1.all);
        assert_eq!(a, b);
        felt += a.iter().flat_map(|[x, _]| x).sum::<f32>();
    }
    assert!(felt > 1.0, "{felt}");
    for (name, why) in [
        ("../measured/round.sam", "is no file in the folder"),
        ("/etc/passwd", "is no file in the folder"),
        ("tables/../round.sam", "is no file in the folder"),
        ("..\\\\round.sam", "is no file in the folder"),
        ("absent.sam", "measured.toml line 8: `sensors.1.tables.walls`: cannot read "),
        ("none.sam", "measured.toml line 8: `sensors.1.tables.walls`: none.sam"),
    ] {
        let found = refused(&text.replace("tables/wall.sam", name));
        assert!(found.contains(why), "{name}: {found}");
    }
    std::fs::write(folder.join("two.sam"), "2 4 1 0 50\nTURN 0\n512 512\n0 256\n0 0\n256 0\nEND\n").expect("a table");
    let found = refused(&text.replace("tables/wall.sam", "two.sam").replace("round.sam", "two.sam"));
    assert!(found.contains("are of 2 sensors where the Khepera has 8"), "{found}");
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(env!("CARGO_MANIFEST_DIR"), folder.join("away")).expect("a link");
        let found = refused(&text.replace("tables/wall.sam", "away/Cargo.toml"));
        assert!(found.contains("leads out of the folder"), "{found}");
    }
    assert!(refused(&text.replace(tables, "")).contains("lacks the key `tables`"));
    assert!(refused(&text.replace("model = \"tables\"\n", "")).contains("are for the model `tables`"));
    let found = refused(&kept.replace("\"round.sam\" =", "\"rund.sam\" ="));
    assert!(found.contains("unknown file `round.sam`; the nearest is `rund.sam`"), "{found}");
}

/// Objects may be in a separate file, and their errors name that file.
#[test]
fn a_scene_stands_in_a_file_of_its_own() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("scene");
    std::fs::create_dir_all(&folder).expect("a folder");
    let scene = "[[objects]]\nname = \"lamp\"\nkind = \"cylinder\"\nradius = 0.02\nlamp = 1.0\nat = [1.5, 1.0]\n\
        [[objects]]\nname = \"nest\"\nkind = \"disc\"\nradius = 0.3\ncolor = [0.2, 0.2, 0.2]\n";
    let text = |scene: &str| {
        format!(
            "[world]\nsize = [2.0, 2.0]\n{scene}[robot]\nkind = \"e-puck\"\n{}\
             [[reward]]\nkind = \"approach\"\nobject = \"lamp\"\n[network]\nkind = \"perceptron\"\n\
             [[start]]\nplace = \"nest\"\nat = \"anywhere\"\n",
            PARTS.replace("groups = 8\n", "")
        )
    };
    let read = |scene: &str, text: &str| {
        std::fs::write(folder.join("rooms.toml"), scene).expect("a scene");
        std::fs::write(folder.join("own.toml"), text).expect("a file");
        ComposedExperiment::from_file(folder.join("own.toml"), farsa_lab::strategy::strategies())
    };
    let apart = read(scene, &text("scene = \"rooms.toml\"\n")).unwrap_or_else(|error| panic!("{error}"));
    let inline = read(scene, &format!("{}{scene}", text(""))).unwrap_or_else(|error| panic!("{error}"));
    let prepared = |made: &ComposedExperiment| made.prepare("", &Settings::new(made.settings(""))?);
    let [mut a, mut b] = [&apart, &inline].map(|made| prepared(made).unwrap_or_else(|error| panic!("{error}")));
    let parameters = vec![0.4; 18];
    for trial in 0..5 {
        let [a, b] = [a.as_mut(), b.as_mut()].map(|task| recorded(task, &parameters, trial));
        assert_eq!((a.0, a.1.all), (b.0, b.1.all));
    }
    assert!(apart.settings("").iter().any(|setting| setting.key() == "objects.lamp.radius"));
    let refused = |scene: &str| match read(scene, &text("scene = \"rooms.toml\"\n")) {
        Ok(_) => panic!("nothing is wrong"),
        Err(error) => error.to_string(),
    };
    let found = refused(&scene.replace("radius = 0.02", "radius = -1"));
    assert!(found.contains("rooms.toml line 4: `objects.1.radius`: -1 is outside"), "{found}");
    let found = refused(&scene.replace("name = \"nest\"", "name = \"robot\""));
    assert!(found.contains("rooms.toml line 8: `objects.2.name`"), "{found}");
    assert!(refused(&format!("{scene}[robot]\nkind = \"e-puck\"\n")).contains("unknown key `robot`"));
}
