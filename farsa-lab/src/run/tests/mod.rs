//! Tests of complete runs with every strategy.

mod every_strategy;
mod faults;
mod files;
mod generalist;
mod large;
mod normalised;
mod own_strategy;
mod pool;
mod protocols;
mod ranks;
mod reference;

use std::collections::BTreeMap;
use std::fs;
use std::ops::Deref;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use farsa_body::Recorder;
use farsa_num::{Domain, Stream};
use farsa_view::Schema;

use crate::archive::{Archive, pack, restore};
use crate::error::Error;
use crate::evaluation::generations::{self, Sampling};
use crate::evaluation::replay::{ReplaySummary, Selection, replay};
use crate::evaluation::replayed::Replayed;
use crate::evaluation::test;
use crate::experiment::behavior::{Behavior, NotedBehavior};
use crate::experiment::episode::EpisodeId;
use crate::experiment::evaluator::{Evaluation, Evaluator, Iteration, Learner, Task, TaskInfo};
use crate::experiment::lanes::LaneRequest;
use crate::experiment::outcome::{Description, Outcome};
use crate::experiment::parameter::Parameter;
use crate::experiment::settings::{Setting, Settings, Value};
use crate::run::begin::create;
use crate::run::evolve::continue_run;
use crate::run::experiment::Experiment;
use crate::run::plan::Plan;
use crate::run::pool::Pool;
use crate::run::records::Best;
use crate::store::directory::Directory;
use crate::strategy::any_strategy::Genome;
use crate::strategy::definition::StrategyDefinition;
use crate::strategy::history::History;
use crate::strategy::settings::{GENERATIONS as GENERATIONS_KEY, POPULATION};
use crate::strategy::{Learning, OnePlusOne, Truncation};

const TRIALS: u32 = 3;
const SIZE: usize = 10;

/// Genes have to match numbers, alone and with noise, or the genes of others: population 0 seeks, the others flee.
#[derive(Clone, Copy)]
struct Numbers {
    strategy: &'static dyn StrategyDefinition,
    populations: usize,
}

const STEADY: Numbers = Numbers { strategy: &OnePlusOne, populations: 1 };
const LEARNER: Numbers = Numbers { strategy: &Learning, populations: 1 };
const CHASE_ALONE: Numbers = Numbers { strategy: &Truncation, populations: 1 };
const CHASE: Numbers = Numbers { strategy: &Truncation, populations: 3 };

impl Experiment for Numbers {
    fn name(&self) -> &'static str {
        "numbers"
    }
    fn summary(&self) -> &'static str {
        "genes are to match numbers"
    }
    fn strategy(&self, _: &str) -> &'static dyn StrategyDefinition {
        self.strategy
    }
    fn settings(&self, _: &str) -> Vec<Setting> {
        if !["truncation", "generalist"].contains(&self.strategy.name()) {
            return vec![Setting::text("numbers.file", "")];
        }
        let size = i64::try_from(SIZE).unwrap();
        if self.strategy.name() == "generalist" {
            let small = [(POPULATION, size), ("strategy.newcomers", 5), ("strategy.iterations", 3)];
            return small.map(|(key, value)| Setting::whole(key, value, 1..=100)).into();
        }
        vec![Setting::whole(POPULATION, size, 1..=100), Setting::whole("evolution.parents", 2, 1..=100)]
    }
    fn files(&self, _: &str, settings: &Settings) -> Result<Vec<PathBuf>, Error> {
        let file = settings.text("numbers.file").unwrap_or_default();
        Ok(if file.is_empty() { Vec::new() } else { vec![file.into()] })
    }
    fn prepare(&self, _: &str, _: &Settings) -> Result<Box<dyn Evaluator>, Error> {
        Ok(Box::new(*self))
    }
    fn gene_bits(&self) -> u32 {
        8
    }
}

impl Numbers {
    fn alone(genes: &[f32], id: EpisodeId) -> f64 {
        let noise = Stream::new(id.seed, Domain::Start, id.trial, id.individual, id.generation).uniform_f64();
        200.0 * noise - f64::from((genes[0] - 100.0).abs()) - f64::from((genes[1] - 7.0).abs())
    }

    fn against(genes: &[f32], opponents: &[&[f32]], population: usize) -> f64 {
        let misses = opponents.iter().map(|other| f64::from((genes[0] - other[0]).abs()));
        let sign = if population == 0 { -1.0 } else { 1.0 };
        misses.map(|miss| sign * miss).sum()
    }
}

/// Parameters are genes as they are.
fn plain(genes: &[u16]) -> Vec<f32> {
    genes.iter().copied().map(f32::from).collect()
}

impl Task for Numbers {
    fn info(&self) -> TaskInfo {
        TaskInfo {
            description: Description::default(),
            trials: TRIALS as usize,
            populations: (0..self.populations).map(|population| population.to_string()).collect(),
            ..TaskInfo::new(
                vec![Parameter::new("first", [0.0, 255.0]), Parameter::new("second", [0.0, 255.0])],
                Schema::from_scalars(["gene"]),
            )
        }
    }

    fn behavior(&self) -> Option<&dyn Behavior> {
        Some(&BEHAVIOUR)
    }
}

/// The second gene has to match another number, too. The genes are the behavior.
static BEHAVIOUR: NotedBehavior =
    NotedBehavior { objectives: &[("to 200", -1.0)], measures: &[("first", [0.0, 255.0]), ("second", [0.0, 255.0])] };

/// Moves integer genes half way to 100 and 7, with a small difference.
impl Learner for Numbers {
    fn initial_state(&self, _: u64) -> Vec<f64> {
        vec![0.0; 2]
    }
    fn iterate(&mut self, state: &mut [f64], seed: u64, generation: u32) -> Option<Iteration> {
        let beside = Stream::new(seed, Domain::Network, 0, 0, generation).uniform_f64();
        let [first, second] = state else { return None };
        let before = (100.0 - *first).abs();
        (*first, *second) = (0.5 * (*first + 100.0) + beside, 0.5 * (*second + 7.0));
        Some(Iteration { before, after: (100.0 - *first).abs(), successes: 1.0 })
    }
    fn learned(&self, state: &[f64]) -> Vec<f64> {
        state.iter().map(|value| value.floor()).collect()
    }
}

impl Evaluator for Numbers {
    fn evaluate(&mut self, evaluation: Evaluation<'_>, recorder: Option<&mut dyn Recorder>) -> Outcome {
        let Evaluation { parameters, opponents, id, .. } = evaluation;
        assert_eq!(opponents.len(), self.populations - 1);
        if let Some(recorder) = recorder {
            recorder.scalars(&[f64::from(opponents.first().unwrap_or(&parameters)[0])]);
            recorder.tick(0.0);
        }
        let notes = vec![
            ("to 200", f64::from((parameters[1] - 200.0).abs()).into()),
            ("first", f64::from(parameters[0]).into()),
            ("second", f64::from(parameters[1]).into()),
        ];
        if self.populations == 1 {
            return Outcome { terms: vec![Self::alone(parameters, id)], steps: 1, notes, ..Outcome::default() };
        }
        let fitness = Self::against(parameters, opponents, id.population(SIZE));
        Outcome { terms: vec![fitness], steps: 1, success: fitness >= 0.0, notes, ..Outcome::default() }
    }
    fn learner(&mut self) -> Option<&mut dyn Learner> {
        Some(self)
    }
}

/// A directory that does not exist yet, and is removed with everything in it at the end of a test.
struct Scratch(PathBuf);

impl Deref for Scratch {
    type Target = Path;

    fn deref(&self) -> &Path {
        &self.0
    }
}

impl AsRef<Path> for Scratch {
    fn as_ref(&self) -> &Path {
        self
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn scratch(name: &str) -> Scratch {
    let path = std::env::temp_dir().join(format!("farsa-search-{name}-{}", std::process::id()));
    let _ = fs::remove_dir_all(&path);
    Scratch(path)
}

fn plan(numbers: &Numbers, generations: i64) -> Plan<'_> {
    let mut plan = Plan::new(numbers, None, "").unwrap();
    plan.seed = 11;
    plan.settings.set("", GENERATIONS_KEY, Value::Whole(generations)).unwrap();
    plan
}

fn pool<'e>(plan: &Plan<'e>, threads: usize) -> Pool<'e> {
    Pool::new(plan, threads, LaneRequest::ONE).unwrap()
}

fn run(plan: &Plan<'_>, directory: &Directory, threads: usize) -> String {
    continue_run(plan, directory, pool(plan, threads), &AtomicBool::new(false), "farsa", true).unwrap().text()
}

/// Makes a complete run, and one with other numbers of threads that is stopped twice. Both must have the same files. Returns the first.
fn twice(numbers: &Numbers, root: &std::path::Path, generations: i64) -> Directory {
    let whole = plan(numbers, generations);
    let directory = create(&whole, &root.join("whole")).unwrap();
    let text = run(&whole, &directory, 2);
    let parts = create(&plan(numbers, 1), &root.join("parts")).unwrap();
    for (generations, threads) in [(1, 3), (generations / 2, 1), (generations, 2)] {
        let said = run(&plan(numbers, generations), &parts, threads);
        assert_eq!(said.split_once(": ").unwrap().1 == text.split_once(": ").unwrap().1, threads == 2, "{said} {text}");
    }
    for name in ["config.toml", "fitness.csv", "champion.bin", "record.bin", "checkpoint.bin", "lineage.csv"] {
        let read = |run: &str| fs::read(root.join(run).join(name)).ok();
        assert!(read("whole") == read("parts"), "{name}");
        assert_eq!(read("whole").is_some(), name != "lineage.csv" || numbers.strategy.name() != "learning", "{name}");
    }
    directory
}

/// The genes of an individual of a finished generation, rebuilt.
fn genes_of(history: &History<'_>, generation: u32, individual: usize) -> Vec<u16> {
    match history.genomes(&[(generation, individual)]).unwrap().remove(0) {
        Genome::Words(genes) => genes,
        Genome::Reals(_) => panic!("reals"),
    }
}

fn words(best: &Best) -> &Vec<u16> {
    match &best.genes {
        Genome::Words(genes) => genes,
        Genome::Reals(_) => panic!("reals"),
    }
}

/// Generation, individual and parents of each line of `lineage.csv`.
fn lineage(directory: &Directory) -> Vec<(u32, usize, Vec<usize>)> {
    let text = fs::read_to_string(directory.lineage()).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("generation,individual,parents"));
    let line = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        let parents = fields[2].split(' ').map(|parent| parent.parse().unwrap()).collect();
        (fields[0].parse().unwrap(), fields[1].parse().unwrap(), parents)
    };
    lines.map(line).collect()
}

fn rows(directory: &Directory) -> Vec<Vec<f64>> {
    let log = fs::read_to_string(directory.log()).unwrap();
    log.lines().skip(1).map(|line| line.split(',').map(|field| field.parse().unwrap()).collect()).collect()
}

/// Checks the tests of every third generation by tests of single individuals, and that an archive restores every visible file.
fn check_archive(plan: &Plan<'_>, directory: &Directory) {
    let sampling = Sampling { every: 3, trials: 4, seed: 1 };
    generations::test(&AtomicBool::new(false), plan, directory, sampling, (2, LaneRequest::ONE), true).unwrap();
    let tests = generations::read(directory).unwrap().unwrap();
    assert_eq!(tests.rows.len(), (plan.generations().unwrap() as usize).div_ceil(3));
    for row in &tests.rows {
        let which = Selection { generation: Some(row.generation), ..Selection::default() };
        let single = test::test(plan, directory, Some(which), 4, 1, 2, LaneRequest::ONE, true).unwrap().findings;
        let at = row.generation as usize;
        let found = [tests.success(at), tests.fitness(at)];
        assert_eq!(format!("{found:?}"), format!("{:?}", [single.rate, single.fitness]), "{} {at}", plan.name());
    }
    let files = |directory: &Path| {
        let entries = fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().path());
        let visible = |path: &PathBuf| !path.file_name().unwrap().to_string_lossy().starts_with('.');
        let name = |path: PathBuf| (path.file_name().unwrap().to_owned(), fs::read(&path).unwrap());
        entries.filter(visible).map(name).collect::<BTreeMap<_, _>>()
    };
    let folder = tempfile::tempdir().unwrap();
    let runs = [("run".to_owned(), pack(plan, directory).unwrap().unwrap())].into();
    Archive { runs }.unpack(folder.path()).unwrap();
    let restored = Directory::open(&folder.path().join("run")).unwrap();
    restore(plan, &restored).unwrap();
    let [expected, found] = [directory, &restored].map(|directory| files(directory.path()));
    assert!(found.keys().eq(expected.keys()), "{:?} instead of {:?}", found.keys(), expected.keys());
    for (name, bytes) in &expected {
        assert!(found[name] == *bytes, "{}: {}", plan.name(), name.display());
    }
}

fn replayed(plan: &Plan<'_>, directory: &Directory, which: Selection) -> (String, Replayed<ReplaySummary>) {
    let mut out = Vec::new();
    let found = replay(plan, directory, which, None, || Ok(&mut out)).unwrap();
    (String::from_utf8(out).unwrap(), found)
}
