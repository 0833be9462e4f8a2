//! Free places near a thing.

use farsa_body::Pose;
use farsa_body::ports::BodyId;
use farsa_lab::Error;
use farsa_lab::advanced::PlanarWorld;
use farsa_num::Stream;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::spot::Spot;
use crate::part::{PartScene, Start, StartPart};
use crate::starts::free::Free;

/// Uniformly in free space near a thing.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Near {
    /// Name of the thing.
    of: String,
    /// Greatest distance between the centers [m].
    #[schemars(range(min = 0.0, max = 1000.0))]
    within: f64,
    /// Least distance from the walls [m].
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1000.0))]
    walls: f64,
    /// Least distance from everything placed earlier [m].
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1000.0))]
    apart: f64,
}

/// A search in a disc around a thing [m].
#[derive(Clone, Debug)]
pub(super) struct NearStart {
    of: BodyId,
    within: f64,
    free: Free,
}

impl<W: PlanarWorld> Start<W> for NearStart {
    fn pose(&self, world: &W, spot: &mut Spot<'_>, stream: &mut Stream) -> Option<Pose> {
        let [x, y, _] = world.pose(self.of).position;
        self.free.find(world, Some(([x, y], self.within as f32)), spot, stream)
    }
}

impl StartPart for Near {
    type Start = NearStart;

    fn start(&self, scene: &PartScene<'_>) -> Result<NearStart, Error> {
        let of = scene.0.placed_before(&self.of, "of")?;
        Ok(NearStart { of, within: self.within, free: Free { walls: self.walls, apart: self.apart } })
    }
}
