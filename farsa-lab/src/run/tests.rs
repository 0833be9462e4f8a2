//! Tests of whole runs by every search: what is selected, written, resumed and lived again.

use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use farsa_body::Recorder;
use farsa_num::{Domain, Stream};
use farsa_view::Stage;

use crate::error::Error;
use crate::evaluation::replay::{Which, replay};
use crate::evaluation::test;
use crate::experiment::definition::Experiment;
use crate::experiment::episode::EpisodeId;
use crate::experiment::evaluator::{Evaluation, Evaluator, Learner, Lesson, Parameter, Task};
use crate::experiment::lanes::Wanted;
use crate::experiment::outcome::{Description, Outcome};
use crate::experiment::search_kind::Search;
use crate::experiment::settings::{Setting, Settings, Value};
use crate::run::bench::{Sample, bench};
use crate::run::evolve::{create, go_on};
use crate::run::plan::Plan;
use crate::run::pool::Pool;
use crate::run::records::{Ancestry, Champions};
use crate::search::engine::Descent;
use crate::search::evolution;
use crate::store::directory::Directory;

const TRIALS: u32 = 3;
const SIZE: usize = 10;

/// Genes are to match numbers, alone and with noise, or those of others: population 0 seeks, the others flee.
#[derive(Clone, Copy)]
struct Numbers {
    search: Search,
    populations: usize,
}

const STEADY: Numbers = Numbers { search: Search::OnePlusOne, populations: 1 };
const LEARNER: Numbers = Numbers { search: Search::Learning, populations: 1 };
const CHASE: Numbers = Numbers { search: Search::Truncation, populations: 3 };

impl Experiment for Numbers {
    fn name(&self) -> &'static str {
        "numbers"
    }
    fn summary(&self) -> &'static str {
        "genes are to match numbers"
    }
    fn search(&self, _: &str) -> Search {
        self.search
    }
    fn settings(&self, _: &str) -> Vec<Setting> {
        if self.search != Search::Truncation {
            return vec![Setting::text("numbers.file", "")];
        }
        let size = i64::try_from(SIZE).unwrap();
        vec![Setting::whole(evolution::POPULATION, size, 1..=100), Setting::whole("evolution.parents", 2, 1..=100)]
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
    fn parameters(&self) -> Vec<Parameter> {
        vec![Parameter::new("first", [0.0, 255.0]), Parameter::new("second", [0.0, 255.0])]
    }
    fn populations(&self) -> Vec<String> {
        (0..self.populations).map(|population| population.to_string()).collect()
    }
    fn trials(&self) -> usize {
        TRIALS as usize
    }
    fn stage(&self) -> Stage {
        Stage::of_scalars(["gene"])
    }
    fn description(&self) -> Description {
        Description::default()
    }
}

/// Words half way from where they are to 100 and 7, and a little beside it.
impl Learner for Numbers {
    fn first_words(&self, _: u64) -> Vec<f64> {
        vec![0.0; 2]
    }
    fn lesson(&mut self, words: &mut [f64], seed: u64, generation: u32) -> Option<Lesson> {
        let beside = Stream::new(seed, Domain::Network, 0, 0, generation).uniform_f64();
        let [first, second] = words else { return None };
        let before = (100.0 - *first).abs();
        (*first, *second) = (0.5 * (*first + 100.0) + beside, 0.5 * (*second + 7.0));
        Some(Lesson { before, after: (100.0 - *first).abs(), successes: 1.0 })
    }
    fn learned(&self, words: &[f64]) -> Vec<u16> {
        words.iter().map(|word| *word as u16).collect()
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
        if self.populations == 1 {
            return Outcome { terms: vec![Self::alone(parameters, id)], steps: 1, ..Outcome::default() };
        }
        let fitness = Self::against(parameters, opponents, id.population(SIZE));
        Outcome { terms: vec![fitness], steps: 1, success: fitness >= 0.0, ..Outcome::default() }
    }
    fn learner(&mut self) -> Option<&mut dyn Learner> {
        Some(self)
    }
}

fn scratch(name: &str) -> PathBuf {
    let path = std::env::temp_dir().join(format!("farsa-search-{name}-{}", std::process::id()));
    let _ = fs::remove_dir_all(&path);
    path
}

fn plan(numbers: &Numbers, generations: i64) -> Plan<'_> {
    let mut plan = Plan::new(numbers, None, "").unwrap();
    plan.seed = 11;
    plan.settings.set("", evolution::GENERATIONS, Value::Whole(generations)).unwrap();
    plan
}

fn pool(plan: &Plan<'_>, threads: usize) -> Pool {
    Pool::new(plan, threads, Wanted::ONE).unwrap()
}

fn run(plan: &Plan<'_>, directory: &Directory, threads: usize) -> String {
    go_on(plan, directory, pool(plan, threads), &AtomicBool::new(false), "farsa", true).unwrap().text()
}

/// A whole run, and one of other threads that was stopped twice, which must have the same files; returns the first.
fn twice(numbers: &Numbers, root: &std::path::Path, generations: i64) -> Directory {
    let whole = plan(numbers, generations);
    let directory = create(&whole, &root.join("whole")).unwrap();
    let text = run(&whole, &directory, 2);
    let parts = create(&plan(numbers, 1), &root.join("parts")).unwrap();
    for (generations, threads) in [(1, 3), (generations / 2, 1), (generations, 2)] {
        let said = run(&plan(numbers, generations), &parts, threads);
        assert_eq!(said.split_once(": ").unwrap().1 == text.split_once(": ").unwrap().1, threads == 2, "{said} {text}");
    }
    for name in ["config.toml", "fitness.csv", "champion.bin", "lineage.bin", "checkpoint.bin"] {
        let read = |run: &str| fs::read(root.join(run).join(name)).unwrap();
        assert!(read("whole") == read("parts"), "{name}");
    }
    directory
}

fn rows(directory: &Directory) -> Vec<Vec<f64>> {
    let log = fs::read_to_string(directory.log()).unwrap();
    log.lines().skip(1).map(|line| line.split(',').map(|field| field.parse().unwrap()).collect()).collect()
}

fn replayed(plan: &Plan<'_>, directory: &Directory, which: Which) -> (String, String) {
    let mut out = Vec::new();
    let summary = replay(plan, directory, which, &mut out).unwrap().summary;
    (String::from_utf8(out).unwrap(), summary)
}

#[test]
fn a_steady_state_keeps_the_better_of_two() {
    const GENERATIONS: i64 = 120;
    let root = scratch("steady");
    let directory = twice(&STEADY, &root, GENERATIONS);
    let plan = plan(&STEADY, GENERATIONS);
    let (Ancestry { descent, .. }, _) = Ancestry::read(&plan, &directory).unwrap();
    let rows = rows(&directory);
    assert_eq!((rows.len(), descent.finished()), (120, 120));
    // By hand: every evaluation of the parent so far, the one as a mutant included, against the mutant's own.
    let mut life: Vec<f64> = Vec::new();
    let (mut replaced, mut longest) = (0, 0);
    for (generation, row) in (0..).zip(&rows) {
        let earned = |individual: usize| {
            let genes = descent.genome_of(generation, individual).unwrap();
            assert!(genes.iter().all(|&gene| gene < 256));
            let trial = |trial| EpisodeId { seed: 11, generation, individual: individual as u32, trial };
            (0..TRIALS).map(|t| Numbers::alone(&plain(&genes), trial(t))).sum::<f64>()
        };
        life.push(earned(0));
        longest = longest.max(life.len());
        let (parent, mutant) = (life.iter().sum::<f64>() / life.len() as f64, earned(1));
        let survivor = usize::from(mutant >= parent);
        assert_eq!(descent.champion(0, generation), Some(survivor), "generation {generation}");
        let (best, worst) = (parent.max(mutant), parent.min(mutant));
        for (found, expected) in row[1..4].iter().zip([best, f64::midpoint(best, worst), worst]) {
            assert!((found - expected).abs() < 1e-9 * expected.abs().max(1.0), "{row:?} {expected}");
        }
        assert_eq!(row[4..], [2.0, 0.0]);
        if survivor == 1 {
            (life, replaced) = (vec![mutant], replaced + 1);
        }
    }
    assert!(replaced > 3 && longest > 5, "{replaced} {longest}");
    // The champion is the survivor with the fitness of its whole life, and the life that is seen again is its own.
    let Champions { generation, best, .. } = Champions::read(&plan, &directory).unwrap();
    let survivor = descent.champion(0, 119).unwrap();
    assert_eq!((generation, best.len(), best[0].individual as usize), (119, 1, survivor));
    assert_eq!(best[0].genes, descent.genome_of(119, survivor).unwrap());
    assert_eq!(best[0].fitness.get(), rows[119][1]);
    let (csv, summary) = replayed(&plan, &directory, Which::default());
    assert!(summary.starts_with(&format!("individual {survivor} of generation 119, 3 trials")), "{summary}");
    assert_eq!(csv.lines().nth(1).unwrap(), format!("0,0,0.0,{:?}", f64::from(best[0].genes[0])));
    assert!(replay(&plan, &directory, Which { individual: Some(2), ..Which::default() }, &mut Vec::new()).is_err());
    let table = test::test(&plan, &directory, 7, 1, 2, Wanted::ONE, true).unwrap().text();
    assert!(table.contains(&format!("individual {survivor} of generation 119")), "{table}");
    // Nothing but the truncation algorithm has a population to set.
    let mut plan = plan;
    let error = plan.settings.set("--population", evolution::POPULATION, Value::Whole(9)).unwrap_err();
    assert!(error.to_string().contains("unknown key `evolution.population`"), "{error}");
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn a_learner_lives_and_takes_lessons() {
    const GENERATIONS: i64 = 12;
    let root = scratch("learner");
    let directory = twice(&LEARNER, &root, GENERATIONS);
    let read = |run: &str| fs::read_to_string(root.join(run).join("learning.csv")).unwrap();
    assert_eq!(read("whole"), read("parts"));
    let plan = plan(&LEARNER, GENERATIONS);
    let (Ancestry { descent, .. }, _) = Ancestry::read(&plan, &directory).unwrap();
    // By hand: the life of a generation is that of the words before its lesson.
    let (mut evaluator, mut words) = (LEARNER, LEARNER.first_words(11));
    let mut curve = String::from("generation,error before,error after,successes\n");
    for (generation, row) in (0..12_u32).zip(rows(&directory)) {
        let genes = LEARNER.learned(&words);
        assert_eq!(descent.genome_of(generation, 0).unwrap(), genes);
        assert_eq!(descent.champion(0, generation), Some(0));
        let earned = |trial| Numbers::alone(&plain(&genes), EpisodeId { seed: 11, generation, individual: 0, trial });
        let fitness: f64 = (0..TRIALS).map(earned).sum();
        assert_eq!(row[1..], [fitness, fitness, fitness, 1.0, 0.0]);
        let Lesson { before, after, .. } = evaluator.lesson(&mut words, 11, generation).unwrap();
        writeln!(curve, "{generation},{before:?},{after:?},1.0").unwrap();
    }
    assert_eq!(read("whole"), curve);
    // What is known after the last lesson waits for its life; the champion is who lived last.
    assert_eq!(descent.genome_of(12, 0).unwrap(), LEARNER.learned(&words));
    assert!(descent.genome_of(13, 0).is_err() && descent.genome_of(3, 1).is_err() && descent.champion(0, 12).is_none());
    let Champions { generation, best, .. } = Champions::read(&plan, &directory).unwrap();
    assert_eq!((generation, &best[0].genes), (11, &descent.genome_of(11, 0).unwrap()));
    let (csv, _) = replayed(&plan, &directory, Which { generation: Some(0), ..Which::default() });
    assert_eq!(csv.lines().nth(1).unwrap(), "0,0,0.0,0.0");
    let table = test::test(&plan, &directory, 7, 1, 2, Wanted::ONE, true).unwrap().text();
    assert!(table.contains("individual 0 of generation 11"), "{table}");
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn populations_meet_each_others_champions() {
    const GENERATIONS: i64 = 9;
    let root = scratch("chase");
    let directory = twice(&CHASE, &root, GENERATIONS);
    let plan = plan(&CHASE, GENERATIONS);
    let (Ancestry { descent, .. }, _) = Ancestry::read(&plan, &directory).unwrap();
    let rows = rows(&directory);
    // Of three trials two are against the last two champions, one against that in the middle of all before.
    let rule = |generation: u32, trial: u32| match trial {
        0 | 1 => generation.checked_sub(1 + trial),
        _ => (generation > 2).then(|| (generation - 2) / 2),
    };
    // By hand: everyone's fitness against whom the rule names, and the best of each population.
    for (generation, row) in (0..9_u32).zip(&rows) {
        let genes = |generation, individual| descent.genome_of(generation, individual).unwrap();
        let fitness = |individual: usize| {
            let own = individual / SIZE;
            let trial = |trial: u32| {
                let others: Vec<Vec<f32>> = (0..3)
                    .filter(|other| *other != own)
                    .map(|other| {
                        plain(&rule(generation, trial).map_or_else(
                            || genes(generation, other * SIZE + trial as usize),
                            |earlier| genes(earlier, descent.champion(other, earlier).unwrap()),
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
            assert_eq!(descent.champion(population, generation), Some(population * SIZE + first));
            assert_eq!([row[6 + 3 * population], row[8 + 3 * population]], [best, worst], "generation {generation}");
        }
        assert_eq!(row[1], all.iter().copied().fold(f64::NEG_INFINITY, f64::max));
        assert_eq!(row[4], 30.0);
        // A life is seen again against the same opponents.
        for individual in [0, 14, 29] {
            let which = Which { generation: Some(generation), individual: Some(individual), trial: None };
            let (_, summary) = replayed(&plan, &directory, which);
            assert!(summary.ends_with(&format!("fitness {:?}", all[individual as usize])), "{summary}");
            let (one, _) = replayed(&plan, &directory, Which { trial: Some(2), ..which });
            let other = usize::from(individual < 10);
            let met = match rule(generation, 2) {
                Some(earlier) => genes(earlier, descent.champion(other, earlier).unwrap()),
                None => genes(generation, other * SIZE + 2),
            };
            assert_eq!(one.lines().nth(1).unwrap(), format!("2,0,0.0,{:?}", f64::from(met[0])));
        }
    }
    let Champions { best, .. } = Champions::read(&plan, &directory).unwrap();
    let individuals: Vec<_> = best.iter().map(|best| best.individual as usize).collect();
    assert_eq!(individuals, (0..3).map(|p| descent.champion(p, 8).unwrap()).collect::<Vec<_>>());

    // A test lets the champions live against each other, and tells of every population.
    let exam = test::test(&plan, &directory, 4, 1, 2, Wanted::ONE, true).unwrap();
    let text = exam.text();
    assert!(text.contains(" of generation 8 against each other"), "{text}");
    let csv = fs::read_to_string(directory.test()).unwrap();
    let [a, b, c] = [0, 1, 2].map(|p| f64::from(best[p].genes[0]));
    let head = "index,trial,steps,success,fitness,fitness of population 1,success of population 1,\
                fitness of population 2,success of population 2";
    let (seeker, first, second) =
        (-(a - b).abs() - (a - c).abs(), (b - a).abs() + (b - c).abs(), (c - a).abs() + (c - b).abs());
    assert_eq!(csv.lines().next(), Some(head));
    assert_eq!(csv.lines().nth(2).unwrap(), format!("1,1,1,{},{seeker:?},{first:?},1,{second:?},1", seeker >= 0.0));
    assert_eq!(csv.lines().count(), 5);
    assert_eq!(text, test::test(&plan, &directory, 4, 1, 1, Wanted::ONE, true).unwrap().text());
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn lives_of_every_search_can_be_measured() {
    let root = scratch("bench");
    for (numbers, lives) in [(STEADY, 2 * TRIALS), (LEARNER, TRIALS), (CHASE, 30 * TRIALS)] {
        let plan = plan(&numbers, 2);
        let directory = create(&plan, &root.join(format!("{:?}-{}", numbers.search, numbers.populations))).unwrap();
        run(&plan, &directory, 1);
        for sample in [Sample::random(&plan), Sample::of_run(&plan, &directory)] {
            let told = serde_json::to_value(bench(&plan, &sample.unwrap(), pool(&plan, 2), 1e-3).unwrap()).unwrap();
            let rounds = told["rounds"].as_u64().unwrap();
            assert!(rounds == 0 || told["lives"].as_u64().unwrap() >= rounds * u64::from(lives), "{told}");
            assert!(told["lives"].as_u64().unwrap() > 0, "{told}");
        }
    }
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn a_run_knows_the_files_that_it_was_made_with() {
    let root = scratch("files");
    fs::create_dir_all(&root).unwrap();
    let file = root.join("numbers \"one\".txt");
    let plan = |generations| {
        let mut plan = plan(&STEADY, generations);
        plan.settings.set("", "numbers.file", Value::Word(file.display().to_string())).unwrap();
        plan
    };
    let refused = |words: &str| {
        let (five, directory) = (plan(5), Directory::open(&root.join("run")).unwrap());
        let errors = [
            go_on(&five, &directory, pool(&five, 1), &AtomicBool::new(false), "farsa", true).unwrap_err(),
            replay(&five, &directory, Which::default(), &mut Vec::new()).unwrap_err(),
            test::test(&five, &directory, 1, 1, 1, Wanted::ONE, true).unwrap_err(),
        ];
        for error in errors.map(|error| error.to_string()) {
            assert!(error.contains(words) && error.contains("numbers \"one\".txt"), "{error}");
        }
    };
    assert!(create(&plan(3), &root.join("run")).is_err() && !root.join("run").exists());
    fs::write(&file, "1 2 3").unwrap();
    let directory = create(&plan(3), &root.join("run")).unwrap();
    run(&plan(3), &directory, 1);
    assert!(fs::read_to_string(directory.manifest()).unwrap().contains("\"files\""));
    fs::write(&file, "1 2 4").unwrap();
    refused("is another file than the run in ");
    fs::remove_file(&file).unwrap();
    refused("cannot read ");
    fs::write(&file, "1 2 3").unwrap();
    run(&plan(5), &directory, 1);
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn the_search_of_a_run_stays_what_it_was() {
    let root = scratch("other");
    let steady = create(&plan(&STEADY, 3), &root.join("steady")).unwrap();
    run(&plan(&STEADY, 3), &steady, 1);
    // The same experiment, by name, with another search or more populations.
    for other in [Numbers { search: Search::Truncation, populations: 1 }, CHASE] {
        let mut plan = plan(&other, 5);
        plan.settings.set("", "evolution.mutation", Value::Word("flip".into())).unwrap();
        let error = go_on(&plan, &steady, pool(&plan, 1), &AtomicBool::new(false), "farsa", true).unwrap_err();
        assert!(error.to_string().contains("checkpoint.bin: its genomes are not those"), "{error}");
    }
    let steady_populations = Numbers { populations: 2, ..STEADY };
    let error = create(&plan(&steady_populations, 3), &root.join("none")).unwrap_err();
    assert!(error.to_string().contains("steady-state search of several populations"), "{error}");
    assert!(!root.join("none").exists());
    let mut rising = plan(&STEADY, 3);
    rising.settings.set("", "evolution.last_rate", Value::Number(0.75)).unwrap();
    let error = create(&rising, &root.join("none")).unwrap_err().to_string();
    assert_eq!(error, "`evolution.last_rate`: a mutation rate cannot fall from 0.5 to 0.75");
    assert!(matches!(Ancestry::read(&plan(&STEADY, 3), &steady).unwrap().0.descent, Descent::OnePlusOne(_)));
    fs::remove_dir_all(root).unwrap();
}
