//! `farsa evaluate --stdin`: a custom optimizer at the other end of two pipes.

use std::fs;
use std::io::{BufRead as _, BufReader, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use farsa_num::{Domain, Stream};
use serde_json::{Value, json};

use crate::tool::{Deadline, Running, Said, command, farsa, ok, own, say, scratch};

/// The command at the other end of two pipes.
struct Served {
    child: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    _deadline: Deadline,
}

impl Served {
    fn new(program: &Path, here: &Path, arguments: &str) -> Self {
        let arguments: Vec<&str> = arguments.split(' ').collect();
        let mut child = command(program, here, &arguments).stdin(Stdio::piped()).spawn().expect("the program");
        let input = child.stdin.take().expect("a pipe");
        let output = BufReader::new(child.stdout.take().expect("a pipe"));
        let deadline = Deadline::new(child.id());
        Self { child, input, output, _deadline: deadline }
    }

    fn read(&mut self) -> Value {
        let mut line = String::new();
        assert!(self.output.read_line(&mut line).expect("a line") > 0, "there is no more");
        serde_json::from_str(&line).expect("JSON")
    }

    fn ask(&mut self, line: &Value) -> Value {
        writeln!(self.input, "{line}").and_then(|()| self.input.flush()).expect("a pipe");
        self.read()
    }

    fn end(self) -> Said {
        drop(self.input);
        drop(self.output);
        self.child.wait_with_output().expect("its end").into()
    }
}

/// The answers to lines that are written all at once.
fn all(program: &Path, here: &Path, arguments: &str, lines: &str) -> Said {
    let arguments: Vec<&str> = arguments.split(' ').collect();
    fs::write(here.join("lines"), lines).expect("a file");
    let input = fs::File::open(here.join("lines")).expect("a file");
    Running::start(command(program, here, &arguments).stdin(input)).end()
}

fn answers(said: &Said) -> Vec<Value> {
    said.out.lines().map(|line| serde_json::from_str(line).expect(line)).collect()
}

/// A search that moves to the best of ten neighbors, nearer ones each time.
#[test]
fn a_search_of_one_s_own_stops_the_cart() {
    let here = scratch("lines-search");
    let mut served = Served::new(own(), &here, "evaluate cart --stdin --threads 2");
    let about = served.read();
    assert_eq!(
        (&about["experiment"], &about["condition"], &about["trials"]),
        (&"cart".into(), &"rough".into(), &3.into())
    );
    assert_eq!((&about["populations"], &about["population_size"]), (&json!(["0"]), &Value::Null));
    assert_eq!(
        about["parameters"],
        json!([
            {"name": "gain of position", "range": [-8.0, 8.0]}, {"name": "gain of speed", "range": [-8.0, 8.0]}
        ])
    );
    let mut draw = Stream::new(20_261_124, Domain::General, 0, 0, 0);
    let (mut best, mut place, mut first, mut step) = (f64::NEG_INFINITY, [0.0, 0.0], None, 6.0);
    for generation in 0..12 {
        let mut near = |x: f64| (x + step * draw.range_f64(-1.0, 1.0)).clamp(-8.0, 8.0);
        let vectors: Vec<[f64; 2]> = (0..10).map(|_| [near(place[0]), near(place[1])]).collect();
        let answer = served.ask(&json!({"parameters": vectors, "id": generation}));
        assert_eq!((&answer["line"], &answer["id"]), (&(generation + 1).into(), &generation.into()));
        let fitness = answer["fitness"].as_array().expect("a list");
        assert_eq!(fitness.len(), 10);
        for (vector, (fitness, individual)) in
            vectors.iter().zip(fitness.iter().zip(answer["individuals"].as_array().expect("a list")))
        {
            assert_eq!(individual["fitness"], *fitness);
            // The cart may leave its track, which is a failure of the trial.
            let Some(fitness) = fitness.as_f64() else {
                assert!(individual["failed"].as_str().is_some_and(|why| !why.is_empty()), "{individual}");
                continue;
            };
            let trials = individual["trials"].as_array().expect("a list");
            let sum: f64 = trials.iter().map(|trial| trial["terms"]["fitness"].as_f64().expect("a term")).sum();
            assert!(trials.len() == 3 && (sum - fitness).abs() < 1e-12, "{individual}");
            assert!(trials.iter().all(|trial| trial["notes"]["at [m]"].is_f64() && trial["steps"] == 500));
            if fitness > best {
                (best, place) = (fitness, *vector);
            }
        }
        first.get_or_insert(best);
        step *= 0.7;
    }
    assert_eq!(served.end().code, Some(0));
    // Three trials earn a unit each at most.
    assert!(best > 2.45 && Some(best) > first, "{first:?} {best} {place:?}");
}

/// The champion of a run, sent again, earns what it earned there.
#[test]
fn it_is_what_a_run_evaluates() {
    let here = scratch("lines-run");
    ok(own(), &here, "run cart --generations 3 --seed 9 --out r");
    let champion: Value = serde_json::from_str(&ok(own(), &here, "replay r --json --out steps.csv")).expect("JSON");
    let words = ok(own(), &here, "export genotype r");
    let words: Vec<f64> = words.lines().filter_map(|word| word.parse().ok()).collect();
    assert_eq!(words.len(), 2, "two genes");
    let genes: Vec<f64> = words.iter().map(|word| 2.0 * word / 65535.0 - 1.0).collect();
    let parameters: Vec<f64> = words.iter().map(|word| -8.0 + 16.0 * word / 65535.0).collect();
    let at = |what: &str, row: &[f64], generation: u32| {
        json!({what: row, "seed": 9, "generation": generation, "individual": champion["individual"]}).to_string()
    };
    let lines = [at("parameters", &parameters, 2), at("genes", &genes, 2), at("genes", &genes, 1)].join("\n");
    let said = all(own(), &here, "evaluate cart --stdin", &lines);
    let found = answers(&said);
    assert_eq!((said.code, &found[1]["fitness"][0]), (Some(0), &champion["fitness"]), "{said:?}");
    let close = found[2]["fitness"][0].as_f64().zip(champion["fitness"].as_f64());
    assert!(close.is_some_and(|(a, b)| (a - b).abs() < 1e-4), "{close:?}");
    assert_ne!(found[3]["fitness"], found[2]["fitness"], "another generation, other starts");
    let seeded = all(own(), &here, "evaluate cart --stdin --seed 9", &lines.replace("\"seed\":9", "\"id\":1"));
    assert_eq!(answers(&seeded)[1]["fitness"], found[1]["fitness"]);
}

/// Vectors of every experiment, of all populations, on threads and in lanes.
#[test]
fn every_experiment_answers_with_the_same_bits() {
    let here = scratch("lines-all");
    ok(farsa(), &here, "new lamp --from light");
    let list: Value = serde_json::from_str(&ok(farsa(), &here, "list --json")).expect("JSON");
    let names = list.as_array().expect("a list").iter().filter_map(|one| one["name"].as_str());
    let mut several = 0;
    for name in names.filter(|name| cfg!(feature = "rapier") || *name != "push-box").chain(["lamp.toml"]) {
        let short = match name {
            "passive-walker" => " --set trial.steps=200 --set trial.count=1",
            "double-pole" | "minimal-cognition" => "",
            "lamp.toml" | "ant-omni" => " --set episode.steps=10",
            "hopper" | "walker2d" | "half-cheetah" | "ant" | "humanoid" | "go1-joystick" | "g1-walk" => {
                " --set episode.steps=10 --set strategy.normalise_observations=false"
            }
            _ => " --set trial.steps=10",
        };
        let words = format!("evaluate {name} --stdin{short}");
        let about = &answers(&all(farsa(), &here, &words, ""))[0];
        let count = about["parameters"].as_array().expect("a list").len();
        let populations = about["populations"].as_array().expect("a list").clone();
        let vector = |place: usize| {
            (0..count).map(|number| ((number * 7 + place * 3) % 11) as f64 / 5.0 - 1.0).collect::<Vec<_>>()
        };
        let genes = if populations.len() == 1 {
            json!([vector(0), vector(1), vector(2)])
        } else {
            several += 1;
            let of = |(place, name): (usize, &Value)| {
                (name.as_str().expect("a name").to_owned(), json!([vector(place), vector(place + 5)]))
            };
            Value::Object(populations.iter().enumerate().map(of).collect())
        };
        let line = json!({"genes": genes, "seed": 3, "generation": 2});
        let lines = format!("{line}\n{}\n{line}\n", json!({"genes": genes}));
        let one = all(farsa(), &here, &format!("{words} --threads 1 --lanes 1"), &lines);
        let other = all(farsa(), &here, &format!("{words} --threads 3"), &lines);
        assert_eq!((one.code, &one.out), (Some(0), &other.out), "{name}: {one:?}");
        let answers = answers(&one);
        for what in ["fitness", "individuals"] {
            assert_eq!(answers[1][what], answers[3][what], "{name}: the same line twice");
        }
        let first = if populations.len() == 1 { &answers[1]["fitness"] } else { &answers[1]["fitness"]["prey"] };
        assert_eq!(first.as_array().map(Vec::len), Some(if populations.len() == 1 { 3 } else { 2 }), "{name}");
    }
    assert_eq!(several, 1);
}

#[test]
fn populations_are_met_or_evaluated() {
    let here = scratch("lines-populations");
    let about = &answers(&all(farsa(), &here, "evaluate predator-prey --stdin", ""))[0];
    let count = about["parameters"].as_array().expect("a list").len();
    assert_eq!((&about["populations"], &about["population_size"]), (&json!(["predator", "prey"]), &json!(40)));
    let (a, b) = (vec![0.3; count], vec![-0.4; count]);
    let both = json!({"genes": {"prey": a, "predator": [b, a]}});
    let one = json!({"genes": {"predator": [b, a], "prey": a}, "evaluate": ["predator"]});
    let alone = json!({"genes": {"predator": a}});
    let text = format!("{both}\n{one}\n{alone}\n");
    let said = all(farsa(), &here, "evaluate predator-prey --stdin --set trial.steps=20", &text);
    assert_eq!(said.code, Some(2), "{said:?}");
    let found = answers(&said);
    assert_eq!(found[1]["fitness"]["predator"], found[2]["fitness"]["predator"]);
    assert_eq!(found[1]["fitness"]["prey"].as_array().map(Vec::len), Some(1));
    assert_eq!(found[2]["fitness"].as_object().map(serde_json::Map::len), Some(1));
    assert!(found[1]["individuals"]["prey"][0]["behaviour"].is_object(), "{}", found[1]);
    assert!(found[3]["error"].as_str().is_some_and(|why| why.contains("lacks the population `prey`")), "{}", found[3]);
}

/// A wrong line is answered, the next one is read, and the end reports it.
#[test]
fn wrong_lines_are_refused_one_by_one() {
    let here = scratch("lines-wrong");
    let long = format!("{{\"parameters\": [1, 2{}]}}", " ".repeat(17 << 20));
    let lines = format!(
        "{{\"parameters\": [1, 2]}}\n{{\"parameters\": [1]}}\n{long}\nnonsense\n\n{{\"parameters\": [NaN, 1]}}\n{{\"parameters\": [1, 9]}}\n{{\"parameters\": [1, 2]}}"
    );
    let said = all(own(), &here, "evaluate cart --stdin", &lines);
    let found = answers(&said);
    assert_eq!((said.code, found.len()), (Some(2), 9), "{said:?}");
    assert!(
        said.err.contains("6 of 8 lines were refused; line 2: parameters: vector 0: has 1 numbers where 2"),
        "{said:?}"
    );
    for (line, why) in [
        (2, "has 1 numbers where 2 are wanted"),
        (3, "more than 16777216 bytes"),
        (4, "is no object of JSON, {..}"),
        (5, "is empty"),
        (6, "NaN and Infinity are no numbers"),
        (7, "`gain of speed`, is 9.0, outside -8.0 to 8.0"),
    ] {
        assert_eq!(found[line]["line"], line);
        assert!(found[line]["error"].as_str().is_some_and(|error| error.contains(why)), "{}", found[line]);
    }
    assert_eq!((&found[1]["fitness"], &found[8]["line"]), (&found[8]["fitness"], &8.into()));
    for (arguments, word) in [
        ("evaluate cart --stdin --genes 1,2", "--genes"),
        ("evaluate cart --stdin --trials 3", "--trials"),
        ("evaluate cart --stdin --set cart.frction=1", "`cart.friction`"),
        ("evaluate cart", "--genes"),
    ] {
        let said = say(own(), &here, arguments);
        assert!(said.code == Some(2) && said.err.contains(word), "{arguments}: {said:?}");
    }
    let said = say(farsa(), &here, "evaluate reach-grasp-lift --stdin --set strategy.normalise_observations=true");
    assert!(said.code == Some(2), "{said:?}");
}

fn guide() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/guide/own-optimiser.md");
    fs::read_to_string(path).expect("the guide")
}

/// The program of the guide.
fn program() -> String {
    let guide = guide();
    let block = guide.split("```python optimise.py\n").nth(1).and_then(|rest| rest.split("```").next());
    block.expect("the guide has a program").to_owned()
}

#[test]
fn the_guide_s_program_has_twenty_lines_and_what_it_says_is_said() {
    let text = program();
    assert_eq!(text.lines().count(), 20, "{text}");
    assert!(text.lines().all(|line| line.chars().count() <= 120), "{text}");
    let here = scratch("lines-guide");
    ok(farsa(), &here, "new light --from light");
    let said = all(farsa(), &here, "evaluate light.toml --stdin", "{\"parameters\": [0]}\n{\"genes\": [0]}");
    let error = "parameters: vector 0: has 1 numbers where 96 are wanted";
    assert_eq!(answers(&said)[1]["error"], error);
    assert!(guide().contains(&error.replace("has 1", "has 95")) && guide().contains("networks of 96 parameters"));
}

/// With `FARSA_PYTHON`, a Python that has `cma`: `./ci guides` brings one.
#[test]
#[ignore = "needs FARSA_PYTHON, a Python with cma: ./ci guides"]
fn the_guide_s_program_finds_the_lamp() {
    let here = scratch("lines-python");
    let python = std::env::var_os("FARSA_PYTHON").expect("FARSA_PYTHON names a Python with cma");
    fs::write(here.join("optimise.py"), program()).expect("the program");
    ok(farsa(), &here, "new light --from light");
    let folder = farsa().parent().map(PathBuf::from).expect("a folder");
    let before = std::env::var_os("PATH").unwrap_or_default();
    let paths = [folder].into_iter().chain(std::env::split_paths(&before));
    let output = Command::new(python)
        .args(["optimise.py", "light.toml", "--threads", "2"])
        .current_dir(&here)
        .env("PATH", std::env::join_paths(paths).expect("a path"))
        .stdin(Stdio::null())
        .output()
        .expect("python");
    let said = Said::from(output);
    assert_eq!(said.code, Some(0), "{said:?}");
    assert_eq!(said.out.lines().count(), 60, "{said:?}");
    ok(farsa(), &here, "import best.gen --experiment light.toml --out best");
    let found: Value = serde_json::from_str(&ok(farsa(), &here, "test best --json")).expect("JSON");
    // Another release of cma searches other places. Random networks reach it in a few of a hundred.
    assert!(found["successes"].as_u64() > Some(50), "{found}");
}
