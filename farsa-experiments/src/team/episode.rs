//! An episode of a team: robots with a controller each, and a scenario.

use farsa_body::Recorder;
use farsa_body::sensors::ColorBand;
use farsa_nn::Controller;
use farsa_physics::arena::{Arena, ArenaError};

use crate::team::config::TeamConfig;
use crate::team::robots::Team;
use farsa_lab::advanced::{Behavior, ChannelGroup, Interventions, PlanarWorld};
use farsa_lab::{Episode, EpisodeId, Error, Outcome};
use farsa_view::{Channel, Schema};

/// Where the robots of a team are, and since when.
#[derive(Clone, Copy, Debug)]
pub struct Moment<'a> {
    /// The places of the robots after the last step \[m\].
    pub places: &'a [[f32; 2]],
    /// Steps taken.
    pub steps: u32,
}

/// A task of a team: the differences between experiments with teams.
pub trait Scenario: Send {
    /// The robots.
    fn robots(&self) -> &TeamConfig;

    /// The arena with the robots, in their order, and everything else that a trial places.
    fn arena(&self) -> Arena;

    /// Number of a controller's inputs, those of the eyes first, and outputs.
    fn shape(&self) -> [usize; 2];

    /// The colors in the camera of a robot, as many for every robot.
    fn colors(&self, robot: usize) -> &'static [ColorBand];

    /// The names of the populations. With several, robot p has the genome of population p, else all robots have one.
    fn population_names(&self) -> &[&'static str] {
        &["0"]
    }

    /// Individuals of each of several populations.
    fn population_size(&self) -> usize {
        usize::MAX
    }

    /// Resets the score and places everything for a trial, by random numbers of the id's alone.
    ///
    /// # Errors
    /// [`ArenaError::NoFreePlace`] where something has no room.
    fn arrange<C: Controller, W: PlanarWorld>(
        &mut self,
        team: &Team<C>,
        world: &mut W,
        id: EpisodeId,
    ) -> Result<(), ArenaError>;

    /// The setting that an error names when there is too little room.
    fn crowded(&self) -> &'static str {
        "world.size"
    }

    /// Fills the inputs of the robot at `at` \[m\] that are not its eyes'. Returns false if it is dead.
    fn sense<W: PlanarWorld>(&self, world: &W, robot: usize, at: [f32; 2], rest: &mut [f32]) -> bool {
        let _ = (world, robot, at, rest);
        true
    }

    /// Scores the step that has passed. Returns true if the trial is over before its time.
    fn judge<W: PlanarWorld>(&mut self, world: &W, moment: Moment<'_>) -> bool;

    /// The test protocols, with what they do to the controllers.
    fn interventions(&self) -> Interventions {
        Interventions::default()
    }

    /// Begins a case of the protocol of this name, or none, and discards the changes of an earlier one.
    fn begin_case(&mut self, case: Option<(&str, usize)>) {
        let _ = case;
    }

    /// The reward of population `own` so far.
    fn reward(&self, own: usize, moment: Moment<'_>) -> f64;

    /// Names of the terms of the fitness.
    fn terms(&self) -> Vec<String>;

    /// Objectives and measures of an individual, in addition to its fitness.
    fn behavior(&self) -> Option<&dyn Behavior> {
        None
    }

    /// The outcome of the trial for population `own`.
    fn outcome(&self, own: usize, moment: Moment<'_>) -> Outcome;

    /// Names of a controller's inputs.
    fn input_names(&self) -> Vec<String>;

    /// The inputs in groups.
    fn inputs(&self) -> Vec<ChannelGroup>;

    /// The channels of [`scalars`](Self::scalars).
    fn channels(&self) -> Vec<Channel>;

    /// The recorded scalars of a step.
    fn scalars(&self, moment: Moment<'_>) -> Vec<f64>;

    /// A schema of the arena and the channels with what else is to be seen.
    fn shown_in(&self, schema: Schema) -> Schema {
        schema
    }

    /// Records what [`shown_in`](Self::shown_in) added.
    fn record(&self, recorder: &mut dyn Recorder) {
        let _ = recorder;
    }
}

/// Robots in a scenario, with a controller each.
#[derive(Clone, Debug)]
pub struct TeamEpisode<M, C> {
    scenario: M,
    team: Team<C>,
    /// Where the robots are after the last step \[m\].
    places: Vec<[f32; 2]>,
    most_steps: u32,
    steps: u32,
    failed: bool,
}

impl<M: Scenario, C: Controller> TeamEpisode<M, C> {
    /// An episode with these controllers, one for each robot.
    ///
    /// # Errors
    /// The errors of [`Team::new`].
    pub fn from_scenario(scenario: M, controllers: Vec<C>) -> Result<Self, Error> {
        let config = scenario.robots();
        Ok(Self {
            team: Team::new(config, |robot| scenario.colors(robot), scenario.shape(), controllers)?,
            places: vec![[0.0; 2]; config.robots],
            most_steps: config.steps,
            steps: 0,
            failed: false,
            scenario,
        })
    }

    /// Places everything for a trial.
    ///
    /// # Errors
    /// [`ArenaError::NoFreePlace`] after a thousand tries.
    pub fn arrange<W: PlanarWorld>(&mut self, world: &mut W, id: EpisodeId) -> Result<(), ArenaError> {
        self.scenario.arrange(&self.team, world, id)
    }

    /// Where the robots are, and since when.
    pub fn moment(&self) -> Moment<'_> {
        Moment { places: &self.places, steps: self.steps }
    }

    /// The reward of the first population so far, or NaN for a failed trial.
    pub fn fitness(&self) -> f64 {
        if self.failed { f64::NAN } else { self.scenario.reward(0, self.moment()) }
    }

    /// The outcome of the trial for population `own`.
    pub fn outcome(&self, own: usize) -> Outcome {
        if self.failed {
            return Outcome { terms: vec![f64::NAN; self.scenario.terms().len()], ..Outcome::default() };
        }
        self.scenario.outcome(own, self.moment())
    }

    /// The scenario, with its score.
    pub fn scenario(&self) -> &M {
        &self.scenario
    }

    /// The same, to be changed.
    pub(crate) fn scenario_mut(&mut self) -> &mut M {
        &mut self.scenario
    }

    /// The robots.
    pub fn team(&self) -> &Team<C> {
        &self.team
    }

    /// The robots, for other controllers.
    pub fn team_mut(&mut self) -> &mut Team<C> {
        &mut self.team
    }

    /// Steps taken.
    pub fn steps(&self) -> u32 {
        self.steps
    }

    /// True if something had no free place, or a value was not finite.
    pub fn failed(&self) -> bool {
        self.failed
    }
}

impl<M: Scenario, C: Controller, W: PlanarWorld> Episode<W> for TeamEpisode<M, C> {
    fn start(&mut self, world: &mut W, id: EpisodeId) {
        self.failed = self.arrange(world, id).is_err();
        self.team.reset();
        self.steps = 0;
    }

    fn has_started(&self) -> bool {
        !self.failed
    }

    /// All robots sense, compute and act.
    fn act(&mut self, world: &mut W) {
        let Self { scenario, team, .. } = self;
        team.act(world, |world, robot, parts, rest| {
            let [x, y, _] = world.pose(parts.body).position;
            scenario.sense(world, robot, [x, y], rest)
        });
    }

    /// Judges the step that has passed. `Some` ends the trial with the reward of the first population.
    fn judge(&mut self, world: &mut W) -> Option<f64> {
        let Self { scenario, team, places, .. } = self;
        self.steps += 1;
        for (robot, place) in places.iter_mut().enumerate() {
            *place = team.place(world, robot);
            self.failed |= !place.iter().all(|x| x.is_finite());
        }
        let over = scenario.judge(world, Moment { places, steps: self.steps });
        (self.failed || over || self.steps >= self.most_steps).then(|| self.fitness())
    }
}
