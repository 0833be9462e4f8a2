//! What robots sense.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::document::wrapper::Wrapper;
use crate::document::yes;
use crate::name::NAME;

/// Something that each robot senses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Sensor {
    /// What settings, drawings and recordings call it; by default its kind.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(regex(pattern = NAME))]
    pub name: Option<String>,
    /// Whether it is there; if not, the network has no inputs for it.
    #[serde(default = "yes")]
    pub enabled: bool,
    /// What happens to its values on their way, the first one first.
    #[serde(default)]
    #[schemars(length(max = 32))]
    pub wrappers: Vec<Wrapper>,
    /// What it is.
    #[serde(flatten)]
    pub kind: SensorKind,
}

/// The kinds of sensors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum SensorKind {
    /// Infrared sensors around the hull: 0 nothing .. 1 at the hull.
    Infrared {
        /// How they are computed.
        #[serde(default)]
        model: InfraredModel,
        /// How many of them, from the robot's first on; 0 is all.
        #[serde(default)]
        #[schemars(range(min = 0, max = 64))]
        first: u32,
        /// In so many groups of neighbours, each of which gives its largest value, by rays; 0 is each alone.
        #[serde(default)]
        #[schemars(range(min = 0, max = 64))]
        groups: u32,
        /// Files of measured readings, for the model `tables`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        tables: Option<MeasuredTables>,
    },
    /// How brightly lamps shine where the infrared sensors are: 0 dark .. 1.
    Light {
        /// Distance from which a sensor that looks at a lamp of intensity 1 reads 1 [m].
        #[serde(default = "reference")]
        #[schemars(range(min = 0.0001, max = 100.0))]
        reference: f64,
    },
    /// The colour of the ground under the robot: grey, or red, green and blue, 0 to 1 each.
    GroundColor {
        /// Whether red, green and blue are told apart.
        #[serde(default)]
        rgb: bool,
        /// At so many of the robot's places, from the first on; 0 is all.
        #[serde(default)]
        #[schemars(range(min = 0, max = 64))]
        first: u32,
        /// Whether it is only one place, under the robot's middle.
        #[serde(default)]
        middle: bool,
    },
    /// A fan of laser range finders: 0 at the hull .. 1 nothing within the range.
    LaserDistance {
        /// Beams from left to right.
        #[schemars(range(min = 1, max = 10000))]
        beams: u32,
        /// How wide the fan is, around straight ahead [deg].
        #[schemars(range(min = 0.0, max = 360.0))]
        field_of_view: f64,
        /// How far they reach from the hull [m].
        #[schemars(range(min = 0.001, max = 1000.0))]
        range: f64,
        /// How high they are [m].
        #[serde(default = "beam_height")]
        #[schemars(range(min = 0.0, max = 100.0))]
        height: f64,
    },
    /// A camera of sectors from left to right: of each colour the share of a sector that shows it. With a robot with joints it sees
    /// coloured things in the horizontal plane at `world.sight_height`.
    Camera(Camera),
    /// What an eye sees: red, green and blue of each pixel, row by row from the upper left; 0 where there is nothing, or nothing with
    /// a colour. Recordings show it.
    CameraImage {
        /// The eye.
        eye: Eye,
    },
    /// Where colours are in an eye's image: how far to the left and upwards the middle of each is, in halves of the image's width, and
    /// the share of all pixels; three zeros where it is not. Recordings show the image.
    ColorBlobs {
        /// The eye.
        eye: Eye,
        /// The colours.
        colors: Vec<ColorRange>,
    },
    /// How far one thing is from another in an eye's image, to the left and upwards in widths of the image: -1 to 1; 0 where one is
    /// behind the eye. Nothing hides them.
    VisualOffset {
        /// The eye.
        eye: Eye,
        /// Which thing, or which body of the robot.
        of: String,
        /// From which thing, or which body of the robot.
        from: String,
    },
    /// How fast the wheels turn, left and right: 0 backwards .. 1/2 at rest .. 1 ahead.
    WheelSpeed {
        /// Whether they read -1 .. 0 at rest .. 1 instead.
        #[serde(default)]
        signed: bool,
    },
    /// Where the robot is pulled, ahead and to the left: -1 to 1.
    Traction {
        /// The difference of speeds that reads 1 [m/s].
        #[schemars(range(min = 0.0001, max = 100.0))]
        largest: f64,
    },
    /// What other robots signal, in sectors counter-clockwise from ahead: the strongest, 0 to 1.
    Signal {
        /// How far it hears [m].
        #[schemars(range(min = 0.001, max = 1000.0))]
        range: f64,
        /// Sectors around the robot: 1, 2, 4 or 8.
        #[serde(default = "four")]
        #[schemars(range(min = 1, max = 8))]
        sectors: u32,
        /// Whether the mean of a sector is read instead of the strongest.
        #[serde(default)]
        mean: bool,
    },
    /// Whether the attachment device holds something: 0 or 1.
    Attachment {},
    /// Whether the robot touches something: 0 or 1.
    Touch {
        /// Bodies of a robot with joints that feel it; none is all of them.
        #[serde(default)]
        bodies: Vec<String>,
        /// The only thing that counts, or `floor`, for a robot with joints.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        with: Option<String>,
    },
    /// The sum of the forces at which the robot is pushed [N]; nominal in the kinematic arena.
    ContactForce {
        /// Bodies of a robot with joints that feel it; none is all of them.
        #[serde(default)]
        bodies: Vec<String>,
        /// The only thing that counts, or `floor`, for a robot with joints.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        with: Option<String>,
    },
    /// Where a thing is, three channels of which the third is its height.
    TargetPosition {
        /// Which thing, or which body of a robot with joints.
        target: String,
        /// The body of a robot with joints that it is seen from; by default its first.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        body: Option<String>,
        /// From which point of that body [m].
        #[serde(default)]
        #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
        point: [f64; 3],
        /// Seen by whom.
        #[serde(default)]
        axes: AxesName,
        /// What a metre reads.
        #[serde(default = "unit")]
        #[schemars(range(min = -1000.0, max = 1000.0))]
        scale: f64,
    },
    /// Where the robot is: x, y, z [m] and four numbers of its orientation.
    BodyPose {
        /// Which body of a robot with joints; by default its first.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        body: Option<String>,
    },
    /// How the robot moves: three of its velocity [m/s] and three of its angular velocity [rad/s].
    BodyVelocity {
        /// Which body of a robot with joints; by default its first.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        body: Option<String>,
        /// In which axes.
        #[serde(default)]
        axes: AxesName,
    },
    /// How high the robot's origin is [m].
    Height {
        /// Which body of a robot with joints; by default its first.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        body: Option<String>,
        /// Which point of that body [m].
        #[serde(default)]
        #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
        point: [f64; 3],
    },
    /// Positions of joints or wheels, 0 at `from` and 1 at `to`.
    JointPosition {
        /// Which, `left-wheel` and `right-wheel` of a robot on wheels; none is all.
        #[serde(default)]
        joints: Vec<String>,
        /// What reads 0 [rad or m]; by default the lowest that the joint allows.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = -1e6, max = 1e6))]
        from: Option<f64>,
        /// What reads 1 [rad or m]; by default the highest that the joint allows.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = -1e6, max = 1e6))]
        to: Option<f64>,
    },
    /// Speeds of joints or wheels [rad/s or m/s].
    JointSpeed {
        /// Which, `left-wheel` and `right-wheel` of a robot on wheels; none is all.
        #[serde(default)]
        joints: Vec<String>,
    },
    /// The robot's energy, 0 dead .. 1, by the rules of `foraging`.
    Energy {},
    /// Whether the robot carries food, 0 or 1, by the rules of `foraging`.
    Carried {},
    /// A number that never changes, such as a label of the condition.
    Constant {
        /// The number.
        #[schemars(range(min = -1e6, max = 1e6))]
        value: f64,
    },
}

/// How infrared sensors are computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum InfraredModel {
    /// By a formula of distance and angle; its distances are a Khepera's.
    #[default]
    Analytic,
    /// By rays, as far as the robot's sensors see.
    Rays,
    /// By measured readings, from files.
    Tables,
}

/// Files of measured infrared readings, in the folder of the experiment's file or below it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MeasuredTables {
    /// Readings beside a wall.
    pub walls: String,
    /// Readings beside round things: each takes the file whose radius is nearest to its own.
    #[serde(default)]
    pub bodies: Vec<MeasuredBody>,
}

/// A file of readings beside a round thing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MeasuredBody {
    /// Its name.
    pub file: String,
    /// The radius of the thing [m].
    #[schemars(range(min = 0.0001, max = 10.0))]
    pub radius: f64,
}

/// A camera.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Camera {
    /// The body of a robot with joints that carries it at its origin and along whose x axis it looks; by default the first one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub body: Option<String>,
    /// How much it sees, around straight ahead [deg].
    #[schemars(range(min = 1.0, max = 360.0))]
    pub field_of_view: f64,
    /// Sectors from left to right.
    #[schemars(range(min = 1, max = 1000))]
    pub sectors: u32,
    /// Rays by which each sector is searched.
    #[serde(default = "nine")]
    #[schemars(range(min = 1, max = 1000))]
    pub rays: u32,
    /// How far it sees [m].
    #[schemars(range(min = 0.001, max = 1000.0))]
    pub range: f64,
    /// The colours that it tells apart.
    pub colors: Vec<ColorRange>,
}

/// An eye of a robot with joints, that looks along x of its own axes, with y to the left and z up.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Eye {
    /// The body that carries it; by default the robot's first.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub body: Option<String>,
    /// Where it is in the body's axes [m].
    #[serde(default)]
    #[schemars(inner(range(min = -1000.0, max = 1000.0)))]
    pub at: [f64; 3],
    /// How it is turned there, about x, then y, then z of the body [deg].
    #[serde(default)]
    #[schemars(inner(range(min = -360.0, max = 360.0)))]
    pub turned: [f64; 3],
    /// Pixels from left to right.
    #[schemars(range(min = 1, max = 1000))]
    pub columns: u32,
    /// Pixels from top to bottom; they are squares.
    #[schemars(range(min = 1, max = 1000))]
    pub rows: u32,
    /// How much it sees from left to right [deg].
    #[schemars(range(min = 1.0, max = 179.0))]
    pub field_of_view: f64,
    /// How far it sees [m].
    #[schemars(range(min = 0.001, max = 1000.0))]
    pub range: f64,
}

/// A range of colours.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ColorRange {
    /// What it is called.
    #[schemars(regex(pattern = NAME))]
    pub name: String,
    /// The least of red, green and blue.
    #[schemars(inner(range(min = 0.0, max = 1.0)))]
    pub low: [f64; 3],
    /// The most of red, green and blue.
    #[schemars(inner(range(min = 0.0, max = 1.0)))]
    pub high: [f64; 3],
}

/// The axes in which a vector is read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum AxesName {
    /// Those of the robot.
    #[default]
    Body,
    /// Those of the world.
    World,
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

fn unit() -> f64 {
    1.0
}
