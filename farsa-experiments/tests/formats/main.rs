//! Run directories of this version and earlier ones are read, replayed, tested, drawn, run in pages and resumed to the same bits,
//! or refused by name. `formats/make` makes those of this version. A later one adds its directories next to them.

mod checks;
mod later;
mod place;
mod refusal;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use place::{Place, content, has, today};

/// The list of directories of a version, each with its test.
macro_rules! directories {
    ($version:literal, $($test:ident: $name:literal),* $(,)?) => {
        pub(crate) const VERSION: &str = $version;
        pub(crate) const NAMES: &[&str] = &[$($name),*];
        $(#[test]
        fn $test() {
            super::lasts($version, $name);
        })*
    };
}

mod v0_1 {
    directories! {
        "v0.1",
        reach_grasp_lift: "reach-grasp-lift", compositional_instructions: "compositional-instructions",
        icub_reach: "icub-reach", icub_reach_grasp: "icub-reach-grasp", kinesthetic_grasp: "kinesthetic-grasp",
        discrimination: "discrimination", discrimination_cylinders: "discrimination-cylinders",
        braitenberg: "braitenberg", minimal_cognition: "minimal-cognition", double_pole: "double-pole",
        foraging: "foraging", aggregation: "aggregation", predator_prey: "predator-prey", push_box: "push-box",
        passive_walker: "passive-walker", body_evolution: "body-evolution", hopper: "hopper", walker2d: "walker2d",
        half_cheetah: "half-cheetah", ant: "ant", ant_omni: "ant-omni", humanoid: "humanoid", go1_joystick: "go1-joystick",
        g1_walk: "g1-walk", random_search: "random-search",
        real_ga: "real-ga", sss: "sss", evolution_strategy: "evolution-strategy", cosyne: "cosyne",
        cma_es: "cma-es", cholesky_cma_es: "cholesky-cma-es", separable_cma_es: "separable-cma-es",
        restarts: "restarts", xnes: "xnes", snes: "snes", open_ai_es: "open-ai-es", pgpe: "pgpe", ars: "ars",
        nsga2: "nsga2", map_elites: "map-elites", cma_me: "cma-me", novelty_search: "novelty-search",
        populations_of_reals: "populations-of-reals", generalist: "generalist", normalised: "normalised",
        composed: "composed", composed_populations: "composed-populations", failures: "failures",
        imported: "imported", imported_populations: "imported-populations", tested: "tested",
        tested_in_rapier: "tested-in-rapier",
    }
}

/// Trials and seed of the test that `formats/make` made of each, and the generations that it went on to.
pub(crate) const TEST: &str = "test run --trials 2 --seed 7";
pub(crate) const GENERATIONS: usize = 4;

pub(crate) fn formats() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/formats")
}

pub(crate) fn gallery() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/gallery/runs")
}

/// The expected results of a directory.
#[derive(Default)]
struct Expected {
    /// The reward of the champion in a replay.
    replay: Option<f64>,
    /// The digest of each file.
    files: BTreeMap<String, u64>,
}

/// The expected results of each directory of a version.
fn expected(version: &str) -> BTreeMap<String, Expected> {
    let mut all: BTreeMap<String, Expected> = BTreeMap::new();
    for line in fs::read_to_string(formats().join(version).join("expected.txt")).expect("a list").lines() {
        let [name, what, number] = line.split(' ').collect::<Vec<_>>()[..] else { panic!("{line}") };
        let one = all.entry(name.into()).or_default();
        if what == "replay" {
            one.replay = Some(number.parse().expect("a fitness"));
        } else {
            one.files.insert(what.into(), u64::from_str_radix(number, 16).expect("a digest"));
        }
    }
    all
}

fn lasts(version: &str, name: &str) {
    let place = Place::with(&format!("{version}-{name}"), &formats().join(version).join(name));
    if let Some(refusal) = place.refused() {
        return place.is_refused(&refusal);
    }
    let expected = &expected(version)[name];
    assert!(expected.replay.is_some(), "{name}: nobody said what a replay earns");
    place.is_read(expected.replay);
    if place.recorded().is_some() {
        place.is_rebuilt();
    }
    place.is_shown();
    place.goes_on(expected);
    place.is_what_it_was(expected, version);
}

#[test]
fn no_directory_is_passed_over() {
    let lists = [(v0_1::VERSION, v0_1::NAMES)];
    let names = |folder: &Path| -> BTreeSet<String> {
        let entries = fs::read_dir(folder).expect("a directory").map(|entry| entry.expect("an entry"));
        let folders = entries.filter(|entry| entry.path().is_dir());
        folders.map(|entry| entry.file_name().into_string().expect("a name")).collect()
    };
    assert_eq!(names(&formats()), lists.iter().map(|(version, _)| (*version).to_owned()).collect());
    for (version, list) in lists {
        let list: BTreeSet<String> = list.iter().map(|name| (*name).to_owned()).collect();
        assert_eq!(names(&formats().join(version)), list);
        assert_eq!(expected(version).into_keys().collect::<BTreeSet<_>>(), list);
    }
}

/// True if one of the files has these bytes somewhere.
fn any_has<'f>(mut files: impl Iterator<Item = &'f Vec<u8>>, bytes: &[u8]) -> bool {
    files.any(|file| has(file, bytes))
}

#[test]
fn every_experiment_strategy_and_kind_of_file_of_this_version_has_a_directory() {
    let all = content(&formats().join(v0_1::VERSION));
    let with = |end: &'static str| all.iter().filter(move |(file, _)| file.ends_with(end)).map(|(_, bytes)| bytes);
    // One that this program resumes: a change of values needs new directories, as it needs new goldens.
    let read: BTreeSet<String> = v0_1::NAMES
        .iter()
        .map(|name| Place::with(&format!("read-{name}"), &formats().join(v0_1::VERSION).join(name)))
        .filter(|place| place.refused().is_none())
        .filter_map(|place| place.manifest("run")["experiment"].as_str().map(str::to_owned))
        .collect();
    for experiment in farsa_experiments::all() {
        let name = experiment.name();
        assert!(read.contains(name), "{name}: no directory has the values of this program; formats/make makes them");
    }
    for strategy in today().ok("strategies --json").json().as_array().expect("a list") {
        let name = strategy["name"].as_str().expect("a name");
        // In the head of the record, after its length.
        let name = [&[u8::try_from(name.len()).expect("a short name")], name.as_bytes()].concat();
        assert!(any_has(with("record.bin"), &name), "{strategy}");
    }
    // All that a sealed file of a run can begin with.
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("../farsa-lab/src/run/records.rs");
    let source = fs::read_to_string(source).expect("the source");
    let kinds: Vec<&str> = source.split(": b\"").skip(1).filter_map(|rest| rest.get(..8)).collect();
    assert!(kinds.len() >= 8, "{kinds:?}");
    for kind in kinds {
        assert!(with(".bin").any(|bytes| bytes.starts_with(kind.as_bytes())), "{kind}");
    }
    let named = |file: &str| all.keys().any(|name| name.rsplit('/').next() == Some(file));
    for file in
        ["archive.csv", "failures.csv", "learning.csv", "lineage.csv", "strategy.csv", "test.json", "test-rapier.json"]
    {
        assert!(named(file), "{file}");
    }
}

#[test]
fn the_runs_of_the_gallery_are_read() {
    let mut read = 0;
    for entry in fs::read_dir(gallery()).expect("the gallery") {
        let run = entry.expect("an entry").path();
        let name = run.file_name().and_then(|name| name.to_str()).expect("a name").to_owned();
        let place = Place::with(&format!("gallery-{name}"), &run);
        // A gallery is made again where values change.
        assert!(place.refused().is_none(), "{name}");
        place.is_read(None);
        read += 1;
    }
    assert!(read >= 11, "{read}");
}
