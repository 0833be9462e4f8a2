//! A custom strategy.

use std::fs;

use farsa_evo::{EvoError, Fitness, Population, Strategy};
use farsa_num::{Domain, Stream};

use crate::error::Error;
use crate::evaluation::replay::Selection;
use crate::experiment::settings::{Setting, Value};
use crate::run::begin::create;
use crate::run::plan::Plan;
use crate::run::tests::{CHASE, CHASE_ALONE, replayed, rows, run, scratch};
use crate::strategy::any_strategy::AnyStrategy;
use crate::strategy::definition::{StrategyDefinition, StrategyStart};
use crate::strategy::settings::{GENERATIONS as GENERATIONS_KEY, POPULATION};
use crate::strategy::{Diagnostics, DiagnosticsChart};

/// A strategy as a user writes it: three methods. It steps from the best of four guesses, wherever that lies.
struct HillClimber {
    generation: u32,
    seed: u64,
    population: Population,
}

impl HillClimber {
    fn draw(&mut self, around: &[u16]) {
        for (individual, genome) in self.population.iter_mut().enumerate() {
            let mut stream = Stream::new(self.seed, Domain::Mutation, 0, individual as u32, self.generation);
            for (gene, around) in genome.iter_mut().zip(around) {
                *gene = (around + stream.below(9) as u16).saturating_sub(4).min(255);
            }
        }
    }
}

impl Strategy for HillClimber {
    fn generation(&self) -> u32 {
        self.generation
    }
    fn ask(&self) -> &Population {
        &self.population
    }
    fn tell(&mut self, fitness: &[Fitness]) -> Result<(), EvoError> {
        let best = self.champions(fitness)[0];
        let around = self.population.get(best).unwrap_or_default().to_vec();
        self.generation += 1;
        self.draw(&around);
        Ok(())
    }
    fn diagnostics(&self) -> Vec<f64> {
        vec![f64::from(self.generation), 0.5]
    }
}

struct Climbing;

impl StrategyDefinition for Climbing {
    fn name(&self) -> &'static str {
        "hill-climber"
    }
    fn settings(&self) -> Vec<Setting> {
        vec![
            Setting::whole(GENERATIONS_KEY, 10, 1..=1000),
            Setting::whole("evolution.guesses", 4, 1..=100).doc("Guesses of a generation."),
        ]
    }
    fn start(&self, start: &StrategyStart<'_>) -> Result<AnyStrategy, Error> {
        let guesses = start.settings.count("evolution.guesses")?;
        let population = Population::new(guesses, start.genes).map_err(|error| Error::Other(error.to_string()))?;
        let mut climber = HillClimber { generation: 0, seed: start.seed, population };
        climber.draw(&vec![128; start.genes]);
        Ok(AnyStrategy::from_words(climber))
    }
    fn diagnostics(&self) -> Option<Diagnostics> {
        const COUNT: DiagnosticsChart =
            DiagnosticsChart { title: "count", axis: "1", curves: &[("count", "of all"), ("half", "of it")] };
        Some(Diagnostics { file: "climb", charts: &[COUNT] })
    }
}

#[test]
fn a_strategy_of_other_populations_than_the_experiments_is_refused() {
    let root = scratch("uneven");
    let plan = Plan::with_strategy(&CHASE, None, "", Some(&Climbing)).unwrap();
    let error = create(&plan, &root).unwrap_err().to_string();
    let says = "the strategy `hill-climber` has 1 populations of 2 genes where numbers has 3 of 2";
    assert_eq!((error.as_str(), root.exists()), (says, false));
}

#[test]
fn a_strategy_of_ones_own_runs_resumes_and_replays() {
    const GENERATIONS: i64 = 9;
    let root = scratch("own");
    let plan = |generations| {
        let mut plan = Plan::with_strategy(&CHASE_ALONE, None, "", Some(&Climbing)).unwrap();
        plan.settings.set("", GENERATIONS_KEY, Value::Whole(generations)).unwrap();
        plan
    };
    let error = plan(1).settings.set("--population", POPULATION, Value::Whole(9)).unwrap_err();
    assert!(error.to_string().contains("unknown key `evolution.population`"), "{error}");
    let whole = create(&plan(GENERATIONS), &root.join("whole")).unwrap();
    run(&plan(GENERATIONS), &whole, 2);
    let parts = create(&plan(1), &root.join("parts")).unwrap();
    for (generations, threads) in [(1, 3), (4, 1), (GENERATIONS, 2)] {
        run(&plan(generations), &parts, threads);
    }
    for name in ["fitness.csv", "champion.bin", "record.bin", "checkpoint.bin", "climb.csv", "climb.svg"] {
        let read = |run: &str| fs::read(root.join(run).join(name)).unwrap();
        assert!(read("whole") == read("parts"), "{name}");
    }
    assert!(!whole.lineage().exists(), "its individuals have no parents");
    let table = fs::read_to_string(root.join("whole").join("climb.csv")).unwrap();
    assert!(table.starts_with("generation,count,half\n0,1.0,0.5\n1,2.0,0.5\n"), "{table}");
    let rows = rows(&whole);
    let plan = plan(GENERATIONS);
    for generation in [0, 5, 8] {
        let (_, found) = replayed(&plan, &whole, Selection { generation: Some(generation), ..Selection::default() });
        assert_eq!(found.replay.fitness, rows[generation as usize][1]);
    }
    fs::remove_dir_all(root).unwrap();
}
