//! Eyes of a robot with joints: cameras with an image.

use farsa_body::Pose;
use farsa_body::sensors::{Camera, CameraImage, ColorBlobs};
use farsa_lab::Error;
use farsa_num::sin_cos;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::PartScene;
use crate::part::object::SpatialSensor;

/// An eye of a robot with joints. It looks along the x axis of its frame, with y to the left and z up.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub(super) struct Eye {
    /// Body that carries it, by default the robot's first.
    body: Option<String>,
    /// Position in the body's axes [m].
    #[serde(default)]
    #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
    at: [f64; 3],
    /// Rotation about x, then y, then z of the body [deg].
    #[serde(default)]
    #[schemars(inner(range(min = -360.0, max = 360.0)))]
    turned: [f64; 3],
    /// Pixels from left to right.
    #[schemars(range(min = 1, max = 1000))]
    pub(super) columns: u32,
    /// Square pixels from top to bottom.
    #[schemars(range(min = 1, max = 1000))]
    rows: u32,
    /// Field of view from left to right [deg].
    #[schemars(range(min = 1.0, max = 179.0))]
    field_of_view: f64,
    /// Range [m].
    #[schemars(range(min = 0.001, max = 1000.0))]
    range: f64,
}

impl Eye {
    /// Returns the numbers of columns and rows.
    pub(super) fn size(&self) -> [usize; 2] {
        [self.columns, self.rows].map(|count| count as usize)
    }

    /// Counts the rays in a step.
    pub(super) fn rays(&self) -> usize {
        let [columns, rows] = self.size();
        columns * rows
    }

    /// Builds the camera with the given numbers of columns and rows.
    pub(super) fn camera(&self, size: [usize; 2], scene: &PartScene<'_>) -> Result<Camera, Error> {
        let (body, frame) = scene.0.frame(self.body.as_ref(), "eye/body")?;
        let about = |axis: usize| {
            // A turn by a about axis k is the quaternion with sin(a/2) at k and cos(a/2) last. The document has degrees.
            let (sine, cosine) = sin_cos(0.5 * self.turned[axis].to_radians());
            let mut rotation = [0.0, 0.0, 0.0, cosine];
            rotation[axis] = sine;
            Pose { rotation, ..Pose::identity() }
        };
        // R = Rz Ry Rx, so the turn about x is applied first.
        let turned = about(2).compose(&about(1)).compose(&about(0));
        let placement = frame.compose(&Pose::at(self.at)).compose(&turned);
        let made = Camera::new(body, placement.cast(), size, self.field_of_view.to_radians(), self.range as f32);
        made.map_err(super::wrong)
    }
}

/// Gets the camera of a sensor with an image.
pub(crate) fn camera_of(sensor: &dyn SpatialSensor) -> Option<&Camera> {
    let sensor = sensor.as_any();
    let image = sensor.downcast_ref::<CameraImage>().map(CameraImage::camera);
    image.or_else(|| sensor.downcast_ref::<ColorBlobs>().map(ColorBlobs::camera))
}
