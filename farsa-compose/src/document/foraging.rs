//! Food and energy.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Robots collect the food of the cells that they cross and carry it to a nest, which restores their energy.
///
/// A robot without energy is dead. It stops, and the food that it carries is lost.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Foraging {
    /// Name of the disc that serves as the nest. A robot there delivers its food and has an energy of 1.
    pub nest: String,
    /// Cells along each side of the arena, with one piece of food each. 0 means no food.
    #[serde(default)]
    #[schemars(range(min = 0, max = 1000))]
    pub cells: u32,
    /// Energy cost of a step.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub cost: f64,
}
