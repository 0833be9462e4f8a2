//! The world of rapier against our articulated one and against closed forms. The figures next to the tolerances were
//! measured.

use crate::common::{CLOSED, POSES, SPHERES, WRIST, Wrist, ghost, hand_and_sphere, scene};
use farsa_body::actuators::Law;
use farsa_body::ports::{
    Actuated, ActuatorId, Arrange, BodyId, Contacts, ExternalForces, Handles, JointId, Joints, Kinematics, PairId,
    World as _,
};
use farsa_body::robot::{Collider, Joint, MassProperties, Robot, Segment, Shape, Surface};
use farsa_body::robots::{ArmAndHand, Tabletop};
use farsa_body::{Pose, Twist};
use farsa_num::sin_cos;
use farsa_physics::articulated;
use farsa_physics::rapier::{Options, World};

const RADIUS: f64 = 0.025;
const MASS: f64 = 0.05;

/// The first start of the experiment.
fn start<W: Arrange + Handles<Body = BodyId, Joint = JointId>>(world: &mut W) {
    world.clear();
    for (j, degrees) in POSES[0].into_iter().enumerate() {
        world.place_joint(JointId(j as u16), degrees.to_radians() as f32, 0.0);
    }
    world.place_body(Tabletop::SPHERE, Pose::at([10.0, 0.0, 0.0]), Twist::default());
    world.finish_placement();
}

/// Returns the largest and the final difference of `joints` between rapier and the limit of our world, over a second under
/// one command [rad]. The limit has 100 dynamics steps per control step.
fn joints_differ(joints: core::ops::Range<u16>, command: [f32; 2], options: Options) -> [f32; 2] {
    let robot = ghost(&scene());
    let fine = articulated::Options { substeps: 100, ..articulated::Options::default() };
    let mut ours = articulated::World::<f64>::new(articulated::Model::new(&robot, &fine).unwrap());
    let mut theirs = World::new(&robot, &options).unwrap();
    start(&mut ours);
    start(&mut theirs);
    let (mut most, mut last) = (0.0_f32, 0.0_f32);
    for _ in 0..100 {
        for j in joints.clone().map(ActuatorId) {
            ours.command(j, command);
            theirs.command(j, command);
        }
        ours.step();
        theirs.step();
        last = joints.clone().map(JointId).map(|j| (ours.position(j) - theirs.position(j)).abs()).fold(0.0, f32::max);
        most = most.max(last);
    }
    [most, last]
}

#[test]
fn joints_move_as_ours_do() {
    let fine = Options { substeps: 100, ..Options::default() };
    // Name, joints, command. Tolerances over the way and at the end, as it is stepped by default and 25 times as fine.
    // Our own world's 4 dynamics steps differ from their limit by 1.4 mrad (swing), 1.4 mrad (unequal) and 12 mrad
    // (servo).
    for (name, joints, command, usual, limit) in [
        ("swing", 0..7, [0.0, 0.0], [3e-3, 3e-3], [2e-4, 2e-4]),
        ("unequal activations", 0..7, [0.3, 0.1], [3e-3, 1e-3], [2e-4, 1e-4]),
        // Stalled at their stops the servos press 0.3 N m: rapier's stop yields by torque h2 / inertia, 3.1 mrad.
        ("servo step", 7..27, [0.8, 0.0], [2e-2, 5e-3], [1e-3, 1e-3]),
    ] {
        let one = joints_differ(joints.clone(), command, Options::default());
        let other = joints_differ(joints, command, fine);
        println!("{name}: {one:?}, finer {other:?} rad");
        assert!(one[0] < usual[0] && one[1] < usual[1], "{name}: {one:?}");
        assert!(other[0] < limit[0] && other[1] < limit[1], "{name}: {other:?}");
    }
}

/// The arm's angles after a tenth of a second from its first start, under these forces on bodies.
fn pushed<W>(world: &mut W, pushes: &[(BodyId, [f32; 3])]) -> Vec<f32>
where
    W: farsa_body::ports::World
        + Arrange
        + Handles<Body = BodyId, Joint = JointId>
        + Joints
        + Kinematics
        + ExternalForces,
{
    start(world);
    for _ in 0..10 {
        for (body, force) in pushes {
            world.apply_force(*body, world.origin(*body), *force);
        }
        world.step();
    }
    (0..7).map(|j| world.position(JointId(j))).collect()
}

/// The arm, pushed at its palm and at its elbow for a tenth of a second, moves as ours does.
#[test]
fn a_pushed_arm_moves_as_ours_does() {
    let robot = ghost(&scene());
    let options = articulated::Options { substeps: 100, ..articulated::Options::default() };
    let mut ours = articulated::World::new(articulated::Model::<f32>::new(&robot, &options).unwrap());
    let mut theirs = World::new(&robot, &Options { substeps: 100, ..Options::default() }).unwrap();
    let pushes = [(BodyId(6), [2.0, -1.0, 3.0]), (BodyId(3), [0.0, 4.0, 1.0])];
    let [free, ours] = [&[][..], &pushes].map(|pushes| pushed(&mut ours, pushes));
    let theirs = pushed(&mut theirs, &pushes);
    let way = ours.iter().zip(&free).fold(0.0_f32, |most, (a, b)| most.max((a - b).abs()));
    let apart = ours.iter().zip(&theirs).fold(0.0_f32, |most, (a, b)| most.max((a - b).abs()));
    println!("pushed by {way} rad, {apart} rad apart");
    assert!(way > 0.02 && apart < 0.02 * way, "{way} {apart}");
}

/// Two rods in a row, hinged about the y axis: mass, inertia, from hinge to center and to the next hinge.
const ROD: [f64; 4] = [0.2, 0.001, 0.13, 0.26];

fn rods() -> Robot {
    let [mass, inertia, centre, length] = ROD;
    let rod = MassProperties { mass, centre: [0.0, 0.0, -centre], inertia: [inertia, inertia, 1e-5, 0.0, 0.0, 0.0] };
    let mut robot = Robot::new("rods");
    let endless = [f64::NEG_INFINITY, f64::INFINITY];
    let hinge = |name: &str, z| Joint::revolute(name, [0.0, 1.0, 0.0], Pose::at([0.0, 0.0, z]), endless);
    let upper = robot.add_segment(Segment::new("upper", None, hinge("upper", 0.0), rod));
    robot.add_segment(Segment::new("lower", Some(upper), hinge("lower", -length), rod));
    robot
}

/// Returns the hinges' angles a second after their release at 1.2 and 0.3 rad, in steps of `h` in double precision. A step
/// is v += h a, q += h v with (M + h C) a = f. C is 0 for semi-implicit Euler. In rapier it is the sum of its
/// `update_mass_matrix`, the change of the centrifugal forces with the speeds. That sum has half of the lower rod's
/// rotation where the upper one's alone carries the hinge.
fn swung(h: f64, coriolis: bool) -> [f64; 2] {
    let [m, inertia, l, length] = ROD;
    let (mut q, mut v) = ([f64::from(1.2_f32), f64::from(0.3_f32)], [0.0; 2]);
    for _ in 0..(1.0 / h).round() as u32 {
        let (s1, c1) = sin_cos(q[0]);
        let (s2, c2) = sin_cos(q[0] + q[1]);
        let [w1, w2] = [v[0], v[0] + v[1]];
        // From hinge to center, from center to hinge, from hinge to center.
        let arms = [[-l * s1, -l * c1], [-(length - l) * s1, -(length - l) * c1], [-l * s2, -l * c2]];
        let turned = |r: [f64; 2]| [r[1], -r[0]];
        let sum = |a: [f64; 2], b: [f64; 2]| [a[0] + b[0], a[1] + b[1]];
        let times = |a: [f64; 2], x: f64| [a[0] * x, a[1] * x];
        let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
        let reach = sum(sum(arms[0], arms[1]), arms[2]);
        // Columns of the centers' Jacobians, their centripetal accelerations, and how these change with the speeds.
        let jacobians = [[turned(arms[0]), [0.0; 2]], [turned(reach), turned(arms[2])]];
        let first = times(arms[0], -w1 * w1);
        let second = sum(sum(first, times(arms[1], -w1 * w1)), times(arms[2], -w2 * w2));
        let held = times(arms[0], -2.0 * w1);
        let carried = sum(held, times(arms[1], -(w1 + w2)));
        let changes = [[held, [0.0; 2]], [sum(carried, times(arms[2], -2.0 * w2)), times(arms[2], -2.0 * w2)]];
        let mut matrix = [[2.0 * inertia, inertia], [inertia, inertia]];
        let mut force = [0.0; 2];
        for ((jacobian, change), bias) in jacobians.iter().zip(changes).zip([first, second]) {
            for i in 0..2 {
                force[i] += m * dot(jacobian[i], sum([0.0, -9.81], times(bias, -1.0)));
                for j in 0..2 {
                    let implicit = if coriolis { times(change[j], h) } else { [0.0; 2] };
                    matrix[i][j] += m * dot(jacobian[i], sum(jacobian[j], implicit));
                }
            }
        }
        let [[a, b], [c, d]] = matrix;
        let determinant = a * d - b * c;
        v = sum(v, times([d * force[0] - b * force[1], a * force[1] - c * force[0]], h / determinant));
        q = sum(q, times(v, h));
    }
    q
}

#[test]
fn rapier_takes_coriolis_forces_implicitly() {
    let robot = rods();
    for (h, substeps) in [(2.5e-3, 4), (1e-3, 10), (4e-4, 25), (1e-4, 100)] {
        let mut theirs = World::new(&robot, &Options { substeps, ..Options::default() }).unwrap();
        let options = articulated::Options { substeps, ..articulated::Options::default() };
        let mut ours = articulated::World::<f64>::new(articulated::Model::new(&robot, &options).unwrap());
        let [found, own] = [after_a_second(&mut theirs), after_a_second(&mut ours)];
        let [implicit, explicit] = [true, false].map(|coriolis| swung(h, coriolis));
        let off = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).abs().max((a[1] - b[1]).abs());
        let apart = off(implicit, explicit);
        println!("{h}: rapier {:.1e}, ours {:.1e}; apart {apart:.1e} rad", off(found, implicit), off(own, explicit));
        // Both differ from the limit by the order of the step. From their own rule by rounding alone.
        assert!(off(own, explicit) < 1e-6 && apart > 5.0 * h, "{h}: {own:?} {explicit:?}, {apart}");
        assert!(off(found, implicit) < 1e-4 && off(found, implicit) < 0.02 * apart, "{h}: {found:?} {implicit:?}");
    }
}

fn after_a_second<W>(world: &mut W) -> [f64; 2]
where
    W: farsa_body::ports::World + Joints + Arrange + Handles<Joint = JointId>,
{
    world.place_joint(JointId(0), 1.2, 0.0);
    world.place_joint(JointId(1), 0.3, 0.0);
    world.finish_placement();
    for _ in 0..100 {
        world.step();
    }
    [0, 1].map(|j| f64::from(world.position(JointId(j))))
}

/// A walker whose foot is lifted from the ground, or whose ground is taken away, must not be struck by what it stood on.
#[test]
fn a_body_that_is_moved_keeps_its_speeds() {
    let mut robot = Robot::new("foot");
    let rail = Joint::prismatic("rail", [0.0, 0.0, 1.0], Pose::identity(), [-10.0, 10.0]);
    let ball = Shape::Sphere { radius: RADIUS };
    let foot = robot.add_segment(Segment::new("foot", None, rail, MassProperties::from_shape(&ball, MASS)));
    let skin = Collider::new("foot", Some(foot), ball, Pose::identity());
    let pair = [skin, Collider::new("ground", None, Shape::Plane, Pose::identity())].map(|c| robot.add_collider(c));
    robot.add_pair(pair, surface(1.0, 0.0));
    let mut world = World::new(&robot, &Options::default()).unwrap();
    for _ in 0..20 {
        world.step();
    }
    assert!(world.touches(PairId(0)));
    world.place_joint(JointId(0), 1.0, -0.5);
    world.finish_placement();
    assert_eq!((world.position(JointId(0)), world.speed(JointId(0))), (1.0, -0.5));
    assert!(!world.touches(PairId(0)), "{:?}", world.pair_contact(PairId(0)));
    // Put into the ground it is not slowed down before time passes.
    world.place_joint(JointId(0), 0.024, -0.5);
    world.finish_placement();
    assert_eq!(world.speed(JointId(0)), -0.5);
    world.step();
    assert!(world.speed(JointId(0)) > -0.1);
}

/// Builds a floating trunk with its center of mass off its origin, a slide and a hinge on it, and a fixed head.
fn floating() -> Robot {
    let mut robot = Robot::new("floating");
    let brick = |mass, at| MassProperties::cuboid(mass, [0.03, 0.05, 0.02]).placed(&Pose::at(at));
    let start = Pose { position: [0.1, 0.2, 0.3], rotation: [0.5, 0.5, -0.5, 0.5] };
    let trunk = robot.add_segment(Segment::new("trunk", None, Joint::floating(start), brick(0.4, [0.02, -0.01, 0.03])));
    let slide = Joint::prismatic("slide", [1.0, 2.0, 0.0], Pose::at([0.05, 0.0, 0.0]), [-0.1, 0.1]).with_damping(0.3);
    robot.add_segment(Segment::new("arm", Some(trunk), slide, brick(0.2, [0.0, 0.0, 0.04])));
    let hinge = Joint::revolute("hinge", [0.0, 1.0, 0.0], Pose::at([-0.05, 0.0, 0.0]), [-3.0, 3.0]).with_armature(1e-4);
    let leg = robot.add_segment(Segment::new("leg", Some(trunk), hinge, brick(0.1, [0.0, 0.0, -0.05])));
    let neck = Joint::fixed(Pose::at([0.0, 0.02, -0.1]));
    robot.add_segment(Segment::new("foot", Some(leg), neck, brick(0.05, [0.0; 3])));
    robot
}

/// Thrown, turning, both joints moving.
fn throw<W: Arrange + Handles<Body = BodyId, Joint = JointId>>(world: &mut W) {
    let twist = Twist { linear: [0.3, -0.2, 1.0], angular: [1.0, -2.0, 0.5] };
    world.place_body(BodyId(0), Pose { position: [0.1, 0.2, 0.3], rotation: [0.5, -0.5, 0.5, 0.5] }, twist);
    world.place_joint(JointId(1), 0.02, -0.1);
    world.place_joint(JointId(2), -0.4, 3.0);
    world.finish_placement();
}

#[test]
fn a_floating_robot_tumbles_as_ours_does() {
    let robot = floating();
    let fine = articulated::Options { substeps: 100, ..articulated::Options::default() };
    let mut ours = articulated::World::<f64>::new(articulated::Model::new(&robot, &fine).unwrap());
    let mut theirs = World::new(&robot, &Options { substeps: 100, ..Options::default() }).unwrap();
    throw(&mut ours);
    throw(&mut theirs);
    let mut most = [0.0_f32; 3];
    for _ in 0..50 {
        for body in (0..4).map(BodyId) {
            let (a, b) = (ours.pose(body), theirs.pose(body));
            let (u, v) = (ours.velocity(body), theirs.velocity(body));
            for k in 0..3 {
                most[0] = most[0].max((a.position[k] - b.position[k]).abs());
                most[1] = most[1].max((u.linear[k] - v.linear[k]).abs());
                most[2] = most[2].max((u.angular[k] - v.angular[k]).abs());
            }
        }
        ours.step();
        theirs.step();
    }
    println!("{most:?} m, m/s, rad/s");
    assert!(most[0] < 1e-3 && most[1] < 5e-3 && most[2] < 5e-2, "{most:?}");
}

fn surface(friction: f64, rolling_friction: f64) -> Surface {
    Surface { friction, rolling_friction, stiffness: 1e5, damping: 300.0 }
}

/// A thing of this shape, 50 g, and a ground.
fn thing_on(shape: Shape, ground: Shape, placement: Pose<f64>, surface: Surface) -> Robot {
    let mut robot = Robot::new("thing");
    let start = Joint::floating(Pose::at([0.0, 0.0, RADIUS]));
    let thing = robot.add_segment(Segment::new("thing", None, start, MassProperties::from_shape(&shape, MASS)));
    let pair = [
        Collider::new("thing", Some(thing), shape, Pose::identity()),
        Collider::new("ground", None, ground, placement),
    ];
    let pair = pair.map(|collider| robot.add_collider(collider));
    robot.add_pair(pair, surface);
    robot
}

fn ball(surface: Surface) -> World {
    let shape = Shape::Sphere { radius: RADIUS };
    World::new(&thing_on(shape, Shape::Plane, Pose::identity(), surface), &Options::default()).unwrap()
}

#[test]
fn a_ball_rests_rolls_and_stops() {
    // On the experiment's table it sinks 17 um. In rapier's own settings, made for persons, a centimeter.
    let mut world = World::new(&scene(), &Options::default()).unwrap();
    let [x, y] = SPHERES[2].map(|x| x as f32);
    world.place_body(Tabletop::SPHERE, Pose::at([x, y, 0.025]), Twist::default());
    world.finish_placement();
    for _ in 0..300 {
        world.step();
    }
    let p = world.pose(Tabletop::SPHERE).position;
    println!("sinks {:.1e} m", 0.025 - p[2]);
    assert!(0.025 - p[2] < 5e-4 && (p[0] - x).abs() < 1e-4 && (p[1] - y).abs() < 1e-4, "{p:?}");
    let pair = scene().pair("sphere", "table").unwrap();
    let contact = world.pair_contact(pair);
    assert!((contact.normal_force - (MASS * 9.81) as f32).abs() < 1e-3 && contact.points == 1, "{contact:?}");
    assert!(contact.depth > 0.0 && contact.depth < 5e-4 && contact.force[2] > 0.48, "{contact:?}");
    let free = Tabletop { sphere_start: [0.2, 0.0], ..Tabletop::default() };
    assert_eq!(free.scene(&ArmAndHand::default()).unwrap().pairs.len(), world.pairs());

    // Thrown along the ground it slides with mu g, then rolls with 5/7 of its speed.
    let mut world = ball(surface(0.3, 0.0));
    world.place_body(BodyId(0), Pose::at([0.0, 0.0, 0.025]), Twist { linear: [1.0, 0.0, 0.0], angular: [0.0; 3] });
    world.finish_placement();
    for _ in 0..5 {
        world.step();
    }
    let sliding = world.pair_contact(PairId(0));
    let share = -sliding.force[0] / sliding.normal_force;
    assert!((share - 0.3).abs() < 1e-3, "{share} of the normal force");
    assert!((world.velocity(BodyId(0)).linear[0] - (1.0 - 0.3 * 9.81 * 0.05)).abs() < 0.01);
    for _ in 0..45 {
        world.step();
    }
    let speed = world.velocity(BodyId(0)).linear[0];
    println!("rolls at {speed} of 5/7");
    assert!((speed - 5.0 / 7.0).abs() < 0.01, "{speed} m/s");

    // Rolling friction slows it down by 5/7 g mu_r / r, and it stays where it stops.
    let mut world = ball(surface(1.0, 5e-4));
    let v = 0.2_f32;
    let twist = Twist { linear: [v, 0.0, 0.0], angular: [0.0, v / 0.025, 0.0] };
    world.place_body(BodyId(0), Pose::at([0.0, 0.0, 0.025]), twist);
    world.finish_placement();
    for _ in 0..100 {
        world.step();
    }
    let (speed, closed) = (world.velocity(BodyId(0)).linear[0], v - (5.0 / 7.0 * 9.81 * 5e-4 / 0.025) as f32);
    println!("slowed to {speed}, {closed} m/s");
    assert!((speed - closed).abs() < 2e-3, "{speed} {closed}");
    for _ in 0..150 {
        world.step();
    }
    assert!(world.velocity(BodyId(0)).linear[0].abs() < 1e-4, "{:?}", world.velocity(BodyId(0)));
}

#[test]
fn a_box_slips_if_and_only_if_the_slope_is_steeper_than_friction() {
    for (mu, degrees, slips) in
        [(0.5_f64, 24.0_f64, false), (0.5, 29.0, true), (1.0, 43.0, false), (1.0, 47.0, true), (0.2, 13.0, true)]
    {
        let (half_sin, half_cos) = sin_cos(degrees.to_radians() / 2.0);
        let (sin, cos) = sin_cos(degrees.to_radians());
        let tilt = [0.0, half_sin, 0.0, half_cos];
        let shape = Shape::Box { half: [RADIUS, RADIUS, RADIUS / 2.0] };
        let slope = Pose { position: [0.0; 3], rotation: tilt };
        let mut world =
            World::new(&thing_on(shape, Shape::Plane, slope, surface(mu, 0.0)), &Options::default()).unwrap();
        let up = [sin * RADIUS / 2.0, 0.0, cos * RADIUS / 2.0];
        world.place_body(BodyId(0), Pose { position: up, rotation: tilt }.cast(), Twist::default());
        world.finish_placement();
        for _ in 0..100 {
            world.step();
        }
        let p = world.pose(BodyId(0)).position;
        let (dx, dz) = (f64::from(p[0]) - up[0], f64::from(p[2]) - up[2]);
        let moved = (dx * dx + dz * dz).sqrt();
        let slides = 0.5 * 9.81 * (sin - mu * cos);
        println!("mu {mu}, {degrees} deg: moved {:.2} mm, {:.2} mm by the formula", moved * 1e3, slides * 1e3);
        if slips {
            assert!((moved - slides).abs() < 0.05 * slides + 2e-3, "mu {mu}, {degrees} deg: {moved}");
        } else {
            assert!(moved < 1e-3, "mu {mu}, {degrees} deg: {moved}");
        }
    }
}

#[test]
fn a_pinch_holds_the_sphere() {
    let arm = ArmAndHand::default();
    let robot = hand_and_sphere(Wrist::Fixed, arm.surface, Some(Law::Servo(arm.servo)));
    // The sphere is pressed into the palm until the fingers have closed. Then it hangs in them.
    let mut world = World::new(&robot, &Options { gravity: [0.0, 0.0, 2.0], ..Options::default() }).unwrap();
    let at = [WRIST[0] + 0.0775, WRIST[1], WRIST[2] - 0.0355].map(|x| x as f32);
    world.place_body(Tabletop::SPHERE, Pose::at(at), Twist::default());
    world.finish_placement();
    for (group, y) in arm.servo_groups().iter().zip(CLOSED) {
        for s in group {
            world.command(ActuatorId(s.servo.0 - 7), [s.from + (s.to - s.from) * y, 0.0]);
        }
    }
    let mut held = [0.0; 3];
    for t in 0..500 {
        if t == 60 {
            world.physics_mut().gravity = [0.0, 0.0, -9.81].into();
        }
        if t == 100 {
            held = world.pose(Tabletop::SPHERE).position;
        }
        world.step();
    }
    let p = world.pose(Tabletop::SPHERE).position;
    let fell = held[2] - p[2];
    let touching = (0..world.pairs()).filter(|p| world.touches(PairId(*p as u16))).count();
    println!("{touching} pairs touch; in 4 s it fell by {fell:e} m");
    assert!(touching >= 3 && fell.abs() < 1e-3);
    // The force of the hand on the sphere carries its weight.
    let up: f32 = (0..world.pairs() as u16)
        .map(PairId)
        .map(|pair| (world.pair_bodies(pair), world.pair_contact(pair).force[2]))
        .map(|(bodies, force)| match bodies {
            [_, Some(Tabletop::SPHERE)] => -force,
            [Some(Tabletop::SPHERE), _] => force,
            _ => 0.0,
        })
        .sum();
    println!("carried with {up} N");
    assert!((up - (MASS * 9.81) as f32).abs() < 0.05, "{up} N");
}

/// Joints without actuators that have springs, dampers and dry friction: they swing and come to rest as ours do.
#[test]
fn springs_and_dry_friction_of_joints_are_as_ours() {
    for (name, [stiffness, damping, friction], tolerance) in
        [("spring", [4.0, 0.2, 0.0], 3e-3), ("dry friction", [0.0, 0.0, 0.3], 3e-3), ("both", [4.0, 0.0, 0.3], 3e-3)]
    {
        let mut robot = Robot::new("chain");
        let mut parent = None;
        for i in 0..3_u16 {
            let at = Pose::at([0.0, 0.0, if i == 0 { 1.0 } else { -0.3 }]);
            let joint = Joint::revolute(&format!("J{i}"), [0.0, 1.0, 0.0], at, [-10.0, 10.0]);
            let joint = joint.with_spring(stiffness, 0.3).with_damping(damping).with_friction(friction);
            let rod = MassProperties::capsule(0.5, 0.02, 0.15).placed(&Pose::at([0.0, 0.0, -0.15]));
            parent = Some(robot.add_segment(Segment::new(&format!("rod{i}"), parent, joint, rod)));
        }
        let fine = articulated::Options { substeps: 100, sweeps: 100, ..articulated::Options::default() };
        let mut ours = articulated::World::<f64>::new(articulated::Model::new(&robot, &fine).unwrap());
        let mut theirs = World::new(&robot, &Options { substeps: 100, ..Options::default() }).unwrap();
        ours.place_joint(JointId(0), 1.0, 0.0);
        theirs.place_joint(JointId(0), 1.0, 0.0);
        ours.finish_placement();
        theirs.finish_placement();
        let mut most = 0.0_f32;
        for _ in 0..100 {
            ours.step();
            theirs.step();
            let differences = (0..3).map(JointId).map(|j| (ours.position(j) - theirs.position(j)).abs());
            most = differences.fold(most, f32::max);
        }
        println!("{name}: {most:.1e} rad");
        assert!(most < tolerance, "{name}: {most} rad");
    }
}
