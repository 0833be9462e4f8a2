//! A run in which the strategy chooses opponents.

use std::fs;

use super::{CHASE_ALONE, Numbers, SIZE, TRIALS, replayed, rows, run, scratch};
use crate::evaluation::replay::Selection;
use crate::experiment::settings::Value;
use crate::run::begin::create;
use crate::run::plan::Plan;
use crate::run::record_file::history;
use crate::strategy::any_strategy::Genome;
use crate::strategy::definition::StrategyDefinition;
use crate::strategy::settings::{GENERATIONS, POPULATION};
use crate::strategy::{Truncation, strategies};

const CHASE: Numbers = Numbers { strategy: &Truncation, populations: 2 };

pub(super) fn generalist() -> &'static dyn StrategyDefinition {
    *strategies().iter().find(|strategy| strategy.name() == "generalist").unwrap()
}

fn plan<'n>(numbers: &'n Numbers, values: &[(&str, i64)]) -> Plan<'n> {
    let mut plan = Plan::with_strategy(numbers, None, "", Some(generalist())).unwrap();
    let size = i64::try_from(SIZE).unwrap();
    let usual = [(POPULATION, size), ("strategy.newcomers", 5), ("strategy.iterations", 3), (GENERATIONS, 16)];
    for (key, value) in usual.iter().chain(values) {
        plan.settings.set("", key, Value::Whole(*value)).unwrap();
    }
    plan
}

fn parameters(genome: &Genome) -> Vec<f32> {
    match genome {
        Genome::Words(genes) => genes.iter().copied().map(f32::from).collect(),
        Genome::Reals(_) => panic!("reals"),
    }
}

#[test]
fn everyone_meets_whom_the_strategy_chose_in_the_run_and_in_its_replay() {
    for (opponents, encounters) in [(0, 4), (2, 5)] {
        let root = scratch(&format!("generalist-{opponents}"));
        let plan = plan(&CHASE, &[("strategy.opponents", opponents)]);
        let directory = create(&plan, &root).unwrap();
        run(&plan, &directory, 2);
        let (_, history, _) = history(&plan, &directory).unwrap();
        let rows = rows(&directory);
        let mut sums = [0.0; 2 * SIZE];
        for generation in 0..16_u32 {
            let place = generation % (encounters + 3);
            if place == 0 || place >= encounters {
                sums.fill(0.0);
            }
            let mut met_by_population = Vec::new();
            for (individual, sum) in sums.iter_mut().enumerate() {
                let own = parameters(&history.genomes(&[(generation, individual)]).unwrap()[0]);
                let met = history.opponents_of(generation, individual, 0..TRIALS).unwrap().unwrap();
                let others: Vec<Vec<f32>> = met.iter().map(|met| parameters(&met[0])).collect();
                let one = |other: &Vec<f32>| Numbers::against(&own, &[other], individual / SIZE);
                let fitness: f64 = others.iter().map(one).sum();
                *sum += fitness;
                if individual % 7 == 0 {
                    let which = Selection {
                        generation: Some(generation),
                        individual: Some(u32::try_from(individual).unwrap()),
                        ..Selection::default()
                    };
                    let (lines, found) = replayed(&plan, &directory, which);
                    assert_eq!(found.replay.fitness, fitness, "{generation}");
                    for (line, other) in lines.lines().skip(1).zip(&others) {
                        assert!(line.ends_with(&format!(",{:?}", f64::from(other[0]))), "{line}");
                    }
                }
                met_by_population.push(others);
            }
            // The run and its record have the same opponents.
            assert!(met_by_population.chunks(SIZE).all(|own| own.iter().all(|met| *met == own[0])));
            let rounds = if place < encounters { f64::from(place + 1) } else { 1.0 };
            for (population, own) in sums.chunks(SIZE).enumerate() {
                let best = own.iter().copied().fold(f64::NEG_INFINITY, f64::max) / rounds;
                let worst = own.iter().copied().fold(f64::INFINITY, f64::min) / rounds;
                let row = &rows[generation as usize];
                assert_eq!([row[6 + 3 * population], row[8 + 3 * population]], [best, worst], "{generation}");
            }
        }
        let table = fs::read_to_string(root.join("strategy.csv")).unwrap();
        assert_eq!(table.lines().next(), Some("generation,replaced_1,replaced_2,members_1,members_2"));
        fs::remove_dir_all(root).unwrap();
    }
}

#[test]
fn what_does_not_go_together_is_refused_with_its_numbers() {
    let refused = |numbers: &Numbers, values: &[(&str, i64)]| {
        plan(numbers, values).strategy().map(|_| ()).unwrap_err().to_string()
    };
    let one = refused(&CHASE_ALONE, &[]);
    assert_eq!(one, "numbers: has 1 population where `generalist` wants 2");
    let many = refused(&Numbers { populations: 3, ..CHASE }, &[]);
    assert_eq!(many, "numbers: has 3 populations where `generalist` wants 2");
    let uneven = refused(&CHASE, &[("strategy.newcomers", 4)]);
    assert_eq!(uneven, "`strategy.newcomers`: 4 newcomers are not a half, a third or so on of 10 individuals");
    let none = refused(&CHASE, &[("strategy.newcomers", 10)]);
    assert_eq!(none, "`strategy.newcomers`: 10 newcomers are not a half, a third or so on of 10 individuals");
    let trials = refused(&CHASE, &[("strategy.opponents", 4)]);
    assert_eq!(trials, "`strategy.opponents`: 4 opponents in 3 trials");
    let members = refused(&CHASE, &[("strategy.opponents", 3), (POPULATION, 4), ("strategy.newcomers", 2)]);
    assert_eq!(members, "`strategy.opponents`: the number of opponents is 3, where 1 to all members is possible");
}
