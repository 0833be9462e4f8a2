//! A handwritten grasp. It demonstrates that the task can be solved by the simulated arm and hand.

use std::sync::Arc;

use farsa_body::actuators::{Law, MusclePair};
use farsa_body::kinematics::{Goal, InverseKinematics, InverseKinematicsError, KinematicTree, Orientation};
use farsa_body::ports::{Actuated, ActuatorId, Arrange, BodyId, Contacts, Handles, JointId, Joints, Kinematics, Motor};
use farsa_body::robots::{ArmAndHand, Tabletop};
use farsa_lab::{Episode, EpisodeId, Error};

use crate::reach_grasp_lift::config::OUTPUTS;
use crate::reach_grasp_lift::episode::Judge;
use crate::reach_grasp_lift::scene::{Motors, Scene};
use crate::smooth::smooth;

/// Postures with the palm exactly down, its center 5 cm above the sphere in its four places \[deg\]. The search for a
/// posture begins there.
const PALM_DOWN: [[f64; 7]; 4] = [
    [-92.0, -8.0, 53.0, -102.0, -28.0, -48.0, 11.0],
    [-82.0, -26.0, 18.0, -66.0, -18.0, -25.0, 6.0],
    [-43.0, -29.0, 2.0, -46.0, -21.0, -21.0, -6.0],
    [-61.0, -28.0, 26.0, -90.0, -31.0, -23.0, 0.0],
];

/// The places that they belong to, X and Y in the world \[m\].
const PLACES: [[f64; 2]; 4] = [[0.10, -0.18], [0.18, -0.26], [0.26, -0.18], [0.18, -0.10]];

/// The timing and the gains of the script. They were tuned by hand in two simulators.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timetable {
    /// Durations of reaching the way-point, descending, closing and lifting (in seconds). The lifted posture is
    /// held for the rest of the trial.
    pub durations: [f64; 4],
    /// Height of the palm's center above the table at the way-point (in meters).
    pub way_point: f64,
    /// Height of the palm's center above the table during the grasp (in meters). It is chosen below the top of the
    /// sphere, so that the palm presses gently.
    pub palm: f64,
    /// Distance from the palm's center to the sphere in the direction of the fingertips (in meters).
    pub ahead: f64,
    /// Height by which the hand is lifted (in meters).
    pub lift: f64,
    /// Positions of the nine servo groups when the hand is closed around the sphere.
    pub closed: [f64; 9],
    /// Position gains of the feedback for J1..J7 (in N m/rad).
    pub stiffness: [f64; 7],
    /// Velocity gains of the feedback for J1..J7 (in N m s/rad).
    pub damping: [f64; 7],
}

impl Default for Timetable {
    fn default() -> Self {
        Self {
            durations: [2.2, 0.8, 0.6, 0.8],
            way_point: 0.13,
            palm: 0.037,
            ahead: 0.015,
            lift: 0.06,
            closed: [0.85, 0.35, 0.35, 0.65, 0.70, 0.65, 0.70, 0.0, 0.675],
            stiffness: [12.0, 40.0, 12.0, 12.0, 6.0, 4.0, 4.0],
            damping: [1.0, 3.0, 1.0, 1.0, 0.4, 0.2, 0.2],
        }
    }
}

/// A static model of the arm. It computes postures and the muscle activations that hold them.
#[derive(Clone, Debug)]
pub struct Statics {
    tree: KinematicTree,
    muscles: [MusclePair<f64>; 7],
    palm_centre: [f64; 3],
    gravity: [f64; 3],
}

impl Statics {
    /// Creates the static model for the arm of a scene.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if the arm is not driven by muscles.
    pub fn new(scene: &Scene) -> Result<Self, Error> {
        let tree = KinematicTree::new(&scene.robot).map_err(|error| Error::Other(error.to_string()))?;
        let laws: Vec<_> = scene.robot.actuators.iter().map(|actuator| actuator.law).collect();
        let muscles: Vec<_> =
            laws.into_iter().map_while(|law| if let Law::MusclePair(pair) = law { Some(pair) } else { None }).collect();
        let muscles = muscles.try_into().map_err(|other: Vec<_>| {
            Error::Other(format!("reach-grasp-lift: {} muscle pairs where the arm has seven joints", other.len()))
        })?;
        let gravity = [0.0, 0.0, -scene.config.gravity];
        Ok(Self { tree, muscles, palm_centre: scene.arm.palm_centre, gravity })
    }

    /// Gets the kinematic tree of the scene.
    pub fn tree(&self) -> &KinematicTree {
        &self.tree
    }

    /// Computes the joint angles J1..J27 for which the palm points down and its center is at the given position in the
    /// world. Positions are in meters and angles in radians. The search starts from the posture `from`.
    ///
    /// # Errors
    /// Returns [`InverseKinematicsError`] if the joint ranges do not permit such a posture.
    pub fn palm_down(&self, place: [f64; 3], from: &[f64]) -> Result<Vec<f64>, InverseKinematicsError> {
        let goal = Goal {
            body: ArmAndHand::PALM,
            point: self.palm_centre,
            position: place,
            orientation: Orientation::Direction { own: ArmAndHand::PALM_NORMAL, wanted: [0.0, 0.0, -1.0] },
        };
        InverseKinematics::default().solve(&self.tree, &goal, from).map(|solution| solution.joints)
    }

    /// Computes joint angles J1..J27 for which the palm points down and its center is at a given height above a point
    /// of the table. Positions are in meters and angles in radians.
    ///
    /// # Errors
    /// Returns [`InverseKinematicsError`] if the joint ranges do not permit such a posture.
    pub fn above(&self, [x, y]: [f64; 2], height: f64) -> Result<Vec<f64>, InverseKinematicsError> {
        let far = |place: &[f64; 2]| (place[0] - x) * (place[0] - x) + (place[1] - y) * (place[1] - y);
        let mut nearest = 0;
        for i in 1..PLACES.len() {
            if far(&PLACES[i]) < far(&PLACES[nearest]) {
                nearest = i;
            }
        }
        // The solver converges to a solution near its start, which therefore is a posture with the palm down.
        let mut from = self.tree.zero();
        for (q, degrees) in from.iter_mut().zip(PALM_DOWN[nearest]) {
            *q = degrees.to_radians();
        }
        self.palm_down([x, y, height], &from)
    }

    /// Computes the activations of the agonists and antagonists of J1..J7 that produce the given torques (in N m) at a
    /// posture (in radians). The second result is true if the muscles are strong enough.
    pub fn activations(&self, joints: &[f64], torques: &[f64]) -> ([[f64; 2]; 7], bool) {
        let mut all_reached = true;
        let activations = core::array::from_fn(|i| {
            let (pair, reached) = self.muscles[i].activations(joints[i], torques[i]);
            all_reached &= reached;
            pair
        });
        (activations, all_reached)
    }

    /// The arm's muscles, J1..J7.
    pub(crate) fn muscles(&self) -> &[MusclePair<f64>; 7] {
        &self.muscles
    }

    /// Computes the torques of J1..J27 that hold a posture (in radians) against gravity (in N m).
    pub fn gravity_torques(&self, joints: &[f64]) -> Vec<f64> {
        self.tree.gravity_torques(&self.tree.poses(joints), self.gravity)
    }
}

/// The sequence of postures that the script follows from one initial state.
#[derive(Clone, Debug)]
pub struct GraspPlan {
    timetable: Timetable,
    statics: Arc<Statics>,
    /// J1..J7 at the start, at the way-point, around the sphere, lifted.
    postures: [[f64; 7]; 4],
}

fn seven(joints: &[f64]) -> [f64; 7] {
    core::array::from_fn(|i| joints[i])
}

impl GraspPlan {
    /// Plans the grasp of a sphere at the given position on the table (in meters). The arm starts at the posture
    /// `start`. It contains the angles of J1..J27 in radians.
    ///
    /// # Errors
    /// Returns [`InverseKinematicsError`] if the sphere is out of reach.
    pub fn new(
        timetable: Timetable,
        statics: Arc<Statics>,
        start: &[f64],
        sphere: [f64; 2],
    ) -> Result<Self, InverseKinematicsError> {
        let over = statics.above(sphere, timetable.palm + 0.05)?;
        // Where the fingers point.
        let [x, y, _] = statics.tree.poses(&over)[ArmAndHand::PALM.index()].rotate([1.0, 0.0, 0.0]);
        let length = farsa_num::Scalar::sqrt(x * x + y * y);
        // The palm is `ahead` meters behind the sphere, against the horizontal direction of the fingers.
        let back = timetable.ahead / length;
        let place = |height: f64| [sphere[0] - back * x, sphere[1] - back * y, height];
        // Each solution starts from the previous one, so that no joint changes to another branch.
        let way_point = statics.palm_down(place(timetable.way_point), &over)?;
        let down = statics.palm_down(place(timetable.palm), &way_point)?;
        let up = statics.palm_down(place(timetable.palm + timetable.lift), &down)?;
        let postures = [seven(start), seven(&way_point), seven(&down), seven(&up)];
        Ok(Self { timetable, statics, postures })
    }

    /// Returns the desired posture at the given time in seconds, and the degree to which the hand is closed.
    pub fn wanted(&self, time: f64) -> ([f64; 7], f64) {
        let [reach, descend, close, lift] = self.timetable.durations;
        let ends = [reach, reach + descend, reach + descend + close];
        let [start, way_point, down, up] = &self.postures;
        let (from, to, share) = if time < ends[0] {
            (start, way_point, time / reach)
        } else if time < ends[2] {
            (way_point, down, (time - ends[0]) / descend)
        } else {
            (down, up, (time - ends[2]) / lift)
        };
        let share = smooth(share);
        let posture = core::array::from_fn(|i| from[i] + (to[i] - from[i]) * share);
        // Closed a fifth before the lift begins: the servos need the time.
        (posture, smooth((time - ends[1]) / (0.8 * close)))
    }

    /// J1..J27 \[rad\], and the torques \[N m\] that follow the plan at a time \[s\]: against gravity, with feedback on
    /// J1..J7.
    pub(crate) fn torques<W>(&self, world: &W, time: f64) -> (Vec<f64>, Vec<f64>)
    where
        W: Joints<Joint = JointId> + ?Sized,
    {
        let joints = self.statics.tree.joints();
        let positions: Vec<f64> = joints.iter().map(|joint| f64::from(world.position(*joint))).collect();
        let (wanted, _) = self.wanted(time);
        let mut torques = self.statics.gravity_torques(&positions);
        for i in 0..7 {
            let speed = f64::from(world.speed(joints[i]));
            // tau = g(q) + k (q_wanted - q) - d w. With gravity compensated, small gains k suffice.
            torques[i] += self.timetable.stiffness[i] * (wanted[i] - positions[i]) - self.timetable.damping[i] * speed;
        }
        (positions, torques)
    }

    /// The positions of the nine servo groups at a time \[s\].
    pub(crate) fn hand(&self, time: f64) -> [f64; 9] {
        let (_, closed) = self.wanted(time);
        self.timetable.closed.map(|position| position * closed)
    }

    /// Computes the 23 outputs at the given time in seconds. The muscles are controlled by inverse statics with
    /// feedback on J1..J7, and the hand by desired positions.
    pub fn outputs<W>(&self, world: &W, time: f64) -> [f32; OUTPUTS]
    where
        W: Joints<Joint = JointId> + ?Sized,
    {
        let (positions, torques) = self.torques(world, time);
        let (activations, _) = self.statics.activations(&positions, &torques);
        let mut y = [0.0; OUTPUTS];
        for (out, value) in y.iter_mut().zip(activations.into_iter().flatten().chain(self.hand(time))) {
            *out = value as f32;
        }
        y
    }
}

/// A trial controlled by the script. It uses only the outputs, the starts and the judge of the experiment.
#[derive(Clone, Debug)]
pub struct ScriptEpisode {
    judge: Judge,
    motors: Motors,
    timetable: Timetable,
    statics: Arc<Statics>,
    plan: Option<GraspPlan>,
    done: [f32; OUTPUTS],
}

impl ScriptEpisode {
    /// Creates an episode in a scene with the given timetable.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if the arm is not driven by muscles.
    pub fn new(scene: Arc<Scene>, timetable: Timetable) -> Result<Self, Error> {
        let (motors, statics) = (scene.motors()?, Arc::new(Statics::new(&scene)?));
        let judge = Judge::new(scene);
        Ok(Self { judge, motors, timetable, statics, plan: None, done: [0.0; OUTPUTS] })
    }

    /// Gets the judge of the trial.
    pub fn judge(&self) -> &Judge {
        &self.judge
    }

    /// Gets the static model of the arm.
    pub fn statics(&self) -> &Arc<Statics> {
        &self.statics
    }

    /// Gets the plan of the trial, or `None` if the sphere is out of reach.
    pub fn plan(&self) -> Option<&GraspPlan> {
        self.plan.as_ref()
    }

    /// Gets the outputs of the last step.
    pub fn done(&self) -> &[f32; OUTPUTS] {
        &self.done
    }
}

impl<W> Episode<W> for ScriptEpisode
where
    W: Kinematics
        + Joints
        + Actuated
        + Contacts
        + Arrange
        + Handles<Body = BodyId, Joint = JointId, Actuator = ActuatorId>
        + ?Sized,
{
    fn start(&mut self, world: &mut W, id: EpisodeId) {
        self.judge.start(world, id);
        let joints = self.statics.tree.joints();
        let start: Vec<f64> = joints.iter().map(|joint| f64::from(world.position(*joint))).collect();
        let [x, y, _] = world.pose(Tabletop::SPHERE).position.map(f64::from);
        self.plan = GraspPlan::new(self.timetable, Arc::clone(&self.statics), &start, [x, y]).ok();
    }

    fn act(&mut self, world: &mut W) {
        if let Some(plan) = &self.plan {
            let time = f64::from(self.judge.trial().steps) * self.judge.scene().config.time_step;
            self.done = plan.outputs(world, time);
        }
        self.motors.drive(&self.done, world);
    }

    fn judge(&mut self, world: &mut W) -> Option<f64> {
        self.judge.judge(world)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reach_grasp_lift::config::Config;

    #[test]
    fn the_movement_is_smooth_from_end_to_end() {
        assert_eq!([smooth(-1.0), smooth(0.0), smooth(0.5), smooth(1.0), smooth(7.0)], [0.0, 0.0, 0.5, 1.0, 1.0]);
        let scene = Scene::new(Config::default()).unwrap();
        let statics = Arc::new(Statics::new(&scene).unwrap());
        let (start, sphere) = scene.start(EpisodeId::default());
        let plan = GraspPlan::new(Timetable::default(), statics, &start, sphere).unwrap();
        let mut last = plan.wanted(0.0);
        assert_eq!(last.0, seven(&start));
        for step in 1..800 {
            let now = plan.wanted(f64::from(step) * 0.01);
            assert!((0..7).all(|i| (now.0[i] - last.0[i]).abs() < 0.03), "a jump at step {step}");
            assert!(now.1 >= last.1);
            last = now;
        }
        assert_eq!(last.1, 1.0);
    }

    #[test]
    fn the_known_postures_are_found() {
        let scene = Scene::new(Config::default()).unwrap();
        let statics = Statics::new(&scene).unwrap();
        for (place, known) in PLACES.into_iter().zip(PALM_DOWN) {
            let posture = statics.above(place, 0.075).unwrap();
            for (q, known) in posture.iter().zip(known) {
                assert!((q.to_degrees() - known).abs() < 4.0, "{} instead of {known} deg", q.to_degrees());
            }
        }
    }
}
