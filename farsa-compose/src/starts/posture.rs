//! Postures of the whole robot.

use farsa_body::Pose;
use farsa_lab::Error;
use farsa_num::Stream;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::spot::Spot;
use crate::part::{PartScene, Start, StartPart};

/// All joints and the free body of a model in a posture of its file, with noise.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Posture {
    /// Keyframe of the model, by default the configuration of the file.
    keyframe: Option<String>,
    /// Largest uniform noise of each position, also of each number of a quaternion [rad or m].
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1000.0))]
    noise: f64,
    /// Largest uniform noise of each speed [rad/s or m/s].
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1000.0))]
    speeds: f64,
    /// Height that is added to the free body [m]. Some postures have feet inside the floor.
    #[serde(default)]
    #[schemars(range(min = -1000.0, max = 1000.0))]
    raised: f64,
    /// Draws speeds from a normal distribution, with `speeds` as its deviation.
    #[serde(default)]
    normal: bool,
}

impl<W: ?Sized> Start<W> for Posture {
    fn pose(&self, _: &W, _: &mut Spot<'_>, _: &mut Stream) -> Option<Pose> {
        None
    }

    fn around(&self, position: f32, stream: &mut Stream) -> Option<[f32; 2]> {
        let [noise, speeds] = [self.noise, self.speeds].map(|most| most as f32);
        let position = position + stream.range(-noise, noise);
        let speed = if self.normal { stream.normal() * speeds } else { stream.range(-speeds, speeds) };
        Some([position, speed])
    }
}

impl StartPart for Posture {
    type Start = Self;

    fn start(&self, _: &PartScene<'_>) -> Result<Self, Error> {
        Ok(self.clone())
    }

    fn posture(&self) -> Option<(&str, f64)> {
        Some((self.keyframe.as_deref().unwrap_or_default(), self.raised))
    }
}
