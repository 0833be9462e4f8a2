//! The loop: read, step, guard, drive.

use core::fmt;

use adapters::{Converter, Converters, CurveError, Fault, Guard, GuardError, Pulses};
use embedded_hal::pwm::SetDutyCycle;
use farsa_body::ports::{Motor, Sensor};
use farsa_nn::bytes::BytesError;
use farsa_nn::{Controller, Perceptron};

use crate::{SENSORS, SLOPE, WHEELS, champion};

/// The curve from counts of 12 bits to inputs: 0 with nothing within 0.05 m, 1 at the hull, proportional between.
///
/// Replace it by counts of your sensors in front of a wall at measured distances, see the guide.
pub const CURVE: &[[f32; 2]] = &[[0.0, 0.0], [4095.0, 1.0]];

/// The largest change of a motor value in a tick: from full speed ahead to rest.
pub const CHANGE: f32 = 0.5;

/// At rest.
pub const SAFE: f32 = 0.5;

/// The robot with a converter of eight infrared sensors and the pulses of two wheels.
///
/// As with a bridge in locked antiphase, a pulse of half the period is a wheel at rest. A longer one drives it ahead, a shorter one
/// back. This value has all the memory of an episode.
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

/// An error of building the robot.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum EPuckError {
    /// The bytes of the champion.
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
    /// Builds the champion from a converter, the curve of its sensors, and the pulses of the left and the right wheel.
    ///
    /// # Errors
    /// [`EPuckError`]. Nothing has moved then.
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

    /// Runs one control step, 0.1 s after the last. `time` reports a late step.
    ///
    /// # Errors
    /// The fault. The wheels then rest, if they can be driven.
    pub fn tick(&mut self, time: Result<(), Fault>) -> Result<(), Fault> {
        self.sensors.read(&(), &mut self.x);
        let sensed = time.and(self.sensors.check());
        self.network.step(&self.x, &mut self.y);
        self.driven = self.guard.pass(self.y, sensed);
        self.motors.drive(&self.driven, &mut ());
        sensed.and(self.motors.check())
    }

    /// The inputs of the network in the last tick.
    pub fn sensed(&self) -> &[f32; SENSORS] {
        &self.x
    }

    /// The outputs of the network in the last tick.
    pub fn asked(&self) -> &[f32; WHEELS] {
        &self.y
    }

    /// The commands after the guard in the last tick.
    pub fn driven(&self) -> &[f32; WHEELS] {
        &self.driven
    }
}
