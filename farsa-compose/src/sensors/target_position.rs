//! Positions of things.

use farsa_body::ports::{BodyId, Channels, Handles, Kinematics, Sensor};
use farsa_body::sensors;
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::named_point::NamedPoint;
use crate::part::{PartScene, Quantity, SensorPart};
use crate::sensors::axes::AxesName;
use crate::sensors::marker_position::MarkerPosition;
use crate::sensors::{AXES, wrong};

/// Position of a thing, in three channels. The third is its height.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct TargetPosition {
    /// Name of a thing, or of a body of a robot with joints.
    target: String,
    /// Body of a robot with joints from which it is seen, by default the first.
    body: Option<String>,
    /// Point of that body [m].
    #[serde(default)]
    #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
    point: [f64; 3],
    /// Axes of the position.
    #[serde(default)]
    axes: AxesName,
    /// Reading per meter.
    #[serde(default = "one")]
    #[schemars(range(min = -1000.0, max = 1000.0))]
    scale: f64,
}

fn one() -> f64 {
    1.0
}

/// The position of a body, or of a marker.
#[derive(Clone, Debug)]
pub(crate) enum TargetSensor {
    Body(sensors::TargetPosition),
    Marker(MarkerPosition),
}

impl TargetSensor {
    /// Updates the position of a marker from those of all markers [m].
    pub(crate) fn look(&mut self, markers: &[[f32; 3]]) {
        if let Self::Marker(marker) = self {
            marker.look(markers);
        }
    }
}

impl Channels for TargetSensor {
    fn channels(&self) -> usize {
        3
    }
}

impl<W: Kinematics + Handles<Body = BodyId>> Sensor<W> for TargetSensor {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        match self {
            Self::Body(target) => target.read(world, out),
            Self::Marker(marker) => marker.read(world, out),
        }
    }
}

impl SensorPart for TargetPosition {
    type Sensor = TargetSensor;

    fn sensor(&self, scene: &PartScene<'_>) -> Result<TargetSensor, Error> {
        let (axes, scale) = (self.axes.into(), self.scale as f32);
        let target = scene.0.target(&self.target, "target")?;
        let from = scene.0.point(self.body.as_ref(), self.point)?;
        Ok(match target {
            NamedPoint::Body(target) => {
                TargetSensor::Body(sensors::TargetPosition::new(target, from, axes, scale).map_err(wrong)?)
            }
            NamedPoint::Marker(marker) => TargetSensor::Marker(MarkerPosition::new(marker, from, axes, scale)),
        })
    }

    fn quantity(&self, channel: usize, scene: &PartScene<'_>) -> Quantity {
        // A channel is scale times the distance, so it is 1 at 1 / scale meters.
        let end = if self.scale == 0.0 { 1.0 } else { 1.0 / self.scale };
        let from = if scene.mobile_robot().is_some() {
            String::new()
        } else {
            format!("from {} ", scene.0.called(self.body.as_ref()))
        };
        let text = format!("{} of the way {from}to {}", AXES[channel % 3], self.target);
        Quantity::new(text, "m", [0.0, end])
    }
}
