//! An episode of one robot with a network and a custom objective.

use farsa_body::Recorder;
use farsa_body::ports::{
    Actuated, ActuatorId, Arrange, BodyId, Channels, Contacts, Handles, JointId, Joints, Kinematics, Motor, Planar,
    Rays, Sensor,
};
use farsa_body::robot::Robot;
use farsa_nn::Leak;
use farsa_physics::arena::{Arena, Batch, World};

use crate::error::Error;
use crate::experiment::controller_export::{ControllerExport, MotorDrive, MotorExport, SensorExport, SensorReading};
use crate::experiment::episode::{Episode, EpisodeId, seconds};
use crate::experiment::evaluator::{Evaluation, Exports, Task, TaskInfo};
use crate::experiment::in_world::InWorld;
use crate::experiment::lanes::Lanes;
use crate::experiment::network_export::NetworkExport;
use crate::experiment::neurocontroller::Neurocontroller;
use crate::experiment::outcome::{Combination, Note, Outcome};
use crate::experiment::rollout::Rollout;

/// A world with wheeled robots. This can be a single arena, a lane of a batch, or an arena in rapier.
pub trait PlanarWorld:
    Planar
    + Rays
    + Kinematics
    + Joints
    + Actuated
    + Contacts
    + Arrange
    + Handles<Body = BodyId, Joint = JointId, Actuator = ActuatorId>
{
}

impl<W> PlanarWorld for W where
    W: Planar
        + Rays
        + Kinematics
        + Joints
        + Actuated
        + Contacts
        + Arrange
        + Handles<Body = BodyId, Joint = JointId, Actuator = ActuatorId>
{
}

/// Task of a robot in a planar world. It defines how trials start, and the reward of each step.
pub trait Objective: Clone + Send + 'static {
    /// Sets the world up for an episode with its own random numbers, and discards the previous state.
    fn start<W: PlanarWorld>(&mut self, world: &mut W, id: EpisodeId);

    /// Computes the reward of the last step. NaN for a trial that failed.
    fn reward<W: PlanarWorld>(&mut self, world: &W) -> f64;

    /// Checks whether the trial ends early.
    fn is_over(&self) -> bool {
        false
    }

    /// Checks whether the trial succeeded, at its end. `None`, the default, is a task without a criterion of success.
    /// It must be `Some` from the start, or always `None`.
    fn success(&self) -> Option<bool> {
        None
    }

    /// Returns further columns by name, after every step. A replay shows each step, a test the end of each trial. The
    /// names are always the same.
    fn values(&self) -> Vec<(&'static str, f64)> {
        Vec::new()
    }
}

/// Number of trials of an evaluation, and their length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trials {
    /// Number of trials of an evaluation.
    pub count: usize,
    /// Maximum number of steps in a trial.
    pub steps: u32,
    /// Time between two steps \[s\].
    pub time_step: f64,
}

/// A robot with a [`Neurocontroller`] and an [`Objective`]. To get a complete experiment, you only need to add its
/// name and settings.
///
/// Fitness is the sum of the rewards of all trials. Everything that the controller does is recorded, and the network
/// can be exported. If you use [`InWorld::in_arena`], it also runs in lanes.
#[derive(Clone, Debug)]
pub struct Controlled<S, M, O> {
    control: Neurocontroller<S, M>,
    objective: O,
    trials: Trials,
    steps: u32,
    sum: f64,
    robot: Option<Robot>,
}

impl<S: Channels, M: Channels, O: Objective> Controlled<S, M, O> {
    /// Creates episodes of this controller with this objective. Evolution then changes the parameters of the
    /// controller.
    pub fn new(control: Neurocontroller<S, M>, objective: O, trials: Trials) -> Self {
        let names: Vec<&str> = objective.values().into_iter().map(|(name, _)| name).collect();
        let schema = control.schema().clone().with_scalars(names);
        Self { control: control.with_schema(schema), objective, trials, steps: 0, sum: 0.0, robot: None }
    }

    /// Sets the robot for `farsa export robot`. For mobile robots of this project, use [`MobileRobot::description`].
    ///
    /// [`MobileRobot::description`]: farsa_body::robots::MobileRobot::description
    #[must_use]
    pub fn with_robot(self, robot: Robot) -> Self {
        Self { robot: Some(robot), ..self }
    }
}

impl<W, S, M, O> Episode<W> for Controlled<S, M, O>
where
    W: PlanarWorld,
    S: Sensor<W>,
    M: Motor<W>,
    O: Objective,
{
    fn start(&mut self, world: &mut W, id: EpisodeId) {
        (self.steps, self.sum) = (0, 0.0);
        self.control.reset();
        self.objective.start(world, id);
    }

    fn act(&mut self, world: &mut W) {
        self.control.act(world);
    }

    fn judge(&mut self, world: &mut W) -> Option<f64> {
        self.steps += 1;
        self.sum += self.objective.reward(world);
        let over = self.steps >= self.trials.steps || self.sum.is_nan() || self.objective.is_over();
        over.then_some(self.sum)
    }

    fn record(&self, world: &W, recorder: &mut dyn Recorder) {
        self.control.record(world, recorder);
        let values: Vec<f64> = self.objective.values().into_iter().map(|(_, value)| value).collect();
        recorder.scalars(&values);
        recorder.tick(seconds(self.steps, self.trials.time_step));
    }
}

impl<S: Channels + Send, M: Channels + Send, O: Objective> Task for Controlled<S, M, O> {
    /// Returns the protocols of [`Neurocontroller::protocols`].
    fn info(&self) -> TaskInfo {
        TaskInfo {
            description: self.control.description(self.trials.steps as usize, self.trials.time_step),
            trials: self.trials.count,
            observations: self.control.sensed().len(),
            protocols: self.control.protocols(),
            anatomy: Some(self.control.anatomy()),
            combination: Some(Combination::Sum),
            has_success: self.objective.success().is_some(),
            ..TaskInfo::new(self.control.parameters(), self.control.schema().clone())
        }
    }

    fn exports(&self) -> Option<&dyn Exports> {
        Some(self)
    }
}

impl<S: Channels + Send, M: Channels + Send, O: Objective> Rollout for Controlled<S, M, O> {
    fn load(&mut self, evaluation: &Evaluation<'_>) -> bool {
        self.control.load_evaluation(evaluation)
    }

    fn record_parameters(&self, recorder: &mut dyn Recorder) {
        self.control.record_parameters(recorder);
    }

    fn outcome(&self) -> Outcome {
        let Self { objective, steps, sum, .. } = self;
        let notes = objective.values().into_iter().map(|(name, value)| (name, Note::from(value))).collect();
        Outcome {
            terms: vec![*sum],
            steps: *steps,
            success: objective.success().unwrap_or_default(),
            notes,
            observed: self.control.observed().cloned(),
            ..Outcome::default()
        }
    }
}

impl<S: Channels + Send, M: Channels + Send, O: Objective> Exports for Controlled<S, M, O> {
    fn robot(&self, _: Option<&[f32]>) -> Option<Robot> {
        self.robot.clone()
    }

    /// Exports the network, with the numbers of the channels that it reads and writes.
    fn controller(&self, parameters: &[f32]) -> Option<ControllerExport> {
        let schema = self.control.schema();
        let sensors = schema.sensors.iter().enumerate().map(|(channel, sensor)| SensorExport {
            name: sensor.name.clone(),
            reads: SensorReading::Channel { channel },
        });
        let motors = schema
            .outputs
            .iter()
            .enumerate()
            .map(|(channel, motor)| MotorExport { name: motor.name.clone(), drives: MotorDrive::Channel { channel } });
        Some(ControllerExport {
            network: NetworkExport::leaky(self.control.layout(), Leak::Filter, parameters),
            sensors: sensors.collect(),
            motors: motors.collect(),
            actuators: Vec::new(),
            surfaces: Vec::new(),
            judge: None,
            time_step: self.trials.time_step,
            steps: self.trials.steps,
        })
    }
}

impl<R> InWorld<World, R>
where
    R: Rollout + Clone + for<'a> Episode<farsa_physics::arena::Lane<'a>> + 'static,
{
    /// Evaluates an episode in an arena, either alone or in lanes.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if the arena is invalid.
    pub fn in_arena(arena: &Arena, rollout: R) -> Result<Self, Error> {
        let world = World::new(arena).map_err(|error| Error::Other(error.to_string()))?;
        let arena = arena.clone();
        let batch = move |lanes: Lanes| {
            let batch = Batch::new(&arena, lanes.count(), lanes.instructions());
            batch.map_err(|error| Error::Other(error.to_string()))
        };
        Ok(Self::new(world, rollout).with_lanes::<Batch>(batch).with_displacements())
    }
}
