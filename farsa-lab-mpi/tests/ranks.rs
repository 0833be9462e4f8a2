//! Compares the files of `farsa-mpi` under `mpirun` with those of `farsa`, with killed ranks. `./ci mpi` runs it.
//!
//! `FARSA_KILLS` is the number of kills. `./ci long` sets it to a hundred.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use farsa_num::{Domain, Stream};

/// Experiments with short generations: a world in lanes, populations with opponents, and training.
const RUNS: [(&str, &str, u32); 4] = [
    ("discrimination", "--set trial.count=2 --set trial.steps=50", 40),
    ("predator-prey", "--population 6 --set evolution.parents=2 --set trial.count=2 --set trial.steps=40", 6),
    ("kinesthetic-grasp", "", 2),
    ("reach-grasp-lift", "--population 12 --set evolution.parents=2", 2),
];

/// The command of one process, which `./ci mpi` builds.
fn farsa(here: &Path, arguments: &str) -> Command {
    let beside = Path::new(env!("CARGO_BIN_EXE_farsa-mpi")).with_file_name("farsa");
    let program = std::env::var_os("FARSA").map_or(beside, PathBuf::from);
    assert!(program.is_file(), "{}: build `farsa` first, or name it in FARSA", program.display());
    let mut command = Command::new(program);
    command.args(arguments.split_whitespace());
    in_folder(command, here)
}

/// Runs ranks of `farsa-mpi`. More ranks follow after a colon, as in `mpirun`.
fn mpirun(here: &Path, ranks: usize, arguments: &str) -> Command {
    let mut command = Command::new("mpirun");
    command.args(["--oversubscribe", "--allow-run-as-root", "-n", &ranks.to_string()]);
    command.arg(env!("CARGO_BIN_EXE_farsa-mpi"));
    for word in arguments.split_whitespace() {
        match word {
            ":" => command.args([":", "-n", "1", env!("CARGO_BIN_EXE_farsa-mpi")]),
            word => command.arg(word),
        };
    }
    in_folder(command, here)
}

fn in_folder(mut command: Command, here: &Path) -> Command {
    command.current_dir(here).stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn succeed(mut command: Command) {
    let output = command.output().expect("a program");
    assert!(output.status.success(), "{command:?}: {}", said(&output));
}

fn scratch(name: &str) -> PathBuf {
    let here = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&here);
    fs::create_dir_all(&here).expect("a scratch directory");
    here
}

/// Refuses other content than that of a run, except for the manifest with its times.
fn same(found: &Path, expected: &Path) {
    let content = |run: &Path| -> BTreeMap<String, Vec<u8>> {
        let entries = fs::read_dir(run).expect("a run").map(|entry| entry.expect("an entry"));
        let names = entries.map(|entry| entry.file_name().into_string().expect("a name"));
        let names = names.filter(|name| name != "manifest.json");
        names.map(|name| (name.clone(), fs::read(run.join(name)).expect("a file"))).collect()
    };
    let (found, expected) = (content(found), content(expected));
    assert!(found.keys().eq(expected.keys()), "{:?} where {:?} are expected", found.keys(), expected.keys());
    for (name, bytes) in &expected {
        assert!(found[name] == *bytes, "{name} differs");
    }
    assert!(expected.len() > 5);
}

#[test]
fn ranks_make_the_files_of_one_process_also_when_their_number_changes() {
    let here = scratch("equal");
    for (name, options, generations) in RUNS {
        let start =
            |generations: u32, out: &str| format!("run {name} {options} --generations {generations} --out {out} -q");
        let whole = format!("{name}-1-thread");
        succeed(farsa(&here, &format!("{} --threads 1", start(generations, &whole))));
        let threads = format!("{name}-2-threads");
        succeed(farsa(&here, &format!("{} --threads 2", start(generations, &threads))));
        same(&here.join(&threads), &here.join(&whole));
        for ranks in [1, 2, 4] {
            let out = format!("{name}-{ranks}");
            succeed(mpirun(&here, ranks, &format!("{} --threads {}", start(generations, &out), 1 + ranks % 2)));
            same(&here.join(&out), &here.join(&whole));
        }
        let parts = format!("{name}-parts");
        succeed(mpirun(&here, 1, &start(1, &parts)));
        for (ranks, generations) in [(4, generations.div_ceil(2)), (2, generations)] {
            succeed(mpirun(&here, ranks, &format!("run --resume {parts} --generations {generations} -q")));
        }
        same(&here.join(&parts), &here.join(&whole));
    }
}

#[test]
fn ranks_may_have_other_instructions_and_lanes() {
    let here = scratch("mixed");
    let start = |out: &str| {
        format!("run reach-grasp-lift --population 12 --set evolution.parents=2 --generations 2 --out {out} -q")
    };
    succeed(farsa(&here, &start("whole")));
    let mixed = format!("{0} --simd auto : {0} --simd baseline --lanes 8 : {0} --lanes 1", start("mixed"));
    succeed(mpirun(&here, 1, &mixed));
    same(&here.join("mixed"), &here.join("whole"));
}

#[test]
fn replications_go_on_side_by_side() {
    let here = scratch("groups");
    let run = "run discrimination --set trial.count=2 --set trial.steps=50 --generations 20 --replications 5 --out";
    succeed(farsa(&here, &format!("{run} whole -q")));
    for (ranks, groups) in [(2, 2), (4, 2), (3, 3)] {
        let out = format!("on-{ranks}");
        let mut command = mpirun(&here, ranks, &format!("{run} {out} --groups {groups} --threads 1"));
        let output = command.output().expect("mpirun");
        assert!(output.status.success(), "{}", said(&output));
        let table = String::from_utf8_lossy(&output.stdout).into_owned();
        assert_eq!(table.lines().count(), 7, "{table}");
        for entry in fs::read_dir(here.join("whole")).expect("runs") {
            let name = entry.expect("an entry").file_name();
            same(&here.join(&out).join(&name), &here.join("whole").join(&name));
        }
    }
    let output = mpirun(&here, 2, &format!("{run} none --groups 3")).output().expect("mpirun");
    assert!(said(&output).contains("error: --groups 3: there are too few ranks"), "{}", said(&output));
    assert_eq!((output.status.code(), here.join("none").exists()), (Some(2), false));
}

#[test]
fn what_goes_wrong_is_said_once_and_ends_all() {
    let here = scratch("wrong");
    let once = |arguments: &str, code: i32, message: &str| {
        let begun = Instant::now();
        let output = mpirun(&here, 2, arguments).output().expect("mpirun");
        let said = said(&output);
        assert_eq!(output.status.code(), Some(code), "{arguments}: {said}");
        assert_eq!(said.matches("error: ").count(), 1, "{arguments}: {said}");
        assert!(said.contains(message), "{arguments}: {said}");
        assert!(begun.elapsed() < Duration::from_secs(60), "{arguments}");
    };
    let run = "run discrimination --generations 3 --out r -q";
    once(&format!("{run} : {run} --set trial.count=3"), 2, "rank 2: `trial.count` is 3 there and ");
    once(&format!("{run} : {run} --seed 9"), 2, "rank 2: `seed` is 9 there and 1 on rank 0");
    once(&format!("{run} : list"), 2, "rank 2: `command` is ");
    once(&format!("{run} : {run} --sed 9"), 2, "rank 2: unexpected argument '--sed' found");
    once("run discriminaton", 2, "unknown experiment `discriminaton`; the nearest is `discrimination`");
    once("run --resume nowhere", 2, "nowhere: there is no such directory");
    assert!(!here.join("r").exists());
    // A directory instead of a file that rank 0 replaces.
    succeed(mpirun(&here, 2, run));
    fs::remove_file(here.join("r/fitness.svg")).expect("a picture");
    fs::create_dir(here.join("r/fitness.svg")).expect("a directory");
    once("run --resume r --generations 5 -q", 1, "fitness.svg");
    // Rank 0 alone runs other verbs.
    let output = mpirun(&here, 3, "list").output().expect("mpirun");
    let list = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!((output.status.code(), list.matches("predator-prey").count()), (Some(0), 1), "{list}");
}

/// Returns the child processes of a process on Linux.
fn children(of: u32) -> Vec<u32> {
    let entries =
        fs::read_dir("/proc").expect("/proc").filter_map(|entry| entry.ok()?.file_name().to_str()?.parse().ok());
    let parent = |process: &u32| -> Option<u32> {
        let stat = fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
        stat.rsplit_once(") ")?.1.split_whitespace().nth(1)?.parse().ok()
    };
    entries.filter(|process| parent(process) == Some(of)).collect()
}

fn signal(name: &str, process: u32) {
    let _ = Command::new("kill").args([name, &process.to_string()]).stderr(Stdio::null()).status();
}

/// Returns whether `mpirun` ends after a rank is lost. Otherwise it is killed.
///
/// Open MPI 4 sometimes deadlocks when all its ranks are gone (its issue 7790). A rank that continues is another case.
fn ends(mpirun: &mut Child) -> bool {
    let begun = Instant::now();
    while begun.elapsed() < Duration::from_secs(30) {
        if mpirun.try_wait().expect("its state").is_some() {
            return true;
        }
        thread::sleep(Duration::from_millis(20));
    }
    let alive = |process: &u32| {
        let stat = fs::read_to_string(format!("/proc/{process}/stat")).unwrap_or_default();
        stat.rsplit_once(") ").is_some_and(|(_, state)| !state.starts_with('Z'))
    };
    let ranks: Vec<u32> = children(mpirun.id()).into_iter().filter(alive).collect();
    signal("-KILL", mpirun.id());
    assert!(ranks.is_empty(), "{} ranks went on for half a minute after one was lost", ranks.len());
    false
}

/// Starts three ranks that continue the run `r`, and waits until they have finished generations together. They are in the order
/// of their numbers.
fn go_on(here: &Path) -> (Child, Vec<u32>) {
    let saved = || fs::metadata(here.join("r/fitness.csv")).expect("the log").len();
    let (before, begun) = (saved(), Instant::now());
    let child = mpirun(here, 3, "run --resume r --generations 4000000 -q").spawn().expect("mpirun");
    while saved() == before {
        assert!(begun.elapsed() < Duration::from_secs(60), "no generation in a minute");
        thread::sleep(Duration::from_millis(20));
    }
    let mut ranks = children(child.id());
    ranks.sort_unstable();
    assert_eq!(ranks.len(), 3);
    (child, ranks)
}

#[test]
fn a_rank_that_is_told_to_stop_stops_all() {
    let here = scratch("stop");
    let run = "discrimination --set trial.count=2 --set trial.steps=50";
    succeed(farsa(&here, &format!("run {run} --generations 1 --out r -q")));
    for told in 0..3 {
        let (child, ranks) = go_on(&here);
        signal("-TERM", ranks[told]);
        let output = child.wait_with_output().expect("its end");
        assert_eq!(output.status.code(), Some(130), "{}", said(&output));
        assert_eq!(said(&output).matches("interrupted; go on with ").count(), 1, "{}", said(&output));
    }
}

#[test]
fn a_lost_rank_ends_all_and_is_named() {
    let here = scratch("lost");
    let run = "run discrimination --set trial.count=2 --set trial.steps=50";
    succeed(farsa(&here, &format!("{run} --generations 1 --out r -q")));
    for lost in 0..3 {
        let (child, ranks) = go_on(&here);
        signal("-KILL", ranks[lost]);
        let output = child.wait_with_output().expect("its end");
        let said = said(&output).split_whitespace().collect::<Vec<_>>().join(" ");
        // The number of the process, or 0.
        assert!(said.contains(&format!("process rank {lost} with PID ")), "{said}");
        assert!(said.contains("exited on signal 9"), "{said}");
        assert_eq!(output.status.code(), Some(128 + 9), "{said}");
    }
    // The saved files are complete.
    let end = fs::read_to_string(here.join("r/fitness.csv")).expect("the log").lines().count() + 5;
    succeed(mpirun(&here, 2, &format!("run --resume r --generations {end} -q")));
    succeed(farsa(&here, &format!("{run} --generations {end} --out whole -q")));
    same(&here.join("r"), &here.join("whole"));
}

/// Runs one rank on a full disk and others with space. No file of the former grows beyond some blocks of 512 bytes. Messages use
/// sockets, because shared memory is a file, too.
fn with_a_full_disk(here: &Path, full: usize, blocks: u32, arguments: &str) -> Command {
    let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" {arguments}");
    let mut command = Command::new("mpirun");
    command.args(["--oversubscribe", "--allow-run-as-root", "--mca", "btl", "self,tcp"]);
    for rank in 0..3 {
        command.args(if rank == 0 { &["-n", "1"][..] } else { &[":", "-n", "1"] });
        if rank == full {
            command.args(["sh", "-c", &script]);
        }
        command.arg(env!("CARGO_BIN_EXE_farsa-mpi"));
        if rank != full {
            command.args(arguments.split_whitespace());
        }
    }
    in_folder(command, here)
}

#[test]
fn a_full_disk_of_one_rank_loses_nothing() {
    let here = scratch("full");
    let run = "run discrimination --set trial.count=2 --set trial.steps=50";
    let resume = "run --resume r --generations 400 -q";
    succeed(farsa(&here, &format!("{run} --generations 400 --out whole -q")));
    succeed(mpirun(&here, 2, &format!("{run} --generations 4 --out r -q")));
    let file = |name: &str| fs::read(here.join("r").join(name)).expect("a file");
    let before = ["champion.bin", "checkpoint.bin", "record.bin", "fitness.csv"].map(|name| (name, file(name)));
    // At first not even the configuration can be written, then some generations can.
    for (blocks, cannot) in [(0, "r/config.toml: File too large (os error 27)"), (8, "r/")] {
        let output = with_a_full_disk(&here, 0, blocks, resume).output().expect("mpirun");
        let said = said(&output);
        assert_eq!((output.status.code(), said.matches("error: ").count()), (Some(1), 1), "{said}");
        assert!(said.contains(&format!("error: cannot write {cannot}")), "{said}");
        assert!(said.contains(": File too large (os error 27)"), "{said}");
        for (name, content) in &before {
            let (found, grows) = (file(name), ["record.bin", "fitness.csv"].contains(name));
            // A slow machine saves once before the disk is full.
            assert!(if grows { found.starts_with(content) } else { blocks > 0 || found == *content }, "{name}");
        }
        assert_eq!(file("record.bin").len() > before[2].1.len(), blocks > 0, "it should come some way");
    }
    // Only rank 0 needs space. With space the run continues as usual.
    succeed(with_a_full_disk(&here, 1, 0, resume));
    same(&here.join("r"), &here.join("whole"));
}

#[test]
fn a_run_whose_ranks_are_killed_again_and_again_is_the_run_that_was_not() {
    let kills = std::env::var("FARSA_KILLS").ok().map_or(10, |kills| kills.parse().expect("FARSA_KILLS is a number"));
    let here = scratch("kills");
    let run = "discrimination --set trial.count=2 --set trial.steps=50";
    let mut stream = Stream::new(20_261_123, Domain::General, 0, 0, 0);
    let mut hung = 0;
    for kill in 0..kills {
        let arguments = if here.join("r").exists() { "run --resume r" } else { "run" };
        let arguments = match arguments {
            "run" => format!("run {run} --generations 4000000 --out r -q"),
            resume => format!("{resume} -q"),
        };
        let size = 2 + kill % 3;
        let mut child = mpirun(&here, size, &arguments).spawn().expect("mpirun");
        // Most kills are at the start and at the first save, after a second.
        let seconds = if stream.uniform_f64() < 0.4 { 0.6 * stream.uniform_f64() } else { 1.0 + stream.uniform_f64() };
        thread::sleep(Duration::from_secs_f64(seconds));
        let ranks = children(child.id());
        let which = (stream.uniform_f64() * ranks.len() as f64) as usize;
        signal("-KILL", ranks.get(which).copied().unwrap_or(child.id()));
        hung += usize::from(!ends(&mut child));
        let output = child.wait_with_output().expect("its end");
        assert!(!output.status.success(), "kill {kill}: it ended by itself");
    }
    assert!(10 * hung <= kills.max(10), "{hung} of {kills} launchers hung without a rank");
    // At least one rank was killed after its first save.
    let log = fs::read_to_string(here.join("r/fitness.csv")).expect("the log");
    let end = log.lines().count() + 20;
    // A rank that has lost its launcher may hold the run a moment longer.
    let resumed = (0..100).find_map(|_| {
        thread::sleep(Duration::from_millis(100));
        let output = mpirun(&here, 3, &format!("run --resume r --generations {end} -q")).output().expect("mpirun");
        (!said(&output).contains("another process is at this run")).then_some(output)
    });
    let resumed = resumed.expect("a run that no process holds");
    assert!(resumed.status.success(), "{}", said(&resumed));
    succeed(farsa(&here, &format!("run {run} --generations {end} --out whole -q")));
    same(&here.join("r"), &here.join("whole"));
    println!("{kills} kills, {end} generations, all files the same; {hung} launchers hung");
}
