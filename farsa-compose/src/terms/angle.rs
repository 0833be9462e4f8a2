//! Angles to things.

use farsa_body::ports::{BodyId, Handles, Kinematics};
use farsa_lab::Error;
use farsa_num::atan2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{Moment, PartScene, Term, TermPart};
use crate::terms::place::{Place, turned};

/// Angle between heading and thing [rad].
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Angle {
    /// Name of the thing.
    object: String,
}

/// The number of the robot, and the thing.
#[derive(Clone, Debug)]
pub(super) struct AngleTerm(usize, Place);

impl<W: Kinematics + Handles<Body = BodyId>> Term<W> for AngleTerm {
    fn start(&mut self, world: &W, _: &Moment<'_>) {
        self.1.locate(world);
    }

    fn step(&mut self, world: &W, _: &Moment<'_>) {
        self.1.locate(world);
    }

    fn value(&self, _: &W, now: &Moment<'_>) -> f64 {
        // |atan2| of the bearing in the robot's axes, in [0, pi].
        let pose = &now.poses[self.0];
        let [ahead, left] = turned(pose, self.1.way(pose));
        atan2(left, ahead).abs()
    }

    fn has_state(&self) -> bool {
        self.1.has_state()
    }
}

impl TermPart for Angle {
    type Term = AngleTerm;

    fn term(&self, scene: &PartScene<'_>) -> Result<AngleTerm, Error> {
        Ok(AngleTerm(scene.0.robot(), Place::new(&self.object, scene)?))
    }
}
