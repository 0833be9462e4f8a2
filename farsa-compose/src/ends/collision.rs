//! Collisions of robots.

use farsa_body::ports::{Contacts, PairId};
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{End, EndPart, Moment, PartScene};

/// A robot collides with something.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Collision {}

/// Contact pairs of the robots.
#[derive(Clone, Debug)]
pub(super) struct Touching(Vec<PairId>);

impl<W: Contacts + ?Sized> End<W> for Touching {
    fn ends(&self, world: &W, _: &Moment<'_>, _: bool) -> bool {
        self.0.iter().any(|pair| world.touches(*pair))
    }
}

impl EndPart for Collision {
    type End = Touching;

    fn end(&self, scene: &PartScene<'_>) -> Result<Touching, Error> {
        Ok(Touching(scene.collisions()))
    }
}
