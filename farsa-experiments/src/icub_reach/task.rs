//! The task of `icub-reach`. It runs and records episodes of evolved networks.

use std::sync::Arc;

use farsa_body::Recorder;
use farsa_body::ports::{Actuated, ActuatorId, Arrange, Contacts, Handles};
use farsa_body::robot::Robot;
use farsa_lab::advanced::{Anatomy, ChannelGroup, Description, Rollout, mean_of_trials};
use farsa_lab::exports::{ControllerExport, Exports, MotorExport, NetworkExport, SensorExport};
use farsa_lab::{Combination, Episode, EpisodeId, Error, Evaluation, Note, Outcome, Task, TaskInfo};
use farsa_nn::Leak;
use farsa_nn::block::BlockLayoutBuf;
use farsa_view::Schema;

use crate::icub_reach::config::{Condition, Config, INPUTS, MOTORS};
use crate::icub_reach::episode::{ReachEpisode, ReachingWorld};
use crate::icub_reach::network::{Agent, HIDDEN, HIDDEN_ONES, LAYOUT, parameters};
use crate::icub_reach::protocols::Protocols;
use crate::icub_reach::scene::{CONTROLLED, Scene};
use crate::icub_reach::schema;

/// Runs the trials of a network and defines the channels recorded.
#[derive(Clone)]
pub struct ReachTask {
    episode: ReachEpisode<Agent>,
    protocols: Arc<Protocols>,
}

impl ReachTask {
    /// Creates the task for a scene.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if the network cannot be built.
    pub fn new(scene: Scene) -> Result<Self, Error> {
        let protocols = Arc::new(Protocols::new(&scene.config));
        let episode = ReachEpisode::new(Arc::new(scene), Agent::new()?);
        Ok(Self { episode, protocols })
    }

    fn config(&self) -> &Config {
        &self.episode.scene().config
    }

    /// Gets the current episode.
    pub fn episode(&self) -> &ReachEpisode<Agent> {
        &self.episode
    }
}

impl<W> Episode<W> for ReachTask
where
    W: ReachingWorld + Actuated + Contacts + Arrange + Handles<Actuator = ActuatorId> + ?Sized,
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
        schema::record(world, &self.episode, recorder);
    }
}

impl Rollout for ReachTask {
    fn load(&mut self, evaluation: &Evaluation<'_>) -> bool {
        self.episode.ask(self.protocols.asked(evaluation.case));
        let network = self.episode.reacher_mut().network_mut();
        if !network.load(evaluation.normalisation) {
            return false;
        }
        let change = self.protocols.applied(evaluation);
        network.intervene(&change, evaluation.id, 0);
        network.controller_mut().copy_parameters(&change.edited(evaluation.parameters)).is_ok()
    }

    fn record_parameters(&self, recorder: &mut dyn Recorder) {
        recorder.parameters(self.episode.reacher().network().controller().parameters());
    }

    fn outcome(&self) -> Outcome {
        let totals = self.episode.totals();
        let [x, y, z] = self.episode.target();
        Outcome {
            terms: vec![self.episode.fitness()],
            steps: self.episode.steps(),
            success: totals.mean() < self.config().success,
            notes: vec![
                ("distance [cm]", Note::from(100.0 * totals.mean())),
                ("start distance [cm]", Note::from(100.0 * totals.start())),
                ("target x [m]", Note::from(x)),
                ("target y [m]", Note::from(y)),
                ("target z [m]", Note::from(z)),
            ],
            observed: self.episode.reacher().network().observed().cloned(),
            ..Outcome::default()
        }
    }
}

impl ReachTask {
    fn schema(&self) -> Schema {
        schema::schema(self.episode.scene())
    }

    fn description(&self) -> Description {
        let Config { condition, speed, offset, steps, time_step, .. } = *self.config();
        let (sensors, motors) = match condition {
            Condition::Steady => (
                ChannelGroup::new("target", INPUTS, "x, y, z from the least to the greatest of the volume, 0..1"),
                ChannelGroup::new("angles", MOTORS, "desired angles, from the lower to the upper limit"),
            ),
            Condition::Velocity => (
                ChannelGroup::new(
                    "way",
                    INPUTS,
                    &format!("from hand to target, x, y, z: -1 at -{offset} m, 1 at {offset} m"),
                ),
                ChannelGroup::new(
                    "speeds",
                    MOTORS,
                    &format!("desired speeds, 0 at -{speed} rad/s, 1 at {speed} rad/s"),
                ),
            ),
        };
        Description {
            sensors: vec![sensors],
            motors: vec![motors],
            network: format!("feed-forward, {INPUTS} sensory, {HIDDEN} hidden, {MOTORS} motor neurons"),
            parameters: LAYOUT.parameter_count(),
            steps: steps as usize,
            step_seconds: time_step,
        }
    }

    fn anatomy(&self) -> Anatomy {
        let anatomy = Anatomy::new(&self.schema(), &self.description());
        anatomy.with_first(HIDDEN_ONES.first, HIDDEN_ONES.end())
    }
}

impl Task for ReachTask {
    fn info(&self) -> TaskInfo {
        TaskInfo {
            combination: Some(Combination::Mean),
            description: self.description(),
            trials: self.config().targets as usize,
            terms: vec!["fitness".into()],
            observations: INPUTS,
            protocols: self.protocols.list(),
            anatomy: Some(self.anatomy()),
            ..TaskInfo::new(parameters(self.config().weight_range), self.schema())
        }
    }

    /// The mean over the targets.
    fn fitness(&self, trials: &[Outcome]) -> f64 {
        mean_of_trials(trials)
    }

    fn exports(&self) -> Option<&dyn Exports> {
        Some(self)
    }
}

impl Exports for ReachTask {
    fn robot(&self, _: Option<&[f32]>) -> Option<Robot> {
        Some(self.episode.scene().bare_robot())
    }

    fn controller(&self, parameters: &[f32]) -> Option<ControllerExport> {
        if parameters.len() != LAYOUT.parameter_count() {
            return None;
        }
        let Config { condition, volume, speed, offset, steps, time_step, .. } = *self.config();
        let layout = BlockLayoutBuf::from(LAYOUT);
        let network = NetworkExport::Blocks { layout, leak: Leak::Filter, parameters: parameters.into() };
        let sensors = schema::sensors(self.config()).into_iter().enumerate().map(|(axis, name)| match condition {
            Condition::Steady => {
                SensorExport::quantity(name, "the target's place relative to the body's center", "m", volume.ends(axis))
            }
            Condition::Velocity => SensorExport::quantity(name, "way from hand to target", "m", [0.0, offset]),
        });
        let motors = CONTROLLED.into_iter().zip(self.episode.scene().ranges());
        let motors = motors.map(|(name, range)| match condition {
            Condition::Steady => MotorExport::quantity(name, "desired angle of the joint", "rad", range),
            Condition::Velocity => MotorExport::quantity(name, "desired speed of the joint", "rad/s", [-speed, speed]),
        });
        Some(ControllerExport::new(network, sensors.collect(), motors.collect(), time_step, steps))
    }
}
