//! Descriptions and configurations survive being written and read.
#![cfg(all(feature = "serde", feature = "alloc"))]

use farsa_body::Pose;
use farsa_body::actuators::{Held, Law, MuscleVariant, Torque};
use farsa_body::kinematics::{Goal, InverseKinematics, KinematicTree, Orientation};
use farsa_body::motors::Muscles;
use farsa_body::ports::{ActuatorId, BodyId, Hit, PairContact};
use farsa_body::robot::{Collider, Joint, MassProperties, Robot, Segment, Shape, Surface};
use farsa_body::robots::{ArmAndHand, MobileRobot, Tabletop};
use farsa_body::sensors::BodyPose;
use farsa_body::wrappers::Noise;
use serde::{Serialize, de::DeserializeOwned};

/// Written and read.
fn again<T: Serialize + DeserializeOwned>(value: &T) -> T {
    let text = serde_json::to_string(value).expect("numbers and names");
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{text}: {error}"))
}

#[test]
fn a_robot_reads_back_as_it_was() {
    let robot = Tabletop::default().scene(&ArmAndHand::default()).expect("a valid scene");
    assert_eq!(again(&robot), robot);
    for robot in [MobileRobot::khepera(), MobileRobot::e_puck(), MobileRobot::marxbot()] {
        assert_eq!(again(&robot), robot);
    }
}

/// The parts that the arm and its table do not have: every kind of joint and shape, the other laws.
#[test]
fn every_kind_of_part_reads_back_as_it_was() {
    let mut robot = Robot::new("parts");
    let ball = MassProperties::sphere(0.1, 0.2).placed(&Pose::at([0.1, 0.0, -0.3]));
    let turned = Pose { position: [0.1, 0.2, 1.0 / 3.0], rotation: [0.5, -0.5, 0.5, 0.5] };
    let slide = Joint::prismatic("slide", [0.6, 0.8, 0.0], turned, [-0.1, 0.3]).with_armature(1e-3).with_damping(0.1);
    let base = robot.add_segment(Segment::new("base", None, Joint::fixed(turned), ball));
    let cart = robot.add_segment(Segment::new("cart", Some(base), slide, ball));
    let free = robot.add_segment(Segment::new("free", None, Joint::floating(turned), ball));
    let plane = robot.add_collider(Collider::new("plane", None, Shape::Plane, Pose::identity()));
    let block = Shape::Box { half: [0.1, 0.2, 0.3] };
    let block = robot.add_collider(Collider::new("block", Some(free), block, turned));
    robot.add_collider(Collider::new("ball", Some(cart), Shape::Sphere { radius: 0.1 }, turned));
    robot.add_collider(Collider::capsule_between("rod", Some(base), [0.0; 3], [0.1, 0.2, 0.3], 0.01));
    robot.add_pair([plane, block], Surface { friction: 0.5, rolling_friction: 1e-3, stiffness: 1e4, damping: 10.0 });
    let joint = robot.joint("slide").expect("a joint");
    robot.add_actuator("torque", joint, Law::Torque(Torque { limit: 2.0 }));
    robot.add_actuator("held", joint, Law::Held(Held { stiffness: 3.0, damping: 0.1 }));
    assert_eq!(robot.validate(), Ok(()));
    assert_eq!(again(&robot), robot);
}

#[test]
fn what_is_asked_and_answered_reads_back_as_it_was() {
    let robot = ArmAndHand::default().robot().expect("a valid robot");
    let tree = KinematicTree::new(&robot).expect("a valid robot");
    let orientation = Orientation::Direction { own: ArmAndHand::PALM_NORMAL, wanted: [0.0, 0.0, -1.0] };
    let goal = Goal { body: ArmAndHand::PALM, point: [0.0; 3], position: [0.1, -0.18, 0.075], orientation };
    assert_eq!(again(&goal), goal);
    let solution = InverseKinematics::default().solve(&tree, &goal, &tree.zero()).expect("within reach");
    assert_eq!(again(&solution), solution);
    let hit = Hit { distance: 0.1_f32, normal: [0.0, 0.6, 0.8], body: Some(BodyId(3)) };
    assert_eq!(again(&hit), hit);
    let contact = PairContact { points: 2, force: [0.1, 0.2, 0.3], normal_force: 0.7, point: [1.0; 3], depth: -0.1 };
    assert_eq!(again(&contact), contact);
    assert_eq!(again(&Noise::Normal(0.1)), Noise::Normal(0.1));
    assert_eq!(again(&Muscles::new(ActuatorId(3))), Muscles::new(ActuatorId(3)));
    let sensor = BodyPose::new(BodyId(1));
    assert_eq!(again(&sensor), sensor);
}

#[test]
fn a_configuration_names_only_what_differs() {
    let arm: ArmAndHand = serde_json::from_str(r#"{"moment_arm": 0.03, "muscle_variant": "original"}"#).expect("valid");
    assert_eq!(arm, ArmAndHand { moment_arm: 0.03, muscle_variant: MuscleVariant::Original, ..ArmAndHand::default() });
    assert_eq!(serde_json::from_str::<Tabletop>("{}").expect("valid"), Tabletop::default());
    assert_eq!(serde_json::from_str::<InverseKinematics>("{}").expect("valid"), InverseKinematics::default());
    let error = serde_json::from_str::<ArmAndHand>(r#"{"moment_arms": 0.03}"#).expect_err("a typing mistake");
    assert!(error.to_string().contains("moment_arms"));
}
