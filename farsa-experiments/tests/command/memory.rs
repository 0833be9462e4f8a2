//! Memory of a run.
#![cfg(target_os = "linux")]

use std::fs;
use std::path::Path;
use std::thread::sleep;
use std::time::Duration;

use crate::tool::{Deadline, command, farsa, scratch};

/// The peak memory of a process \[kB\], by Linux. It never falls during the process.
pub(crate) fn peak(process: u32) -> Option<u64> {
    let status = fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?.trim().strip_suffix(" kB")?.parse().ok()
}

/// The most memory of a run in a folder \[kB\].
fn most(directory: &Path, arguments: &str) -> u64 {
    let arguments: Vec<&str> = arguments.split(' ').collect();
    let mut child = command(farsa(), directory, &arguments).spawn().expect("the program");
    let _deadline = Deadline::new(child.id());
    let mut most = 0;
    let ended = loop {
        most = most.max(peak(child.id()).unwrap_or(0));
        if let Some(ended) = child.try_wait().expect("a child") {
            break ended;
        }
        sleep(Duration::from_millis(2));
    };
    assert!(ended.success(), "{ended}");
    println!("{arguments:?}: at most {most} kB");
    most
}

#[test]
fn many_generations_take_no_more_memory_than_few() {
    let directory = scratch("generations");
    for (strategy, generations) in [("one-plus-one", 15_000), ("cma-es", 7000), ("map-elites", 3000)] {
        let run = |generations: u32| {
            let settings = "--set trial.count=1 --set trial.steps=1 --threads 1 --quiet --force --out run";
            let more = format!("--strategy {strategy} --generations {generations}");
            most(&directory, &format!("run discrimination {settings} {more}"))
        };
        let [few, many] = [1500, generations].map(run);
        // A hundred bytes of each generation would be 1300 kB with the first.
        assert!(many < few + 1000, "{strategy}: {few} and {many} kB");
    }
}

#[test]
fn a_run_of_the_main_experiment_stays_within_64_mib() {
    let directory = scratch("memory");
    let arguments = "run reach-grasp-lift --generations 3 --population 20 --threads 2 --out run --quiet";
    let most = most(&directory, arguments);
    // Two threads with eight worlds each take some megabytes. A smaller peak was not seen in time.
    assert!((4 << 10..64 << 10).contains(&most), "{most} kB");
}
