//! Progress on the standard error: a bar on a terminal, plain lines otherwise.

use std::io::{self, IsTerminal as _, Write as _};
use std::thread;
use std::time::Duration;

use farsa_evo::Statistics;
use indicatif::{ProgressBar, ProgressState, ProgressStyle};

use crate::escaped::escaped;
use crate::figures::significant::significant;

/// Progress of a run or a test, on the standard error.
pub(crate) enum Progress {
    Quiet,
    Lines,
    Bar(ProgressBar),
}

impl Progress {
    /// Creates a bar from `done` to `all` individuals on a terminal, lines otherwise, and nothing if `quiet`.
    pub(crate) fn new(done: u64, all: u64, quiet: bool) -> Self {
        if quiet {
            return Self::Quiet;
        }
        if !io::stderr().is_terminal() {
            return Self::Lines;
        }
        let bar = ProgressBar::new(all).with_position(done);
        bar.reset_eta();
        // The message comes last and is cut at the end of the line. The template is a constant.
        if let Ok(style) = ProgressStyle::with_template("{bar:12} {percent:>3}% {rate}, {eta} left  {wide_msg}") {
            // Writing to the bar's own text cannot fail.
            let rate = |state: &ProgressState, text: &mut dyn std::fmt::Write| {
                let _ = write!(text, "{:.1}/s", state.per_sec());
            };
            bar.set_style(style.with_key("rate", rate));
        }
        // A bar that ticks needs its own thread. Without it the bar moves only after an event.
        if thread::Builder::new().spawn(|| {}).is_ok_and(|thread| thread.join().is_ok()) {
            bar.enable_steady_tick(Duration::from_millis(250));
        }
        Self::Bar(bar)
    }

    /// Counts an evaluated individual. Any thread may call it.
    pub(crate) fn advance(&self) {
        if let Self::Bar(bar) = self {
            bar.inc(1);
        }
    }

    /// Prints a note on its own line.
    pub(crate) fn note(&self, text: &str) {
        match self {
            Self::Quiet => {}
            Self::Bar(bar) => bar.suspend(|| note(text)),
            Self::Lines => note(text),
        }
    }

    /// Reports a finished generation. `all` has the statistics of all individuals, or of each population with its name.
    pub(crate) fn generation(&self, generation: u32, all: &[(&str, &Statistics)]) {
        match self {
            Self::Quiet => {}
            Self::Bar(bar) => bar.set_message(format!("generation {generation}: {}", in_words(all, false))),
            Self::Lines => {
                // A closed error stream is no error.
                let _ = writeln!(io::stderr(), "generation {generation}: {}", escaped(&in_words(all, true)));
            }
        }
    }
}

/// Formats the best, the mean and, if it fits, the worst of each population, and the number of failures.
fn in_words(all: &[(&str, &Statistics)], whole: bool) -> String {
    let format_population = |(name, statistics): &(&str, &Statistics)| {
        let Statistics { best, mean, worst, failed, .. } = statistics;
        let name = if all.len() > 1 { format!("{name} ") } else { String::new() };
        if !best.is_finite() {
            return format!("{name}all {failed} failed");
        }
        let [best, mean, worst] = [best, mean, worst].map(|x| significant(*x));
        let rest = if whole { format!(", worst {worst}") } else { String::new() };
        let lost = if *failed > 0 { format!(", {failed} failed") } else { String::new() };
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
        if let Self::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use farsa_evo::Fitness;

    #[test]
    fn populations_have_their_names() {
        let of = |values: &[f64]| {
            let fitness: Vec<Fitness> = values.iter().map(|x| Fitness::nan_as_failed(*x)).collect();
            Statistics::from_fitness(&fitness).unwrap()
        };
        let (hunter, prey) = (of(&[0.25, 1.0]), of(&[-2.0, f64::NAN]));
        assert_eq!(in_words(&[("0", &hunter)], true), "best 1.000, mean 0.6250, worst 0.2500");
        let both = [("hunter", &hunter), ("prey", &prey)];
        let text =
            "hunter best 1.000, mean 0.6250, worst 0.2500; prey best -2.000, mean -2.000, worst -2.000, 1 failed";
        assert_eq!(in_words(&both, true), text);
        let text = "hunter best 1.000, mean 0.6250; prey best -2.000, mean -2.000, 1 failed";
        assert_eq!(in_words(&both, false), text);
        assert_eq!(in_words(&[("0", &of(&[f64::NAN; 3]))], true), "all 3 failed");
    }
}
