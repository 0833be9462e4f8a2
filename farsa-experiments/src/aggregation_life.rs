//! A life of `aggregation`: robots look for nests, and for each other.

use farsa_body::{Arrange as _, BodyId, Kinematics as _, Pose, Twist};
use farsa_nn::Controller;
use farsa_num::{Domain, Stream};
use farsa_physics::arena::{Area, Arena, ArenaError, World};

use crate::aggregation_measure::{Gathering, mean_distances};
use crate::error::Error;
use crate::foraging_life::{COLORS, NEST, on_nest};
use crate::life::{Job, Life};
use crate::settings::{Setting, Settings};
use crate::swarm_config::{TeamConfig, whole};
use crate::swarm_team::{OUTPUTS, Team, distance};

/// What the robots aggregate in; the defaults are those of a condition, the robot's name.
///
/// Lengths are metres.
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
    /// What a robot on a nest earns.
    pub nest_reward: f64,
    /// What a robot earns that is in the same place as all others.
    pub near_reward: f64,
}

impl AggregationConfig {
    /// The defaults of a condition.
    pub fn of_condition(condition: &str) -> Self {
        let team = TeamConfig::of_condition(condition);
        // Six radii: all ten robots fit onto one nest with room to drive by.
        let nest_radius = 6.0 * team.robot.radius;
        Self { nests: 2, nest_radius, nest_to_wall: 1.5 * nest_radius, nest_reward: 100.0, near_reward: 1.0, team }
    }

    /// Every value as a setting, with these as defaults.
    pub fn table(&self) -> Vec<Setting> {
        let length = |key: &str, default: f64| Setting::number(key, default, 0.0..=1000.0).unit("m");
        let reward = |key: &str, default: f64| Setting::number(key, default, 0.0..=1e6).given();
        let mut table = crate::swarm_config::evolution(80, 30, 6);
        table.extend(self.team.table(true, self.team.of_marxbots()));
        table.extend([
            Setting::whole("nest.count", whole(self.nests), 1..=100).doc("Nests; two, so that robots may part."),
            length("nest.radius", self.nest_radius)
                .doc("Radius of a nest; six of a robot's, so that ten robots fit with room to drive by."),
            length("nest.to_wall", self.nest_to_wall)
                .doc("Least distance of a nest's middle from the walls, and half of that from another nest's."),
            reward("fitness.nest", self.nest_reward).doc("What a robot earns at the end that is on a nest then."),
            reward("fitness.near", self.near_reward).doc(
                "What a robot earns at the end less its mean distance to the others, of the arena's diagonal; times this.",
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

    /// The arena with robots and nests, which every trial places anew.
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
        World::new(&Arena { size: None, ..self.arena() }).map_err(|error| Error::Other(error.to_string()))
    }

    /// Channels that a controller reads: infrared, camera and ground.
    pub fn inputs(&self) -> usize {
        self.team.seen(COLORS.len()) + 1
    }
}

/// Robots that aggregate, with a controller each.
///
/// A controller reads 8 infrared channels, the camera's (for each sector red, then blue), and whether the ground under the
/// robot is a nest's; it writes what [`Team`] says.
#[derive(Clone, Debug)]
pub struct AggregationLife<C> {
    config: AggregationConfig,
    team: Team<C>,
    nests: Vec<BodyId>,
    places: Vec<[f32; 2]>,
    /// On which nest each robot is.
    homes: Vec<Option<usize>>,
    steps: u32,
    failed: bool,
    begun: bool,
}

impl<C: Controller> AggregationLife<C> {
    /// A life of these controllers, one for each robot.
    ///
    /// # Errors
    /// Those of [`Team::new`].
    pub fn new(config: AggregationConfig, controllers: Vec<C>) -> Result<Self, Error> {
        let arena = config.arena();
        Ok(Self {
            team: Team::new(&config.team, |_| &COLORS, [config.inputs(), OUTPUTS], controllers)?,
            nests: (0..config.nests).map(|nest| arena.area(nest)).collect(),
            places: vec![[0.0; 2]; config.team.robots],
            homes: vec![None; config.team.robots],
            steps: 0,
            failed: false,
            begun: false,
            config,
        })
    }

    /// Puts the nests and then the robots somewhere, from the stream of [`Domain::Start`] of the job's trial, individual and
    /// generation.
    ///
    /// # Errors
    /// [`ArenaError::NoFreePlace`] after a thousand tries for a nest or a robot.
    pub fn arrange(&mut self, world: &mut World, job: Job) -> Result<(), ArenaError> {
        const TRIES: u32 = 1000;
        let Self { config, team, nests, .. } = self;
        let mut stream = Stream::new(job.seed, Domain::Start, job.trial, job.individual, job.generation);
        world.clear();
        let [low, high] = [config.nest_to_wall, config.team.size - config.nest_to_wall].map(|x| x as f32);
        let apart = (2.0 * config.nest_to_wall) as f32;
        let mut taken: Vec<[f32; 2]> = Vec::new();
        for &nest in nests.iter() {
            let mut short = f32::INFINITY;
            let at = (0..TRIES).find_map(|_| {
                let at = [0; 2].map(|_| stream.range(low, high.max(low)));
                let lacks = taken.iter().fold(f32::NEG_INFINITY, |most, other| most.max(apart - distance(at, *other)));
                short = short.min(lacks);
                (lacks <= 0.0).then_some(at)
            });
            let radius = config.nest_radius as f32;
            let at = at.ok_or(ArenaError::NoFreePlace { tries: TRIES, radius, short })?;
            world.place_body(nest, Pose::planar(at, 0.0), Twist::default());
            taken.push(at);
        }
        world.arranged();
        team.scatter(world, None, &mut stream)
    }

    /// All robots sense, think and act.
    pub fn act(&mut self, world: &mut World) {
        self.team.act(world, |world, _, parts, rest| {
            let [x, y, _] = world.pose(parts.body).position;
            rest.copy_from_slice(&[on_nest(world, [x, y])]);
            true
        });
    }

    /// Looks where the robots are; `Some` ends the trial with what it earned.
    pub fn judge(&mut self, world: &World) -> Option<f64> {
        let Self { config, team, nests, places, homes, failed, steps, .. } = self;
        *steps += 1;
        let centres = |nest: &BodyId| {
            let [x, y, _] = world.pose(*nest).position;
            [x, y]
        };
        for (robot, (place, home)) in places.iter_mut().zip(homes).enumerate() {
            *place = team.place(world, robot);
            *failed |= !place.iter().all(|x| x.is_finite());
            let near = |nest: &BodyId| distance(*place, centres(nest)) <= config.nest_radius as f32;
            *home = nests.iter().position(near);
        }
        (*failed || *steps >= config.team.steps).then(|| self.fitness())
    }

    /// What the team would earn if the trial ended now, the mean over its robots; NaN for a trial that failed.
    pub fn fitness(&self) -> f64 {
        let [nest, near] = self.terms();
        nest + near
    }

    /// What the team would earn for being on nests and for being near each other.
    pub fn terms(&self) -> [f64; 2] {
        let Self { config, places, homes, .. } = self;
        if self.failed {
            return [f64::NAN; 2];
        }
        let robots = places.len().max(1) as f64;
        let home = homes.iter().flatten().count() as f64 / robots;
        let diagonal = farsa_num::Scalar::sqrt(2.0 * config.team.size * config.team.size);
        let near: f64 = mean_distances(places, diagonal).iter().map(|far| 1.0 - far).sum::<f64>() / robots;
        [config.nest_reward * home, config.near_reward * near]
    }

    /// How close together the robots are.
    pub fn gathering(&self) -> Gathering {
        Gathering::of(&self.places, self.config.team.robot.radius)
    }

    /// On which nest each robot is.
    pub fn homes(&self) -> &[Option<usize>] {
        &self.homes
    }

    /// The configuration.
    pub fn config(&self) -> &AggregationConfig {
        &self.config
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

    /// Whether no place was found for a nest or a robot, or a number was none.
    pub fn failed(&self) -> bool {
        self.failed
    }
}

impl<C: Controller> Life<World> for AggregationLife<C> {
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
