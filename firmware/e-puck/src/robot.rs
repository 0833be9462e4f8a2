//! The loop: read, think, guard, drive.

use core::fmt;

use adapters::{Converter, Converters, CurveError, Fault, Guard, GuardError, Pulses};
use embedded_hal::pwm::SetDutyCycle;
use farsa_body::ports::{Motor, Sensor};
use farsa_nn::bytes::BytesError;
use farsa_nn::{Controller, Perceptron};

use crate::{SENSORS, SLOPE, WHEELS, champion};

/// From counts of 12 bits to what the network reads: 0 where nothing is within 0.05 m, 1 at the hull, in proportion between.
///
/// Replace it by what your robot's sensors count in front of a wall at known distances; see the guide.
pub const CURVE: &[[f32; 2]] = &[[0.0, 0.0], [4095.0, 1.0]];

/// The most that a wheel's motor value changes in a tick: from full speed ahead to rest.
pub const CHANGE: f32 = 0.5;

/// At rest.
pub const SAFE: f32 = 0.5;

/// The robot with a converter of eight infrared sensors and the pulses of two wheels.
///
/// A pulse of half the period is a wheel at rest, a longer one drives it ahead, a shorter one back: what a bridge in locked
/// antiphase does. All the memory of an episode is in here.
#[derive(Debug)]
pub struct EPuck<C, P> {
    sensors: Converters<C, SENSORS>,
    network: Perceptron<&'static [f32]>,
    guard: Guard<WHEELS>,
    motors: Pulses<P, WHEELS>,
    x: [f32; SENSORS],
    y: [f32; WHEELS],
    driven: [f32; WHEELS],
}

/// Why there is no robot.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum EPuckError {
    /// The champion's bytes.
    Bytes(BytesError),
    /// The curves of the sensors.
    Curve(CurveError),
    /// The limits of the wheels.
    Guard(GuardError),
}

impl fmt::Display for EPuckError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bytes(error) => error.fmt(f),
            Self::Curve(error) => error.fmt(f),
            Self::Guard(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for EPuckError {}

impl<C: Converter, P: SetDutyCycle> EPuck<C, P> {
    /// The champion on this converter, whose sensors have this curve, and the pulses of the left and the right wheel.
    ///
    /// # Errors
    /// [`EPuckError`]; nothing has moved then.
    pub fn new(converter: C, curve: &'static [[f32; 2]], wheels: [P; WHEELS]) -> Result<Self, EPuckError> {
        let parameters = champion().map_err(EPuckError::Bytes)?;
        let network = Perceptron::new(SENSORS, WHEELS, SLOPE, parameters);
        Ok(Self {
            sensors: Converters::new(converter, [curve; SENSORS]).map_err(EPuckError::Curve)?,
            network: network.map_err(|error| EPuckError::Bytes(error.into()))?,
            guard: Guard::new([[0.0, 1.0]; WHEELS], [CHANGE; WHEELS], [SAFE; WHEELS]).map_err(EPuckError::Guard)?,
            motors: Pulses::new(wheels, 0.0, 1.0),
            x: [0.0; SENSORS],
            y: [SAFE; WHEELS],
            driven: [SAFE; WHEELS],
        })
    }

    /// One control step, 0.1 s after the last; `time` says whether it came in time.
    ///
    /// # Errors
    /// What went wrong; the wheels rest then, as far as they can be told.
    pub fn tick(&mut self, time: Result<(), Fault>) -> Result<(), Fault> {
        self.sensors.read(&(), &mut self.x);
        let sensed = time.and(self.sensors.check());
        self.network.step(&self.x, &mut self.y);
        self.driven = self.guard.pass(self.y, sensed);
        self.motors.drive(&self.driven, &mut ());
        sensed.and(self.motors.check())
    }

    /// What the network read in the last tick.
    pub fn sensed(&self) -> &[f32; SENSORS] {
        &self.x
    }

    /// What the network asked for in the last tick.
    pub fn asked(&self) -> &[f32; WHEELS] {
        &self.y
    }

    /// What the guard let pass in the last tick.
    pub fn driven(&self) -> &[f32; WHEELS] {
        &self.driven
    }
}
