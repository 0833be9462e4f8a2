//! Evaluations that panic, return NaN or do not end.

use std::fs;

use farsa_body::Recorder;
use farsa_num::{Domain, Stream};
use farsa_view::Schema;

use super::ranks::{part, same};
use super::{check_archive, pool, scratch};
use crate::error::Error;
use crate::evaluation::test;
use crate::experiment::episode::{Episode, EpisodeId, NoWorld};
use crate::experiment::evaluator::{Evaluation, Evaluator, Task, TaskInfo};
use crate::experiment::lanes::LaneRequest;
use crate::experiment::outcome::{Description, Outcome};
use crate::experiment::parameter::Parameter;
use crate::experiment::settings::{Setting, Settings, Value};
use crate::experiment::{InWorld, Rollout};
use crate::ranks::threads::on_ranks;
use crate::run::begin::create;
use crate::run::evolve::continue_run;
use crate::run::experiment::Experiment;
use crate::run::plan::Plan;
use crate::store::directory::Directory;
use crate::strategy::settings::{GENERATIONS, POPULATION};

const SIZE: usize = 20;
const TRIALS: u32 = 2;
const STEPS: u32 = 50;

/// The fault of a trial.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    None,
    Panics,
    NoNumber,
    Infinite,
    Endless,
}

impl Fault {
    /// The fault of one trial in twenty.
    fn of(id: EpisodeId) -> Self {
        let mut stream = Stream::new(id.seed, Domain::Start, id.trial, id.individual, id.generation);
        if stream.uniform_f64() >= 0.05 {
            return Self::None;
        }
        [Self::Panics, Self::NoNumber, Self::Infinite, Self::Endless][(stream.uniform_f64() * 4.0) as usize]
    }
}

/// Its fitness is its gene, in ten steps, unless a fault occurs.
#[derive(Clone)]
struct Faulty {
    id: EpisodeId,
    steps: u32,
    earned: f64,
    /// True if a step is half done: what panicked must not be used again.
    within: bool,
}

impl Experiment for Faulty {
    fn name(&self) -> &'static str {
        "faulty"
    }
    fn summary(&self) -> &'static str {
        "one evaluation in ten fails"
    }
    fn settings(&self, _: &str) -> Vec<Setting> {
        let size = i64::try_from(SIZE).unwrap();
        vec![Setting::whole(POPULATION, size, 1..=100), Setting::whole("evolution.parents", 5, 1..=100)]
    }
    fn prepare(&self, _: &str, _: &Settings) -> Result<Box<dyn Evaluator>, Error> {
        Ok(Box::new(InWorld::new(NoWorld, self.clone())))
    }
}

impl Task for Faulty {
    fn info(&self) -> TaskInfo {
        TaskInfo {
            description: Description { parameters: 1, steps: STEPS as usize, ..Description::default() },
            trials: TRIALS as usize,
            terms: vec!["gene".into()],
            ..TaskInfo::new(vec![Parameter::new("gene", [0.0, 1.0])], Schema::from_scalars(["step"]))
        }
    }
}

impl Episode<NoWorld> for Faulty {
    fn start(&mut self, _: &mut NoWorld, id: EpisodeId) {
        (self.id, self.steps) = (id, 0);
        assert!(!self.within, "an evaluator in which a trial panicked is used again");
    }
    fn act(&mut self, _: &mut NoWorld) {
        (self.steps, self.within) = (self.steps + 1, true);
        assert!(Fault::of(self.id) != Fault::Panics, "as planned");
        self.within = false;
    }
    fn judge(&mut self, _: &mut NoWorld) -> Option<f64> {
        (self.steps >= 10 && Fault::of(self.id) != Fault::Endless).then_some(self.earned)
    }
    fn record(&self, _: &NoWorld, recorder: &mut dyn Recorder) {
        recorder.scalars(&[f64::from(self.steps)]);
        recorder.tick(f64::from(self.steps));
    }
}

impl Rollout for Faulty {
    fn load(&mut self, evaluation: &Evaluation<'_>) -> bool {
        self.earned = f64::from(evaluation.parameters[0]);
        true
    }
    fn outcome(&self) -> Outcome {
        let term = match Fault::of(self.id) {
            Fault::NoNumber => f64::NAN,
            Fault::Infinite => f64::INFINITY,
            _ => self.earned,
        };
        Outcome { terms: vec![term], steps: self.steps, ..Outcome::default() }
    }
}

fn faulty() -> Faulty {
    Faulty { id: EpisodeId::default(), steps: 0, earned: 0.0, within: false }
}

fn plan(experiment: &Faulty, generations: i64) -> Plan<'_> {
    let mut plan = Plan::new(experiment, None, "").unwrap();
    plan.settings.set("", GENERATIONS, Value::Whole(generations)).unwrap();
    plan
}

/// The first failed trial of an evaluation, and its fault.
fn expected(generation: u32, individual: u32) -> Option<(u32, Fault)> {
    let of = |trial| Fault::of(EpisodeId { seed: 1, generation, individual, trial });
    (0..TRIALS).map(|trial| (trial, of(trial))).find(|(_, fault)| *fault != Fault::None)
}

fn run(generations: i64, threads: usize, directory: &Directory) {
    let (experiment, stop) = (faulty(), false.into());
    let plan = plan(&experiment, generations);
    continue_run(&plan, directory, pool(&plan, threads), &stop, "farsa", true).unwrap();
}

#[test]
fn a_thousand_generations_with_a_tenth_of_all_evaluations_failing() {
    let root = scratch("faults");
    let generations = 1000;
    let experiment = faulty();
    let mut all = Vec::new();
    for threads in [1, 2, 8] {
        let directory = create(&plan(&experiment, 1), &root.join(threads.to_string())).unwrap();
        // The run is interrupted, so that the log of failures is continued.
        run(generations / 3, threads, &directory);
        run(generations, threads, &directory);
        let files =
            [directory.log(), directory.failures(), directory.lineage(), directory.record(), directory.champion()];
        all.push(files.map(|path| fs::read(path).unwrap()));
    }
    assert!(all[0] == all[1] && all[1] == all[2], "the same bits on 1, 2 and 8 threads");
    let [log, failures, ..] = &all[0];
    let (log, failures) = (String::from_utf8_lossy(log), String::from_utf8_lossy(failures));
    let mut lines = failures.lines().skip(1);
    let (mut count, mut kinds) = (0, [0; 4]);
    for (generation, line) in (0..).zip(log.lines().skip(1)) {
        let failed = (0..SIZE as u32).filter_map(|individual| Some((individual, expected(generation, individual)?)));
        let failed: Vec<_> = failed.collect();
        assert_eq!(line.split(',').nth(5).unwrap().parse::<usize>(), Ok(failed.len()), "generation {generation}");
        assert!(!line.contains("NaN") && !line.contains("inf"), "{line}");
        for (individual, (trial, fault)) in failed {
            let found = lines.next().unwrap();
            assert!(found.starts_with(&format!("{generation},{individual},{trial},\"")), "{found}");
            let words = match fault {
                Fault::Panics => "panicked: as planned (",
                Fault::NoNumber => "the term `gene` of the fitness is NaN",
                Fault::Infinite => "the term `gene` of the fitness is inf",
                _ => "had not ended after 50 steps",
            };
            assert!(found.contains(words), "{found}: {fault:?}");
            kinds[[Fault::Panics, Fault::NoNumber, Fault::Infinite, Fault::Endless]
                .iter()
                .position(|f| *f == fault)
                .unwrap()] += 1;
            count += 1;
        }
    }
    assert_eq!(lines.next(), None);
    assert!((1700..2200).contains(&count) && kinds.iter().all(|kind| *kind > 350), "{count}: {kinds:?}");
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn evaluations_that_fail_on_any_rank_are_told_as_in_one_process() {
    let root = scratch("faults-ranks");
    let whole = create(&plan(&faulty(), 1), &root.join("whole")).unwrap();
    run(100, 2, &whole);
    let place = root.join("ranks");
    let results = on_ranks(3, |ranks| {
        let (experiment, stop) = (faulty(), false.into());
        part(ranks, &plan(&experiment, 100), &place, 1, &stop)
    });
    for result in results {
        result.unwrap();
    }
    same(&place, whole.path());
    assert!(fs::read_to_string(place.join("failures.csv")).unwrap().lines().count() > 100);
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn a_trial_of_a_test_that_breaks_says_why() {
    let root = scratch("faulty-test");
    let experiment = faulty();
    let directory = create(&plan(&experiment, 2), &root).unwrap();
    run(2, 1, &directory);
    let plan = plan(&experiment, 2);
    let found = test::test(&plan, &directory, None, 200, 3, 2, LaneRequest::ONE, true).unwrap().text(false);
    let line = found.lines().last().unwrap();
    assert!(line.starts_with("line ") && line.contains(" of the test failed: "), "{found}");
    assert!(directory.failures().is_file());
    check_archive(&plan, &directory);
    fs::remove_dir_all(root).unwrap();
}
