//! Images.

use farsa_body::robots::MobileRobot;
use farsa_body::sensors;
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{PartScene, Quantity, SensorPart};
use crate::sensors::eye::Eye;

/// Image of an eye: red, green and blue of each pixel, row by row from the upper left. Pixels without a colored
/// thing are 0. Recordings show the image.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct CameraImage {
    /// The eye.
    eye: Eye,
}

impl SensorPart for CameraImage {
    type Sensor = sensors::CameraImage;

    fn sensor(&self, scene: &PartScene<'_>) -> Result<sensors::CameraImage, Error> {
        Ok(sensors::CameraImage::new(self.eye.camera(self.eye.size(), scene)?))
    }

    fn quantity(&self, channel: usize, _: &PartScene<'_>) -> Quantity {
        let color = ["red", "green", "blue"][channel % 3];
        // Pixels are row by row, with three colors each.
        let [columns, _] = self.eye.size();
        let (column, row) = (channel / 3 % columns, channel / 3 / columns);
        Quantity::new(format!("{color} of the pixel in column {column}, row {row}"), "1", [0.0, 1.0])
    }

    fn rays(&self, _: Option<&MobileRobot>) -> usize {
        self.eye.rays()
    }
}
