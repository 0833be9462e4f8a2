//! Every strategy on experiments of one population and of two: interrupted, replayed, tested.

use std::fs;

use farsa_body::Recorder;
use farsa_evo::Fitness;
use farsa_view::Schema;

use super::{Numbers, check_archive, pool, rows, run, scratch};
use crate::error::Error;
use crate::evaluation::replay::{Replayable, Selection, replay};
use crate::evaluation::test;
use crate::experiment::behavior::Behavior;
use crate::experiment::evaluator::{Evaluation, Evaluator, Task, TaskInfo};
use crate::experiment::lanes::LaneRequest;
use crate::experiment::outcome::Outcome;
use crate::experiment::parameter::Parameter;
use crate::experiment::settings::{Setting, Settings, Value};
use crate::run::begin::create;
use crate::run::config_file::ConfigFile;
use crate::run::experiment::Experiment;
use crate::run::laboratory::Laboratory;
use crate::run::plan::Plan;
use crate::run::record_file::history;
use crate::run::records::Champions;
use crate::store::directory::Directory;
use crate::strategy::definition::StrategyDefinition;
use crate::strategy::settings::{GENERATIONS as GENERATIONS_KEY, POPULATION};
use crate::strategy::{Truncation, strategies};

const GENERATIONS: i64 = 7;

fn plan<'n>(numbers: &'n Numbers, strategy: &'static dyn StrategyDefinition, generations: i64) -> Plan<'n> {
    let mut plan = Plan::with_strategy(numbers, None, "", Some(strategy)).unwrap();
    plan.seed = 5;
    plan.settings.set("", GENERATIONS_KEY, Value::Whole(generations)).unwrap();
    if numbers.populations > 1 {
        // The size that the experiment uses.
        let size = i64::try_from(super::SIZE).unwrap();
        plan.settings.set("", POPULATION, Value::Whole(size)).unwrap();
        if ["truncation", "novelty-search"].contains(&strategy.name()) {
            plan.settings.set("", "evolution.parents", Value::Whole(2)).unwrap();
        }
        if strategy.name() == "evolution-strategy" {
            plan.settings.set("", "strategy.parents", Value::Whole(2)).unwrap();
        }
        if strategy.name() == "generalist" {
            plan.settings.set("", "strategy.newcomers", Value::Whole(5)).unwrap();
            plan.settings.set("", "strategy.iterations", Value::Whole(2)).unwrap();
        }
        if strategy.name() == "cma-me" {
            plan.settings.set("", "strategy.emitters", Value::Whole(2)).unwrap();
        }
    }
    plan
}

/// The strategies whose champion is the best of all generations.
const KEEP: [&str; 5] = ["random-search", "novelty-search", "map-elites", "cma-me", "nsga2"];

/// The first generation with the largest of the best.
fn best_of_all(rows: &[Vec<f64>]) -> usize {
    (0..rows.len()).fold(0, |found, generation| if rows[generation][1] > rows[found][1] { generation } else { found })
}

/// A complete run, and one with other numbers of threads that was stopped twice.
fn runs_the_same(numbers: &Numbers, strategy: &'static dyn StrategyDefinition) {
    let name = strategy.name();
    let root = scratch(&format!("{name}-{}", numbers.populations));
    let all = plan(numbers, strategy, GENERATIONS);
    let whole = create(&all, &root.join("whole")).unwrap();
    run(&all, &whole, 2);
    let parts = create(&plan(numbers, strategy, 1), &root.join("parts")).unwrap();
    for (generations, threads) in [(1, 3), (4, 1), (GENERATIONS, 2)] {
        run(&plan(numbers, strategy, generations), &parts, threads);
    }
    let mut files: Vec<_> = fs::read_dir(root.join("whole")).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    files.retain(|file| file != "manifest.json" && file != "fitness.svg" && !file.to_string_lossy().starts_with('.'));
    for file in files {
        let read = |run: &str| fs::read(root.join(run).join(&file)).ok();
        assert!(read("whole") == read("parts"), "{name}: {}", file.display());
    }
    // Champions of unsaved generations are discarded.
    let early = create(&plan(numbers, strategy, 3), &root.join("early")).unwrap();
    run(&plan(numbers, strategy, 3), &early, 1);
    let champions = fs::read(early.champion()).unwrap();
    fs::copy(whole.champion(), early.champion()).unwrap();
    run(&plan(numbers, strategy, 3), &early, 1);
    assert!(fs::read(early.champion()).unwrap() == champions, "{name}");
    // Missing champions are rebuilt.
    let champions = fs::read(parts.champion()).unwrap();
    fs::remove_file(parts.champion()).unwrap();
    run(&plan(numbers, strategy, GENERATIONS), &parts, 1);
    assert!(fs::read(parts.champion()).unwrap() == champions, "{name}");
    // The configuration alone is complete.
    let file = ConfigFile::read(&whole.config()).unwrap();
    let again = Plan::from_file(&Laboratory::new(&[numbers]), &file).unwrap();
    assert_eq!((again.definition().name(), again.identity().unwrap()), (name, all.identity().unwrap()));
    // Any generation is replayed from its reported fitness, with the same fitness.
    let rows = rows(&whole);
    for generation in [0, 3, 6] {
        let which = Selection { generation: Some(generation), ..Selection::default() };
        let replayed = replay(&again, &whole, which, None, || Ok(Vec::new())).unwrap();
        // The strategy one plus one stores means.
        if numbers.populations == 1 && name != "one-plus-one" {
            assert_eq!(replayed.replay.fitness, rows[generation as usize][1], "{name}: {}", replayed.summary);
        }
    }
    // The champion is the one of the record.
    let evaluator = all.evaluator().unwrap();
    let champions = Champions::read_checked(&all, &whole, evaluator.as_ref()).unwrap();
    let (_, history, _) = history(&all, &whole).unwrap();
    let generation = if numbers.populations == 1 && KEEP.contains(&name) { best_of_all(&rows) } else { 6 };
    assert_eq!(champions.generation, generation as u32, "{name}");
    if numbers.populations == 1 {
        assert_eq!(champions.fitness().map(Fitness::get), Some(rows[generation][1]), "{name}");
    }
    let wanted = champions.best.iter().map(|best| (champions.generation, best.individual as usize));
    let wanted: Vec<(u32, usize)> = wanted.collect();
    let genes: Vec<_> = champions.best.into_iter().map(|best| best.genes).collect();
    assert_eq!(history.genomes(&wanted).unwrap(), genes, "{name}");
    let found = Replayable::find(&again, &whole, Selection::default()).unwrap();
    assert_eq!((found.generation, found.individual as usize), wanted[0], "{name}");
    let of_all = Replayable::champions(&again, &whole).unwrap();
    let of_all: Vec<_> = of_all.iter().map(|found| (found.generation, found.individual as usize)).collect();
    assert_eq!(of_all, wanted, "{name}");
    test::test(&all, &whole, None, 6, 1, 2, LaneRequest::ONE, true).unwrap();
    check_archive(&all, &whole);
    drop(pool(&all, 1));
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn every_strategy_runs_resumes_and_replays() {
    let alone = Numbers { strategy: &Truncation, populations: 1 };
    for strategy in strategies().iter().filter(|strategy| strategy.name() != "generalist") {
        runs_the_same(&alone, *strategy);
    }
}

#[test]
fn every_strategy_has_opponents() {
    let chase = Numbers { strategy: &Truncation, populations: 2 };
    for strategy in strategies().iter().filter(|strategy| !["one-plus-one", "learning"].contains(&strategy.name())) {
        runs_the_same(&chase, *strategy);
    }
}

#[test]
fn reals_search_what_words_search() {
    let alone = Numbers { strategy: &Truncation, populations: 1 };
    for name in ["cma-es", "real-ga", "sss", "evolution-strategy", "xnes", "snes", "separable-cma-es"] {
        let root = scratch(&format!("finds-{name}"));
        let strategy = *strategies().iter().find(|strategy| strategy.name() == name).unwrap();
        let plan = plan(&alone, strategy, 150);
        let directory = create(&plan, &root).unwrap();
        run(&plan, &directory, 2);
        let evaluator = plan.evaluator().unwrap();
        let best = Champions::read_checked(&plan, &directory, evaluator.as_ref()).unwrap().best.remove(0);
        let found = best.genes.decode(&plan.genotype(evaluator.as_ref())).unwrap();
        assert!((found[0] - 100.0).abs() < 30.0 && (found[1] - 7.0).abs() < 60.0, "{name}: {found:?}");
        fs::remove_dir_all(root).unwrap();
    }
}

/// The lines of a run's archive.
fn archive(directory: &Directory) -> Vec<Vec<String>> {
    let text = fs::read_to_string(directory.path().join("archive.csv")).unwrap();
    text.lines().map(|line| line.split(',').map(String::from).collect()).collect()
}

#[test]
fn an_archive_names_individuals_that_the_record_finds() {
    let alone = Numbers { strategy: &Truncation, populations: 1 };
    for (name, cells) in [("map-elites", "grid"), ("map-elites", "cvt"), ("cma-me", "grid"), ("nsga2", "")] {
        let root = scratch(&format!("archive-{name}-{cells}"));
        let strategy = *strategies().iter().find(|strategy| strategy.name() == name).unwrap();
        let mut plan = plan(&alone, strategy, 20);
        if name != "nsga2" {
            plan.settings.set("", "strategy.cells", Value::Whole(100)).unwrap();
            plan.settings.set("", "strategy.division", Value::Word(cells.into())).unwrap();
        }
        let directory = create(&plan, &root).unwrap();
        run(&plan, &directory, 2);
        let lines = archive(&directory);
        let head = if name == "nsga2" { vec!["fitness", "minus to 200"] } else { vec!["fitness", "first", "second"] };
        assert_eq!(lines[0], [vec!["cell", "generation", "individual"], head].concat());
        assert!(lines.len() > if name == "nsga2" { 5 } else { 60 }, "{name} {cells}: {} lines", lines.len());
        let (_, history, _) = history(&plan, &directory).unwrap();
        let evaluator = plan.evaluator().unwrap();
        let genotype = plan.genotype(evaluator.as_ref());
        for line in &lines[1..] {
            let number = |column: usize| line[column].parse::<f64>().unwrap();
            let genome = history.genomes(&[(number(1) as u32, number(2) as usize)]).unwrap().remove(0);
            let found = genome.decode(&genotype).unwrap().into_iter().map(f64::from).collect::<Vec<_>>();
            if name == "nsga2" {
                assert!((number(4) + (found[1] - 200.0).abs()).abs() < 1e-4, "{line:?}: {found:?}");
            } else {
                assert!((number(4) - found[0]).abs() < 1e-9 && (number(5) - found[1]).abs() < 1e-9, "{line:?}");
            }
        }
        // A missing file is written again.
        let before = fs::read(root.join("archive.csv")).unwrap();
        fs::remove_file(root.join("archive.csv")).unwrap();
        run(&plan, &directory, 1);
        assert_eq!(fs::read(root.join("archive.csv")).unwrap(), before);
        fs::remove_dir_all(root).unwrap();
    }
}

/// An experiment with an invalid description.
#[derive(Clone, Copy)]
struct Described(&'static [f64]);

impl Behavior for Described {
    fn objectives(&self) -> Vec<String> {
        vec!["speed".into()]
    }
    fn measures(&self) -> Vec<Parameter> {
        vec![Parameter::new("place", [0.0, 1.0])]
    }
    fn describe(&self, _: &[Outcome]) -> Vec<f64> {
        self.0.to_vec()
    }
}

impl Task for Described {
    fn info(&self) -> TaskInfo {
        TaskInfo::new(vec![Parameter::new("gene", [0.0, 1.0])], Schema::from_scalars(["gene"]))
    }

    fn behavior(&self) -> Option<&dyn Behavior> {
        if self.0.is_empty() { None } else { Some(self) }
    }
}

impl Evaluator for Described {
    fn evaluate(&mut self, _: Evaluation<'_>, _: Option<&mut dyn Recorder>) -> Outcome {
        Outcome { terms: vec![1.0], steps: 1, ..Outcome::default() }
    }
}

impl Experiment for Described {
    fn name(&self) -> &'static str {
        "described"
    }
    fn summary(&self) -> &'static str {
        "describes behaviours in numbers of its own"
    }
    fn settings(&self, _: &str) -> Vec<Setting> {
        Vec::new()
    }
    fn prepare(&self, _: &str, _: &Settings) -> Result<Box<dyn Evaluator>, Error> {
        Ok(Box::new(*self))
    }
}

#[test]
fn a_behaviour_that_is_none_is_a_failed_evaluation() {
    let by = |name: &str| *strategies().iter().find(|strategy| strategy.name() == name).unwrap();
    let cases: [(&str, &'static [f64], &str); 5] = [
        ("nsga2", &[f64::NAN, 0.5], "`speed` of its behaviour is NaN"),
        ("map-elites", &[1.0, f64::INFINITY], "`place` of its behaviour is inf"),
        ("novelty-search", &[1.0], "its behaviour is described by 1 numbers where 2 are named"),
        ("map-elites", &[1.0, 0.5, 0.5], "its behaviour is described by 3 numbers where 2 are named"),
        ("truncation", &[f64::NAN], ""),
    ];
    for (number, (name, numbers, why)) in cases.into_iter().enumerate() {
        let (root, described) = (scratch(&format!("described-{number}")), Described(numbers));
        let mut plan = Plan::with_strategy(&described, None, "", Some(by(name))).unwrap();
        plan.settings.set("", GENERATIONS_KEY, Value::Whole(2)).unwrap();
        let directory = create(&plan, &root).unwrap();
        run(&plan, &directory, 2);
        let failures = fs::read_to_string(directory.failures()).unwrap_or_default();
        if why.is_empty() {
            assert_eq!(failures, "", "{name}");
        } else {
            assert!(failures.lines().count() == 201 && failures.contains(why), "{name}: {failures}");
        }
        fs::remove_dir_all(root).unwrap();
    }
}

#[test]
fn what_an_experiment_does_not_say_is_asked_for_by_name() {
    let by = |name: &str| *strategies().iter().find(|strategy| strategy.name() == name).unwrap();
    let silent = Described(&[]);
    let wants = |name: &str| {
        let plan = Plan::with_strategy(&silent, None, "", Some(by(name))).unwrap();
        plan.strategy().map(|_| ()).unwrap_err().to_string()
    };
    for name in ["map-elites", "cma-me", "novelty-search"] {
        assert_eq!(
            wants(name),
            "described: says nothing of behaviour, which `map-elites` wants".replace("map-elites", name)
        );
    }
    assert_eq!(wants("nsga2"), "described: has its fitness alone, where `nsga2` wants several objectives");
    let told = Described(&[0.0, 0.0]);
    let mut plan = Plan::with_strategy(&told, None, "", Some(by("cma-me"))).unwrap();
    plan.settings.set("", "strategy.emitters", Value::Whole(7)).unwrap();
    let error = plan.strategy().map(|_| ()).unwrap_err().to_string();
    assert_eq!(error, "`evolution.population`: 555 individuals are not as many of each of 7 emitters");
}

#[test]
fn an_experiment_is_told_the_size_that_a_strategy_chooses() {
    let chase = Numbers { strategy: &Truncation, populations: 2 };
    let strategy = *strategies().iter().find(|strategy| strategy.name() == "cma-es").unwrap();
    let mut plan = Plan::with_strategy(&chase, None, "", Some(strategy)).unwrap();
    // 4 + 3 ln 2, rounded down.
    let told = |plan: &Plan<'_>| plan.settings_of_trials().unwrap().count(POPULATION).unwrap();
    assert_eq!((plan.size().unwrap(), told(&plan)), (6, 6));
    assert_eq!(plan.settings.count(POPULATION).unwrap(), 0);
    plan.settings.set("", POPULATION, Value::Whole(9)).unwrap();
    assert_eq!((plan.size().unwrap(), told(&plan)), (9, 9));
}

#[test]
fn the_name_of_a_strategy_is_part_of_a_run() {
    let alone = Numbers { strategy: &Truncation, populations: 1 };
    let by = |name: &str| *strategies().iter().find(|strategy| strategy.name() == name).unwrap();
    assert_eq!(plan(&alone, by("cma-es"), 3).name(), "numbers-cma-es-5");
    let own = plan(&alone, by("truncation"), 3);
    assert_eq!((own.name().as_str(), own.chosen_strategy()), ("numbers-5", None));
    assert!(!own.to_toml().unwrap().contains("[strategy]"));
    let text = plan(&alone, by("snes"), 3).to_toml().unwrap();
    assert!(text.contains("\n[strategy]\n") && text.contains("name = \"snes\""), "{text}");
    let root = scratch("named");
    let directory = create(&plan(&alone, by("snes"), 3), &root).unwrap();
    let error = history(&plan(&alone, by("xnes"), 3), &directory).map(|_| ()).unwrap_err().to_string();
    assert!(error.contains("strategy.name"), "{error}");
    let wrong = |line: &str| {
        let file = ConfigFile::parse("my.toml", &format!("experiment = \"numbers\"\n{line}")).unwrap();
        Plan::from_file(&Laboratory::new(&[&alone]), &file).map(|_| ()).unwrap_err().to_string()
    };
    assert_eq!(wrong("[strategy]\nname = \"cma\""), "my.toml line 3: unknown strategy `cma`; the nearest is `cma-es`");
    let other = wrong("[strategy]\nname = \"ars\"\nactive = true");
    let start =
        "my.toml line 4: `strategy.active`: a setting of `cma-es`, `cholesky-cma-es`, not of `ars`; the settings of";
    assert!(other.starts_with(start), "{other}");
    fs::remove_dir_all(root).unwrap();
}
