//! A recorded episode instead of a robot: the counts of its sensors, and the commands of the wheels.

use core::cell::Cell;
use core::convert::Infallible;

use adapters::{Converter, Fault};
use embedded_hal::pwm::{ErrorType, SetDutyCycle};
use farsa_num::Digest;

use crate::{CURVE, EPuck, EPuckError, SAFE, SENSORS, WHEELS};

/// Counts of 12 bits, little-endian, of every sensor in the first 300 steps of a trial.
static READINGS: &[u8] = include_bytes!("../readings.bin");

/// Steps of the recording.
pub const STEPS: usize = READINGS.len() / (2 * SENSORS);

/// The count of a sensor in a step, `None` beyond the end.
pub fn reading(step: usize, sensor: usize) -> Option<u16> {
    if sensor >= SENSORS {
        return None;
    }
    let at = 2 * (step.checked_mul(SENSORS)? + sensor);
    let low = READINGS.get(at)?;
    let high = READINGS.get(at + 1)?;
    Some(u16::from(*low) | u16::from(*high) << 8)
}

/// A converter that plays the recording. It fails beyond the end.
#[derive(Debug)]
pub struct Recording<'a> {
    /// The current step.
    pub step: &'a Cell<usize>,
}

impl Converter for Recording<'_> {
    type Error = Fault;

    fn count(&mut self, sensor: usize) -> Result<u16, Fault> {
        reading(self.step.get(), sensor).ok_or(Fault::Read)
    }
}

/// Pulses that store their width.
#[derive(Debug)]
pub struct Width<'a> {
    /// The width, in units of [`TOP`](Self::TOP).
    pub duty: &'a Cell<u16>,
}

impl Width<'_> {
    /// The width of a pulse that never ends.
    pub const TOP: u16 = 10_000;
}

impl ErrorType for Width<'_> {
    type Error = Infallible;
}

impl SetDutyCycle for Width<'_> {
    fn max_duty_cycle(&self) -> u16 {
        Self::TOP
    }

    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Infallible> {
        self.duty.set(duty);
        Ok(())
    }
}

/// Drives the recorded episode, then one tick without sensors. It calls `step` before every tick, and again after it with the
/// motor values and the widths of the pulses.
///
/// Returns a fingerprint of all motor values and widths, the same on every target. The flag is true if only the tick without
/// sensors stops the wheels with a fault.
///
/// # Errors
/// [`EPuckError`].
pub fn run_episode(mut on_tick: impl FnMut(&mut dyn FnMut())) -> Result<(u64, bool), EPuckError> {
    let (step, left, right) = (Cell::new(0), Cell::new(0), Cell::new(0));
    let wheels = [Width { duty: &left }, Width { duty: &right }];
    let mut robot = EPuck::new(Recording { step: &step }, CURVE, wheels)?;
    let (mut digest, mut faultless) = (Digest::new(), true);
    for number in 0..STEPS {
        step.set(number);
        on_tick(&mut || faultless &= robot.tick(Ok(())).is_ok());
        digest.add_f32s(robot.asked());
        digest.add_bytes(&left.get().to_le_bytes());
        digest.add_bytes(&right.get().to_le_bytes());
    }
    step.set(STEPS);
    let safe = robot.tick(Ok(())) == Err(Fault::Read) && *robot.driven() == [SAFE; WHEELS];
    Ok((digest.finish(), faultless && safe))
}
