//! Commands that continue after the end of a run.

use crate::experiment::settings::Value;
use crate::run::plan::Plan;
use crate::run::summary::Summary;
use crate::shell::quoted;
use crate::strategy::settings::GENERATIONS;

/// Returns the commands that show a run, and those that test and continue it where that is left to do.
pub(super) fn after_run(summary: &Summary, plan: &Plan<'_>) -> String {
    let (program, run) = (typed(), quoted(&summary.directory.to_string_lossy()));
    let more = summary.generations.saturating_mul(2);
    let continues = plan.clone().set("", GENERATIONS, Value::Whole(more.into())).is_ok();
    let commands = [
        (true, format!("look:      {program} replay {run} --html trials.html\n")),
        (summary.test.is_none(), format!("test:      {program} test {run}\n")),
        (continues, format!("continue:  {program} run --resume {run} --generations {more}\n")),
    ];
    commands.into_iter().filter_map(|(left, command)| left.then_some(command)).collect()
}

/// Returns the program as it was typed, so that its commands can be copied, also after `cargo run`.
fn typed() -> String {
    std::env::args_os().next().map_or_else(|| "farsa".into(), |word| quoted(&word.to_string_lossy()))
}
