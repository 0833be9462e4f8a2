//! What a waiting user sees: a bar on a terminal, plain lines elsewhere.

use std::io::{self, IsTerminal as _, Write as _};
use std::thread;
use std::time::Duration;

use farsa_evo::Statistics;
use indicatif::{ProgressBar, ProgressState, ProgressStyle};

use crate::escaped::escaped;

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

    /// A generation is finished.
    pub(crate) fn generation(&self, generation: u32, statistics: &Statistics) {
        let Statistics { best, mean, worst, failed, .. } = statistics;
        match self {
            Self::Quiet => {}
            Self::Bar(bar) => bar.set_message(format!("generation {generation}: best {best:.2}, mean {mean:.2}")),
            Self::Lines => {
                let failed = if *failed == 0 { String::new() } else { format!(", {failed} failed") };
                // A user who closed the error stream does not want to know.
                let _ = writeln!(
                    io::stderr(),
                    "generation {generation}: best {best:.2}, mean {mean:.2}, worst {worst:.2}{failed}"
                );
            }
        }
    }
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
