//! Experiments whose files are part of the program.
//!
//! A file of farsa-compose describes the robot, the world and the fitness. A second file names the settings of the experiment, which
//! are fewer than those of the first one.

mod experiment;
mod infrared;
mod settings;

pub use experiment::EmbeddedExperiment;

use farsa_body::robots::MobileRobot;
use farsa_lab::{Error, Settings};

/// Does a robot that senses walls and a cylinder alike stay near the cylinder? \[FARSA2\]
///
/// Six infrared sensors and two logistic units drive the wheels. One parent makes one mutant per generation. The condition is the
/// robot, with the source's numbers for each.
///
/// Deviations: the random numbers, and the default model of the sensors, a formula that needs no measured tables.
pub static DISCRIMINATION: EmbeddedExperiment = EmbeddedExperiment::new(
    "discrimination",
    include_str!("../../experiments/discrimination.toml"),
    include_str!("../../experiments/discrimination.settings.toml"),
    |_| Ok(()),
);

/// Can a robot distinguish a large cylinder from a small one by the way it moves next to them? \[FARSA2; Ferrauto2010, 4.6.5\]
///
/// Time near the large cylinder counts for the robot of `discrimination`, time near the small one against it. It senses the speeds
/// of its wheels (condition `wheels`) or not (`no-wheels`). These speeds are the only memory of its two units.
///
/// Chosen: the size of the arena, the distance of the cylinders, the fitness and truncation selection.
pub static DISCRIMINATION_CYLINDERS: EmbeddedExperiment = EmbeddedExperiment::new(
    "discrimination-cylinders",
    include_str!("../../experiments/discrimination-cylinders.toml"),
    include_str!("../../experiments/discrimination-cylinders.settings.toml"),
    |_| Ok(()),
);

/// Four ways of wiring two wheels to light sensors, seen from outside \[Braitenberg1984, vehicles 2a to 3b\].
///
/// A Khepera with eight light sensors and a lamp. Nothing evolves: a run is one vehicle in one generation, and its one gene has no
/// effect. The fitness is the decrease of the distance to the lamp \[m\].
///
/// Deviations: the source gives the radius of the lamp only, and its vehicles have one sensor on either side.
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
