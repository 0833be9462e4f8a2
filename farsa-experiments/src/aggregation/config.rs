//! The values of `aggregation`, as settings.

use farsa_lab::{Error, Setting, Settings};
use farsa_physics::arena::{Area, Arena, World};

use crate::team::config::{TeamConfig, whole};
use crate::team::nest::{COLORS, NEST};
use crate::team::{nest, task};

/// The arena of aggregation. The defaults are those of a condition, the robot's name.
///
/// Lengths are in meters.
#[derive(Clone, Debug, PartialEq)]
pub struct AggregationConfig {
    /// The robots.
    pub team: TeamConfig,
    /// Number of nests.
    pub nests: usize,
    /// Radius of a nest.
    pub nest_radius: f64,
    /// Least distance of the nests' middles from the walls and half of that between them.
    pub nest_to_wall: f64,
    /// Reward of a robot on a nest.
    pub nest_reward: f64,
    /// Reward of a robot in the same place as all others.
    pub near_reward: f64,
}

impl AggregationConfig {
    /// The defaults of a condition.
    pub fn for_condition(condition: &str) -> Self {
        let team = TeamConfig::for_condition(condition);
        // Six radii: all ten robots fit onto one nest with room to drive by.
        let nest_radius = 6.0 * team.robot.radius;
        Self {
            nests: 2,
            nest_radius,
            nest_to_wall: 1.5 * nest_radius,
            nest_reward: 100.0,
            near_reward: 1.0,
            team: TeamConfig { trials: 4, ..team },
        }
    }

    /// Every value as a setting, with these as defaults.
    pub fn table(&self) -> Vec<Setting> {
        let length = |key: &str, default: f64| Setting::number(key, default, 0.0..=1000.0).unit("m");
        let reward = |key: &str, default: f64| Setting::number(key, default, 0.0..=1e6).given();
        let mut table = crate::team::config::evolution([120, 30, 6], 0.02);
        table.extend(self.team.table(true, self.team.uses_marxbots()));
        table.extend([
            Setting::whole("nest.count", whole(self.nests), 1..=100).doc("Nests. With two, robots can separate."),
            length("nest.radius", self.nest_radius)
                .doc("Radius of a nest. Six of a robot's, so that ten robots fit with room to drive by."),
            length("nest.to_wall", self.nest_to_wall)
                .doc("Least distance of a nest's middle from the walls, and half of that from another nest's."),
            reward("fitness.nest", self.nest_reward).doc("Reward at the end of a robot on a nest."),
            reward("fitness.near", self.near_reward).doc(
                "Reward at the end of a robot in the place of all others. It falls with the mean distance to the others, in parts of the arena's diagonal.",
            ),
        ]);
        table
    }

    /// These values with those of checked settings.
    ///
    /// # Errors
    /// [`Error::Setting`] for what does not go together.
    pub fn read(self, settings: &Settings) -> Result<Self, Error> {
        let read = Self {
            team: self.team.read(true, settings)?,
            nests: settings.count("nest.count")?,
            nest_radius: settings.number("nest.radius")?,
            nest_to_wall: settings.number("nest.to_wall")?,
            nest_reward: settings.number("fitness.nest")?,
            near_reward: settings.number("fitness.near")?,
        };
        nest::check(read.nest_radius, read.nest_to_wall, read.team.size)?;
        Ok(read)
    }

    /// The arena with robots and nests, which every trial places.
    pub fn arena(&self) -> Arena {
        let mut arena = self.team.arena();
        for _ in 0..self.nests {
            arena.add_area(Area::circle([0.5 * self.team.size; 2], self.nest_radius, NEST));
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

    /// Channels that a controller reads: infrared, camera and ground.
    pub fn inputs(&self) -> usize {
        self.team.seen(COLORS.len()) + 1
    }
}
