//! Exchanges of two areas by two robots.

use farsa_body::ports::{BodyId, Handles, Kinematics};
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{Area, Moment, PartScene, Term, TermPart};

/// Number of times that two robots exchanged two areas: each is in one of them, the other way round than the last time.
///
/// Source: `[DeGreeff2010]`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Exchanges {
    /// Name of a disc or rectangle.
    area: String,
    /// Name of the other one.
    with: String,
}

/// Exchanges of a trial.
#[derive(Clone, Debug)]
pub(super) struct ExchangesTerm {
    robots: [BodyId; 2],
    areas: [Area; 2],
    /// True if the first robot was last in the first area, false if it was in the second. `None` before both were in areas.
    last: Option<bool>,
    count: u32,
}

impl<W: Kinematics + Handles<Body = BodyId>> Term<W> for ExchangesTerm {
    fn start(&mut self, world: &W, now: &Moment<'_>) {
        (self.last, self.count) = (None, 0);
        self.step(world, now);
    }

    fn step(&mut self, world: &W, _: &Moment<'_>) {
        let is_in = |robot: usize, area: usize| self.areas[area].contains(world, world.pose(self.robots[robot]));
        let first = match () {
            () if is_in(0, 0) && is_in(1, 1) => true,
            () if is_in(0, 1) && is_in(1, 0) => false,
            () => return,
        };
        self.count += u32::from(self.last.is_some_and(|last| last != first));
        self.last = Some(first);
    }

    fn value(&self, _: &W, _: &Moment<'_>) -> f64 {
        f64::from(self.count)
    }
}

impl TermPart for Exchanges {
    type Term = ExchangesTerm;

    fn term(&self, scene: &PartScene<'_>) -> Result<ExchangesTerm, Error> {
        let robots = scene.robots();
        let robots = <[BodyId; 2]>::try_from(&robots[..]);
        let robots = robots.map_err(|_| scene.error("is for two robots on wheels"))?;
        Ok(ExchangesTerm { robots, areas: [scene.area(&self.area)?, scene.area(&self.with)?], last: None, count: 0 })
    }
}
