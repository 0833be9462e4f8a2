//! The arm and hand against the checked figures of the experiment `reach-grasp-lift`: axes, postures, gravity, reach.

use std::collections::BTreeSet;

use farsa_body::Pose;
use farsa_body::actuators::{Law, MuscleVariant};
use farsa_body::kinematics::{Goal, InverseKinematics, KinematicTree, Orientation};
use farsa_body::ports::{ActuatorId, BodyId, JointId};
use farsa_body::robot::{Shape, Surface};
use farsa_body::robots::{ArmAndHand, Finger, Tabletop};

const DOWN: [f64; 3] = [0.0, 0.0, -1.0];
const GRAVITY: [f64; 3] = [0.0, 0.0, -9.81];
const RADIUS: f64 = 0.025;

/// The four places of the sphere, forward and left [m].
const SPHERES: [[f64; 2]; 4] = [[0.10, -0.18], [0.18, -0.26], [0.26, -0.18], [0.18, -0.10]];

/// J1 to J7 [deg] with the palm down, its center 5 cm above the sphere's, rounded to whole degrees.
const PALM_DOWN: [[f64; 7]; 4] = [
    [-92.0, -8.0, 53.0, -102.0, -28.0, -48.0, 11.0],
    [-82.0, -26.0, 18.0, -66.0, -18.0, -25.0, 6.0],
    [-43.0, -29.0, 2.0, -46.0, -21.0, -21.0, -6.0],
    [-61.0, -28.0, 26.0, -90.0, -31.0, -23.0, 0.0],
];

/// J1 to J4 at the start of the four trials [deg].
const STARTS: [[f64; 4]; 4] = [
    [-73.0, -30.0, -40.0, -56.0],
    [-73.0, -30.0, -40.0, -113.0],
    [-6.0, 30.0, -10.0, -56.0],
    [-73.0, -30.0, 45.0, -113.0],
];

fn arm() -> (ArmAndHand, KinematicTree) {
    let arm = ArmAndHand::default();
    let tree = KinematicTree::new(&arm.robot().expect("a valid robot")).expect("a valid robot");
    (arm, tree)
}

/// All joints at 0 but the first ones, given in degrees.
fn posture(degrees: &[f64]) -> [f64; 27] {
    core::array::from_fn(|i| degrees.get(i).copied().unwrap_or(0.0).to_radians())
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum::<f64>().sqrt()
}

/// Angle between the palm's outward normal and straight down [rad].
fn tilt(palm: &Pose<f64>) -> f64 {
    let n = palm.rotate(ArmAndHand::PALM_NORMAL);
    farsa_num::atan2(n[0].hypot(n[1]), -n[2])
}

fn palm(poses: &[Pose<f64>]) -> &Pose<f64> {
    &poses[ArmAndHand::PALM.index()]
}

#[test]
fn numbers_of_joints_and_parts() {
    let arm = ArmAndHand::default();
    let robot = arm.robot().expect("a valid robot");
    let joints: Vec<_> = robot.joints().collect();
    assert_eq!(joints, ArmAndHand::joints());
    for n in 1..=27 {
        assert_eq!(robot.joint(&format!("J{n}")), Some(JointId(n - 1)));
        assert_eq!(robot.actuator(&format!("J{n}")), Some(ActuatorId(n - 1)));
        assert_eq!(robot.actuators[usize::from(n) - 1].joint, JointId(n - 1));
        let muscles = matches!(robot.actuators[usize::from(n) - 1].law, Law::MusclePair(_));
        assert_eq!(muscles, n <= 7, "muscles drive the arm, servos the hand");
    }
    assert_eq!(robot.body("palm"), Some(ArmAndHand::PALM));
    let names = ["thumb", "index", "middle", "ring", "little"];
    for (finger, name) in Finger::ALL.into_iter().zip(names) {
        for (i, part) in ["proximal", "middle", "distal"].into_iter().enumerate() {
            let name = format!("{name}_{part}");
            assert_eq!(robot.body(&name), Some(ArmAndHand::phalanges(finger)[i]));
            assert_eq!(robot.collider(&name), Some(ArmAndHand::phalange_colliders(finger)[i]));
        }
    }
    for (i, name) in ["upper_arm", "forearm", "palm"].into_iter().enumerate() {
        assert_eq!(robot.collider(name), Some(ArmAndHand::ARM_COLLIDERS[i]));
    }
    let flexion = [9, 10, 11, 13, 14, 15, 17, 18, 19, 21, 22, 23, 25, 26, 27].map(|n| JointId(n - 1));
    assert_eq!(ArmAndHand::flexion_joints(), flexion);
    for joint in flexion {
        let range = robot.segments[joint.index()].joint.range;
        assert_eq!(range.map(|x| x.to_degrees().round() as i32), [-90, 0]);
    }
    let mass: f64 = robot.segments.iter().map(|s| s.mass).sum();
    assert!((mass - (0.19 + 0.18 + 0.884 + 0.074 + 0.525 + 0.036 + 0.15 + 5.0 * 0.031)).abs() < 1e-12);
    for pair in [("thumb_middle", "little_distal"), ("thumb_distal", "index_middle"), ("ring_distal", "little_distal")]
    {
        assert!(robot.pair(pair.0, pair.1).is_some());
    }
    assert_eq!(robot.pairs.len(), 25);
}

#[test]
fn joint_damping_is_a_choice() {
    let damping = |arm: ArmAndHand| -> Vec<f64> {
        arm.robot().expect("a valid robot").segments.iter().take(8).map(|s| s.joint.damping).collect()
    };
    let expected = [0.375, 3.75, 0.375, 0.375, 0.375, 0.25, 0.25, 0.002];
    assert!(damping(ArmAndHand::default()).iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15));
    let off = damping(ArmAndHand { damping_per_torque: 0.0, ..ArmAndHand::default() });
    assert_eq!(off, [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.002]);
}

#[test]
fn fingers_push_and_touch_by_their_numbers() {
    let robot = ArmAndHand::default().robot().expect("a valid robot");
    for (actuator, segment) in robot.actuators.iter().zip(&robot.segments).skip(7) {
        // 1 N m/rad and 0.04 N m s/rad, up to what a tendon of 300 N pulls at 1 mm.
        let torque = |q: f64, speed: f64| actuator.law.effort(q, speed, [0.0; 2]).torque;
        for (found, expected) in
            [(torque(-0.1, 0.0), 0.1), (torque(0.0, 1.0), -0.04), (torque(-1.0, 0.0), 300.0 * 0.001)]
        {
            assert!((found - expected).abs() < 1e-12, "{}: {found} N m where {expected} are expected", actuator.name);
        }
        assert_eq!([segment.joint.armature, segment.joint.damping], [5e-4, 0.002], "{}", actuator.name);
    }
    let surface = Surface { friction: 1.0, rolling_friction: 0.0, stiffness: 2e5, damping: 100.0 };
    assert!(robot.pairs.iter().all(|pair| pair.surface == surface), "{:?}", robot.pairs);
}

#[test]
fn muscle_variants() {
    let law = |variant| {
        let arm = ArmAndHand { muscle_variant: variant, passive_reduction: 0.6, ..ArmAndHand::default() };
        let Law::MusclePair(m) = arm.robot().expect("a valid robot").actuators[1].law else { panic!("no muscles") };
        m
    };
    let (thesis, original) = (law(MuscleVariant::Thesis), law(MuscleVariant::Original));
    assert_eq!([thesis.viscosity, original.viscosity], [0.9, 1.0]);
    assert!((original.passive_scale - 0.3 * thesis.passive_scale).abs() < 1e-12);
    assert_eq!(thesis.tension, 3000.0);
}

#[test]
fn servo_groups_flex_and_spread() {
    let groups = ArmAndHand::default().servo_groups();
    let numbers: Vec<Vec<u16>> = groups.iter().map(|g| g.iter().map(|s| s.servo.0 + 1).collect()).collect();
    let expected: [&[u16]; 9] =
        [&[8], &[9], &[10, 11], &[13], &[14, 15], &[17], &[18, 19], &[12, 16, 20, 24], &[21, 22, 23, 25, 26, 27]];
    assert_eq!(numbers, expected);
    for (g, group) in groups.iter().enumerate() {
        for servo in group {
            let degrees = [servo.from, servo.to].map(|x| x.to_degrees().round() as i32);
            let wanted = match (g, servo.servo.0 + 1) {
                (0, _) => [0, -120],
                (_, 12) => [0, 15],
                (_, 16) => [-2, 2],
                (_, 20) => [0, -10],
                (_, 24) => [0, -15],
                _ => [0, -90],
            };
            assert_eq!(degrees, wanted, "J{}", servo.servo.0 + 1);
        }
    }
}

#[test]
fn zero_posture_points_forward_palm_down() {
    let (arm, tree) = arm();
    let poses = tree.poses(&posture(&[]));
    let centre = palm(&poses).transform(arm.palm_centre);
    assert!(distance(centre, [-0.025 + 0.152 + 0.137 + 0.0625, -0.108, 0.20]) < 1e-12);
    assert!(tilt(palm(&poses)) < 1e-12);
    let tip = |finger| {
        let (body, point) = arm.fingertip(finger);
        poses[body.index()].transform(point)
    };
    let thumb = tip(Finger::Thumb);
    assert!((thumb[1] - (-0.108 + 0.020 + 0.010 + 0.0648)).abs() < 1e-12, "the thumb points left: {thumb:?}");
    let wrist = 0.264;
    for (finger, length, y) in [
        (Finger::Index, 0.0647, 0.025),
        (Finger::Middle, 0.0693, 0.008),
        (Finger::Ring, 0.0647, -0.008),
        (Finger::Little, 0.0577, -0.024),
    ] {
        assert!(distance(tip(finger), [wrist + 0.080 + length, y - 0.108, 0.21]) < 1e-12, "{finger:?}");
    }
}

#[test]
fn joints_turn_as_their_names_say() {
    let (arm, tree) = arm();
    let at =
        |degrees: &[f64], body: BodyId, point: [f64; 3]| tree.poses(&posture(degrees))[body.index()].transform(point);
    let hand = |degrees: &[f64]| at(degrees, ArmAndHand::PALM, arm.palm_centre);
    let zero = hand(&[]);
    assert!(hand(&[-30.0])[1] < zero[1] - 0.1, "J1 negative: outward");
    assert!(hand(&[0.0, 30.0])[2] > zero[2] + 0.1, "J2 positive: up");
    assert!(
        hand(&[0.0, 0.0, 60.0, -90.0])[2] < hand(&[0.0, 0.0, 0.0, -90.0])[2] - 0.1,
        "J3 positive: bent forearm down"
    );
    assert!(hand(&[0.0, 0.0, 0.0, -60.0])[1] > zero[1] + 0.1, "J4: forearm inward");
    let (middle, tip) = arm.fingertip(Finger::Middle);
    let finger = |degrees: &[f64]| at(degrees, middle, tip);
    let straight = finger(&[]);
    assert!(finger(&[0.0, 0.0, 0.0, 0.0, 0.0, 30.0])[2] < straight[2] - 0.05, "J6 positive: palmar");
    assert!(finger(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 30.0])[1] > straight[1] + 0.05, "J7 positive: to the thumb");
    let thumb_side = |j5: f64| tree.poses(&posture(&[0.0, 0.0, 0.0, 0.0, j5]))[6].rotate([0.0, 1.0, 0.0]);
    assert!(thumb_side(30.0)[2] > 0.4, "J5 positive: thumb up");

    // The hand, seen from the palm: one joint moved, one fingertip.
    let moved = |number: usize, degrees: f64, finger: Finger| {
        let mut q = posture(&[]);
        let (body, point) = arm.fingertip(finger);
        let before = tree.poses(&q);
        q[number - 1] = degrees.to_radians();
        let after = tree.poses(&q);
        let [a, b] = [before, after].map(|p| palm(&p).transform_back(p[body.index()].transform(point)));
        [b[0] - a[0], b[1] - a[1], b[2] - a[2]]
    };
    for (knuckle, finger) in [(12, Finger::Index), (16, Finger::Middle), (20, Finger::Ring), (24, Finger::Little)] {
        for flexion in 1..=3 {
            assert!(moved(knuckle + flexion, -45.0, finger)[2] < -0.01, "J{}: closes palmwards", knuckle + flexion);
        }
        assert!(moved(knuckle, 2.0, finger)[1] > 0.001, "J{knuckle} positive: to the thumb's side");
    }
    let opposed = moved(8, -90.0, Finger::Thumb);
    assert!(
        opposed[2] < -0.07 && opposed[1] < -0.07 && opposed[0].abs() < 1e-12,
        "J8 at -90: straight out of the palm"
    );
    for n in 9..=11 {
        assert!(moved(n, -45.0, Finger::Thumb)[0] > 0.01, "J{n}: towards the fingers");
    }
}

#[test]
fn labels_are_true_in_anatomy() {
    let (arm, tree) = arm();
    let labels = ArmAndHand::joint_labels();
    let distinct: BTreeSet<&str> =
        labels.into_iter().chain(ArmAndHand::muscle_labels().into_iter().flatten()).collect();
    assert_eq!(distinct.len(), 27 + 14);
    let robot = arm.robot().expect("a valid robot");
    let turned = |start: &[f64], label: &str, degrees: f64| {
        let mut q = posture(start);
        q[labels.iter().position(|l| *l == label).expect(label)] += degrees.to_radians();
        tree.poses(&q)
    };
    // Returns the growth of a measure of the arm, its palm or a finger when the joint of a label turns by 20 degrees.
    let grows = |start: &[f64], label: &str, measure: &dyn Fn(&[Pose<f64>]) -> f64| {
        measure(&turned(start, label, 20.0)) - measure(&turned(start, label, 0.0))
    };
    let hand = |poses: &[Pose<f64>]| palm(poses).transform(arm.palm_centre);
    let (middle, tip) = arm.fingertip(Finger::Middle);
    let of_forearm = |poses: &[Pose<f64>]| poses[4].transform_back(poses[middle.index()].transform(tip));
    assert!(grows(&[], "shoulder adduction", &|p| hand(p)[1]) > 0.1, "towards the body, which is to the left");
    assert!(grows(&[], "shoulder flexion", &|p| hand(p)[2]) > 0.1, "up");
    let bent = [0.0, 0.0, 0.0, -90.0];
    assert!(grows(&bent, "internal rotation", &|p| hand(p)[2]) < -0.05, "the bent forearm turns down");
    for elbow in [-120.0, -60.0] {
        let reach = |p: &[Pose<f64>]| distance(hand(p), arm.shoulder);
        assert!(grows(&[0.0, 0.0, 0.0, elbow], "elbow extension", &reach) > 0.02, "away from the shoulder");
    }
    assert!(grows(&[], "forearm supination", &|p| palm(p).rotate([0.0, 1.0, 0.0])[2]) > 0.3, "the thumb comes up");
    assert!(grows(&[], "wrist flexion", &|p| of_forearm(p)[2]) < -0.04, "to the palm's side");
    assert!(grows(&[], "wrist abduction", &|p| of_forearm(p)[1]) > 0.04, "to the thumb's side");

    let named = |finger: Finger, part: &str| format!("{} {part}", format!("{finger:?}").to_lowercase());
    for (finger, labels) in Finger::ALL.into_iter().zip(labels[7..].chunks_exact(4)) {
        let tip_of = |poses: &[Pose<f64>], finger: Finger| {
            let (body, tip) = arm.fingertip(finger);
            palm(poses).transform_back(poses[body.index()].transform(tip))
        };
        let first = if finger == Finger::Thumb { "opposition" } else { "abduction" };
        assert_eq!(labels[0], named(finger, first));
        let aside = grows(&[], labels[0], &|p| tip_of(p, finger)[1]);
        assert!(finger == Finger::Thumb || aside > 0.01, "{}: to the thumb's side", labels[0]);
        for (label, body) in labels[1..].iter().zip(ArmAndHand::phalanges(finger)) {
            assert_eq!(*label, robot.segments[body.index()].name.replace('_', " "));
        }
    }
    let opposed = turned(&[], "thumb opposition", -90.0);
    assert!(palm(&opposed).transform_back(opposed[10].position)[2] < -0.02, "out of the palm");
}

#[test]
fn muscles_pull_as_their_labels_say() {
    let robot = ArmAndHand::default().robot().expect("a valid robot");
    let opposites = [("adduct", "abduct"), ("flex", "extens"), ("internal", "external"), ("supinat", "pronat")];
    for (i, [agonist, antagonist]) in ArmAndHand::muscle_labels().into_iter().enumerate() {
        let Law::MusclePair(muscles) = robot.actuators[i].law else { panic!("no muscles") };
        let middle = 0.5 * (muscles.lower + muscles.upper);
        let torque = |command| muscles.effort(middle, 0.0, command).torque;
        assert!(torque([1.0, 0.0]) < -1.0 && torque([0.0, 1.0]) > 1.0, "J{}", i + 1);
        let turn = ArmAndHand::joint_labels()[i];
        let stem = antagonist.strip_suffix("or").expect("a muscle");
        assert!(turn.starts_with(stem), "{antagonist} beside {turn}");
        let opposed = opposites.iter().flat_map(|(a, b)| [antagonist.replace(a, b), antagonist.replace(b, a)]);
        assert!(agonist != antagonist && opposed.into_iter().any(|other| other == agonist), "{agonist}, {antagonist}");
    }
}

#[test]
fn listed_postures_put_the_palm_above_the_sphere() {
    let (arm, tree) = arm();
    for ([x, y], degrees) in SPHERES.into_iter().zip(PALM_DOWN) {
        let poses = tree.poses(&posture(&degrees));
        let centre = palm(&poses).transform(arm.palm_centre);
        let off = distance(centre, [x, y, RADIUS + 0.05]);
        println!("sphere at ({x}, {y}): {:.1} mm, {:.2} deg", off * 1e3, tilt(palm(&poses)).to_degrees());
        assert!(off < 0.005, "sphere at ({x}, {y}): palm {off} m off");
        assert!(tilt(palm(&poses)) < 2f64.to_radians(), "sphere at ({x}, {y})");
    }
}

/// The lowest surface over the table, by collider: signed height [m].
fn lowest(arm: &ArmAndHand, poses: &[Pose<f64>]) -> (f64, String) {
    let robot = arm.robot().expect("a valid robot");
    let table = Tabletop::default();
    let mut least = (f64::INFINITY, String::new());
    for collider in &robot.colliders {
        let body = collider.body.expect("on a segment");
        let pose = poses[body.index()].compose(&collider.placement);
        let (corners, radius) = match collider.shape {
            Shape::Capsule { radius, half_length: h } => {
                ((0..=20).map(|i| [0.0, 0.0, h * (0.1 * f64::from(i) - 1.0)]).collect::<Vec<_>>(), radius)
            }
            Shape::Box { half: [a, b, c] } => {
                let sign = |bit: u32, i: u32| if i & bit == 0 { -1.0 } else { 1.0 };
                ((0..8).map(|i| [a * sign(1, i), b * sign(2, i), c * sign(4, i)]).collect(), 0.0)
            }
            _ => panic!("no such shape in the arm"),
        };
        for corner in corners {
            let [x, y, z] = pose.transform(corner);
            let over = |v: f64, [low, high]: [f64; 2]| v > low - radius && v < high + radius;
            if over(x, table.table_x) && over(y, table.table_y) && z - radius < least.0 {
                least = (z - radius, collider.name.clone());
            }
        }
    }
    least
}

#[test]
fn start_postures_clear_the_table() {
    let (arm, tree) = arm();
    let clearances = STARTS.map(|degrees| lowest(&arm, &tree.poses(&posture(&degrees))));
    println!("{clearances:?}");
    assert!(clearances.iter().all(|(height, _)| *height > 0.010));
    // 1.1 cm is the figure that the shoulder's height was chosen by.
    assert!((clearances[3].0 - 0.011).abs() < 0.001, "start 4: {:?}", clearances[3]);
}

/// The lowest start posture stays above the table however its joints are displaced by one degree.
#[test]
fn displaced_starts_clear_the_table() {
    let (arm, tree) = arm();
    let mut least = f64::INFINITY;
    for signs in 0..128 {
        let mut degrees = [0.0; 7];
        for (i, d) in degrees.iter_mut().enumerate() {
            *d = STARTS[3].get(i).copied().unwrap_or(0.0) + if signs >> i & 1 == 0 { 1.0 } else { -1.0 };
        }
        least = least.min(lowest(&arm, &tree.poses(&posture(&degrees))).0);
    }
    println!("least clearance of start 4, displaced: {least:.4} m");
    assert!(least > 0.0, "{least} m");
}

/// The largest activation that holds a posture, and the torques needed.
fn holding(arm: &ArmAndHand, tree: &KinematicTree, q: &[f64]) -> (f64, Vec<f64>) {
    let robot = arm.robot().expect("a valid robot");
    let torques = tree.gravity_torques(&tree.poses(q), GRAVITY);
    let mut largest = 0.0;
    for i in 0..7 {
        let Law::MusclePair(muscles) = &robot.actuators[i].law else { panic!("no muscles") };
        let (command, reached) = muscles.activations(q[i], torques[i]);
        largest = f64::max(largest, if reached { command[0].max(command[1]) } else { f64::INFINITY });
    }
    (largest, torques)
}

#[test]
fn muscles_hold_the_listed_postures() {
    let (arm, tree) = arm();
    for degrees in PALM_DOWN {
        let (activation, torques) = holding(&arm, &tree, &posture(&degrees));
        println!("activation {activation:.2}, torques {:.2?}", &torques[..7]);
        assert!(torques[1] > 1.0 && torques[1] < 2.6, "J2 {}", torques[1]);
        assert!(torques[..7].iter().enumerate().all(|(i, t)| i == 1 || t.abs() < 0.85), "{torques:?}");
        assert!(activation < 0.6, "{activation}");
    }
}

/// Every start of the sphere within its displacement can be reached from above: the palm's center 5 cm above the
/// sphere's and facing down, inside the limits.
#[test]
fn palm_gets_above_every_start_of_the_sphere() {
    let (arm, tree) = arm();
    let solver = InverseKinematics { position_tolerance: 1e-4, angle_tolerance: 1e-3, ..InverseKinematics::default() };
    let mut strongest = 0.0;
    for ([x, y], degrees) in SPHERES.into_iter().zip(PALM_DOWN) {
        for i in -3..=3 {
            for j in -3..=3 {
                let sphere = [x + 0.005 * f64::from(i), y + 0.005 * f64::from(j), RADIUS];
                let goal = Goal {
                    body: ArmAndHand::PALM,
                    point: arm.palm_centre,
                    position: [sphere[0], sphere[1], sphere[2] + 0.05],
                    orientation: Orientation::Direction { own: ArmAndHand::PALM_NORMAL, wanted: DOWN },
                };
                // From nowhere near: the posture with everything at zero.
                let far = solver.solve(&tree, &goal, &tree.zero()).unwrap_or_else(|e| panic!("{sphere:?}: {e}"));
                let near = solver.solve(&tree, &goal, &posture(&degrees)).unwrap_or_else(|e| panic!("{sphere:?}: {e}"));
                for found in [&far, &near] {
                    let poses = tree.poses(&found.joints);
                    let centre = palm(&poses).transform(arm.palm_centre);
                    assert!(distance(centre, goal.position) < 1e-3 && tilt(palm(&poses)) < 2f64.to_radians());
                    for (q, [low, high]) in found.joints.iter().zip(tree.ranges()) {
                        assert!(low <= q && q <= high, "{q} outside [{low}, {high}]");
                    }
                }
                // Continued from the listed posture it can also be held, and keeps off the table.
                let (activation, _) = holding(&arm, &tree, &near.joints);
                strongest = f64::max(strongest, activation);
                assert!(activation < 1.0, "{sphere:?}: {activation}, {:?}", near.joints);
                let (height, part) = lowest(&arm, &tree.poses(&near.joints));
                assert!(height > 0.0, "{sphere:?}: {part} {height} m");
            }
        }
    }
    println!("largest holding activation {strongest:.2}");
}
