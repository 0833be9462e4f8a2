//! The conformance kit: what every world, sensor and motor promises, as functions that name the first broken promise.
//!
//! ```
//! use farsa_body::testing::{PointWorld, Probe, check_world};
//!
//! let probe = Probe::numbered(3, [[-20.0, 0.0], [20.0, 0.0]]);
//! assert_eq!(check_world(|| PointWorld::new(3), &probe), Ok(()));
//! ```

use alloc::{string::String, vec::Vec};
use core::fmt;

pub use crate::check_arrange::check_arrange;
pub use crate::check_channels::{check_motor, check_sensor};
pub use crate::check_planar::check_planar;
pub use crate::check_rays::check_rays;
pub use crate::check_world::check_world;
pub use crate::plane_world::PlaneWorld;
pub use crate::point_world::PointWorld;

use crate::actuator::Law;
use crate::ports::{ActuatorId, BodyId, JointId};
use crate::robot::{JointKind, Robot};

/// The parts of a world that the kit looks at and moves, and how long and how closely.
#[derive(Clone, Debug, PartialEq)]
pub struct Probe<B = BodyId, J = JointId, A = ActuatorId> {
    /// All bodies.
    pub bodies: Vec<B>,
    /// The bodies that move freely.
    pub floating: Vec<B>,
    /// The bodies that can be put anywhere on a plane: place and heading are kept, and they are at rest.
    pub planar: Vec<B>,
    /// The joints with two positions [rad or m] between which they can be placed.
    pub joints: Vec<(J, [f32; 2])>,
    /// The actuators with the lower and upper ends of the two numbers of their commands.
    pub actuators: Vec<(A, [[f32; 2]; 2])>,
    /// Number of steps of a run, at least 16.
    pub steps: usize,
    /// How far the mean speed over a step may lie outside what the speeds at its ends allow [m/s or rad/s].
    pub slack: f32,
}

impl Probe {
    /// The steps of a run where none are asked for.
    const STEPS: usize = 200;
    /// The slack where none is asked for.
    const SLACK: f32 = 0.1;

    /// A probe of a world built from this robot.
    pub fn of(robot: &Robot) -> Self {
        let finite = |range: [f64; 2]| {
            let [low, high] = range.map(|x| x as f32);
            [if low.is_finite() { low } else { -1.0 }, if high.is_finite() { high } else { 1.0 }]
        };
        let range = |joint: JointId| finite(robot.segments.get(joint.index()).map_or([0.0; 2], |s| s.joint.range));
        let command = |actuator: &crate::robot::Actuator| match actuator.law {
            Law::MusclePair(_) => [[0.0; 2], [1.0; 2]],
            Law::Servo(_) => range(actuator.joint).map(|x| [x, 0.0]),
            Law::Torque(torque) => finite([-torque.limit, torque.limit]).map(|x| [x, 0.0]),
            Law::Held(_) => [[-1.0, 0.0], [1.0, 0.0]],
        };
        let kinds = || robot.segments.iter().map(|s| s.joint.kind).enumerate();
        Self {
            bodies: kinds().map(|(i, _)| BodyId(i as u16)).collect(),
            floating: kinds().filter(|(_, k)| *k == JointKind::Floating).map(|(i, _)| BodyId(i as u16)).collect(),
            planar: Vec::new(),
            joints: robot.joints().map(|joint| (joint, range(joint))).collect(),
            actuators: (0u16..).map(ActuatorId).zip(robot.actuators.iter().map(command)).collect(),
            steps: Self::STEPS,
            slack: Self::SLACK,
        }
    }

    /// A probe of a world whose `count` bodies, joints (placed between 0 and 1) and actuators have the same numbers.
    pub fn numbered(count: u16, commands: [[f32; 2]; 2]) -> Self {
        Self {
            bodies: (0..count).map(BodyId).collect(),
            floating: Vec::new(),
            planar: Vec::new(),
            joints: (0..count).map(|i| (JointId(i), [0.0, 1.0])).collect(),
            actuators: (0..count).map(|i| (ActuatorId(i), commands)).collect(),
            steps: Self::STEPS,
            slack: Self::SLACK,
        }
    }
}

/// What a world, a sensor or a motor promises.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Promise {
    /// The time step is finite and > 0.
    TimeStep,
    /// What the ports tell is finite.
    Finite,
    /// Rotations are unit quaternions.
    UnitRotation,
    /// A body's velocity is its change of pose over time.
    Velocity,
    /// A joint's speed is its change of position over time.
    JointSpeed,
    /// A pair has a body, and each of its bodies is one of the world's.
    PairBodies,
    /// A pair that does not touch has no force and no point; one that touches has a normal force > 0.
    Contact,
    /// A pair that does not exist reads as zero.
    NoSuchPair,
    /// The same commands give the same bits.
    Deterministic,
    /// Saving writes every word of the snapshot.
    SnapshotFilled,
    /// Restoring brings back what the ports told.
    SnapshotRestores,
    /// What follows a restored snapshot has the same bits.
    SnapshotReplays,
    /// A snapshot goes on in another world with the same bits.
    SnapshotTravels,
    /// A command holds until the next.
    CommandHolds,
    /// A command has an effect.
    CommandActs,
    /// Clearing forgets what was.
    ClearForgets,
    /// A joint is where it was placed.
    JointPlaced,
    /// A floating or planar body is where it was placed, and no other.
    BodyPlaced,
    /// After the setting up every port tells the truth.
    Arranged,
    /// A ray meets the nearest surface within its range, and tells how.
    Ray,
    /// What is near in the plane is told, where it is.
    Near,
    /// The nearest surface in a direction of the plane is seen.
    Look,
    /// Colours, signals and lamps are numbers of their ranges.
    Shown,
    /// A sensor writes all its channels.
    SensorFills,
    /// A sensor or motor touches no value beyond its channels.
    Bounds,
    /// A sensor reads finite values.
    SensorFinite,
    /// A sensor reads the same bits, and a motor commands the same, in the same state after a reset.
    Repeats,
    /// A shorter slice gets the first channels.
    ShortSlice,
    /// A motor's commands are finite, whatever it is given.
    MotorFinite,
    /// The number of channels does not change.
    Channels,
}

/// A broken promise, and where it was seen to break.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ConformanceError {
    /// The promise.
    pub promise: Promise,
    /// What was seen.
    pub detail: String,
}

impl fmt::Display for ConformanceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "broken promise {:?}: {}", self.promise, self.detail)
    }
}

impl core::error::Error for ConformanceError {}

/// Ok where the promise is kept; the detail is only written where it is not.
pub(crate) fn ensure(kept: bool, promise: Promise, detail: impl FnOnce() -> String) -> Result<(), ConformanceError> {
    if kept { Ok(()) } else { Err(ConformanceError { promise, detail: detail() }) }
}
