//! The scene of `compositional-instructions`. It contains an arm and three objects in a plane.

use farsa_body::Pose;
use farsa_body::actuators::{Law, Velocity};
use farsa_body::ports::{Actuated, ActuatorId, Arrange, BodyId, Handles, JointId, PairId};
use farsa_body::robot::{Collider, Ground, Joint, MassProperties, Robot, RobotError, Segment, Shape, Surface};
use farsa_lab::{EpisodeId, Error};
use farsa_num::{Domain, Scalar, Stream, sin_cos};
use farsa_physics::articulated::Options;

use crate::compositional_instructions::config::Config;
use crate::compositional_instructions::instruction::Color;

/// The number of no trial, by which something is drawn for all trials of a generation.
const ALL_TRIALS: u32 = (1 << 24) - 1;
/// The orders of the three colors, from left to right.
const ORDERS: [[Color; 3]; 6] = {
    use Color::{Blue as B, Green as G, Red as R};
    [[R, G, B], [R, B, G], [G, R, B], [G, B, R], [B, R, G], [B, G, R]]
};

/// Stiffness of what touches, so that a push of the arm presses surfaces together by a millimetre \[N/m\].
const STIFFNESS: f64 = 2e4;
/// Damping of what touches \[N s/m\].
const DAMPING: f64 = 40.0;
const GRAVITY: f64 = 9.81;

/// The positions of the arm and the objects at the start of a trial.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StartPose {
    /// Angles of the two joints (in radians).
    pub joints: [f64; 2],
    /// Positions of the objects in the order of their colors (in meters).
    pub objects: [[f64; 2]; 3],
}

/// The description of the robot, together with the identifiers of its parts.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Arm and objects in one description.
    pub robot: Robot,
    /// Configuration from which the scene was built.
    pub config: Config,
    /// Bodies of the objects in the order of their colors.
    pub objects: [BodyId; 3],
    /// The two sliding joints of each object.
    pub sliders: [[JointId; 2]; 3],
}

impl Scene {
    /// The first segment, to which the camera is attached.
    pub const FIRST: BodyId = BodyId(0);
    /// Second segment of the arm. It can touch the objects.
    pub const SECOND: BodyId = BodyId(1);
    /// The joint at the base and the joint between the two segments.
    pub const JOINTS: [JointId; 2] = [JointId(0), JointId(1)];
    /// Actuators of the two joints.
    pub const ACTUATORS: [ActuatorId; 2] = [ActuatorId(0), ActuatorId(1)];

    /// Builds the scene for a configuration.
    ///
    /// # Errors
    /// Returns the errors of [`Config::check`], or [`Error::Other`] if the robot cannot be simulated.
    pub fn new(config: Config) -> Result<Self, Error> {
        config.check()?;
        let wrong = |error: RobotError| Error::Other(format!("compositional-instructions: {error}"));
        let Config { arm, objects, .. } = &config;
        let height = objects.radius;
        let mut robot = Robot::new("arm and three objects");
        // The arm moves at the height of the centers of the objects, so that contacts are horizontal.
        let mut at = Pose::at([0.0, 0.0, height]);
        let mut parent = None;
        let mut shapes = Vec::new();
        for (i, name) in ["first", "second"].into_iter().enumerate() {
            let [length, mass, range] = [arm.lengths[i], arm.masses[i], arm.ranges[i].to_radians()];
            let capsule = Collider::capsule_between(name, None, [0.0; 3], [length, 0.0, 0.0], arm.radius);
            let joint = Joint::revolute(&format!("J{}", i + 1), [0.0, 0.0, 1.0], at, [-range, range]);
            let body = robot.add_segment(Segment::new(name, parent, joint, capsule.mass_properties(mass)));
            shapes.push(robot.add_collider(Collider { body: Some(body), ..capsule }));
            (parent, at) = (Some(body), Pose::at([length, 0.0, 0.0]));
        }
        for (i, joint) in Self::JOINTS.into_iter().enumerate() {
            let law = Law::Velocity(Velocity { gain: arm.gains[i], limit: arm.torques[i] });
            robot.add_actuator(&format!("M{}", i + 1), joint, law);
        }
        let surface =
            Surface { friction: objects.friction, rolling_friction: 0.0, stiffness: STIFFNESS, damping: DAMPING };
        let mut bodies = [BodyId(0); 3];
        let mut balls = [0; 3];
        for color in Color::ALL {
            let i = color.index();
            let ball = MassProperties::sphere(objects.mass, objects.radius);
            bodies[i] = robot.add_sliding_body(color.word(), Pose::at([0.0, 0.0, height]), ball, false);
            let shape = Shape::Sphere { radius: objects.radius };
            let collider =
                Collider::new(color.word(), Some(bodies[i]), shape, Pose::identity()).with_color(color.rgb());
            balls[i] = robot.add_collider(collider);
            let load = objects.mass * GRAVITY;
            robot.add_ground(Ground { body: bodies[i], friction: objects.ground_friction, load, radius: 0.0 });
            for arm in &shapes {
                robot.add_pair([balls[i], *arm], surface);
            }
        }
        for [one, other] in [[0, 1], [0, 2], [1, 2]] {
            robot.add_pair([balls[one], balls[other]], surface);
        }
        robot.validate().map_err(wrong)?;
        // A sliding body has two segments, for x and y, and its identifier is that of the second.
        let slider = |body: BodyId, before: u16| JointId(body.0 - before);
        let sliders = bodies.map(|body| [slider(body, 1), slider(body, 0)]);
        Ok(Self { robot, config, objects: bodies, sliders })
    }

    /// Returns the options of the articulated world.
    pub fn options(&self) -> Options {
        let Config { time_step, substeps, objects, .. } = self.config;
        Options { time_step, substeps, sight_height: objects.radius, ..Options::default() }
    }

    /// Returns the contact pair of an object and the second segment.
    pub fn pair_on_second(&self, color: Color) -> PairId {
        // Each color adds its pairs with the first and the second segment, before the pairs of objects.
        PairId((2 * color.index() + 1) as u16)
    }

    /// Draws the initial positions for an episode.
    ///
    /// Since all values come from the stream of [`Domain::Start`], they are the same for all individuals of a
    /// generation. The bearing and the distance of each place are drawn from left to right. They are followed by the
    /// pair of objects between which the first joint starts, its angle, and the angle and side of the second joint.
    /// Trial i uses the order i + k modulo 6 of the colors, where k depends on the generation. Six consecutive trials
    /// therefore use each order exactly once.
    pub fn start_pose(&self, id: EpisodeId) -> StartPose {
        let Config { objects, start, .. } = &self.config;
        let first = Stream::new(id.seed, Domain::Start, ALL_TRIALS, 0, id.generation).below(ORDERS.len() as u32);
        // A generation draws the first order, and six successive trials use each order once.
        let order = (u64::from(id.trial) + u64::from(first)) as usize % ORDERS.len();
        let mut stream = Stream::new(id.seed, Domain::Start, id.trial, 0, id.generation);
        let mut around = |middle: f64, spread: f64| stream.range_f64(middle - spread, middle + spread);
        let mut places = [[0.0; 2]; 3];
        for (color, bearing) in ORDERS[order].into_iter().zip(objects.bearings) {
            let angle = around(bearing, objects.bearing_spread).to_radians();
            let distance = around(objects.distance, objects.distance_spread);
            let (sine, cosine) = sin_cos(angle);
            places[color.index()] = [distance * cosine, distance * sine];
        }
        let [left, middle, right] = objects.bearings;
        let between = if stream.below(2) == 0 { [left, middle] } else { [middle, right] };
        let mut around = |middle: f64, spread: f64| stream.range_f64(middle - spread, middle + spread);
        let first = around(0.5 * (between[0] + between[1]), start.first_spread);
        let second = around(start.second, start.second_spread);
        // Drawn last, so that the other draws are the same with and without it.
        let side = if !start.both_sides || stream.below(2) == 0 { 1.0 } else { -1.0 };
        StartPose { joints: [first.to_radians(), side * second.to_radians()], objects: places }
    }

    /// Moves everything to the given positions, at rest.
    pub fn arrange<W>(&self, world: &mut W, start: &StartPose)
    where
        W: Arrange + Actuated + Handles<Joint = JointId> + ?Sized,
    {
        world.clear();
        for (joint, angle) in Self::JOINTS.into_iter().zip(start.joints) {
            world.place_joint(joint, angle as f32, 0.0);
        }
        for (sliders, place) in self.sliders.into_iter().zip(start.objects) {
            for (slider, x) in sliders.into_iter().zip(place) {
                world.place_joint(slider, x as f32, 0.0);
            }
        }
        world.finish_placement();
    }

    /// The distance between two points \[m\].
    pub(crate) fn distance([x, y]: [f64; 2], [u, v]: [f64; 2]) -> f64 {
        Scalar::sqrt((x - u) * (x - u) + (y - v) * (y - v))
    }
}
