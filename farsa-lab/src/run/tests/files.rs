//! Refused files, and repaired ones.

use std::fs;
use std::sync::atomic::AtomicBool;

use crate::evaluation::replay::{Selection, replay};
use crate::evaluation::test;
use crate::experiment::lanes::LaneRequest;
use crate::experiment::settings::Value;
use crate::run::begin::create;
use crate::run::evolve::continue_run;
use crate::run::tests::{CHASE, LEARNER, Numbers, STEADY, plan, pool, run, scratch};
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
            continue_run(&five, &directory, pool(&five, 1), &AtomicBool::new(false), "farsa", true).unwrap_err(),
            replay(&five, &directory, Selection::default(), None, || Ok(Vec::new())).unwrap_err(),
            test::test(&five, &directory, None, 1, 1, 1, LaneRequest::ONE, true).unwrap_err(),
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
        continue_run(&plan(&STEADY, 5), &directory, pool(&plan(&STEADY, 5), 1), &AtomicBool::new(false), "farsa", true)
            .unwrap();
        assert_eq!(fs::read_to_string(directory.lineage()).unwrap(), whole);
    }
    // Entries after the checkpoint, written by a killed process, are removed.
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
    let resumed = continue_run(&plan, &directory, pool(&plan, 1), &AtomicBool::new(false), "farsa", true).unwrap_err();
    let replayed = replay(&plan, &directory, Selection::default(), None, || Ok(Vec::new())).unwrap_err();
    for error in [resumed, replayed] {
        let said = error.to_string();
        assert!(said.contains("has a lineage.bin of an earlier version") && said.contains("run --config "), "{said}");
    }
    assert!(test::test(&plan, &directory, None, 1, 1, 1, LaneRequest::ONE, true).is_ok(), "its champion is still read");
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
    let said = continue_run(&plan, &directory, pool(&plan, 1), &AtomicBool::new(false), "farsa", true).unwrap_err();
    assert!(said.to_string().contains("record.bin: truncated: "), "{said}");
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
        let error = continue_run(&plan, &steady, pool(&plan, 1), &AtomicBool::new(false), "farsa", true).unwrap_err();
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

/// The files of a run with their content, except for times.
fn contents(directory: &Directory) -> Vec<(String, Vec<u8>)> {
    let entries = fs::read_dir(directory.path()).unwrap().map(|entry| entry.unwrap());
    let named = entries.map(|entry| (entry.file_name().into_string().unwrap(), entry.path()));
    let mut all: Vec<_> = named.map(|(name, path)| (name, fs::read(path).unwrap())).collect();
    all.retain(|(name, _)| name != "manifest.json");
    all.sort();
    all
}

#[test]
fn what_is_lost_is_written_again() {
    let root = scratch("lost");
    let [whole, other] = ["whole", "other"].map(|name| create(&plan(&STEADY, 5), &root.join(name)).unwrap());
    run(&plan(&STEADY, 8), &whole, 1);
    run(&plan(&STEADY, 5), &other, 1);
    for lost in [other.log(), other.manifest(), other.plot(), other.lineage()] {
        fs::remove_file(lost).unwrap();
    }
    // Continuing a finished run restores all files.
    run(&plan(&STEADY, 5), &other, 1);
    assert_eq!(contents(&other).len(), contents(&whole).len());
    let text = fs::read_to_string(other.log()).unwrap();
    fs::write(other.log(), text.replace('\n', "\r\n")).unwrap();
    run(&plan(&STEADY, 8), &other, 1);
    assert_eq!(contents(&other), contents(&whole));
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn champions_of_a_generation_that_was_not_saved_are_forgotten() {
    let root = scratch("between");
    for (name, numbers) in [("steady", STEADY), ("learner", LEARNER), ("chase", CHASE)] {
        let [five, eight] = [5, 8].map(|generations| {
            let plan = plan(&numbers, generations);
            let directory = create(&plan, &root.join(format!("{name}-{generations}"))).unwrap();
            run(&plan, &directory, 1);
            directory
        });
        let whole = fs::read(five.champion()).unwrap();
        assert_ne!(fs::read(eight.champion()).unwrap(), whole, "{name}");
        // The state after a kill between the two files.
        fs::copy(eight.champion(), five.champion()).unwrap();
        let said = run(&plan(&numbers, 5), &five, 1);
        assert!(said.contains("all 5 generations are finished already"), "{name}: {said}");
        assert!(fs::read(five.champion()).unwrap() == whole, "{name}");
        fs::remove_file(five.champion()).unwrap();
        run(&plan(&numbers, 5), &five, 1);
        assert!(fs::read(five.champion()).unwrap() == whole, "{name}: one that is gone is written again");
    }
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn a_manifest_of_another_format_is_refused_and_kept() {
    let root = scratch("format");
    let directory = create(&plan(&STEADY, 2), &root).unwrap();
    let text = fs::read_to_string(directory.manifest()).unwrap();
    for (from, to, words) in
        [("\"format\": 1", "\"format\": 2", "has format 2, this program reads format 1"), ("{", "", "manifest.json: ")]
    {
        let changed = text.replacen(from, to, 1);
        assert_ne!(changed, text);
        fs::write(directory.manifest(), &changed).unwrap();
        let plan = plan(&STEADY, 2);
        let error =
            continue_run(&plan, &directory, pool(&plan, 1), &AtomicBool::new(false), "farsa", true).unwrap_err();
        assert!(error.to_string().contains(words), "{error}");
        assert_eq!(fs::read_to_string(directory.manifest()).unwrap(), changed);
    }
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn a_log_that_disappears_is_noticed_at_once() {
    let root = scratch("removed");
    let directory = create(&plan(&STEADY, 1), &root).unwrap();
    let endless = plan(&STEADY, i64::from(u32::MAX) - 1);
    let log = directory.log();
    let removed = std::thread::spawn(move || {
        while fs::read_to_string(&log).unwrap().lines().count() < 20 {}
        fs::remove_file(log).unwrap();
    });
    let error =
        continue_run(&endless, &directory, pool(&endless, 1), &AtomicBool::new(false), "farsa", true).unwrap_err();
    removed.join().unwrap();
    assert!(error.to_string().contains("fitness.csv: was removed during the run"), "{error}");
    // The saved generations are continued.
    let error =
        continue_run(&endless, &directory, pool(&endless, 1), &AtomicBool::new(true), "farsa", true).unwrap_err();
    assert!(error.to_string().contains("interrupted") && directory.log().is_file(), "{error}");
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn a_checkpoint_does_not_grow_and_a_record_grows_by_what_is_new() {
    let root = scratch("growth");
    let directory = create(&plan(&LEARNER, 10), &root).unwrap();
    let size = |generations| {
        run(&plan(&LEARNER, generations), &directory, 1);
        [directory.checkpoint(), directory.record()].map(|path| fs::metadata(path).unwrap().len())
    };
    let [first, second, third] = [10, 60, 110].map(size);
    assert!(second[0] - first[0] < 8 && third[0] - second[0] < 8, "{first:?} {second:?} {third:?}");
    assert!(third[1] - second[1] < (second[1] - first[1]) + 50 * 8, "{first:?} {second:?} {third:?}");
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn the_log_of_a_run_that_somebody_changed_is_kept() {
    let root = scratch("changed");
    let directory = create(&plan(&STEADY, 3), &root).unwrap();
    run(&plan(&STEADY, 3), &directory, 1);
    let text = fs::read_to_string(directory.log()).unwrap();
    let changed = text.replace("worst", "remarks");
    fs::write(directory.log(), &changed).unwrap();
    run(&plan(&STEADY, 4), &directory, 1);
    assert!(fs::read_to_string(directory.log()).unwrap().starts_with(&text));
    assert_eq!(fs::read_to_string(root.join("fitness-changed-1.csv")).unwrap(), changed);
    fs::remove_dir_all(root).unwrap();
}

#[cfg(unix)]
#[test]
fn links_in_a_strangers_run_are_not_followed() {
    use std::os::unix::fs::symlink;
    let root = scratch("links");
    let directory = create(&plan(&STEADY, 3), &root.join("run")).unwrap();
    run(&plan(&STEADY, 3), &directory, 1);
    let victim = root.join("victim");
    let precious = "precious\n".repeat(1000);
    fs::write(&victim, &precious).unwrap();
    let names =
        ["config.toml", "manifest.json", "fitness.csv", "fitness.svg", "champion.bin", "checkpoint.bin", "record.bin"];
    for name in names.into_iter().chain(["lineage.csv", "test.csv", "test.json"]) {
        let _ = symlink(&victim, directory.path().join(format!(".{name}.new")));
    }
    // These are not read, or refused after reading.
    for name in ["fitness.csv", "fitness.svg", "lineage.csv", "failures.csv", "test.csv", "test.json"] {
        let _ = fs::remove_file(directory.path().join(name));
        symlink(&victim, directory.path().join(name)).unwrap();
    }
    run(&plan(&STEADY, 5), &directory, 1);
    test::test(&plan(&STEADY, 5), &directory, None, 2, 1, 1, LaneRequest::ONE, true).unwrap();
    assert_eq!(fs::read_to_string(&victim).unwrap(), precious);
    // A lock that is a link would create a file in another place.
    fs::remove_file(directory.path().join(".run.lock")).unwrap();
    symlink(root.join("made"), directory.path().join(".run.lock")).unwrap();
    let plan = plan(&STEADY, 6);
    let error = continue_run(&plan, &directory, pool(&plan, 1), &AtomicBool::new(false), "farsa", true).unwrap_err();
    assert!(error.to_string().contains("is no regular file") && !root.join("made").exists(), "{error}");
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn tests_at_the_same_time_leave_the_files_of_one() {
    let root = scratch("together");
    let directory = create(&plan(&STEADY, 3), &root).unwrap();
    run(&plan(&STEADY, 3), &directory, 1);
    std::thread::scope(|scope| {
        for seed in 1..5 {
            let directory = &directory;
            scope.spawn(move || {
                for _ in 0..10 {
                    let trials = 3 + seed as usize;
                    test::test(&plan(&STEADY, 3), directory, None, trials, seed, 1, LaneRequest::ONE, true).unwrap();
                    let (_, record) = test::read(directory).unwrap().unwrap();
                    assert!(record.is_some(), "the two files are of the same test");
                }
            });
        }
    });
    fs::remove_dir_all(root).unwrap();
}
