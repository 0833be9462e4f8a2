//! Sensors.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use crate::document::wrapper::Wrapper;
use crate::document::{one, yes};
use crate::name::NAME;

/// A sensor of each robot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Sensor {
    /// Name for settings, drawings and recordings, by default the kind.
    #[schemars(regex(pattern = NAME))]
    pub name: Option<String>,
    /// Names of the channels, in the order of the network's inputs, by default the name with a number.
    pub channels: Option<Vec<String>>,
    /// Enables the sensor. The network has no inputs for a disabled one.
    #[serde(default = "yes")]
    pub enabled: bool,
    /// Wrappers of the values, of which the first is applied first.
    #[serde(default)]
    #[schemars(length(max = 32))]
    pub wrappers: Vec<Wrapper>,
    /// The kind of sensor.
    #[serde(flatten)]
    pub kind: SensorKind,
}

/// The kinds of sensors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum SensorKind {
    /// Infrared sensors around the hull: 0 nothing .. 1 at the hull.
    Infrared {
        /// Model of the readings.
        #[serde(default)]
        model: InfraredModel,
        /// Number of sensors, from the robot's first. 0 means all.
        #[serde(default)]
        #[schemars(range(min = 0, max = 64))]
        first: u32,
        /// Number of groups of neighboring sensors, each of which gives its largest value, by rays. 0 keeps each alone.
        #[serde(default)]
        #[schemars(range(min = 0, max = 64))]
        groups: u32,
        /// Files of measured readings, for the model `tables`.
        tables: Option<MeasuredTables>,
    },
    /// Light intensity at the places of the infrared sensors: 0 dark .. 1.
    Light {
        /// Distance at which a sensor that faces a lamp of intensity 1 reads 1 [m].
        #[serde(default = "reference")]
        #[schemars(range(min = 0.0001, max = 100.0))]
        reference: f64,
    },
    /// Color of the ground under the robot: gray, or red, green and blue, 0 to 1 each.
    GroundColor {
        /// Reads red, green and blue separately.
        #[serde(default)]
        rgb: bool,
        /// Number of the robot's places, from the first. 0 means all.
        #[serde(default)]
        #[schemars(range(min = 0, max = 64))]
        first: u32,
        /// Reads only the place under the robot's center.
        #[serde(default)]
        middle: bool,
    },
    /// A fan of laser range finders: 0 at the hull .. 1 nothing within the range.
    LaserDistance {
        /// Beams, from left to right.
        #[schemars(range(min = 1, max = 10000))]
        beams: u32,
        /// Width of the fan around straight ahead [deg].
        #[schemars(range(min = 0.0, max = 360.0))]
        field_of_view: f64,
        /// Range from the hull [m].
        #[schemars(range(min = 0.001, max = 1000.0))]
        range: f64,
        /// Height of the beams [m].
        #[serde(default = "beam_height")]
        #[schemars(range(min = 0.0, max = 100.0))]
        height: f64,
    },
    /// A camera of sectors from left to right. Each channel is the share of a sector that shows a color. With a robot
    /// with joints it sees colored things in the horizontal plane at `world.sight_height`.
    Camera(Camera),
    /// Image of an eye: red, green and blue of each pixel, row by row from the upper left. Pixels without a colored
    /// thing are 0. Recordings show the image.
    CameraImage {
        /// The eye.
        eye: Eye,
    },
    /// Positions of colors in an eye's image: the offset of each center to the left and upwards, in halves of the
    /// image's width, and its share of all pixels. Absent colors are three zeros. Recordings show the image.
    ColorBlobs {
        /// The eye.
        eye: Eye,
        /// Colors.
        colors: Vec<ColorRange>,
    },
    /// Offset between two things in an eye's image, to the left and upwards in widths of the image: -1 to 1. It is 0
    /// if one is behind the eye. Nothing hides them.
    VisualOffset {
        /// The eye.
        eye: Eye,
        /// Name of a thing, or of a body of the robot.
        of: String,
        /// Name of the thing or body from which the offset is measured.
        from: String,
    },
    /// Wheel speeds, left and right: 0 backwards .. 1/2 at rest .. 1 ahead.
    WheelSpeed {
        /// Reads -1 .. 0 at rest .. 1 instead.
        #[serde(default)]
        signed: bool,
    },
    /// Traction force on the robot, ahead and to the left: -1 to 1.
    Traction {
        /// Difference of speeds that reads 1 [m/s].
        #[schemars(range(min = 0.0001, max = 100.0))]
        largest: f64,
    },
    /// Signals of other robots, in sectors counter-clockwise from ahead: the strongest, 0 to 1.
    Signal {
        /// Range of the sensor [m].
        #[schemars(range(min = 0.001, max = 1000.0))]
        range: f64,
        /// Sectors around the robot: 1, 2, 4 or 8.
        #[serde(default = "four")]
        #[schemars(range(min = 1, max = 8))]
        sectors: u32,
        /// Reads the mean of a sector instead of the strongest signal.
        #[serde(default)]
        mean: bool,
    },
    /// State of the attachment device: 1 while it holds something, else 0.
    Attachment {},
    /// Contact of the robot: 1 while it touches something, else 0.
    Touch {
        /// Bodies of a robot with joints that sense contact, by default all of them.
        #[serde(default)]
        bodies: Vec<String>,
        /// The only thing that counts, or `floor`, for a robot with joints.
        with: Option<String>,
    },
    /// Sum of the contact forces on the robot [N], nominal in the kinematic arena.
    ContactForce {
        /// Bodies of a robot with joints that sense contact, by default all of them.
        #[serde(default)]
        bodies: Vec<String>,
        /// The only thing that counts, or `floor`, for a robot with joints.
        with: Option<String>,
    },
    /// Position of a thing, in three channels. The third is its height.
    TargetPosition {
        /// Name of a thing, or of a body of a robot with joints.
        target: String,
        /// Body of a robot with joints from which it is seen, by default the first.
        body: Option<String>,
        /// Point of that body [m].
        #[serde(default)]
        #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
        point: [f64; 3],
        /// Axes of the position.
        #[serde(default)]
        axes: AxesName,
        /// Reading per meter.
        #[serde(default = "one")]
        #[schemars(range(min = -1000.0, max = 1000.0))]
        scale: f64,
    },
    /// Pose of the robot: x, y, z [m] and a quaternion.
    BodyPose {
        /// Body of a robot with joints, by default the first.
        body: Option<String>,
    },
    /// Velocity of the robot [m/s] and angular velocity [rad/s], three channels each.
    BodyVelocity {
        /// Body of a robot with joints, by default the first.
        body: Option<String>,
        /// Axes of the velocity.
        #[serde(default)]
        axes: AxesName,
    },
    /// Height of the robot's origin [m].
    Height {
        /// Body of a robot with joints, by default the first.
        body: Option<String>,
        /// Point of that body [m].
        #[serde(default)]
        #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
        point: [f64; 3],
    },
    /// Positions of joints or wheels, 0 at `from` and 1 at `to`.
    JointPosition {
        /// Names, `left-wheel` and `right-wheel` of a robot on wheels, by default all.
        #[serde(default)]
        joints: Vec<String>,
        /// Position that reads 0 [rad or m], by default the lowest of the joint.
        #[schemars(range(min = -1e6, max = 1e6))]
        from: Option<f64>,
        /// Position that reads 1 [rad or m], by default the highest of the joint.
        #[schemars(range(min = -1e6, max = 1e6))]
        to: Option<f64>,
    },
    /// Speeds of joints or wheels [rad/s or m/s].
    JointSpeed {
        /// Names, `left-wheel` and `right-wheel` of a robot on wheels, by default all.
        #[serde(default)]
        joints: Vec<String>,
    },
    /// Energy of the robot, 0 dead .. 1, according to `foraging`.
    Energy {},
    /// Food load of the robot: 1 while it carries food, else 0, according to `foraging`.
    Carried {},
    /// A constant, such as a label of the condition.
    Constant {
        /// Value.
        #[schemars(range(min = -1e6, max = 1e6))]
        value: f64,
    },
    /// A sensor of the user's program, with its keys.
    #[serde(untagged)]
    #[schemars(skip)]
    Registered {
        /// Registered name.
        kind: String,
        /// Keys.
        #[serde(flatten)]
        keys: Map<String, Value>,
    },
}

/// Models of infrared sensors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum InfraredModel {
    /// A formula of distance and angle, with distances of a Khepera.
    #[default]
    Analytic,
    /// Rays, up to the range of the robot's sensors.
    Rays,
    /// Measured readings from files.
    Tables,
}

/// Files of measured infrared readings, in the folder of the experiment's file or below it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MeasuredTables {
    /// Readings near a wall.
    pub walls: String,
    /// Readings near round things. Each thing takes the file of the nearest radius.
    #[serde(default)]
    pub bodies: Vec<MeasuredBody>,
}

/// A file of readings near a round thing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MeasuredBody {
    /// Name of the file.
    pub file: String,
    /// Radius of the thing [m].
    #[schemars(range(min = 0.0001, max = 10.0))]
    pub radius: f64,
}

/// A camera.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Camera {
    /// Body of a robot with joints that carries the camera at its origin, with the view along its x axis, by default
    /// the first.
    pub body: Option<String>,
    /// Field of view around straight ahead [deg].
    #[schemars(range(min = 1.0, max = 360.0))]
    pub field_of_view: f64,
    /// Sectors from left to right.
    #[schemars(range(min = 1, max = 1000))]
    pub sectors: u32,
    /// Rays in each sector.
    #[serde(default = "nine")]
    #[schemars(range(min = 1, max = 1000))]
    pub rays: u32,
    /// Range [m].
    #[schemars(range(min = 0.001, max = 1000.0))]
    pub range: f64,
    /// Colors of the channels.
    pub colors: Vec<ColorRange>,
}

/// An eye of a robot with joints. It looks along the x axis of its frame, with y to the left and z up.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Eye {
    /// Body that carries it, by default the robot's first.
    pub body: Option<String>,
    /// Position in the body's axes [m].
    #[serde(default)]
    #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
    pub at: [f64; 3],
    /// Rotation about x, then y, then z of the body [deg].
    #[serde(default)]
    #[schemars(inner(range(min = -360.0, max = 360.0)))]
    pub turned: [f64; 3],
    /// Pixels from left to right.
    #[schemars(range(min = 1, max = 1000))]
    pub columns: u32,
    /// Square pixels from top to bottom.
    #[schemars(range(min = 1, max = 1000))]
    pub rows: u32,
    /// Field of view from left to right [deg].
    #[schemars(range(min = 1.0, max = 179.0))]
    pub field_of_view: f64,
    /// Range [m].
    #[schemars(range(min = 0.001, max = 1000.0))]
    pub range: f64,
}

/// A range of colors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ColorRange {
    /// Name of the color.
    #[schemars(regex(pattern = NAME))]
    pub name: String,
    /// Least red, green and blue.
    #[schemars(inner(range(min = 0.0, max = 1.0)))]
    pub low: [f64; 3],
    /// Greatest red, green and blue.
    #[schemars(inner(range(min = 0.0, max = 1.0)))]
    pub high: [f64; 3],
}

/// Axes of a vector.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum AxesName {
    /// Axes of the robot.
    #[default]
    Body,
    /// Axes of the world.
    World,
}

impl From<AxesName> for farsa_body::sensors::Axes {
    fn from(name: AxesName) -> Self {
        match name {
            AxesName::Body => Self::Body,
            AxesName::World => Self::World,
        }
    }
}

fn reference() -> f64 {
    0.25
}

fn beam_height() -> f64 {
    0.02
}

fn four() -> u32 {
    4
}

fn nine() -> u32 {
    9
}
