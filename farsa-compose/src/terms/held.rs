//! Attachment devices.

use farsa_body::ports::BodyId;
use farsa_lab::Error;
use farsa_lab::advanced::PlanarWorld;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::term::Constants;
use crate::part::{Moment, PartScene, Term, TermPart};
use crate::terms::place::yes;

/// 1 while the robot's attachment device holds something.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Held {}

/// The body of the robot.
#[derive(Clone, Debug)]
pub(super) struct HeldTerm(BodyId);

impl<W: PlanarWorld> Term<W> for HeldTerm {
    fn value(&self, world: &W, _: &Moment<'_>) -> f64 {
        yes(world.attached(self.0).is_some())
    }

    fn has_state(&self) -> bool {
        false
    }
}

impl TermPart for Held {
    type Term = HeldTerm;

    fn term(&self, scene: &PartScene<'_>) -> Result<HeldTerm, Error> {
        Ok(HeldTerm(scene.planar()?.parts.body))
    }

    fn is_constant(&self, of: &dyn Constants) -> bool {
        !of.pulls()
    }
}
