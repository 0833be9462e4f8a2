//! Shapes that no robot contains.

use farsa_body::Pose;
use farsa_body::ports::BodyId;

use crate::shape::appearance::{Color, Instance, Role};
use crate::shape::geometry::Geometry;

/// A visible shape that does not belong to a [`Robot`](farsa_body::robot::Robot). Examples are hulls, walls and areas
/// on the ground.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneObject {
    /// Name of the object.
    pub name: String,
    /// Body with which the shape moves. Use `None` for a fixed shape.
    pub body: Option<BodyId>,
    /// Geometry of the shape.
    pub geometry: Geometry,
    /// Pose in the frame of its body, or in the world if it is fixed.
    pub placement: Pose<f64>,
    /// Role of the shape.
    pub role: Role,
    /// Color of the shape. If this is `None`, the color of its role is used.
    pub color: Option<Color>,
    /// Condition under which the shape is visible. If this is `None`, it is always visible.
    pub shown: Option<ShownWhile>,
}

/// Condition under which a shape is visible. The value of a channel must be between `low` and `high`.
#[derive(Clone, Debug, PartialEq)]
pub struct ShownWhile {
    /// Name of the channel in [`Schema::columns`](crate::Schema::columns). If there is no such channel, the shape is
    /// never visible.
    pub channel: String,
    /// Minimum value.
    pub low: f64,
    /// Maximum value.
    pub high: f64,
}

impl SceneObject {
    /// Creates a fixed shape with the color of its role.
    pub fn new(name: &str, geometry: Geometry, placement: Pose<f64>, role: Role) -> Self {
        Self { name: name.into(), body: None, geometry, placement, role, color: None, shown: None }
    }

    /// Attaches the shape to a body, so that it moves with it.
    pub fn on_body(self, body: BodyId) -> Self {
        Self { body: Some(body), ..self }
    }

    /// Sets the color.
    pub fn with_color(self, color: Color) -> Self {
        Self { color: Some(color), ..self }
    }

    /// Shows the shape only while a channel has a value from `low` to `high`. Channels are those of
    /// [`Schema::columns`](crate::Schema::columns).
    ///
    /// Since pages round a channel to 65535 values, choose bounds between values that actually occur.
    pub fn shown_while(self, channel: &str, low: f64, high: f64) -> Self {
        Self { shown: Some(ShownWhile { channel: channel.into(), low, high }), ..self }
    }

    /// Returns the shape placed by the `pose` of its body.
    pub(crate) fn placed(&self, pose: &Pose<f64>) -> Instance {
        let placed = Instance::new(self.geometry, pose.compose(&self.placement), self.role);
        Instance { color: self.color, ..placed }
    }
}

/// Converts the color of a light to a color on a screen. Red, green and blue are from 0 to 1.
pub fn screen_color(light: [f64; 3]) -> Color {
    light.map(|x| (x.clamp(0.0, 1.0) * 255.0).round() as u8)
}
