//! Embedded experiments keep the bits that they had as programs: the logs of small runs in expected.txt.
#![cfg(feature = "rapier")]
#![allow(missing_docs, clippy::unwrap_used)]

use std::path::Path;
use std::process::Command;

#[test]
fn runs_of_embedded_experiments_keep_their_logs() {
    let here = Path::new(env!("CARGO_TARGET_TMPDIR")).join("embedded");
    let _ = std::fs::remove_dir_all(&here);
    std::fs::create_dir_all(&here).unwrap();
    let (mut runs, mut expected, mut logs) = (0, Vec::new(), Vec::new());
    for line in include_str!("expected.txt").lines() {
        if line.starts_with(|c: char| c.is_ascii_digit()) {
            expected.push(line.to_owned());
            continue;
        }
        assert_eq!(logs, expected, "before {line}");
        (expected, logs) = (Vec::new(), log(&here, line));
        runs += 1;
    }
    assert_eq!(logs, expected);
    assert_eq!(runs, 33);
}

/// The lines of a run's log, without the head.
fn log(here: &Path, run: &str) -> Vec<String> {
    let out = here.join("run");
    let mut command = Command::new(env!("CARGO_BIN_EXE_farsa"));
    command.arg("run").args(run.split(' ')).args(["--seed", "3", "--quiet", "--out"]).arg(&out);
    let output = command.output().unwrap();
    assert!(output.status.success(), "{run}: {}", String::from_utf8_lossy(&output.stderr));
    let log = std::fs::read_to_string(out.join("fitness.csv")).unwrap();
    std::fs::remove_dir_all(out).unwrap();
    log.lines().skip(1).map(str::to_owned).collect()
}
