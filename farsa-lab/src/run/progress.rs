//! Progress on the standard error: a bar on a terminal, a line per interval otherwise.

use std::io::{self, IsTerminal as _, Write as _};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use farsa_evo::Statistics;
use indicatif::{ProgressBar, ProgressState, ProgressStyle};

use crate::escaped::escaped;
use crate::figures::significant::{counted, significant};

/// Time between two lines of a log file. The first and the last generation always have a line.
const INTERVAL: Duration = Duration::from_secs(10);

/// Options of the progress of a run.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ProgressOptions {
    pub(crate) quiet: bool,
    /// Other runs of the same command.
    pub(crate) study: Option<Study>,
}

/// Work of the other runs of a study in this process.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Study {
    /// Individuals of finished runs.
    pub(crate) before: u64,
    /// Time since the study began.
    pub(crate) elapsed: Duration,
    /// Individuals of later runs.
    pub(crate) after: u64,
}

/// Progress of a run or a test, on the standard error.
pub(crate) struct Progress {
    output: Output,
    work: Arc<Work>,
}

enum Output {
    Quiet,
    Lines(Mutex<Interval>),
    Bar(ProgressBar),
}

/// Evaluations that are done and left.
struct Work {
    /// Evaluations before this process and altogether.
    first: u64,
    all: u64,
    done: AtomicU64,
    /// Number of generations, 0 for a test.
    generations: u32,
    started: Instant,
    study: Option<Study>,
}

/// Time of the latest line, since the start.
struct Interval(Duration);

impl Interval {
    /// True at most once per interval, and if `must`.
    fn is_due(&mut self, now: Duration, must: bool) -> bool {
        let due = must || now.saturating_sub(self.0) >= INTERVAL;
        if due {
            self.0 = now;
        }
        due
    }
}

impl Work {
    /// Formats the number of finished generations or trials, the rate and the time left.
    fn text(&self, elapsed: Duration) -> String {
        let (done, generations) = (self.done.load(Ordering::Relaxed), u64::from(self.generations));
        let (text, unit) = if generations == 0 {
            (format!("{done} of {}", counted(self.all as usize, "trial")), "trials")
        } else {
            let finished = done.saturating_mul(generations) / self.all.max(1);
            (format!("{finished} of {}", counted(generations as usize, "generation")), "individuals")
        };
        let new = done - self.first;
        if new == 0 {
            return text;
        }
        let seconds = elapsed.as_secs_f64();
        let rate = new as f64 / seconds;
        let rate = if rate < 0.1 { format!("{:.1} {unit}/min", 60.0 * rate) } else { format!("{rate:.1} {unit}/s") };
        let after = self.all.saturating_sub(done);
        let left = match after {
            0 => String::new(),
            _ => format!(", {} left", time(seconds * after as f64 / new as f64)),
        };
        let study =
            self.study.filter(|study| after + study.after > 0).map(|Study { before, elapsed, after: later }| {
                let seconds = (elapsed.as_secs_f64() + seconds) * (after + later) as f64 / (before + new) as f64;
                format!(", all runs {}", time(seconds))
            });
        format!("{text}, {rate}{left}{}", study.unwrap_or_default())
    }
}

/// Formats a time in whole seconds.
fn time(seconds: f64) -> String {
    humantime::format_duration(Duration::from_secs(seconds.ceil().clamp(0.0, 1e12) as u64)).to_string()
}

impl Progress {
    /// Creates the progress of a run from one number of evaluated individuals to another, in the given number of generations.
    pub(crate) fn of_run([done, all]: [u64; 2], generations: u32, options: ProgressOptions) -> Self {
        Self::new([done, all], generations, options)
    }

    /// Creates the progress of a number of trials.
    pub(crate) fn of_trials(trials: usize, quiet: bool) -> Self {
        Self::new([0, trials as u64], 0, ProgressOptions { quiet, study: None })
    }

    /// Creates a bar on a terminal, lines otherwise, and nothing if `quiet`.
    fn new([done, all]: [u64; 2], generations: u32, options: ProgressOptions) -> Self {
        let ProgressOptions { quiet, study } = options;
        let started = Instant::now();
        let work = Arc::new(Work { first: done, all, done: done.into(), generations, started, study });
        let output = if quiet {
            Output::Quiet
        } else if io::stderr().is_terminal() {
            Output::Bar(bar(&work))
        } else {
            Output::Lines(Mutex::new(Interval(Duration::ZERO)))
        };
        Self { output, work }
    }

    /// Counts an evaluated individual or trial. Any thread may call it.
    pub(crate) fn advance(&self) {
        self.work.done.fetch_add(1, Ordering::Relaxed);
        match &self.output {
            Output::Quiet => {}
            Output::Bar(bar) => bar.inc(1),
            Output::Lines(interval) => {
                if let Some(elapsed) = self.due(interval, false) {
                    note(&self.work.text(elapsed));
                }
            }
        }
    }

    /// Returns the time since the start if a line is due.
    fn due(&self, interval: &Mutex<Interval>, must: bool) -> Option<Duration> {
        let elapsed = self.work.started.elapsed();
        interval.lock().unwrap_or_else(PoisonError::into_inner).is_due(elapsed, must).then_some(elapsed)
    }

    /// Prints a note on its own line.
    pub(crate) fn note(&self, text: &str) {
        match &self.output {
            Output::Quiet => {}
            Output::Bar(bar) => bar.suspend(|| note(text)),
            Output::Lines(_) => note(text),
        }
    }

    /// Reports a finished generation. `all` has the statistics of all individuals, or of each population with its name.
    pub(crate) fn generation(&self, generation: u32, all: &[(&str, &Statistics)]) {
        let Work { first, all: individuals, generations, .. } = *self.work;
        let size = individuals / u64::from(generations.max(1));
        let is_single = size == all.len() as u64;
        match &self.output {
            Output::Quiet => {}
            Output::Bar(bar) => bar.set_message(in_words(all, is_single, false)),
            Output::Lines(interval) => {
                let must = u64::from(generation) * size == first || generation + 1 == generations;
                if let Some(elapsed) = self.due(interval, must) {
                    let words = in_words(all, is_single, true);
                    note(&format!("generation {generation}: {words}; {}", self.work.text(elapsed)));
                }
            }
        }
    }
}

/// Creates a bar that shows some work.
fn bar(work: &Arc<Work>) -> ProgressBar {
    let bar = ProgressBar::new(work.all).with_position(work.first);
    // The message comes last and is cut at the end of the line. The template is a constant.
    if let Ok(style) = ProgressStyle::with_template("{bar:12} {work}  {wide_msg}") {
        let work = work.clone();
        // Writing to the bar's own text cannot fail.
        let text = move |_: &ProgressState, text: &mut dyn std::fmt::Write| {
            let _ = text.write_str(&work.text(work.started.elapsed()));
        };
        bar.set_style(style.with_key("work", text));
    }
    // A bar that ticks needs its own thread. Without it the bar moves only after an event.
    if thread::Builder::new().spawn(|| {}).is_ok_and(|thread| thread.join().is_ok()) {
        bar.enable_steady_tick(Duration::from_millis(250));
    }
    bar
}

/// Formats the best, the mean and, if it fits, the worst of each population, and the number of failures. A single individual
/// has one fitness.
fn in_words(all: &[(&str, &Statistics)], is_single: bool, whole: bool) -> String {
    let format_population = |(name, statistics): &(&str, &Statistics)| {
        let Statistics { best, mean, worst, failed, .. } = statistics;
        let name = if all.len() > 1 { format!("{name} ") } else { String::new() };
        if !best.is_finite() {
            return format!("{name}all {failed} failed");
        }
        let [best, mean, worst] = [best, mean, worst].map(|x| significant(*x));
        let lost = if *failed > 0 { format!(", {failed} failed") } else { String::new() };
        if is_single {
            return format!("{name}fitness {best}{lost}");
        }
        let rest = if whole { format!(", worst {worst}") } else { String::new() };
        format!("{name}best {best}, mean {mean}{rest}{lost}")
    };
    all.iter().map(format_population).collect::<Vec<_>>().join("; ")
}

fn note(text: &str) {
    // A closed error stream is no error.
    let _ = writeln!(io::stderr(), "{}", escaped(text));
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Output::Bar(bar) = &self.output {
            bar.finish_and_clear();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use farsa_evo::Fitness;

    fn work(generations: u32, [first, done, all]: [u64; 3], study: Option<Study>) -> Work {
        Work { first, all, done: done.into(), generations, started: Instant::now(), study }
    }

    #[test]
    fn work_has_units_and_the_time_left() {
        let seconds = Duration::from_secs;
        // 4 of 12 generations of 20 individuals, 2 of them in this process: 40 individuals in 10 s, 160 left.
        let run = work(12, [40, 80, 240], None);
        assert_eq!(run.text(seconds(10)), "4 of 12 generations, 4.0 individuals/s, 40s left");
        assert_eq!(run.text(seconds(4000)), "4 of 12 generations, 0.6 individuals/min, 4h 26m 40s left");
        assert_eq!(work(12, [40, 40, 240], None).text(seconds(9)), "2 of 12 generations");
        assert_eq!(work(1, [0, 20, 20], None).text(seconds(10)), "1 of 1 generation, 2.0 individuals/s");
        assert_eq!(work(12, [40, 240, 240], None).text(seconds(10)), "12 of 12 generations, 20.0 individuals/s");
        assert_eq!(work(0, [0, 250, 1000], None).text(seconds(5)), "250 of 1000 trials, 50.0 trials/s, 15s left");
        // 200 individuals in 50 s before and 40 in 10 s here are 4/s. There are 160 left here and 240 later.
        let study = Study { before: 200, elapsed: seconds(50), after: 240 };
        let text = work(12, [40, 80, 240], Some(study)).text(seconds(10));
        assert_eq!(text, "4 of 12 generations, 4.0 individuals/s, 40s left, all runs 1m 40s");
    }

    #[test]
    fn a_log_has_a_line_per_interval() {
        let mut interval = Interval(Duration::ZERO);
        let mut due = |seconds: u64, must: bool| interval.is_due(Duration::from_secs(seconds), must);
        assert_eq!([due(0, false), due(9, false), due(10, false), due(11, false)], [false, false, true, false]);
        // The line of the last generation starts another interval.
        assert_eq!([due(15, true), due(24, false), due(25, false)], [true, false, true]);
    }

    #[test]
    fn populations_have_their_names() {
        let of = |values: &[f64]| {
            let fitness: Vec<Fitness> = values.iter().map(|x| Fitness::nan_as_failed(*x)).collect();
            Statistics::from_fitness(&fitness).unwrap()
        };
        let (hunter, prey) = (of(&[0.25, 1.0]), of(&[-2.0, f64::NAN]));
        assert_eq!(in_words(&[("0", &hunter)], false, true), "best 1.000, mean 0.6250, worst 0.2500");
        let both = [("hunter", &hunter), ("prey", &prey)];
        let text =
            "hunter best 1.000, mean 0.6250, worst 0.2500; prey best -2.000, mean -2.000, worst -2.000, 1 failed";
        assert_eq!(in_words(&both, false, true), text);
        let text = "hunter best 1.000, mean 0.6250; prey best -2.000, mean -2.000, 1 failed";
        assert_eq!(in_words(&both, false, false), text);
        assert_eq!(in_words(&[("0", &of(&[f64::NAN; 3]))], false, true), "all 3 failed");
        assert_eq!(in_words(&[("", &of(&[0.25]))], true, true), "fitness 0.2500");
    }
}
