//! The promises of worlds, sensors and motors, and the error for a violated promise.

use alloc::string::String;
use core::fmt;

/// A promise of a world, a sensor or a motor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Promise {
    /// The time step is finite and > 0.
    TimeStep,
    /// The ports report finite numbers.
    Finite,
    /// Rotations are unit quaternions.
    UnitRotation,
    /// A body's origin is its pose's.
    Origin,
    /// A body's velocity is its change of pose over time.
    Velocity,
    /// A joint's speed is its change of position over time.
    JointSpeed,
    /// A pair has a body, and each of its bodies is one of the world's.
    PairBodies,
    /// A pair that does not touch has no force and no point. One that touches has a normal force > 0.
    Contact,
    /// A pair that does not exist reads as zero.
    NoSuchPair,
    /// Equal commands give equal bits.
    Deterministic,
    /// Saving writes every word of the snapshot.
    SnapshotFilled,
    /// Restoring brings back what the ports reported.
    SnapshotRestores,
    /// A run from a restored snapshot repeats its bits.
    SnapshotReplays,
    /// A snapshot continues in another world with the same bits.
    SnapshotTravels,
    /// A command holds until the next.
    CommandHolds,
    /// A command has an effect.
    CommandActs,
    /// Clearing discards the past.
    ClearForgets,
    /// A joint is where it was placed.
    JointPlaced,
    /// A floating or planar body is where it was placed, and no other.
    BodyPlaced,
    /// After the setting up every port reports the truth.
    Arranged,
    /// A force from outside acts on its body in the next step alone.
    ForceActs,
    /// A ray reports the nearest surface within its range.
    Ray,
    /// Near surfaces of the plane are reported at their place.
    Near,
    /// The nearest surface in a direction of the plane is seen.
    Look,
    /// The rays of a camera hit the nearest surfaces, together as alone.
    Vision,
    /// Colors, signals and lamps are numbers of their ranges.
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

/// The error returned when a promise is violated.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ConformanceError {
    /// Violated promise.
    pub promise: Promise,
    /// A description of the observation.
    pub detail: String,
}

impl fmt::Display for ConformanceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "broken promise {:?}: {}", self.promise, self.detail)
    }
}

impl core::error::Error for ConformanceError {}

/// Ok where the promise is kept. The detail is only written where it is not.
pub(crate) fn ensure(kept: bool, promise: Promise, detail: impl FnOnce() -> String) -> Result<(), ConformanceError> {
    if kept { Ok(()) } else { Err(ConformanceError { promise, detail: detail() }) }
}
