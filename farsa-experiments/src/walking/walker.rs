//! A biped with two stiff pairs of legs. The simplest walking model is a limit of this rigid body.

use farsa_body::Pose;
use farsa_body::actuators::{Law, Torque};
use farsa_body::ports::{ActuatorId, BodyId, JointId, PairId};
use farsa_body::robot::{Collider, Joint, MassProperties, Robot, Segment, Shape, Surface};
use farsa_num::{Scalar, sin_cos};

/// Half the thickness of legs and of the hip's axle. Only their own small inertia depends on it \[m\].
const THIN: f64 = 0.01;
/// Distance of a withdrawn plate to the side, and half its width \[m\].
pub(crate) const ASIDE: f64 = 8.0;
const WIDTH: f64 = 1.0;
/// Half the length of a plate, and half its thickness \[m\].
const LENGTH: f64 = 1000.0;
const THICKNESS: f64 = 0.5;
/// Mass of the rail that guides the hip, in hips.
const RAIL: f64 = 1e-9;

/// A pair of legs that are rigidly connected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Legs {
    /// Distance from the hip to the sole in meters.
    pub length: f64,
    /// Mass of the shanks (in kilograms). It is uniformly distributed between hip and sole.
    pub mass: f64,
    /// Mass at the sole (in kilograms).
    pub foot_mass: f64,
    /// Radius of the round sole (in meters). Its center is on the leg.
    pub foot_radius: f64,
}

/// A walker that consists of two stiff pairs of legs on a common axle.
///
/// In its frame, x points ahead, y to the left and z along the normal of the ground. The outer and the inner pair keep
/// each other upright sideways, so the walker only moves in the x-z plane. This plane is enforced by joints. The hip
/// slides along x and z without friction, the outer legs rotate about it, and the inner legs rotate relative to the
/// outer legs. A slope is represented by tilted gravity (see [`Walker::gravity`]).
///
/// Stiff legs cannot clear the ground when they pass each other. Therefore each pair has a separate ground plate that
/// can be moved aside while the pair swings. The plates slide perpendicular to the plane of motion. They are not
/// affected by the forces of the walk, and their weight has no effect.
///
/// Source: `[McGeer1990]` describes such a machine with round feet, and `[Garcia1998]` its limit for massless point
/// feet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Walker {
    /// Outer and inner legs.
    pub legs: [Legs; 2],
    /// Mass at the hip (in kilograms).
    pub hip_mass: f64,
    /// Distance between the outer feet (in meters). The distance between the inner feet is half as large. It is
    /// used in drawings and does not affect the motion in the plane.
    pub hip_spacing: f64,
    /// Coefficient of friction between the feet and the ground.
    pub friction: f64,
    /// Stiffness of the contact between a foot and the ground (in N/m).
    pub stiffness: f64,
    /// Damping ratio of this contact for the mass of the entire walker.
    pub damping_ratio: f64,
    /// Largest angle between the inner and the outer legs, in both directions (in radians).
    pub hip_range: f64,
    /// Largest torque of the motor at the hip (in newton meters). A value of 0 removes the motor.
    pub torque: f64,
}

/// The identifiers of the parts of a walker.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WalkerParts {
    /// Joints that move the hip along x and z.
    pub slides: [JointId; 2],
    /// The joint of the hip and the outer legs and the joint of the outer and the inner legs. A positive
    /// angle moves the foot back.
    pub hinges: [JointId; 2],
    /// Joints of the ground plates for the outer and the inner legs.
    pub plates: [JointId; 2],
    /// Contact pairs of the outer and the inner feet.
    pub soles: [PairId; 2],
    /// Body of the hip.
    pub hip: BodyId,
    /// Bodies of the outer and the inner legs.
    pub legs: [BodyId; 2],
    /// Motor at the hip, or `None` for a passive walker.
    pub motor: Option<ActuatorId>,
}

impl Default for Walker {
    /// Returns a walker that is close to the simplest walking model. Its legs are 1 m long, with 10 kg at the hip, and
    /// its feet have a mass of 10 g and a radius of 0.1 mm.
    fn default() -> Self {
        let legs = Legs { length: 1.0, mass: 0.0, foot_mass: 0.01, foot_radius: 1e-4 };
        Self {
            legs: [legs; 2],
            hip_mass: 10.0,
            hip_spacing: 0.3,
            friction: 1.0,
            stiffness: 1e6,
            damping_ratio: 1.0,
            hip_range: 1.5,
            torque: 0.0,
        }
    }
}

impl Legs {
    /// Mass, center and inertia in the frame of the hip's axle, the legs pointing down.
    fn body(&self) -> MassProperties {
        let at = |z: f64| Pose::at([0.0, 0.0, z]);
        let foot = MassProperties::sphere(self.foot_mass, THIN * self.length).placed(&at(-self.length));
        let shank = MassProperties::cylinder(self.mass, THIN * self.length, 0.5 * self.length);
        foot.with(&shank.placed(&at(-0.5 * self.length)))
    }

    /// The sole's center and its lowest point, seen from the hip, with the leg turned back by an angle \[rad\]. Returns
    /// x and z of the center, and z of the lowest point \[m\].
    pub(crate) fn sole(&self, angle: f64) -> [f64; 3] {
        let (sine, cosine) = sin_cos(angle);
        let arm = self.length - self.foot_radius;
        [-arm * sine, -arm * cosine, -arm * cosine - self.foot_radius]
    }
}

impl Walker {
    /// Computes the total mass (in kilograms).
    pub fn mass(&self) -> f64 {
        self.hip_mass + self.legs.iter().map(|legs| legs.mass + legs.foot_mass).sum::<f64>()
    }

    /// Returns the gravity vector (in m/s2) of the given magnitude in the frame of a slope. It descends along x at the
    /// given angle (in radians).
    pub fn gravity(size: f64, slope: f64) -> [f64; 3] {
        let (sine, cosine) = sin_cos(slope);
        // Axis x points down the slope, and z is its normal. Walking ahead is walking down.
        [size * sine, 0.0, -size * cosine]
    }

    /// Builds the description of the walker and its ground plates, and returns the identifiers of its parts.
    pub fn robot(&self) -> (Robot, WalkerParts) {
        let everywhere = [f64::NEG_INFINITY, f64::INFINITY];
        let mut robot = Robot::new("walker");
        let axle = MassProperties::cuboid(self.hip_mass, [THIN, 0.5 * self.hip_spacing.max(THIN), THIN]);
        // Two slides in series need a body between them. Its mass is a billionth of the hip's.
        let rail = MassProperties::sphere(RAIL * self.hip_mass, THIN);
        let slide = |name: &str, axis| Joint::prismatic(name, axis, Pose::identity(), everywhere);
        let guide = robot.add_segment(Segment::new("rail", None, slide("forward", [1.0, 0.0, 0.0]), rail));
        let hip = robot.add_segment(Segment::new("hip", Some(guide), slide("up", [0.0, 0.0, 1.0]), axle));
        let hinge = |name: &str, range| Joint::revolute(name, [0.0, 1.0, 0.0], Pose::identity(), range);
        let outer = Segment::new("outer legs", Some(hip), hinge("outer hinge", everywhere), self.legs[0].body());
        let outer = robot.add_segment(outer);
        let between = [-self.hip_range, self.hip_range];
        let inner = Segment::new("inner legs", Some(outer), hinge("inner hinge", between), self.legs[1].body());
        let inner = robot.add_segment(inner);
        let surface = Surface {
            friction: self.friction,
            rolling_friction: 0.0,
            stiffness: self.stiffness,
            // c = 2 zeta sqrt(k m), with the mass of the complete walker on one sole.
            damping: 2.0 * self.damping_ratio * Scalar::sqrt(self.stiffness * self.mass()),
        };
        let mut plates = [JointId(0); 2];
        let mut soles = [PairId(0); 2];
        for (i, (name, body)) in [("outer", outer), ("inner", inner)].into_iter().enumerate() {
            let half = [LENGTH, WIDTH, THICKNESS];
            let joint = slide(&format!("{name} plate aside"), [0.0, 1.0, 0.0]);
            let plate = MassProperties::sphere(1.0, 0.1);
            let plate = robot.add_segment(Segment::new(&format!("{name} plate"), None, joint, plate));
            plates[i] = JointId(plate.0);
            let legs = &self.legs[i];
            // The half height is THICKNESS, so the surface of the plate is at z = 0.
            let below = Pose::at([0.0, 0.0, -THICKNESS]);
            let ground = Collider::new(&format!("{name} ground"), Some(plate), Shape::Box { half }, below);
            let centre = Pose::at([0.0, 0.0, legs.foot_radius - legs.length]);
            let sole = Shape::Sphere { radius: legs.foot_radius };
            let sole = Collider::new(&format!("{name} sole"), Some(body), sole, centre);
            let pair = [robot.add_collider(sole), robot.add_collider(ground)];
            soles[i] = robot.add_pair(pair, surface);
        }
        let motor = (self.torque > 0.0)
            .then(|| robot.add_actuator("hip motor", JointId(inner.0), Law::Torque(Torque { limit: self.torque })));
        let joint = |body: BodyId| JointId(body.0);
        let parts = WalkerParts {
            slides: [joint(guide), joint(hip)],
            hinges: [joint(outer), joint(inner)],
            plates,
            soles,
            hip,
            legs: [outer, inner],
            motor,
        };
        (robot, parts)
    }

    /// Computes the sum of the kinetic and the potential energy of a [`Posture`] under the given gravity (in joules).
    pub fn energy(&self, posture: &Posture, gravity: [f64; 3]) -> f64 {
        let mut energy = 0.0;
        let mut add = |mass: f64, [x, z]: [f64; 2], [u, w]: [f64; 2]| {
            // m v^2 / 2 - m g . p, with gravity in the axes of the slope.
            energy += 0.5 * mass * (u * u + w * w) - mass * (gravity[0] * x + gravity[2] * z);
        };
        add(self.hip_mass, posture.hip, posture.velocity);
        // The rail slides along x only.
        add(RAIL * self.hip_mass, [posture.hip[0], 0.0], [posture.velocity[0], 0.0]);
        let mut turning = 0.0;
        for (i, legs) in self.legs.iter().enumerate() {
            let body = legs.body();
            let (sine, cosine) = sin_cos(posture.angles[i]);
            let (arm, rate) = (-body.centre[2], posture.rates[i]);
            let [x, z] = [-arm * sine, -arm * cosine];
            // A rotation about +y moves a point at (x, z) from the hip with (rate z, -rate x).
            let velocity = [posture.velocity[0] + rate * z, posture.velocity[1] - rate * x];
            add(body.mass, [posture.hip[0] + x, posture.hip[1] + z], velocity);
            // I w^2 / 2 about the center of mass, where only y is an axis of rotation.
            turning += 0.5 * body.inertia[1] * rate * rate;
        }
        energy + turning
    }
}

/// The position and the velocity of a walker in its plane.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Posture {
    /// X and z coordinates of the hip (in meters).
    pub hip: [f64; 2],
    /// Velocity of the hip (in meters per second).
    pub velocity: [f64; 2],
    /// Backward rotation of the outer and the inner legs from the normal of the ground (in radians).
    pub angles: [f64; 2],
    /// Angular velocities of the legs, in radians per second.
    pub rates: [f64; 2],
}

impl Posture {
    /// Reads the posture of the walker from a world.
    pub fn from_world<W>(world: &W, parts: &WalkerParts) -> Self
    where
        W: farsa_body::ports::Joints<Joint = JointId> + ?Sized,
    {
        let at = |joint| f64::from(world.position(joint));
        let speed = |joint| f64::from(world.speed(joint));
        let (outer, rate) = (at(parts.hinges[0]), speed(parts.hinges[0]));
        Self {
            hip: parts.slides.map(at),
            velocity: parts.slides.map(speed),
            // The inner hinge turns relative to the outer legs. Angles of a posture are relative to the slope's normal.
            angles: [outer, outer + at(parts.hinges[1])],
            rates: [rate, rate + speed(parts.hinges[1])],
        }
    }

    /// Sets the posture of the walker in a world.
    /// [`Arrange::finish_placement`](farsa_body::ports::Arrange::finish_placement) must be called afterwards.
    pub fn place<W>(&self, world: &mut W, parts: &WalkerParts)
    where
        W: farsa_body::ports::Arrange<Joint = JointId> + ?Sized,
    {
        for k in 0..2 {
            world.place_joint(parts.slides[k], self.hip[k] as f32, self.velocity[k] as f32);
        }
        let [outer, inner] = self.angles;
        let [rate, inner_rate] = self.rates;
        world.place_joint(parts.hinges[0], outer as f32, rate as f32);
        world.place_joint(parts.hinges[1], (inner - outer) as f32, (inner_rate - rate) as f32);
    }

    /// Returns the posture of a walker whose stance foot is at the origin and rolls without slipping, as in the walking
    /// model. The stance foot is 0 for the outer and 1 for the inner legs. The arguments `theta` and `rate` belong to
    /// the stance leg, and `swing` and `swing_rate` to the other leg. Both are measured forward from the normal of the
    /// ground.
    pub fn standing(walker: &Walker, stance: usize, [theta, swing]: [f64; 2], [rate, swing_rate]: [f64; 2]) -> Self {
        let mut posture = Self::default();
        posture.angles[stance] = -theta;
        posture.rates[stance] = -rate;
        posture.angles[1 - stance] = -swing;
        posture.rates[1 - stance] = -swing_rate;
        let [x, _, low] = walker.legs[stance].sole(-theta);
        // The ground's point is at rest: the hip turns about it.
        posture.hip = [-x, -low];
        posture.velocity = [-rate * -low, rate * -x];
        posture
    }
}
