//! Our strategies, compared with results computed by hand.

use std::fmt::Write as _;
use std::fs;

use crate::evaluation::replay::{Selection, TrialSelector, replay};
use crate::evaluation::test;
use crate::experiment::episode::EpisodeId;
use crate::experiment::evaluator::{Iteration, Learner};
use crate::experiment::lanes::LaneRequest;
use crate::experiment::settings::Value;
use crate::run::begin::create;
use crate::run::bench::bench;
use crate::run::record_file::history;
use crate::run::records::Champions;
use crate::run::sample::Sample;
use crate::run::tests::{
    CHASE, LEARNER, Numbers, SIZE, STEADY, TRIALS, genes_of, lineage, plain, plan, pool, replayed, rows, run, scratch,
    twice, words,
};
use crate::strategy::settings::POPULATION;

#[test]
fn a_steady_state_keeps_the_better_of_two() {
    const GENERATIONS: i64 = 120;
    let root = scratch("steady");
    let directory = twice(&STEADY, &root, GENERATIONS);
    let plan = plan(&STEADY, GENERATIONS);
    let (_, history, _) = history(&plan, &directory).unwrap();
    let rows = rows(&directory);
    assert_eq!((rows.len(), history.finished()), (120, 120));
    // By hand: every evaluation of the parent so far, the one as a mutant included, against the mutant's own.
    let mut evaluations: Vec<f64> = Vec::new();
    let (mut replaced, mut longest) = (0, 0);
    for (generation, row) in (0..).zip(&rows) {
        let earned = |individual: usize| {
            let genes = genes_of(&history, generation, individual);
            assert!(genes.iter().all(|&gene| gene < 256));
            let trial = |trial| EpisodeId { seed: 11, generation, individual: individual as u32, trial };
            (0..TRIALS).map(|t| Numbers::alone(&plain(&genes), trial(t))).sum::<f64>()
        };
        evaluations.push(earned(0));
        longest = longest.max(evaluations.len());
        let (parent, mutant) = (evaluations.iter().sum::<f64>() / evaluations.len() as f64, earned(1));
        let survivor = usize::from(mutant >= parent);
        assert_eq!(history.champion(0, generation), Some(survivor), "generation {generation}");
        let (best, worst) = (parent.max(mutant), parent.min(mutant));
        for (found, expected) in row[1..4].iter().zip([best, f64::midpoint(best, worst), worst]) {
            assert!((found - expected).abs() < 1e-9 * expected.abs().max(1.0), "{row:?} {expected}");
        }
        assert_eq!(row[4..], [2.0, 0.0]);
        if survivor == 1 {
            (evaluations, replaced) = (vec![mutant], replaced + 1);
        }
    }
    assert!(replaced > 3 && longest > 5, "{replaced} {longest}");
    let lineage = lineage(&directory);
    assert_eq!(lineage.len(), 240);
    for (generation, individual, parents) in lineage {
        assert!(individual < 2 && parents == [history.champion(0, generation - 1).unwrap()]);
    }
    // The champion is the survivor with the mean of all its evaluations, and the replay is its own.
    let Champions { generation, best, .. } = Champions::read(&plan, &directory).unwrap();
    let survivor = history.champion(0, 119).unwrap();
    assert_eq!((generation, best.len(), best[0].individual as usize), (119, 1, survivor));
    assert_eq!(*words(&best[0]), genes_of(&history, 119, survivor));
    assert_eq!(best[0].fitness.get(), rows[119][1]);
    let (csv, found) = replayed(&plan, &directory, Selection::default());
    let summary = &found.summary;
    assert!(summary.starts_with(&format!("individual {survivor} of generation 119, 3 trials")), "{summary}");
    assert_eq!(csv.lines().nth(1).unwrap(), format!("0,0,0.0,{:?}", f64::from(words(&best[0])[0])));
    assert!(
        replay(&plan, &directory, Selection { individual: Some(2), ..Selection::default() }, None, || Ok(Vec::new()))
            .is_err()
    );
    let table = test::test(&plan, &directory, None, 7, 1, 2, LaneRequest::ONE, true).unwrap().text(false);
    assert!(table.contains(&format!("individual {survivor} of generation 119")), "{table}");
    // Nothing but the truncation algorithm has a population to set.
    let mut plan = crate::run::tests::plan(&STEADY, GENERATIONS);
    let error = plan.settings.set("--population", POPULATION, Value::Whole(9)).unwrap_err();
    assert!(error.to_string().contains("unknown key `evolution.population`"), "{error}");
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn a_learner_is_evaluated_and_trained() {
    const GENERATIONS: i64 = 12;
    let root = scratch("learner");
    let directory = twice(&LEARNER, &root, GENERATIONS);
    let read = |run: &str| fs::read_to_string(root.join(run).join("learning.csv")).unwrap();
    assert_eq!(read("whole"), read("parts"));
    let plan = plan(&LEARNER, GENERATIONS);
    let (_, history, _) = history(&plan, &directory).unwrap();
    // By hand: what is evaluated in a generation is the state before its iteration.
    let (mut evaluator, mut state) = (LEARNER, LEARNER.initial_state(11));
    let mut curve = String::from("generation,error before,error after,successes\n");
    for (generation, row) in (0..12_u32).zip(rows(&directory)) {
        let genes: Vec<u16> = LEARNER.learned(&state).into_iter().map(|value| value as u16).collect();
        assert_eq!(genes_of(&history, generation, 0), genes);
        assert_eq!(history.champion(0, generation), Some(0));
        let earned = |trial| Numbers::alone(&plain(&genes), EpisodeId { seed: 11, generation, individual: 0, trial });
        let fitness: f64 = (0..TRIALS).map(earned).sum();
        assert_eq!(row[1..], [fitness, fitness, fitness, 1.0, 0.0]);
        let Iteration { before, after, .. } = evaluator.iterate(&mut state, 11, generation).unwrap();
        writeln!(curve, "{generation},{before:?},{after:?},1.0").unwrap();
    }
    assert_eq!(read("whole"), curve);
    // The champion is the last evaluated individual.
    assert!(history.genomes(&[(12, 0)]).is_err() && history.genomes(&[(3, 1)]).is_err());
    assert!(history.champion(0, 12).is_none());
    let Champions { generation, best, .. } = Champions::read(&plan, &directory).unwrap();
    assert_eq!((generation, words(&best[0])), (11, &genes_of(&history, 11, 0)));
    let (csv, _) = replayed(&plan, &directory, Selection { generation: Some(0), ..Selection::default() });
    assert_eq!(csv.lines().nth(1).unwrap(), "0,0,0.0,0.0");
    let table = test::test(&plan, &directory, None, 7, 1, 2, LaneRequest::ONE, true).unwrap().text(false);
    assert!(table.contains("individual 0 of generation 11"), "{table}");
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn populations_meet_each_others_champions() {
    const GENERATIONS: i64 = 9;
    let root = scratch("chase");
    let directory = twice(&CHASE, &root, GENERATIONS);
    let plan = plan(&CHASE, GENERATIONS);
    let (_, history, _) = history(&plan, &directory).unwrap();
    let rows = rows(&directory);
    // Two of three trials are against the last two champions, one is against the middle of the earlier ones.
    let rule = |generation: u32, trial: u32| match trial {
        0 | 1 => generation.checked_sub(1 + trial),
        _ => (generation > 2).then(|| (generation - 2) / 2),
    };
    // By hand: everyone's fitness against whom the rule names, and the best of each population.
    for (generation, row) in (0..9_u32).zip(&rows) {
        let genes = |generation, individual| genes_of(&history, generation, individual);
        let fitness = |individual: usize| {
            let own = individual / SIZE;
            let trial = |trial: u32| {
                let others: Vec<Vec<f32>> = (0..3)
                    .filter(|other| *other != own)
                    .map(|other| {
                        plain(&rule(generation, trial).map_or_else(
                            || genes(generation, other * SIZE + trial as usize),
                            |earlier| genes(earlier, history.champion(other, earlier).unwrap()),
                        ))
                    })
                    .collect();
                let others: Vec<&[f32]> = others.iter().map(Vec::as_slice).collect();
                Numbers::against(&plain(&genes(generation, individual)), &others, own)
            };
            (0..TRIALS).map(trial).sum::<f64>()
        };
        let all: Vec<f64> = (0..3 * SIZE).map(fitness).collect();
        for (population, own) in all.chunks(SIZE).enumerate() {
            let best = own.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let worst = own.iter().copied().fold(f64::INFINITY, f64::min);
            let first = own.iter().position(|fitness| *fitness == best).unwrap();
            assert_eq!(history.champion(population, generation), Some(population * SIZE + first));
            assert_eq!([row[6 + 3 * population], row[8 + 3 * population]], [best, worst], "generation {generation}");
        }
        assert_eq!(row[1], all.iter().copied().fold(f64::NEG_INFINITY, f64::max));
        assert_eq!(row[4], 30.0);
        // A trial is replayed against the same opponents.
        for individual in [0, 14, 29] {
            let which =
                Selection { generation: Some(generation), individual: Some(individual), ..Selection::default() };
            let (_, found) = replayed(&plan, &directory, which);
            assert_eq!(found.replay.fitness, all[individual as usize]);
            let (one, _) = replayed(&plan, &directory, Selection { trial: TrialSelector::Number(2), ..which });
            let other = usize::from(individual < 10);
            let met = match rule(generation, 2) {
                Some(earlier) => genes(earlier, history.champion(other, earlier).unwrap()),
                None => genes(generation, other * SIZE + 2),
            };
            assert_eq!(one.lines().nth(1).unwrap(), format!("2,0,0.0,{:?}", f64::from(met[0])));
        }
    }
    // Everyone descends from one of the best two of its population, those of the best first.
    let lineage = lineage(&directory);
    assert_eq!(lineage.len(), 9 * 30);
    for (generation, individual, parents) in &lineage {
        let (population, rank) = (individual / SIZE, individual % SIZE / 5);
        assert!(parents.len() == 1 && parents[0] / SIZE == population);
        let best = history.champion(population, generation - 1).unwrap();
        assert_eq!(parents[0] == best, rank == 0, "{individual} of {generation}");
        if individual % 5 == 0 && *generation < 9 {
            let (own, theirs) = ((*generation, *individual), (generation - 1, parents[0]));
            let genes = history.genomes(&[own, theirs]).unwrap();
            assert_eq!(genes[0], genes[1]);
        }
    }
    let Champions { best, .. } = Champions::read(&plan, &directory).unwrap();
    let individuals: Vec<_> = best.iter().map(|best| best.individual as usize).collect();
    assert_eq!(individuals, (0..3).map(|p| history.champion(p, 8).unwrap()).collect::<Vec<_>>());

    // A test runs the champions against each other, and reports every population.
    let tested = test::test(&plan, &directory, None, 4, 1, 2, LaneRequest::ONE, true).unwrap();
    let text = tested.text(false);
    assert!(text.contains(" of generation 8 against each other"), "{text}");
    let csv = fs::read_to_string(directory.test()).unwrap();
    let [a, b, c] = [0, 1, 2].map(|p| f64::from(words(&best[p])[0]));
    let head = "index,trial,steps,success,fitness,to 200,first,second,fitness of population 1,success of population 1,\
                fitness of population 2,success of population 2";
    let (seeker, first, second) =
        (-(a - b).abs() - (a - c).abs(), (b - a).abs() + (b - c).abs(), (c - a).abs() + (c - b).abs());
    assert_eq!(csv.lines().next(), Some(head));
    let own = words(&best[0]).iter().map(|gene| f64::from(*gene)).collect::<Vec<_>>();
    let notes = format!("{:?},{:?},{:?}", (own[1] - 200.0).abs(), own[0], own[1]);
    let line = format!("1,1,1,{},{seeker:?},{notes},{first:?},1,{second:?},1", seeker >= 0.0);
    assert_eq!(csv.lines().nth(2).unwrap(), line);
    assert_eq!(csv.lines().count(), 5);
    assert_eq!(text, test::test(&plan, &directory, None, 4, 1, 1, LaneRequest::ONE, true).unwrap().text(false));
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn trials_with_every_strategy_can_be_measured() {
    let root = scratch("bench");
    for (numbers, trials) in [(STEADY, 2 * TRIALS), (LEARNER, TRIALS), (CHASE, 30 * TRIALS)] {
        let plan = plan(&numbers, 2);
        let directory =
            create(&plan, &root.join(format!("{}-{}", numbers.strategy.name(), numbers.populations))).unwrap();
        run(&plan, &directory, 1);
        for sample in [Sample::random(&plan), Sample::from_run(&plan, &directory)] {
            let sample = sample.unwrap();
            // On a busy machine no trial may end in a millisecond.
            let patience =
                [1e-3, 1.0, 60.0].iter().filter_map(|&time| bench(&plan, &sample, pool(&plan, 2), time).ok());
            let mut all = patience.map(|bench| serde_json::to_value(bench).unwrap());
            let measured = all.find(|measured| measured["trials"].as_u64().unwrap() > 0).unwrap();
            let rounds = measured["rounds"].as_u64().unwrap();
            assert!(rounds == 0 || measured["trials"].as_u64().unwrap() >= rounds * u64::from(trials), "{measured}");
        }
    }
    fs::remove_dir_all(root).unwrap();
}
