//! The task of a team: the description of a scenario, and its episodes over parameters.

use farsa_body::Recorder;
use farsa_body::ports::BodyId;
use farsa_body::robot::Robot;
use farsa_evo::ObservationStatistics;
use farsa_nn::{Leak, LeakyLayout};
use farsa_physics::arena::{Arena, World};

use crate::team::config::{EYES, TeamConfig};
use crate::team::episode::{Scenario, TeamEpisode};
use crate::team::eyes::eye_angles;
use crate::team::robots::OUTPUTS;
use crate::wheeled::infrared_exports;
use farsa_lab::advanced::{
    Anatomy, Behavior, ChannelGroup, Description, Interventions, NormalizedController, OwnedNetwork, PlanarWorld,
    Rollout, mean_of_trials, network_parameters, resting_network, seconds,
};
use farsa_lab::exports::{ControllerExport, Exports, MotorExport, NetworkExport, SensorExport};
use farsa_lab::{Episode, EpisodeId, Error, Evaluation, InWorld, Outcome, Parameter, Task, TaskInfo};
use farsa_view::Schema;

/// A team in a scenario, whose networks have the parameters that are evaluated.
#[derive(Clone)]
pub(crate) struct TeamTask<M> {
    episode: TeamEpisode<M, NormalizedController<OwnedNetwork>>,
    layout: LeakyLayout,
    /// The population whose outcome is asked for.
    own: usize,
    /// The robot that is recorded.
    watched: usize,
    /// Bodies whose poses are recorded: robots and the objects that trials place.
    bodies: u16,
    interventions: Interventions,
}

/// An arena without bounds, so that robots and areas can wait outside until a trial places them.
fn parked(arena: Arena) -> Arena {
    Arena { size: None, ..arena }
}

/// A world of an arena whose robots and areas every trial places.
pub(crate) fn world(arena: Arena) -> Result<World, Error> {
    World::new(&parked(arena)).map_err(|error| Error::Other(error.to_string()))
}

/// Evaluates a scenario.
///
/// # Errors
/// [`Error::Setting`] for an arena without room for all, [`Error::Other`] for values that make no world or team.
pub(crate) fn evaluator<M: Scenario + Clone + 'static>(scenario: M) -> Result<InWorld<World, TeamTask<M>>, Error> {
    let (config, [inputs, outputs], arena) = (scenario.robots(), scenario.shape(), scenario.arena());
    let layout = config.layout(inputs, outputs);
    // An error if the range is empty.
    network_parameters(&layout, config.weight_range, [0.0, 1.0], "net.weight_range")?;
    let networks = (0..config.robots).map(|_| resting_network(&layout).map(NormalizedController::new));
    let networks = networks.collect::<Result<_, _>>()?;
    let bodies = (arena.robots.len() + arena.areas.len()) as u16;
    let mut world = world(arena.clone())?;
    let interventions = scenario.interventions();
    let mut episode = TeamEpisode::from_scenario(scenario, networks)?;
    // Seeds of this kind are neither a run's nor a test's.
    for trial in 0..8 {
        let id = EpisodeId { seed: u64::MAX, trial, ..EpisodeId::default() };
        episode.arrange(&mut world, id).map_err(|error| Error::setting(episode.scenario().crowded(), error))?;
    }
    InWorld::in_arena(&parked(arena), TeamTask { episode, layout, own: 0, watched: 0, bodies, interventions })
}

impl<M: Scenario> TeamTask<M> {
    /// The observations of the robots, one after the other, where observations are normalized.
    fn observed(&self) -> Option<ObservationStatistics> {
        let mut robots = self.episode.team().controllers().iter().map(NormalizedController::observed);
        let first = robots.next()??.clone();
        robots.flatten().try_fold(first, |mut all, own| all.merge(own).ok().map(|()| all))
    }
}

impl<M: Scenario, W: PlanarWorld> Episode<W> for TeamTask<M> {
    fn start(&mut self, world: &mut W, id: EpisodeId) {
        self.episode.start(world, id);
    }

    fn has_started(&self) -> bool {
        !self.episode.failed()
    }

    fn act(&mut self, world: &mut W) {
        self.episode.act(world);
    }

    fn judge(&mut self, world: &mut W) -> Option<f64> {
        self.episode.judge(world)
    }

    fn record_action(&self, world: &W, recorder: &mut dyn Recorder) {
        self.episode.team().record_rays(world, self.watched, recorder);
    }

    /// Records what the watched robot sensed, computed and did before the step, and what that led to.
    fn record(&self, world: &W, recorder: &mut dyn Recorder) {
        let Self { episode, watched, bodies, .. } = self;
        let team = episode.team();
        recorder.sensors(team.sensed(*watched));
        recorder.neurons(team.controllers()[*watched].controller().hidden());
        recorder.outputs(team.done(*watched));
        (0..*bodies).map(BodyId).for_each(|body| recorder.pose(body, world.pose(body)));
        recorder.scalars(&episode.scenario().scalars(episode.moment()));
        episode.scenario().record(recorder);
        recorder.tick(seconds(episode.steps(), episode.scenario().robots().time_step));
    }
}

impl<M: Scenario> Rollout for TeamTask<M> {
    /// Gives all robots their networks, of several populations robot p that of population p. Without opponents each robot plays
    /// against copies of its network.
    fn load(&mut self, evaluation: &Evaluation<'_>) -> bool {
        let Evaluation { parameters, opponents, normalisation, id, case, .. } = *evaluation;
        let change = self.interventions.applied(evaluation).into_owned();
        let Self { episode, interventions, .. } = self;
        episode.scenario_mut().begin_case(interventions.named(case));
        let scenario = self.episode.scenario();
        let count = scenario.population_names().len();
        let trained = id.population(scenario.population_size()).min(count - 1);
        self.own = trained;
        let last = scenario.robots().robots.saturating_sub(1);
        self.watched = evaluation.watched.map_or(trained, |robot| (robot as usize).min(last));
        let networks = self.episode.team_mut().controllers_mut();
        if !networks.iter_mut().all(|network| network.load(normalisation)) {
            return false;
        }
        for (robot, network) in networks.iter_mut().enumerate() {
            network.intervene(&change, id, robot as u32);
        }
        let mut networks = networks.iter_mut().map(NormalizedController::controller_mut);
        if count == 1 {
            let parameters = change.edited(parameters);
            return networks.all(|network| network.copy_parameters(&parameters).is_ok());
        }
        let mut others = opponents.iter();
        (0..count).zip(networks).all(|(population, network)| {
            let parameters =
                if population == trained { parameters } else { others.next().copied().unwrap_or(parameters) };
            network.copy_parameters(&change.edited(parameters)).is_ok()
        })
    }

    fn record_parameters(&self, recorder: &mut dyn Recorder) {
        recorder.parameters(self.episode.team().controllers()[self.watched].controller().parameters());
    }

    fn outcome(&self) -> Outcome {
        Outcome { observed: self.observed(), ..self.episode.outcome(self.own) }
    }
}

impl<M: Scenario> TeamTask<M> {
    fn parameters(&self) -> Vec<Parameter> {
        let range = self.episode.scenario().robots().weight_range;
        network_parameters(&self.layout, range, [0.0, 1.0], "net.weight_range").unwrap_or_default()
    }

    /// Sensors, neurons and outputs are those of the watched robot: by default the first, or the individual's where there are
    /// several populations.
    fn schema(&self) -> Schema {
        let scenario = self.episode.scenario();
        let [_, outputs] = scenario.shape();
        let schema = Schema::from_arena(&scenario.arena()).with_sensors(scenario.input_names());
        let mut schema = schema.with_outputs(MOTORS.into_iter().take(outputs)).with_network(&self.layout);
        schema.outputs.iter_mut().chain(&mut schema.sensors).for_each(|channel| channel.range = Some([0.0, 1.0]));
        scenario.shown_in(Schema { scalars: scenario.channels(), ..schema })
    }

    fn description(&self) -> Description {
        let (scenario, layout) = (self.episode.scenario(), &self.layout);
        let (config, [inputs, outputs]) = (scenario.robots(), scenario.shape());
        let whose = if self.populations().len() == 1 { ", the same in all robots" } else { "" };
        Description {
            sensors: scenario.inputs(),
            motors: motor_groups().into_iter().take(outputs / 2).collect(),
            network: format!("{inputs}-{}-{outputs}, recurrent hidden layer{whose}", layout.hidden()),
            parameters: layout.parameter_count(),
            steps: config.steps as usize,
            step_seconds: config.time_step,
        }
    }

    fn populations(&self) -> Vec<String> {
        self.episode.scenario().population_names().iter().map(|&name| name.into()).collect()
    }
}

impl<M: Scenario> Task for TeamTask<M> {
    fn info(&self) -> TaskInfo {
        TaskInfo {
            description: self.description(),
            trials: self.episode.scenario().robots().trials,
            terms: self.episode.scenario().terms(),
            populations: self.populations(),
            robots: self.schema().bodies.into_iter().take(self.episode.scenario().robots().robots).collect(),
            observations: self.layout.sensors(),
            protocols: self.interventions.protocols(),
            anatomy: Some(Anatomy::new(&self.schema(), &self.description())),
            ..TaskInfo::new(self.parameters(), self.schema())
        }
    }

    fn behavior(&self) -> Option<&dyn Behavior> {
        self.episode.scenario().behavior()
    }

    /// The mean over the trials.
    fn fitness(&self, trials: &[Outcome]) -> f64 {
        mean_of_trials(trials)
    }

    fn exports(&self) -> Option<&dyn Exports> {
        Some(self)
    }
}

impl<M: Scenario> Exports for TeamTask<M> {
    fn robot(&self, _: Option<&[f32]>) -> Option<Robot> {
        Some(self.episode.scenario().robots().robot().description())
    }

    fn controller(&self, parameters: &[f32]) -> Option<ControllerExport> {
        let scenario = self.episode.scenario();
        let (config, [_, outputs]) = (scenario.robots(), scenario.shape());
        if parameters.len() != self.layout.parameter_count() {
            return None;
        }
        let mut names = scenario.input_names().into_iter();
        let eyes: Vec<String> = names.by_ref().take(EYES).collect();
        let robot = config.robot();
        let angles = eye_angles(&robot);
        let eyes = infrared_exports(eyes, &angles, &robot);
        // The other inputs are described in groups.
        let groups = scenario.inputs();
        let meanings = groups.iter().flat_map(|group| std::iter::repeat_n(&group.meaning, group.count)).skip(EYES);
        let others = names.zip(meanings).map(|(name, meaning)| SensorExport::quantity(name, meaning, "1", [0.0, 1.0]));
        let sensors = eyes.chain(others).collect();
        let largest = robot.max_wheel_speed;
        let light =
            |color: &str| MotorExport::quantity(color, format!("brightness of the {color} LED"), "1", [0.0, 1.0]);
        let motors = [
            MotorExport::quantity(MOTORS[0], "mean speed of both wheels", "rad/s", [0.0, largest]),
            MotorExport::quantity(
                MOTORS[1],
                "half of how much faster the right wheel is than the left; where a wheel would be too fast, both slow down",
                "rad/s",
                [-largest, largest],
            ),
            light(MOTORS[2]),
            light(MOTORS[3]),
        ];
        let network = NetworkExport::leaky(&self.layout, Leak::Filter, parameters);
        let motors = motors.into_iter().take(outputs).collect();
        Some(ControllerExport::new(network, sensors, motors, config.time_step, config.steps))
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
