//! A life of `predator-prey`: one robot chases another.

use core::f32::consts::PI;

use farsa_body::{Arrange as _, BodyId, ColorBand, Contacts as _, PairId, Pose, Twist};
use farsa_nn::Controller;
use farsa_num::{Domain, Stream};
use farsa_physics::arena::{Arena, CollisionRule, World};

use crate::error::Error;
use crate::life::{Job, Life};
use crate::settings::{Setting, Settings};
use crate::swarm_config::{TeamConfig, whole};
use crate::swarm_robot::{BLUE, RED};
use crate::swarm_team::{NetworkDecoder, Team, TeamNetwork, distance};

/// Words for the rules of collisions.
const CIRCLES: &str = "circles";
const UNDONE: &str = "undone";
/// Outputs of a controller: speed and turn.
pub(crate) const OUTPUTS: usize = 2;
/// The predator is robot 0, the prey robot 1.
pub(crate) const PREDATOR: usize = 0;
pub(crate) const PREY: usize = 1;
/// What the predator's and the prey's camera see: each other.
const SEEN: [[ColorBand; 1]; 2] = [[BLUE], [RED]];
/// Colours of the hulls.
const COLORS: [[f64; 3]; 2] = [[0.85, 0.15, 0.1], [0.1, 0.25, 0.85]];

/// Where the two robots meet.
///
/// Lengths are metres.
#[derive(Clone, Debug, PartialEq)]
pub struct PredatorPreyConfig {
    /// The two robots.
    pub team: TeamConfig,
    /// Hulls that are as near as this touch, as do those whose last step would have led into each other.
    pub touch: f64,
    /// What happens to robots that run into something.
    pub collisions: CollisionRule,
    /// Individuals of each population.
    pub population: usize,
}

impl Default for PredatorPreyConfig {
    fn default() -> Self {
        let team = TeamConfig {
            robots: 2,
            size: 3.0,
            trials: 4,
            steps: 2000,
            sectors: 8,
            field_of_view: core::f64::consts::TAU,
            rays: 6,
            hidden: 6,
            ..TeamConfig::of_condition("marxbot")
        };
        Self { team, touch: 0.002, collisions: CollisionRule::Circles, population: 30 }
    }
}

impl PredatorPreyConfig {
    /// Every value as a setting, with these as defaults.
    pub fn table(&self) -> Vec<Setting> {
        let mut table = crate::swarm_config::evolution(60, whole(self.population), 6);
        table.extend(self.team.table(false, true));
        table.push(
            Setting::word("world.collisions", CIRCLES, &[CIRCLES, UNDONE])
                .doc("Robots slide along what they run into; undone as in the original, chases were seen to end with both stuck a few centimetres apart."),
        );
        table.push(
            Setting::number("capture.touch", self.touch, 0.0..=1.0)
                .unit("m")
                .doc("Hulls as near as this touch, which is capture; so do hulls that collided in the last step."),
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
                UNDONE => CollisionRule::Undone,
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
        for (placed, name) in arena.robots.iter_mut().zip(["predator", "prey"]) {
            placed.robot.name = name.into();
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

    /// The network of a genome.
    ///
    /// # Errors
    /// [`Error::Other`] for a genome of another length.
    pub fn network(&self, genes: &[u16]) -> Result<TeamNetwork, Error> {
        let mut decoder = NetworkDecoder::new(self.team.layout(self.inputs(), OUTPUTS), self.team.weight_range)?;
        let mut network = decoder.network()?;
        if decoder.decode_into(genes, core::slice::from_mut(&mut network)) {
            return Ok(network);
        }
        let (found, wanted) = (genes.len(), decoder.layout.parameter_count());
        Err(Error::Other(format!("predator-prey: {found} genes where {wanted} are wanted")))
    }

    /// Channels that a controller reads: infrared and camera.
    pub fn inputs(&self) -> usize {
        self.team.seen(1)
    }
}

/// A predator and a prey with a controller each.
///
/// A controller reads 8 infrared channels and for each of the camera's sectors how much of it is the other robot; it writes
/// speed and turn.
#[derive(Clone, Debug)]
pub struct PredatorPreyLife<C> {
    config: PredatorPreyConfig,
    team: Team<C>,
    gap: f64,
    steps: u32,
    captured: bool,
    failed: bool,
    begun: bool,
}

impl<C: Controller> PredatorPreyLife<C> {
    /// A life of the predator's controller and the prey's.
    ///
    /// # Errors
    /// Those of [`Team::new`].
    pub fn new(config: PredatorPreyConfig, controllers: [C; 2]) -> Result<Self, Error> {
        let shape = [config.inputs(), OUTPUTS];
        Ok(Self {
            team: Team::new(&config.team, |robot| &SEEN[robot.min(PREY)], shape, controllers.into())?,
            gap: 0.0,
            steps: 0,
            captured: false,
            failed: false,
            begun: false,
            config,
        })
    }

    /// Puts both on the middle line, a third and two thirds along it, at headings from the stream of [`Domain::Start`] of
    /// the job's trial, generation, and place within its population.
    ///
    /// The same place in both populations has the same headings: the two lives of a test are one.
    pub fn arrange(&mut self, world: &mut World, job: Job) {
        let place = job.individual % (self.config.population as u32).max(1);
        let mut stream = Stream::new(job.seed, Domain::Start, job.trial, place, job.generation);
        world.clear();
        let size = self.config.team.size as f32;
        for robot in [PREDATOR, PREY] {
            let at = [size * (robot + 1) as f32 / 3.0, 0.5 * size];
            world.place_body(BodyId(robot as u16), Pose::planar(at, stream.range(-PI, PI)), Twist::default());
        }
        world.arranged();
    }

    /// Both robots sense, think and act.
    pub fn act(&mut self, world: &mut World) {
        self.team.act(world, |_, _, _, _| true);
    }

    /// Judges the step that has passed; `Some` ends the trial with the predator's reward.
    ///
    /// Capture is told by either robot's contact: one that also collides with a wall may tell of the wall only.
    pub fn judge(&mut self, world: &World) -> Option<f64> {
        self.steps += 1;
        let [predator, prey] = [PREDATOR, PREY].map(|robot| self.team.place(world, robot));
        self.gap = f64::from(distance(predator, prey)) - 2.0 * self.config.team.robot.radius;
        self.failed |= !self.gap.is_finite();
        let met = |a: usize, b: usize| {
            let pair = PairId(a as u16);
            world.touches(pair) && world.pair_bodies(pair)[1] == Some(BodyId(b as u16))
        };
        self.captured = met(PREDATOR, PREY) || met(PREY, PREDATOR) || self.gap <= self.config.touch;
        (self.failed || self.captured || self.steps >= self.config.team.steps).then(|| self.reward(PREDATOR))
    }

    /// What a robot has earned so far: the predator 1 - t/T for a capture at step t of T, the prey the rest of 1; NaN for a
    /// trial that failed.
    pub fn reward(&self, robot: usize) -> f64 {
        let share = f64::from(self.steps) / f64::from(self.config.team.steps.max(1));
        let predator = if self.captured { 1.0 - share } else { 0.0 };
        match robot {
            _ if self.failed => f64::NAN,
            PREDATOR => predator,
            _ => 1.0 - predator,
        }
    }

    /// Whether the prey was captured.
    pub fn captured(&self) -> bool {
        self.captured
    }

    /// Between the hulls after the last step \[m\].
    pub fn gap(&self) -> f64 {
        self.gap
    }

    /// The configuration.
    pub fn config(&self) -> &PredatorPreyConfig {
        &self.config
    }

    /// The two robots, the predator first.
    pub fn team(&self) -> &Team<C> {
        &self.team
    }

    /// The two robots, for other controllers.
    pub fn team_mut(&mut self) -> &mut Team<C> {
        &mut self.team
    }

    /// Steps lived.
    pub fn steps(&self) -> u32 {
        self.steps
    }

    /// Whether a number was none.
    pub fn failed(&self) -> bool {
        self.failed
    }
}

impl<C: Controller> Life<World> for PredatorPreyLife<C> {
    fn start(&mut self, world: &mut World, job: Job) {
        self.arrange(world, job);
        self.team.reset();
        (self.steps, self.begun, self.captured, self.failed) = (0, false, false, false);
    }

    fn tick(&mut self, world: &mut World) -> Option<f64> {
        let end = if self.begun { self.judge(world) } else { None };
        self.begun = true;
        if end.is_none() {
            self.act(world);
        }
        end
    }
}
