//! Experiments whose files are embedded in the program.
//!
//! Each experiment is described by a file of farsa-compose, which contains the robot, the world and the fitness. A
//! second file defines the settings of the experiment. There are fewer of them than values in the first file.

mod experiment;
mod infrared;
mod settings;

pub use experiment::EmbeddedExperiment;

use farsa_body::robots::MobileRobot;
use farsa_lab::{Error, Settings};

/// A robot has to stay near a cylinder that it can hardly distinguish from the walls \[FARSA2\].
///
/// The robot has six infrared sensors, and two logistic units drive its wheels. In each generation one parent produces
/// one mutant. The condition selects the robot and the values that the source gives for it.
///
/// The implementation uses different random numbers than the source. By default the sensors are modeled by a formula,
/// which does not need measured tables.
pub static DISCRIMINATION: EmbeddedExperiment = EmbeddedExperiment::new(
    "discrimination",
    include_str!("../../experiments/discrimination.toml"),
    include_str!("../../experiments/discrimination.settings.toml"),
    |_| Ok(()),
);

/// A robot has to distinguish a large cylinder from a small one by its movements \[FARSA2\] \[Ferrauto2010, 4.6.5\].
///
/// The robot is the same as in `discrimination`. The fitness is increased by the time near the large cylinder and
/// decreased by the time near the small one. With the condition `wheels`, the robot senses the speeds of its wheels.
/// These speeds are the only memory of its two units. The condition `no-wheels` removes them.
///
/// The size of the arena, the distance of the cylinders, the fitness and the selection scheme are not specified by the
/// sources and were chosen.
pub static DISCRIMINATION_CYLINDERS: EmbeddedExperiment = EmbeddedExperiment::new(
    "discrimination-cylinders",
    include_str!("../../experiments/discrimination-cylinders.toml"),
    include_str!("../../experiments/discrimination-cylinders.settings.toml"),
    |_| Ok(()),
);

/// Demonstrates four ways to connect two light sensors to two wheels \[Braitenberg1984, vehicles 2a to 3b\].
///
/// A Khepera robot with eight light sensors moves near a lamp. Nothing evolves in this experiment. A run consists of
/// one generation with one vehicle, and its only gene has no effect. The fitness is the decrease of the distance to the
/// lamp in meters.
///
/// The source specifies only the radius of the lamp, and its vehicles have one sensor on each side.
pub static BRAITENBERG: EmbeddedExperiment = EmbeddedExperiment::new(
    "braitenberg",
    include_str!("../../experiments/braitenberg.toml"),
    include_str!("../../experiments/braitenberg.settings.toml"),
    starts_between_lamp_and_walls,
);

/// Refuses starts within the lamp or beyond the walls.
fn starts_between_lamp_and_walls(settings: &Settings) -> Result<(), Error> {
    let radius = MobileRobot::khepera().radius;
    let [near, far] = settings.array("start.distance")?;
    let least = radius + settings.number("lamp.radius")?;
    let most = 0.5 * settings.number("world.size")? - radius;
    if near < least || far > most || near > far {
        let why = format!(
            "from {near} to {far} m: must rise and lie between {least:.3} m, the lamp, and {most:.3} m, the wall"
        );
        return Err(Error::setting("start.distance", why));
    }
    Ok(())
}
