//! Descriptions put together: bodies of bodies, robots of robots, things on tables, covers on colliders.

use farsa_body::Pose;
use farsa_body::actuators::{Law, Torque};
use farsa_body::kinematics::{InverseKinematicsError, KinematicTree, Solution};
use farsa_body::ports::{BodyId, JointId};
use farsa_body::robot::{Collider, Ground, Joint, MassProperties, Robot, RobotError, Segment, Shape, Surface, Visual};
use farsa_body::robots::{ArmAndHand, Hand, Icub, IcubTabletop, Side, Tabletop};
use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;

fn matrix([xx, yy, zz, xy, xz, yz]: [f64; 6]) -> Matrix3<f64> {
    Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
}

fn pose() -> impl Strategy<Value = Pose<f64>> {
    let turn = prop::array::uniform4(-1.0_f64..1.0)
        .prop_filter("a direction", |q| q.iter().map(|x| x * x).sum::<f64>() > 0.01);
    (prop::array::uniform3(-2.0..2.0), turn).prop_map(|(position, q)| {
        let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
        Pose { position, rotation: q.map(|x| x / length) }
    })
}

/// Returns the difference of two bodies.
fn apart(a: &MassProperties, b: &MassProperties) -> f64 {
    let centre = (Vector3::from(a.centre) - Vector3::from(b.centre)).norm();
    (a.mass - b.mass).abs() + centre + (matrix(a.inertia) - matrix(b.inertia)).norm()
}

proptest! {
    /// Any points, joined in any order: mass, mean place and the sum of m (r^2 1 - r r') about it.
    #[test]
    fn joined_points_have_the_inertia_of_their_sum(
        points in prop::collection::vec((0.1_f64..3.0, prop::array::uniform3(-1.0_f64..1.0)), 2..7), at in 1_usize..6,
    ) {
        let of = |points: &[(f64, [f64; 3])]| {
            let bodies = points.iter().map(|&(mass, centre)| MassProperties { mass, centre, inertia: [0.0; 6] });
            bodies.reduce(|a, b| a.with(&b)).unwrap()
        };
        let mass: f64 = points.iter().map(|point| point.0).sum();
        let centre = points.iter().map(|(mass, place)| Vector3::from(*place) * *mass).sum::<Vector3<f64>>() / mass;
        let about = |&(mass, place): &(f64, [f64; 3])| {
            let r = Vector3::from(place) - centre;
            (Matrix3::identity() * r.norm_squared() - r * r.transpose()) * mass
        };
        let inertia: Matrix3<f64> = points.iter().map(about).sum();
        let (first, last) = points.split_at(at.min(points.len() - 1));
        for joined in [of(&points), of(first).with(&of(last)), of(last).with(&of(first))] {
            prop_assert!((joined.mass - mass).abs() < 1e-12 && (Vector3::from(joined.centre) - centre).norm() < 1e-12);
            prop_assert!((matrix(joined.inertia) - inertia).norm() < 1e-11, "{:?} {}", joined, inertia);
        }
        // The moment about any axis through the middle is never negative.
        prop_assert!(of(&points).is_physical(false));
    }

    /// Two halves of a cylinder and of a box make the whole, however they lie.
    #[test]
    fn halves_make_the_whole(
        pose in pose(), mass in 0.1_f64..5.0, radius in 0.05_f64..0.5, half in prop::array::uniform3(0.05_f64..0.5),
    ) {
        let length = half[2];
        let at = |z: f64| pose.compose(&Pose::at([0.0, 0.0, z]));
        let disc = MassProperties::cylinder(mass, radius, length);
        let halves = disc.placed(&at(length)).with(&disc.placed(&at(-length)));
        let whole = MassProperties::cylinder(2.0 * mass, radius, 2.0 * length).placed(&pose);
        prop_assert!(apart(&halves, &whole) < 1e-11, "{:?} {:?}", halves, whole);
        let part = MassProperties::cuboid(mass, half);
        let halves = part.placed(&at(length)).with(&part.placed(&at(-length)));
        let whole = MassProperties::cuboid(2.0 * mass, [half[0], half[1], 2.0 * length]).placed(&pose);
        prop_assert!(apart(&halves, &whole) < 1e-11, "{:?} {:?}", halves, whole);
        // A quarter and three quarters do, too.
        let thin = MassProperties::cylinder(0.5 * mass, radius, 0.5 * length).placed(&at(-1.5 * length));
        let thick = MassProperties::cylinder(1.5 * mass, radius, 1.5 * length).placed(&at(0.5 * length));
        let whole = MassProperties::cylinder(2.0 * mass, radius, 2.0 * length).placed(&pose);
        prop_assert!(apart(&thin.with(&thick), &whole) < 1e-11);
    }
}

const SURFACE: Surface = Surface { friction: 1.0, rolling_friction: 0.0, stiffness: 1e4, damping: 10.0 };

/// Beads on a string, each turning on the one before, all pairs of every other one in groups. And a puck that slides.
fn beads(count: u16) -> Robot {
    let mut robot = Robot::new("beads");
    let ball = MassProperties::sphere(1.0, 0.1);
    let mut parent = None;
    for bead in 0..count {
        let joint = Joint::revolute(&format!("joint {bead}"), [0.0, 1.0, 0.0], Pose::at([0.2, 0.0, 0.0]), [-1.0, 1.0]);
        let body = robot.add_segment(Segment::new(&format!("bead {bead}"), parent, joint, ball));
        assert_eq!(robot.body(&format!("bead {bead}")), Some(body));
        let shape = Shape::Sphere { radius: 0.05 };
        let collider = robot.add_collider(Collider::new(&format!("ball {bead}"), Some(body), shape, Pose::identity()));
        assert_eq!(robot.collider(&format!("ball {bead}")), Some(collider));
        let limit = f64::from(bead + 1);
        let law = Law::Torque(Torque { limit });
        let motor = robot.add_actuator(&format!("motor {bead}"), JointId(body.0), law);
        assert_eq!(robot.actuator(&format!("motor {bead}")), Some(motor));
        assert_eq!(robot.actuators[motor.index()].law, law);
        parent = Some(body);
    }
    let pair = robot.add_pair([0, 2], SURFACE);
    assert_eq!(robot.pair("ball 2", "ball 0"), Some(pair));
    robot.add_pair_group([[0, 3], [1, 3]], SURFACE);
    robot.add_pair_group([[0, 4], [1, 4], [2, 4]], SURFACE);
    let pair = robot.add_pair([3, 5], SURFACE);
    assert_eq!(robot.pair("ball 3", "ball 5"), Some(pair));
    let puck = robot.add_sliding_body("puck", Pose::at([1.0, 0.0, 0.0]), ball, true);
    robot.add_ground(Ground { body: puck, friction: 0.5, load: 9.81, radius: 0.05 });
    robot.add_visual(Visual::new(Some(puck), Shape::Sphere { radius: 0.1 }, Pose::identity()));
    robot
}

/// Which pairs lie in which other's group.
fn together(robot: &Robot) -> Vec<Vec<bool>> {
    let same = |a: Option<u16>, b: Option<u16>| a.is_some() && a == b;
    robot.pairs.iter().map(|a| robot.pairs.iter().map(|b| same(a.group, b.group)).collect()).collect()
}

#[test]
fn merged_robots_move_and_meet_as_before() {
    let one = beads(6);
    let groups = together(&one);
    assert_eq!(
        groups.iter().map(|row| row.iter().filter(|same| **same).count()).collect::<Vec<_>>(),
        [0, 2, 2, 3, 3, 3, 0]
    );
    let mut all = Robot::new("all");
    let offsets = ["a ", "b ", "c "].map(|prefix| all.merge(&one.prefixed(prefix)));
    assert_eq!(all.validate(), Ok(()));
    let tree = |robot: &Robot| KinematicTree::new(robot).unwrap();
    let q: Vec<f64> = (0..9).map(|i| 0.1 * f64::from(i) - 0.3).collect();
    let (own, many) = (tree(&one).poses(&q), tree(&all).poses(&q.repeat(3)));
    for (offset, prefix) in offsets.iter().zip(["a ", "b ", "c "]) {
        let bodies = one.segments.len();
        assert_eq!(many[offset.segments..offset.segments + bodies], own[..]);
        for (i, pair) in one.pairs.iter().enumerate() {
            let merged = &all.pairs[offset.pairs + i];
            assert_eq!(merged.colliders, pair.colliders.map(|collider| offset.collider(collider)));
            assert_eq!(merged.surface, pair.surface);
            // Grouped with the pairs of the same robot only.
            let row = &together(&all)[offset.pairs + i];
            let own_pairs = offset.pairs..offset.pairs + one.pairs.len();
            assert_eq!(row[own_pairs.clone()], groups[i][..]);
            assert!(row.iter().enumerate().all(|(j, same)| own_pairs.contains(&j) || !same), "{prefix}{i}");
        }
        for (i, actuator) in one.actuators.iter().enumerate() {
            let merged = &all.actuators[offset.actuators + i];
            assert_eq!((&merged.name, merged.law), (&format!("{prefix}{}", actuator.name), actuator.law));
            assert_eq!(merged.joint, offset.joint(actuator.joint));
        }
        let puck = all.body(&format!("{prefix}puck")).unwrap();
        assert_eq!(puck, offset.body(one.body("puck").unwrap()));
        assert!(all.grounds.contains(&Ground { body: puck, ..one.grounds[0] }));
        assert!(all.visuals.contains(&Visual { body: Some(puck), ..one.visuals[0] }));
        assert_eq!(all.sliders(puck).map(|(slides, _)| slides), Some([JointId(puck.0 - 2), JointId(puck.0 - 1)]));
    }
    assert_eq!((all.grounds.len(), all.visuals.len(), all.actuators.len()), (3, 3, 18));
}

#[test]
fn ground_lies_below_what_slides_and_once() {
    let puck = beads(6);
    assert_eq!(puck.grounds, [Ground { body: puck.body("puck").unwrap(), friction: 0.5, load: 9.81, radius: 0.05 }]);
    assert_eq!(puck.validate(), Ok(()));
    let with = |ground: Ground| {
        let mut robot = beads(6);
        robot.add_ground(ground);
        robot.validate()
    };
    let again = puck.grounds[0];
    assert_eq!(with(again), Err(RobotError::Name { name: "puck".into() }));
    let bead = Ground { body: BodyId(0), ..again };
    let why = "segment bead 0: no body that slides in a plane has ground below it".into();
    assert_eq!(with(bead), Err(RobotError::Structure { why }));
    for wrong in [Ground { friction: -0.1, ..bead }, Ground { load: f64::NAN, ..bead }, Ground { radius: -1.0, ..bead }]
    {
        assert!(matches!(with(wrong), Err(RobotError::Value { .. })), "{wrong:?}");
    }
    let nowhere = Ground { body: BodyId(99), ..again };
    assert!(matches!(with(nowhere), Err(RobotError::Index { index: 99, .. })));
}

/// Lower and upper corner of a box that is not turned.
fn corners(collider: &Collider) -> [[f64; 3]; 2] {
    let Shape::Box { half } = collider.shape else { panic!("{} is no box", collider.name) };
    assert_eq!(collider.placement.rotation, Pose::<f64>::identity().rotation);
    [-1.0, 1.0].map(|side| [0, 1, 2].map(|i| collider.placement.position[i] + side * half[i]))
}

fn same(a: [f64; 3], b: [f64; 3]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12)
}

proptest! {
    /// A table fills its declared volume. An object on it touches its top in one point.
    #[test]
    fn things_lie_on_tables(
        x in (-0.5_f64..0.5, 0.1_f64..2.0), y in (-0.5_f64..0.5, 0.1_f64..2.0), top in -0.5_f64..0.5, depth in 0.05_f64..1.0,
        radius in 0.01_f64..0.1, start in prop::array::uniform2(-0.4_f64..0.4), mass in 0.01_f64..0.2,
    ) {
        let (table_x, table_y) = ([x.0, x.0 + x.1], [y.0, y.0 + y.1]);
        let tabletop = Tabletop {
            table_x, table_y, table_depth: depth, sphere_radius: radius, sphere_start: start, sphere_mass: mass,
            ..Tabletop::default()
        };
        let of_icub = IcubTabletop {
            table_x, table_y, table_top: top, table_depth: depth, ball_radius: radius, ball_start: start, ball_mass: mass,
            ..IcubTabletop::default()
        };
        let scenes = [
            (tabletop.scene(&ArmAndHand::default()).unwrap(), "sphere", 0.0),
            (of_icub.scene(&Icub::default()).unwrap(), "ball", top),
        ];
        for (scene, thing, top) in scenes {
            let table = &scene.colliders[scene.collider("table").unwrap()];
            let [low, high] = corners(table);
            prop_assert_eq!(table.body, None);
            prop_assert!(same(low, [table_x[0], table_y[0], top - depth]), "{:?}", low);
            prop_assert!(same(high, [table_x[1], table_y[1], top]), "{:?}", high);
            let body = scene.body(thing).unwrap();
            let tree = KinematicTree::new(&scene).unwrap();
            let place = tree.poses(&tree.zero())[body.index()].position;
            prop_assert!(same(place, [start[0], start[1], top + radius]), "{:?}", place);
            let collider = &scene.colliders[scene.collider(thing).unwrap()];
            prop_assert_eq!((collider.body, collider.shape), (Some(body), Shape::Sphere { radius }));
            // A solid ball.
            let inertia = 0.4 * mass * radius * radius;
            let segment = &scene.segments[body.index()];
            prop_assert!(segment.mass == mass && segment.inertia[..3].iter().all(|x| (x - inertia).abs() < 1e-15));
        }
    }

    /// Wherever the iCub's root is, all of it is moved along.
    #[test]
    fn an_icub_stands_where_its_root_is(
        root in prop::array::uniform3(-2.0_f64..2.0), share in prop::collection::vec(0.0_f64..1.0, 60),
    ) {
        let tree = |root| KinematicTree::new(&Icub { root, ..Icub::default() }.robot().unwrap()).unwrap();
        let (here, there) = (tree([0.0; 3]), tree(root));
        let q: Vec<f64> = here.ranges().iter().zip(share).map(|([low, high], x)| low + x * (high - low)).collect();
        for (a, b) in here.poses(&q).iter().zip(there.poses(&q)) {
            let moved = [0, 1, 2].map(|i| a.position[i] + root[i]);
            prop_assert!(same(moved, b.position) && a.rotation == b.rotation, "{:?} {:?}", a, b);
        }
    }
}

/// The axis of a ball, a capsule, a cylinder or a box and the radius around it [m]. For a box, its smallest half from its middle.
fn axis(shape: &Shape, placement: &Pose<f64>) -> ([[f64; 3]; 2], f64) {
    let (half, radius) = match *shape {
        Shape::Capsule { radius, half_length } | Shape::Cylinder { radius, half_length } => (half_length, radius),
        Shape::Sphere { radius } => (0.0, radius),
        Shape::Box { half } => (0.0, half.into_iter().fold(f64::INFINITY, f64::min)),
        Shape::Plane => panic!("a plane has no axis"),
    };
    ([-half, half].map(|z| placement.transform([0.0, 0.0, z])), radius)
}

/// The distance of a point from a line, and from the segment between its two ends.
fn beside(point: [f64; 3], [a, b]: [[f64; 3]; 2]) -> [f64; 2] {
    let [point, a, b] = [point, a, b].map(Vector3::from);
    let share = (point - a).dot(&(b - a)) / (b - a).norm_squared();
    [share, share.clamp(0.0, 1.0)].map(|share| (a + (b - a) * share - point).norm())
}

/// Covers of the arms are drawn over their colliders: along the same bones, and hardly beyond.
#[test]
fn covers_of_the_arms_lie_on_their_colliders() {
    let robot = Icub::default().robot().unwrap();
    for side in Side::ALL {
        for name in ["upper_arm", "forearm"] {
            let name = format!("{}{name}", side.prefix());
            let collider = &robot.colliders[robot.collider(&name).unwrap()];
            let (bone, around) = axis(&collider.shape, &collider.placement);
            let covers: Vec<_> = robot.visuals.iter().filter(|visual| visual.body == collider.body).collect();
            assert_eq!(covers.len(), 2, "{name}");
            for cover in covers {
                let (ends, radius) = axis(&cover.shape, &cover.placement);
                for end in ends {
                    let [aside, off] = beside(end, bone);
                    assert!(aside < 0.005, "{name}: {:.1} mm beside the bone", 1e3 * aside);
                    assert!(off + radius < around + 0.006, "{name}: {:.1} mm beyond", 1e3 * (off + radius - around));
                }
            }
        }
    }
}

/// The look of the left side is the image of the right one.
#[test]
fn looks_are_symmetric() {
    let robot = Icub::default().robot().unwrap();
    let tree = KinematicTree::new(&robot).unwrap();
    let poses = tree.poses(&[0.0; 60]);
    let drawn: Vec<_> = robot
        .visuals
        .iter()
        .map(|visual| {
            let place = poses[visual.body.unwrap().index()].compose(&visual.placement);
            (axis(&visual.shape, &place), visual.color)
        })
        .collect();
    for (([a, b], radius), color) in &drawn {
        let [a, b] = [a, b].map(|[x, y, z]| [*x, -y, *z]);
        let image = |((ends, other), shade): &(([[f64; 3]; 2], f64), _)| {
            let there = (same(ends[0], a) && same(ends[1], b)) || (same(ends[1], a) && same(ends[0], b));
            there && other == radius && shade == color
        };
        assert!(drawn.iter().any(image), "nothing is drawn at {a:?}, {b:?}");
    }
}

#[test]
fn the_hand_of_an_arm_has_the_arms_numbers() {
    let usual = Hand::default();
    let hand = Hand {
        palm_mass: 0.21,
        palm_half: [0.031, 0.032, 0.011],
        palm_box: [0.051, 0.001, 0.002],
        palm_centre: [0.06, 0.001, -0.011],
        armature: 6e-4,
        damping: 0.003,
        servo: farsa_body::actuators::Servo { stiffness: 2.0, damping: 0.05, limit: 0.4 },
        knuckle_mass: 0.006,
        phalange_masses: [0.013, 0.009, 0.007],
        phalange_radii: [0.007, 0.0065, 0.006],
        phalange_lengths: usual.phalange_lengths.map(|lengths| lengths.map(|x| 1.1 * x)),
        finger_bases: usual.finger_bases.map(|[x, y, z]| [x + 0.001, y, z]),
        abduction_ranges: [[0.0, 0.1], [-0.1, 0.1], [-0.2, 0.0], [-0.3, 0.0]],
        thumb_base: [0.029, 0.021, -0.003],
        thumb_link: 0.011,
        opposition_range: [-2.0, 0.1],
        flexion_range: [-1.5, 0.1],
        surface: SURFACE,
    };
    let arm = ArmAndHand {
        arm_masses: [0.19, 0.18, 0.884, 0.074, 0.525, 0.036, hand.palm_mass],
        palm_half: hand.palm_half,
        palm_box: hand.palm_box,
        palm_centre: hand.palm_centre,
        finger_armature: hand.armature,
        finger_damping: hand.damping,
        servo: hand.servo,
        knuckle_mass: hand.knuckle_mass,
        phalange_masses: hand.phalange_masses,
        phalange_radii: hand.phalange_radii,
        phalange_lengths: hand.phalange_lengths,
        finger_bases: hand.finger_bases,
        abduction_ranges: hand.abduction_ranges,
        thumb_base: hand.thumb_base,
        thumb_link: hand.thumb_link,
        opposition_range: hand.opposition_range,
        flexion_range: hand.flexion_range,
        surface: hand.surface,
        ..ArmAndHand::default()
    };
    assert_eq!(arm.hand(), hand);
    // The palm of the robot, and the weight of its fingers.
    let robot = arm.robot().unwrap();
    assert_eq!(robot.segments[ArmAndHand::PALM.index()].mass, 0.21);
    let fingers: f64 = robot.segments[7..].iter().map(|segment| segment.mass).sum();
    assert!((fingers - 5.0 * (0.006 + 0.013 + 0.009 + 0.007)).abs() < 1e-12);
    assert!((hand.mass() - 0.21 - fingers).abs() < 1e-12);
}

#[test]
fn errors_of_kinematics_name_their_numbers() {
    let closest = Solution { joints: vec![], position_error: 0.25, angle_error: 1.5 };
    let told = [
        (InverseKinematicsError::Body { body: 7, count: 3 }, "body 7 of 3"),
        (InverseKinematicsError::Goal, "the goal is not made of finite numbers, directions and unit quaternions"),
        (InverseKinematicsError::Start { given: 2, joints: 5 }, "2 start positions for 5 joints"),
        (InverseKinematicsError::NotReached { closest }, "the goal was missed by 0.25 m and 1.5 rad"),
    ];
    for (error, text) in told {
        assert_eq!(error.to_string(), text);
    }
}
