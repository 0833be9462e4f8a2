//! The values of `predator-prey`, as settings.

use farsa_lab::advanced::{OwnedNetwork, resting_network};
use farsa_lab::{Error, Setting, Settings};
use farsa_physics::arena::{Arena, CollisionRule, World};

use crate::team::config::{TeamConfig, whole};
use crate::team::task;

/// Words for the rules of collisions.
const CIRCLES: &str = "circles";
const UNDONE: &str = "undone";
/// Outputs of a controller: speed and turn.
pub(crate) const OUTPUTS: usize = 2;
/// The robots and their populations.
pub(crate) const NAMES: [&str; 2] = ["predator", "prey"];
/// Colours of the hulls.
const COLORS: [[f64; 3]; 2] = [[0.85, 0.15, 0.1], [0.1, 0.25, 0.85]];

/// The arena of the two robots.
///
/// Lengths are in meters.
#[derive(Clone, Debug, PartialEq)]
pub struct PredatorPreyConfig {
    /// The two robots.
    pub team: TeamConfig,
    /// Hulls that are as near as this touch, as do those whose last step would have led into each other.
    pub touch: f64,
    /// The rule for robots that run into something.
    pub collisions: CollisionRule,
    /// Individuals of each population.
    pub population: usize,
}

impl Default for PredatorPreyConfig {
    fn default() -> Self {
        let team = TeamConfig {
            robots: 2,
            size: 3.0,
            trials: 6,
            steps: 2000,
            sectors: 8,
            field_of_view: core::f64::consts::TAU,
            rays: 6,
            hidden: 6,
            ..TeamConfig::for_condition("marxbot")
        };
        Self { team, touch: 0.002, collisions: CollisionRule::Circles, population: 40 }
    }
}

impl PredatorPreyConfig {
    /// Every value as a setting, with these as defaults.
    pub fn table(&self) -> Vec<Setting> {
        let mut table = crate::team::config::evolution([250, whole(self.population), 8], 0.004);
        table.extend(self.team.table(false, true));
        table.push(
            Setting::word("world.collisions", CIRCLES, &[CIRCLES, UNDONE])
                .doc("Robots slide along obstacles. With `undone`, as in the original, chases can end with both stuck a few centimeters apart."),
        );
        table.push(
            Setting::number("capture.touch", self.touch, 0.0..=1.0)
                .unit("m")
                .doc("Hulls as near as this touch, which is capture. So do hulls that collided in the last step."),
        );
        table
    }

    /// These values with those of checked settings.
    ///
    /// # Errors
    /// [`Error::Setting`] for an arena that is too small for the two starts.
    pub fn read(self, settings: &Settings) -> Result<Self, Error> {
        let read = Self {
            team: self.team.read(false, settings)?,
            touch: settings.number("capture.touch")?,
            collisions: match settings.word("world.collisions")? {
                UNDONE => CollisionRule::Revert,
                _ => CollisionRule::Circles,
            },
            population: settings.count("evolution.population")?,
        };
        let [size, radius] = [read.team.size, read.team.robot.radius];
        let least = 3.0 * (2.0 * radius + read.touch);
        if size <= least {
            let why =
                format!("no free place: two robots of {radius} m a third of {size} m apart touch; more than {least} m");
            return Err(Error::setting("world.size", why));
        }
        Ok(read)
    }

    /// The arena with the red predator and the blue prey.
    pub fn arena(&self) -> Arena {
        let mut arena = Arena { collisions: self.collisions, ..self.team.arena() };
        arena.robots.iter_mut().zip(COLORS).for_each(|(placed, color)| placed.robot.color = color);
        for (placed, name) in arena.robots.iter_mut().zip(NAMES) {
            placed.robot.name = name.into();
        }
        arena
    }

    /// A world of that arena.
    ///
    /// # Errors
    /// [`Error::Other`] for values that make no world.
    pub fn world(&self) -> Result<World, Error> {
        task::world(self.arena())
    }

    /// The network with these parameters.
    ///
    /// # Errors
    /// [`Error::Other`] for another number of them.
    pub fn network(&self, parameters: &[f32]) -> Result<OwnedNetwork, Error> {
        let mut network = resting_network(&self.team.layout(self.inputs(), OUTPUTS))?;
        network.copy_parameters(parameters).map_err(|error| Error::Other(format!("predator-prey: {error}")))?;
        Ok(network)
    }

    /// Channels that a controller reads: infrared and camera.
    pub fn inputs(&self) -> usize {
        self.team.seen(1)
    }
}
