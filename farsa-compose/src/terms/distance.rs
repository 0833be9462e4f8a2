//! Distances to things, and their decrease.

use farsa_body::Pose;
use farsa_body::ports::{BodyId, Handles, Kinematics};
use farsa_body::sensors::Point;
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::named_point::NamedPoint;
use crate::part::{Moment, PartScene, Term, TermPart};
use crate::terms::place::{Place, apart};

/// Distance between the centers of robot and thing [m].
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Distance {
    /// Name of the thing.
    object: String,
    /// Body of a robot with joints, by default the first.
    body: Option<String>,
    /// Point of that body [m].
    #[serde(default)]
    #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
    point: [f64; 3],
}

/// Decrease of the distance to a thing since the start [m].
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Approach {
    /// Name of the thing.
    object: String,
    /// Body of a robot with joints, by default the first.
    body: Option<String>,
    /// Point of that body [m].
    #[serde(default)]
    #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
    point: [f64; 3],
}

/// The distance between the centers of a robot and a thing.
#[derive(Clone, Debug)]
pub(super) enum DistanceTerm {
    /// With the number of the robot and its pose at the start.
    Planar {
        robot: usize,
        place: Place,
        started: Pose,
    },
    Spatial {
        thing: NamedPoint,
        from: Point,
    },
}

impl DistanceTerm {
    fn new(object: &str, body: Option<&String>, point: [f64; 3], scene: &PartScene<'_>) -> Result<Self, Error> {
        let from = scene.0.point(body, point)?;
        if scene.mobile_robot().is_some() {
            let place = Place::new(object, scene)?;
            return Ok(Self::Planar { robot: scene.0.robot(), place, started: Pose::identity() });
        }
        Ok(Self::Spatial { thing: scene.0.target(object, "object")?, from })
    }
}

impl<W: Kinematics + Handles<Body = BodyId>> Term<W> for DistanceTerm {
    fn start(&mut self, world: &W, now: &Moment<'_>) {
        if let Self::Planar { robot, place, started } = self {
            place.locate(world);
            *started = now.poses[*robot];
        }
    }

    fn step(&mut self, world: &W, _: &Moment<'_>) {
        if let Self::Planar { place, .. } = self {
            place.locate(world);
        }
    }

    fn value(&self, world: &W, now: &Moment<'_>) -> f64 {
        match self {
            Self::Planar { robot, place, .. } => place.distance(&now.poses[*robot]),
            Self::Spatial { thing, from } => {
                apart(thing.position(world, now.markers), from.position(world).map(f64::from))
            }
        }
    }

    fn has_state(&self) -> bool {
        matches!(self, Self::Planar { place, .. } if place.has_state())
    }
}

/// The decrease since the start.
#[derive(Clone, Debug)]
pub(super) struct ApproachTerm {
    distance: DistanceTerm,
    /// Distance at the start [m].
    far: f64,
}

impl<W: Kinematics + Handles<Body = BodyId>> Term<W> for ApproachTerm {
    fn start(&mut self, world: &W, now: &Moment<'_>) {
        Term::start(&mut self.distance, world, now);
        self.far = self.distance.value(world, now);
    }

    fn step(&mut self, world: &W, now: &Moment<'_>) {
        Term::step(&mut self.distance, world, now);
    }

    fn value(&self, world: &W, now: &Moment<'_>) -> f64 {
        let far = match &self.distance {
            // A thing that moves counts at its present place.
            DistanceTerm::Planar { place, started, .. } => place.distance(started),
            DistanceTerm::Spatial { .. } => self.far,
        };
        // d(0) - d(t)
        far - self.distance.value(world, now)
    }

    fn has_state(&self) -> bool {
        Term::<W>::has_state(&self.distance)
    }
}

impl TermPart for Distance {
    type Term = DistanceTerm;

    fn term(&self, scene: &PartScene<'_>) -> Result<DistanceTerm, Error> {
        DistanceTerm::new(&self.object, self.body.as_ref(), self.point, scene)
    }
}

impl TermPart for Approach {
    type Term = ApproachTerm;

    fn term(&self, scene: &PartScene<'_>) -> Result<ApproachTerm, Error> {
        let distance = DistanceTerm::new(&self.object, self.body.as_ref(), self.point, scene)?;
        Ok(ApproachTerm { distance, far: 0.0 })
    }
}
