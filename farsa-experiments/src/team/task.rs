//! What there is to know of a team's mission, and its episodes over parameters.

use farsa_body::{BodyId, Recorder};
use farsa_nn::LeakyLayout;
use farsa_physics::arena::{Arena, World};

use crate::team::config::{EYES, TeamConfig};
use crate::team::life::{Mission, TeamLife};
use crate::team::robots::OUTPUTS;
use farsa_lab::{
    ChannelGroup, Description, Episode, EpisodeId, Error, Evaluation, InWorld, Outcome, OwnedNetwork, Parameter,
    PlanarWorld, Rollout, Task, mean_of_trials, network_parameters, resting_network, seconds,
};
use farsa_view::Stage;

/// A team on a mission, whose networks have the parameters that are evaluated.
#[derive(Clone)]
pub(crate) struct TeamTask<M> {
    life: TeamLife<M, OwnedNetwork>,
    layout: LeakyLayout,
    /// The population whose outcome is asked for.
    own: usize,
    /// Bodies whose poses are recorded: robots and what is placed beside them.
    bodies: u16,
}

/// An arena whose robots and areas every trial places anew, without bounds for what waits outside.
fn parked(arena: Arena) -> Arena {
    Arena { size: None, ..arena }
}

/// A world of an arena whose robots and areas every trial places anew.
pub(crate) fn world(arena: Arena) -> Result<World, Error> {
    World::new(&parked(arena)).map_err(|error| Error::Other(error.to_string()))
}

/// Evaluates a mission.
///
/// # Errors
/// [`Error::Setting`] for an arena without room for all, [`Error::Other`] for values that make no world or team.
pub(crate) fn evaluator<M: Mission + Clone + 'static>(mission: M) -> Result<InWorld<World, TeamTask<M>>, Error> {
    let (config, [inputs, outputs], arena) = (mission.robots(), mission.shape(), mission.arena());
    let layout = config.layout(inputs, outputs);
    // Whether the range is one.
    network_parameters(&layout, config.weight_range, [0.0, 1.0], "net.weight_range")?;
    let networks = (0..config.robots).map(|_| resting_network(&layout)).collect::<Result<_, _>>()?;
    let bodies = (arena.robots.len() + arena.areas.len()) as u16;
    let mut world = world(arena.clone())?;
    let mut life = TeamLife::on(mission, networks)?;
    // Seeds of this kind are neither a run's nor a test's.
    for trial in 0..8 {
        let id = EpisodeId { seed: u64::MAX, trial, ..EpisodeId::default() };
        life.arrange(&mut world, id).map_err(|error| Error::setting(life.mission().crowded(), error))?;
    }
    InWorld::in_arena(&parked(arena), TeamTask { life, layout, own: 0, bodies })
}

impl<M: Mission, W: PlanarWorld> Episode<W> for TeamTask<M> {
    fn start(&mut self, world: &mut W, id: EpisodeId) {
        self.life.start(world, id);
    }

    fn has_started(&self) -> bool {
        !self.life.failed()
    }

    fn act(&mut self, world: &mut W) {
        self.life.act(world);
    }

    fn judge(&mut self, world: &mut W) -> Option<f64> {
        self.life.judge(world)
    }

    fn record_action(&self, world: &W, recorder: &mut dyn Recorder) {
        self.life.team().tell_rays(world, self.own, recorder);
    }

    /// Records what the robot of the own population sensed, computed and did before the step, and what that led to.
    fn record(&self, world: &W, recorder: &mut dyn Recorder) {
        let Self { life, own, bodies, .. } = self;
        let team = life.team();
        recorder.sensors(team.sensed(*own));
        recorder.neurons(team.controllers()[*own].hidden());
        recorder.outputs(team.done(*own));
        (0..*bodies).map(BodyId).for_each(|body| recorder.pose(body, world.pose(body)));
        recorder.scalars(&life.mission().scalars(life.moment()));
        recorder.tick(seconds(life.steps(), life.mission().robots().time_step));
    }
}

impl<M: Mission> Rollout for TeamTask<M> {
    /// Gives all robots their networks; of several populations robot p that of population p. Without opponents everybody
    /// meets its like.
    fn load(&mut self, evaluation: &Evaluation<'_>) -> bool {
        let Evaluation { parameters, opponents, id, .. } = *evaluation;
        let mission = self.life.mission();
        let count = mission.population_names().len();
        let own = id.population(mission.population_size()).min(count - 1);
        self.own = own;
        let networks = self.life.team_mut().controllers_mut();
        if count == 1 {
            return networks.iter_mut().all(|network| network.copy_parameters(parameters).is_ok());
        }
        let mut others = opponents.iter();
        (0..count).zip(networks).all(|(population, network)| {
            let own = population == own;
            let parameters = if own { parameters } else { others.next().copied().unwrap_or(parameters) };
            network.copy_parameters(parameters).is_ok()
        })
    }

    fn record_parameters(&self, recorder: &mut dyn Recorder) {
        recorder.parameters(self.life.team().controllers()[self.own].parameters());
    }

    fn outcome(&self) -> Outcome {
        self.life.outcome(self.own)
    }
}

impl<M: Mission> Task for TeamTask<M> {
    fn parameters(&self) -> Vec<Parameter> {
        let range = self.life.mission().robots().weight_range;
        network_parameters(&self.layout, range, [0.0, 1.0], "net.weight_range").unwrap_or_default()
    }

    fn populations(&self) -> Vec<String> {
        self.life.mission().population_names().iter().map(|&name| name.into()).collect()
    }

    fn trials(&self) -> usize {
        self.life.mission().robots().trials
    }

    fn terms(&self) -> Vec<String> {
        self.life.mission().terms()
    }

    /// Sensors, neurons and outputs are those of the first robot, or of the individual's where populations meet.
    fn stage(&self) -> Stage {
        let mission = self.life.mission();
        let [_, outputs] = mission.shape();
        let stage = Stage::of_arena(&mission.arena()).with_sensors(mission.input_names());
        let mut stage = stage.with_outputs(MOTORS.into_iter().take(outputs)).with_network(&self.layout);
        stage.outputs.iter_mut().chain(&mut stage.sensors).for_each(|channel| channel.range = Some([0.0, 1.0]));
        Stage { scalars: mission.channels(), ..stage }
    }

    fn description(&self) -> Description {
        let (mission, layout) = (self.life.mission(), &self.layout);
        let (config, [inputs, outputs]) = (mission.robots(), mission.shape());
        let whose = if self.populations().len() == 1 { ", the same in all robots" } else { "" };
        Description {
            sensors: mission.inputs(),
            motors: motor_groups().into_iter().take(outputs / 2).collect(),
            network: format!("{inputs}-{}-{outputs}, recurrent hidden layer{whose}", layout.hidden()),
            parameters: layout.parameter_count(),
            steps: config.steps as usize,
            step_seconds: config.time_step,
        }
    }

    /// The mean over the trials.
    fn fitness(&self, trials: &[Outcome]) -> f64 {
        mean_of_trials(trials)
    }
}

const MOTORS: [&str; OUTPUTS] = ["speed", "turn", "red", "blue"];

/// The motors of a team's robot, two channels in each group.
fn motor_groups() -> Vec<ChannelGroup> {
    vec![
        ChannelGroup::new("wheels", 2, "speed, 0 at rest .. 1 ahead; turn, 0 right .. 1/2 straight on .. 1 left"),
        ChannelGroup::new("LEDs", 2, "red and blue, 0 dark .. 1; without effect on a robot that has none"),
    ]
}

/// The names of what the eyes of a robot read.
pub(crate) fn eye_names(sectors: usize, colors: &[&str]) -> Vec<String> {
    let sectors = (1..=sectors).flat_map(|sector| colors.iter().map(move |color| format!("camera {sector} {color}")));
    (1..=EYES).map(|eye| format!("infrared {eye}")).chain(sectors).collect()
}

/// The sensors of infrared and camera.
pub(crate) fn eye_groups(config: &TeamConfig, colors: &str, count: usize) -> Vec<ChannelGroup> {
    let sectors = config.sectors;
    vec![
        ChannelGroup::new(
            "infrared",
            EYES,
            "eight directions in the robot's order, 0 nothing .. 1 at the hull, by rays",
        ),
        ChannelGroup::new(
            "camera",
            sectors * count,
            &format!("{sectors} sectors from left to right, in each the share of it that is {colors}, 0..1"),
        ),
    ]
}
