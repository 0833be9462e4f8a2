//! Experiments whose files are embedded in the program.
//!
//! Each experiment is described by a file of farsa-compose. It contains the robot, the world and the fitness. A
//! second file defines the settings of the experiment. There are fewer of them than values in the first file.

mod experiment;
mod infrared;
mod model;
mod settings;

pub use experiment::EmbeddedExperiment;
pub use model::ModelExperiment;

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

/// A team of robots that see little and soon run out of energy has to feed a nest together \[FARSA2\].
///
/// All robots share one genome. They leave the nest, pick up the food that they drive over, and have to return before
/// their energy is used up. The condition selects the robot. The source specifies the arenas, nests, energy, steps,
/// sensors, motors and hidden neurons.
///
/// The number of robots, the time step, the view of the camera and the remaining properties of the network were chosen.
/// The load of a robot is not limited. Each infrared channel of a `MarXbot` is the maximum of three of its 24 sensors.
/// The bias neuron of the source corresponds to the biases of the hidden neurons.
pub static FORAGING: EmbeddedExperiment = EmbeddedExperiment::new(
    "foraging",
    include_str!("../../experiments/foraging.toml"),
    include_str!("../../experiments/foraging.settings.toml"),
    nests_fit,
);

/// A team of robots that sense a nest only while they are on it has to gather there \[FARSA2\].
///
/// All robots share one genome and start anywhere in the arena. At the end of a trial, every robot earns 100 if it is on
/// a nest, and up to 1 for its proximity to the others. The condition selects the robot. The source specifies the arena,
/// the steps and the rewards of the `MarXbot`. Sensors and motors are those of [`FORAGING`] without the energy. The spread
/// and the clusters of the robots are also measured \[Gauci2014\].
///
/// The nests, and all values that the settings list as chosen, are not specified by the source.
pub static AGGREGATION: EmbeddedExperiment = EmbeddedExperiment::new(
    "aggregation",
    include_str!("../../experiments/aggregation.toml"),
    include_str!("../../experiments/aggregation.settings.toml"),
    nests_fit,
);

/// A torso on one leg hops forward \[Towers2024, Hopper-v5\].
///
/// Rewards, ends and starts are those of Gymnasium. Its XML is read with `robot.model`, and the model of this crate has the same
/// names. The condition `no-bonus` has no reward for staying upright, and `way` has neither this nor a price of torques.
pub static HOPPER: ModelExperiment = ModelExperiment::new(
    "hopper",
    include_str!("../../experiments/locomotion/hopper.toml"),
    include_str!("../../experiments/locomotion/hopper.xml"),
);

/// A torso on two legs walks forward, as [`HOPPER`] \[Towers2024, Walker2d-v5\].
pub static WALKER2D: ModelExperiment = ModelExperiment::new(
    "walker2d",
    include_str!("../../experiments/locomotion/walker2d.toml"),
    include_str!("../../experiments/locomotion/walker2d.xml"),
);

/// A back on a hind and a fore leg runs forward, as [`HOPPER`] \[Towers2024, HalfCheetah-v5\].
pub static HALF_CHEETAH: ModelExperiment = ModelExperiment::new(
    "half-cheetah",
    include_str!("../../experiments/locomotion/half-cheetah.toml"),
    include_str!("../../experiments/locomotion/half-cheetah.xml"),
);

/// A ball on four legs runs forward, as [`HOPPER`] \[Towers2024, Ant-v5\].
///
/// Neither the observation nor the reward contains contact forces.
pub static ANT: ModelExperiment = ModelExperiment::new(
    "ant",
    include_str!("../../experiments/locomotion/ant.toml"),
    include_str!("../../experiments/locomotion/ant.xml"),
);

/// The ant of [`ANT`] runs in every direction, with an archive of elites by the place at the end \[Lim2022\].
///
/// The archive covers 10 m around the start, because a trial lasts 5 s. Gymnasium's bonus and price of torques are the
/// fitness.
pub static ANT_OMNI: ModelExperiment = ModelExperiment::new(
    "ant-omni",
    include_str!("../../experiments/locomotion/ant-omni.toml"),
    include_str!("../../experiments/locomotion/ant.xml"),
);

/// A body of two legs and two arms walks forward, as [`HOPPER`] \[Towers2024, Humanoid-v5\].
///
/// The observation has positions and velocities. The way is that of the torso instead of the center of mass, and contact
/// forces have no price.
pub static HUMANOID: ModelExperiment = ModelExperiment::new(
    "humanoid",
    include_str!("../../experiments/locomotion/humanoid.toml"),
    include_str!("../../experiments/locomotion/humanoid.xml"),
);

/// A quadruped walks and turns at commanded speeds \[Zakka2025\].
///
/// The model of this crate has the size of a Go1. The Go1 of the Playground is read with `robot.model`. Speeds, posture and
/// actions are those of the Playground. Rewards are for speed, turn, height and effort, and a clock gives the rhythm of steps.
pub static GO1_JOYSTICK: ModelExperiment = ModelExperiment::new(
    "go1-joystick",
    include_str!("../../experiments/locomotion/go1-joystick.toml"),
    include_str!("../../experiments/locomotion/go1-joystick.xml"),
);

/// A humanoid walks at a commanded speed, as [`GO1_JOYSTICK`] \[Zakka2025\].
pub static G1_WALK: ModelExperiment = ModelExperiment::new(
    "g1-walk",
    include_str!("../../experiments/locomotion/g1-walk.toml"),
    include_str!("../../experiments/locomotion/g1-walk.xml"),
);

/// Rejects nests without a size, and nests that cannot have their distance from all walls.
fn nests_fit(settings: &Settings) -> Result<(), Error> {
    if settings.number("nest.radius")? <= 0.0 {
        return Err(Error::setting("nest.radius", "must be more than 0"));
    }
    let (to_wall, size) = (settings.number("nest.to_wall")?, settings.number("world.size")?);
    let room = 0.5 * size;
    if to_wall > room {
        let why = format!("{to_wall} m from all walls of an arena of {size} m: at most {room} m");
        return Err(Error::setting("nest.to_wall", why));
    }
    Ok(())
}

/// A population of predators and a population of prey evolve against each other \[FARSA2\].
///
/// The two robots are `MarXbot`s with the same abilities in a walled arena. A predator that touches the prey at step t of T
/// earns 1 - t/T, and otherwise nothing. The prey earns the rest of 1. The source specifies the arena, the starts, T and
/// the rewards.
///
/// The headings, sensors, networks and the strategy were chosen, as the settings show.
pub static PREDATOR_PREY: EmbeddedExperiment = EmbeddedExperiment::new(
    "predator-prey",
    include_str!("../../experiments/predator-prey.toml"),
    include_str!("../../experiments/predator-prey.settings.toml"),
    starts_apart,
);

/// Rejects an arena in which both robots touch at the start.
fn starts_apart(settings: &Settings) -> Result<(), Error> {
    let (size, touch) = (settings.number("world.size")?, settings.number("capture.touch")?);
    let radius = MobileRobot::marxbot().radius;
    let least = 3.0 * (2.0 * radius + touch);
    if size <= least {
        let why =
            format!("no free place: two robots of {radius} m a third of {size} m apart touch; more than {least} m");
        return Err(Error::setting("world.size", why));
    }
    Ok(())
}

/// Rejects starts within the lamp or beyond the walls.
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
