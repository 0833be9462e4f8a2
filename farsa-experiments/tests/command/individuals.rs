//! Any individual of a run is tested, and the files that speak of the champion stay as they are.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::tool::{farsa, ok, say, scratch};

fn tested(here: &Path, arguments: &str) -> Value {
    serde_json::from_str(&ok(farsa(), here, &format!("test {arguments} --json"))).expect("JSON")
}

fn maze() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../experiments/maze.toml")
}

/// The maze has one start and no noise: a fresh trial of an elite is the one that brought it into the archive.
#[test]
fn an_elite_is_tested_by_its_generation_and_number() {
    let here = scratch("elites");
    fs::copy(maze(), here.join("maze.toml")).expect("the file");
    let small = "--population 10 --generations 4 --set episode.steps=100 --quiet";
    ok(farsa(), &here, &format!("run maze.toml --strategy map-elites {small} --out r"));
    let archive = fs::read_to_string(here.join("r/archive.csv")).expect("the archive");
    let elites: Vec<Vec<&str>> = archive.lines().skip(1).map(|line| line.split(',').collect()).collect();
    assert!(elites.iter().any(|elite| elite[1] != "3") && elites.len() > 5, "{archive}");
    for elite in elites.iter().take(8) {
        let [generation, individual, fitness, x] = [1, 2, 3, 4].map(|column| elite[column]);
        let found = tested(&here, &format!("r --generation {generation} --individual {individual} --trials 2"));
        assert_eq!(found["fitness"].as_f64(), fitness.parse().ok(), "{found}");
        assert_eq!(found["notes"]["measured x"]["mean"].as_f64(), x.parse().ok(), "{found}");
        assert_eq!(
            (found["generation"].to_string(), found["individual"].to_string()),
            (generation.into(), individual.into())
        );
    }
    let files = || ["test.csv", "test.json"].map(|file| fs::read(here.join("r").join(file)).ok());
    assert_eq!(files(), [None, None]);
    ok(farsa(), &here, "test r --trials 3 --quiet");
    let before = files();
    assert!(before.iter().all(Option::is_some));
    let said = ok(farsa(), &here, "test r --generation 0 --trials 2");
    assert!(said.contains(" of generation 0, test seed 1"), "{said}");
    assert_eq!(files(), before);
    for (arguments, words) in [
        ("r --generation 4", "generation 4 of 4 finished ones (the first is 0)"),
        ("r --individual 10", "generation 3: individual 10 of a population of 10"),
        ("r --generation 1 --protocol lesions", "cannot be used with"),
        ("r --individual 1 --lesion neuron:1", "cannot be used with"),
    ] {
        let said = say(farsa(), &here, &format!("test {arguments}"));
        assert!(said.code == Some(2) && said.err.contains(words), "{said:?}");
    }
    assert_eq!(files(), before);
}

/// An individual of one population plays against the best of the other. Without a choice it is the test of the champions.
#[test]
fn an_individual_of_a_population_meets_the_best_of_the_other() {
    let here = scratch("individuals");
    let short = "--population 16 --generations 3 --quiet --set trial.steps=20";
    ok(farsa(), &here, &format!("run predator-prey {short} --out r"));
    let champions = tested(&here, "r --trials 6 --seed 2");
    assert_eq!(tested(&here, "r --generation 2 --trials 6 --seed 2"), champions);
    let [predator, prey] = [0, 1].map(|number| champions["individuals"][number].to_string());
    assert_eq!(tested(&here, &format!("r --individual {prey} --trials 6 --seed 2")), champions);
    let other = if prey == "20" { 21 } else { 20 };
    let found = tested(&here, &format!("r --individual {other} --trials 6 --seed 2"));
    assert_eq!(found["individuals"].to_string(), format!("[{predator},{other}]"));
    assert_ne!(found["notes"], champions["notes"], "{found}");
}

/// The statistics of normalization are those of the generation.
#[test]
fn observations_are_normalised_as_in_the_generation() {
    let here = scratch("individuals-normalised");
    fs::copy(maze(), here.join("maze.toml")).expect("the file");
    let short = "--population 8 --generations 3 --quiet --set episode.steps=100";
    let strategy = "--strategy open-ai-es --set strategy.normalise_observations=true";
    ok(farsa(), &here, &format!("run maze.toml {strategy} {short} --out r"));
    let champion = tested(&here, "r --trials 4");
    assert_eq!(tested(&here, "r --generation 2 --trials 4"), champion);
    // The genes of the last generation are moved a little, and there are more observations.
    assert_ne!(tested(&here, "r --generation 0 --trials 4")["fitness"], champion["fitness"]);
}
