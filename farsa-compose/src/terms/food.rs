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

impl TermPart for Food {
    type Term = FoodTerm;

    fn term(&self, scene: &PartScene<'_>) -> Result<FoodTerm, Error> {
        with_food(scene)?;
        Ok(FoodTerm(|stock| f64::from(stock.collected())))
    }

    fn looks_back(&self) -> bool {
        false
    }

    fn is_of_team(&self) -> bool {
        true
    }

    fn is_constant(&self, of: &dyn Constants) -> bool {
        of.foraging()[0]
    }
}

impl TermPart for CarriedFood {
    type Term = FoodTerm;

    fn term(&self, scene: &PartScene<'_>) -> Result<FoodTerm, Error> {
        with_food(scene)?;
        Ok(FoodTerm(|stock| f64::from(stock.carried())))
    }

    fn looks_back(&self) -> bool {
        false
    }

    fn is_of_team(&self) -> bool {
        true
    }

    fn is_constant(&self, of: &dyn Constants) -> bool {
        of.foraging()[0]
    }
}

impl TermPart for LostFood {
    type Term = FoodTerm;

    fn term(&self, scene: &PartScene<'_>) -> Result<FoodTerm, Error> {
        with_food(scene)?;
        Ok(FoodTerm(|stock| f64::from(stock.lost())))
    }

    fn looks_back(&self) -> bool {
        false
    }

    fn is_of_team(&self) -> bool {
        true
    }

    fn is_constant(&self, of: &dyn Constants) -> bool {
        of.foraging().contains(&true)
    }
}

impl TermPart for Deaths {
    type Term = FoodTerm;

    fn term(&self, scene: &PartScene<'_>) -> Result<FoodTerm, Error> {
        with_food(scene)?;
        Ok(FoodTerm(|stock| stock.deaths() as f64))
    }

    fn looks_back(&self) -> bool {
        false
    }

    fn is_of_team(&self) -> bool {
        true
    }

    fn is_constant(&self, of: &dyn Constants) -> bool {
        of.foraging()[1]
    }
}

/// The number of the robot, and a number of its energy and life.
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

impl TermPart for Energy {
    type Term = EnergyTerm;

    fn term(&self, scene: &PartScene<'_>) -> Result<EnergyTerm, Error> {
        with_food(scene)?;
        Ok(EnergyTerm(scene.0.robot(), |(energy, _)| energy))
    }

    fn looks_back(&self) -> bool {
        false
    }

    fn is_constant(&self, of: &dyn Constants) -> bool {
        of.foraging()[1]
    }
}

impl TermPart for Alive {
    type Term = EnergyTerm;

    fn term(&self, scene: &PartScene<'_>) -> Result<EnergyTerm, Error> {
        with_food(scene)?;
        Ok(EnergyTerm(scene.0.robot(), |(_, alive)| yes(alive)))
    }

    fn looks_back(&self) -> bool {
        false
    }

    fn is_constant(&self, of: &dyn Constants) -> bool {
        of.foraging()[1]
    }
}
