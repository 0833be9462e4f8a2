//! Free places.

use farsa_body::Pose;
use farsa_lab::Error;
use farsa_lab::advanced::PlanarWorld;
use farsa_num::Stream;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::spot::Spot;
use crate::part::{PartScene, Start, StartPart};
use crate::starts::free::Free;

/// Uniformly in free space.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Anywhere {
    /// Least distance from the walls [m].
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1000.0))]
    walls: f64,
    /// Least distance from everything placed earlier [m], for areas from other areas.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1000.0))]
    apart: f64,
    /// Measures both distances from the centers of areas instead of their edges.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    centers: bool,
}

impl<W: PlanarWorld> Start<W> for Free {
    fn pose(&self, world: &W, spot: &mut Spot<'_>, stream: &mut Stream) -> Option<Pose> {
        self.find(world, None, spot, stream)
    }
}

impl StartPart for Anywhere {
    type Start = Free;

    fn start(&self, _: &PartScene<'_>) -> Result<Free, Error> {
        Ok(Free { walls: self.walls, apart: self.apart })
    }

    fn measures_centers(&self) -> bool {
        self.centers
    }
}
