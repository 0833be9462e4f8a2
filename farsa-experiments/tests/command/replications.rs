//! Many runs by one command: the same as n commands, and interrupted any number of times.

use std::fs;
use std::path::Path;

use crate::tool::{Running, Said, command, content, interruptible, ok, own, results, say, scratch};

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
        let best = log.lines().last().and_then(|line| line.split(',').nth(1)?.parse::<f64>().ok());
        let best = format!("{:.3}", best.expect("the best"));
        assert!(
            said.out.lines().any(|line| line.contains(&format!("smooth-{seed} ")) && line.ends_with(&best)),
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

    // More of both, in another place: from the files of a single run.
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
    refused(&run.replace("replications 3", "replications 0"), "not a whole number from 1 to 4294967295");
    refused("run --resume runs/cart-rough-1 --replications 2", "--replications");
    refused("run cart --seed 9223372036854775806 --replications 3 --out x", "the largest seed is 9223372036854775807");
    refused("run cart --replications 2 --lanes 8 --out x", "cart has 1 only");
    refused("run cart --replications 2 --replication 3 --out x", "--replication 3: there are 2");
    refused("run cart --replications 2 --replication 0 --out x", "not a whole number from 1 to 4294967295");
    refused("run cart --replication 1 --out x", "--replications");
    // The seeds of all must be there, so that a task of an array is refused as the whole would be.
    refused(
        "run cart --seed 9223372036854775806 --replications 3 --replication 1 --out x",
        "the largest seed is 9223372036854775807",
    );
    assert!(!here.join("x").exists());
}

/// Trials long enough that a generation takes a few milliseconds.
const SLOW: &str = "run cart --set trial.steps=5000 --set cart.friction=5 --generations 600 --seed 2";

fn generations(run: &Path) -> usize {
    fs::read_to_string(run.join("fitness.csv")).map_or(0, |log| log.lines().count().saturating_sub(1))
}

/// Starts the command, sends it a signal once the second of its runs has some generations, and returns its output.
#[cfg(unix)]
fn cut_short(here: &Path, line: &str, signal: &str) -> Said {
    let arguments: Vec<&str> = line.split(' ').collect();
    let mut run = Running::start(&mut interruptible(own(), here, &arguments));
    let second = here.join("runs/cart-rough-3");
    let wanted = generations(&second) + 20;
    run.until("20 generations more", || generations(&second) >= wanted);
    run.signal(signal);
    run.end()
}

#[cfg(unix)]
#[test]
fn killed_interrupted_and_repeated() {
    let here = scratch("replications-cut");
    let line = format!("{SLOW} --replications 3");
    cut_short(&here, &line, "KILL");
    assert!(!here.join("runs/cart-rough-4").exists());
    let first = content(&here.join("runs/cart-rough-2"));
    let said = cut_short(&here, &line, "INT");
    assert_eq!(said.code, Some(130), "{said:?}");
    assert!(said.err.contains(&format!("interrupted; go on with `own-experiment {line}`")), "{said:?}");
    assert!(said.err.contains("replication 2 of 3: runs/cart-rough-3: continues\n"), "{said:?}");
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
    // Temporary files of a process that was killed while it made a directory would be next to the runs.
    assert_eq!(fs::read_dir(here.join("runs")).expect("a directory").count(), 3);
}

/// Sessions of a run: one for each process that was at it.
fn sessions(run: &Path) -> usize {
    let text = fs::read_to_string(run.join("manifest.json")).expect("the manifest");
    let manifest: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    manifest["sessions"].as_array().expect("a list").len()
}

#[test]
fn the_tasks_of_an_array_make_what_one_process_makes() {
    let here = scratch("replications-array");
    let run = "run cart --condition smooth --generations 5 --set trial.steps=100 --seed 7 --replications 3";
    ok(own(), &here, &format!("{run} --out whole"));
    // In any order, and one of them twice.
    for number in [2, 3, 2, 1] {
        let said = say(own(), &here, &format!("{run} --replication {number} --out tasks"));
        assert_eq!(said.code, Some(0), "{said:?}");
        let seed = number + 6;
        assert!(said.err.contains(&format!("replication {number} of 3: tasks/cart-smooth-{seed}")), "{said:?}");
        assert_eq!(said.out.lines().filter(|line| line.starts_with("tasks/")).count(), 1, "{said:?}");
    }
    for seed in [7, 8, 9] {
        let [whole, task] = ["whole", "tasks"].map(|name| here.join(name).join(format!("cart-smooth-{seed}")));
        assert_eq!(results(&whole), results(&task), "seed {seed}");
        assert_eq!(sessions(&task), 1, "seed {seed}");
    }
}

#[test]
fn processes_on_one_folder_share_the_runs() {
    let here = scratch("replications-shared");
    let run = "run cart --generations 40 --set trial.steps=400 --threads 1 --replications 6";
    ok(own(), &here, &format!("{run} --out one"));
    for processes in [2, 4] {
        let root = format!("shared-{processes}");
        let line = format!("{run} --out {root} --json");
        let arguments: Vec<&str> = line.split(' ').collect();
        let start = || Running::start(&mut command(own(), &here, &arguments));
        let begun: Vec<Running> = (0..processes).map(|_| start()).collect();
        let said: Vec<Said> = begun.into_iter().map(Running::end).collect();
        let mut made: Vec<u64> = Vec::new();
        for said in &said {
            assert_eq!(said.code, Some(0), "{said:?}");
            let json: serde_json::Value = serde_json::from_str(&said.out).expect("JSON");
            let runs = json["replications"].as_array().expect("a list");
            // Runs that one process does not report belong to the other.
            let elsewhere = json["elsewhere"].as_array().map_or(0, Vec::len);
            assert_eq!(runs.len() + elsewhere, 6, "{said:?}");
            assert_eq!(said.err.contains("repeat the command"), elsewhere > 0, "{said:?}");
            let mine = runs.iter().filter(|run| run["skipped"] == false);
            made.extend(mine.map(|run| run["seed"].as_u64().expect("a seed")));
        }
        made.sort_unstable();
        assert_eq!(made, [1, 2, 3, 4, 5, 6], "each once: {said:?}");
        for seed in 1..=6 {
            let [one, shared] = ["one", &root].map(|name| here.join(name).join(format!("cart-rough-{seed}")));
            assert_eq!(results(&one), results(&shared), "seed {seed}");
            assert_eq!(sessions(&shared), 1, "seed {seed}");
        }
        assert_eq!(fs::read_dir(here.join(&root)).expect("a directory").count(), 6, "no draft is left");
        // Again, alone: all of them, and nothing to do.
        let again = ok(own(), &here, &line);
        let json: serde_json::Value = serde_json::from_str(&again).expect("JSON");
        assert_eq!(json["replications"].as_array().map(Vec::len), Some(6), "{again}");
        assert_eq!(json.get("elsewhere"), None, "{again}");
    }
}

#[cfg(unix)]
#[test]
fn a_run_that_another_process_has_is_left_to_it() {
    let here = scratch("replications-busy");
    ok(own(), &here, "run cart --generations 2 --seed 2 --out runs/cart-rough-2");
    // As a process holds it.
    let lock = fs::OpenOptions::new()
        .create(true)
        .append(true)
        .open(here.join("runs/cart-rough-2/.run.lock"))
        .expect("its lock");
    lock.try_lock().expect("the lock");
    let run = "run cart --generations 4 --replications 3";
    let [said, only] = [say(own(), &here, run), say(own(), &here, &format!("{run} --replication 2"))];
    drop(lock);
    assert_eq!((said.code, only.code), (Some(0), Some(0)), "{said:?} {only:?}");
    let busy = "replication 2 of 3: runs/cart-rough-2: another process is at it";
    assert!(said.err.contains(busy) && only.err.contains(busy), "{said:?} {only:?}");
    let others = "another process is at 1 run: repeat the command for the result";
    assert!(said.err.contains(others) && only.err.contains(others), "{said:?} {only:?}");
    assert_eq!([1, 2, 3].map(|seed| generations(&here.join(format!("runs/cart-rough-{seed}")))), [4, 2, 4]);
    let said = say(own(), &here, run);
    assert!(said.code == Some(0) && said.err.contains("runs/cart-rough-2: continues"), "{said:?}");
    assert_eq!(generations(&here.join("runs/cart-rough-2")), 4);
}

#[test]
fn a_wrong_configuration_never_asks_to_be_started_again() {
    let here = scratch("replications-never-75");
    fs::write(here.join("wrong.toml"), "experiment = \"cart\"\n[cart]\nfrictoin = 1\n").expect("a file");
    for line in [
        "run cart --replications 3 --replication 4",
        "run cart --set cart.friction=-1 --replications 3",
        "run --config wrong.toml --replications 2",
        "run nothing --replications 2",
        "run --resume nowhere",
        "run cart --replications",
        "sweep wrong.toml",
        "sweep nothing.toml",
    ] {
        let arguments: Vec<&str> = line.split(' ').collect();
        for scheduler in ["SLURM_JOB_ID", "PBS_JOBID"] {
            let said = Running::start(command(own(), &here, &arguments).env(scheduler, "42")).end();
            assert!([Some(1), Some(2)].contains(&said.code), "{line}: {said:?}");
        }
    }
    assert_eq!(fs::read_dir(&here).expect("a directory").count(), 1);
}

#[cfg(unix)]
#[test]
fn under_a_scheduler_an_interrupted_study_asks_to_be_started_again() {
    let here = scratch("replications-75");
    let line = format!("{SLOW} --replications 2");
    let arguments: Vec<&str> = line.split(' ').collect();
    let mut run = Running::start(interruptible(own(), &here, &arguments).env("SLURM_JOB_ID", "42"));
    run.until("generation 20", || generations(&here.join("runs/cart-rough-2")) >= 20);
    run.signal("TERM");
    let said = run.end();
    assert_eq!(said.code, Some(75), "{said:?}");
    assert!(said.err.contains(&format!("interrupted; go on with `own-experiment {line}`")), "{said:?}");
}
