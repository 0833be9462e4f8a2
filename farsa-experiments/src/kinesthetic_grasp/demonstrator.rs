//! The demonstrator. It executes the scripted grasp and optionally mixes in the commands of the network.

use std::sync::Arc;

use farsa_body::actuators::MusclePair;
use farsa_body::ports::{Channels as _, Kinematics as _, Motor as _, Sensor as _};
use farsa_body::robots::Tabletop;
use farsa_lab::advanced::run_episode;
use farsa_lab::{Episode, EpisodeId, Error};
use farsa_nn::Controller;
use farsa_nn::learning::Demonstration;
use farsa_physics::articulated::{Model, World};

use crate::reach_grasp_lift::config::OUTPUTS;
use crate::reach_grasp_lift::episode::Judge;
use crate::reach_grasp_lift::scene::{Motors, Scene, Senses};
use crate::reach_grasp_lift::script::{GraspPlan, Statics, Timetable};

/// The activation of both muscles of a pair without torque.
const TONUS: f64 = 0.5;
/// Largest distance of a joint of the arm from the script's angle before the script waits \[rad\].
const PATIENCE: f64 = 0.25;
/// Largest roll of the sphere before the lift, beyond which the script gives up \[m\].
const ROLLED: f64 = 0.03;

/// Guides the arm through reach, grasp and lift, and returns its commands at every tick.
///
/// The script is that of [`ScriptEpisode`](crate::reach_grasp_lift::ScriptEpisode): way-points by inverse kinematics,
/// inverse statics of the muscles, feedback on the arm's joints. It differs in two ways. A torque has infinitely many
/// pairs of activations, and this script takes the pair nearest to 0.5 in both. That is a smooth function of the
/// torque, in the middle of the network's logistic outputs, where the other script has one muscle at rest and a kink.
/// And its clock stops while the arm is farther than 0.25 rad from its target, so that a delayed arm is guided on from
/// its place.
pub(crate) struct Demonstrator {
    scene: Arc<Scene>,
    world: World<f32>,
    statics: Arc<Statics>,
    judge: Judge,
    senses: Senses,
    motors: Motors,
}

/// Inputs and desired motor values of a demonstration.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Record {
    /// Sensor values `[ticks x sensors]`.
    pub(crate) x: Vec<f32>,
    /// Desired motor values `[ticks x 23]`.
    pub(crate) wanted: Vec<f32>,
    /// Success of the trial by the experiment's definition.
    pub(crate) success: bool,
}

impl Record {
    /// The demonstration as a network learns from it.
    pub(crate) fn demonstration(&self) -> Demonstration<'_> {
        Demonstration { x: &self.x, wanted: &self.wanted }
    }
}

impl Demonstrator {
    /// A demonstrator in a scene.
    ///
    /// # Errors
    /// [`Error::Other`] for a robot that cannot be built.
    pub(crate) fn new(scene: Arc<Scene>) -> Result<Self, Error> {
        let model = Model::new(&scene.robot, &scene.config.options());
        let world = World::new(model.map_err(|error| Error::Other(format!("kinesthetic-grasp: {error}")))?);
        let (senses, motors, statics) = (scene.senses()?, scene.motors()?, Arc::new(Statics::new(&scene)?));
        let judge = Judge::new(Arc::clone(&scene));
        Ok(Self { scene, world, statics, judge, senses, motors })
    }

    /// Guides the arm through the trial of an id. The motors get the demonstrator's commands, mixed with `share`
    /// \[0..1\] of the network's commands for the same sensor values. The network starts from rest.
    ///
    /// The record ends with the trial, or where the sphere has rolled away by 3 cm. It is empty if the sphere is out of
    /// reach.
    pub(crate) fn roll_out<C: Controller>(&mut self, id: EpisodeId, network: &mut C, share: f32, record: &mut Record) {
        let Self { scene, world, statics, judge, senses, motors } = self;
        (record.success, record.x, record.wanted) = (false, Vec::new(), Vec::new());
        let x = vec![0.0; senses.channels()];
        let mut guided = Guided {
            scene,
            statics,
            judge,
            senses,
            motors,
            network,
            share,
            record,
            plan: None,
            x,
            positions: Vec::new(),
            time: 0.0,
        };
        run_episode(&mut guided, world, id, None);
        let success = guided.plan.is_some() && guided.judge.succeeds();
        guided.record.success = success;
    }
}

/// An episode in which the arm is guided.
struct Guided<'a, C> {
    scene: &'a Scene,
    statics: &'a Arc<Statics>,
    judge: &'a mut Judge,
    senses: &'a mut Senses,
    motors: &'a mut Motors,
    network: &'a mut C,
    share: f32,
    record: &'a mut Record,
    /// The script, with the sphere's place, if the sphere is in reach.
    plan: Option<(GraspPlan, [f64; 2])>,
    x: Vec<f32>,
    /// Positions of the arm's joints before the step \[rad\].
    positions: Vec<f64>,
    /// The script's own \[s\].
    time: f64,
}

impl<C: Controller> Episode<World<f32>> for Guided<'_, C> {
    fn start(&mut self, world: &mut World<f32>, id: EpisodeId) {
        self.judge.start(world, id);
        self.network.reset();
        self.senses.reset();
        self.motors.reset();
        let (start, sphere) = self.scene.start(id);
        let plan = GraspPlan::new(Timetable::default(), Arc::clone(self.statics), &start, sphere);
        self.plan = plan.ok().map(|plan| (plan, sphere));
        self.time = 0.0;
    }

    fn has_started(&self) -> bool {
        self.plan.is_some()
    }

    fn act(&mut self, world: &mut World<f32>) {
        let Some((plan, _)) = &self.plan else { return };
        self.senses.set_label(self.judge.trial().phase);
        self.senses.read(world, &mut self.x);
        let (positions, torques) = plan.torques(world, self.time);
        let wanted = wanted(self.statics, plan, &positions, &torques, self.time);
        self.positions = positions;
        let (mut own, mut y) = ([0.0; OUTPUTS], [0.0; OUTPUTS]);
        self.network.step(&self.x, &mut own);
        self.record.x.extend_from_slice(&self.x);
        self.record.wanted.extend_from_slice(&wanted);
        for ((y, wanted), own) in y.iter_mut().zip(wanted).zip(own) {
            // y = (1 - share) script + share network, as DAgger mixes policies [Ross2011].
            *y = wanted + self.share * (own - wanted);
        }
        self.motors.drive(&y, world);
    }

    /// Ends the episode, too, where the sphere has rolled away.
    fn judge(&mut self, world: &mut World<f32>) -> Option<f64> {
        let (plan, sphere) = self.plan.as_ref()?;
        let (posture, _) = plan.wanted(self.time);
        // The clock waits for a joint that is far behind, so that the script does not run away from a slow arm.
        let follows = posture.iter().zip(&self.positions).all(|(wanted, q)| (wanted - q).abs() < PATIENCE);
        self.time += if follows { self.scene.config.time_step } else { 0.0 };
        let [x, y, z] = world.pose(Tabletop::SPHERE).position.map(f64::from);
        // The plan grasps at the initial place, so a sphere that has rolled away on the table is lost for it.
        let lies = z < self.scene.config.sphere_radius + 0.01;
        let rolled = (x - sphere[0]).abs().max((y - sphere[1]).abs()) > ROLLED;
        if lies && rolled {
            return Some(self.judge.trial().rewards.total());
        }
        self.judge.judge(world)
    }
}

/// The 23 motor values that the script would give.
fn wanted(statics: &Statics, plan: &GraspPlan, positions: &[f64], torques: &[f64], time: f64) -> [f32; OUTPUTS] {
    let mut y = [0.0; OUTPUTS];
    let (muscles, hand) = y.split_at_mut(14);
    let pairs = muscles.chunks_exact_mut(2).zip(statics.muscles()).zip(positions.iter().zip(torques));
    for ((out, muscle), (q, torque)) in pairs {
        let pair = with_tonus(muscle, *q, *torque).map(|a| a as f32);
        out.copy_from_slice(&pair);
    }
    for (out, position) in hand.iter_mut().zip(plan.hand(time)) {
        *out = position as f32;
    }
    y
}

/// The activations nearest to [`TONUS`] that give a torque \[N m\] at an angle \[rad\] at rest. A torque beyond the
/// pair's range is clamped.
fn with_tonus(muscle: &MusclePair<f64>, q: f64, torque: f64) -> [f64; 2] {
    let at = |activations| muscle.effort(q, 0.0, activations).torque;
    // Muscles also pull without activation, by passive tension.
    let passive = at([0.0, 0.0]);
    // The effect of full activations: the agonist pulls towards the lower limit.
    let (down, up) = (at([1.0, 0.0]) - passive, at([0.0, 1.0]) - passive);
    // Torques are linear in the activations: passive + down a + up b. The pair nearest to (t, t) on this line is (t, t) + more (down,
    // up), with more = (torque - passive - t (down + up)) / (down^2 + up^2).
    let strength = down * down + up * up;
    if strength.is_nan() || strength <= 0.0 {
        return [TONUS; 2];
    }
    let missing = torque - passive;
    let more = (missing - TONUS * (down + up)) / strength;
    let agonist = (TONUS + more * down).clamp(0.0, 1.0);
    let antagonist = if up > 0.0 { ((missing - agonist * down) / up).clamp(0.0, 1.0) } else { TONUS };
    // Where the second met its limit, the first gives what is left.
    let agonist = if down < 0.0 { ((missing - antagonist * up) / down).clamp(0.0, 1.0) } else { agonist };
    [agonist, antagonist]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reach_grasp_lift::config::Config;

    #[test]
    fn activations_give_the_torque_from_the_middle() {
        let scene = Scene::new(Config::default()).unwrap();
        let statics = Statics::new(&scene).unwrap();
        for (i, muscle) in statics.muscles().iter().enumerate() {
            let [low, high] = scene.robot.segments[i].joint.range;
            for part in [0.1, 0.35, 0.5, 0.8] {
                let q = low + part * (high - low);
                let torque = |pair| muscle.effort(q, 0.0, pair).torque;
                let [least, most] = [torque([1.0, 0.0]), torque([0.0, 1.0])];
                for share in [0.0, 0.1, 0.5, 0.6, 1.0] {
                    let wanted = least + share * (most - least);
                    let pair = with_tonus(muscle, q, wanted);
                    assert!((torque(pair) - wanted).abs() < 1e-9, "J{} at {q}: {pair:?}", i + 1);
                    assert!(pair.iter().all(|a| (0.0..=1.0).contains(a)));
                }
                // A torque beyond the range gives full activations, and no torque needs at most the middle if the muscles agree.
                assert_eq!(with_tonus(muscle, q, 2.0 * most - least), [0.0, 1.0]);
            }
            let middle = with_tonus(muscle, 0.5 * (low + high), 0.0);
            assert!(middle.iter().all(|a| (a - TONUS).abs() < 1e-9), "{middle:?}");
        }
    }
}
