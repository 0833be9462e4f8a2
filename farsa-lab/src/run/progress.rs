//! What a waiting user sees: a bar on a terminal, plain lines elsewhere.

use std::io::{self, IsTerminal as _, Write as _};
use std::thread;
use std::time::Duration;

use farsa_evo::Statistics;
use indicatif::{ProgressBar, ProgressState, ProgressStyle};

use crate::escaped::escaped;
use crate::figures::significant::significant;

/// The progress of a run or a test, on the standard error.
pub(crate) enum Progress {
    Quiet,
    Lines,
    Bar(ProgressBar),
}

impl Progress {
    /// A bar from `done` to `all` individuals on a terminal, lines elsewhere, and nothing if `quiet`.
    pub(crate) fn new(done: u64, all: u64, quiet: bool) -> Self {
        if quiet {
            return Self::Quiet;
        }
        if !io::stderr().is_terminal() {
            return Self::Lines;
        }
        let bar = ProgressBar::new(all).with_position(done);
        bar.reset_eta();
        // The message comes last and is cut where a line ends. The template is a constant; the default would do as well.
        if let Ok(style) = ProgressStyle::with_template("{bar:12} {percent:>3}% {rate}, {eta} left  {wide_msg}") {
            // Writing to the bar's own text cannot fail.
            let rate = |state: &ProgressState, text: &mut dyn std::fmt::Write| {
                let _ = write!(text, "{:.1}/s", state.per_sec());
            };
            bar.set_style(style.with_key("rate", rate));
        }
        // A bar that ticks has a thread of its own, without which it moves only when something has happened.
        if thread::Builder::new().spawn(|| {}).is_ok_and(|thread| thread.join().is_ok()) {
            bar.enable_steady_tick(Duration::from_millis(250));
        }
        Self::Bar(bar)
    }

    /// One more individual is evaluated; called from any thread.
    pub(crate) fn advance(&self) {
        if let Self::Bar(bar) = self {
            bar.inc(1);
        }
    }

    /// Something that is worth a line of its own.
    pub(crate) fn note(&self, text: &str) {
        match self {
            Self::Quiet => {}
            Self::Bar(bar) => bar.suspend(|| note(text)),
            Self::Lines => note(text),
        }
    }

    /// A generation is finished; `all` is of everyone, or of each of several populations with its name.
    pub(crate) fn generation(&self, generation: u32, all: &[(&str, &Statistics)]) {
        match self {
            Self::Quiet => {}
            Self::Bar(bar) => bar.set_message(format!("generation {generation}: {}", in_words(all, false))),
            Self::Lines => {
                // A user who closed the error stream does not want to know.
                let _ = writeln!(io::stderr(), "generation {generation}: {}", escaped(&in_words(all, true)));
            }
        }
    }
}

/// The best, the mean and, where there is room, the worst of each population, and how many failed.
fn in_words(all: &[(&str, &Statistics)], whole: bool) -> String {
    let one = |(name, statistics): &(&str, &Statistics)| {
        let Statistics { best, mean, worst, failed, .. } = statistics;
        let name = if all.len() > 1 { format!("{name} ") } else { String::new() };
        let [best, mean, worst] = [best, mean, worst].map(|x| significant(*x));
        let rest = if whole { format!(", worst {worst}") } else { String::new() };
        let lost = if whole && *failed > 0 { format!(", {failed} failed") } else { String::new() };
        format!("{name}best {best}, mean {mean}{rest}{lost}")
    };
    all.iter().map(one).collect::<Vec<_>>().join("; ")
}

fn note(text: &str) {
    // A user who closed the error stream does not want to know.
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
        assert_eq!(in_words(&both, false), "hunter best 1.000, mean 0.6250; prey best -2.000, mean -2.000");
    }
}
