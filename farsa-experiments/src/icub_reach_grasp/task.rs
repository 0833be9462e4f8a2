//! The task of `icub-reach-grasp`. It runs and records episodes of evolved networks.

use std::sync::Arc;

use farsa_body::Recorder;
use farsa_body::ports::{Actuated, ActuatorId, Arrange, Handles, Vision};
use farsa_body::robot::Robot;
use farsa_body::sensors::Camera;
use farsa_lab::advanced::{
    Anatomy, Behavior, ChannelGroup, Description, NotedBehavior, Rollout, mean_of_trials, network_parameters,
};
use farsa_lab::exports::{ControllerExport, Exports, MotorExport, NetworkExport, SensorExport};
use farsa_lab::{Combination, Episode, EpisodeId, Error, Evaluation, Note, Outcome, Parameter, Task, TaskInfo};
use farsa_nn::Leak;
use farsa_view::Schema;

use crate::icub_reach_grasp::agent::Agent;
use crate::icub_reach_grasp::config::{Config, SENSORS};
use crate::icub_reach_grasp::episode::{GraspEpisode, GraspingWorld};
use crate::icub_reach_grasp::motors::{CONTROLLED, Motors};
use crate::icub_reach_grasp::protocols::Protocols;
use crate::icub_reach_grasp::scene::Scene;
use crate::icub_reach_grasp::schema;
use crate::icub_reach_grasp::senses::Senses;

/// Runs the trials of a network and defines the channels recorded.
#[derive(Clone)]
pub struct GraspTask {
    episode: GraspEpisode<Agent>,
    protocols: Arc<Protocols>,
    parameters: Arc<[Parameter]>,
    /// Left eye, whose image is recorded.
    eye: Arc<Camera>,
}

impl GraspTask {
    /// Creates the task for a scene.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if the network, the eye or the servos are invalid.
    pub fn new(scene: Scene) -> Result<Self, Error> {
        let (config, agent) = (scene.config, Agent::new(&scene.config)?);
        let range = config.weight_range;
        let parameters = network_parameters(&config.layout(), range, [0.0, 1.0], "net.weight_range")?;
        let eye = Arc::new(Senses::camera(&scene, schema::IMAGE)?);
        let episode = GraspEpisode::new(Arc::new(scene), agent)?;
        Ok(Self { episode, protocols: Arc::new(Protocols::new(&config)), parameters: parameters.into(), eye })
    }

    fn config(&self) -> &Config {
        &self.episode.scene().config
    }

    /// Gets the current episode.
    pub fn episode(&self) -> &GraspEpisode<Agent> {
        &self.episode
    }
}

impl<W> Episode<W> for GraspTask
where
    W: GraspingWorld + Vision + Actuated + Arrange + Handles<Actuator = ActuatorId> + ?Sized,
{
    fn start(&mut self, world: &mut W, id: EpisodeId) {
        self.episode.start(world, id);
    }

    fn act(&mut self, world: &mut W) {
        self.episode.act(world);
    }

    fn judge(&mut self, world: &mut W) -> Option<f64> {
        self.episode.judge(world)
    }

    fn record(&self, world: &W, recorder: &mut dyn Recorder) {
        schema::record(world, &self.episode, &self.eye, recorder);
    }
}

impl Rollout for GraspTask {
    fn load(&mut self, evaluation: &Evaluation<'_>) -> bool {
        self.episode.ask(self.protocols.asked(evaluation.case));
        let network = self.episode.grasper_mut().network_mut();
        if !network.load(evaluation.normalisation) {
            return false;
        }
        let change = self.protocols.applied(evaluation);
        network.intervene(&change, evaluation.id, 0);
        network.controller_mut().copy_parameters(&change.edited(evaluation.parameters)).is_ok()
    }

    fn record_parameters(&self, recorder: &mut dyn Recorder) {
        recorder.parameters(self.episode.grasper().network().controller().parameters());
    }

    fn outcome(&self) -> Outcome {
        let (score, seen) = (self.episode.score(), self.episode.seen());
        Outcome {
            terms: self.episode.terms().to_vec(),
            steps: score.steps,
            success: self.episode.succeeds(),
            notes: vec![
                ("end", Note::from(if score.fallen { "ball fell" } else { "time" })),
                ("distance [cm]", Note::from(100.0 * seen.distance)),
                ("height [cm]", Note::from(100.0 * seen.height)),
                ("highest [cm]", Note::from(100.0 * score.highest)),
                ("held [s]", Note::from(f64::from(score.held) * self.config().time_step)),
            ],
            observed: self.episode.grasper().network().observed().cloned(),
            ..Outcome::default()
        }
    }
}

/// Objectives and measures of an individual, for strategies that use more than its fitness.
static BEHAVIOUR: NotedBehavior = NotedBehavior {
    objectives: &[("highest [cm]", 1.0), ("distance [cm]", -1.0)],
    measures: &[("highest [cm]", [0.0, 40.0]), ("distance [cm]", [0.0, 40.0])],
};

impl GraspTask {
    fn schema(&self) -> Schema {
        schema::schema(self.episode.scene())
    }

    fn description(&self) -> Description {
        let Config { steps, time_step, .. } = *self.config();
        let layout = self.config().layout();
        let offset = "ball from hand in the left eye's image, leftwards and upwards, in its widths, -1..1";
        Description {
            sensors: vec![
                ChannelGroup::new("eye", 2, offset),
                ChannelGroup::new("neck", 2, "pitch and yaw, 0 at the lower and 1 at the upper limit"),
                ChannelGroup::new("trunk", 2, "pitch and yaw, 0 at the lower and 1 at the upper limit"),
                ChannelGroup::new("fingertips", 5, "touch of ball or table, thumb to little finger, 0 or 1"),
                ChannelGroup::new(
                    "palm",
                    4,
                    "touch of the ball by index finger, little finger, thumb and heel, 0 or 1",
                ),
            ],
            motors: vec![
                ChannelGroup::new("angles", CONTROLLED.len(), "desired angles, from the lower to the upper limit"),
                ChannelGroup::new("hand", 1, "all joints but abduction, 0 open, 1 closed"),
            ],
            network: format!(
                "{}-{}-{}, recurrent hidden layer, leaky",
                layout.sensors(),
                layout.hidden(),
                layout.outputs()
            ),
            parameters: layout.parameter_count(),
            steps: steps as usize,
            step_seconds: time_step,
        }
    }
}

impl Task for GraspTask {
    fn info(&self) -> TaskInfo {
        TaskInfo {
            combination: Some(Combination::Mean),
            description: self.description(),
            trials: self.config().trials as usize,
            terms: ["nearness", "touch", "lift"].map(String::from).to_vec(),
            observations: SENSORS,
            protocols: self.protocols.list(),
            anatomy: Some(Anatomy::new(&self.schema(), &self.description())),
            ..TaskInfo::new(self.parameters.to_vec(), self.schema())
        }
    }

    fn behavior(&self) -> Option<&dyn Behavior> {
        Some(&BEHAVIOUR)
    }

    /// The mean over the trials of the sum of the three terms: 3 at most.
    fn fitness(&self, trials: &[Outcome]) -> f64 {
        mean_of_trials(trials)
    }

    fn exports(&self) -> Option<&dyn Exports> {
        Some(self)
    }
}

impl Exports for GraspTask {
    fn robot(&self, _: Option<&[f32]>) -> Option<Robot> {
        Some(self.episode.scene().robot.clone())
    }

    fn controller(&self, parameters: &[f32]) -> Option<ControllerExport> {
        let (config, scene) = (self.config(), self.episode.scene());
        let layout = config.layout();
        if parameters.len() != layout.parameter_count() {
            return None;
        }
        let network = NetworkExport::leaky(&layout, Leak::Filter, parameters);
        let sensors = Senses::names().into_iter().enumerate().map(|(i, name)| match i {
            0 | 1 => SensorExport::quantity(name, "ball from hand in the image, in its widths", "1", [0.0, 1.0]),
            2..6 => {
                let range = scene.range(&name.replace(' ', "_")).unwrap_or_default();
                SensorExport::quantity(name, "angle of the joint", "rad", range)
            }
            _ => SensorExport::quantity(name, "touch", "1", [0.0, 1.0]),
        });
        let motors = Motors::names().into_iter().map(|name| match scene.range(name) {
            Ok(range) => MotorExport::quantity(name, "desired angle of the joint", "rad", range),
            Err(_) => MotorExport::quantity(name, "closing of the hand", "1", [0.0, 1.0]),
        });
        Some(ControllerExport::new(network, sensors.collect(), motors.collect(), config.time_step, config.steps))
    }
}
