//! An episode of `icub-reach-grasp`: the ball is somewhere, and shall be lifted.

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

/// A controller of the robot.
pub trait Grasper {
    /// Starts a trial with the ball at this place \[m\]. An agent does not sense it and clears its state.
    fn start(&mut self, ball: [f64; 3]);
    /// Senses `x` and writes the motors' values `y`, 0..1.
    fn step(&mut self, x: &[f32; SENSORS], y: &mut [f32; MOTORS]);
}

/// A world in which the robot senses and is seen.
pub trait GraspingWorld: Kinematics + Joints + Contacts + Handles<Body = BodyId, Joint = JointId> {}

impl<W> GraspingWorld for W where W: Kinematics + Joints + Contacts + Handles<Body = BodyId, Joint = JointId> + ?Sized {}

/// The demands of a trial.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Lifting {
    /// The cell of the ball, and the number of cells along X and Y of the tested area. Without it each trial has its part of the
    /// area.
    pub cell: Option<[[u32; 2]; 2]>,
    /// Largest error of the offsets in the eye's image.
    pub noise: f32,
}

/// A trial of a network or of a script.
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
    /// Trials in a scene.
    ///
    /// # Errors
    /// [`Error::Other`] for an eye or servos that there are not.
    pub fn new(scene: Arc<Scene>, grasper: C) -> Result<Self, Error> {
        let (senses, motors) = (Senses::new(&scene)?, Motors::new(&scene)?);
        let (asked, seen, score) = (Lifting::default(), Observation::default(), Score::default());
        Ok(Self { scene, senses, motors, grasper, asked, seen, score, x: [0.0; SENSORS], y: [0.0; MOTORS] })
    }

    /// Sets the demands of the next trials.
    pub fn ask(&mut self, asked: Lifting) {
        self.asked = asked;
    }

    /// The scene.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// The controller of the robot.
    pub fn grasper(&self) -> &C {
        &self.grasper
    }

    /// The same, to be changed.
    pub fn grasper_mut(&mut self) -> &mut C {
        &mut self.grasper
    }

    /// The observation after the last step.
    pub fn seen(&self) -> &Observation {
        &self.seen
    }

    /// The sums so far.
    pub fn score(&self) -> &Score {
        &self.score
    }

    /// The last inputs \[15\].
    pub fn sensed(&self) -> &[f32; SENSORS] {
        &self.x
    }

    /// The last outputs \[10\].
    pub fn done(&self) -> &[f32; MOTORS] {
        &self.y
    }

    /// The terms of the reward if the trial ends now: nearness, touch, height, each from 0 to 1.
    pub fn terms(&self) -> [f64; 3] {
        self.score.terms(&self.scene.config)
    }

    /// True if the trial succeeds when it ends now.
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
