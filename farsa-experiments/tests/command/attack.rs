//! Results of an attack, end to end: hostile files, processes at the same time, signals, and refusals of the system.

use std::fs;
use std::path::Path;
#[cfg(unix)]
use std::process::Command;

#[cfg(unix)]
use crate::tool::interruptible;
use crate::tool::{Running, Said, command, ok, own, scratch};

/// Runs a line of a shell.
fn shell(here: &Path, line: &str) -> Said {
    let mut shell = command(Path::new("sh"), here, &["-c", line]);
    Running::start(shell.env("F", own())).end()
}

/// A run that continues until it is stopped, once it has finished some generations.
#[cfg(unix)]
fn begun(here: &Path, start: &mut Command) -> Running {
    let mut run = Running::start(start);
    run.until("generation 5", || generations(here) > 5);
    run
}

#[cfg(unix)]
fn generations(here: &Path) -> usize {
    fs::read_to_string(here.join("r/fitness.csv")).map_or(0, |log| log.lines().count().saturating_sub(1))
}

#[cfg(unix)]
const ENDLESS: [&str; 8] = ["run", "cart", "--generations", "4000000", "--out", "r", "--threads", "1"];

#[cfg(unix)]
#[test]
fn signals_end_a_run_as_ctrl_c_does() {
    for (name, scheduler, code) in [("INT", "", 130), ("TERM", "", 130), ("HUP", "", 130), ("TERM", "42", 75)] {
        let here = scratch(&format!("signals-{name}{scheduler}"));
        let mut start = interruptible(own(), &here, &ENDLESS);
        if !scheduler.is_empty() {
            start.env("SLURM_JOB_ID", scheduler);
        }
        let run = begun(&here, &mut start);
        run.signal(name);
        let said = run.end();
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
    let mut run = begun(&here, interruptible(Path::new("nohup"), &here, &[own()]).args(ENDLESS));
    run.signal("HUP");
    let before = generations(&here);
    run.until("more generations", || generations(&here) >= before + 50);
    run.signal("TERM");
    let said = run.end();
    assert_eq!(said.code, Some(130), "{said:?}");
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
        let all: Vec<Running> = (1..4)
            .map(|seed: usize| {
                let words = format!("test r --trials {} --seed {seed} -q", 3 * seed);
                let words: Vec<&str> = words.split(' ').collect();
                Running::start(&mut command(own(), &here, &words))
            })
            .collect();
        for child in all {
            let said = child.end();
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
