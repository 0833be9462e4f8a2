//! Commands that continue after the end of a run.

use crate::run::queue::quoted;
use crate::run::summary::Summary;

/// Returns the commands that show, test and continue a run.
pub(super) fn after_run(summary: &Summary) -> String {
    let (program, run) = (typed(), quoted(&summary.directory));
    let more = summary.generations.saturating_mul(2);
    format!(
        "look:      {program} replay {run} --html trials.html\n\
         test:      {program} test {run}\n\
         continue:  {program} run --resume {run} --generations {more}\n"
    )
}

/// Returns the program as it was typed, so that its commands can be copied, also after `cargo run`.
fn typed() -> String {
    std::env::args_os().next().map_or_else(|| "farsa".into(), |word| quoted(&word.to_string_lossy()))
}
