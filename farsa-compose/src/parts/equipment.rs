//! Sensors and motors of a robot.

use farsa_body::ports::{Channels, Motor, Sensor};

use crate::parts::noise_streams::NoiseStreams;
use crate::parts::part::Part;

/// Names of sensors or motors, with the first channel of each and the one after the last.
type Spans = [(String, [usize; 2])];

/// Sensors and motors of a robot, of kinds `S` and `M`.
#[derive(Clone, Debug)]
pub(crate) struct Equipment<S, M> {
    pub(crate) sensors: Vec<Part<S>>,
    pub(crate) motors: Vec<Part<M>>,
}

impl<S: Channels, M: Channels> Equipment<S, M> {
    /// Returns the numbers of channels of each sensor and of each motor.
    pub(crate) fn channels(&self) -> [Vec<usize>; 2] {
        [self.sensors.iter().map(Part::channels).collect(), self.motors.iter().map(Part::channels).collect()]
    }

    /// Reads all sensors into the channels of their spans.
    #[inline(always)]
    pub(crate) fn sense<W>(&mut self, spans: &Spans, world: &W, x: &mut [f32])
    where
        S: Sensor<W>,
    {
        // A single sensor has all channels. Most experiments have no other, and the loop costs a call in each step.
        match &mut self.sensors[..] {
            [Part::Bare(sensor)] => sensor.read(world, x),
            _ => self.sense_all(spans, world, x),
        }
    }

    #[inline(never)]
    fn sense_all<W>(&mut self, spans: &Spans, world: &W, x: &mut [f32])
    where
        S: Sensor<W>,
    {
        for (sensor, (_, [first, end])) in self.sensors.iter_mut().zip(spans) {
            sensor.read(world, &mut x[*first..*end]);
        }
    }

    /// Drives all motors by the channels of their spans.
    #[inline(always)]
    pub(crate) fn drive<W>(&mut self, spans: &Spans, y: &[f32], world: &mut W)
    where
        M: Motor<W>,
    {
        match &mut self.motors[..] {
            [Part::Bare(motor)] => motor.drive(y, world),
            _ => self.drive_all(spans, y, world),
        }
    }

    #[inline(never)]
    fn drive_all<W>(&mut self, spans: &Spans, y: &[f32], world: &mut W)
    where
        M: Motor<W>,
    {
        for (motor, (_, [first, end])) in self.motors.iter_mut().zip(spans) {
            motor.drive(&y[*first..*end], world);
        }
    }

    /// Resets all sensors and motors, with the streams of an episode for their noise.
    pub(crate) fn begin(&mut self, [sensor, motor]: &mut [NoiseStreams; 2]) {
        for part in &mut self.sensors {
            part.reseed(sensor);
            part.reset();
        }
        for part in &mut self.motors {
            part.reseed(motor);
            part.reset();
        }
    }
}
