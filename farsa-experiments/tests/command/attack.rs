//! Results of an attack, end to end: hostile files, processes at the same time, signals, and refusals of the system.

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::Duration;

use crate::tool::{Said, command, interruptible, ok, own, scratch};

/// Runs a line of a shell.
fn shell(here: &Path, line: &str) -> Said {
    let mut shell = Command::new("sh");
    shell.arg("-c").arg(line).current_dir(here).stdin(Stdio::null()).env("F", own());
    shell.output().expect("a shell").into()
}

/// A run that continues until it is stopped, once it has finished some generations.
fn begun(here: &Path, start: &mut Command) -> Child {
    let child = start.current_dir(here).spawn().expect("the program");
    let log = here.join("r/fitness.csv");
    while !fs::read_to_string(&log).is_ok_and(|text| text.lines().count() > 5) {
        thread::sleep(Duration::from_millis(5));
    }
    child
}

fn endless(here: &Path) -> Command {
    let mut start =
        interruptible(own(), here, &["run", "cart", "--generations", "4000000", "--out", "r", "--threads", "1"]);
    // A machine of a cluster that tests has its own.
    for name in ["SLURM_JOB_ID", "PBS_JOBID", "LSB_JOBID", "SGE_TASK_ID", "OAR_JOB_ID", "FLUX_JOB_ID", "_CONDOR_JOB_AD"]
    {
        start.env_remove(name);
    }
    start
}

fn signal(child: &Child, name: &str) {
    let sent = Command::new("kill").args([format!("-{name}"), child.id().to_string()]).status().expect("kill");
    assert!(sent.success());
}

#[cfg(unix)]
#[test]
fn signals_end_a_run_as_ctrl_c_does() {
    for (name, scheduler, code) in [("INT", "", 130), ("TERM", "", 130), ("HUP", "", 130), ("TERM", "42", 75)] {
        let here = scratch(&format!("signals-{name}{scheduler}"));
        let mut start = endless(&here);
        if !scheduler.is_empty() {
            start.env("SLURM_JOB_ID", scheduler);
        }
        let child = begun(&here, &mut start);
        signal(&child, name);
        let said = Said::from(child.wait_with_output().expect("its end"));
        assert_eq!(said.code, Some(code), "{name}: {said:?}");
        assert!(said.err.contains("go on with `own-experiment run --resume r`"), "{name}: {said:?}");
        // All that was finished is kept: the log has no line more than the checkpoint.
        let log = fs::read_to_string(here.join("r/fitness.csv")).expect("the log");
        let done = log.lines().count() - 1;
        ok(own(), &here, &format!("run --resume r --generations {done} -q"));
        assert_eq!(fs::read_to_string(here.join("r/fitness.csv")).expect("the log"), log);
    }
}

#[cfg(unix)]
#[test]
fn what_nohup_ignores_stays_ignored() {
    let here = scratch("nohup");
    let mut start = Command::new("nohup");
    start.arg(own()).args(["run", "cart", "--generations", "4000000", "--out", "r", "--threads", "1"]);
    start.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let child = begun(&here, &mut start);
    signal(&child, "HUP");
    let lines = || fs::read_to_string(here.join("r/fitness.csv")).expect("the log").lines().count();
    let before = lines();
    while lines() < before + 50 {
        thread::sleep(Duration::from_millis(5));
    }
    signal(&child, "TERM");
    let said = Said::from(child.wait_with_output().expect("its end"));
    assert!(said.code == Some(130) || said.code == Some(75), "{said:?}");
}

#[cfg(target_os = "linux")]
#[test]
fn files_without_an_end_end() {
    let here = scratch("own-endless");
    ok(own(), &here, "run cart --generations 2 --out r -q");
    for (line, words) in [
        ("$F run --config /dev/zero", "/dev/zero: "),
        ("$F evaluate cart --genes-file /dev/zero", "/dev/zero: "),
        ("mkfifo fifo; yes > fifo & $F run --config fifo", "fifo: has more than 4000000 bytes"),
        ("mkfifo robot; : > robot & $F robot robot", "does not have a root node"),
        ("cp -r r a; rm a/checkpoint.bin; mkfifo a/checkpoint.bin; $F run --resume a", "a/checkpoint.bin: "),
        ("cp -r r b; rm b/config.toml; ln -s /dev/zero b/config.toml; $F replay b", "b: holds no run"),
        ("cp -r r c; rm c/record.bin; mkfifo c/record.bin; $F replay c", "c/record.bin: "),
    ] {
        let said = shell(&here, &format!("ulimit -v 4000000; {line}"));
        assert!(said.code == Some(1) || said.code == Some(2), "{line}: {said:?}");
        assert!(said.err.contains(words), "{line}: no {words} in {said:?}");
    }
    // The output of another program is a file like others.
    let said = shell(&here, "cat r/config.toml | $F run --config /dev/stdin --out again -q");
    assert_eq!(said.code, Some(0), "{said:?}");
    assert_eq!(
        fs::read(here.join("again/config.toml")).expect("it"),
        fs::read(here.join("r/config.toml")).expect("it")
    );
}

#[cfg(target_os = "linux")]
#[test]
fn threads_that_cannot_be_made_are_an_error() {
    let here = scratch("too-many-threads");
    let said = shell(&here, "ulimit -v 2000000; $F run cart --generations 1 --threads 4096 --out t");
    assert_eq!(said.code, Some(1), "{said:?}");
    assert!(said.err.contains("cannot start thread ") && said.err.contains(" of 4096"), "{said:?}");
    assert!(!said.err.contains("panicked"), "{said:?}");
    ok(own(), &here, "run --resume t --generations 1 --threads 2 -q");
}

#[cfg(unix)]
#[test]
fn a_directory_left_by_a_process_of_the_same_number_is_in_nobodys_way() {
    let here = scratch("number");
    // The names that earlier versions gave, and a draft without its maker.
    let said = shell(&here, "mkdir .r.$$ .r.0123456789ab.new; exec $F run cart --generations 2 --out r -q");
    assert_eq!(said.code, Some(0), "{said:?}");
    assert!(here.join("r/champion.bin").is_file() && !here.join(".r.0123456789ab.new").exists());
}

#[cfg(unix)]
#[test]
fn a_link_named_like_a_temporary_file_is_nothing() {
    let here = scratch("temporary");
    ok(own(), &here, "run cart --generations 2 --out r -q");
    fs::write(here.join("victim"), "precious").expect("a file");
    for name in [".test.csv.new", ".test.json.new", ".champion.bin.new", "test.csv"] {
        std::os::unix::fs::symlink("../victim", here.join("r").join(name)).expect("a link");
    }
    ok(own(), &here, "test r --trials 3 -q");
    ok(own(), &here, "run --resume r --generations 4 -q");
    assert_eq!(fs::read_to_string(here.join("victim")).expect("it"), "precious");
    assert!(fs::read_to_string(here.join("r/test.csv")).expect("it").starts_with("index,trial,"));
}

#[test]
fn tests_of_one_run_at_the_same_time_leave_the_files_of_one() {
    let here = scratch("together");
    ok(own(), &here, "run cart --generations 2 --out r -q");
    for _ in 0..10 {
        let all: Vec<Child> = (1..4)
            .map(|seed: usize| {
                let words = format!("test r --trials {} --seed {seed} -q", 3 * seed);
                let words: Vec<&str> = words.split(' ').collect();
                command(own(), &here, &words).spawn().expect("the program")
            })
            .collect();
        for child in all {
            let said = Said::from(child.wait_with_output().expect("its end"));
            assert_eq!(said.code, Some(0), "{said:?}");
        }
        let record = fs::read_to_string(here.join("r/test.json")).expect("it");
        let record: serde_json::Value = serde_json::from_str(&record).expect("JSON");
        let table = fs::read_to_string(here.join("r/test.csv")).expect("it");
        assert_eq!(record["trials"].as_u64(), Some(table.lines().count() as u64 - 1), "{record}");
        assert_eq!(record["trials"].as_u64(), record["seed"].as_u64().map(|seed| 3 * seed), "{record}");
        let left: Vec<_> =
            fs::read_dir(here.join("r")).expect("it").map(|entry| entry.expect("it").file_name()).collect();
        assert!(!left.iter().any(|name| name.to_string_lossy().ends_with(".new")), "{left:?}");
    }
}
