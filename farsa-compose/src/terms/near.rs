//! Things within a distance.

use farsa_body::ports::{BodyId, Handles, Kinematics};
use farsa_body::sensors::Point;
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::named_point::NamedPoint;
use crate::part::{Moment, PartScene, Term, TermPart};
use crate::terms::place::{Place, apart, length, yes};

/// 1 while the surfaces of robot and thing are closer than this.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Near {
    /// Name of the thing.
    object: String,
    /// Greatest distance [m].
    #[schemars(range(min = 0.0, max = 1000.0))]
    within: f64,
    /// Body of a robot with joints, by default the first.
    body: Option<String>,
    /// Point of that body [m].
    #[serde(default)]
    #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
    point: [f64; 3],
}

/// The thing and the greatest distance of the surfaces [m].
#[derive(Clone, Debug)]
pub(super) enum NearTerm {
    /// With the number of the robot and the sum of the radii [m].
    Planar {
        robot: usize,
        place: Place,
        radii: [f64; 2],
        within: f64,
    },
    Spatial {
        thing: NamedPoint,
        from: Point,
        within: f64,
    },
}

impl<W: Kinematics + Handles<Body = BodyId>> Term<W> for NearTerm {
    fn start(&mut self, world: &W, _: &Moment<'_>) {
        if let Self::Planar { place, .. } = self {
            place.locate(world);
        }
    }

    fn step(&mut self, world: &W, now: &Moment<'_>) {
        Term::start(self, world, now);
    }

    fn value(&self, world: &W, now: &Moment<'_>) -> f64 {
        let (distance, within) = match self {
            Self::Planar { robot, place, radii: [own, other], within } => {
                (length(place.way(&now.poses[*robot])) - own - other, *within)
            }
            Self::Spatial { thing, from, within } => {
                (apart(thing.position(world, now.markers), from.position(world).map(f64::from)), *within)
            }
        };
        // NaN makes the trial fail. The comparison alone would turn a broken position into 0.
        if distance.is_finite() { yes(distance < within) } else { f64::NAN }
    }

    fn has_state(&self) -> bool {
        matches!(self, Self::Planar { place, .. } if place.has_state())
    }
}

impl TermPart for Near {
    type Term = NearTerm;

    fn term(&self, scene: &PartScene<'_>) -> Result<NearTerm, Error> {
        let from = scene.0.point(self.body.as_ref(), self.point)?;
        if let Some(robot) = scene.mobile_robot() {
            let (body, radius) = scene.0.cylinder(&self.object, "object")?;
            let (place, radii) = (Place::of(body, scene), [robot.radius, radius]);
            return Ok(NearTerm::Planar { robot: scene.0.robot(), place, radii, within: self.within });
        }
        let (thing, reach) = scene.0.target_with_reach(&self.object, "object")?;
        // Distances are those of centers, so the reach of the thing is a part of the limit.
        Ok(NearTerm::Spatial { thing, from, within: reach + self.within })
    }
}
