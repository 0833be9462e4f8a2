//! `farsa list` and `farsa info`: experiments and their parts.

use std::fmt::Write as _;

use serde::Serialize;

use crate::command::behaviour::BehaviourInfo;
use crate::error::Error;
use crate::experiment::PartNames;
use crate::experiment::outcome::{ChannelGroup, Description};
use crate::experiment::protocol::Protocol;
use crate::experiment::settings::{AllowedValues, Setting, Source, Value};
use crate::figures::significant::counted;
use crate::json::pretty;
use crate::run::experiment::Experiment;
use crate::run::plan::Plan;

/// Most names of a kind that are listed before the last.
const MAX_NAMES: usize = 12;

/// Returns a line per experiment with its conditions.
pub(crate) fn list(experiments: &[&dyn Experiment]) -> String {
    let width = experiments.iter().map(|experiment| experiment.name().len()).max().unwrap_or(0);
    let mut text = String::new();
    for experiment in experiments {
        let (name, summary, conditions) = (experiment.name(), experiment.summary(), experiment.conditions().join(", "));
        let conditions = if conditions.is_empty() { conditions } else { format!(" [{conditions}]") };
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{name:width$}  {summary}{conditions}");
    }
    text
}

/// Returns the experiments as JSON.
pub(crate) fn list_as_json(experiments: &[&dyn Experiment]) -> Result<String, Error> {
    let list: Vec<Entry> = experiments
        .iter()
        .map(|experiment| Entry {
            name: experiment.name(),
            summary: experiment.summary(),
            conditions: experiment.conditions(),
        })
        .collect();
    pretty(&list)
}

#[derive(Serialize)]
struct Entry {
    name: &'static str,
    summary: &'static str,
    conditions: &'static [&'static str],
}

/// Description of an experiment under a condition, with the names of its JSON.
#[derive(Serialize)]
struct Info {
    experiment: String,
    summary: String,
    condition: String,
    conditions: Vec<String>,
    /// Groups of sensors.
    sensors: Vec<ChannelGroup>,
    inputs: usize,
    motors: Vec<ChannelGroup>,
    outputs: usize,
    network: String,
    parameters: usize,
    genes: usize,
    genome_bits: usize,
    trials: usize,
    /// Most steps of a trial.
    steps: usize,
    step_seconds: f64,
    fitness_terms: Vec<String>,
    #[serde(flatten)]
    behaviour: BehaviourInfo,
    /// Protocols of `farsa test --protocol`.
    protocols: Vec<ProtocolInfo>,
    /// Parts that `farsa test --lesion` can change, by kind.
    lesions: Vec<PartNames>,
    settings: Vec<SettingInfo>,
}

/// Description of a test protocol.
#[derive(Serialize)]
struct ProtocolInfo {
    name: String,
    summary: String,
    /// Number of cases.
    cases: usize,
    /// Number of held-out cases.
    held_out: usize,
    /// Default number of trials per case.
    trials: u32,
}

impl ProtocolInfo {
    fn new(Protocol { name, summary, trials, cases, .. }: Protocol) -> Self {
        let held_out = cases.iter().filter(|case| case.held_out).count();
        Self { name, summary, cases: cases.len(), held_out, trials }
    }
}

/// Description of a setting.
#[derive(Serialize)]
pub(super) struct SettingInfo {
    key: String,
    default: serde_json::Value,
    unit: String,
    allowed: String,
    #[serde(flatten)]
    values: AllowedValues,
    source: Source,
    doc: String,
}

impl SettingInfo {
    pub(super) fn new(setting: &Setting) -> Self {
        Self {
            key: setting.key().into(),
            default: json(setting.default_value()),
            unit: setting.unit_name().into(),
            allowed: setting.allowed(),
            values: setting.allowed_values(),
            source: setting.source(),
            doc: setting.doc_text().into(),
        }
    }

    /// Returns a line with the setting and a line with its meaning.
    pub(super) fn text(&self, setting: &Setting) -> String {
        let Self { key, unit, allowed, source, doc, .. } = self;
        let value = setting.default_value();
        let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
        let doc = if doc.is_empty() { String::new() } else { format!("      {doc}\n") };
        format!("  {key} = {value}{unit}  [{}; {allowed}]\n{doc}", source.name())
    }
}

impl Info {
    fn from_plan(plan: &Plan<'_>) -> Result<Self, Error> {
        let evaluator = plan.evaluator()?;
        let Description { sensors, motors, network, parameters, steps, step_seconds } = evaluator.info().description;
        let count = |groups: &[ChannelGroup]| groups.iter().map(|group| group.count).sum();
        let protocols = evaluator.info().protocols;
        Protocol::check(&protocols)?;
        let settings = plan.settings.table().iter().map(SettingInfo::new);
        Ok(Self {
            experiment: plan.experiment.name().into(),
            summary: plan.experiment.summary().into(),
            condition: plan.condition.clone(),
            conditions: plan.experiment.conditions().iter().map(|&name| name.to_owned()).collect(),
            inputs: count(&sensors),
            outputs: count(&motors),
            sensors,
            motors,
            network,
            parameters,
            genes: evaluator.info().parameters.len(),
            genome_bits: plan.experiment.gene_bits() as usize * evaluator.info().parameters.len(),
            trials: evaluator.info().trials,
            steps,
            step_seconds,
            fitness_terms: evaluator.info().terms,
            behaviour: BehaviourInfo::new(&evaluator.info(), evaluator.behavior()),
            protocols: protocols.into_iter().map(ProtocolInfo::new).collect(),
            lesions: evaluator.info().anatomy.map(|anatomy| anatomy.names()).unwrap_or_default(),
            settings: settings.collect(),
        })
    }
}

fn json(value: &Value) -> serde_json::Value {
    match value {
        Value::Flag(flag) => (*flag).into(),
        Value::Whole(n) => (*n).into(),
        Value::Number(x) => (*x).into(),
        Value::Word(word) => word.as_str().into(),
        Value::Numbers(list) => list.clone().into(),
    }
}

/// Returns the description of an experiment as JSON.
pub(crate) fn as_json(plan: &Plan<'_>) -> Result<String, Error> {
    pretty(&Info::from_plan(plan)?)
}

/// Returns the description of an experiment as text.
pub(crate) fn as_text(plan: &Plan<'_>) -> Result<String, Error> {
    let info = Info::from_plan(plan)?;
    let mut text = format!("{}: {}\n", info.experiment, info.summary);
    // Writing to a string cannot fail.
    if !info.condition.is_empty() {
        let _ = writeln!(text, "condition: {} (of {})", info.condition, info.conditions.join(", "));
    }
    for (what, count, groups) in [("sensors", info.inputs, &info.sensors), ("motors", info.outputs, &info.motors)] {
        let _ = writeln!(text, "\n{what}: {count}");
        let width = groups.iter().map(|group| group.name.chars().count()).max().unwrap_or(0);
        for ChannelGroup { name, count, meaning } in groups {
            let _ = writeln!(text, "  {count:4}  {name:width$}  {meaning}");
        }
    }
    let _ = writeln!(text, "\nnetwork: {}", info.network);
    let _ = writeln!(text, "parameters: {}", info.parameters);
    let _ = writeln!(text, "genome: {}, {}", counted(info.genes, "gene"), counted(info.genome_bits, "bit"));
    let seconds = info.step_seconds * info.steps as f64;
    let clock = if seconds > 0.0 { format!(" ({seconds:?} s)") } else { String::new() };
    let _ = writeln!(text, "trials: {}, each of at most {} steps{clock}", info.trials, info.steps);
    text += &info.behaviour.text(&info.fitness_terms);
    if !info.protocols.is_empty() {
        let _ = writeln!(text, "\nprotocols of `test --protocol`:");
    }
    let width = info.protocols.iter().map(|protocol| protocol.name.len()).max().unwrap_or(0);
    for ProtocolInfo { name, summary, cases, trials, .. } in &info.protocols {
        let s = if *cases == 1 { "" } else { "s" };
        let _ = writeln!(text, "  {name:width$}  {summary} ({cases} case{s}, {trials} trials each)");
    }
    if !info.lesions.is_empty() {
        let _ = writeln!(text, "\nparts that `test --lesion` changes:");
    }
    let width = info.lesions.iter().map(|lesion| lesion.kind.len()).max().unwrap_or(0);
    for PartNames { kind, names } in &info.lesions {
        let names = match names.as_slice() {
            [first @ .., last] if first.len() > MAX_NAMES => {
                format!("{}, ..., {last}", first[..MAX_NAMES].join(", "))
            }
            all => all.join(", "),
        };
        let _ = writeln!(text, "  {kind:width$}  {names}");
    }
    let _ = writeln!(text, "\nsettings (given by the source, derived from it, or chosen here):");
    for (setting, info) in plan.settings.table().iter().zip(&info.settings) {
        text.push_str(&info.text(setting));
    }
    Ok(text)
}
