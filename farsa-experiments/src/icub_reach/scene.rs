//! The scene of `icub-reach`. It contains the robot, its controlled joints and the targets.

use farsa_body::actuators::{Law, Torque};
use farsa_body::kinematics::KinematicTree;
use farsa_body::ports::{Actuated, ActuatorId, Arrange, BodyId, Handles, JointId, Kinematics};
use farsa_body::robot::{Actuator, JointKind, Robot, RobotError};
use farsa_body::robots::{Icub, IcubError, Side};
use farsa_lab::{EpisodeId, Error};
use farsa_num::{Domain, Scalar, Stream};
use farsa_physics::articulated::Options;

use crate::icub_reach::config::{Condition, Config};

/// Names of the joints controlled by the network, in the order of its outputs.
pub const CONTROLLED: [&str; 6] =
    ["torso_pitch", "torso_yaw", "l_shoulder_pitch", "l_shoulder_roll", "l_shoulder_yaw", "l_elbow"];

/// Acceleration of gravity \[m/s^2\].
const GRAVITY: f64 = 9.81;
/// The most that a load may turn a joint by \[N m\].
const LARGEST_TORQUE: f64 = 1000.0;

/// A joint with its actuator and what it is held at or moves between.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Driven {
    pub(crate) joint: JointId,
    pub(crate) actuator: ActuatorId,
    /// Its angle at the start \[rad\].
    pub(crate) start: f64,
    /// Its limits \[rad\].
    pub(crate) range: [f64; 2],
}

/// A joint that carries the hand, with the torque motor through which a load acts on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Burdened {
    body: BodyId,
    /// Its axis in the body's frame, of unit length.
    axis: [f64; 3],
    actuator: ActuatorId,
}

/// The description of the robot, together with the identifiers of its parts.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Robot that is simulated.
    pub robot: Robot,
    /// Configuration from which the scene was built.
    pub config: Config,
    /// Center of the palm in the frame of the hand (in meters).
    pub palm_centre: [f64; 3],
    pub(crate) controlled: [Driven; 6],
    pub(crate) held: Vec<Driven>,
    pub(crate) burdened: Vec<Burdened>,
}

impl Scene {
    /// The last body of the arm. It carries the palm.
    pub const PALM: BodyId = BodyId(12);

    /// Builds the scene for a configuration.
    ///
    /// # Errors
    /// Returns the errors of [`Config::check`], or [`Error::Other`] if the robot cannot be simulated.
    pub fn new(config: Config) -> Result<Self, Error> {
        config.check()?;
        let wrong = |error: IcubError| Error::Other(format!("icub-reach: {error}"));
        let icub = config.icub();
        let mut robot = icub.robot().map_err(wrong)?;
        let burdened = Self::burden(&mut robot);
        let driven = |(joint, start): (JointId, f64)| -> Result<Driven, Error> {
            let joint_of = &robot.segments[joint.index()].joint;
            let actuator = icub.actuator(&joint_of.name).map_err(wrong)?;
            Ok(Driven { joint, actuator, start, range: joint_of.range })
        };
        let joints: Vec<Driven> = robot.joints().zip(icub.start()).map(driven).collect::<Result<_, _>>()?;
        let is_controlled =
            |driven: &Driven| CONTROLLED.contains(&robot.segments[driven.joint.index()].joint.name.as_str());
        let (controlled, held): (Vec<Driven>, Vec<Driven>) = joints.into_iter().partition(is_controlled);
        let controlled = controlled
            .try_into()
            .map_err(|joints: Vec<Driven>| Error::Other(format!("icub-reach: {} joints, not 6", joints.len())))?;
        let palm_centre = icub.palm_centre(Side::Left);
        debug_assert_eq!(Self::PALM, Icub::palm(Side::Left));
        Ok(Self { robot, config, palm_centre, controlled, held, burdened })
    }

    /// Adds a torque motor to each joint that carries the hand, from the hand's body to the root.
    fn burden(robot: &mut Robot) -> Vec<Burdened> {
        let mut burdened = Vec::new();
        let mut next = Some(Self::PALM);
        // Only joints between the palm and the root carry the load.
        while let Some(body) = next {
            let segment = &robot.segments[body.index()];
            next = segment.parent;
            if segment.joint.kind != JointKind::Revolute {
                continue;
            }
            let length = Scalar::sqrt(segment.joint.axis.iter().fold(0.0, |sum: f64, x| sum + x * x));
            let axis = segment.joint.axis.map(|x| x / length);
            let name = format!("load on {}", segment.joint.name);
            let law = Law::Torque(Torque { limit: LARGEST_TORQUE });
            burdened.push(Burdened { body, axis, actuator: ActuatorId(robot.actuators.len() as u16) });
            robot.actuators.push(Actuator { name, joint: JointId(body.0), law, command_range: None });
        }
        burdened
    }

    /// The robot without the motors of a load.
    pub(crate) fn bare_robot(&self) -> Robot {
        let mut robot = self.robot.clone();
        robot.actuators.truncate(robot.actuators.len() - self.burdened.len());
        robot
    }

    /// Commands the torques of a weight at the palm's center, `mass` \[kg\], until the next command.
    ///
    /// A force F at the point p turns a joint at o about the unit axis a by a . (p - o) x F. Inertia of the load is
    /// left out.
    pub(crate) fn hang<W>(&self, world: &mut W, hand: [f64; 3], mass: f64)
    where
        W: Kinematics + Actuated + Handles<Body = BodyId, Actuator = ActuatorId> + ?Sized,
    {
        // tau = a . (r x F) for each joint, with its axis a and the vector r from the joint to the hand.
        for Burdened { body, axis, actuator } in &self.burdened {
            let pose = world.pose(*body).cast::<f64>();
            let [x, y, _] = [0, 1, 2].map(|k| hand[k] - pose.position[k]);
            let [a, b, _] = pose.rotate(*axis);
            // (x, y, z) x (0, 0, -w) = (-y w, x w, 0).
            world.command(*actuator, [((b * x - a * y) * mass * GRAVITY) as f32, 0.0]);
        }
    }

    /// Returns the options of the articulated world.
    pub fn options(&self) -> Options {
        let Config { time_step, substeps, .. } = self.config;
        Options { time_step, substeps, ..Options::default() }
    }

    /// Returns the lower and upper limits of the six joints (in radians).
    pub fn ranges(&self) -> [[f64; 2]; 6] {
        self.controlled.map(|driven| driven.range)
    }

    /// Returns the initial angles of the six joints in radians.
    pub fn start(&self) -> [f64; 6] {
        self.controlled.map(|driven| driven.start)
    }

    /// Returns a kinematic tree in which only the six controlled joints can move. All other joints are fixed at their
    /// initial angles.
    ///
    /// # Errors
    /// Returns the errors of [`KinematicTree::new`].
    pub fn kinematics(&self) -> Result<KinematicTree, RobotError> {
        let mut robot = Robot { actuators: Vec::new(), pairs: Vec::new(), ..self.robot.clone() };
        for Driven { joint, start, .. } in &self.held {
            let joint = &mut robot.segments[joint.index()].joint;
            *joint = joint.locked(*start);
        }
        KinematicTree::new(&robot)
    }

    /// Draws the position of the target (in meters) from the stream of [`Domain::Start`]. The position is uniformly
    /// distributed in the volume and the same for all individuals of a generation.
    pub fn target(&self, id: EpisodeId) -> [f64; 3] {
        self.draw(&mut self.stream(id))
    }

    /// Draws two independent targets for a trial (in meters). Both are uniformly distributed in the volume.
    pub fn two_targets(&self, id: EpisodeId) -> [[f64; 3]; 2] {
        let mut stream = self.stream(id);
        [self.draw(&mut stream), self.draw(&mut stream)]
    }

    fn stream(&self, id: EpisodeId) -> Stream {
        // Individual 0 below makes the targets equal for all individuals of a generation.
        let generation = if self.config.same_targets { 0 } else { id.generation };
        Stream::new(id.seed, Domain::Start, id.trial, 0, generation)
    }

    /// By rejection from the half ellipsoid's box. Half of the points are in it.
    fn draw(&self, stream: &mut Stream) -> [f64; 3] {
        loop {
            // Rejection gives uniform draws in the half ball x >= 0. It accepts a share of pi / 6.
            let parts = [stream.range_f64(0.0, 1.0), stream.range_f64(-1.0, 1.0), stream.range_f64(-1.0, 1.0)];
            if parts.iter().fold(0.0, |sum, x| sum + x * x) <= 1.0 {
                return self.config.volume.at(parts);
            }
        }
    }

    /// Moves the robot to its initial posture, at rest. The commands are set such that it stays there.
    pub fn arrange<W>(&self, world: &mut W)
    where
        W: Arrange + Actuated + Handles<Joint = JointId, Actuator = ActuatorId> + ?Sized,
    {
        world.clear();
        let steady = self.config.condition == Condition::Steady;
        for one in self.controlled.iter().chain(&self.held) {
            world.place_joint(one.joint, one.start as f32, 0.0);
            world.command(one.actuator, [if steady { one.start as f32 } else { 0.0 }, 0.0]);
        }
        world.finish_placement();
    }

    /// The distance between two points \[m\].
    pub(crate) fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
        let [x, y, z] = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
        Scalar::sqrt(x * x + y * y + z * z)
    }
}
