//! A biped of two stiff pairs of legs, as data: the rigid body that the simplest walking model is the limit of.

use farsa_body::Pose;
use farsa_body::actuators::{Law, Torque};
use farsa_body::ports::{ActuatorId, BodyId, JointId, PairId};
use farsa_body::robot::{Collider, Joint, MassProperties, Robot, Segment, Shape, Surface};
use farsa_num::{Scalar, sin_cos};

/// Half the thickness of legs and of the hip's axle, which nothing but their own small inertia depends on \[m\].
const THIN: f64 = 0.01;
/// Distance of a withdrawn plate to the side, and half its width \[m\].
pub(crate) const ASIDE: f64 = 8.0;
const WIDTH: f64 = 1.0;
/// Half the length of a plate, and half its thickness \[m\].
const LENGTH: f64 = 1000.0;
const THICKNESS: f64 = 0.5;
/// Mass of the rail that guides the hip, in hips.
const RAIL: f64 = 1e-9;

/// A pair of legs that move as one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Legs {
    /// From the hip to the sole \[m\].
    pub length: f64,
    /// Mass of the shanks, spread evenly from hip to sole \[kg\].
    pub mass: f64,
    /// Mass at the sole \[kg\].
    pub foot_mass: f64,
    /// Radius of the round sole, whose center is on the leg \[m\].
    pub foot_radius: f64,
}

/// A walker of two stiff pairs of legs on one axle. Frame: x ahead, y to the left, z along the ground's normal.
///
/// The outer pair and the inner pair hold the walker upright sideways, so it moves in the plane of x and z alone. Joints make the
/// plane. The hip slides along x and z without weight or friction of the guide, the outer legs turn about it, the inner legs turn
/// on the outer ones. A slope is gravity that leans ([`Walker::gravity`]).
///
/// Stiff legs cannot clear the ground next to each other, so each pair has a separate ground, a plate that a world can slide aside
/// while that pair swings. The plate slides across the plane of motion: no force of the walk acts on it, and its weight has no
/// effect.
///
/// `[McGeer1990]` is such a machine with round feet, `[Garcia1998]` its limit for point feet without mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Walker {
    /// The outer legs and the inner legs.
    pub legs: [Legs; 2],
    /// Mass at the hip \[kg\].
    pub hip_mass: f64,
    /// Distance of the outer feet \[m\]. The inner ones are half as far apart. Drawn, and without effect on the motion in the
    /// plane.
    pub hip_spacing: f64,
    /// Coefficient of friction.
    pub friction: f64,
    /// Stiffness of a foot on the ground \[N/m\].
    pub stiffness: f64,
    /// Damping ratio of the whole walker's mass on that stiffness.
    pub damping_ratio: f64,
    /// Largest turn of the inner legs against the outer ones, to each side \[rad\].
    pub hip_range: f64,
    /// Largest torque of the hip's motor \[N m\], or 0 without a motor.
    pub torque: f64,
}

/// The ids of the parts of a walker.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WalkerParts {
    /// The hip's place along x and z.
    pub slides: [JointId; 2],
    /// The outer legs' turn from upright, and the inner legs' against the outer: positive moves the foot back.
    pub hinges: [JointId; 2],
    /// The plates' joints, of the outer and the inner legs.
    pub plates: [JointId; 2],
    /// The contacts of outer and inner feet.
    pub soles: [PairId; 2],
    /// The hip.
    pub hip: BodyId,
    /// The outer and inner legs.
    pub legs: [BodyId; 2],
    /// The hip's motor, if there is one.
    pub motor: Option<ActuatorId>,
}

impl Default for Walker {
    /// Legs of 1 m, 10 kg at the hip, feet of 10 g and 0.1 mm: nearly the simplest walking model.
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

    /// The sole's center and its lowest point, seen from the hip, with the leg turned back by an angle \[rad\]. Returns x and z of
    /// the center, and z of the lowest point \[m\].
    pub(crate) fn sole(&self, angle: f64) -> [f64; 3] {
        let (sine, cosine) = sin_cos(angle);
        let arm = self.length - self.foot_radius;
        [-arm * sine, -arm * cosine, -arm * cosine - self.foot_radius]
    }
}

impl Walker {
    /// Mass of all \[kg\].
    pub fn mass(&self) -> f64 {
        self.hip_mass + self.legs.iter().map(|legs| legs.mass + legs.foot_mass).sum::<f64>()
    }

    /// Gravity \[m/s2\] of a size on a slope \[rad\] that falls along x, in the frame of the slope.
    pub fn gravity(size: f64, slope: f64) -> [f64; 3] {
        let (sine, cosine) = sin_cos(slope);
        [size * sine, 0.0, -size * cosine]
    }

    /// The walker with the plates that it walks on, and the ids of its parts.
    pub fn robot(&self) -> (Robot, WalkerParts) {
        let everywhere = [f64::NEG_INFINITY, f64::INFINITY];
        let mut robot = Robot::new("walker");
        let axle = MassProperties::cuboid(self.hip_mass, [THIN, 0.5 * self.hip_spacing.max(THIN), THIN]);
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

    /// Kinetic energy, and potential energy under a gravity \[J\], of a [`Posture`].
    pub fn energy(&self, posture: &Posture, gravity: [f64; 3]) -> f64 {
        let mut energy = 0.0;
        let mut add = |mass: f64, [x, z]: [f64; 2], [u, w]: [f64; 2]| {
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
            let velocity = [posture.velocity[0] + rate * z, posture.velocity[1] - rate * x];
            add(body.mass, [posture.hip[0] + x, posture.hip[1] + z], velocity);
            turning += 0.5 * body.inertia[1] * rate * rate;
        }
        energy + turning
    }
}

/// Where a walker is and how it moves in its plane.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Posture {
    /// The hip's place, x and z \[m\].
    pub hip: [f64; 2],
    /// Its velocity \[m/s\].
    pub velocity: [f64; 2],
    /// Backward turn of outer and inner legs from the ground's normal \[rad\].
    pub angles: [f64; 2],
    /// Their rates \[rad/s\].
    pub rates: [f64; 2],
}

impl Posture {
    /// The posture of a world's walker.
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
            angles: [outer, outer + at(parts.hinges[1])],
            rates: [rate, rate + speed(parts.hinges[1])],
        }
    }

    /// Sets the posture of a world's walker. [`Arrange::finish_placement`](farsa_body::ports::Arrange::finish_placement) must follow.
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

    /// The posture of a walker whose stance foot (0 outer, 1 inner) rests and rolls at the origin, as in the walking model. `theta`
    /// and `theta_rate` are those of the stance leg, `swing` and `swing_rate` of the other, turned ahead of the ground's normal.
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
