//! Numbers with their meaning: combinations of trials, intervals, tests of champions and learning curves.

use std::fs;
use std::path::Path;

use serde_json::Value;

#[cfg(target_os = "linux")]
use crate::tool::command;
#[cfg(unix)]
use crate::tool::{Running, interruptible};
use crate::tool::{farsa, json, ok, own, scratch};

fn read(path: &Path) -> String {
    fs::read_to_string(path).expect("the file")
}

/// Splits a table of fields without quotes.
fn rows(text: &str) -> Vec<Vec<&str>> {
    text.lines().map(|line| line.split(',').collect()).collect()
}

#[test]
fn an_experiment_without_a_criterion_has_no_share_of_successes() {
    let here = scratch("no-criterion");
    ok(farsa(), &here, "new follow --from light --quiet");
    assert!(!ok(farsa(), &here, "check follow.toml").contains("criterion"));
    let text = read(&here.join("follow.toml"));
    let without: Vec<&str> = text.lines().filter(|line| !line.starts_with("success")).collect();
    fs::write(here.join("follow.toml"), without.join("\n") + "\n").expect("the file");
    let checked = ok(farsa(), &here, "check follow.toml");
    assert!(checked.contains("fitness: near, touch (mean of 8 trials)\nsuccess: no criterion\n"), "{checked}");
    assert_eq!(json(&ok(farsa(), &here, "check follow.toml --json"))["has_success"], false);

    let run = ok(farsa(), &here, "run follow.toml --generations 1 --population 8 --set episode.steps=20 --out r");
    assert!(run.contains(" (mean of 8 trials)\n"), "{run}");
    let small = "--generations 1 --population 8 --set episode.steps=20";
    let test = ok(farsa(), &here, &format!("run follow.toml {small} --out t --test 1"));
    assert!(test.contains("\ntest of 1 trial: no criterion of success, mean fitness of a trial "), "{test}");
    let sweep = "experiment = \"follow.toml\"\nevolution.generations = 1\nevolution.population = 8\n[grid]\nepisode.steps = [20, 30]\n[test]\ntrials = 1\n";
    fs::write(here.join("sweep.toml"), sweep).expect("the sweep");
    let replications = format!("run follow.toml {small} --replications 1 --out runs --test 1");
    for line in [&replications, "sweep sweep.toml"] {
        let table = ok(farsa(), &here, line);
        assert!(table.lines().nth(1).is_some_and(|line| line.contains("  no criterion  ")), "{table}");
    }
    let tested = ok(farsa(), &here, "test r --trials 5");
    assert!(tested.contains("\nsuccess: no criterion\nfitness of a trial: mean "), "{tested}");
    assert!(tested.contains("fitness of a run: mean of 8 trials\n"), "{tested}");
    let found = json(&ok(farsa(), &here, "test r --trials 5 --json"));
    assert_eq!([&found["successes"], &found["rate"]], [&Value::Null; 2]);
    let table = read(&here.join("r/test.csv"));
    assert!(rows(&table)[1..].iter().all(|row| row[3].is_empty()), "{table}");
    let protocol = ok(farsa(), &here, "test r --protocol noise --trials 2");
    assert!(protocol.contains("trials  fitness") && !protocol.contains("success"), "{protocol}");
    let evaluated = ok(farsa(), &here, "export genotype r --out champion.gen --quiet");
    assert!(evaluated.is_empty());
    let evaluated = ok(farsa(), &here, "evaluate follow.toml --genes-file champion.gen --trials 3");
    assert!(evaluated.contains("mean_fitness ") && !evaluated.contains("success_rate"), "{evaluated}");
    let merged = ok(farsa(), &here, "merge r --quiet");
    let merged = rows(&merged);
    let column = merged[0].iter().position(|name| *name == "test success").expect("the column");
    assert_eq!(merged[1][column], "");
    ok(farsa(), &here, "report r --md r.md");
    let page = read(&here.join("r.md"));
    assert!(page.contains("| r | generation 0 | 5 | no criterion |"), "{page}");
    assert!(page.contains("| fitness | mean of 8 trials: near + touch |"), "{page}");
}

#[test]
fn a_test_has_intervals_and_its_record_has_results() {
    let here = scratch("test-results");
    ok(own(), &here, "run cart --generations 3 --out r --quiet");
    let text = ok(own(), &here, "test r --trials 20");
    let found = json(&ok(own(), &here, "test r --trials 20 --json"));
    let record = json(&read(&here.join("r/test.json")));
    for key in ["trials", "successes", "rate", "interval", "broken_down", "fitness", "fitness_interval", "notes"] {
        assert_eq!(record["results"][key], found[key], "{key}");
    }
    // The mean of the table, and Wilson's interval of k of 20: (2 k + z^2 -+ z (z^2 + 4 k (1 - k / 20))^(1/2)) / 2 / (20 + z^2).
    let table = read(&here.join("r/test.csv"));
    let rows = rows(&table);
    let fitness: Vec<f64> = rows[1..].iter().map(|row| row[4].parse().expect("a number")).collect();
    let mean = fitness.iter().sum::<f64>() / 20.0;
    let number = |value: &Value| value.as_f64().expect("a number");
    assert!((number(&found["fitness"]) - mean).abs() < 1e-12 * mean.abs());
    let (z, k) = (1.959_963_984_540_054_f64, rows[1..].iter().filter(|row| row[3] == "true").count() as f64);
    let reach = z * (z * z + 4.0 * k * (1.0 - k / 20.0)).sqrt();
    for (place, sign) in [(0, -1.0), (1, 1.0)] {
        let end = (2.0 * k + z * z + sign * reach) / (2.0 * (20.0 + z * z));
        assert!((number(&found["interval"][place]) - end).abs() < 1e-12, "{found}");
    }
    assert!(text.contains(" %, 95 % interval ") && text.contains("fitness of a trial: mean "), "{text}");
    // An interval of the mean is around the mean and within the extremes.
    let [low, high] = [0, 1].map(|place| number(&found["fitness_interval"][place]));
    let least = fitness.iter().copied().fold(f64::INFINITY, f64::min);
    let most = fitness.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    assert!(least <= low && low <= mean && mean <= high && high <= most, "{found}");
}

#[test]
fn champions_of_many_runs_are_tested_when_asked() {
    let here = scratch("champion-tests");
    let study = "run cart --generations 2 --replications 2 --out study";
    assert!(!ok(own(), &here, study).contains("test success"));
    let said = ok(own(), &here, &format!("{study} --test 12"));
    assert!(said.lines().next().is_some_and(|head| head.ends_with("test success  test fitness")), "{said}");
    let runs = json(&ok(own(), &here, &format!("{study} --test 12 --json")));
    for (number, seed) in [(0, 1), (1, 2)] {
        let path = here.join(format!("study/cart-rough-{seed}"));
        let record = json(&read(&path.join("test.json")));
        assert_eq!((&record["trials"], &record["seed"]), (&12.into(), &1.into()));
        let test = &runs["replications"][number]["test"];
        assert_eq!([&test["success"], &test["fitness"]], [&record["results"]["rate"], &record["results"]["fitness"]]);
    }
    // An equal test is not run again, and another one is.
    let table = here.join("study/cart-rough-1/test.csv");
    let time = || fs::metadata(&table).and_then(|file| file.modified()).expect("a time");
    let before = time();
    ok(own(), &here, &format!("{study} --test 12 --quiet"));
    assert_eq!(time(), before);
    ok(own(), &here, &format!("{study} --test 13 --quiet"));
    assert_eq!(json(&read(&here.join("study/cart-rough-1/test.json")))["trials"], 13);
    ok(own(), &here, "report study/cart-rough-1 study/cart-rough-2 --md study.md");
    let page = read(&here.join("study.md"));
    assert!(page.contains("success of the champions") && !page.contains("Not tested yet"), "{page}");
    // A single run, and a sweep by its file.
    let said = ok(own(), &here, "run cart --generations 1 --out one --test 5");
    assert!(said.contains("\ntest of 5 trials: success ") && here.join("one/test.csv").is_file(), "{said}");
    let file =
        "experiment = \"cart\"\nevolution.generations = 1\n[grid]\ncart.friction = [0.5, 1.0]\n[test]\ntrials = 4\n";
    fs::write(here.join("grid.toml"), file).expect("the sweep");
    let said = ok(own(), &here, "sweep grid.toml --out grid");
    assert!(said.starts_with("point  finished  median fitness  quartiles"), "{said}");
    assert!(said.contains("  median success  directory\n"), "{said}");
    for friction in ["0.5", "1.0"] {
        let record = json(&read(&here.join(format!("grid/friction={friction}/cart-rough-1/test.json"))));
        assert_eq!(record["trials"], 4);
    }
    ok(own(), &here, "sweep grid.toml --out grid --test 6 --quiet");
    assert_eq!(json(&read(&here.join("grid/friction=0.5/cart-rough-1/test.json")))["trials"], 6);
}

#[cfg(unix)]
#[test]
fn a_stopped_test_names_the_command_that_repeats_it() {
    let here = scratch("stopped-tests");
    // Without the stop, the test of 400000 trials takes minutes.
    let long = ["--generations", "1", "--test", "400000"];
    let arguments = |first: &[&'static str]| [first, &long].concat();
    let slow = ["run", "cart", "--set", "trial.steps=5000", "--set", "cart.friction=5"];
    let single = [&slow[..], &["--out", "my run"]].concat();
    let several = [&slow[..], &["--out", "my runs", "--replications", "1"]].concat();
    for (first, directory, resume) in [
        (single, "my run", "run --resume 'my run' --test 400000".to_owned()),
        (
            several,
            "my runs/cart-rough-1",
            format!("{} --out 'my runs' --replications 1 {}", slow.join(" "), long.join(" ")),
        ),
    ] {
        let mut program = Running::start(&mut interruptible(own(), &here, &arguments(&first)));
        let log = here.join(directory).join("fitness.csv");
        program.until("end of the run", || fs::read_to_string(&log).is_ok_and(|text| text.lines().count() == 2));
        program.signal("INT");
        let said = program.end();
        assert_eq!(said.code, Some(130), "{said:?}");
        assert!(said.err.contains(&format!("interrupted; go on with `own-experiment {resume}`")), "{said:?}");
        assert!(!here.join(directory).join("test.csv").exists());
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_run_in_a_directory_of_any_name_is_tested() {
    use std::os::unix::ffi::OsStrExt as _;

    let here = scratch("any-name");
    let name = std::ffi::OsStr::from_bytes(b"r\xff");
    let line: Vec<&std::ffi::OsStr> =
        ["run", "cart", "--generations", "1", "--test", "3", "--out"].map(std::ffi::OsStr::new).into();
    let output = command(own(), &here, &[&line[..], &[name]].concat()).output().expect("the program");
    assert!(output.status.success(), "{output:?}");
    assert!(here.join(name).join("test.csv").is_file());
}

#[test]
fn curves_of_runs_are_one_long_table() {
    let here = scratch("curves");
    for seed in [1, 2] {
        ok(own(), &here, &format!("run cart --generations 3 --seed {seed} --out runs/cart-{seed} --quiet"));
    }
    let short = "run predator-prey --generations 2 --population 16 --set trial.steps=2 --out runs/arena --quiet";
    ok(farsa(), &here, short);
    assert_eq!(ok(own(), &here, "merge runs/cart-1 runs/cart-2 --curves curves.csv"), "2 runs\n");
    let table = read(&here.join("curves.csv"));
    let found = rows(&table);
    let head = "directory,experiment,condition,strategy,seed,population,generation,evaluations,failed,best,mean,worst";
    assert_eq!((found[0].join(","), found.len()), (head.to_owned(), 1 + 2 * 3));
    for (number, row) in found[1..].iter().enumerate() {
        let (seed, generation) = (1 + number / 3, number % 3);
        let log = read(&here.join(format!("runs/cart-{seed}/fitness.csv")));
        let log = rows(&log);
        let line = &log[1 + generation];
        assert_eq!(row[..5].join(","), format!("runs/cart-{seed},cart,rough,truncation,{seed}"));
        assert_eq!(row[5..9].join(","), format!(",{generation},20,{}", line[5]));
        assert_eq!(row[9..], line[1..4]);
    }
    // The populations have their names, in the log and in the table.
    ok(farsa(), &here, "merge runs/arena --curves arena.csv --quiet");
    let (table, log) = (read(&here.join("arena.csv")), read(&here.join("runs/arena/fitness.csv")));
    let (found, log) = (rows(&table), rows(&log));
    assert_eq!(log[0][6..].join(","), "best predator,mean predator,worst predator,best prey,mean prey,worst prey");
    for (number, row) in found[1..].iter().enumerate() {
        let (generation, population) = (number / 2, number % 2);
        assert_eq!(row[5..8].join(","), format!("{},{generation},32", ["predator", "prey"][population]));
        assert_eq!(row[9..], log[1 + generation][6 + 3 * population..9 + 3 * population]);
    }
    assert_eq!(found.len(), 1 + 2 * 2);
}
