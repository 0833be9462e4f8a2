//! Descriptions of wheeled robots with bodies and joints. They are used for model files and for worlds that support
//! joints.

use alloc::format;
use core::f64::consts::PI;

use crate::actuators::law::{Law, Torque};
use crate::ports::BodyId;
use crate::pose::Pose;
use crate::robot::description::{Collider, Robot, Segment, Surface};
use crate::robot::joint::Joint;
use crate::robot::mass_properties::MassProperties;
use crate::robot::shape::Shape;
use crate::robots::mobile::MobileRobot;

/// Boxes whose faces are the sides of the hull: a polygon of twice as many.
const FACES: usize = 8;

/// The height of the skids above the ground, in radii of a wheel.
const CLEARANCE: f64 = 0.02;

/// The depth to which the robot's weight presses a wheel into the ground \[m\].
const SINK: f64 = 1e-4;

impl MobileRobot {
    /// Mean density of a robot (in kg/m3) \[chosen\]. For comparison, an e-puck of 150 g has 780 and a Khepera of
    /// 80 g has 690.
    pub const DENSITY: f64 = 750.0;

    /// Fraction of the mass that belongs to the two wheels \[chosen\].
    pub const WHEEL_SHARE: f64 = 0.1;

    /// Computes the mass that results from [`DENSITY`](Self::DENSITY) (in kilograms).
    pub fn mass(&self) -> f64 {
        Self::DENSITY * (PI * self.radius * self.radius * self.height)
    }

    /// Builds a description of the robot with a floating hull, two wheels on unlimited joints, two skids and the
    /// ground. Each infrared and ground sensor is represented by a massless segment whose x axis is the direction of
    /// the sensor.
    ///
    /// The segments are named `hull`, `left wheel`, `right wheel`, `infrared 1`..., and `ground 1`.... The frame of
    /// `hull` is that of the robot, on the ground between the wheels. Its inertia is that of a solid cylinder whose
    /// center is at the height of the axle. The largest torque of a wheel's motor is a quarter of the weight of the
    /// robot, multiplied by the radius of the wheel.
    ///
    /// Deviations from the planar robots: since descriptions have no cylinders, the hull is a polygon with 16 sides
    /// that deviates from the circle by at most 2 %. It ends above the ground at half the radius of a wheel, or at half
    /// its height. The wheels are spheres that touch the ground in one point. The friction is 0.8 below the wheels
    /// and 0 below the skids. Contacts are critically damped and 0.1 mm deep under the weight of the robot. These
    /// values were chosen. LEDs, signals and attachment devices are not represented.
    pub fn description(&self) -> Robot {
        let mut robot = Robot::new(&self.name);
        let hull_mass = (1.0 - Self::WHEEL_SHARE) * self.mass();
        let centred = MassProperties::cylinder(hull_mass, self.radius, 0.5 * self.height);
        let hull = centred.placed(&Pose::at([0.0, 0.0, self.wheel_radius]));
        let hull = robot.add_segment(Segment::new("hull", None, Joint::floating(Pose::identity()), hull));
        let ground = robot.add_collider(Collider::new("ground", None, Shape::Plane, Pose::identity()));
        self.add_hull(&mut robot, hull);
        let stiffness = self.mass() * 9.81 / SINK;
        let damping = 2.0 * farsa_num::Scalar::sqrt(stiffness * self.mass());
        let surface = |friction| Surface { friction, rolling_friction: 0.0, stiffness, damping };
        for (name, left) in [("left wheel", 0.5 * self.track), ("right wheel", -0.5 * self.track)] {
            let wheel = self.add_wheel(&mut robot, hull, name, left);
            robot.add_pair([wheel, ground], surface(0.8));
        }
        let skid = 0.25 * self.wheel_radius;
        for (name, ahead) in [("front skid", 0.7 * self.radius), ("rear skid", -0.7 * self.radius)] {
            let place = Pose::at([ahead, 0.0, skid + CLEARANCE * self.wheel_radius]);
            let skid = robot.add_collider(Collider::new(name, Some(hull), Shape::Sphere { radius: skid }, place));
            robot.add_pair([skid, ground], surface(0.0));
        }
        self.add_sensors(&mut robot, hull);
        robot
    }

    /// The height at which the hull begins [m].
    fn bottom(&self) -> f64 {
        (0.5 * self.wheel_radius).min(0.5 * self.height)
    }

    fn add_hull(&self, robot: &mut Robot, hull: BodyId) {
        let (low, high) = (self.bottom(), self.height);
        let (sine, cosine) = farsa_num::sin_cos(0.5 * PI / FACES as f64);
        let half = [self.radius * cosine, self.radius * sine, 0.5 * (high - low)];
        for face in 0..FACES {
            let turned = Pose::planar([0.0, 0.0], PI * face as f64 / FACES as f64);
            let place = Pose { position: [0.0, 0.0, 0.5 * (low + high)], ..turned };
            let name = format!("hull {}", face + 1);
            robot.add_collider(Collider::new(&name, Some(hull), Shape::Box { half }, place));
        }
    }

    /// A wheel at this distance to the left. Its collider.
    fn add_wheel(&self, robot: &mut Robot, hull: BodyId, name: &str, left: f64) -> usize {
        let radius = self.wheel_radius;
        let mass = 0.5 * Self::WHEEL_SHARE * self.mass();
        // As wide as a quarter of its diameter, about y.
        let upright = Pose { rotation: QUARTER_ABOUT_X, ..Pose::identity() };
        let disc = MassProperties::cylinder(mass, radius, 0.25 * radius).placed(&upright);
        let place = Pose::at([0.0, left, radius]);
        let joint = Joint::revolute(name, [0.0, 1.0, 0.0], place, [f64::NEG_INFINITY, f64::INFINITY]);
        let wheel = robot.add_segment(Segment::new(name, Some(hull), joint, disc));
        if let Some(joint) = robot.joint(name) {
            let limit = 0.25 * 9.81 * self.mass() * radius;
            robot.add_actuator(&format!("{name} motor"), joint, Law::Torque(Torque { limit }));
        }
        robot.add_collider(Collider::new(name, Some(wheel), Shape::Sphere { radius }, Pose::identity()))
    }

    fn add_sensors(&self, robot: &mut Robot, hull: BodyId) {
        let nothing = MassProperties { mass: 0.0, centre: [0.0; 3], inertia: [0.0; 6] };
        let mut sensor = |name: &str, place| {
            robot.add_segment(Segment::new(name, Some(hull), Joint::fixed(place), nothing));
        };
        let middle = 0.5 * (self.bottom() + self.height);
        for (number, &angle) in self.infrared.angles.iter().enumerate() {
            let (sine, cosine) = farsa_num::sin_cos(angle);
            let position = [self.radius * cosine, self.radius * sine, middle];
            sensor(&format!("infrared {}", number + 1), Pose { position, ..Pose::planar([0.0, 0.0], angle) });
        }
        for (number, &[x, y]) in self.ground.iter().enumerate() {
            let place = Pose { position: [x, y, self.bottom()], rotation: QUARTER_ABOUT_Y };
            sensor(&format!("ground {}", number + 1), place);
        }
    }
}

/// Quarter turns: z becomes -y, x becomes -z.
const QUARTER_ABOUT_X: [f64; 4] = [core::f64::consts::FRAC_1_SQRT_2, 0.0, 0.0, core::f64::consts::FRAC_1_SQRT_2];
const QUARTER_ABOUT_Y: [f64; 4] = [0.0, core::f64::consts::FRAC_1_SQRT_2, 0.0, core::f64::consts::FRAC_1_SQRT_2];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::joint::JointKind;

    fn near(a: [f64; 3], b: [f64; 3]) -> bool {
        a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12)
    }

    #[test]
    fn descriptions_are_valid_and_as_large_as_the_robots() {
        for mobile in [MobileRobot::khepera(), MobileRobot::e_puck(), MobileRobot::marxbot()] {
            let robot = mobile.description();
            robot.validate().expect("a valid description");
            let mass: f64 = robot.segments.iter().map(|segment| segment.mass).sum();
            assert!((mass - mobile.mass()).abs() < 1e-12, "{}: {mass}", mobile.name);
            let wheels = [1, 2].map(|wheel| &robot.segments[wheel]);
            for (wheel, left) in wheels.into_iter().zip([0.5, -0.5]) {
                assert_eq!((wheel.joint.kind, wheel.joint.axis), (JointKind::Revolute, [0.0, 1.0, 0.0]));
                let place = [0.0, left * mobile.track, mobile.wheel_radius];
                assert!(near(wheel.joint.placement.position, place), "{}", mobile.name);
                // About its axle a wheel has m r^2 / 2.
                let about = 0.5 * wheel.mass * mobile.wheel_radius * mobile.wheel_radius;
                assert!((wheel.inertia[1] - about).abs() < 1e-15 && wheel.inertia[0] < about, "{}", mobile.name);
            }
            assert_eq!(robot.segments.len(), 3 + mobile.infrared.angles.len() + mobile.ground.len());
        }
        // The real robots weigh 80 g and 150 g. A tenth of tolerance.
        for (mobile, mass) in [(MobileRobot::khepera(), 0.08), (MobileRobot::e_puck(), 0.15)] {
            assert!((mobile.mass() / mass - 1.0).abs() < 0.1, "{}: {} kg", mobile.name, mobile.mass());
        }
    }

    #[test]
    fn sensors_look_away_from_the_hull_and_to_the_ground() {
        let mobile = MobileRobot::e_puck();
        let robot = mobile.description();
        for (number, angle) in mobile.infrared.angles.iter().enumerate() {
            let place = robot.segments[3 + number].joint.placement;
            let (sine, cosine) = farsa_num::sin_cos(*angle);
            assert!(near(place.rotate([1.0, 0.0, 0.0]), [cosine, sine, 0.0]), "{number}");
            assert!(near([place.position[0], place.position[1], 0.0], [cosine, sine, 0.0].map(|x| 0.035 * x)));
        }
        let ground = robot.body("ground 2").expect("the segment");
        let place = robot.segments[ground.index()].joint.placement;
        assert!(near(place.rotate([1.0, 0.0, 0.0]), [0.0, 0.0, -1.0]));
    }

    #[test]
    fn the_hull_is_a_polygon_within_its_circle() {
        let mobile = MobileRobot::marxbot();
        let robot = mobile.description();
        let within = |x: f64, y: f64| {
            robot.colliders.iter().filter(|collider| collider.name.starts_with("hull ")).any(|collider| {
                let Shape::Box { half } = collider.shape else { return false };
                let across = collider.placement.rotate([1.0, 0.0, 0.0]);
                let [a, b] = [x * across[0] + y * across[1], y * across[0] - x * across[1]];
                a.abs() <= half[0] && b.abs() <= half[1]
            })
        };
        for degree in 0..360 {
            let (sine, cosine) = farsa_num::sin_cos(f64::from(degree) * (PI / 180.0));
            let at = |share: f64| within(share * 0.085 * cosine, share * 0.085 * sine);
            assert!(at(0.0) && at(0.5) && at(0.98) && !at(1.0001), "{degree}");
        }
    }
}
