//! Distances from the start.

use farsa_body::Pose;
use farsa_body::ports::{BodyId, Handles, Kinematics};
use farsa_body::sensors::Point;
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::named_point::NamedPoint;
use crate::part::term::Constants;
use crate::part::{Moment, PartScene, Term, TermPart};
use crate::terms::place::{Place, apart, length};

/// Distance of the robot from its start [m].
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Displacement {
    /// Body of a robot with joints, by default the first.
    body: Option<String>,
}

/// Distance of a thing from its start [m].
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Moved {
    /// Name of the thing.
    object: String,
}

/// The distance of a robot from its start.
#[derive(Clone, Debug)]
pub(super) enum DisplacementTerm {
    /// With the number of the robot.
    Planar(usize, Pose),
    Spatial(Point, [f64; 3]),
}

impl<W: Kinematics + Handles<Body = BodyId>> Term<W> for DisplacementTerm {
    fn start(&mut self, world: &W, now: &Moment<'_>) {
        match self {
            Self::Planar(robot, began) => *began = now.poses[*robot],
            Self::Spatial(point, began) => *began = point.position(world).map(f64::from),
        }
    }

    fn value(&self, world: &W, now: &Moment<'_>) -> f64 {
        match self {
            Self::Planar(robot, began) => {
                let pose = &now.poses[*robot];
                length([0, 1].map(|k| f64::from(pose.position[k]) - f64::from(began.position[k])))
            }
            Self::Spatial(point, began) => apart(point.position(world).map(f64::from), *began),
        }
    }

    fn has_state(&self) -> bool {
        false
    }
}

/// The distance of a thing from its start.
#[derive(Clone, Debug)]
pub(super) enum MovedTerm {
    Planar(Place, Pose),
    Spatial(NamedPoint, [f64; 3]),
}

impl<W: Kinematics + Handles<Body = BodyId>> Term<W> for MovedTerm {
    fn start(&mut self, world: &W, now: &Moment<'_>) {
        match self {
            Self::Planar(place, began) => {
                place.locate(world);
                *began = place.pose;
            }
            Self::Spatial(thing, began) => *began = thing.position(world, now.markers),
        }
    }

    fn step(&mut self, world: &W, _: &Moment<'_>) {
        if let Self::Planar(place, _) = self {
            place.locate(world);
        }
    }

    fn value(&self, world: &W, now: &Moment<'_>) -> f64 {
        match self {
            Self::Planar(place, began) => {
                length([0, 1].map(|k| f64::from(place.pose.position[k]) - f64::from(began.position[k])))
            }
            Self::Spatial(thing, began) => apart(thing.position(world, now.markers), *began),
        }
    }

    fn has_state(&self) -> bool {
        matches!(self, Self::Planar(place, _) if place.has_state())
    }
}

impl TermPart for Displacement {
    type Term = DisplacementTerm;

    fn term(&self, scene: &PartScene<'_>) -> Result<DisplacementTerm, Error> {
        let point = scene.0.point(self.body.as_ref(), [0.0; 3])?;
        Ok(match scene.mobile_robot() {
            Some(_) => DisplacementTerm::Planar(scene.0.robot(), Pose::identity()),
            None => DisplacementTerm::Spatial(point, [0.0; 3]),
        })
    }
}

impl TermPart for Moved {
    type Term = MovedTerm;

    fn term(&self, scene: &PartScene<'_>) -> Result<MovedTerm, Error> {
        Ok(match scene.mobile_robot() {
            Some(_) => MovedTerm::Planar(Place::new(&self.object, scene)?, Pose::identity()),
            None => MovedTerm::Spatial(scene.0.target(&self.object, "object")?, [0.0; 3]),
        })
    }

    fn is_constant(&self, of: &dyn Constants) -> bool {
        of.is_fixed(&self.object)
    }
}
