//! Offsets between things in an image.

use farsa_body::ports::BodyId;
use farsa_body::sensors;
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::named_point::NamedPoint;
use crate::part::{PartScene, Quantity, SensorPart};
use crate::sensors::eye::Eye;

/// Offset between two things in an eye's image, to the left and upwards in widths of the image: -1 to 1. It is 0
/// if one is behind the eye. Nothing hides them.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct VisualOffset {
    /// The eye.
    eye: Eye,
    /// Name of a thing, or of a body of the robot.
    of: String,
    /// Name of the thing or body from which the offset is measured.
    from: String,
}

impl SensorPart for VisualOffset {
    type Sensor = sensors::VisualOffset;

    fn sensor(&self, scene: &PartScene<'_>) -> Result<sensors::VisualOffset, Error> {
        let point = |name: &String, key: &str| -> Result<(BodyId, [f32; 3]), Error> {
            match scene.0.target(name, key)? {
                NamedPoint::Body(point) => Ok((point.body, point.at)),
                NamedPoint::Marker(_) => Err(scene.0.error_at(key, format!("`{name}` is a marker, which no eye sees"))),
            }
        };
        let (target, from) = (point(&self.of, "of")?, point(&self.from, "from")?);
        // Only the pose and the field of view of the camera matter.
        Ok(sensors::VisualOffset::new(self.eye.camera([1, 1], scene)?, target, from))
    }

    fn quantity(&self, channel: usize, _: &PartScene<'_>) -> Quantity {
        let (way, Self { of, from, .. }) = (["to the left", "above"][channel % 2], self);
        Quantity::new(format!("widths of the image that {of} is {way} of {from}"), "1", [0.0, 1.0])
    }
}
