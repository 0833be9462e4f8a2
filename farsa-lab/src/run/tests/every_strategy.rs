//! Every strategy on experiments of one population and of two: interrupted, replayed, tested.

use std::fs;

use super::{Numbers, pool, rows, run, scratch};
use crate::evaluation::replay::{Which, replay};
use crate::evaluation::test;
use crate::experiment::lanes::Wanted;
use crate::experiment::settings::Value;
use crate::run::begin::create;
use crate::run::config_file::ConfigFile;
use crate::run::laboratory::Laboratory;
use crate::run::plan::Plan;
use crate::run::records::Champions;
use crate::run::told::history;
use crate::strategy::definition::StrategyDefinition;
use crate::strategy::settings::{GENERATIONS as GENERATIONS_KEY, POPULATION};
use crate::strategy::{Truncation, strategies};

const GENERATIONS: i64 = 7;

fn plan<'n>(numbers: &'n Numbers, strategy: &'static dyn StrategyDefinition, generations: i64) -> Plan<'n> {
    let mut plan = Plan::with_strategy(numbers, None, "", Some(strategy)).unwrap();
    plan.seed = 5;
    plan.settings.set("", GENERATIONS_KEY, Value::Whole(generations)).unwrap();
    if numbers.populations > 1 {
        // What the experiment counts by.
        let size = i64::try_from(super::SIZE).unwrap();
        plan.settings.set("", POPULATION, Value::Whole(size)).unwrap();
        if strategy.name() == "truncation" {
            plan.settings.set("", "evolution.parents", Value::Whole(2)).unwrap();
        }
        if strategy.name() == "evolution-strategy" {
            plan.settings.set("", "strategy.parents", Value::Whole(2)).unwrap();
        }
    }
    plan
}

/// A whole run, and one of other threads that was stopped twice.
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
    // The configuration alone says all.
    let file = ConfigFile::read(&whole.config()).unwrap();
    let again = Plan::from_file(&Laboratory::new(&[numbers]), &file).unwrap();
    assert_eq!((again.definition().name(), again.identity().unwrap()), (name, all.identity().unwrap()));
    // Any generation is replayed from what was told, with the fitness that it had.
    let rows = rows(&whole);
    for generation in [0, 3, 6] {
        let which = Which { generation: Some(generation), ..Which::default() };
        let summary = replay(&again, &whole, which, &mut Vec::new()).unwrap().summary;
        // One plus one remembers means.
        if numbers.populations == 1 && name != "one-plus-one" {
            let fitness = format!("fitness {:?}", rows[generation as usize][1]);
            assert!(summary.ends_with(&fitness), "{name}: {summary}, {fitness}");
        }
    }
    // The champion is the one of the record.
    let evaluator = all.evaluator().unwrap();
    let champions = Champions::read_checked(&all, &whole, evaluator.as_ref()).unwrap();
    let (_, history, _) = history(&all, &whole).unwrap();
    let wanted: Vec<(u32, usize)> = champions.best.iter().map(|best| (6, best.individual as usize)).collect();
    let genes: Vec<_> = champions.best.into_iter().map(|best| best.genes).collect();
    assert_eq!(history.genomes(&wanted).unwrap(), genes, "{name}");
    test::test(&all, &whole, 6, 1, 2, Wanted::ONE, true).unwrap();
    drop(pool(&all, 1));
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn every_strategy_runs_resumes_and_replays() {
    let alone = Numbers { strategy: &Truncation, populations: 1 };
    for strategy in strategies() {
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
    assert_eq!(
        wrong("[strategy]\nname = \"ars\"\nactive = true"),
        "my.toml line 4: unknown key `strategy.active`; the nearest is `strategy.name`"
    );
    fs::remove_dir_all(root).unwrap();
}
