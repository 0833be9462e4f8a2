//! Food and energy.

use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::moment::Stock;
use crate::part::term::Constants;
use crate::part::{Moment, PartScene, Term, TermPart};
use crate::terms::place::yes;

/// Pieces of food that the team has delivered to its nest, according to `foraging`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Food {}

/// Pieces of food that the team carries, according to `foraging`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct CarriedFood {}

/// Pieces of food that the team lost with dead robots, according to `foraging`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct LostFood {}

/// Number of dead robots, according to `foraging`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Deaths {}

/// Energy of the robot, 0 dead .. 1, according to `foraging`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Energy {}

/// 1 while the robot is alive, according to `foraging`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Alive {}

/// A number of the team's food.
#[derive(Clone, Debug)]
pub(super) struct FoodTerm(fn(&dyn Stock) -> f64);

impl<W: ?Sized> Term<W> for FoodTerm {
    fn value(&self, _: &W, now: &Moment<'_>) -> f64 {
        now.stock.map_or(0.0, self.0)
    }

    fn has_state(&self) -> bool {
        false
    }
}

/// Rejects a document without food.
fn with_food(scene: &PartScene<'_>) -> Result<(), Error> {
    scene.planar()?;
    if scene.0.has_food() { Ok(()) } else { Err(scene.error("needs the section `foraging`, which there is not")) }
}

macro_rules! of_food {
    ($($name:ident, $value:expr, $constant:expr;)*) => {
        $(impl TermPart for $name {
            type Term = FoodTerm;

            fn term(&self, scene: &PartScene<'_>) -> Result<FoodTerm, Error> {
                with_food(scene)?;
                Ok(FoodTerm($value))
            }

            fn is_of_team(&self) -> bool {
                true
            }

            fn is_constant(&self, of: &dyn Constants) -> bool {
                let [no_food, no_cost] = of.foraging();
                ($constant)(no_food, no_cost)
            }
        })*
    };
}
of_food! {
    Food, |stock| f64::from(stock.collected()), |no_food, _| no_food;
    CarriedFood, |stock| f64::from(stock.carried()), |no_food, _| no_food;
    LostFood, |stock| f64::from(stock.lost()), |no_food, no_cost| no_food || no_cost;
    Deaths, |stock| stock.deaths() as f64, |_, no_cost| no_cost;
}

/// The number of the robot, and a function of energy and life.
#[derive(Clone, Debug)]
pub(super) struct EnergyTerm(usize, fn((f64, bool)) -> f64);

impl<W: ?Sized> Term<W> for EnergyTerm {
    fn value(&self, _: &W, now: &Moment<'_>) -> f64 {
        now.stock.and_then(|stock| stock.energy(self.0)).map_or(0.0, self.1)
    }

    fn has_state(&self) -> bool {
        false
    }
}

macro_rules! of_energy {
    ($($name:ident, $value:expr;)*) => {
        $(impl TermPart for $name {
            type Term = EnergyTerm;

            fn term(&self, scene: &PartScene<'_>) -> Result<EnergyTerm, Error> {
                with_food(scene)?;
                Ok(EnergyTerm(scene.0.robot(), $value))
            }

            fn is_constant(&self, of: &dyn Constants) -> bool {
                let [_, no_cost] = of.foraging();
                no_cost
            }
        })*
    };
}
of_energy! {
    Energy, |(energy, _)| energy;
    Alive, |(_, alive)| yes(alive);
}
