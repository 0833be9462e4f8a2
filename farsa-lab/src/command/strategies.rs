//! `farsa strategies`: the strategies of runs.

use serde::Serialize;

use crate::command::arguments::subcommands::StrategiesArgs;
use crate::command::cli::{say, tell};
use crate::command::info::SettingInfo;
use crate::command::invocation::Invocation;
use crate::error::Error;
use crate::json::pretty;
use crate::strategy::definition::StrategyDefinition;

impl Invocation<'_, '_> {
    /// Lists the strategies, or describes one.
    pub(super) fn strategies(&self, args: &StrategiesArgs) -> Result<(), Error> {
        let chosen = args.strategy.as_ref().map(|name| self.laboratory.strategy(name, "")).transpose()?;
        let table = chosen.as_ref().map_or_else(|| self.laboratory.strategies(), std::slice::from_ref);
        match (args.json, &chosen) {
            (true, _) => say(&as_json(table)?),
            (false, Some(strategy)) => tell(&as_text(*strategy)),
            (false, None) => tell(&list(table)),
        }
    }
}

/// Formats the strategies, one per line.
fn list(strategies: &[&'static dyn StrategyDefinition]) -> String {
    let width = strategies.iter().map(|strategy| strategy.name().len()).max().unwrap_or(0);
    let line = |strategy: &&'static dyn StrategyDefinition| {
        let line = format!("{:width$}  {}", strategy.name(), strategy.summary());
        format!("{}\n", line.trim_end())
    };
    strategies.iter().map(line).collect()
}

/// Formats a strategy with its settings.
fn as_text(strategy: &dyn StrategyDefinition) -> String {
    let summary = strategy.summary();
    let summary = if summary.is_empty() { String::new() } else { format!(": {summary}") };
    let settings = strategy.settings();
    let settings = settings.iter().map(|setting| SettingInfo::new(setting).text(setting));
    format!("{}{summary}\n{}", strategy.name(), settings.collect::<String>())
}

/// Returns the strategies as JSON.
fn as_json(strategies: &[&'static dyn StrategyDefinition]) -> Result<String, Error> {
    let entry = |strategy: &&'static dyn StrategyDefinition| Entry {
        name: strategy.name(),
        summary: strategy.summary(),
        settings: strategy.settings().iter().map(SettingInfo::new).collect(),
    };
    pretty(&strategies.iter().map(entry).collect::<Vec<_>>())
}

#[derive(Serialize)]
struct Entry {
    name: &'static str,
    summary: &'static str,
    settings: Vec<SettingInfo>,
}
