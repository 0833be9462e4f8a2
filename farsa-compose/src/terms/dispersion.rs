//! Spread and clusters of robots.

use farsa_body::Pose;
use farsa_lab::Error;
use farsa_num::Scalar;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::term::Constants;
use crate::part::{Moment, PartScene, Term, TermPart};
use crate::terms::gathering::{Gathering, distance};

/// Sum of the robots' squared distances from their centroid, in squared diameters of a robot.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Dispersion {}

/// Number of groups of robots without gaps that another robot fits into.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Clusters {}

/// Share of the robots in the largest of these groups.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct LargestCluster {}

/// Proximity of the other robots: 1 at one place .. 0 at a mean distance of the arena's diagonal.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct NearOthers {}

/// A number of a gathering of robots of this radius [m].
#[derive(Clone, Debug)]
pub(super) struct GatheringTerm(f64, fn(Gathering, &Moment<'_>) -> f64);

impl<W: ?Sized> Term<W> for GatheringTerm {
    fn value(&self, _: &W, now: &Moment<'_>) -> f64 {
        (self.1)(Gathering::new(now.poses, self.0), now)
    }

    fn has_state(&self) -> bool {
        false
    }
}

macro_rules! of_gathering {
    ($($name:ident, $value:expr;)*) => {
        $(impl TermPart for $name {
            type Term = GatheringTerm;

            fn term(&self, scene: &PartScene<'_>) -> Result<GatheringTerm, Error> {
                Ok(GatheringTerm(scene.planar()?.robot.radius, $value))
            }

            fn is_of_team(&self) -> bool {
                true
            }

            fn is_constant(&self, of: &dyn Constants) -> bool {
                of.is_alone()
            }
        })*
    };
}
of_gathering! {
    Dispersion, |found, _| found.dispersion;
    Clusters, |found, _| found.clusters as f64;
    LargestCluster, |found, now| found.largest as f64 / now.poses.len().max(1) as f64;
}

/// The number of the robot, and the arena's diagonal [m].
#[derive(Clone, Debug)]
pub(super) struct NearOthersTerm(usize, f64);

impl<W: ?Sized> Term<W> for NearOthersTerm {
    fn value(&self, _: &W, now: &Moment<'_>) -> f64 {
        // 1 - mean |p - p_j| / diagonal. The sum contains the robot itself at distance 0, the mean does not count it.
        let pose = &now.poses[self.0];
        let way = |other: &Pose| f64::from(distance(pose, other));
        let others = now.poses.len().saturating_sub(1).max(1) as f64;
        1.0 - now.poses.iter().map(way).sum::<f64>() / others / self.1
    }

    fn has_state(&self) -> bool {
        false
    }
}

impl TermPart for NearOthers {
    type Term = NearOthersTerm;

    fn term(&self, scene: &PartScene<'_>) -> Result<NearOthersTerm, Error> {
        scene.planar()?;
        let [width, depth] = scene.0.size();
        Ok(NearOthersTerm(scene.0.robot(), Scalar::sqrt(width * width + depth * depth)))
    }

    fn is_constant(&self, of: &dyn Constants) -> bool {
        of.is_alone()
    }
}
