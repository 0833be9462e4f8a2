//! An episode of `reach-grasp-lift`: one trial, from the start to the last step or the sphere's fall.

use std::sync::Arc;

use farsa_body::ports::{
    Actuated, ActuatorId, Arrange, BodyId, Channels, Contacts, Handles, JointId, Joints, Kinematics, Motor, Sensor,
};
use farsa_lab::{Episode, EpisodeId, Error};
use farsa_nn::Controller;

use crate::reach_grasp_lift::fitness::{Rewards, Trial};
use crate::reach_grasp_lift::phase::Observation;
use crate::reach_grasp_lift::scene::{Motors, OUTPUTS, Scene, Senses};

/// The judge of one trial. It sees every step, keeps the score and ends the trial.
#[derive(Clone, Debug)]
pub struct Judge {
    scene: Arc<Scene>,
    trial: Trial,
    seen: Observation,
    earned: Rewards,
    /// The trials whose posture and place there are at the start, where they are not the trial's own.
    starts: Option<[usize; 2]>,
}

impl Judge {
    /// A judge of trials in this scene.
    pub fn new(scene: Arc<Scene>) -> Self {
        let (trial, seen, earned) = (Trial::default(), Observation::default(), Rewards::default());
        Self { scene, trial, seen, earned, starts: None }
    }

    /// Sets the world up for a trial and resets the score.
    pub fn start<W>(&mut self, world: &mut W, id: EpisodeId)
    where
        W: Arrange + Handles<Body = BodyId, Joint = JointId> + ?Sized,
    {
        self.scene.arrange_from(world, id, self.starts.unwrap_or([id.trial as usize; 2]));
        self.trial = Trial::default();
    }

    /// Judges the step that has passed. `Some` ends the trial with its reward alone, NaN if the world broke down.
    ///
    /// A trial ends after its last step or when the sphere's center is below the table's top. The rewards so far remain.
    pub fn judge<W>(&mut self, world: &W) -> Option<f64>
    where
        W: Kinematics + Joints + Contacts + Handles<Body = BodyId, Joint = JointId> + ?Sized,
    {
        let config = &self.scene.config;
        self.seen = self.scene.observe(world);
        self.earned = self.trial.judge(&self.seen, &config.judgement);
        if !self.seen.is_finite() {
            self.trial.rewards = Rewards { reach: f64::NAN, ..Rewards::default() };
            return Some(f64::NAN);
        }
        self.trial.fallen = self.seen.height < 0.0;
        if self.trial.fallen || self.trial.steps >= config.steps {
            self.trial.end();
            return Some(self.trial.rewards.total());
        }
        None
    }

    /// The scene.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// The score of the trial.
    pub fn trial(&self) -> &Trial {
        &self.trial
    }

    /// The observation of the last step.
    pub fn seen(&self) -> &Observation {
        &self.seen
    }

    /// The rewards of the last step.
    pub fn earned(&self) -> &Rewards {
        &self.earned
    }

    /// True if the trial succeeds when it ends now.
    pub fn succeeds(&self) -> bool {
        self.trial.succeeds(self.scene.config.steps_per_second())
    }
}

/// A trial run by a controller: the robot senses, the controller steps, the motors act, every control step.
///
/// The return of this [`Episode`] is the reward of its one trial alone. The return of an individual takes the sums of the rewards
/// of its four trials ([`Rewards::total`]).
#[derive(Clone, Debug)]
pub struct ReachEpisode<C> {
    judge: Judge,
    senses: Senses,
    motors: Motors,
    controller: C,
    x: Vec<f32>,
    y: [f32; OUTPUTS],
    /// The label is that of the next phase, of lift that of reach.
    wrong_label: bool,
}

impl<C: Controller> ReachEpisode<C> {
    /// A trial of this controller, whose inputs must be the sensors' channels and whose outputs the motors'.
    ///
    /// # Errors
    /// [`Error::Other`] for a controller of another shape or a scene without sensible channels.
    pub fn new(scene: Arc<Scene>, controller: C) -> Result<Self, Error> {
        let (senses, motors) = (scene.senses()?, scene.motors()?);
        let (inputs, outputs) = (controller.inputs(), controller.outputs());
        if inputs != senses.channels() || outputs != motors.channels() {
            return Err(Error::Other(format!(
                "reach-grasp-lift: a controller of {inputs} inputs and {outputs} outputs for {} sensors and {} motors",
                senses.channels(),
                motors.channels()
            )));
        }
        let x = vec![0.0; senses.channels()];
        Ok(Self { judge: Judge::new(scene), senses, motors, controller, x, y: [0.0; OUTPUTS], wrong_label: false })
    }

    /// The judge of the trial.
    pub fn judge(&self) -> &Judge {
        &self.judge
    }

    /// The sensors.
    pub fn senses(&self) -> &Senses {
        &self.senses
    }

    /// The motors.
    pub fn motors(&self) -> &Motors {
        &self.motors
    }

    /// The controller.
    pub fn controller(&self) -> &C {
        &self.controller
    }

    /// The same, for other parameters.
    pub fn controller_mut(&mut self) -> &mut C {
        &mut self.controller
    }

    /// Starts from the arm's posture and the sphere's place of these trials instead of the trial's own, with the label of a
    /// wrong phase or the right one.
    pub(crate) fn change(&mut self, starts: Option<[usize; 2]>, wrong_label: bool) {
        (self.judge.starts, self.wrong_label) = (starts, wrong_label);
    }

    /// The last inputs \[29 or 26\].
    pub fn sensed(&self) -> &[f32] {
        &self.x
    }

    /// The last outputs \[23\].
    pub fn done(&self) -> &[f32] {
        &self.y
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
    }

    /// Senses, computes and acts. The label is the phase after the previous step.
    fn act(&mut self, world: &mut W) {
        let phase = self.judge.trial().phase;
        self.senses.set_label(if self.wrong_label { phase.following() } else { phase });
        self.senses.read(world, &mut self.x);
        self.controller.step(&self.x, &mut self.y);
        self.motors.drive(&self.y, world);
    }

    fn judge(&mut self, world: &mut W) -> Option<f64> {
        self.judge.judge(world)
    }
}
