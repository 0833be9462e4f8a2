//! `farsa bench`: measures trials per second and estimates the duration of a study.

use std::fmt::Write as _;
use std::fs;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

use serde::Serialize;

use crate::error::Error;
use crate::experiment::episode::EpisodeId;
use crate::experiment::lanes::LanesInfo;
use crate::experiment::outcome::{Failure, Outcome};
use crate::run::evaluation_backend::Unfinished;
use crate::run::fitness::{Generation, Opponents, run_generation};
use crate::run::plan::Plan;
use crate::run::pool::Pool;
use crate::run::sample::Sample;
use crate::store::manifest::Machine;

/// Runs of a study.
const REPLICATIONS: u64 = 20;
/// Cores of the larger machine in the estimate.
const MANY: usize = 64;

/// Measurement and estimate.
#[derive(Debug, Serialize)]
pub(crate) struct Bench {
    experiment: String,
    condition: String,
    /// Run of the genomes, `None` for random ones.
    run: Option<String>,
    /// Generation of the genomes.
    generation: u32,
    genomes: usize,
    /// Finished generations.
    rounds: u32,
    /// Finished trials.
    trials: u64,
    /// Steps of finished and interrupted trials.
    steps: u64,
    seconds: f64,
    threads: usize,
    #[serde(flatten)]
    lanes: LanesInfo,
    machine: Machine,
    cores: usize,
    /// Share of time in which the threads had a core and work, where the system reports it.
    busy: Option<f64>,
    steps_per_second: f64,
    /// Rate for each core that the threads can have had.
    steps_per_second_and_core: f64,
    trials_per_second_and_core: f64,
    study: Study,
    /// Estimate with as many cores as in the measurement.
    generations_per_hour: f64,
    predictions: Vec<Prediction>,
}

/// Size of a study.
#[derive(Debug, Clone, Copy, Serialize)]
struct Study {
    replications: u64,
    generations: u64,
    population: u64,
    trials: u64,
    /// Largest number of steps of a trial, or the measured mean if the experiment has none.
    steps: f64,
    control_steps: f64,
}

/// Estimated duration of the study.
#[derive(Debug, Clone, Copy, Serialize)]
struct Prediction {
    cores: usize,
    seconds: f64,
}

/// Steps of some trials.
#[derive(Default)]
struct Counts {
    /// Trials that were not interrupted, and their steps.
    trials: AtomicU64,
    steps: AtomicU64,
    /// Interrupted trials, and their steps.
    interrupted: AtomicU64,
    cut: AtomicU64,
    /// Finished generations.
    rounds: u32,
}

impl Counts {
    /// Evaluates complete generations for some time. Interrupts the first one if it takes longer.
    fn new(sample: &Sample, pool: &mut Pool, limit: Duration) -> Result<Self, Error> {
        let Sample { parameters, seed, generation, .. } = sample;
        let opponents: Vec<&[f32]> = sample.opponents.iter().map(Vec::as_slice).collect();
        let opponents = Opponents { parameters: &opponents, each: sample.populations - 1, told_apart: None };
        // The evaluator owns the trials in its lanes, so no shorter borrow fits.
        let stop: &'static AtomicBool = Box::leak(Box::default());
        let mut counts = Self::default();
        let started = Instant::now();
        thread::scope(|scope| {
            let (finished, first) = channel::<()>();
            let timer = move || {
                if first.recv_timeout(limit) == Err(RecvTimeoutError::Timeout) {
                    stop.store(true, Ordering::Relaxed);
                }
            };
            let timer = thread::Builder::new().spawn_scoped(scope, timer);
            timer.map_err(|error| Error::Other(format!("cannot start a thread: {error}")))?;
            let mut finished = Some(finished);
            while counts.rounds == 0 || started.elapsed() < limit {
                let generation = generation.saturating_add(counts.rounds);
                let id = EpisodeId { seed: *seed, generation, ..EpisodeId::default() };
                let batch = Generation { parameters, opponents, normalisation: None, id, stop: Some(stop) };
                match run_generation(&mut pool.until(stop), batch, |outcome| counts.add(outcome)) {
                    Ok(_) => counts.rounds += 1,
                    Err(Unfinished::Stopped) => break,
                    Err(Unfinished::Error(error)) => return Err(error),
                }
                // The next generation is evaluated to its end.
                finished.take();
                if stop.load(Ordering::Relaxed) {
                    break;
                }
            }
            Ok(())
        })?;
        Ok(counts)
    }

    fn add(&self, outcome: Option<&Outcome>) {
        let Some(outcome) = outcome else { return };
        let steps = u64::from(outcome.steps);
        if outcome.failure == Some(Failure::Interrupted) {
            self.interrupted.fetch_add(1, Ordering::Relaxed);
            self.cut.fetch_add(steps, Ordering::Relaxed);
        } else {
            self.trials.fetch_add(1, Ordering::Relaxed);
            self.steps.fetch_add(steps, Ordering::Relaxed);
        }
    }

    /// Computes the mean number of steps of a trial. The trials that end before a cut are the short ones, so without a
    /// complete generation it is the largest number of steps, if there is one.
    fn mean_steps(&self, longest: usize) -> f64 {
        let [trials, steps, interrupted, cut] =
            [&self.trials, &self.steps, &self.interrupted, &self.cut].map(|count| count.load(Ordering::Relaxed) as f64);
        match (self.rounds, longest) {
            (0, 0) => (steps + cut) / (trials + interrupted),
            (0, longest) => longest as f64,
            _ => steps / trials,
        }
    }
}

/// Evaluates complete generations, as a run does, for some seconds. A first generation that takes longer is cut.
///
/// # Errors
/// [`Error::Other`], also if no step was evaluated.
pub(crate) fn bench(plan: &Plan<'_>, sample: &Sample, mut pool: Pool, seconds: f64) -> Result<Bench, Error> {
    let Sample { parameters, generation, run, .. } = sample;
    let (started, used) = (Instant::now(), processor_seconds());
    let counts = Counts::new(sample, &mut pool, Duration::from_secs_f64(seconds))?;
    let elapsed = started.elapsed().as_secs_f64();
    let used = used.zip(processor_seconds()).map(|(before, after)| after - before);

    let mean = counts.mean_steps(pool.info().description.steps);
    let Counts { trials, steps, cut, rounds, .. } = counts;
    let (trials, steps) = (trials.into_inner(), steps.into_inner() + cut.into_inner());
    if steps == 0 {
        return Err(Error::Other(format!("{}: none of {trials} trials had a step", plan.experiment.name())));
    }
    let machine = Machine::here();
    let (threads, cores) = (pool.threads(), machine.cores());
    let had = threads.min(cores);
    let steps_per_second = steps as f64 / elapsed;
    let per_core = steps_per_second / had as f64;
    let study = Study::new(plan, &pool, parameters.len(), mean)?;
    let predict = |cores: usize| Prediction { cores, seconds: study.control_steps / (per_core * cores as f64) };
    Ok(Bench {
        experiment: plan.experiment.name().into(),
        condition: plan.condition.clone(),
        run: run.clone(),
        generation: *generation,
        genomes: parameters.len(),
        rounds,
        trials,
        steps,
        seconds: elapsed,
        threads,
        lanes: pool.lanes().info(),
        machine,
        cores,
        busy: used.map(|used| (used / (elapsed * had as f64)).min(1.0)),
        steps_per_second,
        steps_per_second_and_core: per_core,
        trials_per_second_and_core: per_core / mean,
        generations_per_hour: 3600.0 * steps_per_second / study.steps_of_generation(),
        predictions: vec![predict(cores), predict(MANY)],
        study,
    })
}

impl Study {
    /// Returns the study of a plan. `mean` is the mean number of steps of a trial.
    fn new(plan: &Plan<'_>, pool: &Pool, population: usize, mean: f64) -> Result<Self, Error> {
        let most = pool.info().description.steps;
        let study = Self {
            replications: REPLICATIONS,
            generations: plan.generations()?.into(),
            population: population as u64,
            trials: pool.info().trials as u64,
            steps: if most == 0 { mean } else { most as f64 },
            control_steps: 0.0,
        };
        let runs = (study.replications * study.generations) as f64;
        Ok(Self { control_steps: runs * study.steps_of_generation(), ..study })
    }

    fn steps_of_generation(&self) -> f64 {
        (self.population * self.trials) as f64 * self.steps
    }
}

impl Bench {
    /// Formats the measurement as a table.
    pub(crate) fn text(&self) -> String {
        let Self { experiment, condition, genomes, generation, rounds, trials, steps, seconds, threads, .. } = self;
        let mut text = String::new();
        let genomes = match &self.run {
            None => format!("{genomes} random genomes"),
            Some(run) => format!("the {genomes} genomes of generation {generation} of {run}"),
        };
        let rounds = match rounds {
            0 => "a part of one generation".into(),
            1 => "one generation".into(),
            rounds => format!("{rounds} generations"),
        };
        let lanes = match &self.lanes {
            LanesInfo { lanes: 1, .. } => "one trial at a time each".into(),
            LanesInfo { lanes, simd } => format!("{lanes} lanes each, {simd}"),
        };
        // Writing into a string cannot fail.
        let _ = writeln!(text, "{}", [experiment.as_str(), condition].join(" ").trim_end());
        let _ = writeln!(text, "counted: {rounds} of {genomes}: {trials} trials, {steps} steps, in {seconds:.2} s");
        let _ = writeln!(text, "threads: {threads}, {lanes}");
        let _ = writeln!(text, "machine: {}", self.machine.describe());
        if let Some(busy) = self.busy {
            let part = 100.0 * busy;
            let _ = writeln!(text, "processor time: {part:.0} %; the rest went to waiting and to other programs");
        }
        let study = &self.study;
        let steps_of = |steps: f64| if steps.fract() == 0.0 { format!("{steps}") } else { format!("{steps:.1}") };
        let Study { replications, generations, population, trials, .. } = study;
        let mut rows = vec![
            ("control steps per second".to_owned(), significant(self.steps_per_second)),
            ("control steps per second and core".to_owned(), significant(self.steps_per_second_and_core)),
            ("microseconds of a core per control step".to_owned(), significant(1e6 / self.steps_per_second_and_core)),
            ("trials per second and core".to_owned(), significant(self.trials_per_second_and_core)),
            ("generations per hour".to_owned(), significant(self.generations_per_hour)),
        ];
        let place = |index| if index == 0 { "this machine" } else { "a machine of such cores" };
        rows.extend(self.predictions.iter().enumerate().map(|(index, Prediction { cores, seconds })| {
            let cores = if *cores == 1 { "1 core".to_owned() } else { format!("{cores} cores") };
            (format!("the study on {}, {cores}", place(index)), readable(*seconds))
        }));
        let widths = [0, 1].map(|column| {
            let cells = rows.iter().map(|row| if column == 0 { &row.0 } else { &row.1 });
            cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
        });
        let _ = writeln!(text);
        for (what, value) in rows {
            let _ = writeln!(text, "{what:<0$}  {value:>1$}", widths[0], widths[1]);
        }
        let _ = writeln!(
            text,
            "\nthe study: {replications} runs x {generations} generations x {population} individuals x {trials} trials \
             x {} steps\n= {:.3e} control steps; shorter if trials end early, and runs side by side on many cores",
            steps_of(study.steps),
            study.control_steps,
        );
        text
    }
}

/// Formats a positive number to three figures, or its integer part.
fn significant(x: f64) -> String {
    match x {
        x if x >= 100.0 => format!("{x:.0}"),
        x if x >= 10.0 => format!("{x:.1}"),
        x if x >= 1.0 => format!("{x:.2}"),
        x => format!("{x:.3}"),
    }
}

/// Formats a time \[s\] in a suitable unit.
fn readable(seconds: f64) -> String {
    let units = [("days", 86400.0), ("h", 3600.0), ("min", 60.0), ("s", 1.0)];
    let (unit, size) = units.into_iter().find(|(_, size)| seconds >= 2.0 * size).unwrap_or(units[3]);
    format!("{} {unit}", significant(seconds / size))
}

/// Gets the processor time of the process \[s\], with ended threads, on Linux.
fn processor_seconds() -> Option<f64> {
    // The kernel's interface counts in hundredths of a second.
    ticks(&fs::read_to_string("/proc/self/stat").ok()?).map(|ticks| ticks as f64 / 100.0)
}

/// Ticks in user and system mode, fields 14 and 15 of Linux's process statistics.
fn ticks(stat: &str) -> Option<u64> {
    // The program's name, the second field, is in parentheses and may contain anything.
    let mut fields = stat.rsplit_once(')')?.1.split_whitespace().skip(11);
    Some(fields.next()?.parse::<u64>().ok()? + fields.next()?.parse::<u64>().ok()?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::episode::{Episode, NoWorld};
    use crate::experiment::evaluator::{Evaluation, Evaluator, Task, TaskInfo};
    use crate::experiment::lanes::LaneRequest;
    use crate::experiment::outcome::Description;
    use crate::experiment::parameter::Parameter;
    use crate::experiment::settings::{Setting, Settings, Value};
    use crate::experiment::{InWorld, Rollout};
    use crate::run::experiment::Experiment;
    use crate::strategy::settings::{GENERATIONS, POPULATION};
    use farsa_body::Recorder;
    use farsa_view::Schema;

    /// Trials of 7 steps of at most 10. Individual 1 fails in its first trial.
    struct Toy(usize);

    impl Experiment for Toy {
        fn name(&self) -> &'static str {
            "toy"
        }
        fn summary(&self) -> &'static str {
            "trials"
        }
        fn settings(&self, _: &str) -> Vec<Setting> {
            vec![Setting::whole(POPULATION, 20, 1..=100)]
        }
        fn prepare(&self, _: &str, _: &Settings) -> Result<Box<dyn Evaluator>, Error> {
            Ok(Box::new(Toy(self.0)))
        }
    }

    impl Task for Toy {
        fn info(&self) -> TaskInfo {
            TaskInfo {
                description: Description { steps: self.0, ..Description::default() },
                trials: 3,
                ..TaskInfo::new(vec![Parameter::new("none", [0.0, 1.0])], Schema::default())
            }
        }
    }

    impl Evaluator for Toy {
        fn evaluate(&mut self, evaluation: Evaluation<'_>, _: Option<&mut dyn Recorder>) -> Outcome {
            if evaluation.id.individual == 1 {
                return Outcome::failed();
            }
            std::thread::sleep(Duration::from_micros(100));
            Outcome { terms: vec![1.0], steps: 7, ..Outcome::default() }
        }
    }

    fn benched(toy: &Toy, threads: usize, seconds: f64) -> Result<Bench, Error> {
        let mut plan = Plan::new(toy, None, "").unwrap();
        plan.settings.set("", GENERATIONS, Value::Whole(50)).unwrap();
        let pool = Pool::new(&plan, threads, LaneRequest::ONE).unwrap();
        bench(&plan, &Sample::random(&plan).unwrap(), pool, seconds)
    }

    #[test]
    fn counts_and_rates_are_those_of_the_trials() {
        for threads in [1, 3] {
            // On a busy machine a round may take longer than expected.
            let whole = |seconds| benched(&Toy(10), threads, seconds).ok().filter(|found| found.rounds > 0);
            let found = [0.05, 1.0, 60.0].into_iter().find_map(whole).unwrap();
            let rounds = u64::from(found.rounds);
            assert!(found.seconds >= 0.05, "{found:?}");
            // Another thread may have begun the other trials of the failed individual.
            assert!((58 * rounds..=60 * rounds).contains(&found.trials), "{found:?}");
            assert_eq!(found.steps, 7 * 57 * rounds);
            let had = threads.min(found.cores) as f64;
            let rate = found.steps as f64 / found.seconds;
            assert_eq!((found.steps_per_second, found.steps_per_second_and_core), (rate, rate / had));
            assert_eq!(found.study.control_steps, 20.0 * 50.0 * 20.0 * 3.0 * 10.0);
            let hours = 50.0 * 20.0 / found.generations_per_hour * had / found.cores as f64;
            let predicted = found.predictions[0].seconds / 3600.0;
            assert!((hours / predicted - 1.0).abs() < 1e-12, "{hours} {predicted}");
            let ratio = found.predictions[0].seconds / found.predictions[1].seconds;
            assert!((ratio - 64.0 / found.cores as f64).abs() < 1e-9, "{ratio}");
            let text = found.text();
            assert!(text.contains(&format!("{} trials, {} steps", found.trials, found.steps)), "{text}");
        }
    }

    #[test]
    fn a_first_generation_that_takes_too_long_is_cut_short() {
        // A generation takes 5.8 ms at least. On a busy machine not even a trial may end in 4 ms.
        let short = |most| benched(&Toy(most), 1, 0.004).ok().filter(|bench| bench.trials > 0);
        let [open, limited] = [0, 10].map(|most| (0..100).find_map(|_| short(most)).unwrap());
        assert!([&open, &limited].iter().all(|bench| bench.rounds == 0 && bench.trials < 58), "{open:?} {limited:?}");
        // Without a limit of the experiment, trials are as long as measured.
        assert_eq!(open.study.steps, open.steps as f64 / open.trials as f64);
        assert_eq!(limited.trials_per_second_and_core, limited.steps_per_second_and_core / 10.0);
    }

    #[test]
    fn interrupted_trials_have_a_part_in_the_mean() {
        let mut counts = Counts::default();
        for (steps, is_cut) in [(3, false), (4, false), (10, true), (20, true), (30, true)] {
            let failure = is_cut.then_some(Failure::Interrupted);
            counts.add(Some(&Outcome { steps, failure, ..Outcome::default() }));
        }
        // (3 + 4 + 10 + 20 + 30) / 5, and (3 + 4) / 2 for complete generations.
        assert_eq!([0, 100].map(|longest| counts.mean_steps(longest)), [13.4, 100.0]);
        counts.rounds = 1;
        assert_eq!([0, 100].map(|longest| counts.mean_steps(longest)), [3.5, 3.5]);
    }

    /// An episode that ends long after every other test.
    struct Endless(u64);

    impl Episode<NoWorld> for Endless {
        fn start(&mut self, _: &mut NoWorld, _: EpisodeId) {
            self.0 = 0;
        }
        fn act(&mut self, _: &mut NoWorld) {
            thread::sleep(Duration::from_millis(1));
            self.0 += 1;
        }
        fn judge(&mut self, _: &mut NoWorld) -> Option<f64> {
            (self.0 == LONG).then_some(0.0)
        }
    }

    const LONG: u64 = 30_000;

    impl Task for Endless {
        fn info(&self) -> TaskInfo {
            TaskInfo::new(vec![Parameter::new("none", [0.0, 1.0])], Schema::default())
        }
    }

    impl Rollout for Endless {
        fn load(&mut self, _: &Evaluation<'_>) -> bool {
            true
        }
        fn outcome(&self) -> Outcome {
            Outcome { terms: vec![1.0], steps: self.0 as u32, ..Outcome::default() }
        }
    }

    impl Experiment for Endless {
        fn name(&self) -> &'static str {
            "endless"
        }
        fn summary(&self) -> &'static str {
            "one long trial"
        }
        fn settings(&self, _: &str) -> Vec<Setting> {
            vec![Setting::whole(POPULATION, 20, 1..=100), Setting::whole(GENERATIONS, 1, 1..=100)]
        }
        fn prepare(&self, _: &str, _: &Settings) -> Result<Box<dyn Evaluator>, Error> {
            Ok(Box::new(InWorld::new(NoWorld, Endless(0))))
        }
    }

    #[test]
    fn a_trial_that_takes_too_long_is_cut_short() {
        let plan = Plan::new(&Endless(0), None, "").unwrap();
        let pool = Pool::new(&plan, 2, LaneRequest::ONE).unwrap();
        let found = bench(&plan, &Sample::random(&plan).unwrap(), pool, 0.02).unwrap();
        assert_eq!((found.rounds, found.trials), (0, 0));
        assert!((1..LONG).contains(&found.steps), "{found:?}");
        // The mean of one or two interrupted trials is a least length.
        assert!([1.0, 2.0].contains(&(found.steps as f64 / found.study.steps)), "{found:?}");
    }

    #[test]
    fn times_and_rates_are_readable() {
        let said = [0.5, 61.0, 120.0, 5400.0, 7200.0, 86400.0 * 1.5, 86400.0 * 30.0].map(readable);
        assert_eq!(said, ["0.500 s", "61.0 s", "2.00 min", "90.0 min", "2.00 h", "36.0 h", "30.0 days"]);
        assert_eq!([123456.7, 12.34, 1.234].map(significant), ["123457", "12.3", "1.23"]);
    }

    #[test]
    fn the_processor_time_is_found_behind_any_name() {
        let stat = "7 (a) b (c) R 1 7 7 0 -1 4194304 100 0 0 0 123 45 0 0 20 0 1 0 99";
        assert_eq!(ticks(stat), Some(168));
        assert_eq!(ticks("7 (a) R 1"), None);
    }
}
