//! Episodes of `icub-reach`, in which the hand reaches for one or two targets.

use std::sync::Arc;

use farsa_body::ports::{Actuated, ActuatorId, Arrange, BodyId, Handles, JointId, Joints, Kinematics};
use farsa_lab::{Episode, EpisodeId};

use crate::icub_reach::config::{Condition, Config, INPUTS, MOTORS};
use crate::icub_reach::scene::Scene;
use crate::icub_reach::totals::RewardTotals;

/// A controller of the hand. It is implemented by the evolved networks and by a script.
pub trait Reacher {
    /// Clears the state that was left by an earlier trial.
    fn reset(&mut self);
    /// Reads the inputs `x` and the angles of the six joints in radians, and writes the motor values `y` between 0 and
    /// 1.
    ///
    /// Note that the evolved networks ignore the joint angles.
    fn step(&mut self, x: &[f32; INPUTS], joints: &[f32; MOTORS], y: &mut [f32; MOTORS]);
}

/// A world that supports the episodes of this experiment.
pub trait ReachingWorld: Kinematics + Joints + Handles<Body = BodyId, Joint = JointId> {}

impl<W> ReachingWorld for W where W: Kinematics + Joints + Handles<Body = BodyId, Joint = JointId> + ?Sized {}

/// The variable conditions of a trial.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Reaching {
    /// Position of the target in meters. By default each trial draws a random target.
    pub target: Option<[f64; 3]>,
    /// Step at which the target moves to a different position, if it moves at all.
    pub jump: Option<u32>,
    /// If true, the trunk keeps its initial posture.
    pub locked_torso: bool,
    /// An additional mass attached to the hand (in kilograms).
    pub load: f64,
}

/// A trial in which a network or a script controls the hand.
///
/// The totals are reset when the target moves to a different position.
#[derive(Clone, Debug)]
pub struct ReachEpisode<C> {
    scene: Arc<Scene>,
    reacher: C,
    asked: Reaching,
    targets: [[f64; 3]; 2],
    hand: [f64; 3],
    totals: RewardTotals,
    steps: u32,
    x: [f32; INPUTS],
    y: [f32; MOTORS],
}

impl<C: Reacher> ReachEpisode<C> {
    /// Creates an episode in a scene.
    pub fn new(scene: Arc<Scene>, reacher: C) -> Self {
        let totals = RewardTotals::default();
        let (targets, hand) = ([[0.0; 3]; 2], [0.0; 3]);
        let asked = Reaching::default();
        Self { scene, reacher, asked, targets, hand, totals, steps: 0, x: [0.0; INPUTS], y: [0.0; MOTORS] }
    }

    /// Sets the conditions of the following trials.
    pub fn ask(&mut self, asked: Reaching) {
        self.asked = asked;
    }

    /// Gets the scene in which the episodes take place.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// Gets the controller of the hand.
    pub fn reacher(&self) -> &C {
        &self.reacher
    }

    /// Returns a mutable reference to the controller of the hand.
    pub fn reacher_mut(&mut self) -> &mut C {
        &mut self.reacher
    }

    /// Gets the distances that have been collected so far.
    pub fn totals(&self) -> &RewardTotals {
        &self.totals
    }

    /// Gets the number of steps that have been completed.
    pub fn steps(&self) -> u32 {
        self.steps
    }

    /// Gets the three inputs of the last step.
    pub fn sensed(&self) -> &[f32; INPUTS] {
        &self.x
    }

    /// Gets the six outputs of the last step.
    pub fn done(&self) -> &[f32; MOTORS] {
        &self.y
    }

    /// Gets the position of the center of the palm (in meters).
    pub fn hand(&self) -> [f64; 3] {
        self.hand
    }

    /// Returns the current position of the target (in meters).
    pub fn target(&self) -> [f64; 3] {
        self.targets[usize::from(self.asked.jump.is_some_and(|at| self.steps >= at))]
    }

    /// Computes the reward under the assumption that the trial ends now.
    pub fn fitness(&self) -> f64 {
        self.totals.fitness(self.scene.config.least_start)
    }

    fn look<W: ReachingWorld + ?Sized>(&mut self, world: &W) -> f64 {
        self.hand = world.pose(Scene::PALM).cast::<f64>().transform(self.scene.palm_centre);
        Scene::distance(self.hand, self.target())
    }

    fn sense(&mut self) {
        let Config { condition, volume, offset, .. } = &self.scene.config;
        let target = self.target();
        self.x = [0, 1, 2].map(|k| match condition {
            Condition::Steady => {
                // The position of the target in the volume, as a share of each side.
                let [low, high] = volume.ends(k);
                ((target[k] - low) / (high - low)) as f32
            }
            Condition::Velocity => ((target[k] - self.hand[k]) / offset).clamp(-1.0, 1.0) as f32,
        });
    }
}

impl<W, C> Episode<W> for ReachEpisode<C>
where
    W: ReachingWorld + Actuated + Arrange + Handles<Actuator = ActuatorId> + ?Sized,
    C: Reacher,
{
    fn start(&mut self, world: &mut W, id: EpisodeId) {
        self.scene.arrange(world);
        self.reacher.reset();
        let [own, next] = self.scene.two_targets(id);
        self.targets = [self.asked.target.unwrap_or(own), next];
        (self.steps, self.x, self.y) = (0, [0.0; INPUTS], [0.0; MOTORS]);
        self.totals = RewardTotals::new(self.look(world));
    }

    fn act(&mut self, world: &mut W) {
        self.sense();
        let scene = Arc::clone(&self.scene);
        let joints = scene.controlled.map(|driven| world.position(driven.joint));
        self.reacher.step(&self.x, &joints, &mut self.y);
        let Config { condition, speed, hold_rate, .. } = scene.config;
        for (number, one) in scene.controlled.iter().chain(&scene.held).enumerate() {
            // The first two of the six are the trunk's.
            let driven = number < MOTORS && !(self.asked.locked_torso && number < 2);
            let y = self.y.get(number).copied().unwrap_or(0.0);
            let command = match (condition, driven) {
                (Condition::Steady, true) => {
                    let [low, high] = one.range;
                    (low + (high - low) * f64::from(y)) as f32
                }
                (Condition::Steady, false) => one.start as f32,
                // y = 1/2 is rest. Commands are speeds in rad/s.
                (Condition::Velocity, true) => (2.0 * y - 1.0) * speed as f32,
                (Condition::Velocity, false) => {
                    let most = speed as f32;
                    // v = k (q0 - q) returns to the start angle, at most at the speed of driven joints.
                    (hold_rate as f32 * (one.start as f32 - world.position(one.joint))).clamp(-most, most)
                }
            };
            world.command(one.actuator, [command, 0.0]);
        }
        if self.asked.load > 0.0 {
            scene.hang(world, self.hand, self.asked.load);
        }
    }

    fn judge(&mut self, world: &mut W) -> Option<f64> {
        self.steps += 1;
        let Config { steps, .. } = self.scene.config;
        let distance = self.look(world);
        if self.asked.jump == Some(self.steps) {
            // Totals restart at the jump, so that only the second reach counts.
            self.totals = RewardTotals::new(distance);
        } else {
            self.totals.add(distance, self.steps + self.scene.config.window_steps() > steps);
        }
        if !distance.is_finite() {
            self.totals.add(f64::NAN, true);
            return Some(f64::NAN);
        }
        (self.steps >= steps).then(|| self.fitness())
    }
}
