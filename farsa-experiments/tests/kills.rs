//! Runs that are killed again and again, at any moment, come to the bytes of a run that was not.
//!
//! `FARSA_KILLS` is the number of kills. `./ci long` sets a thousand.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::thread;
use std::time::Duration;

use farsa_num::{Domain, Stream};

/// Experiments with what makes their generations short, of one population and of two.
const RUNS: [(&str, &str); 3] = [
    ("discrimination", "--set trial.count=2 --set trial.steps=50"),
    ("foraging", "--population 10 --set evolution.parents=2 --set trial.count=1 --set trial.steps=30"),
    ("predator-prey", "--population 6 --set evolution.parents=2 --set trial.count=2 --set trial.steps=40"),
];

fn farsa(here: &Path, arguments: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_farsa"));
    command.args(arguments.split_whitespace()).current_dir(here).stdin(Stdio::null());
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// The names of all files and directories in a directory, hidden ones too.
fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).into_iter().flatten();
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("an entry").file_name().into_string().expect("a name")).collect();
    names.sort();
    names
}

/// The content of a run without the manifest, which has the times of its sessions.
fn content(run: &Path) -> BTreeMap<String, Vec<u8>> {
    let names = names(run).into_iter().filter(|name| name != "manifest.json");
    names.map(|name| (name.clone(), fs::read(run.join(name)).expect("a file"))).collect()
}

/// When to kill: often while a process begins and while it saves for the first time, which is after a second.
fn delay(stream: &mut Stream) -> Duration {
    let (kind, x) = (stream.uniform_f64(), stream.uniform_f64());
    let seconds = if kind < 0.55 {
        0.06 * x
    } else if kind < 0.85 {
        1.0 + 0.25 * x
    } else {
        1.3 * x
    };
    Duration::from_secs_f64(seconds)
}

/// The finished generations, as a reader of the run sees them, or `None` before the first one.
fn finished(here: &Path) -> Option<u32> {
    let _ = fs::remove_file(here.join("page.html"));
    let output = farsa(here, "report r --json --html page.html").output().expect("the program");
    let _ = fs::remove_file(here.join("page.html"));
    if !output.status.success() {
        let said = said(&output);
        let early = said.contains("no generation is finished yet") || said.contains("there is no such directory");
        assert!(early, "a reader of a run that was killed: {said}");
        return None;
    }
    let summary: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    Some(u32::try_from(summary["runs"][0]["generations"].as_u64().expect("generations")).expect("a number"))
}

fn killed_again_and_again(here: &Path, (name, options): (&str, &str), kills: u32, own: u32) {
    let _ = fs::remove_dir_all(here);
    fs::create_dir_all(here).expect("a scratch directory");
    let mut stream = Stream::new(20_261_123, Domain::General, own, 0, 0);
    let start = format!("run {name} {options} --generations 4000000 --threads 1 --out r -q");
    let mut latest = 0;
    for kill in 0..kills {
        // The next start continues from any state. Only a missing directory is made.
        let arguments = if here.join("r").exists() { "run --resume r --threads 1 -q" } else { &start };
        let mut child = farsa(here, arguments).spawn().expect("the program");
        thread::sleep(delay(&mut stream));
        child.kill().expect("SIGKILL");
        let output = child.wait_with_output().expect("its end");
        assert_eq!(output.status.code(), None, "{name}, kill {kill}: it ended by itself: {}", said(&output));
        if kill % 5 == 0 {
            let now = finished(here).unwrap_or(0);
            assert!(now >= latest, "{name}, kill {kill}: {now} generations are left of {latest}");
            latest = now;
        }
    }
    let last = latest + 20;
    let end = if here.join("r").exists() {
        // The number of generations may have been passed by then.
        let end = finished(here).unwrap_or(0).max(last);
        let output = farsa(here, &format!("run --resume r --generations {end} -q")).output().expect("the program");
        assert!(output.status.success(), "{name}: {}", said(&output));
        end
    } else {
        let output = farsa(here, &format!("run {name} {options} --generations {last} --out r -q"))
            .output()
            .expect("the program");
        assert!(output.status.success(), "{name}: {}", said(&output));
        last
    };
    let whole = format!("run {name} {options} --generations {end} --out whole -q");
    let output = farsa(here, &whole).output().expect("the program");
    assert!(output.status.success(), "{name}: {}", said(&output));
    assert_eq!(names(here), ["r", "whole"], "{name}: what a killed process left beside the run");
    let (killed, whole) = (content(&here.join("r")), content(&here.join("whole")));
    assert_eq!(killed.keys().collect::<Vec<_>>(), whole.keys().collect::<Vec<_>>(), "{name}");
    for (file, bytes) in &whole {
        assert!(killed[file] == *bytes, "{name}: {file} differs after {kills} kills and {end} generations");
    }
    println!("{name}: {kills} kills, {end} generations, {} files the same", whole.len());
}

#[test]
fn a_run_that_is_killed_again_and_again_is_the_run_that_was_not() {
    let kills = std::env::var("FARSA_KILLS").ok().map_or(60, |kills| kills.parse().expect("FARSA_KILLS is a number"));
    let root = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("kills");
    thread::scope(|scope| {
        for (own, run) in (0..).zip(RUNS) {
            let here = root.join(run.0);
            scope.spawn(move || killed_again_and_again(&here, run, kills / 3, own));
        }
    });
}
