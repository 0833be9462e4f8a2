//! How much memory a run takes.
#![cfg(target_os = "linux")]

use std::fs;
use std::thread::sleep;
use std::time::Duration;

use crate::tool::{command, farsa, scratch};

/// The most memory that a process has had at once \[kB\], by Linux; it never falls while the process lives.
fn peak(process: u32) -> Option<u64> {
    let status = fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?.trim().strip_suffix(" kB")?.parse().ok()
}

#[test]
fn a_run_of_the_main_experiment_stays_within_64_mib() {
    let directory = scratch("memory");
    let arguments = "run reach-grasp-lift --generations 3 --population 20 --threads 2 --out run --quiet";
    let arguments: Vec<&str> = arguments.split(' ').collect();
    let mut child = command(farsa(), &directory, &arguments).spawn().expect("the program");
    let mut most = 0;
    let ended = loop {
        most = most.max(peak(child.id()).unwrap_or(0));
        if let Some(ended) = child.try_wait().expect("a child") {
            break ended;
        }
        sleep(Duration::from_millis(2));
    };
    assert!(ended.success(), "{ended}");
    println!("at most {most} kB");
    // Two threads with eight worlds each take some megabytes; less was not looked at in time.
    assert!((4 << 10..64 << 10).contains(&most), "{most} kB");
}
