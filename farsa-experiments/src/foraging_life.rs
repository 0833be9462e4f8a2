//! A life of `foraging`: robots carry food from a field to their nest, and must come home to live.

use farsa_body::{Arrange as _, BodyId, ColorBand, Kinematics as _, Planar as _, Pose, Twist};
use farsa_nn::Controller;
use farsa_num::{Domain, Stream};
use farsa_physics::arena::{Area, Arena, ArenaError, World};

use crate::error::Error;
use crate::foraging_field::Field;
use crate::life::{Job, Life};
use crate::settings::{Setting, Settings};
use crate::swarm_config::{TeamConfig, whole};
use crate::swarm_robot::{BLUE, RED};
use crate::swarm_team::{OUTPUTS, Team};

/// What the cameras see.
pub(crate) const COLORS: [ColorBand; 2] = [RED, BLUE];

/// What the robots forage in; the defaults are those of a condition, the robot's name.
///
/// Lengths are metres.
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
    pub fn of_condition(condition: &str) -> Self {
        let team = TeamConfig::of_condition(condition);
        // The source's 500 mm/s for all: of the smaller robots' own wheels we do not ask what they cannot do.
        let (nest_radius, speed) = match condition {
            "e-puck" => (0.16, team.speed),
            "khepera" => (0.12, team.speed),
            _ => (0.4, 0.5),
        };
        Self {
            team: TeamConfig { speed, ..team },
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
        let mut table = crate::swarm_config::evolution(80, 30, 6);
        table.extend(self.team.table(true, true));
        let speed = Setting::number("robot.speed", self.team.speed, 1e-3..=10.0).unit("m/s");
        let speed = if self.team.of_marxbots() { speed.given() } else { speed };
        table.extend([
            speed.doc(
                "The fastest that a robot drives; the source's 500 mm/s are a MarXbot's, the others keep their own.",
            ),
            length("nest.radius", self.nest_radius).doc("Radius of the nest."),
            length("nest.to_wall", self.nest_to_wall).doc("Least distance of the nest's middle from the walls."),
            length("start.within", self.start_within)
                .doc("Greatest distance of a robot's middle from the nest's middle at the start."),
            Setting::whole("food.cells", whole(self.cells), 1..=1000)
                .given()
                .doc("Cells along a side of the arena; each has one piece of food, which the first robot there takes."),
            Setting::number("energy.cost", self.cost, 0.0..=1.0).given().doc(
                "Energy that a step costs of the 1 that the nest gives; a robot without is dead, and its food is lost.",
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
        if read.nest_radius <= 0.0 {
            return Err(Error::setting("nest.radius", "must be more than 0"));
        }
        let room = 0.5 * read.team.size;
        if read.nest_to_wall > room {
            let why =
                format!("{} m from all walls of an arena of {} m: at most {room} m", read.nest_to_wall, read.team.size);
            return Err(Error::setting("nest.to_wall", why));
        }
        Ok(read)
    }

    /// The arena with robots and nest, which every trial places anew.
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
        World::new(&Arena { size: None, ..self.arena() }).map_err(|error| Error::Other(error.to_string()))
    }

    /// Channels that a controller reads: infrared, camera, ground and energy.
    pub fn inputs(&self) -> usize {
        self.team.seen(COLORS.len()) + 2
    }
}

/// Colour of a nest: dark on the white ground.
pub(crate) const NEST: [f64; 3] = [0.45, 0.45, 0.45];
/// The ground is darker than this in a nest.
const DARK: f32 = 0.7;

/// Whether the ground there is a nest's, as a sensor reads it \[0 or 1\].
pub(crate) fn on_nest(world: &World, [x, y]: [f32; 2]) -> f32 {
    if world.ground([x, y])[0] < DARK { 1.0 } else { 0.0 }
}

/// Robots that forage, with a controller each, and the book of their food and energy.
///
/// A controller reads 8 infrared channels, the camera's (for each sector red, then blue), whether the ground under the
/// robot is the nest's, and its energy; it writes what [`Team`] says.
#[derive(Clone, Debug)]
pub struct ForagingLife<C> {
    config: ForagingConfig,
    team: Team<C>,
    field: Field,
    nest: BodyId,
    steps: u32,
    failed: bool,
    begun: bool,
}

impl<C: Controller> ForagingLife<C> {
    /// A life of these controllers, one for each robot.
    ///
    /// # Errors
    /// Those of [`Team::new`].
    pub fn new(config: ForagingConfig, controllers: Vec<C>) -> Result<Self, Error> {
        let TeamConfig { size, robots, .. } = config.team;
        Ok(Self {
            team: Team::new(&config.team, |_| &COLORS, [config.inputs(), OUTPUTS], controllers)?,
            field: Field::new(size, config.cells, config.cost, config.nest_radius, robots),
            nest: config.arena().area(0),
            steps: 0,
            failed: false,
            begun: false,
            config,
        })
    }

    /// Puts the nest and then the robots somewhere, from the stream of [`Domain::Start`] of the job's trial, individual and
    /// generation.
    ///
    /// # Errors
    /// [`ArenaError::NoFreePlace`] after a thousand tries for a robot.
    pub fn arrange(&mut self, world: &mut World, job: Job) -> Result<(), ArenaError> {
        let Self { config, team, field, nest, .. } = self;
        let mut stream = Stream::new(job.seed, Domain::Start, job.trial, job.individual, job.generation);
        world.clear();
        let [low, high] = [config.nest_to_wall, config.team.size - config.nest_to_wall].map(|x| x as f32);
        let at = [0; 2].map(|_| stream.range(low, high.max(low)));
        world.place_body(*nest, Pose::planar(at, 0.0), Twist::default());
        world.arranged();
        field.begin(at.map(f64::from));
        team.scatter(world, Some((at, config.start_within as f32)), &mut stream)
    }

    /// All robots sense, think and act; the dead stand still in the dark.
    pub fn act(&mut self, world: &mut World) {
        let Self { team, field, .. } = self;
        team.act(world, |world, robot, parts, rest| {
            let [x, y, _] = world.pose(parts.body).position;
            let forager = &field.robots()[robot];
            rest.copy_from_slice(&[on_nest(world, [x, y]), forager.energy as f32]);
            forager.alive
        });
    }

    /// Enters the step that has passed into the book; `Some` ends the trial with the food in the nest.
    pub fn judge(&mut self, world: &World) -> Option<f64> {
        self.steps += 1;
        for robot in 0..self.team.robots() {
            let at = self.team.place(world, robot).map(f64::from);
            self.failed |= !at.iter().all(|x| x.is_finite());
            self.field.step(robot, at);
        }
        // Nothing changes any more when all are dead.
        let over = self.field.deaths() == self.team.robots();
        (self.failed || over || self.steps >= self.config.team.steps).then(|| self.fitness())
    }

    /// What the trial has earned so far: pieces of food that the team carried to the nest; NaN for one that failed.
    pub fn fitness(&self) -> f64 {
        if self.failed { f64::NAN } else { f64::from(self.field.collected()) }
    }

    /// The configuration.
    pub fn config(&self) -> &ForagingConfig {
        &self.config
    }

    /// The book.
    pub fn field(&self) -> &Field {
        &self.field
    }

    /// The robots.
    pub fn team(&self) -> &Team<C> {
        &self.team
    }

    /// The robots, for other controllers.
    pub fn team_mut(&mut self) -> &mut Team<C> {
        &mut self.team
    }

    /// Steps lived.
    pub fn steps(&self) -> u32 {
        self.steps
    }

    /// Whether no place was found for a robot, or a number was none.
    pub fn failed(&self) -> bool {
        self.failed
    }
}

impl<C: Controller> Life<World> for ForagingLife<C> {
    fn start(&mut self, world: &mut World, job: Job) {
        self.failed = self.arrange(world, job).is_err();
        self.team.reset();
        (self.steps, self.begun) = (0, false);
    }

    fn tick(&mut self, world: &mut World) -> Option<f64> {
        if self.failed {
            return Some(f64::NAN);
        }
        let end = if self.begun { self.judge(world) } else { None };
        self.begun = true;
        if end.is_none() {
            self.act(world);
        }
        end
    }
}
