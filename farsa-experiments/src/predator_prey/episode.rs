//! An episode of `predator-prey`: one robot chases another.

use core::f32::consts::PI;

use farsa_body::ports::{BodyId, PairId};
use farsa_body::sensors::ColorBand;
use farsa_body::{Pose, Twist};
use farsa_nn::Controller;
use farsa_num::{Domain, Stream};
use farsa_physics::arena::{Arena, ArenaError};

use crate::predator_prey::config::{NAMES, OUTPUTS, PredatorPreyConfig};
use crate::team::config::TeamConfig;
use crate::team::episode::{Moment, Scenario, TeamEpisode};
use crate::team::eyes::{BLUE, RED};
use crate::team::robots::{Team, distance};
use crate::team::task::{eye_groups, eye_names};
use farsa_lab::advanced::{Behavior, ChannelGroup, NotedBehavior, PlanarWorld};
use farsa_lab::{EpisodeId, Error, Note, Outcome};
use farsa_view::Channel;

/// The predator is robot 0, the prey robot 1.
pub(crate) const PREDATOR: usize = 0;
pub(crate) const PREY: usize = 1;
/// The colors in the cameras of predator and prey: each other.
const SEEN: [[ColorBand; 1]; 2] = [[BLUE], [RED]];

/// A predator and a prey with a controller each.
///
/// A controller reads 8 infrared channels and for each of the camera's sectors the share of the other robot in it. It writes speed
/// and turn.
pub type PredatorPreyEpisode<C> = TeamEpisode<PredatorPreyScenario, C>;

impl<C: Controller> PredatorPreyEpisode<C> {
    /// An episode of the predator's controller and the prey's.
    ///
    /// # Errors
    /// The errors of [`Team::new`].
    pub fn new(config: PredatorPreyConfig, controllers: [C; 2]) -> Result<Self, Error> {
        Self::from_scenario(PredatorPreyScenario::new(config), controllers.into())
    }

    /// True if the prey was captured.
    pub fn captured(&self) -> bool {
        self.scenario().captured
    }

    /// Between the hulls after the last step \[m\].
    pub fn gap(&self) -> f64 {
        self.scenario().gap
    }
}

/// A chase, and how it ends.
#[derive(Clone, Debug)]
pub struct PredatorPreyScenario {
    config: PredatorPreyConfig,
    gap: f64,
    captured: bool,
}

impl PredatorPreyScenario {
    /// A chase under a configuration.
    pub fn new(config: PredatorPreyConfig) -> Self {
        Self { config, gap: 0.0, captured: false }
    }

    /// The configuration.
    pub fn config(&self) -> &PredatorPreyConfig {
        &self.config
    }
}

/// Objectives and measures of an individual, for strategies that use more than its fitness.
static BEHAVIOUR: NotedBehavior = NotedBehavior {
    objectives: &[("gap at the end [m]", -1.0)],
    descriptors: &[("time [s]", [0.0, 100.0]), ("gap at the end [m]", [0.0, 1.0])],
};

impl Scenario for PredatorPreyScenario {
    fn robots(&self) -> &TeamConfig {
        &self.config.team
    }

    fn arena(&self) -> Arena {
        self.config.arena()
    }

    fn shape(&self) -> [usize; 2] {
        [self.config.inputs(), OUTPUTS]
    }

    fn colors(&self, robot: usize) -> &'static [ColorBand] {
        &SEEN[robot.min(PREY)]
    }

    fn population_names(&self) -> &[&'static str] {
        &NAMES
    }

    fn population_size(&self) -> usize {
        self.config.population
    }

    /// Puts both on the middle line, a third and two thirds along it, at headings from the stream of [`Domain::Start`] of
    /// the id's trial, generation, and place within its population.
    ///
    /// The same place in both populations has the same headings: the two episodes of a test are one.
    fn arrange<C: Controller, W: PlanarWorld>(
        &mut self,
        _: &Team<C>,
        world: &mut W,
        id: EpisodeId,
    ) -> Result<(), ArenaError> {
        let place = id.individual % (self.config.population as u32).max(1);
        let mut stream = Stream::new(id.seed, Domain::Start, id.trial, place, id.generation);
        self.captured = false;
        world.clear();
        let size = self.config.team.size as f32;
        for robot in [PREDATOR, PREY] {
            let at = [size * (robot + 1) as f32 / 3.0, 0.5 * size];
            world.place_body(BodyId(robot as u16), Pose::planar(at, stream.range(-PI, PI)), Twist::default());
        }
        world.finish_placement();
        Ok(())
    }

    /// Either robot's contact shows a capture: one that also collides with a wall may report the wall only.
    fn judge<W: PlanarWorld>(&mut self, world: &W, moment: Moment<'_>) -> bool {
        let [predator, prey] = [PREDATOR, PREY].map(|robot| moment.places[robot]);
        self.gap = f64::from(distance(predator, prey)) - 2.0 * self.config.team.robot.radius;
        let met = |a: usize, b: usize| {
            let pair = PairId(a as u16);
            world.touches(pair) && world.pair_bodies(pair)[1] == Some(BodyId(b as u16))
        };
        self.captured = met(PREDATOR, PREY) || met(PREY, PREDATOR) || self.gap <= self.config.touch;
        self.captured
    }

    /// The predator 1 - t/T for a capture at step t of T, the prey the rest of 1.
    fn reward(&self, own: usize, moment: Moment<'_>) -> f64 {
        let share = f64::from(moment.steps) / f64::from(self.config.team.steps.max(1));
        let predator = if self.captured { 1.0 - share } else { 0.0 };
        if own == PREDATOR { predator } else { 1.0 - predator }
    }

    fn terms(&self) -> Vec<String> {
        vec!["reward".into()]
    }

    fn outcome(&self, own: usize, moment: Moment<'_>) -> Outcome {
        Outcome {
            terms: vec![self.reward(own, moment)],
            steps: moment.steps,
            success: self.captured == (own == PREDATOR),
            notes: vec![
                ("captures", Note::from(if self.captured { 1.0 } else { 0.0 })),
                ("time [s]", Note::from(f64::from(moment.steps) * self.config.team.time_step)),
                ("gap at the end [m]", Note::from(self.gap)),
            ],
            ..Outcome::default()
        }
    }

    fn behavior(&self) -> Option<&dyn Behavior> {
        Some(&BEHAVIOUR)
    }

    fn input_names(&self) -> Vec<String> {
        eye_names(self.config.team.sectors, &["other"])
    }

    fn inputs(&self) -> Vec<ChannelGroup> {
        eye_groups(&self.config.team, "the other robot", 1)
    }

    fn channels(&self) -> Vec<Channel> {
        let rewards = ["predator's reward", "prey's reward"].map(|name| Channel::new(name).group("fitness"));
        [Channel::new("gap [m]").group("place")].into_iter().chain(rewards).collect()
    }

    fn scalars(&self, moment: Moment<'_>) -> Vec<f64> {
        vec![self.gap, self.reward(PREDATOR, moment), self.reward(PREY, moment)]
    }
}
