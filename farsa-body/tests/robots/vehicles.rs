//! Wheeled robots as bodies: places of parts, weights, contact with the ground.

use std::f64::consts::PI;

use crate::shared::robots;
use farsa_body::actuators::Law;
use farsa_body::kinematics::KinematicTree;
use farsa_body::ports::{Channels as _, Kinematics as _, Sensor as _};
use farsa_body::robot::{Collider, JointKind, Robot, Shape};
use farsa_body::robots::MobileRobot;
use farsa_body::sensors::Beam;
use farsa_body::sensors::infrared::{InfraredDrawing, InfraredRays};
use farsa_body::testing::PlaneWorld;
use farsa_body::{Pose, Recorder};

fn near(value: f64, expected: f64) -> bool {
    (value - expected).abs() <= 1e-6 * expected.abs().max(1e-3)
}

fn collider<'a>(robot: &'a Robot, name: &str) -> &'a Collider {
    &robot.colliders[robot.collider(name).unwrap()]
}

/// Computed outside this crate from the documented radius, height and radius of the wheels, and 750 kg/m3. The columns
/// are the mass of all, the inertia of the hull across and about its axis, of a wheel across and about its axle, and
/// the largest torque of a wheel's motor.
#[test]
fn masses_and_torques_are_those_of_discs_and_cylinders() {
    let known = [
        [0.086_590_147_5, 2.971_124_4e-5, 4.773_281_9e-5, 2.638_293_6e-7, 4.870_695_8e-7, 3.185_435_1e-3],
        [0.144_316_912_5, 6.683_677_0e-5, 7.955_469_8e-5, 8.212_910_1e-7, 1.516_229_6e-6, 7.255_713_2e-3],
        [2.893_995_883, 1.097_728_8e-2, 9.409_104_1e-3, 2.856_916_6e-5, 5.274_307_5e-5, 0.191_633_17],
    ];
    for (mobile, [mass, across, about, wheel_across, wheel_about, torque]) in robots().iter().zip(known) {
        let robot = mobile.description();
        assert!(near(mobile.mass(), mass), "{}: {} kg", mobile.name, mobile.mass());
        let hull = &robot.segments[0];
        // The wheels have a tenth of the mass.
        assert!(near(hull.mass, 0.9 * mass) && hull.centre == [0.0, 0.0, mobile.wheel_radius], "{}", mobile.name);
        let expected = [across, across, about];
        assert!(hull.inertia.iter().zip(expected).all(|(a, b)| near(1e3 * a, 1e3 * b)), "{:?}", hull.inertia);
        assert_eq!(hull.inertia[3..], [0.0; 3]);
        for wheel in &robot.segments[1..3] {
            assert!(near(wheel.mass, 0.05 * mass) && wheel.centre == [0.0; 3], "{}: {}", mobile.name, wheel.mass);
            let expected = [wheel_across, wheel_about, wheel_across];
            let same = |(a, b): (&f64, f64)| (a - b).abs() < 1e-6 * b;
            assert!(wheel.inertia.iter().zip(expected).all(same), "{}: {:?}", mobile.name, wheel.inertia);
            assert!(wheel.inertia[3..].iter().all(|x| x.abs() < 1e-12), "{:?}", wheel.inertia);
        }
        assert_eq!(robot.actuators.len(), 2);
        for (actuator, wheel) in robot.actuators.iter().zip(1..) {
            let Law::Torque(law) = actuator.law else { panic!("no torque") };
            assert!(near(law.limit, torque), "{}: {} N m", mobile.name, law.limit);
            assert_eq!(actuator.joint.index(), wheel);
        }
    }
}

/// On level ground a robot rests on its wheels, pressed in by 0.1 mm. The skids are just above it.
#[test]
fn robots_stand_on_their_wheels() {
    for mobile in robots() {
        let robot = mobile.description();
        let ground = robot.collider("ground").unwrap();
        assert_eq!(robot.pairs.len(), 4, "{}", mobile.name);
        for pair in &robot.pairs {
            assert_eq!(pair.colliders[1], ground);
            let weight = 9.81 * mobile.mass();
            assert!(near(1e-4 * pair.surface.stiffness, weight), "{}: {:?}", mobile.name, pair.surface);
            // Critical: the square is four times stiffness times mass.
            let square = pair.surface.damping * pair.surface.damping;
            assert!(near(square / pair.surface.stiffness, 4.0 * mobile.mass()), "{}: {:?}", mobile.name, pair.surface);
            assert_eq!(pair.surface.rolling_friction, 0.0);
            let part = &robot.colliders[pair.colliders[0]];
            let Shape::Sphere { radius } = part.shape else { panic!("{} is no ball", part.name) };
            let body = &robot.segments[part.body.unwrap().index()];
            let centre = match body.joint.kind {
                JointKind::Revolute => body.joint.placement.transform(part.placement.position),
                _ => part.placement.position,
            };
            let lowest = centre[2] - radius;
            if part.name.ends_with("wheel") {
                assert!(lowest.abs() < 1e-12 && near(radius, mobile.wheel_radius), "{}", mobile.name);
                assert_eq!((pair.surface.friction, centre[0]), (0.8, 0.0));
            } else {
                // 2 % of a wheel's radius above the ground, a quarter of it large, within the hull.
                assert!(near(lowest / mobile.wheel_radius, 0.02), "{}: {lowest} m", mobile.name);
                assert!(near(radius / mobile.wheel_radius, 0.25), "{}: {radius} m", mobile.name);
                let ahead = if part.name == "front skid" { 0.7 } else { -0.7 };
                assert!(near(centre[0] / mobile.radius, ahead) && centre[1] == 0.0, "{}: {centre:?}", mobile.name);
                assert_eq!(pair.surface.friction, 0.0);
            }
        }
        assert_eq!(collider(&robot, "ground").shape, Shape::Plane);
    }
}

#[test]
fn hulls_reach_from_half_a_wheel_to_the_top() {
    let flat = MobileRobot { height: 0.012, ..MobileRobot::khepera() };
    for mobile in robots().into_iter().chain([flat]) {
        let robot = mobile.description();
        let low = (0.5 * mobile.wheel_radius).min(0.5 * mobile.height);
        let sides: Vec<_> = robot.colliders.iter().filter(|collider| collider.name.starts_with("hull ")).collect();
        assert_eq!(sides.len(), 8);
        for (number, side) in sides.iter().enumerate() {
            assert_eq!(side.name, format!("hull {}", number + 1));
            let Shape::Box { half } = side.shape else { panic!("no box") };
            let z = side.placement.position[2];
            assert!(near(z - half[2], low) && near(z + half[2], mobile.height), "{}: {z} {half:?}", mobile.name);
            assert_eq!(side.placement.position[..2], [0.0, 0.0]);
            // Corners lie on the circle, sixteen at equal angles.
            let corner = half[0].hypot(half[1]);
            // tan 11.25 deg.
            assert!(near(corner, mobile.radius) && near(half[1] / half[0], 0.198_912_367), "{half:?}");
            let heading = side.placement.heading();
            assert!((heading - PI * number as f64 / 8.0).abs() < 1e-12, "{number}: {heading}");
        }
    }
}

/// Sensors sit on the hull at half the height of its side and look out of it, those of the ground under it and look down.
#[test]
fn sensors_sit_where_the_robots_have_them() {
    for mobile in robots() {
        let robot = mobile.description();
        let tree = KinematicTree::new(&robot).unwrap();
        let poses = tree.poses(&tree.zero());
        let pose = |name: &str| &poses[robot.body(name).unwrap().index()];
        let low = 0.5 * mobile.wheel_radius;
        for (number, angle) in mobile.infrared.angles.iter().enumerate() {
            let Pose { position: [x, y, z], .. } = *pose(&format!("infrared {}", number + 1));
            let out = pose(&format!("infrared {}", number + 1)).rotate([1.0, 0.0, 0.0]);
            assert!(near(x.hypot(y), mobile.radius) && near(z - low, mobile.height - z), "{}: {z}", mobile.name);
            assert!(near(out[0] * mobile.radius, x) && near(out[1] * mobile.radius, y) && out[2] == 0.0, "{out:?}");
            let apart = (farsa_num::atan2(y, x) - angle).rem_euclid(2.0 * PI);
            assert!(!(1e-9..=2.0 * PI - 1e-9).contains(&apart), "{}: {apart}", mobile.name);
        }
        for (number, place) in mobile.ground.iter().enumerate() {
            let found = pose(&format!("ground {}", number + 1));
            assert!(near(found.position[2], low) && found.position[..2] == place[..], "{}: {found:?}", mobile.name);
            assert!((found.rotate([1.0, 0.0, 0.0])[2] + 1.0).abs() < 1e-12);
        }
        for (name, left) in [("left wheel", 0.5), ("right wheel", -0.5)] {
            let [x, y, z] = pose(name).position;
            assert!(x == 0.0 && near(y / mobile.track, left) && near(z, mobile.wheel_radius), "{}", mobile.name);
        }
    }
}

#[test]
fn sensors_of_the_robots_look_where_the_documentation_has_them() {
    // Degrees from ahead. Khepera: left to right in front, then the two behind.
    let khepera = [60, 36, 12, -12, -36, -60, -160, 160];
    let e_puck = [90, 54, 18, -18, -54, -90, -150, 150];
    let marxbot: Vec<i32> = (0..24).map(|i| 15 * i).collect();
    for (mobile, degrees) in robots().iter().zip([&khepera[..], &e_puck[..], &marxbot[..]]) {
        let angles: Vec<f64> = mobile.infrared.angles.iter().map(|angle| angle / PI * 180.0).collect();
        assert_eq!(angles.len(), degrees.len());
        let apart = angles.iter().zip(degrees).map(|(a, b)| (a - f64::from(*b)).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-9, "{}: {angles:?}", mobile.name);
        // A cone of 20 degrees.
        assert!((mobile.infrared.aperture / PI * 180.0 - 10.0).abs() < 1e-9, "{}", mobile.name);
    }
    // Four ground sensors of the MarXbot at the corners of a square of 60 mm across, eight around at 80 mm.
    let ground = MobileRobot::marxbot().ground;
    let apart = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
    let (within, around) = ground.split_at(4);
    assert_eq!(around.len(), 8);
    // sin 22.5 deg.
    for (ring, side) in [(within, 0.03 * 2.0_f64.sqrt()), (around, 0.16 * 0.382_683_432)] {
        for (place, next) in ring.iter().zip(ring.iter().cycle().skip(1)) {
            assert!(near(apart(*place, *next), side), "{ring:?}");
            assert!(place[0] * next[1] - place[1] * next[0] > 0.0, "not counter-clockwise: {ring:?}");
        }
    }
    assert!(near(within[0][0], within[0][1]) && around[0] == [0.08, 0.0], "{ground:?}");
    let e_puck = MobileRobot::e_puck().ground;
    assert!(e_puck.len() == 3 && e_puck.iter().all(|place| place[0] == 0.03), "{e_puck:?}");
}

/// Rays that were recorded: from, to, and whether something was met.
#[derive(Default)]
struct Drawn(Vec<([f32; 3], [f32; 3], bool)>);

impl Recorder for Drawn {
    fn ray(&mut self, from: [f32; 3], to: [f32; 3], met: bool) {
        self.0.push((from, to, met));
    }
    fn tick(&mut self, _: f64) {}
}

/// Rays of infrared sensors are drawn from the hull to a wall, and to the end of the range without one.
#[test]
fn infrared_rays_are_drawn_to_what_they_meet() {
    for robot in robots() {
        let [hull, range, height] = [robot.radius, robot.infrared.range, robot.height].map(|x| x as f32);
        let mut world = PlaneWorld::new();
        let body = world.add_robot(&robot, [0.3, -0.2], 0.6).body;
        let wall = 0.3 + hull + 0.4 * range;
        world.add_wall([[wall, -5.0], [wall, 5.0]], [1.0; 3]);
        let beams: Vec<Beam> =
            robot.infrared.angles.iter().map(|angle| Beam::in_cone(robot.radius, *angle, 0.0, 0, 1)).collect();
        let mut sensor = InfraredRays::new(body, beams, 1, 0.5 * height, range).unwrap();
        let mut x = vec![0.0; sensor.channels()];
        sensor.read(&world, &mut x);
        let drawing = InfraredDrawing::for_robot(&robot, x.len());
        assert_eq!(drawing.count(), x.len());
        let draw = |met| {
            let mut drawn = Drawn::default();
            drawing.record(world.pose(body), &x, met, &mut drawn);
            drawn.0
        };
        let seen = x.iter().filter(|x| **x > 0.0).count();
        assert!(seen > 0 && draw(true).len() == seen && draw(false).len() == x.len(), "{}: {x:?}", robot.name);
        for (from, to, met) in draw(false) {
            assert!((from[2] - 0.5 * height).abs() < 1e-6 && (to[2] - 0.5 * height).abs() < 1e-6);
            assert!(((from[0] - 0.3).hypot(from[1] + 0.2) - hull).abs() < 1e-6, "{}: {from:?}", robot.name);
            let length = (to[0] - from[0]).hypot(to[1] - from[1]);
            assert!(if met { (to[0] - wall).abs() < 1e-5 } else { (length - range).abs() < 1e-6 }, "{from:?} {to:?}");
        }
    }
    // One ray for each group, each alone where there are no such groups.
    let counts = [24, 8, 3, 1, 0, 7].map(|groups| InfraredDrawing::for_robot(&MobileRobot::marxbot(), groups).count());
    assert_eq!(counts, [24, 8, 3, 1, 24, 24]);
}
