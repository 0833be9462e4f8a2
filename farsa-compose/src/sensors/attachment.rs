//! Attachment devices.

use farsa_body::sensors::AttachmentSensor;
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{PartScene, Quantity, SensorPart};

/// State of the attachment device: 1 while it holds something, else 0.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Attachment {}

impl SensorPart for Attachment {
    type Sensor = AttachmentSensor;

    fn sensor(&self, scene: &PartScene<'_>) -> Result<AttachmentSensor, Error> {
        Ok(AttachmentSensor::new(scene.planar()?.parts.body))
    }

    fn quantity(&self, _: usize, _: &PartScene<'_>) -> Quantity {
        Quantity::new("whether something is held", "1", [0.0, 1.0])
    }
}
