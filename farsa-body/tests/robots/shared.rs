//! Shared parts of several of these tests.

use farsa_body::ports::Sensor;
use farsa_body::robots::MobileRobot;
use farsa_body::sensors::ColorBand;

pub(crate) const RED: [f32; 3] = [1.0, 0.0, 0.0];
pub(crate) const GREEN: [f32; 3] = [0.0, 1.0, 0.0];
pub(crate) const BLUE: [f32; 3] = [0.0, 0.0, 1.0];

/// Red and blue.
pub(crate) fn bands() -> [ColorBand; 2] {
    [RED, BLUE].map(|color| ColorBand::around(color, 0.25))
}

/// All channels of a sensor.
pub(crate) fn read<W: ?Sized>(sensor: &mut (impl Sensor<W> + ?Sized), world: &W) -> Vec<f32> {
    let mut out = vec![f32::NAN; sensor.channels()];
    sensor.read(world, &mut out);
    out
}

pub(crate) fn robots() -> [MobileRobot; 3] {
    [MobileRobot::khepera(), MobileRobot::e_puck(), MobileRobot::marxbot()]
}

/// The distance of two points.
pub(crate) fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum::<f64>().sqrt()
}
