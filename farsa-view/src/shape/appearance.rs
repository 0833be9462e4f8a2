//! The role, color and place of shapes.

use farsa_body::Pose;

use crate::shape::geometry::Geometry;

/// Red, green and blue of a screen.
pub type Color = [u8; 3];

/// The role of a shape in a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// A part of a robot.
    Robot,
    /// A thing that moves or that the robot handles.
    Object,
    /// The ground and walls, which cameras are not fitted to.
    Ground,
    /// A translucent mark on the ground, such as a target area.
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

/// A placed shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instance {
    /// Its geometry.
    pub geometry: Geometry,
    /// Its frame in the world.
    pub pose: Pose<f64>,
    /// Its role.
    pub role: Role,
    /// Its color, `None` for that of its role.
    pub color: Option<Color>,
    /// True if the camera `close` is fitted to it, as always to things.
    pub focus: bool,
}

/// The colors of Okabe and Ito, distinct for any color vision: orange, sky blue, bluish green, yellow, blue, vermilion, reddish
/// purple.
pub const OKABE_ITO: [Color; 7] =
    [[230, 159, 0], [86, 180, 233], [0, 158, 115], [240, 228, 66], [0, 114, 178], [213, 94, 0], [204, 121, 167]];

const ARM: Color = [146, 161, 178];
const GROUND: Color = [219, 222, 226];

/// Converts a color of parts from 0 to 1.
pub(crate) fn as_screens_take_it(color: [f64; 3]) -> Color {
    color.map(|part| (255.0 * part.clamp(0.0, 1.0) + 0.5) as u8)
}

impl Instance {
    /// Creates a shape in the color of its role.
    pub fn new(geometry: impl Into<Geometry>, pose: Pose<f64>, role: Role) -> Self {
        Self { geometry: geometry.into(), pose, role, color: None, focus: role == Role::Object }
    }

    /// Returns the shape in this color.
    pub fn with_color(mut self, color: Color) -> Self {
        self.color = Some(color);
        self
    }

    /// Returns the shape with the camera `close` fitted to it.
    pub fn with_focus(mut self) -> Self {
        self.focus = true;
        self
    }

    /// Returns its color.
    pub fn color(&self) -> Color {
        self.color.unwrap_or(match self.role {
            Role::Robot => ARM,
            Role::Object => OKABE_ITO[0],
            Role::Ground => GROUND,
            Role::Area => OKABE_ITO[2],
        })
    }
}
