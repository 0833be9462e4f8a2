//! The values of `foraging`, as settings.

use farsa_lab::{Error, Setting, Settings};
use farsa_physics::arena::{Area, Arena, World};

use crate::team::config::{TeamConfig, whole};
use crate::team::nest::{COLORS, NEST};
use crate::team::{nest, task};

/// The arena of foraging. The defaults are those of a condition, the robot's name.
///
/// Lengths are in meters.
#[derive(Clone, Debug, PartialEq)]
pub struct ForagingConfig {
    /// The robots.
    pub team: TeamConfig,
    /// Radius of the nest.
    pub nest_radius: f64,
    /// Least distance of the nest's middle from the walls.
    pub nest_to_wall: f64,
    /// Greatest distance of the robots' middles from the nest's at the start.
    pub start_within: f64,
    /// Cells of food along a side.
    pub cells: usize,
    /// Energy that a step costs, of 1.
    pub cost: f64,
}

impl ForagingConfig {
    /// The defaults of a condition.
    pub fn for_condition(condition: &str) -> Self {
        let team = TeamConfig::for_condition(condition);
        // The source's 500 mm/s for all: of the smaller robots' own wheels we do not ask what they cannot do.
        let (nest_radius, speed) = match condition {
            "e-puck" => (0.16, team.speed),
            "khepera" => (0.12, team.speed),
            _ => (0.4, 0.5),
        };
        // The MarXbot's camera sees all around. Lights behind a robot show it the others.
        let field_of_view = if team.uses_marxbots() { core::f64::consts::TAU } else { team.field_of_view };
        Self {
            team: TeamConfig { speed, field_of_view, trials: 4, ..team },
            nest_radius,
            nest_to_wall: 1.0,
            start_within: 0.5,
            cells: 20,
            cost: 0.01,
        }
    }

    /// Every value as a setting, with these as defaults.
    pub fn table(&self) -> Vec<Setting> {
        let length = |key: &str, default: f64| Setting::number(key, default, 0.0..=1000.0).unit("m").given();
        let mut table = crate::team::config::evolution([400, 40, 8], 0.004);
        table.extend(self.team.table(true, true));
        let speed = Setting::number("robot.speed", self.team.speed, 1e-3..=10.0).unit("m/s");
        let speed = if self.team.uses_marxbots() { speed.given() } else { speed };
        table.extend([
            speed.doc(
                "Largest speed of a robot. The source's 500 mm/s are a MarXbot's, and the others have the speed of their wheels.",
            ),
            length("nest.radius", self.nest_radius).doc("Radius of the nest."),
            length("nest.to_wall", self.nest_to_wall).doc("Least distance of the nest's middle from the walls."),
            length("start.within", self.start_within)
                .doc("Greatest distance of a robot's middle from the nest's middle at the start."),
            Setting::whole("food.cells", whole(self.cells), 1..=1000)
                .given()
                .doc("Cells along a side of the arena. Each has one piece of food, which the first robot there takes."),
            Setting::number("energy.cost", self.cost, 0.0..=1.0).given().doc(
                "Energy that a step costs, of the 1 that the nest gives. A robot without energy is dead, and its food is lost.",
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
            team: TeamConfig { speed: settings.number("robot.speed")?, ..self.team.read(true, settings)? },
            nest_radius: settings.number("nest.radius")?,
            nest_to_wall: settings.number("nest.to_wall")?,
            start_within: settings.number("start.within")?,
            cells: settings.count("food.cells")?,
            cost: settings.number("energy.cost")?,
        };
        nest::check(read.nest_radius, read.nest_to_wall, read.team.size)?;
        Ok(read)
    }

    /// The arena with robots and nest, which every trial places.
    pub fn arena(&self) -> Arena {
        let mut arena = self.team.arena();
        arena.add_area(Area::circle([0.5 * self.team.size; 2], self.nest_radius, NEST));
        arena
    }

    /// A world of that arena.
    ///
    /// # Errors
    /// [`Error::Other`] for values that make no world.
    pub fn world(&self) -> Result<World, Error> {
        task::world(self.arena())
    }

    /// Channels that a controller reads: infrared, camera, ground and energy.
    pub fn inputs(&self) -> usize {
        self.team.seen(COLORS.len()) + 2
    }
}
