//! Fixed points.

use farsa_body::Pose;
use farsa_lab::Error;
use farsa_num::{Stream, sin_cos};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::spot::Spot;
use crate::part::{PartScene, Start, StartPart};

/// At a fixed point, and for robots with a fixed heading.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Fixed {
    /// Center: x and y, and z for experiments with joints [m].
    #[schemars(length(min = 2, max = 3), inner(range(min = -1000.0, max = 1000.0)))]
    point: Vec<f64>,
    /// Heading, counter-clockwise from the x axis [deg].
    #[serde(default)]
    #[schemars(range(min = -360.0, max = 360.0))]
    heading: f64,
    /// Draws the heading instead.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    drawn_heading: bool,
}

/// A pose, or a point with a drawn heading.
#[derive(Clone, Debug)]
pub(super) enum FixedStart {
    Pose(Pose),
    Point([f32; 3]),
}

impl<W: ?Sized> Start<W> for FixedStart {
    fn pose(&self, _: &W, spot: &mut Spot<'_>, stream: &mut Stream) -> Option<Pose> {
        Some(match self {
            Self::Pose(pose) => *pose,
            Self::Point(point) => spot.facing(*point, stream),
        })
    }
}

impl StartPart for Fixed {
    type Start = FixedStart;

    fn start(&self, scene: &PartScene<'_>) -> Result<FixedStart, Error> {
        let is_flat = scene.mobile_robot().is_some();
        if self.drawn_heading && !is_flat {
            return Err(scene.0.error_at("drawn_heading", "is for robots on wheels".into()));
        }
        let position = scene.0.start_point(&self.point, "point")?;
        let [x, y, z] = position.map(|x| x as f32);
        let heading = self.heading.to_radians();
        Ok(match (self.drawn_heading, is_flat) {
            (true, _) => FixedStart::Point([x, y, z]),
            (false, true) => FixedStart::Pose(Pose::planar([x, y], heading as f32)),
            (false, false) => {
                // A turn by h about z is the quaternion (0, 0, sin(h/2), cos(h/2)).
                let (sine, cosine) = sin_cos(0.5 * heading);
                FixedStart::Pose(Pose { position, rotation: [0.0, 0.0, sine, cosine] }.cast())
            }
        })
    }

    fn is_one_place(&self) -> bool {
        true
    }
}
