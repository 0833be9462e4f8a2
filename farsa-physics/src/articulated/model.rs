//! Constant data of an articulated world, such as links, colliders, pairs, actuators and options.

use alloc::string::String;
use alloc::vec::Vec;
use core::fmt;
use core::ops::Range;

use farsa_body::actuators::Law;
use farsa_body::ports::BodyId;
use farsa_body::robot::{JointKind, RobotError};
use farsa_num::Real;

use crate::articulated::impedance::Curve;
use crate::articulated::link::{Link, WORLD};
use crate::articulated::spatial::{Matrix, Vector};

/// Options for the simulation of an articulated world.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct Options {
    /// Duration of a control step [s].
    pub time_step: f64,
    /// Number of dynamics steps in each control step.
    pub substeps: u32,
    /// Gravity [m/s2].
    pub gravity: [f64; 3],
    /// Largest number of sweeps over the contacts in each dynamics step. Where two free boxes can touch it is four times
    /// this number, because stacks converge slowly.
    pub sweeps: u32,
    /// The sweeps of a world end with one that changes no contact's velocity by more than this times the dynamics step
    /// [m/s2]. It is 0 where two free boxes can touch or a body slides on the ground.
    pub settled: f64,
    /// Largest distance by which a link may leave its tangent in a dynamics step [m]. Where one leaves it by more, a world
    /// with contacts makes the step in two halves. `None` leaves all steps whole.
    pub path_error: Option<f64>,
    /// Tangential velocity per friction impulse at a sticking contact [m/(s N s)]. This determines how much creep is
    /// left.
    pub friction_compliance: f64,
    /// Natural frequency of a joint stop for which the description has no law [rad/s]. It is based on the inertia of the joint at
    /// position 0.
    pub limit_frequency: f64,
    /// Damping ratio of a joint stop.
    pub limit_damping: f64,
    /// Distance below which a contact is taken into account [m].
    pub margin: f64,
    /// Height of the horizontal plane that cameras see [m].
    pub sight_height: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            time_step: 0.01,
            substeps: 4,
            gravity: [0.0, 0.0, -9.81],
            sweeps: 10,
            settled: 0.04,
            path_error: None,
            friction_compliance: 1e-3,
            limit_frequency: 1000.0,
            limit_damping: 1.0,
            margin: 5e-4,
            sight_height: 0.0,
        }
    }
}

/// An error that occurs if a model cannot be built.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ModelError {
    /// The description of the robot is not valid.
    Robot(RobotError),
    /// An option is out of its allowed range.
    Option {
        /// Name of the option.
        name: &'static str,
        /// Value that was given.
        value: f64,
    },
    /// A joint has nothing to move, because there is neither mass beyond it about its axis nor an armature.
    Weightless {
        /// Name of the segment.
        segment: String,
    },
    /// A floating body or a hinge has so small an inertia about one axis, compared with the largest principal moment of
    /// its link, that rounding errors could make it negative.
    Thin {
        /// Name of the segment.
        segment: String,
        /// The smallest principal moment of a floating body, or the inertia about the hinge, divided by the largest
        /// principal moment.
        ratio: f64,
        /// Smallest possible ratio in the model's precision.
        least: f64,
    },
    /// There are more parts than can be numbered with 16 bits.
    TooMany {
        /// Kind of the parts.
        what: &'static str,
        /// Number of parts.
        count: usize,
    },
    /// A batch of this many worlds is not possible.
    Lanes {
        /// Requested number of worlds.
        lanes: usize,
        /// Nearest possible number, which is one of [`LANES`](crate::articulated::LANES).
        nearest: usize,
    },
}

impl From<RobotError> for ModelError {
    fn from(e: RobotError) -> Self {
        Self::Robot(e)
    }
}

impl fmt::Display for ModelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Robot(e) => e.fmt(f),
            Self::Option { name, value } => write!(f, "option {name} is {value}"),
            Self::Weightless { segment } => write!(f, "segment {segment}: its joint moves no mass and has no armature"),
            Self::Thin { segment, ratio, least } => write!(
                f,
                "segment {segment}: its least inertia is {ratio:.1e} of the largest, at least {least:.1e} in this precision"
            ),
            Self::TooMany { what, count } => write!(f, "{count} {what}: at most 65534"),
            Self::Lanes { lanes, nearest } => write!(f, "{lanes} worlds in lanes: the nearest number is {nearest}"),
        }
    }
}

impl core::error::Error for ModelError {}

/// Where a segment is: on which link, and its frame in the link's frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mount<R> {
    pub(crate) link: u16,
    pub(crate) rotation: Matrix<R>,
    pub(crate) position: Vector<R>,
}

/// The geometry of a collider with its sizes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Geometry<R> {
    Ball { radius: R },
    Capsule { radius: R, half_length: R },
    Block { half: Vector<R> },
    Cylinder { radius: R, half_length: R },
    Plane,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Collider<R> {
    pub(crate) mount: Mount<R>,
    pub(crate) geometry: Geometry<R>,
    /// Radius of the ball about its origin that holds it, none for a plane.
    pub(crate) bound: R,
}

/// The two sides of a contact in the joint space: which velocities its rows reach.
#[derive(Clone, Debug)]
pub(crate) struct Reach {
    /// Links from the first collider's up to the root.
    pub(crate) first: Vec<u16>,
    /// Links from the second collider's up to, but without, the first one that is also in `first`.
    pub(crate) second: Vec<u16>,
    /// The position in `first` at which the two join, or its length if they do not.
    pub(crate) meet: usize,
    /// The velocities of a row's entries, in the order in which they are written.
    pub(crate) dofs: Vec<u16>,
}

/// The velocities that a joint's own effort reaches, from the joint to the root, and where its row begins.
#[derive(Clone, Debug)]
pub(crate) struct StopPath {
    pub(crate) dofs: Vec<u16>,
    pub(crate) row: usize,
}

/// The ground below a body that slides: the links that it slides and turns by.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ground<R> {
    /// The sliding links, the one on the world first.
    pub(crate) sliders: [u16; 2],
    pub(crate) turn: Option<u16>,
    /// Largest impulse of a whole dynamics step [N s], and its largest moment [N m s].
    pub(crate) limit: R,
    pub(crate) turning_limit: R,
}

#[derive(Clone, Debug)]
pub(crate) struct Pair<R> {
    /// Colliders in the order ball, capsule, block, cylinder, plane.
    pub(crate) colliders: [usize; 2],
    /// True if that is the other way round than in the description.
    pub(crate) flipped: bool,
    /// First contact point and their number.
    pub(crate) point: usize,
    pub(crate) points: usize,
    /// First entry of the first point's rows.
    pub(crate) row: usize,
    /// The first entry of the rolling rows.
    pub(crate) rolling_row: usize,
    /// Number of the first point's rolling impulse, where there is rolling friction.
    pub(crate) rolling: Option<usize>,
    pub(crate) friction: R,
    pub(crate) rolling_friction: R,
    pub(crate) stiffness: R,
    pub(crate) damping: R,
    pub(crate) soft: Option<Soft<R>>,
    pub(crate) restitution: Option<R>,
    /// True if friction is a pyramid.
    pub(crate) is_pyramid: bool,
    /// True if the pair can push a joint that has a stop.
    pub(crate) at_stops: bool,
    /// The grounds below its two shapes.
    pub(crate) grounds: [Option<u16>; 2],
    pub(crate) reach: Reach,
}

/// Properties of contacts that stop motion gradually.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Soft<R> {
    /// Inertia that a touching point adds along its normal.
    pub(crate) inertia: R,
    /// Damping and inertia of friction.
    pub(crate) friction: [R; 2],
    /// Distance at which a contact begins.
    pub(crate) margin: R,
    pub(crate) curve: Option<Curve<R>>,
}

/// The colliders that the pairs of a group have first, or those that they have second.
#[derive(Clone, Debug)]
pub(crate) struct Cluster<R> {
    pub(crate) colliders: Vec<usize>,
    /// The reciprocal of their number.
    pub(crate) share: R,
}

/// Pairs that follow each other: those of a group, or some of none.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Group {
    pub(crate) pairs: Range<usize>,
    /// Their contact points.
    pub(crate) points: Range<usize>,
    /// The clusters of those of a group.
    pub(crate) clusters: Option<[usize; 2]>,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Actuator<R> {
    pub(crate) link: u16,
    pub(crate) law: Law<R>,
}

/// A law of a joint that is a row of the solver.
#[derive(Clone, Copy, Debug)]
pub(crate) enum JointLaw<R> {
    /// Dry friction with its largest impulse in a dynamics step.
    Friction { link: u16, limit: R },
    /// Largest speed.
    Speed { link: u16, limit: R },
    /// Soft stops.
    Stop { link: u16, stiffness: R, damping: R, inertia: R, curve: Option<Curve<R>> },
}

impl<R> JointLaw<R> {
    /// The link that the joint carries.
    pub(crate) fn link(&self) -> u16 {
        match self {
            Self::Friction { link, .. } | Self::Speed { link, .. } | Self::Stop { link, .. } => *link,
        }
    }
}

/// Constant part of an articulated world. Each number of the description is rounded only once.
#[derive(Clone, Debug)]
pub struct Model<R> {
    pub(crate) links: Vec<Link<R>>,
    pub(crate) mounts: Vec<Mount<R>>,
    /// The description's body pairs, for the ports.
    pub(crate) pair_bodies: Vec<[Option<BodyId>; 2]>,
    pub(crate) joints: Vec<JointKind>,
    pub(crate) collider_bodies: Vec<Option<BodyId>>,
    pub(crate) colliders: Vec<Collider<R>>,
    /// The colliders that cameras see, and their colors.
    pub(crate) shown: Vec<(u16, [f32; 3])>,
    pub(crate) sight_height: R,
    pub(crate) pairs: Vec<Pair<R>>,
    /// All pairs in their order.
    pub(crate) groups: Vec<Group>,
    pub(crate) clusters: Vec<Cluster<R>>,
    pub(crate) actuators: Vec<Actuator<R>>,
    /// The words of the state with commands that have a range, and their ranges.
    pub(crate) command_ranges: Vec<(usize, [R; 2])>,
    pub(crate) grounds: Vec<Ground<R>>,
    /// The state after [`farsa_body::ports::Arrange::clear`].
    pub(crate) initial: Vec<R>,
    pub(crate) positions: usize,
    pub(crate) dofs: usize,
    pub(crate) points: usize,
    pub(crate) rolling: usize,
    pub(crate) row_entries: usize,
    pub(crate) rolling_entries: usize,
    /// Which links' joints have a stop, and the rows of them.
    pub(crate) stops: Vec<bool>,
    pub(crate) stop_paths: Vec<StopPath>,
    pub(crate) stop_entries: usize,
    /// The laws of joints that are rows, each with a word of the state.
    pub(crate) joint_laws: Vec<JointLaw<R>>,
    pub(crate) roots: usize,
    pub(crate) gravity: [R; 3],
    /// Control step and dynamics step [s].
    pub(crate) time_step: R,
    pub(crate) h: R,
    pub(crate) substeps: u32,
    /// Square of the product of a link's spin and speed from which on a dynamics step is halved [m2/s4].
    pub(crate) fast: Option<R>,
    pub(crate) sweeps: u32,
    pub(crate) settled: R,
    pub(crate) friction_compliance: R,
    /// Slowest approach that bounces [m/s].
    pub(crate) bounce: R,
    pub(crate) margin: R,
    /// The margin with that of the soft contact that begins farthest from its surfaces [m].
    pub(crate) reach: R,
}

/// Words of the state per contact point: impulse, normal impulse, point, gap.
pub(crate) const POINT_WORDS: usize = 8;

impl<R: Real> Model<R> {
    /// Number of positions in a state. A joint has one and a floating body has seven, its position and the quaternion
    /// x, y, z, w.
    pub fn positions(&self) -> usize {
        self.positions
    }
    /// Number of velocities in a state. A joint has one and a floating body has six. These are its angular velocity and
    /// the velocity of its center of mass.
    pub fn dofs(&self) -> usize {
        self.dofs
    }
    /// Gets the moving links in the order of their velocities. This is mainly useful for the kernels.
    pub fn links(&self) -> &[Link<R>] {
        &self.links
    }
    /// Gets the gravity [m/s2].
    pub fn gravity(&self) -> [R; 3] {
        self.gravity
    }
    /// Length of a state. It consists of positions, velocities, two commands per actuator, eight words per contact
    /// point, three per rolling point, and one per joint with dry friction, with soft stops and with a largest speed.
    pub fn state_len(&self) -> usize {
        self.first_point() + POINT_WORDS * self.points + 3 * self.rolling + self.joint_laws.len()
    }
    /// Where the commands begin in a state.
    pub(crate) fn first_command(&self) -> usize {
        self.positions + self.dofs
    }
    /// Where the words of the contact points begin in a state.
    pub(crate) fn first_point(&self) -> usize {
        self.first_command() + 2 * self.actuators.len()
    }
    /// Finds the link that a body belongs to. If the body is fixed to the world, this returns `None`.
    pub fn link_of(&self, body: BodyId) -> Option<usize> {
        let mount = self.mounts.get(body.index())?;
        (mount.link != WORLD).then_some(usize::from(mount.link))
    }
    /// Finds the indices of the position and the velocity of a joint. For fixed and floating joints this returns
    /// `None`.
    pub fn joint_index(&self, joint: farsa_body::ports::JointId) -> Option<(usize, usize)> {
        match self.joints.get(joint.index())? {
            JointKind::Revolute | JointKind::Prismatic => {
                let link = &self.links[usize::from(self.mounts[joint.index()].link)];
                Some((usize::from(link.q), usize::from(link.dof)))
            }
            _ => None,
        }
    }
}
