//! Runs whose observations are normalised: what was observed is counted by hand, whatever evaluates it.

use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use farsa_body::Recorder;
use farsa_evo::ObservationStatistics;
use farsa_nn::{Controller as _, Perceptron};
use farsa_num::{Domain, Stream};
use farsa_view::Schema;

use super::ranks::{part, same};
use super::{check_archive, pool, rows, run, scratch};
use crate::advanced::RunDirectory;
use crate::error::Error;
use crate::evaluation::replay::{Selection, replay};
use crate::evaluation::test;
use crate::experiment::NormalizedController;
use crate::experiment::episode::EpisodeId;
use crate::experiment::evaluator::{Evaluation, Evaluator, Task, TaskInfo};
use crate::experiment::lanes::LaneRequest;
use crate::experiment::outcome::Outcome;
use crate::experiment::parameter::Parameter;
use crate::experiment::settings::{Setting, Settings, Value};
use crate::export::files::genotype;
use crate::ranks::threads::on_ranks;
use crate::run::begin::create;
use crate::run::evolve::continue_run;
use crate::run::experiment::Experiment;
use crate::run::laboratory::Laboratory;
use crate::run::plan::Plan;
use crate::run::record_file::{RunRecord, history};
use crate::strategy::definition::StrategyDefinition;
use crate::strategy::settings::{GENERATIONS as GENERATIONS_KEY, NORMALISE, POPULATION};
use crate::strategy::strategies;

const GENERATIONS: i64 = 6;
const SIZE: u32 = 8;
const TRIALS: u32 = 3;
const STEPS: usize = 10;

/// A perceptron has to detect which of two quantities of very different size is above its middle.
#[derive(Clone, Copy)]
struct Scales {
    strategy: &'static str,
    normalise: bool,
    populations: usize,
    /// True if outcomes have the observations.
    says: bool,
}

const SCALES: Scales = Scales { strategy: "open-ai-es", normalise: true, populations: 1, says: true };

/// The observations of a trial.
fn observed(id: EpisodeId) -> [[f32; 2]; STEPS] {
    let mut stream = Stream::new(id.seed, Domain::Start, id.trial, id.individual, id.generation);
    std::array::from_fn(|_| [stream.range(150.0, 250.0), stream.range(0.0, 0.002)])
}

/// An evaluation that fails.
fn fails(id: EpisodeId) -> bool {
    (id.generation, id.individual, id.trial) == (2, 1, 1)
}

impl Experiment for Scales {
    fn name(&self) -> &'static str {
        "scales"
    }
    fn summary(&self) -> &'static str {
        "one of two quantities is above its middle"
    }
    fn strategy(&self, _: &str) -> &'static dyn StrategyDefinition {
        *strategies().iter().find(|strategy| strategy.name() == self.strategy).unwrap()
    }
    fn settings(&self, _: &str) -> Vec<Setting> {
        vec![
            Setting::whole(GENERATIONS_KEY, GENERATIONS, 1..=100),
            Setting::whole(POPULATION, SIZE.into(), 1..=100),
            Setting::flag(NORMALISE, self.normalise),
        ]
    }
    fn prepare(&self, _: &str, _: &Settings) -> Result<Box<dyn Evaluator>, Error> {
        Ok(Box::new(*self))
    }
}

impl Task for Scales {
    fn info(&self) -> TaskInfo {
        TaskInfo {
            trials: TRIALS as usize,
            populations: (0..self.populations).map(|population| population.to_string()).collect(),
            observations: if self.strategy == "ars" && self.populations == 1 && !self.says { 0 } else { 2 },
            ..TaskInfo::new(
                ["first", "second", "bias"].map(|name| Parameter::new(name, [-5.0, 5.0])).into(),
                Schema::from_scalars(["output"]),
            )
        }
    }
}

impl Evaluator for Scales {
    fn evaluate(&mut self, evaluation: Evaluation<'_>, recorder: Option<&mut dyn Recorder>) -> Outcome {
        let Evaluation { parameters, normalisation, id, .. } = evaluation;
        let mut control = NormalizedController::new(Perceptron::new(2, 1, 1.0, parameters).unwrap());
        assert!(control.load(normalisation));
        let (mut y, mut sum) = ([0.0], 0.0);
        for x in observed(id) {
            control.step(&x, &mut y);
            let wanted: f32 = if (x[0] > 200.0) == (x[1] > 0.001) { 1.0 } else { 0.0 };
            sum -= f64::from((y[0] - wanted).abs());
        }
        if let Some(recorder) = recorder {
            recorder.scalars(&[y[0].into()]);
            recorder.tick(0.0);
        }
        if fails(id) {
            sum = f64::NAN;
        }
        let observed = control.observed().filter(|_| self.says).cloned();
        Outcome { terms: vec![sum], steps: STEPS as u32, observed, ..Outcome::default() }
    }
}

fn plan(scales: &Scales, generations: i64) -> Plan<'_> {
    let mut plan = Plan::new(scales, None, "").unwrap();
    plan.seed = 7;
    plan.settings.set("", GENERATIONS_KEY, Value::Whole(generations)).unwrap();
    plan
}

/// Means and sums of squares of all observations before a generation, in two passes.
fn by_hand(generation: u32) -> (u64, [f64; 2], [f64; 2]) {
    let mut all = Vec::new();
    for generation in 0..generation {
        for individual in 0..SIZE {
            let trial = |trial| EpisodeId { seed: 7, generation, individual, trial };
            if !(0..TRIALS).any(|number| fails(trial(number))) {
                all.extend((0..TRIALS).flat_map(|number| observed(trial(number))));
            }
        }
    }
    let mean = [0, 1].map(|i| all.iter().map(|x| f64::from(x[i])).sum::<f64>() / all.len().max(1) as f64);
    let squares = [0, 1].map(|i| all.iter().map(|x| f64::from(x[i]) - mean[i]).map(|x| x * x).sum());
    (all.len() as u64, mean, squares)
}

#[test]
fn a_generation_is_normalised_by_all_before_it() {
    let root = scratch("normalised");
    for strategy in ["open-ai-es", "pgpe", "ars"] {
        let scales = Scales { strategy, ..SCALES };
        let all = plan(&scales, GENERATIONS);
        let whole = create(&all, &root.join(strategy).join("whole")).unwrap();
        run(&all, &whole, 2);
        let (_, past, _) = history(&all, &whole).unwrap();
        for generation in 0..=GENERATIONS as u32 {
            let (count, mean, squares) = by_hand(generation);
            let found = past.normalisation(generation).unwrap();
            assert_eq!(found.count(), count, "generation {generation}");
            let near = |found: &[f64], expected: [f64; 2]| {
                found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() <= 1e-9 * expected.abs())
            };
            assert!(near(found.mean(), mean) && near(found.squares(), squares), "{found:?} {mean:?} {squares:?}");
        }
        assert!(past.normalisation(GENERATIONS as u32 + 1).is_none());
        // Each champion is replayed with the fitness that it had.
        for (generation, row) in rows(&whole).iter().enumerate() {
            let which = Selection { generation: Some(generation as u32), ..Selection::default() };
            let found = replay(&all, &whole, which, None, || Ok(Vec::new())).unwrap();
            assert_eq!(found.replay.fitness, row[1], "{strategy}: {}", found.summary);
        }
        // Stopped twice, on other threads.
        let parts = create(&plan(&scales, 1), &root.join(strategy).join("parts")).unwrap();
        for (generations, threads) in [(1, 3), (4, 1), (GENERATIONS, 2)] {
            run(&plan(&scales, generations), &parts, threads);
        }
        same(parts.path(), whole.path());
        // Missing champions are rebuilt with the normalization of their generation, even that of the first.
        let first = create(&plan(&scales, 1), &root.join(strategy).join("first")).unwrap();
        run(&plan(&scales, 1), &first, 1);
        for (generations, directory) in [(GENERATIONS, &whole), (1, &first)] {
            let champions = fs::read(directory.champion()).unwrap();
            fs::remove_file(directory.champion()).unwrap();
            run(&plan(&scales, generations), directory, 1);
            assert!(fs::read(directory.champion()).unwrap() == champions, "{strategy}: generation {generations}");
        }
    }
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn ranks_observe_what_one_process_does() {
    let root = scratch("normalised-ranks");
    let whole = create(&plan(&SCALES, GENERATIONS), &root.join("whole")).unwrap();
    run(&plan(&SCALES, GENERATIONS), &whole, 1);
    let on = |size: usize, generations: i64, place: &Path| {
        let results = on_ranks(size, |ranks| {
            part(ranks, &plan(&SCALES, generations), place, 1 + ranks.rank() % 2, &AtomicBool::new(false))
        });
        for result in results {
            result.unwrap();
        }
    };
    for size in [2, 4] {
        on(size, GENERATIONS, &root.join(size.to_string()));
        same(&root.join(size.to_string()), whole.path());
    }
    for (size, generations) in [(1, 2), (3, 4), (2, GENERATIONS)] {
        on(size, generations, &root.join("parts"));
    }
    same(&root.join("parts"), whole.path());
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn the_champion_is_tested_with_the_normalisation_of_its_generation() {
    let root = scratch("normalised-test");
    let plan = plan(&SCALES, GENERATIONS);
    let directory = create(&plan, &root).unwrap();
    run(&plan, &directory, 2);
    test::test(&plan, &directory, None, 5, 1, 2, LaneRequest::ONE, true).unwrap();
    check_archive(&plan, &directory);
    let text = fs::read_to_string(directory.test()).unwrap();
    let found: Vec<f64> = text.lines().skip(1).map(|line| line.split(',').nth(4).unwrap().parse().unwrap()).collect();
    let best = RunDirectory::open(&root, &Laboratory::new(&[&SCALES])).unwrap().champion().unwrap();
    let expected: Option<&ObservationStatistics> = best.normalisation.as_ref();
    assert_eq!(expected.unwrap().count(), by_hand(GENERATIONS as u32 - 1).0);
    let trial = |trial: usize, normalisation| {
        let id = crate::evaluation::trials::episode(trial, TRIALS as usize, 1);
        let evaluation = Evaluation { normalisation, ..Evaluation::new(&best.parameters[0], id) };
        SCALES.clone().evaluate(evaluation, None).terms[0]
    };
    for (number, found) in found.iter().enumerate() {
        assert_eq!(*found, trial(number, expected), "{text}");
        assert_ne!(*found, trial(number, None), "{text}");
    }
    // Genes alone are not the champion.
    let error = genotype(&plan, &directory, None).unwrap_err();
    assert!(error.to_string().contains("`strategy.normalise_observations`") && error.exit_code() == 2, "{error}");
    // A record without observations, or with those of other channels.
    let checkpoint = crate::run::records::Checkpoint::read(&plan, &directory).unwrap();
    let content = RunRecord::content(&plan, &directory, &checkpoint).unwrap();
    for short in [1, 24, 40] {
        let error = RunRecord::from_content(&plan, &directory, &checkpoint, content[..content.len() - short].to_vec());
        let error = error.map(|_| ()).unwrap_err().to_string();
        assert!(error.contains("generation 5: what was observed: "), "{error}");
    }
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn a_run_that_does_not_normalise_says_nothing_of_observations() {
    let root = scratch("not-normalised");
    let scales = Scales { normalise: false, ..SCALES };
    let plan = plan(&scales, GENERATIONS);
    let directory = create(&plan, &root).unwrap();
    run(&plan, &directory, 2);
    let (_, past, _) = history(&plan, &directory).unwrap();
    assert!(past.normalisation(0).is_none() && past.normalisation(3).is_none());
    genotype(&plan, &directory, None).unwrap();
    let best = RunDirectory::open(&root, &Laboratory::new(&[&scales])).unwrap().champion().unwrap();
    assert!(best.normalisation.is_none());
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn what_cannot_be_normalised_is_refused_before_there_is_a_folder() {
    let root = scratch("normalised-refused");
    let two = Scales { populations: 2, ..SCALES };
    let silent = Scales { strategy: "ars", says: false, ..SCALES };
    for (scales, why) in [
        (two, "`strategy.normalise_observations`: scales has 2 populations; it is for one"),
        (silent, "`strategy.normalise_observations`: scales does not say what its controllers observe"),
    ] {
        let error = create(&plan(&scales, 2), &root).map(|_| ()).unwrap_err();
        assert_eq!((error.to_string().as_str(), error.exit_code()), (why, 2));
        assert!(!root.exists());
    }
    // An experiment whose outcomes have no observations is refused.
    let forgets = Scales { says: false, ..SCALES };
    let plan = plan(&forgets, 2);
    let directory = create(&plan, &root).unwrap();
    let ended = continue_run(&plan, &directory, pool(&plan, 1), &AtomicBool::new(false), "farsa", true).unwrap_err();
    assert!(ended.to_string().ends_with("an outcome does not say what was observed"), "{ended}");
    fs::remove_dir_all(root).unwrap();
}
