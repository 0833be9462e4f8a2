//! Searches and records that are too large to be read.

use std::fs;
use std::sync::atomic::AtomicBool;

use super::ranks::{content, part, same};
use super::{Numbers, plan, pool, scratch};
use crate::evaluation::replay::{Selection, replay};
use crate::experiment::settings::Value;
use crate::ranks::threads::on_ranks;
use crate::run::begin::create;
use crate::run::evolve::continue_run;
use crate::strategy::settings::POPULATION;
use crate::strategy::strategies;

/// Genes that are to match numbers, by a strategy of this name.
fn numbers(name: &str) -> Numbers {
    let strategy = *strategies().iter().find(|strategy| strategy.name() == name).unwrap();
    Numbers { strategy, populations: 1 }
}

#[test]
fn a_run_ends_before_its_record_is_too_large_to_be_read() {
    let root = scratch("large-record");
    let numbers = numbers("random-search");
    let mut plan = plan(&numbers, 20);
    plan.limits.record_bytes = 1 << 19;
    plan.settings.set("", POPULATION, Value::Whole(10_000)).unwrap();
    let directory = create(&plan, &root.join("alone")).unwrap();
    let never = AtomicBool::new(false);
    let go = || continue_run(&plan, &directory, pool(&plan, 2), &never, "farsa", true).unwrap_err().to_string();
    let said = go();
    let expected = "record.bin: would have ";
    // All finished generations are saved and can be read.
    let found = content(directory.path());
    let generations = fs::read_to_string(directory.log()).unwrap().lines().count() - 1;
    assert!((3..20).contains(&generations), "{generations}");
    let end = format!(
        "more than the 524288 that are read of it; the run ends after {generations} generations, which are kept"
    );
    assert!(said.contains(expected) && said.ends_with(&end), "{said}");
    let last = Selection { generation: Some(generations as u32 - 1), ..Selection::default() };
    replay(&plan, &directory, last, None, || Ok(Vec::new())).unwrap();
    // Continuing ends at once and changes nothing.
    assert_eq!(go(), said);
    assert!(content(directory.path()) == found);
    // Other ranks do not wait for one that has ended.
    let place = root.join("ranks");
    let results = on_ranks(3, |ranks| part(ranks, &plan, &place, 1, &never));
    for (rank, result) in results.into_iter().enumerate() {
        match result {
            Ok(code) => assert!(rank > 0 && code == "1", "{rank}: {code}"),
            Err(error) => assert!(rank == 0 && error.to_string().contains(expected), "{rank}: {error}"),
        }
    }
    same(&place, directory.path());
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
            "`real-ga`: a state of 20000 individuals of 2 genes has 320004 bytes; a checkpoint keeps at most 262144",
        ),
        (
            "map-elites",
            "strategy.cells",
            10_000,
            "`strategy.cells`: 10000 cells of 2 genes, when full, are 520008 bytes; a checkpoint keeps at most 262144",
        ),
    ] {
        let numbers = numbers(name);
        let mut plan = plan(&numbers, 20);
        plan.limits.state_bytes = 1 << 18;
        plan.settings.set("", key, Value::Whole(value)).unwrap();
        let error = create(&plan, &root).map(|_| ()).unwrap_err();
        assert_eq!((error.to_string().as_str(), error.exit_code()), (why, 2));
        assert!(!root.exists());
        plan.settings.set("", key, Value::Whole(value / 2)).unwrap();
        create(&plan, &root).unwrap();
        fs::remove_dir_all(&root).unwrap();
    }
}
