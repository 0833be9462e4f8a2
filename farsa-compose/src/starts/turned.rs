//! Positions of joints.

use farsa_body::Pose;
use farsa_lab::Error;
use farsa_num::Stream;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::spot::Spot;
use crate::part::{PartScene, Start, StartPart};

/// A joint at a uniformly drawn position.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Turned {
    /// Least position [rad or m].
    #[schemars(range(min = -1e6, max = 1e6))]
    low: f64,
    /// Greatest position [rad or m].
    #[schemars(range(min = -1e6, max = 1e6))]
    high: f64,
}

impl<W: ?Sized> Start<W> for Turned {
    fn pose(&self, _: &W, _: &mut Spot<'_>, _: &mut Stream) -> Option<Pose> {
        None
    }

    fn position(&self, stream: &mut Stream) -> Option<f32> {
        Some(stream.range(self.low as f32, self.high as f32))
    }
}

impl StartPart for Turned {
    type Start = Self;

    fn start(&self, scene: &PartScene<'_>) -> Result<Self, Error> {
        let Self { low, high } = self;
        if low > high {
            return Err(scene.error(format!("from {low} to {high} runs backwards")));
        }
        Ok(self.clone())
    }

    fn is_of_joints(&self) -> bool {
        true
    }
}
