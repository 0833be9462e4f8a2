//! Deaths of all robots.

use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{End, EndPart, Moment, PartScene};

/// All robots are dead according to `foraging`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Death {}

/// The rule of deaths.
#[derive(Clone, Copy, Debug)]
pub(super) struct AllDead;

impl<W: ?Sized> End<W> for AllDead {
    fn ends(&self, _: &W, now: &Moment<'_>, _: bool) -> bool {
        now.stock.is_some_and(|stock| stock.deaths() == now.poses.len())
    }
}

impl EndPart for Death {
    type End = AllDead;

    fn end(&self, scene: &PartScene<'_>) -> Result<AllDead, Error> {
        if scene.0.has_food() {
            return Ok(AllDead);
        }
        Err(scene.error("needs the section `foraging`, which there is not"))
    }
}
