//! Robots in areas.

use farsa_body::Pose;
use farsa_body::ports::{BodyId, Handles, Kinematics};
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::Area;
use crate::part::{Moment, PartScene, Term, TermPart};
use crate::terms::place::yes;

/// 1 while the robot's center is in an area.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct InArea {
    /// Name of a disc or rectangle.
    area: String,
    /// Further areas.
    #[serde(default)]
    or: Vec<String>,
}

/// Share of the robots whose centers are in the same area, for the area with the most of them.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct FullestArea {
    /// Name of a disc or rectangle, or of several.
    area: String,
}

/// Number of robots whose centers are in an area.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct RobotsInArea {
    /// Name of a disc or rectangle, or of several.
    area: String,
}

/// The number of the robot, and areas of which it has to be in one.
#[derive(Clone, Debug)]
pub(super) struct InAreaTerm(usize, Vec<Area>);

impl<W: Kinematics + Handles<Body = BodyId>> Term<W> for InAreaTerm {
    fn value(&self, world: &W, now: &Moment<'_>) -> f64 {
        yes(self.1.iter().any(|area| area.contains(world, now.poses[self.0])))
    }

    fn has_state(&self) -> bool {
        false
    }
}

/// Areas, of which the one with the most robots counts.
#[derive(Clone, Debug)]
pub(super) struct FullestAreaTerm(Vec<Area>);

impl<W: Kinematics + Handles<Body = BodyId>> Term<W> for FullestAreaTerm {
    fn value(&self, world: &W, now: &Moment<'_>) -> f64 {
        let mut robots = vec![0_u32; self.0.len()];
        for pose in now.poses {
            // A robot in two overlapping areas counts for the first one only.
            if let Some(area) = self.0.iter().position(|area| area.contains(world, *pose)) {
                robots[area] += 1;
            }
        }
        f64::from(robots.into_iter().max().unwrap_or(0)) / now.poses.len().max(1) as f64
    }

    fn has_state(&self) -> bool {
        false
    }
}

/// Areas in which robots are counted.
#[derive(Clone, Debug)]
pub(super) struct RobotsInAreaTerm(Vec<Area>);

impl<W: Kinematics + Handles<Body = BodyId>> Term<W> for RobotsInAreaTerm {
    fn value(&self, world: &W, now: &Moment<'_>) -> f64 {
        let inside = |pose: &&Pose| self.0.iter().any(|area| area.contains(world, **pose));
        now.poses.iter().filter(inside).count() as f64
    }

    fn has_state(&self) -> bool {
        false
    }
}

impl TermPart for InArea {
    type Term = InAreaTerm;

    fn term(&self, scene: &PartScene<'_>) -> Result<InAreaTerm, Error> {
        let mut all = scene.0.areas(&self.area, "area")?;
        for (index, area) in self.or.iter().enumerate() {
            all.extend(scene.0.areas(area, &format!("or/{index}"))?);
        }
        Ok(InAreaTerm(scene.0.robot(), all))
    }
}

impl TermPart for FullestArea {
    type Term = FullestAreaTerm;

    fn term(&self, scene: &PartScene<'_>) -> Result<FullestAreaTerm, Error> {
        Ok(FullestAreaTerm(scene.0.areas(&self.area, "area")?))
    }

    fn is_of_team(&self) -> bool {
        true
    }
}

impl TermPart for RobotsInArea {
    type Term = RobotsInAreaTerm;

    fn term(&self, scene: &PartScene<'_>) -> Result<RobotsInAreaTerm, Error> {
        Ok(RobotsInAreaTerm(scene.0.areas(&self.area, "area")?))
    }

    fn is_of_team(&self) -> bool {
        true
    }
}
