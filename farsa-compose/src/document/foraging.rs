//! Food and energy.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Robots take the food of the cells that they drive over, and bring it to a nest, which gives them energy.
///
/// A robot without energy is dead: it stands still, and what it carries is lost.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Foraging {
    /// The disc that is the nest: who is there gives its food and has an energy of 1.
    pub nest: String,
    /// Cells along each side of the arena, with one piece of food each; 0 is no food.
    #[serde(default)]
    #[schemars(range(min = 0, max = 1000))]
    pub cells: u32,
    /// Energy that a step costs.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub cost: f64,
}
