//! Episodes of `reach-grasp-lift`. A trial ends after its last step or when the sphere falls off the table.

use std::sync::Arc;

use farsa_body::ports::{
    Actuated, ActuatorId, Arrange, BodyId, Channels, Contacts, Handles, JointId, Joints, Kinematics, Motor, Sensor,
};
use farsa_lab::{Episode, EpisodeId, Error};
use farsa_nn::Controller;

use crate::reach_grasp_lift::config::{LABELS, OUTPUTS};
use crate::reach_grasp_lift::fitness::{Rewards, Trial};
use crate::reach_grasp_lift::phase::Observation;
use crate::reach_grasp_lift::scene::{Motors, Scene, Senses};

/// Observes every step of a trial, collects the reward and decides when the trial ends.
#[derive(Clone, Debug)]
pub struct Judge {
    scene: Arc<Scene>,
    trial: Trial,
    seen: Observation,
    earned: Rewards,
    /// Trials whose start posture and place replace those of the current trial.
    starts: Option<[usize; 2]>,
}

impl Judge {
    /// Creates a judge for trials in the given scene.
    pub fn new(scene: Arc<Scene>) -> Self {
        let (trial, seen, earned) = (Trial::default(), Observation::default(), Rewards::default());
        Self { scene, trial, seen, earned, starts: None }
    }

    /// Prepares the world for a trial and resets the reward.
    pub fn start<W>(&mut self, world: &mut W, id: EpisodeId)
    where
        W: Arrange + Handles<Body = BodyId, Joint = JointId> + ?Sized,
    {
        self.scene.arrange_from(world, id, self.starts.unwrap_or([id.trial as usize; 2]));
        self.trial = Trial::default();
    }

    /// Updates the reward after a step. Returns `None` as long as the trial continues. At the end it returns the reward
    /// of this trial, or NaN after a numerical failure.
    ///
    /// A trial ends after its last step or when the center of the sphere is below the table top. Rewards that were
    /// collected before a fall are kept.
    pub fn judge<W>(&mut self, world: &W) -> Option<f64>
    where
        W: Kinematics + Joints + Contacts + Handles<Body = BodyId, Joint = JointId> + ?Sized,
    {
        let config = &self.scene.config;
        self.seen = self.scene.observe(world);
        self.earned = self.trial.judge(&self.seen, &config.judgement);
        // A single NaN term makes the total NaN, so the other terms of a broken trial are irrelevant.
        if !self.seen.is_finite() {
            self.trial.rewards = Rewards { reach: f64::NAN, ..Rewards::default() };
            return Some(f64::NAN);
        }
        // Height counts from the table top, so a sphere that rests on the table is at its radius.
        self.trial.fallen = self.seen.height < 0.0;
        if self.trial.fallen || self.trial.steps >= config.steps {
            self.trial.end();
            return Some(self.trial.rewards.total());
        }
        None
    }

    /// Gets the scene in which the trials take place.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// Gets the reward and the phase of the current trial.
    pub fn trial(&self) -> &Trial {
        &self.trial
    }

    /// Gets the observation that was made after the last step.
    pub fn seen(&self) -> &Observation {
        &self.seen
    }

    /// Gets the rewards of the last step.
    pub fn earned(&self) -> &Rewards {
        &self.earned
    }

    /// Returns true if the trial would count as a success if it ended now.
    pub fn succeeds(&self) -> bool {
        self.trial.succeeds(self.scene.config.steps_per_second())
    }
}

/// A trial in which a controller reads the sensors and drives the motors in every control step.
///
/// Note that the return value of this [`Episode`] is the reward of a single trial. The fitness of an individual is
/// computed from the summed rewards of its four trials (see [`Rewards::total`]).
#[derive(Clone, Debug)]
pub struct ReachEpisode<C> {
    judge: Judge,
    senses: Senses,
    motors: Motors,
    controller: C,
    x: Vec<f32>,
    y: Vec<f32>,
    /// The label is that of the next phase, of lift that of reach.
    wrong_label: bool,
}

impl<C: Controller> ReachEpisode<C> {
    /// Creates an episode for a controller. Its inputs must match the channels of the sensors. Its outputs must match
    /// the channels of the motors, followed by 3 labels for [`Labels::Own`](crate::reach_grasp_lift::Labels::Own).
    ///
    /// # Errors
    /// Returns [`Error::Other`] if the controller has a different number of inputs or outputs, or if the sensors of the
    /// scene are invalid.
    pub fn new(scene: Arc<Scene>, controller: C) -> Result<Self, Error> {
        let (senses, motors) = (scene.senses()?, scene.motors()?);
        let (inputs, outputs) = (controller.inputs(), controller.outputs());
        let labels = scene.config.labels.outputs();
        if inputs != senses.channels() || outputs != motors.channels() + labels {
            let also = if labels == 0 { String::new() } else { format!(" and {labels} labels") };
            return Err(Error::Other(format!(
                "reach-grasp-lift: a controller of {inputs} inputs and {outputs} outputs for {} sensors and {} motors{also}",
                senses.channels(),
                motors.channels()
            )));
        }
        let (x, y) = (vec![0.0; inputs], vec![0.0; outputs]);
        Ok(Self { judge: Judge::new(scene), senses, motors, controller, x, y, wrong_label: false })
    }

    /// Gets the judge of the trial.
    pub fn judge(&self) -> &Judge {
        &self.judge
    }

    /// Gets the sensors of the robot.
    pub fn senses(&self) -> &Senses {
        &self.senses
    }

    /// Gets the motors of the robot.
    pub fn motors(&self) -> &Motors {
        &self.motors
    }

    /// Gets the controller of the robot.
    pub fn controller(&self) -> &C {
        &self.controller
    }

    /// Returns a mutable reference to the controller, for example to load different parameters.
    pub fn controller_mut(&mut self) -> &mut C {
        &mut self.controller
    }

    /// Starts from the arm's posture and the sphere's place of these trials instead of the trial's own, with the label
    /// of a wrong phase or the right one.
    pub(crate) fn change(&mut self, starts: Option<[usize; 2]>, wrong_label: bool) {
        (self.judge.starts, self.wrong_label) = (starts, wrong_label);
    }

    /// Gets the sensor values of the last step. There are 29 of them with labels and 26 without.
    pub fn sensed(&self) -> &[f32] {
        &self.x
    }

    /// Gets the outputs of the last step. These are the 23 motor values, followed by the 3 labels of the next step for
    /// [`Labels::Own`](crate::reach_grasp_lift::Labels::Own).
    pub fn done(&self) -> &[f32] {
        &self.y
    }

    /// Reads the sensors. The label is the phase after the previous step, or an output of the previous step.
    pub(crate) fn sense<W>(&mut self, world: &W)
    where
        W: Kinematics + Joints + Contacts + Handles<Body = BodyId, Joint = JointId> + ?Sized,
    {
        let phase = self.judge.trial().phase;
        self.senses.set_label(if self.wrong_label { phase.following() } else { phase });
        if let Some(labels) = self.next_labels() {
            self.senses.set_own_labels(labels);
        }
        self.senses.read(world, &mut self.x);
    }

    /// Drives the motors by an action instead of the controller, within the range of its outputs.
    pub(crate) fn actuate<W>(&mut self, action: &[f32], world: &mut W)
    where
        W: Joints + Actuated + Handles<Joint = JointId, Actuator = ActuatorId> + ?Sized,
    {
        self.y.iter_mut().zip(action).for_each(|(y, action)| *y = action.clamp(0.0, 1.0));
        self.motors.drive(&self.y[..OUTPUTS], world);
    }

    /// The outputs of the last step for labels.
    fn next_labels(&self) -> Option<[f32; LABELS]> {
        self.y.get(OUTPUTS..)?.first_chunk().copied()
    }
}

impl<W, C> Episode<W> for ReachEpisode<C>
where
    W: Kinematics
        + Joints
        + Actuated
        + Contacts
        + Arrange
        + Handles<Body = BodyId, Joint = JointId, Actuator = ActuatorId>
        + ?Sized,
    C: Controller,
{
    fn start(&mut self, world: &mut W, id: EpisodeId) {
        self.judge.start(world, id);
        self.controller.reset();
        self.senses.reset();
        self.motors.reset();
        self.y.fill(0.0);
    }

    fn act(&mut self, world: &mut W) {
        self.sense(world);
        self.controller.step(&self.x, &mut self.y);
        self.motors.drive(&self.y[..OUTPUTS], world);
    }

    fn judge(&mut self, world: &mut W) -> Option<f64> {
        self.judge.judge(world)
    }
}
