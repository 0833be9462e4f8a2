//! The scripts of the guide about clusters, with a Slurm that only writes down what it is asked for.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};

use crate::tool::{Running, command, ok, own, results, scratch};

fn script(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/guide/cluster").join(name)
}

/// A task of an array that begins, in a folder where `scontrol` writes its words to a file.
fn task(here: &Path, name: &str, number: u32, arguments: &str) -> Running {
    let bin = here.join("bin");
    fs::create_dir_all(&bin).expect("a folder");
    let scontrol = bin.join("scontrol");
    if !scontrol.exists() {
        fs::write(&scontrol, "#!/bin/sh\necho \"$@\" >>requeued\n").expect("a script");
        fs::set_permissions(&scontrol, fs::Permissions::from_mode(0o755)).expect("its mode");
    }
    let path = std::env::var("PATH").unwrap_or_default();
    let mut bash = command(Path::new("bash"), here, &[script(name)]);
    bash.args(arguments.split(' '))
        .env("PATH", format!("{}:{path}", bin.display()))
        .env("FARSA", own())
        .env_remove("FARSA_RUNS")
        .env_remove("FARSA_REPLICATIONS")
        .env("SLURM_JOB_ID", "7")
        .env("SLURM_ARRAY_JOB_ID", "5")
        .env("SLURM_ARRAY_TASK_ID", number.to_string())
        .env("SLURM_ARRAY_TASK_MAX", "2")
        .env("SLURM_CPUS_PER_TASK", "1");
    Running::start(&mut bash)
}

fn generations(run: &Path) -> usize {
    fs::read_to_string(run.join("fitness.csv")).map_or(0, |log| log.lines().count().saturating_sub(1))
}

#[test]
fn a_task_that_is_stopped_asks_to_be_started_again_and_ends_as_if_it_had_not() {
    let here = scratch("cluster-array");
    let study = "cart --generations 400 --set trial.steps=5000 --set cart.friction=5";
    ok(own(), &here, &format!("run {study} --replications 2 --out undisturbed -q"));
    let requeued = || fs::read_to_string(here.join("requeued")).unwrap_or_default();

    let mut first = task(&here, "array.sh", 2, study);
    let run = here.join("runs/cart-rough-2");
    first.until("generation 20", || generations(&run) >= 20);
    first.signal("TERM");
    first.until("requeue", || requeued() == "requeue 5_2\n");
    // As Slurm does with a task that it starts again.
    drop(first);
    let stopped = generations(&run);
    assert!((20..400).contains(&stopped), "{stopped}");

    for number in [2, 1] {
        let code = task(&here, "array.sh", number, study).end().code;
        assert_eq!(code, Some(0), "task {number}");
    }
    assert_eq!(requeued(), "requeue 5_2\n", "what ends by itself is not started again");
    for seed in [1, 2] {
        let name = format!("cart-rough-{seed}");
        assert_eq!(results(&here.join("runs").join(&name)), results(&here.join("undisturbed").join(&name)));
    }
}

#[test]
fn a_wrong_configuration_is_not_started_again() {
    let here = scratch("cluster-wrong");
    for (name, arguments) in [
        ("array.sh", "cart --set cart.frictoin=1"),
        ("array.sh", "nothing"),
        ("workers.sh", "run cart --replications 0"),
        ("workers.sh", "run cart --config nowhere.toml --replications 2"),
    ] {
        let code = task(&here, name, 1, arguments).end().code;
        assert!([Some(1), Some(2)].contains(&code), "{arguments}: {code:?}");
    }
    assert!(!here.join("requeued").exists() && !here.join("runs").exists());
}

#[test]
fn workers_share_a_sweep() {
    let here = scratch("cluster-workers");
    let file =
        "experiment = \"cart\"\nreplications = 2\n[evolution]\ngenerations = 30\n[grid]\ncart.friction = [0, 1, 2]\n";
    fs::write(here.join("friction.toml"), file).expect("the file");
    let workers = [1, 2].map(|number| task(&here, "workers.sh", number, "sweep friction.toml"));
    for worker in workers {
        assert_eq!(worker.end().code, Some(0));
    }
    ok(own(), &here, "sweep friction.toml --out alone -q");
    for friction in ["0.0", "1.0", "2.0"] {
        for seed in [1, 2] {
            let run = format!("friction={friction}/cart-rough-{seed}");
            assert_eq!(results(&here.join("runs/friction").join(&run)), results(&here.join("alone").join(&run)));
        }
    }
    assert!(!here.join("requeued").exists());
}
