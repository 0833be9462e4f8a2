//! Places of things.

use farsa_body::Pose;
use farsa_body::ports::{BodyId, Handles, Kinematics};
use farsa_lab::Error;
use farsa_num::Scalar;

use crate::part::PartScene;
use crate::part::named_point::NamedPoint;

/// Body of a thing in a plane, with its pose.
#[derive(Clone, Debug)]
pub(super) struct Place {
    pub(super) body: BodyId,
    pub(super) pose: Pose,
    /// True if it can move during a trial.
    moves: bool,
}

impl Place {
    /// Finds the thing of the key `object`.
    pub(super) fn new(object: &str, scene: &PartScene<'_>) -> Result<Self, Error> {
        match scene.0.target(object, "object")? {
            NamedPoint::Body(point) => Ok(Self::of(point.body, scene)),
            NamedPoint::Marker(_) => Err(scene.error("is about a marker")),
        }
    }

    pub(super) fn of(body: BodyId, scene: &PartScene<'_>) -> Self {
        Self { body, pose: Pose::identity(), moves: scene.0.moves(body) }
    }

    pub(super) fn has_state(&self) -> bool {
        self.moves
    }

    /// Updates the pose.
    pub(super) fn locate<W: Kinematics + Handles<Body = BodyId>>(&mut self, world: &W) {
        self.pose = world.pose(self.body);
    }

    /// Computes the vector from a pose to the thing [m].
    pub(super) fn way(&self, from: &Pose) -> [f64; 2] {
        [0, 1].map(|k| f64::from(self.pose.position[k] - from.position[k]))
    }

    /// Computes the distance from a pose [m], with the difference formed in double precision.
    pub(super) fn distance(&self, from: &Pose) -> f64 {
        // The rotation leaves the length as it is, except for rounding.
        length(turned(from, [0, 1].map(|k| f64::from(self.pose.position[k]) - f64::from(from.position[k]))))
    }
}

/// Rotates a vector into the axes of a pose.
pub(super) fn turned(pose: &Pose, [u, v]: [f64; 2]) -> [f64; 2] {
    let [ahead, left, _] = pose.cast::<f64>().rotate_back([u, v, 0.0]);
    [ahead, left]
}

pub(super) fn length([x, y]: [f64; 2]) -> f64 {
    Scalar::sqrt(x * x + y * y)
}

pub(super) fn yes(flag: bool) -> f64 {
    if flag { 1.0 } else { 0.0 }
}

/// Computes the distance between two points [m].
pub(super) fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    length_in_space([0, 1, 2].map(|k| a[k] - b[k]))
}

pub(super) fn length_in_space([x, y, z]: [f64; 3]) -> f64 {
    Scalar::sqrt(x * x + y * y + z * z)
}

/// Reads the unit vector of the key `along`, in the plane of robots on wheels.
pub(super) fn direction(along: [f64; 3], scene: &PartScene<'_>) -> Result<[f64; 3], Error> {
    let [x, y, _] = along;
    if scene.mobile_robot().is_some() {
        let far = length([x, y]);
        let why = || scene.0.error_at("along", "points nowhere in the plane".into());
        return (far != 0.0).then(|| [x / far, y / far, 0.0]).ok_or_else(why);
    }
    let far = length_in_space(along);
    let why = || scene.0.error_at("along", "points nowhere".into());
    (far != 0.0).then(|| along.map(|x| x / far)).ok_or_else(why)
}
