//! A handwritten controller. It demonstrates that the task can be solved with the motors of the evolved agents.

use farsa_body::Pose;
use farsa_body::actuators::Law;
use farsa_body::kinematics::{Goal, InverseKinematics, KinematicTree, Orientation};
use farsa_body::robot::Robot;
use farsa_body::robots::{Chain, Icub, Side};
use farsa_lab::Error;
use farsa_num::sin_cos;

use crate::icub_reach_grasp::config::{MOTORS, SENSORS};
use crate::icub_reach_grasp::episode::Grasper;
use crate::icub_reach_grasp::motors::CONTROLLED;
use crate::icub_reach_grasp::scene::{Scene, wrong};
use crate::smooth::smooth;

/// Downward pitch of the palm as it approaches from above and from the right \[deg\].
const DOWN: f64 = 60.0;
/// Turns of the palm's direction about the vertical, from the left. The first one in reach of inverse kinematics is
/// taken \[deg\].
const TURNS: [f64; 6] = [40.0, 20.0, 0.0, -20.0, -40.0, -60.0];
/// Distance of the ball ahead of the palm's center, towards the fingertips \[m\].
const AHEAD: f64 = 0.015;
/// Distance of the palm from the ball before the approach, and its height above the way \[m\].
const BEFORE: [f64; 2] = [0.07, 0.02];
/// Height of the lift \[m\].
const LIFT: f64 = 0.14;
/// When each posture is reached, closing begins and ends, and lifting begins and ends \[s\].
const TIMES: [f64; 6] = [2.5, 4.5, 4.6, 5.8, 6.5, 9.0];
const GRAVITY: [f64; 3] = [0.0, 0.0, -9.81];

/// Angles of the nine joints \[rad\].
type Angles = [f64; 9];

/// A controller that reaches for a ball at a given position, closes the hand and lifts the ball. It does not use any
/// sensors.
///
/// The joint angles of the trunk and the arm are computed with inverse kinematics. The script adds a correction for the
/// deflection of the servos under gravity.
#[derive(Clone, Debug)]
pub struct Script {
    tree: KinematicTree,
    palm_centre: [f64; 3],
    ball_radius: f64,
    time_step: f64,
    start: Angles,
    ranges: [[f64; 2]; 9],
    stiffness: Angles,
    poses: Vec<Pose<f64>>,
    /// Before the ball, at it, lifted.
    postures: [Angles; 3],
    found: bool,
    step: u32,
}

impl Script {
    /// Creates a script for a scene.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if the kinematics of the robot cannot be computed.
    pub fn new(scene: &Scene) -> Result<Self, Error> {
        let tree = KinematicTree::new(&arm(scene)?).map_err(|error| wrong(&error))?;
        let (mut start, mut ranges, mut stiffness) = ([0.0; 9], [[0.0; 2]; 9], [0.0; 9]);
        let posture = scene.icub.start();
        for (i, name) in CONTROLLED.into_iter().enumerate() {
            let actuator = scene.actuator(name)?.index();
            (start[i], ranges[i]) = (posture[actuator], scene.range(name)?);
            stiffness[i] = match scene.robot.actuators[actuator].law {
                Law::Servo(servo) => servo.stiffness,
                _ => f64::INFINITY,
            };
        }
        Ok(Self {
            poses: Vec::with_capacity(tree.bodies()),
            tree,
            palm_centre: scene.icub.palm_centre(Side::Right),
            ball_radius: scene.config.ball_radius,
            time_step: scene.config.time_step,
            start,
            ranges,
            stiffness,
            postures: [start; 3],
            found: false,
            step: 0,
        })
    }

    /// Returns true if the script has found postures for the ball of the current trial. Otherwise the robot does not
    /// move.
    pub fn has_found(&self) -> bool {
        self.found
    }

    /// The postures before a ball, at it and lifted, with the palm looking along `normal`.
    fn plan(&self, ball: [f64; 3], normal: [f64; 3]) -> Option<[Angles; 3]> {
        let solver = InverseKinematics {
            position_tolerance: 2e-3,
            angle_tolerance: 0.15,
            attempts: 8,
            iterations: 80,
            ..InverseKinematics::default()
        };
        let solve = |position: [f64; 3], from: &Angles| -> Option<Angles> {
            let orientation = Orientation::Direction { own: Icub::PALM_NORMAL, wanted: normal };
            let goal = Goal { body: Scene::PALM, point: self.palm_centre, position, orientation };
            let posture = solver.solve(&self.tree, &goal, from).ok()?;
            posture.joints.try_into().ok()
        };
        let place = |gap: f64, above: f64, fingers: [f64; 3]| {
            // The palm is a radius and a gap behind the ball along its normal, and AHEAD m back along the fingers.
            let mut place = [0, 1, 2].map(|k| ball[k] - normal[k] * (self.ball_radius + gap) - AHEAD * fingers[k]);
            place[2] += above;
            place
        };
        // The first posture gives the direction of the fingers.
        // Here the direction of the fingers is still unknown, so they are left out.
        let first = solve(place(BEFORE[0], BEFORE[1], [0.0; 3]), &self.start)?;
        let fingers = self.tree.poses(&first)[Scene::PALM.index()].rotate([1.0, 0.0, 0.0]);
        // Each solution starts from the previous one, so that no joint changes to another branch.
        let before = solve(place(BEFORE[0], BEFORE[1], fingers), &first)?;
        let at = solve(place(0.0, 0.0, fingers), &before)?;
        let lifted = solve(place(0.0, LIFT, fingers), &at)?;
        Some([before, at, lifted])
    }

    /// The target posture at a time \[s\].
    fn wanted(&self, time: f64) -> Angles {
        let [before, near, _, _, lift, up] = TIMES;
        let [first, at, lifted] = &self.postures;
        let (from, to, share) = if time < before {
            (&self.start, first, time / before)
        } else if time < lift {
            (first, at, (time - before) / (near - before))
        } else {
            (at, lifted, (time - lift) / (up - lift))
        };
        let share = smooth(share);
        core::array::from_fn(|i| from[i] + (to[i] - from[i]) * share)
    }
}

/// The robot with the nine joints alone: all others are fixed.
fn arm(scene: &Scene) -> Result<Robot, Error> {
    let icub = Icub { actuated: vec![Chain::Torso, Chain::RightArm], ..scene.icub.clone() };
    let mut robot = icub.robot().map_err(|error| wrong(&error))?;
    robot.actuators.clear();
    robot.pairs.clear();
    let roll = scene.joint("torso_roll")?.index();
    let joint = &mut robot.segments[roll].joint;
    // No channel drives the roll of the torso, so the solver must not use it.
    *joint = joint.locked(scene.config.torso[1].to_radians());
    Ok(robot)
}

impl Grasper for Script {
    fn start(&mut self, ball: [f64; 3]) {
        let (sine, cosine) = sin_cos(DOWN.to_radians());
        let plan = TURNS.into_iter().find_map(|turn| {
            let (across, along) = sin_cos(turn.to_radians());
            // A unit vector that points down by DOWN degrees, turned about the vertical.
            self.plan(ball, [-across * cosine, along * cosine, -sine])
        });
        self.found = plan.is_some();
        self.postures = plan.unwrap_or([self.start; 3]);
        self.step = 0;
    }

    fn step(&mut self, _: &[f32; SENSORS], y: &mut [f32; MOTORS]) {
        let time = f64::from(self.step) * self.time_step;
        self.step += 1;
        let wanted = self.wanted(time);
        self.tree.poses_into(&wanted, &mut self.poses);
        let gravity = self.tree.gravity_torques(&self.poses, GRAVITY);
        for (i, [low, high]) in self.ranges.into_iter().enumerate() {
            // A servo of stiffness k sags by g / k under the gravity torque g. The command is ahead by this angle.
            let angle = wanted[i] + gravity[i] / self.stiffness[i];
            y[i] = ((angle - low) / (high - low)).clamp(0.0, 1.0) as f32;
        }
        let [_, _, from, to, _, _] = TIMES;
        let closed = if self.found { ((time - from) / (to - from)).clamp(0.0, 1.0) } else { 0.0 };
        y[MOTORS - 1] = closed as f32;
    }
}
