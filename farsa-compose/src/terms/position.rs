//! Positions of points.

use farsa_body::ports::{BodyId, Handles, Kinematics};
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::named_point::NamedPoint;
use crate::part::{Moment, PartScene, Term, TermPart};
use crate::terms::place::direction;

/// Position of a point of the robot along a direction of the world, from its origin [m]: `[1.0, 0.0, 0.0]` for x.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Position {
    /// Direction, of any length.
    #[schemars(inner(range(min = -1.0, max = 1.0)))]
    along: [f64; 3],
    /// Body of a robot with joints, by default the first.
    body: Option<String>,
    /// Point of that body [m].
    #[serde(default)]
    #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
    point: [f64; 3],
}

/// Height of a point of the robot [m].
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Height {
    /// Body of a robot with joints, by default the first.
    body: Option<String>,
    /// Point of that body [m].
    #[serde(default)]
    #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
    point: [f64; 3],
}

/// Uprightness of a body: 1 upright .. 0 lying .. -1 upside down.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Upright {
    /// Body of a robot with joints, by default the first.
    body: Option<String>,
}

/// A position along a unit vector, with the number of a robot on wheels.
#[derive(Clone, Debug)]
pub(super) struct PositionTerm(Option<usize>, NamedPoint, [f64; 3]);

impl<W: Kinematics + Handles<Body = BodyId>> Term<W> for PositionTerm {
    fn value(&self, world: &W, now: &Moment<'_>) -> f64 {
        let Self(robot, point, [u, v, w]) = self;
        if let Some(robot) = robot {
            let [x, y] = [0, 1].map(|k| f64::from(now.poses[*robot].position[k]));
            return x * u + y * v;
        }
        let [x, y, z] = point.position(world, now.markers);
        x * u + y * v + z * w
    }

    fn has_state(&self) -> bool {
        false
    }
}

/// The height of a point.
#[derive(Clone, Debug)]
pub(super) struct HeightTerm(NamedPoint);

impl<W: Kinematics + Handles<Body = BodyId>> Term<W> for HeightTerm {
    fn value(&self, world: &W, now: &Moment<'_>) -> f64 {
        self.0.position(world, now.markers)[2]
    }

    fn has_state(&self) -> bool {
        false
    }
}

/// The uprightness of a body.
#[derive(Clone, Debug)]
pub(super) struct UprightTerm(BodyId);

impl<W: Kinematics + Handles<Body = BodyId>> Term<W> for UprightTerm {
    fn value(&self, world: &W, _: &Moment<'_>) -> f64 {
        // z component of the body's z axis in the world.
        f64::from(world.pose(self.0).rotate([0.0, 0.0, 1.0])[2])
    }

    fn has_state(&self) -> bool {
        false
    }
}

impl TermPart for Position {
    type Term = PositionTerm;

    fn term(&self, scene: &PartScene<'_>) -> Result<PositionTerm, Error> {
        let point = scene.0.part_or_thing(self.body.as_ref(), self.point)?;
        let robot = scene.mobile_robot().map(|_| scene.0.robot());
        Ok(PositionTerm(robot, point, direction(self.along, scene)?))
    }
}

impl TermPart for Height {
    type Term = HeightTerm;

    fn term(&self, scene: &PartScene<'_>) -> Result<HeightTerm, Error> {
        Ok(HeightTerm(scene.0.part_or_thing(self.body.as_ref(), self.point)?))
    }
}

impl TermPart for Upright {
    type Term = UprightTerm;

    fn term(&self, scene: &PartScene<'_>) -> Result<UprightTerm, Error> {
        Ok(UprightTerm(scene.0.frame(self.body.as_ref(), "body")?.0))
    }
}
