//! Attachment devices.

use farsa_body::motors::AttachmentMotor;
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{MotorPart, PartScene, Quantity};

/// The attachment device. Above 1/2 it holds the robot in front.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Attachment {}

impl MotorPart for Attachment {
    type Motor = AttachmentMotor;

    fn motor(&self, scene: &PartScene<'_>) -> Result<AttachmentMotor, Error> {
        let place = scene.planar()?;
        place.parts.attachment.map(AttachmentMotor::new).ok_or_else(|| place.lacks("an attachment device"))
    }

    fn quantity(&self, _: usize, _: &PartScene<'_>) -> Quantity {
        Quantity::new("the attachment device: more than 1/2 holds", "1", [0.0, 1.0])
    }

    fn pulls(&self) -> bool {
        true
    }
}
