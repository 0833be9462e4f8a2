//! Motors on pulses: model servos, power stages.

use embedded_hal::pwm::SetDutyCycle;
use farsa_body::ports::{Channels, Motor};

use crate::Fault;

/// `N` outputs with pulses of a width given by the motor values: 0 is `low` of the period, 1 is `high` of it.
#[derive(Debug)]
pub struct Pulses<P, const N: usize> {
    pins: [P; N],
    low: f32,
    high: f32,
    fault: Option<Fault>,
}

impl<P: SetDutyCycle, const N: usize> Pulses<P, N> {
    /// Builds pulses from `low` to `high` [0..1 of the period]: 0.05 and 0.1 for a model servo at 50 Hz, 0 and 1 for a power stage.
    ///
    /// Values outside [0, 1] are clamped.
    pub fn new(pins: [P; N], low: f32, high: f32) -> Self {
        let share = |x: f32| x.max(0.0).min(1.0);
        Self { pins, low: share(low), high: share(high), fault: None }
    }

    /// Returns the fault since the last call.
    ///
    /// # Errors
    /// [`Fault::Write`].
    pub fn check(&mut self) -> Result<(), Fault> {
        self.fault.take().map_or(Ok(()), Err)
    }

    /// Returns the pins.
    pub fn into_pins(self) -> [P; N] {
        self.pins
    }
}

impl<P, const N: usize> Channels for Pulses<P, N> {
    fn channels(&self) -> usize {
        N
    }
}

impl<W: ?Sized, P: SetDutyCycle, const N: usize> Motor<W> for Pulses<P, N> {
    fn drive(&mut self, y: &[f32], _: &mut W) {
        for (pin, y) in self.pins.iter_mut().zip(y) {
            let share = self.low + (self.high - self.low) * y.max(0.0).min(1.0);
            let duty = (share * f32::from(pin.max_duty_cycle()) + 0.5) as u16;
            if pin.set_duty_cycle(duty.min(pin.max_duty_cycle())).is_err() {
                self.fault = Some(Fault::Write);
            }
        }
    }
}
