//! An episode of `icub-reach`: the hand reaches for a target, or for two.

use std::sync::Arc;

use farsa_body::ports::{Actuated, ActuatorId, Arrange, BodyId, Handles, JointId, Joints, Kinematics};
use farsa_lab::{Episode, EpisodeId};

use crate::icub_reach::config::{Condition, Config, INPUTS, MOTORS};
use crate::icub_reach::scene::Scene;
use crate::icub_reach::totals::RewardTotals;

/// A controller of the hand.
pub trait Reacher {
    /// Clears the state of an earlier trial.
    fn reset(&mut self);
    /// Senses `x`, has the six joints at `joints` \[rad\], and writes the motors' values `y`, 0..1.
    ///
    /// A network of the experiment does not look at the joints.
    fn step(&mut self, x: &[f32; INPUTS], joints: &[f32; MOTORS], y: &mut [f32; MOTORS]);
}

/// A world in which the hand is found by kinematics and joints.
pub trait ReachingWorld: Kinematics + Joints + Handles<Body = BodyId, Joint = JointId> {}

impl<W> ReachingWorld for W where W: Kinematics + Joints + Handles<Body = BodyId, Joint = JointId> + ?Sized {}

/// The demands of a trial.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Reaching {
    /// The target \[m\]. Without it each trial draws its target.
    pub target: Option<[f64; 3]>,
    /// From which step on it is another one of the trial's own.
    pub jump: Option<u32>,
    /// The trunk keeps its posture of the start.
    pub locked_torso: bool,
    /// The mass that hangs on the hand \[kg\].
    pub load: f64,
}

/// A trial of a network or of a script.
///
/// A jump of the target restarts the totals.
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
    /// Trials in a scene.
    pub fn new(scene: Arc<Scene>, reacher: C) -> Self {
        let totals = RewardTotals::default();
        let (targets, hand) = ([[0.0; 3]; 2], [0.0; 3]);
        let asked = Reaching::default();
        Self { scene, reacher, asked, targets, hand, totals, steps: 0, x: [0.0; INPUTS], y: [0.0; MOTORS] }
    }

    /// Sets the demands of the next trials.
    pub fn ask(&mut self, asked: Reaching) {
        self.asked = asked;
    }

    /// The scene.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// The controller of the hand.
    pub fn reacher(&self) -> &C {
        &self.reacher
    }

    /// The same, to be changed.
    pub fn reacher_mut(&mut self) -> &mut C {
        &mut self.reacher
    }

    /// The distances so far.
    pub fn totals(&self) -> &RewardTotals {
        &self.totals
    }

    /// Steps so far.
    pub fn steps(&self) -> u32 {
        self.steps
    }

    /// The last inputs \[3\].
    pub fn sensed(&self) -> &[f32; INPUTS] {
        &self.x
    }

    /// The last outputs \[6\].
    pub fn done(&self) -> &[f32; MOTORS] {
        &self.y
    }

    /// The palm's center \[m\].
    pub fn hand(&self) -> [f64; 3] {
        self.hand
    }

    /// Where the target is now \[m\].
    pub fn target(&self) -> [f64; 3] {
        self.targets[usize::from(self.asked.jump.is_some_and(|at| self.steps >= at))]
    }

    /// The reward if the trial ends now.
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
                (Condition::Velocity, true) => (2.0 * y - 1.0) * speed as f32,
                (Condition::Velocity, false) => {
                    let most = speed as f32;
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
