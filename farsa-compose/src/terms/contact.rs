//! Gaps and collisions with things.

use farsa_body::ports::{BodyId, Contacts, Handles, Kinematics, PairId};
use farsa_lab::Error;
use farsa_num::Scalar;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{Moment, PartScene, Term, TermPart};
use crate::terms::place::{Place, yes};
use crate::terms::touch::TouchTerm;

/// Distance between the hulls of robot and thing [m].
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Gap {
    /// Name of the thing.
    object: String,
}

/// 1 while robot and thing collide, or their hulls are at most this far apart.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Contact {
    /// Name of the thing.
    object: String,
    /// Greatest distance [m].
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1000.0))]
    within: f64,
}

/// The distance between the hulls of a robot and a thing, whose radii have this sum [m].
#[derive(Clone, Debug)]
pub(super) struct GapTerm {
    robot: usize,
    place: Place,
    radii: f64,
}

impl GapTerm {
    fn new(object: &str, scene: &PartScene<'_>) -> Result<Self, Error> {
        let own = scene.planar()?.robot.radius;
        let (body, radius) = scene.0.cylinder(object, "object")?;
        Ok(Self { robot: scene.0.robot(), place: Place::of(body, scene), radii: own + radius })
    }

    fn gap(&self, now: &Moment<'_>) -> f64 {
        let [x, y] = [0, 1].map(|k| now.poses[self.robot].position[k] - self.place.pose.position[k]);
        f64::from(Scalar::sqrt(x * x + y * y)) - self.radii
    }
}

impl<W: Kinematics + Handles<Body = BodyId>> Term<W> for GapTerm {
    fn start(&mut self, world: &W, _: &Moment<'_>) {
        self.place.locate(world);
    }

    fn step(&mut self, world: &W, _: &Moment<'_>) {
        self.place.locate(world);
    }

    fn value(&self, _: &W, now: &Moment<'_>) -> f64 {
        self.gap(now)
    }

    fn has_state(&self) -> bool {
        self.place.has_state()
    }
}

/// A collision of a robot with a thing.
#[derive(Clone, Debug)]
pub(super) enum ContactTerm {
    /// With the body of the robot and the greatest gap [m].
    Planar {
        gap: GapTerm,
        body: BodyId,
        within: f64,
    },
    Spatial(TouchTerm),
}

impl<W: Contacts + Kinematics + Handles<Body = BodyId>> Term<W> for ContactTerm {
    fn start(&mut self, world: &W, now: &Moment<'_>) {
        if let Self::Planar { gap, .. } = self {
            Term::start(gap, world, now);
        }
    }

    fn step(&mut self, world: &W, now: &Moment<'_>) {
        if let Self::Planar { gap, .. } = self {
            Term::step(gap, world, now);
        }
    }

    fn value(&self, world: &W, now: &Moment<'_>) -> f64 {
        let (gap, body, within) = match self {
            Self::Planar { gap, body, within } => (gap, *body, *within),
            Self::Spatial(touch) => return touch.value(world, now),
        };
        let meets = |body: BodyId, other: BodyId| {
            let pair = PairId(body.0);
            world.touches(pair) && world.pair_bodies(pair)[1] == Some(other)
        };
        // A robot that also collides with a wall may report the wall only.
        let thing = gap.place.body;
        let met = meets(body, thing) || meets(thing, body);
        let gap = gap.gap(now);
        if gap.is_finite() { yes(met || gap <= within) } else { f64::NAN }
    }

    fn has_state(&self) -> bool {
        matches!(self, Self::Planar { gap, .. } if gap.place.has_state())
    }
}

impl TermPart for Gap {
    type Term = GapTerm;

    fn term(&self, scene: &PartScene<'_>) -> Result<GapTerm, Error> {
        GapTerm::new(&self.object, scene)
    }
}

impl TermPart for Contact {
    type Term = ContactTerm;

    fn term(&self, scene: &PartScene<'_>) -> Result<ContactTerm, Error> {
        if scene.mobile_robot().is_none() && self.within == 0.0 {
            return Ok(ContactTerm::Spatial(TouchTerm(scene.0.touching(&[], Some(&self.object))?)));
        }
        let body = scene.planar()?.parts.body;
        Ok(ContactTerm::Planar { gap: GapTerm::new(&self.object, scene)?, body, within: self.within })
    }
}
