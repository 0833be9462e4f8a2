//! Role, color and place of shapes.

use farsa_body::Pose;

use crate::shape::geometry::Geometry;

/// Color on a screen, as red, green and blue.
pub type Color = [u8; 3];

/// Role of a shape in a picture. It determines the default color, and whether cameras are fitted to the shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Part of a robot.
    Robot,
    /// Thing that moves, or that a robot handles.
    Object,
    /// Ground or wall. Cameras are not fitted to these.
    Ground,
    /// Translucent mark on the ground, such as a target area.
    Area,
}

impl Role {
    /// Returns the word of a page.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Robot => "robot",
            Self::Object => "thing",
            Self::Ground => "ground",
            Self::Area => "area",
        }
    }
}

/// A shape with its pose in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instance {
    /// Geometry of the shape.
    pub geometry: Geometry,
    /// Pose in the world.
    pub pose: Pose<f64>,
    /// Role of the shape.
    pub role: Role,
    /// Color of the shape. If this is `None`, the color of its role is used.
    pub color: Option<Color>,
    /// If this is `true`, the camera `close` is fitted to this shape. Note that it is always fitted to things.
    pub focus: bool,
}

/// Colors of Okabe and Ito. They are distinct for any color vision.
///
/// They are orange, sky blue, bluish green, yellow, blue, vermilion and reddish purple.
pub const OKABE_ITO: [Color; 7] =
    [[230, 159, 0], [86, 180, 233], [0, 158, 115], [240, 228, 66], [0, 114, 178], [213, 94, 0], [204, 121, 167]];

const ARM: Color = [146, 161, 178];
const GROUND: Color = [219, 222, 226];

/// Converts a color of parts from 0 to 1.
pub(crate) fn as_screens_take_it(color: [f64; 3]) -> Color {
    color.map(|part| (255.0 * part.clamp(0.0, 1.0) + 0.5) as u8)
}

impl Instance {
    /// Creates a shape with the color of its role.
    pub fn new(geometry: impl Into<Geometry>, pose: Pose<f64>, role: Role) -> Self {
        Self { geometry: geometry.into(), pose, role, color: None, focus: role == Role::Object }
    }

    /// Sets the color.
    pub fn with_color(mut self, color: Color) -> Self {
        self.color = Some(color);
        self
    }

    /// Fits the camera `close` to this shape.
    pub fn with_focus(mut self) -> Self {
        self.focus = true;
        self
    }

    /// Gets the color of the shape. If it has none, this is the color of its role.
    pub fn color(&self) -> Color {
        self.color.unwrap_or(match self.role {
            Role::Robot => ARM,
            Role::Object => OKABE_ITO[0],
            Role::Ground => GROUND,
            Role::Area => OKABE_ITO[2],
        })
    }
}
