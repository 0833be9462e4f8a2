//! Places in a box.

use farsa_body::Pose;
use farsa_lab::Error;
use farsa_num::{Scalar, Stream};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::spot::Spot;
use crate::part::{PartScene, Start, StartPart};
use crate::starts::TRIES;

/// Uniformly in a box, for experiments with joints.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct InBox {
    /// Least x, y and z [m].
    #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
    low: [f64; 3],
    /// Greatest x, y and z [m].
    #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
    high: [f64; 3],
    /// Least distance from everything placed earlier [m].
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1000.0))]
    apart: f64,
}

impl<W: ?Sized> Start<W> for InBox {
    fn pose(&self, _: &W, spot: &mut Spot<'_>, stream: &mut Stream) -> Option<Pose> {
        let far = spot.radius + self.apart;
        let at = (0..TRIES).find_map(|_| {
            let at = [0, 1, 2].map(|k| stream.range(self.low[k] as f32, self.high[k] as f32));
            let clear = |(other, reach): &([f32; 3], f64)| {
                let [x, y, z] = [0, 1, 2].map(|k| f64::from(at[k] - other[k]));
                Scalar::sqrt(x * x + y * y + z * z) >= reach + far
            };
            spot.earlier.iter().all(clear).then_some(at)
        });
        at.map(Pose::at)
    }
}

impl StartPart for InBox {
    type Start = Self;

    fn start(&self, scene: &PartScene<'_>) -> Result<Self, Error> {
        if (0..3).any(|k| self.low[k] > self.high[k]) {
            return Err(scene.error("has a `low` above its `high`"));
        }
        Ok(self.clone())
    }
}
