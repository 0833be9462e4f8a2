//! A life of a team: robots with a controller each, and a mission that says what it is about.

use farsa_body::ColorBand;
use farsa_nn::Controller;
use farsa_physics::arena::{Arena, ArenaError};

use crate::team::config::TeamConfig;
use crate::team::robots::Team;
use farsa_lab::{ChannelGroup, Episode, EpisodeId, Error, Outcome, PlanarWorld};
use farsa_view::Channel;

/// Where the robots of a team are, and since when.
#[derive(Clone, Copy, Debug)]
pub struct Moment<'a> {
    /// The places of the robots after the last step \[m\].
    pub places: &'a [[f32; 2]],
    /// Steps lived.
    pub steps: u32,
}

/// What a team is to do: all that tells one experiment with a team from another.
pub trait Mission: Send {
    /// The robots.
    fn robots(&self) -> &TeamConfig;

    /// The arena with the robots, in their order, and whatever else a trial places anew.
    fn arena(&self) -> Arena;

    /// Number of a controller's inputs, those of the eyes first, and outputs.
    fn shape(&self) -> [usize; 2];

    /// What the camera of a robot sees; as many colours for every robot.
    fn colors(&self, robot: usize) -> &'static [ColorBand];

    /// What the populations are called: with several, robot p has the genome of population p, else all robots have one.
    fn population_names(&self) -> &[&'static str] {
        &["0"]
    }

    /// Individuals of each of several populations.
    fn population_size(&self) -> usize {
        usize::MAX
    }

    /// Opens a new account and places everything for a trial, by random numbers of the id's alone.
    ///
    /// # Errors
    /// [`ArenaError::NoFreePlace`] where something has no room.
    fn arrange<C: Controller, W: PlanarWorld>(
        &mut self,
        team: &Team<C>,
        world: &mut W,
        id: EpisodeId,
    ) -> Result<(), ArenaError>;

    /// The setting that is to blame for too little room.
    fn crowded(&self) -> &'static str {
        "world.size"
    }

    /// Fills the inputs of the robot at `at` \[m\] that are not its eyes'; false if it does not live.
    fn sense<W: PlanarWorld>(&self, world: &W, robot: usize, at: [f32; 2], rest: &mut [f32]) -> bool {
        let _ = (world, robot, at, rest);
        true
    }

    /// Enters the step that has passed into the account; true if the trial is over before its time.
    fn judge<W: PlanarWorld>(&mut self, world: &W, moment: Moment<'_>) -> bool;

    /// What population `own` has earned so far.
    fn earned(&self, own: usize, moment: Moment<'_>) -> f64;

    /// Names of the terms of the fitness.
    fn terms(&self) -> Vec<String>;

    /// What came of the trial for population `own`.
    fn outcome(&self, own: usize, moment: Moment<'_>) -> Outcome;

    /// Names of a controller's inputs.
    fn input_names(&self) -> Vec<String>;

    /// The inputs in groups.
    fn inputs(&self) -> Vec<ChannelGroup>;

    /// What [`scalars`](Self::scalars) tells.
    fn channels(&self) -> Vec<Channel>;

    /// What a recorder is told at every step beside robots and poses.
    fn scalars(&self, moment: Moment<'_>) -> Vec<f64>;
}

/// Robots on a mission, with a controller each.
#[derive(Clone, Debug)]
pub struct TeamLife<M, C> {
    mission: M,
    team: Team<C>,
    /// Where the robots are after the last step \[m\].
    places: Vec<[f32; 2]>,
    most_steps: u32,
    steps: u32,
    failed: bool,
}

impl<M: Mission, C: Controller> TeamLife<M, C> {
    /// A life of these controllers, one for each robot.
    ///
    /// # Errors
    /// Those of [`Team::new`].
    pub fn on(mission: M, controllers: Vec<C>) -> Result<Self, Error> {
        let config = mission.robots();
        Ok(Self {
            team: Team::new(config, |robot| mission.colors(robot), mission.shape(), controllers)?,
            places: vec![[0.0; 2]; config.robots],
            most_steps: config.steps,
            steps: 0,
            failed: false,
            mission,
        })
    }

    /// Places everything for a trial.
    ///
    /// # Errors
    /// [`ArenaError::NoFreePlace`] after a thousand tries.
    pub fn arrange<W: PlanarWorld>(&mut self, world: &mut W, id: EpisodeId) -> Result<(), ArenaError> {
        self.mission.arrange(&self.team, world, id)
    }

    /// Where the robots are, and since when.
    pub fn moment(&self) -> Moment<'_> {
        Moment { places: &self.places, steps: self.steps }
    }

    /// What the first population has earned so far; NaN for a trial that failed.
    pub fn fitness(&self) -> f64 {
        if self.failed { f64::NAN } else { self.mission.earned(0, self.moment()) }
    }

    /// What came of the trial for population `own`.
    pub fn outcome(&self, own: usize) -> Outcome {
        if self.failed {
            return Outcome { terms: vec![f64::NAN; self.mission.terms().len()], ..Outcome::default() };
        }
        self.mission.outcome(own, self.moment())
    }

    /// What the robots are to do, with its account.
    pub fn mission(&self) -> &M {
        &self.mission
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

    /// Whether no place was found for something, or a number was none.
    pub fn failed(&self) -> bool {
        self.failed
    }
}

impl<M: Mission, C: Controller, W: PlanarWorld> Episode<W> for TeamLife<M, C> {
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
        let Self { mission, team, .. } = self;
        team.act(world, |world, robot, parts, rest| {
            let [x, y, _] = world.pose(parts.body).position;
            mission.sense(world, robot, [x, y], rest)
        });
    }

    /// Judges the step that has passed; `Some` ends the trial with what the first population earned.
    fn judge(&mut self, world: &mut W) -> Option<f64> {
        let Self { mission, team, places, .. } = self;
        self.steps += 1;
        for (robot, place) in places.iter_mut().enumerate() {
            *place = team.place(world, robot);
            self.failed |= !place.iter().all(|x| x.is_finite());
        }
        let over = mission.judge(world, Moment { places, steps: self.steps });
        (self.failed || over || self.steps >= self.most_steps).then(|| self.fitness())
    }
}
