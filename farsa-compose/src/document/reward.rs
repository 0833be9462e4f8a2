//! Terms of the fitness, success and failure.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::document::one;
use crate::document::registered::RewardKind;
use crate::name::NAME;

/// A term of the fitness.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Reward {
    /// Name for logs, tests and other terms, by default the kind.
    #[schemars(regex(pattern = NAME))]
    pub name: Option<String>,
    /// Name in outcomes and recordings, by default `name`, in notes after the word "measured".
    pub label: Option<String>,
    /// Factor of the term. A negative one makes it a cost. With 0 it is only measured and not part of the fitness.
    #[serde(default = "one")]
    #[schemars(range(min = -1e9, max = 1e9))]
    pub weight: f64,
    /// Aggregation over the steps of a trial.
    #[serde(default)]
    pub over: Over,
    /// Number of the robot, from 1, by default all robots.
    #[schemars(range(min = 1, max = 1000))]
    pub robot: Option<u32>,
    /// Name of a group of `robots`, by default all robots, or those that evolve.
    pub of: Option<String>,
    /// Name of another term. Only steps with a positive value of that term count.
    pub during: Option<String>,
    /// Lower and upper limit of the value of a step.
    #[schemars(inner(range(min = -1e9, max = 1e9)))]
    pub clip: Option<[f64; 2]>,
    /// The kind of term.
    #[serde(flatten)]
    pub kind: RewardKind,
}

/// Aggregations over the steps of a trial.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Over {
    /// Sum over the steps, divided by the greatest number of steps.
    #[default]
    Mean,
    /// Sum over the steps.
    Sum,
    /// Value after the last step.
    End,
    /// Largest value of a step.
    Most,
}

/// Combination of the terms into one number.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Fitness {
    /// Multiplies the terms of a trial instead of adding them.
    pub product: bool,
    /// Combination of trials into one number.
    pub trials: Trials,
}

/// Combinations of trials into one number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Trials {
    /// Mean.
    #[default]
    Mean,
    /// Sum.
    Sum,
    /// Worst trial.
    Worst,
}

/// A condition: a formula, or limits on the last step's value of a term, before its weight.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Condition {
    /// Formula, such as `time > 5 and near(lamp, 0.1) > 0 for 1 s`. Its quantities are means over the robots.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(max = 2000))]
    pub formula: Option<String>,
    /// Name of a term, unless there is a formula.
    pub term: Option<String>,
    /// Name of a group of robots. The condition is for trials in which it evolves, by default for all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub of: Option<String>,
    /// Lower limit. The value must be greater.
    #[schemars(range(min = -1e9, max = 1e9))]
    pub above: Option<f64>,
    /// Upper limit. The value must be less.
    #[schemars(range(min = -1e9, max = 1e9))]
    pub below: Option<f64>,
}
