//! What a waiting user sees: a bar on a terminal, plain lines elsewhere.

use std::io::{self, IsTerminal as _, Write as _};
use std::time::Duration;

use farsa_evo::Statistics;
use indicatif::{ProgressBar, ProgressStyle};

/// The progress of a run or a test, on the standard error.
pub(crate) struct Progress {
    bar: Option<ProgressBar>,
}

impl Progress {
    /// A bar from `done` to `all` pieces of work if anybody can see one; `unit` is what a piece is called.
    pub(crate) fn new(unit: &str, done: u64, all: u64) -> Self {
        let bar = io::stderr().is_terminal().then(|| {
            let bar = ProgressBar::new(all).with_position(done);
            bar.reset_eta();
            let template = format!("{{bar:25}} {{pos}}/{{len}} {unit} [{{elapsed}}, {{eta}} left] {{wide_msg}}");
            // The template is a constant but for the unit; the default style would do as well.
            if let Ok(style) = ProgressStyle::with_template(&template) {
                bar.set_style(style);
            }
            bar.enable_steady_tick(Duration::from_millis(250));
            bar
        });
        Self { bar }
    }

    /// One more piece of work is done; called from any thread.
    pub(crate) fn advance(&self) {
        if let Some(bar) = &self.bar {
            bar.inc(1);
        }
    }

    /// A generation is finished.
    pub(crate) fn generation(&self, generation: u32, statistics: &Statistics) {
        let Statistics { best, mean, worst, failed, .. } = statistics;
        if let Some(bar) = &self.bar {
            bar.set_message(format!("generation {generation}: best {best:.2}, mean {mean:.2}"));
        } else {
            let failed = if *failed == 0 { String::new() } else { format!(", {failed} failed") };
            // A user who closed the error stream does not want to know.
            let _ = writeln!(
                io::stderr(),
                "generation {generation}: best {best:.2}, mean {mean:.2}, worst {worst:.2}{failed}"
            );
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
