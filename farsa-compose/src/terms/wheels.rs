//! Speeds of wheels.

use farsa_body::ports::{Handles, JointId, Joints};
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{Moment, PartScene, Term, TermPart};

/// Mean speed of the wheels, as a share of the greatest speed: 0 to 1.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct WheelSpeed {}

/// Difference of the wheel speeds, without its sign [rad/s].
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct WheelDifference {}

/// Similarity of the wheel speeds: 1 equal .. 0 opposite.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct StraightOn {}

/// Wheels, and their greatest speed [rad/s].
#[derive(Clone, Debug)]
struct Wheels([JointId; 2], f64);

impl Wheels {
    fn new(scene: &PartScene<'_>) -> Result<Self, Error> {
        let place = scene.planar()?;
        Ok(Self(place.parts.wheels, place.robot.max_wheel_speed))
    }

    /// Computes the speeds [rad/s].
    fn speeds<W: Joints + Handles<Joint = JointId>>(&self, world: &W) -> [f64; 2] {
        self.0.map(|wheel| f64::from(world.speed(wheel)))
    }
}

/// The mean speed, as a share of the greatest.
#[derive(Clone, Debug)]
pub(super) struct SpeedOfWheels(Wheels);

impl<W: Joints + Handles<Joint = JointId>> Term<W> for SpeedOfWheels {
    fn value(&self, world: &W, _: &Moment<'_>) -> f64 {
        // (|l| + |r|) / 2, with wheel speeds as shares of the greatest.
        let [left, right] = self.0.speeds(world).map(|speed| speed / self.0.1);
        0.5 * (left.abs() + right.abs())
    }

    fn has_state(&self) -> bool {
        false
    }
}

impl TermPart for WheelSpeed {
    type Term = SpeedOfWheels;

    fn term(&self, scene: &PartScene<'_>) -> Result<SpeedOfWheels, Error> {
        Wheels::new(scene).map(SpeedOfWheels)
    }
}

/// The difference of the speeds.
#[derive(Clone, Debug)]
pub(super) struct DifferenceOfWheels(Wheels);

impl<W: Joints + Handles<Joint = JointId>> Term<W> for DifferenceOfWheels {
    fn value(&self, world: &W, _: &Moment<'_>) -> f64 {
        let [left, right] = self.0.speeds(world);
        (right - left).abs()
    }

    fn has_state(&self) -> bool {
        false
    }
}

impl TermPart for WheelDifference {
    type Term = DifferenceOfWheels;

    fn term(&self, scene: &PartScene<'_>) -> Result<DifferenceOfWheels, Error> {
        Wheels::new(scene).map(DifferenceOfWheels)
    }
}

/// The similarity of the speeds.
#[derive(Clone, Debug)]
pub(super) struct SimilarityOfWheels(Wheels);

impl<W: Joints + Handles<Joint = JointId>> Term<W> for SimilarityOfWheels {
    fn value(&self, world: &W, _: &Moment<'_>) -> f64 {
        // 1 - |l - r| / 2
        let [left, right] = self.0.speeds(world).map(|speed| speed / self.0.1);
        1.0 - 0.5 * (left - right).abs()
    }

    fn has_state(&self) -> bool {
        false
    }
}

impl TermPart for StraightOn {
    type Term = SimilarityOfWheels;

    fn term(&self, scene: &PartScene<'_>) -> Result<SimilarityOfWheels, Error> {
        Wheels::new(scene).map(SimilarityOfWheels)
    }
}
