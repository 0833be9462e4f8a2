//! What the kit holds worlds, sensors and motors to, and the error that names a broken promise.

use alloc::string::String;
use core::fmt;

/// What a world, a sensor or a motor promises.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Promise {
    /// The time step is finite and > 0.
    TimeStep,
    /// What the ports report is finite.
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
    /// A pair that does not touch has no force and no point; one that touches has a normal force > 0.
    Contact,
    /// A pair that does not exist reads as zero.
    NoSuchPair,
    /// The same commands give the same bits.
    Deterministic,
    /// Saving writes every word of the snapshot.
    SnapshotFilled,
    /// Restoring brings back what the ports reported.
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
    /// After the setting up every port reports the truth.
    Arranged,
    /// A force from outside acts on its body in the next step alone.
    ForceActs,
    /// A ray meets the nearest surface within its range, and reports how.
    Ray,
    /// What is near in the plane is reported, where it is.
    Near,
    /// The nearest surface in a direction of the plane is seen.
    Look,
    /// The rays of an eye meet the nearest surfaces, together as alone.
    Vision,
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
