//! Searches and records that are too large to be read.

use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use crate::error::Error;
use crate::evaluation::replay::{Which, replay};
use crate::experiment::settings::Value;
use crate::run::begin::create;
use crate::run::evolve::go_on;
use crate::run::plan::Plan;
use crate::run::tests::{Numbers, pool, scratch};
use crate::store::directory::Directory;
use crate::strategy::settings::{GENERATIONS, POPULATION};
use crate::strategy::strategies;
use crate::strategy::truncation::Truncation;

const NUMBERS: Numbers = Numbers { strategy: &Truncation, populations: 1 };

/// A search for twenty generations by a strategy with one setting more.
fn plan(name: &str, key: &str, value: i64) -> Plan<'static> {
    let strategy = strategies().iter().copied().find(|strategy| strategy.name() == name);
    let mut plan = Plan::with_strategy(&NUMBERS, None, "", strategy).unwrap();
    plan.settings.set("", GENERATIONS, Value::Whole(20)).unwrap();
    plan.settings.set("", key, Value::Whole(value)).unwrap();
    plan
}

fn go(plan: &Plan<'_>, directory: &Directory) -> Result<(), Error> {
    go_on(plan, directory, pool(plan, 2), &AtomicBool::new(false), "farsa", true).map(drop)
}

/// The files of a run but for the manifest, in the order of their names.
fn files(root: &Path) -> Vec<(String, Vec<u8>)> {
    let entries = fs::read_dir(root).unwrap().map(|entry| entry.unwrap());
    let mut files: Vec<_> = entries
        .map(|entry| (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap()))
        .filter(|(name, _)| name != "manifest.json")
        .collect();
    files.sort();
    files
}

#[test]
fn a_run_ends_before_its_record_is_too_large_to_be_read() {
    let root = scratch("large-record");
    let plan = plan("random-search", POPULATION, 10_000);
    let directory = create(&plan, &root).unwrap();
    let said = go(&plan, &directory).unwrap_err().to_string();
    assert!(
        said.contains("record.bin: would have ") && said.ends_with("more than the 524288 that are read of it"),
        "{said}"
    );
    // All that was finished is kept, and can be looked at.
    let found = files(&root);
    let generations = fs::read_to_string(directory.log()).unwrap().lines().count() - 1;
    assert!((3..20).contains(&generations), "{generations}");
    let last = Which { generation: Some(generations as u32 - 1), ..Which::default() };
    replay(&plan, &directory, last, None, || Ok(Vec::new())).unwrap();
    // To go on is to end at once, and changes nothing.
    assert_eq!(go(&plan, &directory).unwrap_err().to_string(), said);
    assert!(files(&root) == found);
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn a_search_whose_state_would_not_be_read_is_not_begun() {
    let root = scratch("large-state");
    for (name, key, value, why) in [
        (
            "real-ga",
            POPULATION,
            20_000,
            "20000 individuals of 2 genes: a state of `real-ga` has 320004 bytes; a checkpoint keeps at most 262144",
        ),
        (
            "map-elites",
            "strategy.cells",
            10_000,
            "10000 cells of 2 genes: a full archive has 320000 bytes; a checkpoint keeps at most 262144",
        ),
    ] {
        let said = create(&plan(name, key, value), &root).map(|_| ()).unwrap_err().to_string();
        assert!(said.starts_with(&format!("`{key}`: ")) && said.ends_with(why), "{said}");
        assert!(!root.exists());
        create(&plan(name, key, value / 2), &root).unwrap();
        fs::remove_dir_all(&root).unwrap();
    }
}
