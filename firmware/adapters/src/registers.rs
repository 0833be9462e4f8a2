//! Sensors on an I2C bus: converters, encoders, inertial units.

use embedded_hal::i2c::I2c;
use farsa_body::ports::{Channels, Sensor};

use crate::Fault;

/// `N` consecutive signed registers of 16 bits in a device, high byte first, each with a scale.
///
/// If the device does not respond the values stay as last read, at first 0, and [`check`](Self::check) reports it.
#[derive(Debug)]
pub struct Registers<I, const N: usize> {
    bus: I,
    address: u8,
    first: u8,
    scales: [[f32; 2]; N],
    values: [f32; N],
    fault: Option<Fault>,
}

impl<I: I2c, const N: usize> Registers<I, N> {
    /// Builds registers from `first` on of the device at `address` [7 bits]. A value is `offset + factor * register`, and `scales`
    /// are [offset, factor].
    pub fn new(bus: I, address: u8, first: u8, scales: [[f32; 2]; N]) -> Self {
        Self { bus, address, first, scales, values: [0.0; N], fault: None }
    }

    fn refresh(&mut self) -> Result<(), Fault> {
        let mut bytes = [[0; 2]; N];
        let read = self.bus.write_read(self.address, &[self.first], bytes.as_flattened_mut());
        read.map_err(|_| Fault::Read)?;
        for ((value, bytes), [offset, factor]) in self.values.iter_mut().zip(bytes).zip(self.scales) {
            *value = offset + factor * f32::from(i16::from_be_bytes(bytes));
        }
        Ok(())
    }

    /// Returns the fault since the last call.
    ///
    /// # Errors
    /// [`Fault::Read`].
    pub fn check(&mut self) -> Result<(), Fault> {
        self.fault.take().map_or(Ok(()), Err)
    }

    /// Returns the bus.
    pub fn into_bus(self) -> I {
        self.bus
    }
}

impl<I, const N: usize> Channels for Registers<I, N> {
    fn channels(&self) -> usize {
        N
    }
}

impl<W: ?Sized, I: I2c, const N: usize> Sensor<W> for Registers<I, N> {
    fn read(&mut self, _: &W, out: &mut [f32]) {
        self.fault = self.refresh().err().or(self.fault);
        out.iter_mut().zip(self.values).for_each(|(out, value)| *out = value);
    }
}
