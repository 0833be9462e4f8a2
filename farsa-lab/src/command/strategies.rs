//! `farsa strategies`: the strategies of runs.

use std::fmt::Write as _;

use serde::Serialize;

use crate::command::info::SettingInfo;
use crate::error::Error;
use crate::json::pretty;
use crate::strategy::definition::StrategyDefinition;

/// Formats the strategies with their settings as text.
pub(super) fn as_text(strategies: &[&'static dyn StrategyDefinition]) -> String {
    let mut text = String::new();
    for strategy in strategies {
        let blank = if text.is_empty() { "" } else { "\n" };
        let summary = strategy.summary();
        let summary = if summary.is_empty() { String::new() } else { format!(": {summary}") };
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{blank}{}{summary}", strategy.name());
        for setting in strategy.settings() {
            text.push_str(&SettingInfo::new(&setting).text(&setting));
        }
    }
    text
}

/// Returns the strategies as JSON.
pub(super) fn as_json(strategies: &[&'static dyn StrategyDefinition]) -> Result<String, Error> {
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
