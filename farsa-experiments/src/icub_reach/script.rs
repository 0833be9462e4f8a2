//! A handwritten controller. It demonstrates that all targets can be reached with six joints.

use farsa_body::Pose;
use farsa_body::kinematics::{Goal, InverseKinematics, InverseKinematicsError, KinematicTree, Orientation};
use farsa_lab::Error;

use crate::icub_reach::config::{Condition, Config};
use crate::icub_reach::episode::Reacher;
use crate::icub_reach::scene::Scene;

/// Speed of the hand per meter of distance from the target \[1/s\].
const RATE: f64 = 3.0;
/// Damping of the least squares \[m\].
const DAMPING: f64 = 0.03;
/// A joint so near to a limit moves no farther \[rad\].
const NEAR: f64 = 0.01;
const GRAVITY: [f64; 3] = [0.0, 0.0, -9.81];

/// A controller based on the kinematics of the robot.
///
/// With the condition `steady`, it computes the joint angles with inverse kinematics and compensates for the deflection
/// of the servos under gravity. With `velocity`, it moves toward the target by damped least squares \[Wampler1986\] and
/// uses the measured joint angles.
#[derive(Clone, Debug)]
pub struct Script {
    config: Config,
    tree: KinematicTree,
    palm_centre: [f64; 3],
    start: [f64; 6],
    ranges: [[f64; 2]; 6],
    stiffness: [f64; 6],
    poses: Vec<Pose<f64>>,
    /// Inputs for which the joint angles were computed, with the resulting motor values.
    found: Option<([f32; 3], [f32; 6])>,
}

impl Script {
    /// Creates a script for a scene.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if the kinematics of the robot cannot be computed.
    pub fn new(scene: &Scene) -> Result<Self, Error> {
        let tree = scene.kinematics().map_err(|error| Error::Other(format!("icub-reach: {error}")))?;
        let stiffness = scene.controlled.map(|driven| match scene.robot.actuators[driven.actuator.index()].law {
            farsa_body::actuators::Law::Servo(servo) => servo.stiffness,
            _ => f64::INFINITY,
        });
        let poses = Vec::with_capacity(tree.bodies());
        let (ranges, start, palm_centre) = (scene.ranges(), scene.start(), scene.palm_centre);
        Ok(Self { config: scene.config, tree, palm_centre, start, ranges, stiffness, poses, found: None })
    }

    /// Computes joint angles that move the hand to the given position (in meters). Among all solutions, angles close to
    /// the initial posture are preferred.
    ///
    /// # Errors
    /// Returns [`InverseKinematicsError::NotReached`] with the closest solution if the position is out of reach.
    pub fn angles(&self, place: [f64; 3]) -> Result<[f64; 6], InverseKinematicsError> {
        let goal = Goal { body: Scene::PALM, point: self.palm_centre, position: place, orientation: Orientation::Free };
        let posture = InverseKinematics::default().solve(&self.tree, &goal, &self.start)?;
        Ok(core::array::from_fn(|i| posture.joints[i]))
    }

    fn steady(&mut self, x: &[f32; 3]) -> [f32; 6] {
        let target = [0, 1, 2].map(|k| {
            let [low, high] = self.config.volume.ends(k);
            low + (high - low) * f64::from(x[k])
        });
        let angles = match self.angles(target) {
            Ok(angles) => angles,
            Err(InverseKinematicsError::NotReached { closest }) => core::array::from_fn(|i| closest.joints[i]),
            Err(_) => self.start,
        };
        self.tree.poses_into(&angles, &mut self.poses);
        let gravity = self.tree.gravity_torques(&self.poses, GRAVITY);
        core::array::from_fn(|i| {
            let [low, high] = self.ranges[i];
            // A servo of stiffness k sags by g / k under the gravity torque g. The command is ahead by this angle.
            ((angles[i] + gravity[i] / self.stiffness[i] - low) / (high - low)).clamp(0.0, 1.0) as f32
        })
    }

    fn velocity(&mut self, x: &[f32; 3], joints: &[f32; 6]) -> [f32; 6] {
        let wanted = x.map(|x| RATE * f64::from(x) * self.config.offset);
        let q = joints.map(f64::from);
        self.tree.poses_into(&q, &mut self.poses);
        let jacobian = self.tree.jacobian(&self.poses, Scene::PALM, self.palm_centre);
        let mut free = [true; 6];
        let mut speeds = [0.0; 6];
        // At most one joint more is at its limit each time.
        for _ in 0..=6 {
            // Rows 3 to 5 of the Jacobian are linear velocities. A joint at its limit has a zero column.
            let columns: [[f64; 3]; 6] =
                core::array::from_fn(
                    |i| {
                        if free[i] { [jacobian[i][3], jacobian[i][4], jacobian[i][5]] } else { [0.0; 3] }
                    },
                );
            // q' = J^T (J J^T + damping^2 1)^-1 v.
            let mut square = [[0.0; 3]; 3];
            for a in 0..3 {
                for b in 0..3 {
                    square[a][b] = columns
                        .iter()
                        .fold(if a == b { DAMPING * DAMPING } else { 0.0 }, |sum, column| sum + column[a] * column[b]);
                }
            }
            // z = (J J^T + damping^2 1)^-1 v [Wampler1986]. The damping keeps the matrix regular.
            let z = solve(square, wanted);
            speeds = columns.map(|column| (0..3).fold(0.0, |sum, k| sum + column[k] * z[k]));
            let out = |i: usize| {
                let [low, high] = self.ranges[i];
                free[i] && (q[i] < low + NEAR && speeds[i] < 0.0 || q[i] > high - NEAR && speeds[i] > 0.0)
            };
            match (0..6).find(|i| out(*i)) {
                Some(i) => free[i] = false,
                None => break,
            }
        }
        // One scale for all joints keeps the direction of the hand's velocity.
        let fastest = speeds.iter().fold(self.config.speed, |most, speed| most.max(speed.abs()));
        speeds.map(|speed| (0.5 + 0.5 * speed / fastest) as f32)
    }
}

/// Solves a 3 by 3 system by Cramer's rule.
fn solve(a: [[f64; 3]; 3], b: [f64; 3]) -> [f64; 3] {
    let cross =
        |u: [f64; 3], v: [f64; 3]| [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let dot = |u: [f64; 3], v: [f64; 3]| u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
    let column = |k: usize| [a[0][k], a[1][k], a[2][k]];
    let [u, v, w] = [0, 1, 2].map(column);
    let whole = dot(u, cross(v, w));
    // Cramer's rule, with determinants as triple products of columns.
    [dot(b, cross(v, w)) / whole, dot(u, cross(b, w)) / whole, dot(u, cross(v, b)) / whole]
}

impl Reacher for Script {
    fn reset(&mut self) {
        self.found = None;
    }

    fn step(&mut self, x: &[f32; 3], joints: &[f32; 6], y: &mut [f32; 6]) {
        *y = match (self.config.condition, self.found) {
            (Condition::Velocity, _) => self.velocity(x, joints),
            // The solution depends only on the input, so it is computed again only for another target.
            (Condition::Steady, Some((sensed, motors))) if sensed == *x => motors,
            (Condition::Steady, _) => {
                let motors = self.steady(x);
                self.found = Some((*x, motors));
                motors
            }
        };
    }
}
