//! What there is to see beside a robot's description.

use farsa_body::{BodyId, Pose};

use crate::shape::appearance::{Color, Placed, Role};
use crate::shape::form::Form;

/// A shape to be seen that no [`Robot`](farsa_body::Robot) holds: a wheeled robot's hull, a wall, an area on the ground.
#[derive(Clone, Debug, PartialEq)]
pub struct Prop {
    /// What it is called.
    pub name: String,
    /// The body it moves with; `None` for what stands.
    pub body: Option<BodyId>,
    /// Its form.
    pub form: Form,
    /// Its frame in the body's frame, or in the world.
    pub placement: Pose<f64>,
    /// What it is to the one who looks.
    pub role: Role,
    /// Its colour; `None` for that of its role.
    pub color: Option<Color>,
}

impl Prop {
    /// A standing shape in its role's colour.
    pub fn new(name: &str, form: Form, placement: Pose<f64>, role: Role) -> Self {
        Self { name: name.into(), body: None, form, placement, role, color: None }
    }

    /// The same shape, moving with a body.
    pub fn on(self, body: BodyId) -> Self {
        Self { body: Some(body), ..self }
    }

    /// The same shape in this colour.
    pub fn with_color(self, color: Color) -> Self {
        Self { color: Some(color), ..self }
    }

    /// The shape in its place, when its body is at `pose`.
    pub(crate) fn placed(&self, pose: &Pose<f64>) -> Placed {
        let placed = Placed::new(self.form, pose.compose(&self.placement), self.role);
        Placed { color: self.color, ..placed }
    }
}

/// A colour of light, red, green and blue [0..1], as screens take it.
pub fn screen_color(light: [f64; 3]) -> Color {
    light.map(|x| (x.clamp(0.0, 1.0) * 255.0).round() as u8)
}
