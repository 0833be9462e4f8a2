//! How shapes look: their role, colour and place.

use farsa_body::Pose;

use crate::shape::geometry::Geometry;

/// Red, green and blue as screens take them.
pub type Color = [u8; 3];

/// What a shape is to the viewer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// A part of a robot.
    Robot,
    /// A thing that moves or that the robot deals with.
    Object,
    /// What everything stands on, and walls: never what a camera looks for.
    Ground,
    /// A mark on the ground, such as a target area; shows what it lies on through it.
    Area,
}

impl Role {
    /// The word for it in a page.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Robot => "robot",
            Self::Object => "thing",
            Self::Ground => "ground",
            Self::Area => "area",
        }
    }
}

/// A shape in its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instance {
    /// Its geometry.
    pub geometry: Geometry,
    /// Its frame in the world.
    pub pose: Pose<f64>,
    /// What it is.
    pub role: Role,
    /// Its colour; `None` for that of its role.
    pub color: Option<Color>,
    /// Whether the camera `close` looks for it; things are always looked for.
    pub focus: bool,
}

/// The colours of Okabe and Ito, which people with any colour vision tell apart: orange, sky blue, bluish green, yellow,
/// blue, vermilion, reddish purple.
pub const OKABE_ITO: [Color; 7] =
    [[230, 159, 0], [86, 180, 233], [0, 158, 115], [240, 228, 66], [0, 114, 178], [213, 94, 0], [204, 121, 167]];

const ARM: Color = [146, 161, 178];
const GROUND: Color = [219, 222, 226];

/// A colour of which each part is from 0 to 1, as colliders have it.
pub(crate) fn as_screens_take_it(color: [f64; 3]) -> Color {
    color.map(|part| (255.0 * part.clamp(0.0, 1.0) + 0.5) as u8)
}

impl Instance {
    /// A shape in its role's colour.
    pub fn new(geometry: impl Into<Geometry>, pose: Pose<f64>, role: Role) -> Self {
        Self { geometry: geometry.into(), pose, role, color: None, focus: role == Role::Object }
    }

    /// The same shape in this colour.
    pub fn with_color(mut self, color: Color) -> Self {
        self.color = Some(color);
        self
    }

    /// The same shape, looked for by the camera `close`.
    pub fn with_focus(mut self) -> Self {
        self.focus = true;
        self
    }

    /// Its colour.
    pub fn color(&self) -> Color {
        self.color.unwrap_or(match self.role {
            Role::Robot => ARM,
            Role::Object => OKABE_ITO[0],
            Role::Ground => GROUND,
            Role::Area => OKABE_ITO[2],
        })
    }
}
