//! Exports of wheeled robots for the experiments that use them.

use farsa_body::robots::MobileRobot;
use farsa_lab::exports::{SensorExport, SensorReading};

/// The infrared sensors with these names and directions \[rad\], as another program reads them.
pub(crate) fn infrared_exports<'a>(
    names: impl IntoIterator<Item = String> + 'a,
    angles: &'a [f64],
    robot: &MobileRobot,
) -> impl Iterator<Item = SensorExport> + 'a {
    let range = robot.infrared.range;
    names.into_iter().zip(angles).map(move |(name, angle)| {
        let quantity = format!("distance of a wall from the hull at {:+.1} degrees, left positive", angle.to_degrees());
        SensorExport {
            name,
            reads: SensorReading::Quantity { quantity, unit: "m", zero: range, one: 0.0, linear: true },
        }
    })
}
