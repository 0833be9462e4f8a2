//! What there is to see beside a robot's description.

use farsa_body::Pose;
use farsa_body::ports::BodyId;

use crate::shape::appearance::{Color, Instance, Role};
use crate::shape::geometry::Geometry;

/// A shape to be seen that no [`Robot`](farsa_body::robot::Robot) holds: a wheeled robot's hull, a wall, an area on the ground.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneObject {
    /// What it is called.
    pub name: String,
    /// The body it moves with; `None` for what stands.
    pub body: Option<BodyId>,
    /// Its geometry.
    pub geometry: Geometry,
    /// Its frame in the body's frame, or in the world.
    pub placement: Pose<f64>,
    /// What it is to the viewer.
    pub role: Role,
    /// Its colour; `None` for that of its role.
    pub color: Option<Color>,
    /// When it is seen; `None` for always.
    pub shown: Option<ShownWhile>,
}

/// The condition on which a shape is seen: while a channel has a value from `low` to `high`.
#[derive(Clone, Debug, PartialEq)]
pub struct ShownWhile {
    /// The channel as [`Schema::columns`](crate::Schema::columns) names it; with another name the shape is never seen.
    pub channel: String,
    /// The least value.
    pub low: f64,
    /// The greatest value.
    pub high: f64,
}

impl SceneObject {
    /// A standing shape in its role's colour.
    pub fn new(name: &str, geometry: Geometry, placement: Pose<f64>, role: Role) -> Self {
        Self { name: name.into(), body: None, geometry, placement, role, color: None, shown: None }
    }

    /// The same shape, moving with a body.
    pub fn on_body(self, body: BodyId) -> Self {
        Self { body: Some(body), ..self }
    }

    /// The same shape in this colour.
    pub fn with_color(self, color: Color) -> Self {
        Self { color: Some(color), ..self }
    }

    /// The same shape, seen while a channel, as [`Schema::columns`](crate::Schema::columns) names it, has a value from `low` to
    /// `high`.
    ///
    /// Pages keep 65535 values of a channel between its least and its greatest: bounds are best between values that it has.
    pub fn shown_while(self, channel: &str, low: f64, high: f64) -> Self {
        Self { shown: Some(ShownWhile { channel: channel.into(), low, high }), ..self }
    }

    /// The shape in its place, when its body is at `pose`.
    pub(crate) fn placed(&self, pose: &Pose<f64>) -> Instance {
        let placed = Instance::new(self.geometry, pose.compose(&self.placement), self.role);
        Instance { color: self.color, ..placed }
    }
}

/// A colour of light, red, green and blue [0..1], as screens take it.
pub fn screen_color(light: [f64; 3]) -> Color {
    light.map(|x| (x.clamp(0.0, 1.0) * 255.0).round() as u8)
}
