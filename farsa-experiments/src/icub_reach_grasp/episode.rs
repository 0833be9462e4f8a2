//! Episodes of `icub-reach-grasp`, in which the robot has to lift a ball from the table.

use std::sync::Arc;

use farsa_body::ports::{
    Actuated, ActuatorId, Arrange, BodyId, Channels as _, Contacts, Handles, JointId, Joints, Kinematics, Motor as _,
};
use farsa_lab::{Episode, EpisodeId, Error};

use crate::icub_reach_grasp::config::{MOTORS, SENSORS};
use crate::icub_reach_grasp::fitness::{Observation, Score};
use crate::icub_reach_grasp::motors::Motors;
use crate::icub_reach_grasp::scene::Scene;
use crate::icub_reach_grasp::senses::Senses;

/// A controller of the robot. It is implemented by the evolved networks and by a script.
pub trait Grasper {
    /// Starts a trial with the ball at the given position \[m\]. An evolved network ignores the position and resets its
    /// state.
    fn start(&mut self, ball: [f64; 3]);
    /// Reads the inputs `x` and writes the motor values `y` between 0 and 1.
    fn step(&mut self, x: &[f32; SENSORS], y: &mut [f32; MOTORS]);
}

/// A world that supports all sensors of the robot.
pub trait GraspingWorld: Kinematics + Joints + Contacts + Handles<Body = BodyId, Joint = JointId> {}

impl<W> GraspingWorld for W where W: Kinematics + Joints + Contacts + Handles<Body = BodyId, Joint = JointId> + ?Sized {}

/// The variable conditions of a trial.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Lifting {
    /// Cell in which the ball is placed, followed by the number of cells along x and y. By default each trial uses
    /// a different part of the area.
    pub cell: Option<[[u32; 2]; 2]>,
    /// Largest error of the offsets measured in the image of the eye.
    pub noise: f32,
}

/// A trial in which a network or a script controls the robot.
#[derive(Clone, Debug)]
pub struct GraspEpisode<C> {
    scene: Arc<Scene>,
    senses: Senses,
    motors: Motors,
    grasper: C,
    asked: Lifting,
    seen: Observation,
    score: Score,
    x: [f32; SENSORS],
    y: [f32; MOTORS],
}

impl<C: Grasper> GraspEpisode<C> {
    /// Creates an episode in a scene.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if the eye or the servos are invalid.
    pub fn new(scene: Arc<Scene>, grasper: C) -> Result<Self, Error> {
        let (senses, motors) = (Senses::new(&scene)?, Motors::new(&scene)?);
        let (asked, seen, score) = (Lifting::default(), Observation::default(), Score::default());
        Ok(Self { scene, senses, motors, grasper, asked, seen, score, x: [0.0; SENSORS], y: [0.0; MOTORS] })
    }

    /// Sets the conditions of the following trials.
    pub fn ask(&mut self, asked: Lifting) {
        self.asked = asked;
    }

    /// Gets the scene in which the episodes take place.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// Gets the controller of the robot.
    pub fn grasper(&self) -> &C {
        &self.grasper
    }

    /// Returns a mutable reference to the controller of the robot.
    pub fn grasper_mut(&mut self) -> &mut C {
        &mut self.grasper
    }

    /// Gets the observation that was made after the last step.
    pub fn seen(&self) -> &Observation {
        &self.seen
    }

    /// Gets the sums that have been collected so far.
    pub fn score(&self) -> &Score {
        &self.score
    }

    /// Gets the 15 inputs of the last step.
    pub fn sensed(&self) -> &[f32; SENSORS] {
        &self.x
    }

    /// Gets the 10 outputs of the last step.
    pub fn done(&self) -> &[f32; MOTORS] {
        &self.y
    }

    /// Computes the terms of the reward for nearness, touch and height as if the trial ended now. Each term is between
    /// 0 and 1.
    pub fn terms(&self) -> [f64; 3] {
        self.score.terms(&self.scene.config)
    }

    /// Returns true if the trial would count as a success if it ended now.
    pub fn succeeds(&self) -> bool {
        self.score.succeeds(&self.scene.config)
    }
}

impl<W, C> Episode<W> for GraspEpisode<C>
where
    W: GraspingWorld + Actuated + Arrange + Handles<Actuator = ActuatorId> + ?Sized,
    C: Grasper,
{
    fn start(&mut self, world: &mut W, id: EpisodeId) {
        let place = match self.asked.cell {
            Some([cell, cells]) => self.scene.place_in(id, cell, cells),
            None => self.scene.place(id),
        };
        self.scene.arrange(world, place);
        self.senses.start(id, self.asked.noise);
        self.motors.reset();
        self.seen = self.scene.observe(world);
        self.score = Score::new(self.seen.distance);
        self.grasper.start(self.seen.ball);
        (self.x, self.y) = ([0.0; SENSORS], [0.0; MOTORS]);
    }

    fn act(&mut self, world: &mut W) {
        self.senses.read(world, &mut self.x);
        self.grasper.step(&self.x, &mut self.y);
        self.motors.drive(&self.y, world);
    }

    /// A trial ends after its last step or when the ball has fallen off the table. The return is the sum of the terms.
    fn judge(&mut self, world: &mut W) -> Option<f64> {
        self.seen = self.scene.observe(world);
        if !self.seen.is_finite() {
            self.score.fail();
            return Some(f64::NAN);
        }
        self.score.add(&self.scene.config, &self.seen);
        let over = self.score.fallen || self.score.steps >= self.scene.config.steps;
        over.then(|| self.terms().iter().sum())
    }
}
