//! Restitution of contacts against closed forms, in one world, in lanes and in rapier.

use farsa_body::ports::{Arrange as _, BodyId, Kinematics as _, PairId, World as _};
use farsa_body::robot::{Collider, Joint, MassProperties, Robot, Segment, Shape, SoftContact, Surface};
use farsa_body::{Pose, Twist};
use farsa_physics::articulated::{Model, Options, World};

const RADIUS: f64 = 0.05;
const SURFACE: Surface = Surface { friction: 0.5, rolling_friction: 0.0, stiffness: 1e5, damping: 300.0 };
/// MuJoCo's words for a soft contact with a margin.
const SOFT: SoftContact =
    SoftContact { inertia: 1.0, friction: [50.0, 1.0], margin: 0.002, is_pyramid: false, impedance: None };

/// A ball at a height above a floor.
fn ball(height: f64, restitution: f64, soft: Option<SoftContact>) -> Robot {
    let mut robot = Robot::new("ball");
    let start = Joint::floating(Pose::at([0.0, 0.0, RADIUS + height]));
    let body = robot.add_segment(Segment::new("ball", None, start, MassProperties::sphere(0.2, RADIUS)));
    let skin = Collider::new("skin", Some(body), Shape::Sphere { radius: RADIUS }, Pose::identity());
    let floor = Collider::new("floor", None, Shape::Plane, Pose::identity());
    let pair = [skin, floor].map(|collider| robot.add_collider(collider));
    let pair = robot.add_pair(pair, SURFACE);
    robot.pairs[pair.index()].restitution = restitution;
    robot.pairs[pair.index()].soft = soft;
    robot
}

fn options(h: f64) -> Options {
    Options { time_step: h, substeps: 1, ..Options::default() }
}

/// Heights of the first peaks.
fn peaks(heights: impl Iterator<Item = f64>, count: usize) -> Vec<f64> {
    let (mut peaks, mut last, mut rising) = (Vec::new(), f64::INFINITY, false);
    for height in heights {
        if rising && height < last {
            peaks.push(last);
        }
        rising = height >= last;
        last = height;
        if peaks.len() == count {
            break;
        }
    }
    peaks
}

fn world_of(robot: &Robot, h: f64) -> World<f64> {
    World::new(Model::new(robot, &options(h)).unwrap())
}

/// A ball that falls from 0.5 m rises to e^2, e^4 and e^6 of it. The error is of the first order in the step: the speed of
/// the impact is that of the last step, and the impact is up to one step early.
#[test]
fn a_ball_rises_to_the_share_of_its_height() {
    for soft in [None, Some(SOFT)] {
        let margin = soft.map_or(0.0, |soft| soft.margin);
        for (h, tolerance) in [(1e-3, 6e-3), (2.5e-4, 1.5e-3)] {
            let mut worst = 0.0_f64;
            for restitution in [0.3, 0.5, 0.7, 0.9, 1.0] {
                let mut world = world_of(&ball(0.5 + margin, restitution, soft), h);
                let heights = (0..(3.0 / h) as usize).map(|_| {
                    world.step();
                    world.positions()[2] - RADIUS - margin
                });
                let found = peaks(heights, 3);
                assert_eq!(found.len(), 3, "{restitution}");
                let mut wanted = 0.5;
                for peak in found {
                    wanted *= restitution * restitution;
                    // A peak of some millimeters is one of a few steps.
                    if wanted > 0.02 {
                        worst = worst.max((peak - wanted).abs() / 0.5);
                    }
                }
            }
            println!("step {h}, margin {margin}: {worst:.1e} of the height");
            assert!(worst < tolerance, "{h} s: {worst}");
        }
    }
}

/// Two free balls in line: speeds after the impact follow from momentum and restitution.
#[test]
fn balls_that_meet_keep_momentum_and_the_share_of_their_approach() {
    for (masses, speeds, restitution) in
        [([0.2, 0.2], [1.0, 0.0], 1.0), ([0.1, 0.4], [2.0, -1.0], 0.6), ([1.0, 0.05], [0.5, -3.0], 0.25)]
    {
        let mut robot = Robot::new("balls");
        for (i, mass) in masses.into_iter().enumerate() {
            let start = Joint::floating(Pose::identity());
            let body =
                robot.add_segment(Segment::new(&format!("ball{i}"), None, start, MassProperties::sphere(mass, RADIUS)));
            let shape = Shape::Sphere { radius: RADIUS };
            robot.add_collider(Collider::new(&format!("skin{i}"), Some(body), shape, Pose::identity()));
        }
        let pair = robot.add_pair([0, 1], SURFACE);
        robot.pairs[pair.index()].restitution = restitution;
        let options = Options { gravity: [0.0; 3], ..options(1e-3) };
        let mut world = World::<f64>::new(Model::new(&robot, &options).unwrap());
        for (i, (x, v)) in [0.0, 0.3].into_iter().zip(speeds).enumerate() {
            let twist = Twist { linear: [v as f32, 0.0, 0.0], angular: [0.0; 3] };
            world.place_body(BodyId(i as u16), Pose::at([x, 0.0, 0.0]), twist);
        }
        world.finish_placement();
        for _ in 0..400 {
            world.step();
        }
        let centre = (masses[0] * speeds[0] + masses[1] * speeds[1]) / (masses[0] + masses[1]);
        let rebound = restitution * (speeds[0] - speeds[1]) / (masses[0] + masses[1]);
        let wanted = [centre - masses[1] * rebound, centre + masses[0] * rebound];
        for (i, wanted) in wanted.into_iter().enumerate() {
            let found = world.velocities()[6 * i + 3];
            assert!((found - wanted).abs() < 1e-9, "ball {i}: {found}, not {wanted}");
        }
    }
}

/// A rod that falls level on a stop at its end: the impulse is `(1 + e) v / (1 / m + r^2 / I)`.
#[test]
fn a_rod_that_hits_with_its_end_turns_as_newton_says() {
    let (mass, half, speed, restitution) = (0.6, 0.3, 2.0, 0.5);
    let mut robot = Robot::new("rod");
    let body = MassProperties { mass, centre: [0.0; 3], inertia: [1e-3, 0.02, 0.02, 0.0, 0.0, 0.0] };
    let rod = robot.add_segment(Segment::new("rod", None, Joint::floating(Pose::identity()), body));
    let tip = Pose::at([half, 0.0, 0.0]);
    let tip = robot.add_collider(Collider::new("tip", Some(rod), Shape::Sphere { radius: RADIUS }, tip));
    let floor = robot.add_collider(Collider::new("floor", None, Shape::Plane, Pose::at([0.0, 0.0, -0.2])));
    let pair = robot.add_pair([tip, floor], Surface { friction: 0.0, ..SURFACE });
    robot.pairs[pair.index()].restitution = restitution;
    let options = Options { gravity: [0.0; 3], ..options(1e-3) };
    let mut world = World::<f64>::new(Model::new(&robot, &options).unwrap());
    world.place_body(BodyId(0), Pose::identity(), Twist { linear: [0.0, 0.0, -speed as f32], angular: [0.0; 3] });
    world.finish_placement();
    while world.velocities()[5] == -speed {
        world.step();
    }
    let impulse = (1.0 + restitution) * speed / (1.0 / mass + half * half / 0.02);
    let [spin, rise] = [world.velocities()[1], world.velocities()[5]];
    assert!((rise - (impulse / mass - speed)).abs() < 1e-9, "{rise}");
    assert!((spin + impulse * half / 0.02).abs() < 1e-9, "{spin}");
}

/// A bouncing ball ends at rest where its weight is held, as a ball without restitution.
#[test]
fn a_bouncing_ball_comes_to_rest() {
    for h in [1e-3, 4e-3] {
        let mut world = world_of(&ball(0.1, 0.8, None), h);
        for _ in 0..(6.0 / h) as usize {
            world.step();
        }
        let depth = RADIUS - world.positions()[2];
        assert!((depth - 0.2 * 9.81 / 1e5).abs() < 1e-7, "{depth}");
        assert!(world.velocities()[5].abs() < 1e-6 && world.touches_floor(), "{:?}", world.velocities());
    }
}

/// Access to the only pair.
trait Touches {
    fn touches_floor(&self) -> bool;
}

impl Touches for World<f64> {
    fn touches_floor(&self) -> bool {
        farsa_body::ports::Contacts::touches(self, PairId(0))
    }
}

/// Balls, capsules and boxes that fall on a floor and on each other, hard and soft.
fn heap() -> Robot {
    let mut robot = Robot::new("heap");
    let floor = robot.add_collider(Collider::new("floor", None, Shape::Plane, Pose::identity()));
    let shapes = [
        Shape::Sphere { radius: 0.05 },
        Shape::Capsule { radius: 0.03, half_length: 0.06 },
        Shape::Box { half: [0.05, 0.04, 0.03] },
    ];
    for (i, shape) in shapes.into_iter().enumerate() {
        let start = Joint::floating(Pose::at([0.0, 0.0, 0.2 + 0.2 * i as f64]));
        let mass = MassProperties::from_shape(&shape, 0.3);
        let body = robot.add_segment(Segment::new(&format!("thing{i}"), None, start, mass));
        let skin = robot.add_collider(Collider::new(&format!("skin{i}"), Some(body), shape, Pose::identity()));
        for other in 0..skin {
            let pair = robot.add_pair([skin, other], SURFACE);
            robot.pairs[pair.index()].restitution = 0.4 + 0.2 * other as f64;
            robot.pairs[pair.index()].soft = (i == 1).then_some(SOFT);
        }
    }
    assert_eq!(floor, 0);
    robot
}

#[test]
fn bounces_have_equal_bits_in_lanes() {
    for path_error in [None, Some(1e-4)] {
        let model = Model::new(&heap(), &Options { path_error, ..options(4e-3) }).unwrap();
        crate::lanes_have_the_bits_of_the_world(&model, 150, |world, stream, step| {
            if step % 75 == 0 {
                for i in 0..3 {
                    let at = [stream.range(-0.03, 0.03), stream.range(-0.03, 0.03), 0.15 + 0.15 * f32::from(i)];
                    let angular = [stream.range(-5.0, 5.0), stream.range(-5.0, 5.0), 0.0];
                    let twist = Twist { linear: [0.0, 0.0, stream.range(-3.0, 0.0)], angular };
                    world.place_body(BodyId(i), Pose::at(at), twist);
                }
                world.finish_placement();
            }
        });
    }
}

/// rapier's own restitution, within the time resolution of its steps.
#[cfg(feature = "rapier")]
#[test]
fn a_ball_bounces_in_rapier() {
    for restitution in [0.5, 0.9] {
        let options = farsa_physics::rapier::Options::default();
        let mut world = farsa_physics::rapier::World::new(&ball(0.5, restitution, None), &options).unwrap();
        let heights = (0..150).map(|_| {
            world.step();
            f64::from(world.pose(BodyId(0)).position[2]) - RADIUS
        });
        let peak = peaks(heights, 1)[0];
        let wanted = 0.5 * restitution * restitution;
        println!("rapier, {restitution}: {peak:.4} m instead of {wanted:.4} m");
        assert!((peak / wanted - 1.0).abs() < 0.05, "{restitution}: {peak}");
    }
}
