//! Shapes that no robot contains.

use farsa_body::Pose;
use farsa_body::ports::BodyId;

use crate::shape::appearance::{Color, Instance, Role};
use crate::shape::geometry::Geometry;

/// A visible shape that no [`Robot`](farsa_body::robot::Robot) contains, such as a hull, a wall or an area on the ground.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneObject {
    /// Its name.
    pub name: String,
    /// The body it moves with, `None` for a fixed shape.
    pub body: Option<BodyId>,
    /// Its geometry.
    pub geometry: Geometry,
    /// Its frame in the body's frame, or in the world.
    pub placement: Pose<f64>,
    /// Its role.
    pub role: Role,
    /// Its color, `None` for that of its role.
    pub color: Option<Color>,
    /// The condition of its visibility, `None` for always.
    pub shown: Option<ShownWhile>,
}

/// A condition of visibility: a channel has a value from `low` to `high`.
#[derive(Clone, Debug, PartialEq)]
pub struct ShownWhile {
    /// The channel, by its name in [`Schema::columns`](crate::Schema::columns). With an unknown name the shape is never visible.
    pub channel: String,
    /// The least value.
    pub low: f64,
    /// The largest value.
    pub high: f64,
}

impl SceneObject {
    /// Creates a fixed shape in the color of its role.
    pub fn new(name: &str, geometry: Geometry, placement: Pose<f64>, role: Role) -> Self {
        Self { name: name.into(), body: None, geometry, placement, role, color: None, shown: None }
    }

    /// Returns the shape moving with a body.
    pub fn on_body(self, body: BodyId) -> Self {
        Self { body: Some(body), ..self }
    }

    /// Returns the shape in this color.
    pub fn with_color(self, color: Color) -> Self {
        Self { color: Some(color), ..self }
    }

    /// Returns the shape with a condition of visibility: a channel of [`Schema::columns`](crate::Schema::columns) has a value from
    /// `low` to `high`.
    ///
    /// Pages round a channel to 65535 values, so choose bounds between values that occur.
    pub fn shown_while(self, channel: &str, low: f64, high: f64) -> Self {
        Self { shown: Some(ShownWhile { channel: channel.into(), low, high }), ..self }
    }

    /// Returns the shape placed by the `pose` of its body.
    pub(crate) fn placed(&self, pose: &Pose<f64>) -> Instance {
        let placed = Instance::new(self.geometry, pose.compose(&self.placement), self.role);
        Instance { color: self.color, ..placed }
    }
}

/// Converts a color of light, red, green and blue [0..1], to a screen color.
pub fn screen_color(light: [f64; 3]) -> Color {
    light.map(|x| (x.clamp(0.0, 1.0) * 255.0).round() as u8)
}
