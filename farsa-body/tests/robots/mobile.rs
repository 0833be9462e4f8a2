//! Infrared sensors, wheels and what is felt of them, in the world of the plane.

use core::f32::consts::PI;

use crate::shared::{read, robots};
use farsa_body::motors::{SpeedAndTurn, WheelVelocity};
use farsa_body::ports::{Actuated, BodyId, Channels, Handles, Hit, JointId, Joints, Kinematics, Rays, Sensor, World};
use farsa_body::ports::{ActuatorId, Motor};
use farsa_body::robots::{MobileParts, MobileRobot};
use farsa_body::sensors::infrared::{InfraredFormula, InfraredRays};
use farsa_body::sensors::{Beam, LaserDistance, Traction, WheelSpeed};
use farsa_body::testing::{PlaneWorld, check_motor, check_sensor};
use farsa_body::{ChannelError, Pose, Twist};
use proptest::prelude::*;

/// A robot of this kind among walls and discs.
fn scene(robot: &MobileRobot) -> (PlaneWorld, MobileParts) {
    let mut world = PlaneWorld::new();
    world.add_wall([[0.09, -1.0], [0.14, 1.0]], [1.0; 3]);
    world.add_disc([-0.1, 0.03], 0.0125, [1.0, 0.0, 0.0]);
    world.add_disc([0.0, -0.11], 0.027, [0.0, 1.0, 0.0]);
    let parts = world.add_robot(robot, [0.0, 0.0], 0.4);
    world.add_robot(robot, [0.02, 0.2], -2.0);
    (world, parts)
}

/// For each channel of a ring that of the mirror image.
fn mirror(robot: &MobileRobot) -> Vec<usize> {
    let full = 2.0 * std::f64::consts::PI;
    let angles = &robot.infrared.angles;
    let apart = |a: f64, b: f64| (a + b).rem_euclid(full).min((-a - b).rem_euclid(full));
    angles
        .iter()
        .map(|&a| (0..angles.len()).min_by(|&i, &j| apart(a, angles[i]).total_cmp(&apart(a, angles[j]))).unwrap())
        .collect()
}

fn fan() -> Vec<Beam> {
    (0..7).map(|i| Beam::in_cone(0.035, 0.0, 1.0, i, 7)).collect()
}

#[test]
fn sensors_and_motors_keep_their_promises() {
    for robot in robots() {
        let (world, parts) = scene(&robot);
        let largest = robot.max_wheel_speed as f32;
        let beam = Beam { from: [0.0, 0.035], direction: [0.0, 1.0] };
        let mut sensors: Vec<Box<dyn Sensor<PlaneWorld>>> = vec![
            Box::new(InfraredRays::for_robot(&robot, parts.body).unwrap()),
            Box::new(InfraredRays::new(parts.body, [beam], 1, 0.0, 0.1).unwrap()),
            Box::new(InfraredFormula::for_robot(&robot, parts.body).unwrap()),
            Box::new(InfraredFormula::new(parts.body, [[1.0, 0.0]], 0.035).unwrap()),
            Box::new(LaserDistance::new(parts.body, fan(), 0.0, 1.0).unwrap()),
            Box::new(WheelSpeed::new(parts.wheels, largest).unwrap()),
            Box::new(WheelSpeed::new(parts.wheels, largest).unwrap().signed()),
            Box::new(Traction::new(parts.body, parts.wheels, robot.wheel_radius as f32, 0.1).unwrap()),
        ];
        for (i, sensor) in sensors.iter_mut().enumerate() {
            assert_eq!(check_sensor(sensor.as_mut(), &world), Ok(()), "{}: sensor {i}", robot.name);
        }
        let mut motors: Vec<Box<dyn Motor<PlaneWorld>>> = vec![
            Box::new(WheelVelocity::new(parts.motors, largest).unwrap()),
            Box::new(SpeedAndTurn::new(parts.motors, largest).unwrap()),
            Box::new(SpeedAndTurn::new(parts.motors, largest).unwrap().forwards()),
        ];
        for (i, motor) in motors.iter_mut().enumerate() {
            assert_eq!(check_motor(motor.as_mut(), || scene(&robot).0), Ok(()), "{}: motor {i}", robot.name);
        }
    }
}

#[test]
fn infrared_rays_read_the_nearest_thing_of_their_cone() {
    let robot = MobileRobot::khepera();
    let mut world = PlaneWorld::new();
    let parts = world.add_robot(&robot, [1.0, 2.0], 0.0);
    let disc = world.add_disc([1.0 + 0.035 + 0.02 + 0.0125, 2.0], 0.0125, [1.0; 3]);
    let ahead = [Beam { from: [0.035, 0.0], direction: [1.0, 0.0] }];
    let mut sensor = InfraredRays::new(parts.body, ahead, 1, 0.015, 0.05).unwrap();
    assert!((read(&mut sensor, &world)[0] - 0.6).abs() < 1e-4);
    // Touching the hull, and a little within it.
    for inside in [0.0, 0.0005] {
        world.place(disc, [1.0 + 0.035 + 0.0125 - inside, 2.0], 0.0);
        assert!(read(&mut sensor, &world)[0] > 0.9999, "{inside}");
    }
    world.place(disc, [1.0 + 0.035 + 0.0125 + 0.0501, 2.0], 0.0);
    assert_eq!(read(&mut sensor, &world), [0.0]);
    // The nearest ray of a cone counts: a disc next to the axis is hit by the outer rays only.
    let cone: Vec<Beam> = (0..3).map(|i| Beam::in_cone(0.035, 0.0, 0.5, i, 3)).collect();
    world.place(disc, [1.0 + 0.035 + 0.03, 2.0 + 0.03 * 0.5463], 0.0);
    assert_eq!(read(&mut sensor, &world), [0.0]);
    let mut cone = InfraredRays::new(parts.body, cone, 3, 0.015, 0.05).unwrap();
    let expected = 1.0 - (0.03 / 0.87758 - 0.0125) / 0.05;
    assert!((read(&mut cone, &world)[0] - expected).abs() < 1e-3);
    assert_eq!(cone.channels(), 1);
}

#[test]
fn a_laser_measures_and_reads_1_where_it_meets_nothing() {
    let mut world = PlaneWorld::new();
    let parts = world.add_robot(&MobileRobot::khepera(), [0.0, 0.0], PI / 2.0);
    world.add_wall([[-1.0, 0.535], [1.0, 0.535]], [1.0; 3]);
    let beams: [Beam; 3] = core::array::from_fn(|i| Beam::in_cone(0.035, 0.0, PI.into(), i, 3));
    let values = read(&mut LaserDistance::new(parts.body, beams, 0.0, 2.0).unwrap(), &world);
    assert!((values[1] - 0.25).abs() < 1e-5 && values[0] == 1.0 && values[2] == 1.0, "{values:?}");
}

#[test]
fn the_analytic_ring_adds_what_is_near() {
    let robot = MobileRobot::khepera();
    let mut world = PlaneWorld::new();
    let parts = world.add_robot(&robot, [0.0, 0.0], 0.0);
    let ahead = [[1.0, 0.0]];
    let mut sensor = InfraredFormula::new(parts.body, ahead, 0.035).unwrap();
    world.add_wall([[0.035 + 0.023, -1.0], [0.035 + 0.023, 1.0]], [1.0; 3]);
    assert!((read(&mut sensor, &world)[0] - 0.5).abs() < 1e-5);
    let disc = world.add_disc([0.035 + 0.021 + 0.0125, 0.0], 0.0125, [1.0; 3]);
    assert!((read(&mut sensor, &world)[0] - 0.75).abs() < 1e-5);
    world.place(disc, [0.035 + 0.0125, 0.0], 0.0);
    assert_eq!(read(&mut sensor, &world), [1.0]);
    // With its edge beyond the robot's center it is still on the same side.
    world.place(disc, [0.01, 0.0], 0.0);
    assert_eq!(read(&mut sensor, &world), [1.0]);
    assert_eq!(read(&mut InfraredFormula::new(parts.body, [[-1.0, 0.0]], 0.035).unwrap(), &world), [0.0]);
}

#[test]
fn bad_configurations_are_refused_with_their_numbers() {
    let (b, beams) = (BodyId(0), fan());
    assert_eq!(
        InfraredRays::new(b, &beams, 3, 0.0, 0.1).unwrap_err(),
        ChannelError::Groups { field: "beams", count: 7, size: 3 }
    );
    assert_eq!(InfraredRays::new(b, &beams, 3, 0.0, 0.1).unwrap_err().to_string(), "7 beams are no whole groups of 3");
    assert!(InfraredRays::new(b, &beams, 0, 0.0, 0.1).is_err());
    assert!(InfraredRays::new(b, &beams[..0], 1, 0.0, 0.1).is_err());
    assert!(LaserDistance::new(b, &beams[..0], 0.0, 0.1).is_err());
    assert!(InfraredFormula::new(b, [[0.0; 2]; 0], 0.1).is_err());
    assert!(InfraredFormula::new(b, [[2.0, 0.0]], 0.1).is_err());
    let long = [Beam { from: [0.0; 2], direction: [1.0, 1.0] }];
    assert!(matches!(InfraredRays::new(b, long, 1, 0.0, 0.1), Err(ChannelError::Value { .. })));
    let nowhere = [Beam { from: [f32::NAN, 0.0], direction: [1.0, 0.0] }];
    assert!(LaserDistance::new(b, nowhere, 0.0, 0.1).is_err());
    for bad in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        assert!(InfraredRays::new(b, &beams, 1, 0.0, bad).is_err());
        assert!(LaserDistance::new(b, &beams, 0.0, bad).is_err());
        assert!(InfraredFormula::new(b, [[1.0, 0.0]], bad).is_err());
        assert!(WheelSpeed::new([JointId(0)], bad).is_err());
        assert!(Traction::new(b, [JointId(0); 2], bad, 1.0).is_err());
        assert!(Traction::new(b, [JointId(0); 2], 1.0, bad).is_err());
        assert!(WheelVelocity::new([ActuatorId(0); 2], bad).is_err());
        assert!(SpeedAndTurn::new([ActuatorId(0); 2], bad).is_err());
    }
    assert!(InfraredRays::new(b, &beams, 1, f32::NAN, 0.1).is_err());
    let mut blind = MobileRobot::khepera();
    blind.infrared.angles.clear();
    assert!(InfraredRays::for_robot(&blind, b).is_err() && InfraredFormula::for_robot(&blind, b).is_err());
}

/// The speeds that a motor's values give the wheels of a robot with a largest speed of 2 rad/s.
fn driven(mut motor: impl Motor<PlaneWorld>, parts: &MobileParts, world: &mut PlaneWorld, y: &[f32]) -> [f32; 2] {
    motor.drive(y, world);
    parts.wheels.map(|wheel| world.speed(wheel))
}

#[test]
fn wheels_turn_as_they_are_told() {
    let mut world = PlaneWorld::new();
    let parts = world.add_robot(&MobileRobot::khepera(), [0.0, 0.0], 0.0);
    let wheels = WheelVelocity::new(parts.motors, 2.0).unwrap();
    let turn = SpeedAndTurn::new(parts.motors, 2.0).unwrap();
    let mut drive = |y: &[f32]| driven(wheels, &parts, &mut world, y);
    assert_eq!(drive(&[0.0, 1.0]), [-2.0, 2.0]);
    assert_eq!(drive(&[0.75, f32::NAN]), [1.0, -2.0]);
    assert_eq!(drive(&[0.5]), [0.0, -2.0]);
    let mut drive = |y: &[f32]| driven(turn, &parts, &mut world, y);
    assert_eq!(drive(&[1.0, 0.5]), [2.0, 2.0]);
    assert_eq!(drive(&[0.75]), [1.0, 1.0]);
    assert_eq!(drive(&[0.5, 1.0]), [-2.0, 2.0]);
    assert_eq!(drive(&[0.75, 0.75]), [0.0, 2.0]);
    // Both slowed down by the same factor: (0, 2) times the largest speed are (0, 1).
    assert_eq!(drive(&[1.0, 1.0]), [0.0, 2.0]);
    assert_eq!(drive(&[0.0, f32::NAN]), [0.0, -2.0]);
    let mut drive = |y: &[f32]| driven(turn.forwards(), &parts, &mut world, y);
    assert_eq!(drive(&[0.0, 0.5]), [0.0, 0.0]);
    assert_eq!(drive(&[0.5, 0.5]), [1.0, 1.0]);
}

#[test]
fn robots_are_as_large_and_as_fast_as_the_originals() {
    // Radii of hull and wheels and distance of the wheels [mm], and the largest speed [mm/s].
    let known =
        [[35.0, 15.0, 55.0, 1.1 * 2.0 * PI * 15.0], [35.0, 20.5, 53.0, 144.0], [85.0, 27.0, 126.5, 10.0 * 27.0]];
    for (robot, [hull, wheel, track, fastest]) in robots().iter().zip(known) {
        let sizes = [robot.radius, robot.wheel_radius, robot.track].map(|x| (1e6 * x).round() as f32 / 1e3);
        assert_eq!(sizes, [hull, wheel, track], "{}", robot.name);
        // A second of full speed ahead, then a step of turning on the spot.
        let mut world = PlaneWorld::new();
        let parts = world.add_robot(robot, [0.0, 0.0], 0.0);
        let mut run = |commands: [f32; 2], steps: usize| {
            parts.motors.iter().zip(commands).for_each(|(motor, speed)| world.command(*motor, [speed, 0.0]));
            (0..steps).for_each(|_| world.step());
            world.pose(parts.body)
        };
        let way = 1000.0 * run([1e3; 2], 20).position[0];
        assert!((way - fastest).abs() < 0.01, "{}: {way} mm", robot.name);
        let [_, _, sine, _] = run([-1e3, 1e3], 1).rotation;
        let turn = 2.0 * fastest / track * PlaneWorld::TIME_STEP;
        assert!((sine - farsa_num::sin_cos(0.5 * turn).0).abs() < 1e-5, "{}: {sine}", robot.name);
    }
    // The attachment device of the MarXbot reaches 20 mm.
    assert_eq!(robots().map(|robot| robot.attachment), [None, None, Some(0.02)]);
}

#[test]
fn the_felt_wheel_is_the_driven_wheel() {
    let mut world = PlaneWorld::new();
    let parts = world.add_robot(&MobileRobot::khepera(), [0.0, 0.0], 0.0);
    let mut speed = WheelSpeed::new(parts.wheels, 2.0).unwrap();
    assert_eq!(read(&mut speed, &world), [0.5; 2]);
    assert_eq!(read(&mut speed.signed(), &world), [0.0; 2]);
    for y in [[0.0, 1.0], [0.25, 0.625]] {
        WheelVelocity::new(parts.motors, 2.0).unwrap().drive(&y, &mut world);
        assert_eq!(read(&mut speed, &world), y);
        assert_eq!(read(&mut speed.signed(), &world), y.map(|y| 2.0 * y - 1.0));
    }
    world.command(parts.motors[0], [6.0, 0.0]);
    assert_eq!(read(&mut speed, &world)[0], 1.0);
}

/// A robot whose wheels do not move it as commanded, with arbitrary readings.
struct Odd {
    velocity: [f32; 3],
    speed: f32,
    rotation: [f32; 4],
    place: f32,
    distance: f32,
}

impl Handles for Odd {
    type Body = BodyId;
    type Joint = JointId;
    type Actuator = ActuatorId;
}
impl Kinematics for Odd {
    fn pose(&self, _: BodyId) -> Pose {
        Pose { position: [self.place; 3], rotation: self.rotation }
    }
    fn velocity(&self, _: BodyId) -> Twist {
        Twist { linear: self.velocity, angular: [0.0; 3] }
    }
}
impl Joints for Odd {
    fn position(&self, _: JointId) -> f32 {
        0.0
    }
    fn speed(&self, _: JointId) -> f32 {
        self.speed
    }
}
impl Rays for Odd {
    fn cast(&self, _: [f32; 3], direction: [f32; 3], _: f32) -> Option<Hit<BodyId>> {
        // It shows the own hull from within.
        let body = (self.distance > 0.5).then_some(BodyId(0));
        Some(Hit { distance: self.distance, normal: direction, body })
    }
}

#[test]
fn traction_is_felt_towards_where_one_is_pulled() {
    let h = core::f32::consts::FRAC_1_SQRT_2;
    // Heading along y. The wheels are commanded to 0.2 m/s, and a wall stops the robot. Then it is dragged backwards
    // and to its left.
    let mut world = Odd { velocity: [0.0; 3], speed: 10.0, rotation: [0.0, 0.0, h, h], place: 0.0, distance: 1.0 };
    let mut traction = Traction::new(BodyId(0), [JointId(0), JointId(1)], 0.02, 0.4).unwrap();
    let near = |a: &[f32], b: [f32; 2]| (a[0] - b[0]).abs() < 1e-6 && (a[1] - b[1]).abs() < 1e-6;
    assert!(near(&read(&mut traction, &world), [-0.5, 0.0]));
    world.velocity = [-0.3, -0.1, 0.0];
    assert!(near(&read(&mut traction, &world), [-0.75, 0.75]));
    world.velocity = [0.0, 0.2, 0.0];
    assert!(near(&read(&mut traction, &world), [0.0, 0.0]));
}

fn anything() -> impl Strategy<Value = f32> {
    prop_oneof![
        Just(f32::NAN),
        Just(f32::INFINITY),
        Just(f32::NEG_INFINITY),
        Just(f32::MAX),
        Just(f32::MIN),
        Just(0.0),
        -2.0_f32..2.0
    ]
}

/// A world with one khepera at the origin, and one disc at a distance from its hull and a bearing.
fn with_disc(robot: &MobileRobot, radius: f32, distance: f32, bearing: f32) -> (PlaneWorld, MobileParts) {
    let mut world = PlaneWorld::new();
    let parts = world.add_robot(robot, [0.0, 0.0], 0.0);
    let apart = robot.radius as f32 + distance + radius;
    let (s, c) = farsa_num::sin_cos(bearing);
    world.add_disc([apart * c, apart * s], radius, [1.0; 3]);
    (world, parts)
}

proptest! {
    #[test]
    fn readings_stay_in_their_range_whatever_the_world_tells(
        numbers in prop::array::uniform7(anything()), rotation in prop::array::uniform4(anything()),
    ) {
        let [x, y, z, speed, place, distance, _] = numbers;
        let world = Odd { velocity: [x, y, z], speed, rotation, place, distance };
        let (b, wheels) = (BodyId(0), [JointId(0), JointId(1)]);
        let mut unit: Vec<Box<dyn Sensor<Odd>>> = vec![
            Box::new(InfraredRays::for_robot(&MobileRobot::khepera(), b).unwrap()),
            Box::new(LaserDistance::new(b, fan(), 0.0, 1.0).unwrap()),
            Box::new(WheelSpeed::new(wheels, 2.0).unwrap()),
        ];
        for sensor in &mut unit {
            prop_assert!(read(sensor.as_mut(), &world).iter().all(|x| (0.0..=1.0).contains(x)));
        }
        let mut signed: Vec<Box<dyn Sensor<Odd>>> = vec![
            Box::new(WheelSpeed::new(wheels, 2.0).unwrap().signed()),
            Box::new(Traction::new(b, wheels, 0.02, 1.0).unwrap()),
        ];
        for sensor in &mut signed {
            prop_assert!(read(sensor.as_mut(), &world).iter().all(|x| (-1.0..=1.0).contains(x)));
        }
    }

    /// The mirror image of a scene is read as the mirror image of the ring.
    #[test]
    fn rings_are_mirror_symmetric(
        radius in 0.01_f32..0.05, distance in 0.0_f32..0.1, bearing in -3.0_f32..3.0, wall in 0.1_f32..0.2, tilt in -0.1_f32..0.1,
    ) {
        for robot in robots() {
            let scene = |side: f32| {
                let (mut world, parts) = with_disc(&robot, radius, distance, side * bearing);
                world.add_wall([[-1.0, side * (wall + tilt)], [1.0, side * (wall - tilt)]], [1.0; 3]);
                (world, parts.body)
            };
            let ((left, b), (right, _)) = (scene(1.0), scene(-1.0));
            let mut rings: Vec<Box<dyn Sensor<PlaneWorld>>> = vec![
                Box::new(InfraredRays::for_robot(&robot, b).unwrap()),
                Box::new(InfraredFormula::for_robot(&robot, b).unwrap()),
            ];
            for (ring, name) in rings.iter_mut().zip(["rays", "analytic"]) {
                let (here, there) = (read(ring.as_mut(), &left), read(ring.as_mut(), &right));
                for (channel, &other) in mirror(&robot).iter().enumerate() {
                    // A ray that grazes a disc on one side may miss it on the other.
                    let gap = (here[channel] - there[other]).abs();
                    prop_assert!(gap < 1e-3 || here[channel] == 0.0 || there[other] == 0.0,
                        "{} {name} {channel}: {here:?} {there:?}", robot.name);
                }
                let gaps = mirror(&robot).iter().enumerate().filter(|&(c, &o)| (here[c] - there[o]).abs() >= 1e-3).count();
                prop_assert!(gaps <= 1, "{} {name}: {here:?} {there:?}", robot.name);
            }
        }
    }

    /// A surface that moves straight away has decreasing readings, and none out of range.
    #[test]
    fn infrared_falls_with_distance(
        radius in 0.005_f32..0.05, distance in 0.0_f32..0.1, further in 0.0_f32..0.05, sensor in 0_usize..8,
    ) {
        let robot = MobileRobot::khepera();
        let bearing = robot.infrared.angles[sensor] as f32;
        let ((near, b), (far, _)) = (
            with_disc(&robot, radius, distance, bearing), with_disc(&robot, radius, distance + further, bearing));
        let b = b.body;
        let [mut rays, mut analytic] = [
            Box::new(InfraredRays::for_robot(&robot, b).unwrap()) as Box<dyn Sensor<PlaneWorld>>,
            Box::new(InfraredFormula::for_robot(&robot, b).unwrap()),
        ];
        for (ring, range) in [(&mut rays, 0.05), (&mut analytic, 0.033)] {
            let (here, there) = (read(ring.as_mut(), &near), read(ring.as_mut(), &far));
            // Twice the rounding of a distance over the range.
            prop_assert!(there[sensor] <= here[sensor] + 1e-5);
            prop_assert!(distance < range + 1e-5 || here.iter().all(|&x| x == 0.0), "{here:?}");
            prop_assert!(distance > 0.02 || here[sensor] > 0.0);
        }
    }

    /// Mirrored values drive the mirrored way.
    #[test]
    fn wheels_are_mirror_symmetric(a in 0.0_f32..1.0, b in 0.0_f32..1.0, steps in 1..50) {
        let run = |motor: &mut dyn FnMut(&MobileParts, &mut PlaneWorld)| {
            let mut world = PlaneWorld::new();
            let parts = world.add_robot(&MobileRobot::khepera(), [0.0, 0.0], 0.0);
            motor(&parts, &mut world);
            for _ in 0..steps {
                world.step();
            }
            world.pose(parts.body)
        };
        let pair = |y: [f32; 2]| run(&mut |parts, world| WheelVelocity::new(parts.motors, 6.0).unwrap().drive(&y, world));
        let turn = |y: [f32; 2]| run(&mut |parts, world| SpeedAndTurn::new(parts.motors, 6.0).unwrap().drive(&y, world));
        for (here, there) in [(pair([a, b]), pair([b, a])), (turn([a, b]), turn([a, 1.0 - b]))] {
            prop_assert!((here.position[0] - there.position[0]).abs() < 1e-4);
            prop_assert!((here.position[1] + there.position[1]).abs() < 1e-4);
            prop_assert!((here.rotation[2] + there.rotation[2]).abs() < 1e-4);
        }
        let straight = pair([a, a]);
        prop_assert_eq!((straight.position[1], straight.rotation[2]), (0.0, 0.0));
    }
}
