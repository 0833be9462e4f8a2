//! Many runs by one command: the same as so many commands, and interrupted any number of times.

use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::tool::{Said, command, content, ok, own, results, say, scratch};

#[test]
fn the_same_as_single_runs() {
    let here = scratch("replications");
    let run = "run cart --condition smooth --generations 5 --set trial.steps=100 --seed 7";
    let said = say(own(), &here, &format!("{run} --replications 3"));
    assert_eq!(said.code, Some(0), "{said:?}");
    for (number, seed) in [(1, 7), (2, 8), (3, 9)] {
        ok(own(), &here, &format!("{run} --seed {seed} --out single-{seed}").replacen("--seed 7 ", "", 1));
        let one = here.join(format!("runs/cart-smooth-{seed}"));
        assert_eq!(results(&one), results(&here.join(format!("single-{seed}"))));
        assert!(said.err.contains(&format!("replication {number} of 3: runs/cart-smooth-{seed}\n")), "{said:?}");
        let log = fs::read_to_string(one.join("fitness.csv")).expect("the log");
        let best = log.lines().last().and_then(|line| line.split(',').nth(1)).expect("the best");
        assert!(
            said.out.lines().any(|line| line.contains(&format!("smooth-{seed} ")) && line.ends_with(best)),
            "{said:?}"
        );
    }
    assert!(said.out.contains("champions' fitness: median "), "{said:?}");

    // Again: nothing is evaluated, nothing is touched, and the summary is the same.
    let before = content(&here);
    let again = say(own(), &here, &format!("{run} --replications 3"));
    assert_eq!((again.code, &again.out), (Some(0), &said.out));
    assert_eq!(again.err.lines().filter(|line| line.ends_with("all 5 generations are finished already")).count(), 3);
    assert!(!again.err.contains("generation 0"), "{again:?}");
    assert_eq!(content(&here), before);

    // More of both, elsewhere: from what a single run has begun.
    ok(
        own(),
        &here,
        &format!("{run} --generations 2 --seed 8 --out study/cart-smooth-8")
            .replacen("--generations 5 ", "", 1)
            .replacen("--seed 7 ", "", 1),
    );
    let json = ok(own(), &here, &format!("{run} --replications 2 --out study --json --quiet"));
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let replications = json["replications"].as_array().expect("a list");
    assert_eq!(replications.len(), 2);
    assert_eq!((&replications[1]["seed"], &replications[1]["skipped"]), (&8.into(), &false.into()));
    assert_eq!((&replications[1]["evaluations"], &replications[1]["generations"]), (&60.into(), &5.into()));
    let fitness = |index: usize| replications[index]["champion"]["fitness"].as_f64().expect("a number");
    assert!(
        (json["median"].as_f64().expect("a number") - f64::midpoint(fitness(0), fitness(1))).abs() < 1e-12,
        "{json}"
    );
    assert_eq!(results(&here.join("study/cart-smooth-8")), results(&here.join("single-8")));
}

#[test]
fn what_is_in_the_way_stops_them_before_they_begin() {
    let here = scratch("replications-refused");
    let run = "run cart --generations 3 --set trial.steps=50 --replications 3";
    let refused = |arguments: &str, word: &str| {
        let before = content(&here);
        let said = say(own(), &here, arguments);
        assert!(said.code == Some(2) && said.err.contains(word), "{arguments}: no {word} in {said:?}");
        assert_eq!(content(&here), before, "{arguments}");
    };
    fs::create_dir_all(here.join("runs/cart-rough-3")).expect("a directory");
    fs::write(here.join("runs/cart-rough-3/letter.txt"), "dear").expect("a file");
    refused(run, "runs/cart-rough-3: already holds other files");
    fs::remove_file(here.join("runs/cart-rough-3/letter.txt")).expect("a file");
    // An empty directory is not in the way.
    ok(own(), &here, run);
    refused(&format!("{run} --set cart.friction=2"), "`cart.friction` = 0.5, not 2");
    refused(
        &run.replace("--generations 3", "--generations 2"),
        "runs/cart-rough-1: has finished 3 generations already",
    );
    refused(&run.replace("replications 3", "replications 0"), "0 is not in 1..");
    refused("run --resume runs/cart-rough-1 --replications 2", "--replications");
    refused("run cart --seed 9223372036854775806 --replications 3 --out x", "the largest seed is 9223372036854775807");
    refused("run cart --replications 2 --lanes 8 --out x", "cart has 1 only");
    assert!(!here.join("x").exists());
}

/// Trials long enough that a generation takes a few milliseconds.
const SLOW: &str = "run cart --set trial.steps=5000 --set cart.friction=5 --generations 600 --seed 2";

fn generations(run: &Path) -> usize {
    fs::read_to_string(run.join("fitness.csv")).map_or(0, |log| log.lines().count().saturating_sub(1))
}

/// Begins the command, sends it a signal once the second of its runs has some generations, and returns what it said.
#[cfg(unix)]
fn cut_short(here: &Path, line: &str, signal: &str) -> Said {
    let arguments: Vec<&str> = line.split(' ').collect();
    let mut child = command(own(), here, &arguments);
    if signal == "-KILL" {
        // Nothing reads its output: a full pipe would hold it up.
        child.stderr(Stdio::null());
    }
    let mut child = child.spawn().expect("the program");
    let second = here.join("runs/cart-rough-3");
    let wanted = generations(&second) + 20;
    let patience = Instant::now() + Duration::from_secs(120);
    while generations(&second) < wanted {
        assert!(Instant::now() < patience, "no generation {wanted}");
        assert_eq!(child.try_wait().expect("the child"), None, "it ended by itself");
        sleep(Duration::from_millis(2));
    }
    let kill = std::process::Command::new("kill").args([signal, &child.id().to_string()]).status().expect("kill");
    assert!(kill.success());
    child.wait_with_output().expect("its end").into()
}

#[cfg(unix)]
#[test]
fn killed_interrupted_and_repeated() {
    let here = scratch("replications-cut");
    let line = format!("{SLOW} --replications 3");
    cut_short(&here, &line, "-KILL");
    assert!(!here.join("runs/cart-rough-4").exists());
    let first = content(&here.join("runs/cart-rough-2"));
    let said = cut_short(&here, &line, "-INT");
    assert_eq!(said.code, Some(130), "{said:?}");
    assert!(said.err.contains(&format!("interrupted; go on with `own-experiment {line}`")), "{said:?}");
    assert!(said.err.contains("replication 2 of 3: runs/cart-rough-3: goes on\n"), "{said:?}");
    assert!(generations(&here.join("runs/cart-rough-3")) < 600 && !here.join("runs/cart-rough-4").exists());

    let said = say(own(), &here, &line);
    assert_eq!(said.code, Some(0), "{said:?}");
    assert!(said.err.contains("replication 1 of 3: runs/cart-rough-2: all 600 generations are finished"), "{said:?}");
    assert_eq!(content(&here.join("runs/cart-rough-2")), first, "what is finished is not touched");
    for seed in [2, 3, 4] {
        ok(own(), &here, &format!("{} --seed {seed} --out single-{seed}", SLOW.trim_end_matches(" --seed 2")));
        assert_eq!(
            results(&here.join(format!("runs/cart-rough-{seed}"))),
            results(&here.join(format!("single-{seed}")))
        );
    }
    // Drafts of a process that was killed while it made a directory would lie beside the runs.
    assert_eq!(fs::read_dir(here.join("runs")).expect("a directory").count(), 3);
}
