//! Speeds of robots.

use farsa_body::Pose;
use farsa_body::ports::{BodyId, Handles, Kinematics};
use farsa_body::sensors::Point;
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::named_point::NamedPoint;
use crate::part::{Moment, PartScene, Term, TermPart};
use crate::terms::place::{length, length_in_space};

/// Speed of the robot [m/s].
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Speed {
    /// Body of a robot with joints, by default the first.
    body: Option<String>,
}

/// The speed of a robot.
#[derive(Clone, Debug)]
pub(super) enum SpeedTerm {
    /// The number of the robot, its pose in the last step, and the distance since then [m].
    Planar(usize, Pose, f64),
    Spatial(Point),
}

impl<W: Kinematics + Handles<Body = BodyId>> Term<W> for SpeedTerm {
    fn start(&mut self, _: &W, now: &Moment<'_>) {
        if let Self::Planar(robot, before, way) = self {
            (*before, *way) = (now.poses[*robot], 0.0);
        }
    }

    fn step(&mut self, _: &W, now: &Moment<'_>) {
        if let Self::Planar(robot, before, way) = self {
            let pose = now.poses[*robot];
            *way = length([0, 1].map(|k| f64::from(pose.position[k]) - f64::from(before.position[k])));
            *before = pose;
        }
    }

    fn value(&self, world: &W, now: &Moment<'_>) -> f64 {
        match self {
            // |p - p'| / dt, with p' of the previous step.
            Self::Planar(_, _, way) => way / now.time_step,
            // From the dynamics, unlike in an arena, where it is the difference of two positions.
            Self::Spatial(point) => length_in_space(velocity_of(world, point)),
        }
    }

    fn has_state(&self) -> bool {
        matches!(self, Self::Planar(..))
    }
}

/// Computes the velocity of a point of a body [m/s].
fn velocity_of<W: Kinematics + Handles<Body = BodyId>>(world: &W, point: &Point) -> [f64; 3] {
    let (twist, pose) = (world.velocity(point.body), world.pose(point.body).cast::<f64>());
    let ([x, y, z], [u, v, w]) = (pose.rotate(point.at.map(f64::from)), twist.angular.map(f64::from));
    // v + w x r
    let turning = [v * z - w * y, w * x - u * z, u * y - v * x];
    let linear = twist.linear.map(f64::from);
    [0, 1, 2].map(|k| linear[k] + turning[k])
}

impl TermPart for Speed {
    type Term = SpeedTerm;

    fn term(&self, scene: &PartScene<'_>) -> Result<SpeedTerm, Error> {
        match scene.0.part_or_thing(self.body.as_ref(), [0.0; 3])? {
            NamedPoint::Body(_) if scene.mobile_robot().is_some() => {
                Ok(SpeedTerm::Planar(scene.0.robot(), Pose::identity(), 0.0))
            }
            NamedPoint::Body(point) => Ok(SpeedTerm::Spatial(point)),
            NamedPoint::Marker(_) => Err(scene.error("is about a marker, which has no speed")),
        }
    }
}
