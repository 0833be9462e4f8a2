//! The iCub against Pinocchio's reading of its file (fixtures/icub.py), its mirror image, its chains and its errors.

use crate::shared::apart;
use farsa_body::Pose;
use farsa_body::actuators::Law;
use farsa_body::kinematics::KinematicTree;
use farsa_body::ports::{ActuatorId, BodyId, JointId};
use farsa_body::robot::{Collider, JointKind, Robot, Shape};
use farsa_body::robots::{Chain, Finger, Icub, IcubError, IcubPosture, JointControl, Side};
use farsa_num::{Domain, Stream};
use serde::Deserialize;

#[derive(Deserialize)]
struct Segment {
    joint: String,
    range: [f64; 2],
    effort: f64,
    mass: f64,
    centre: [f64; 3],
    inertia: [f64; 6],
}

/// The content of the file according to Pinocchio.
#[derive(Deserialize)]
struct Fixture {
    segments: Vec<Segment>,
    postures: Vec<Posture>,
}

/// Joint angles, and a place for each segment.
#[derive(Deserialize)]
struct Posture {
    q: Vec<f64>,
    positions: Vec<[f64; 3]>,
    rotations: Vec<[f64; 4]>,
    centres: Vec<Option<[f64; 3]>>,
}

fn fixture() -> Fixture {
    let fixture: Fixture = serde_json::from_str(include_str!("../fixtures/icub.json")).expect("the committed file");
    assert_eq!((fixture.segments.len(), fixture.postures.len()), (20, 60));
    for posture in &fixture.postures {
        assert_eq!([posture.q.len(), posture.positions.len(), posture.rotations.len(), posture.centres.len()], [20; 4]);
    }
    fixture
}

fn robot() -> Robot {
    Icub::default().robot().expect("a valid robot")
}

fn tree() -> KinematicTree {
    KinematicTree::new(&robot()).expect("a valid robot")
}

/// All 60 joint positions, those of the hands at 0.
fn with_hands(q: &[f64]) -> Vec<f64> {
    let mut all = q.to_vec();
    all.resize(60, 0.0);
    all
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |most, (x, y)| most.max((x - y).abs()))
}

/// The largest difference of quaternions of either sign.
fn turned(a: [f64; 4], b: [f64; 4]) -> f64 {
    distance(&a, &b).min(distance(&a, &b.map(|x| -x)))
}

fn back(pose: &Pose<f64>) -> Pose<f64> {
    let [x, y, z, w] = pose.rotation;
    Pose { position: [0.0; 3], rotation: [-x, -y, -z, w] }
}

#[test]
fn segments_are_where_pinocchio_has_them() {
    let (tree, fixture) = (tree(), fixture());
    let zero = tree.poses(&[0.0; 60]);
    for (i, pose) in zero.iter().enumerate().take(20) {
        let axes = match i {
            12 => [-0.5, 0.5, 0.5, 0.5],
            19 => [0.5, 0.5, -0.5, 0.5],
            _ => [0.0, 0.0, 0.0, 1.0],
        };
        assert!(turned(pose.rotation, axes) < 1e-15, "segment {i}: {:?}", pose.rotation);
    }
    let mut worst = [0.0_f64; 2];
    for posture in &fixture.postures {
        let poses = tree.poses(&with_hands(&posture.q));
        for i in 0..20 {
            let relative = poses[i].compose(&back(&zero[i]));
            worst[0] = worst[0].max(distance(&poses[i].position, &posture.positions[i]));
            worst[1] = worst[1].max(turned(relative.rotation, posture.rotations[i]));
        }
    }
    println!("60 postures of 20 segments: positions {:.1e} m, rotations {:.1e}", worst[0], worst[1]);
    assert!(worst[0] < 1e-9 && worst[1] < 1e-9, "{worst:?}");
}

#[test]
fn names_limits_and_efforts_are_the_files() {
    let (robot, fixture) = (robot(), fixture());
    let names = Chain::ALL.into_iter().flat_map(Chain::joint_names);
    for (i, (segment, name)) in fixture.segments.iter().zip(names).enumerate() {
        let joint = &robot.segments[i].joint;
        assert_eq!((&joint.name, &name), (&segment.joint, &segment.joint));
        assert!(distance(&joint.range, &segment.range) < 6e-6, "{name}: {:?}", joint.range);
        let Law::Servo(servo) = robot.actuators[i].law else { panic!("no servo") };
        assert_eq!(servo.limit, segment.effort, "{name}");
    }
}

/// Masses, centers of mass and inertias, in the axes at joint positions 0, which are the world's but for the palms.
#[test]
fn bodies_are_those_of_the_file() {
    let (robot, fixture) = (robot(), fixture());
    let [mut mass, mut centre, mut inertia, mut left_centre, mut left_inertia] = [0.0_f64; 5];
    let mut without = Vec::new();
    for (i, (ours, theirs)) in robot.segments.iter().zip(&fixture.segments).enumerate() {
        if theirs.joint.ends_with("wrist_yaw") {
            continue;
        }
        mass = mass.max((ours.mass - theirs.mass).abs());
        let off = [distance(&ours.centre, &theirs.centre), distance(&ours.inertia, &theirs.inertia)];
        if theirs.inertia == [0.0; 6] {
            without.push(ours.name.as_str());
        } else if Chain::LeftArm.bodies().contains(&i) {
            left_inertia = left_inertia.max(off[1]);
        } else {
            inertia = inertia.max(off[1]);
        }
        if Chain::LeftArm.bodies().contains(&i) {
            left_centre = left_centre.max(off[0]);
        } else {
            centre = centre.max(off[0]);
        }
    }
    println!(
        "mass {mass:.1e} kg, centre {centre:.1e} m, inertia {inertia:.1e} kg m2; left {left_centre:.1e} m, {left_inertia:.1e} kg m2"
    );
    assert!(mass < 1e-9 && centre < 1e-9 && inertia < 1e-12);
    // The figures of the file's left side in the documentation.
    assert!(left_centre < 1.9e-4 && left_inertia < 7e-5);
    assert_eq!(without, ["neck_1", "neck_2", "head", "l_wrist_1", "r_wrist_1"]);
}

#[test]
fn masses_and_centres_of_subtrees_are_pinocchios() {
    let (robot, fixture) = (robot(), fixture());
    let tree = KinematicTree::new(&robot).expect("a valid robot");
    let total: f64 = robot.segments.iter().map(|segment| segment.mass).sum();
    let expected: f64 = fixture.segments.iter().map(|segment| segment.mass).sum();
    assert!((total - expected).abs() < 1e-9, "{total} kg instead of {expected}");
    // All that a segment carries, without the hands.
    let arms = &robot.segments[..20];
    let carried = |root: usize| -> Vec<usize> {
        let mut found = vec![root];
        for (i, segment) in arms.iter().enumerate().skip(root + 1) {
            if segment.parent.is_some_and(|parent| found.contains(&parent.index())) {
                found.push(i);
            }
        }
        found.retain(|i| ![12, 19].contains(i));
        found
    };
    let (mut worst, mut compared) = (0.0_f64, 0);
    for posture in &fixture.postures {
        let poses = tree.poses(&with_hands(&posture.q));
        for (root, expected) in posture.centres.iter().enumerate() {
            let (mut mass, mut moment) = (0.0, [0.0; 3]);
            for i in carried(root) {
                mass += arms[i].mass;
                let centre = poses[i].transform(arms[i].centre);
                moment = [0, 1, 2].map(|k| moment[k] + arms[i].mass * centre[k]);
            }
            assert_eq!(expected.is_some(), mass > 0.0);
            if let Some(expected) = expected {
                worst = worst.max(distance(&moment.map(|x| x / mass), expected));
                compared += 1;
            }
        }
    }
    println!("{compared} centres of mass of subtrees: {worst:.1e} m");
    assert_eq!(compared, 60 * 18);
    assert!(worst < 1e-9, "{worst}");
}

/// The hand is as heavy as the file's, and its center of mass is where the documentation places it.
#[test]
fn the_hand_is_as_heavy_as_the_files() {
    let (robot, fixture) = (robot(), fixture());
    let poses = tree().poses(&[0.0; 60]);
    let hand = (40..60).chain([19]);
    let (mut mass, mut moment) = (0.0, [0.0; 3]);
    for i in hand {
        let segment = &robot.segments[i];
        let centre = poses[i].transform(segment.centre);
        mass += segment.mass;
        moment = [0, 1, 2].map(|k| moment[k] + segment.mass * (centre[k] - poses[19].position[k]));
    }
    let file = &fixture.segments[19];
    let off = apart(moment.map(|x| x / mass), file.centre);
    println!("hand: {mass} kg, centre of mass {:.1} mm off", off * 1e3);
    assert!((mass - file.mass).abs() < 1e-12 && (mass - Icub::default().hand.mass()).abs() < 1e-12);
    assert!(off < 0.0075, "{off} m off");
}

/// Joint positions with equal angles left and right, and the trunk and head upright or the images of each other.
fn symmetric(stream: &mut Stream, icub: &Icub, flip: f64) -> Vec<f64> {
    let mut q = Vec::new();
    let mut draw =
        |chain| -> Vec<f64> { icub.ranges(chain).iter().map(|[low, high]| stream.range_f64(*low, *high)).collect() };
    let (mut torso, mut neck) = (draw(Chain::Torso), draw(Chain::Neck));
    let (arms, hands) = ([draw(Chain::LeftArm), draw(Chain::LeftArm)], [draw(Chain::LeftHand), draw(Chain::LeftHand)]);
    for chain in [&mut torso, &mut neck] {
        chain[1] *= flip;
        chain[2] *= flip;
    }
    q.extend([torso, neck].concat());
    let order = if flip < 0.0 { [1, 0] } else { [0, 1] };
    q.extend(order.into_iter().flat_map(|i| arms[i].clone()));
    q.extend(order.into_iter().flat_map(|i| hands[i].clone()));
    q
}

#[test]
fn the_left_side_is_the_image_of_the_right() {
    let (icub, robot, tree) = (Icub::default(), robot(), tree());
    let other = |i: usize| match i {
        6..13 => i + 7,
        13..20 => i - 7,
        20..40 => i + 20,
        40..60 => i - 20,
        _ => i,
    };
    let image = |[x, y, z]: [f64; 3]| [x, -y, z];
    for draw in 0..100 {
        let poses = [1.0, -1.0].map(|flip| {
            let mut stream = Stream::new(1, Domain::Sensor, draw, 0, 0);
            tree.poses(&symmetric(&mut stream, &icub, flip))
        });
        for i in 0..60 {
            let j = other(i);
            let [a, b] = [&poses[0][i], &poses[1][j]];
            assert!(distance(&a.position, &image(b.position)) < 1e-13, "segment {i}: {a:?} {b:?}");
            for (own, images) in [([1.0, 0.0, 0.0], [1.0, 0.0, 0.0]), ([0.0, 1.0, 0.0], [0.0, -1.0, 0.0])] {
                assert!(distance(&a.rotate(own), &image(b.rotate(images))) < 1e-13, "segment {i}");
            }
            // Only the sides of segments in the middle are each other's images.
            if i != j {
                let centres = [a.transform(robot.segments[i].centre), b.transform(robot.segments[j].centre)];
                assert!(distance(&centres[0], &image(centres[1])) < 1e-13, "segment {i}");
                let [xx, yy, zz, xy, xz, yz] = robot.segments[j].inertia;
                assert!(distance(&robot.segments[i].inertia, &[xx, yy, zz, -xy, xz, -yz]) < 1e-18, "segment {i}");
            }
        }
        for finger in Finger::ALL {
            let [left, right] = Side::ALL.map(|side| icub.fingertip(side, finger));
            let tips = [poses[0][left.0.index()].transform(left.1), poses[1][right.0.index()].transform(right.1)];
            assert!(distance(&tips[0], &image(tips[1])) < 1e-13, "{finger:?}");
        }
    }
    let [left, right] = [Chain::LeftArm, Chain::RightArm].map(Chain::joint_names);
    for (left, right) in left.iter().zip(&right) {
        assert_eq!(left.strip_prefix("l_"), right.strip_prefix("r_"));
    }
}

#[test]
fn palms_face_the_body_and_open_hands_hang() {
    let (icub, tree) = (Icub::default(), tree());
    let poses = tree.poses(&[0.0; 60]);
    for (side, y) in Side::ALL.into_iter().zip([0.11026, -0.11026]) {
        let palm = &poses[Icub::palm(side).index()];
        assert!(distance(&palm.position, &[0.01075, y, -0.11428]) < 1e-12);
        assert!(distance(&palm.rotate(Icub::PALM_NORMAL), &[0.0, -y.signum(), 0.0]) < 1e-12);
        let (body, point) = icub.fingertip(side, Finger::Middle);
        let tip = poses[body.index()].transform(point);
        assert!(tip[2] < palm.position[2] - 0.14, "the fingers point down: {tip:?}");
        let (body, point) = icub.fingertip(side, Finger::Thumb);
        assert!(poses[body.index()].transform(point)[0] > palm.position[0] + 0.09, "the thumb points forward");
        let centre = palm.transform(icub.palm_centre(side));
        assert!((centre[1] - (y - 0.010 * y.signum())).abs() < 1e-12, "{centre:?}");
    }
    let head = &poses[Icub::HEAD.index()];
    let eyes = Icub::EYES.map(|eye| head.transform(eye));
    assert!(eyes[0][1] > 0.0 && (eyes[0][1] - eyes[1][1] - 0.068).abs() < 1e-12 && eyes[0][2] > 0.3);
}

/// The chains in the bits of a number.
fn chains(bits: usize) -> Vec<Chain> {
    Chain::ALL.into_iter().filter(|chain| bits >> *chain as usize & 1 == 1).collect()
}

#[test]
fn every_set_of_chains_is_a_robot() {
    let whole = robot();
    let start = Icub::default().start();
    assert_eq!(start.len(), 60);
    let at_rest = tree().poses(&start);
    for bits in 0..64 {
        for control in [JointControl::Position, JointControl::Velocity] {
            let mut actuated = chains(bits);
            actuated.reverse();
            let icub = Icub { actuated: actuated.clone(), control, ..Icub::default() };
            let robot = icub.robot().unwrap_or_else(|error| panic!("{actuated:?}: {error}"));
            let names = |robot: &Robot| -> Vec<String> { robot.segments.iter().map(|s| s.name.clone()).collect() };
            assert_eq!(names(&robot), names(&whole), "bodies keep their ids");
            assert_eq!(robot.colliders, whole.colliders);
            let mut count = 0;
            for chain in Chain::ALL {
                let moving = actuated.contains(&chain);
                for (i, name) in chain.bodies().zip(chain.joint_names()) {
                    let kind = if moving { JointKind::Revolute } else { JointKind::Fixed };
                    assert_eq!(robot.segments[i].joint.kind, kind, "{name}");
                    assert_eq!(Chain::of_body(BodyId(i as u16)), Some(chain));
                    if moving {
                        assert_eq!(icub.joint(&name), Ok(JointId(i as u16)));
                        assert_eq!(icub.actuator(&name), Ok(ActuatorId(count)));
                        assert_eq!(robot.actuator(&name), Some(ActuatorId(count)));
                        assert_eq!(robot.actuators[usize::from(count)].joint, JointId(i as u16));
                        let position = control == JointControl::Position || chain >= Chain::LeftHand;
                        let law = robot.actuators[usize::from(count)].law;
                        assert_eq!(matches!(law, Law::Servo(_)), position, "{name}");
                        assert_eq!(matches!(law, Law::Velocity(_)), !position, "{name}");
                        count += 1;
                    } else {
                        let locked = IcubError::Locked { joint: name.clone(), chain: chain.name() };
                        assert_eq!(icub.actuator(&name), Err(locked.clone()));
                        assert_eq!(icub.joint(&name), Err(locked));
                        assert_eq!((robot.actuator(&name), robot.joint(&name)), (None, None));
                    }
                }
            }
            assert_eq!(robot.actuators.len(), usize::from(count));
            let tree = KinematicTree::new(&robot).expect("a valid robot");
            let start = icub.start();
            assert_eq!(start.len(), robot.joints().count());
            for (a, b) in tree.poses(&start).iter().zip(&at_rest) {
                assert!(distance(&a.position, &b.position) < 1e-14 && turned(a.rotation, b.rotation) < 1e-14);
            }
            for side in Side::ALL {
                let first = icub.actuator(&format!("{}J8", side.prefix()));
                assert_eq!(icub.servo_groups(side).map(|groups| groups[0][0].servo), first);
            }
        }
    }
}

#[test]
fn servo_groups_are_those_of_the_arm_and_hand() {
    let icub = Icub::default();
    let theirs = farsa_body::robots::ArmAndHand::default().servo_groups();
    for (side, first) in Side::ALL.into_iter().zip([20, 40]) {
        let groups = icub.servo_groups(side).expect("actuated");
        assert_eq!(groups.iter().map(Vec::len).sum::<usize>(), 20);
        for (ours, theirs) in groups.iter().flatten().zip(theirs.iter().flatten()) {
            assert_eq!((ours.servo.0, ours.from, ours.to), (theirs.servo.0 - 7 + first, theirs.from, theirs.to));
        }
    }
}

#[test]
fn pairs_are_those_that_can_move() {
    let whole = robot();
    assert_eq!(whole.pairs.len(), 2 * 25 + 2 * 7 + 8 + 2 * 15 * 6 + 15 * 15);
    for (a, b) in [
        ("l_forearm", "chest"),
        ("r_palm", "head"),
        ("l_upper_arm", "r_palm"),
        ("l_palm", "r_forearm"),
        ("r_thumb_distal", "waist"),
        ("l_ring_middle", "r_upper_arm"),
    ] {
        assert!(whole.pair(a, b).is_some(), "{a}, {b}");
    }
    for (a, b) in [("l_upper_arm", "chest"), ("l_upper_arm", "l_forearm"), ("l_forearm", "l_palm"), ("chest", "head")] {
        assert!(whole.pair(a, b).is_none(), "{a}, {b}");
    }
    let count = |actuated: &[Chain]| {
        let icub = Icub { actuated: actuated.to_vec(), ..Icub::default() };
        icub.robot().expect("a valid robot").pairs.len()
    };
    assert_eq!(count(&[]), 0);
    assert_eq!(count(&[Chain::Neck]), 6 + 30, "arms and fingers with the head");
    assert_eq!(count(&[Chain::RightHand]), 25 + 15 * 6 + 15 * 15);
    assert_eq!(count(&[Chain::LeftArm]), 7 + 8 + 15 * 6 + 15 * 3 + 15 * 15);
}

/// Balls that fill a collider, capsules to 0.1 mm, boxes by points of their surface and inside.
fn balls(collider: &Collider, poses: &[Pose<f64>]) -> (Vec<[f64; 3]>, f64) {
    let body = collider.body.expect("on a segment");
    let pose = poses[body.index()].compose(&collider.placement);
    let steps = || (-20..=20).map(|i| f64::from(i) / 20.0);
    match collider.shape {
        Shape::Capsule { radius, half_length } => {
            (steps().map(|s| pose.transform([0.0, 0.0, s * half_length])).collect(), radius)
        }
        Shape::Box { half: [a, b, c] } => {
            let points = steps().flat_map(|x| steps().flat_map(move |y| steps().map(move |z| [a * x, b * y, c * z])));
            (points.map(|point| pose.transform(point)).collect(), 0.0)
        }
        _ => panic!("no such shape"),
    }
}

#[test]
fn nothing_overlaps_at_rest() {
    let (robot, icub) = (robot(), Icub::default());
    let poses = tree().poses(&icub.start());
    let filled: Vec<_> = robot.colliders.iter().map(|collider| balls(collider, &poses)).collect();
    let mut least = (f64::INFINITY, String::new());
    for pair in &robot.pairs {
        let [(a, ra), (b, rb)] = pair.colliders.map(|i| &filled[i]);
        // One in 35 of a box's 68921 points is enough: an overlapping box would contain many of the other's balls.
        let thin = |points: &[[f64; 3]]| points.len().div_ceil(2000).max(1);
        for p in a.iter().step_by(thin(a)) {
            for q in b.iter().step_by(thin(b)) {
                let gap = apart(*p, *q) - ra - rb;
                if gap < least.0 {
                    least = (gap, pair.colliders.map(|i| robot.colliders[i].name.as_str()).join(", "));
                }
            }
        }
    }
    println!("least clearance at rest: {:.1} mm, {}", least.0 * 1e3, least.1);
    assert!(least.0 > 0.0, "{least:?}");
}

#[test]
fn errors_name_what_is_wrong() {
    let fault = |icub: Icub| icub.robot().expect_err("a fault");
    let chain = Chain::from_name("left-leg").expect_err("no such chain");
    assert_eq!(chain, IcubError::Chain { name: "left-leg".into() });
    let names = Chain::ALL.map(Chain::name);
    assert_eq!(chain.to_string(), format!("no chain is called left-leg: there are {}", names.join(", ")));
    for chain in Chain::ALL {
        assert_eq!(Chain::from_name(chain.name()), Ok(chain));
    }
    let twice = Icub { actuated: vec![Chain::Neck, Chain::Torso, Chain::Neck], ..Icub::default() };
    assert_eq!(fault(twice), IcubError::Twice { chain: "neck" });
    let joint = Icub::default().actuator("l_knee").expect_err("no such joint");
    assert_eq!(joint, IcubError::Joint { name: "l_knee".into() });
    assert!(joint.to_string().starts_with("no joint is called l_knee: there are torso_pitch"), "{joint}");
    assert_eq!(Icub::default().range("elbow"), Err(IcubError::Joint { name: "elbow".into() }));
    let rigid = Icub { actuated: vec![Chain::RightArm], ..Icub::default() };
    let locked = rigid.actuator("l_elbow").expect_err("a rigid joint");
    assert_eq!(locked.to_string(), "joint l_elbow is rigid: the chain left-arm is not actuated");
    assert_eq!(rigid.actuator("r_shoulder_pitch"), Ok(ActuatorId(0)));
    for angle in [0.0, 2.0, f64::NAN, f64::INFINITY] {
        let mut posture = IcubPosture::default();
        posture.chain_mut(Chain::LeftArm)[3] = angle;
        let error = fault(Icub { posture, ..Icub::default() });
        let IcubError::Posture { joint, angle: found, range } = error else { panic!("{error}") };
        assert_eq!((joint.as_str(), found.to_bits()), ("l_elbow", angle.to_bits()));
        assert_eq!(Icub::default().range("l_elbow"), Ok(range));
    }
    let numbers: [fn(&mut Icub, f64); 5] = [
        |icub, x| icub.saturation_angle = x,
        |icub, x| icub.saturation_speed = x,
        |icub, x| icub.servo_time = x,
        |icub, x| icub.damping_per_effort = x,
        |icub, x| icub.armature = x,
    ];
    let fields = ["saturation_angle", "saturation_speed", "servo_time", "damping_per_effort", "armature"];
    for (set, field) in numbers.into_iter().zip(fields) {
        for value in [-1.0, f64::NAN, f64::INFINITY] {
            let mut icub = Icub::default();
            set(&mut icub, value);
            let error = fault(icub);
            assert!(matches!(error, IcubError::Value { field: found, .. } if found == field), "{error}");
        }
    }
    assert_eq!(fault(Icub { saturation_angle: 0.0, ..Icub::default() }).to_string(), "saturation_angle is 0");
    assert!(matches!(fault(Icub { root: [f64::NAN; 3], ..Icub::default() }), IcubError::Robot(_)));
}

#[cfg(feature = "serde")]
#[test]
fn a_configuration_names_only_what_differs() {
    let text = r#"{"actuated": ["torso", "left-arm"], "control": "velocity", "posture": {"torso": [0.1, 0.0, 0.2]}}"#;
    let icub: Icub = serde_json::from_str(text).expect("valid");
    let posture = IcubPosture { torso: [0.1, 0.0, 0.2], ..IcubPosture::default() };
    let actuated = vec![Chain::Torso, Chain::LeftArm];
    assert_eq!(icub, Icub { actuated, control: JointControl::Velocity, posture, ..Icub::default() });
    let again: Icub = serde_json::from_str(&serde_json::to_string(&icub).expect("numbers")).expect("valid");
    assert_eq!(again, icub);
    let error = serde_json::from_str::<Icub>(r#"{"actuated": ["leg"]}"#).expect_err("no such chain");
    assert!(error.to_string().contains("left-arm"), "{error}");
    assert!(serde_json::from_str::<Icub>(r#"{"legs": 2}"#).is_err());
}
