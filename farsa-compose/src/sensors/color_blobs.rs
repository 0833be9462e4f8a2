//! Positions of colors in an image.

use farsa_body::robots::MobileRobot;
use farsa_body::sensors;
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{PartScene, Quantity, SensorPart};
use crate::sensors::color::ColorRange;
use crate::sensors::eye::Eye;
use crate::sensors::wrong;

/// Positions of colors in an eye's image: the offset of each center to the left and upwards, in halves of the
/// image's width, and its share of all pixels. Absent colors are three zeros. Recordings show the image.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct ColorBlobs {
    /// The eye.
    eye: Eye,
    /// Colors.
    colors: Vec<ColorRange>,
}

impl SensorPart for ColorBlobs {
    type Sensor = sensors::ColorBlobs;

    fn sensor(&self, scene: &PartScene<'_>) -> Result<sensors::ColorBlobs, Error> {
        let camera = self.eye.camera(self.eye.size(), scene)?;
        sensors::ColorBlobs::new(camera, self.colors.iter().map(ColorRange::band).collect()).map_err(wrong)
    }

    fn quantity(&self, channel: usize, _: &PartScene<'_>) -> Quantity {
        let color = self.colors.get(channel / 3).map_or("", |color| color.name.as_str());
        let text = match channel % 3 {
            0 => format!("halves of the image's width that {color} is to the left"),
            1 => format!("halves of the image's width that {color} is upwards"),
            _ => format!("share of the pixels that are {color}"),
        };
        Quantity::new(text, "1", [0.0, 1.0])
    }

    fn rays(&self, _: Option<&MobileRobot>) -> usize {
        self.eye.rays()
    }
}
