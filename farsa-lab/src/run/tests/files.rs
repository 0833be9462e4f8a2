//! What is refused, and what is mended.

use std::fs;
use std::sync::atomic::AtomicBool;

use crate::evaluation::replay::{Which, replay};
use crate::evaluation::test;
use crate::experiment::lanes::Wanted;
use crate::experiment::settings::Value;
use crate::run::begin::create;
use crate::run::evolve::go_on;
use crate::run::tests::{CHASE, Numbers, STEADY, plan, pool, run, scratch};
use crate::store::directory::Directory;
use crate::strategy::Truncation;

#[test]
fn a_run_knows_the_files_that_it_was_made_with() {
    let root = scratch("files");
    fs::create_dir_all(&root).unwrap();
    let file = root.join("numbers \"one\".txt");
    let plan = |generations| {
        let mut plan = plan(&STEADY, generations);
        plan.settings.set("", "numbers.file", Value::Word(file.display().to_string())).unwrap();
        plan
    };
    let refused = |words: &str| {
        let (five, directory) = (plan(5), Directory::open(&root.join("run")).unwrap());
        let errors = [
            go_on(&five, &directory, pool(&five, 1), &AtomicBool::new(false), "farsa", true).unwrap_err(),
            replay(&five, &directory, Which::default(), &mut Vec::new()).unwrap_err(),
            test::test(&five, &directory, 1, 1, 1, Wanted::ONE, true).unwrap_err(),
        ];
        for error in errors.map(|error| error.to_string()) {
            assert!(error.contains(words) && error.contains("numbers \"one\".txt"), "{error}");
        }
    };
    assert!(create(&plan(3), &root.join("run")).is_err() && !root.join("run").exists());
    fs::write(&file, "1 2 3").unwrap();
    let directory = create(&plan(3), &root.join("run")).unwrap();
    run(&plan(3), &directory, 1);
    assert!(fs::read_to_string(directory.manifest()).unwrap().contains("\"files\""));
    fs::write(&file, "1 2 4").unwrap();
    refused("is another file than the run in ");
    fs::remove_file(&file).unwrap();
    refused("cannot read ");
    fs::write(&file, "1 2 3").unwrap();
    run(&plan(5), &directory, 1);
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn a_lineage_that_was_cut_is_written_again() {
    let root = scratch("cut");
    let directory = create(&plan(&STEADY, 5), &root).unwrap();
    run(&plan(&STEADY, 5), &directory, 1);
    let whole = fs::read_to_string(directory.lineage()).unwrap();
    for cut in [Some(40), None] {
        match cut {
            Some(bytes) => fs::write(directory.lineage(), &whole[..bytes]).unwrap(),
            None => fs::remove_file(directory.lineage()).unwrap(),
        }
        go_on(&plan(&STEADY, 5), &directory, pool(&plan(&STEADY, 5), 1), &AtomicBool::new(false), "farsa", true)
            .unwrap();
        assert_eq!(fs::read_to_string(directory.lineage()).unwrap(), whole);
    }
    // What a killed process has written beyond its checkpoint goes.
    fs::write(directory.lineage(), format!("{whole}6,0,1\n")).unwrap();
    run(&plan(&STEADY, 6), &directory, 1);
    let longer = fs::read_to_string(directory.lineage()).unwrap();
    assert!(longer.starts_with(&whole) && longer.lines().count() == 13, "{longer}");
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn a_run_of_an_earlier_version_is_refused_by_name() {
    let root = scratch("earlier");
    let directory = create(&plan(&STEADY, 2), &root).unwrap();
    run(&plan(&STEADY, 2), &directory, 1);
    fs::rename(directory.record(), directory.earlier_lineage()).unwrap();
    let plan = plan(&STEADY, 4);
    let resumed = go_on(&plan, &directory, pool(&plan, 1), &AtomicBool::new(false), "farsa", true).unwrap_err();
    let replayed = replay(&plan, &directory, Which::default(), &mut Vec::new()).unwrap_err();
    for error in [resumed, replayed] {
        let said = error.to_string();
        assert!(said.contains("has a lineage.bin of an earlier version") && said.contains("run --config "), "{said}");
    }
    assert!(test::test(&plan, &directory, 1, 1, 1, Wanted::ONE, true).is_ok(), "its champion is still read");
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn a_record_shorter_than_its_checkpoint_is_refused() {
    let root = scratch("short");
    let directory = create(&plan(&STEADY, 2), &root).unwrap();
    let short = fs::read(directory.record()).unwrap();
    run(&plan(&STEADY, 2), &directory, 1);
    fs::write(directory.record(), short).unwrap();
    let plan = plan(&STEADY, 4);
    let said = go_on(&plan, &directory, pool(&plan, 1), &AtomicBool::new(false), "farsa", true).unwrap_err();
    assert!(said.to_string().contains("record.bin: 0 generations where checkpoint.bin speaks of 2"), "{said}");
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn the_strategy_of_a_run_stays_what_it_was() {
    let root = scratch("other");
    let steady = create(&plan(&STEADY, 3), &root.join("steady")).unwrap();
    run(&plan(&STEADY, 3), &steady, 1);
    // The same experiment, by name, with another strategy or more populations.
    for other in [Numbers { strategy: &Truncation, populations: 1 }, CHASE] {
        let mut plan = plan(&other, 5);
        plan.settings.set("", "evolution.mutation", Value::Word("flip".into())).unwrap();
        let error = go_on(&plan, &steady, pool(&plan, 1), &AtomicBool::new(false), "farsa", true).unwrap_err();
        assert!(error.to_string().contains("record.bin: was made by the strategy `one-plus-one`"), "{error}");
    }
    let steady_populations = Numbers { populations: 2, ..STEADY };
    let error = create(&plan(&steady_populations, 3), &root.join("none")).unwrap_err();
    assert!(error.to_string().contains("numbers: one parent and one mutant of 2 populations"), "{error}");
    assert!(!root.join("none").exists());
    let mut rising = plan(&STEADY, 3);
    rising.settings.set("", "evolution.last_rate", Value::Number(0.75)).unwrap();
    let error = create(&rising, &root.join("none")).unwrap_err().to_string();
    assert_eq!(error, "`evolution.last_rate`: a mutation rate cannot fall from 0.5 to 0.75");
    fs::remove_dir_all(root).unwrap();
}
