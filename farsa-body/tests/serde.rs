//! Descriptions and configurations survive being written and read.
#![cfg(all(feature = "serde", feature = "alloc"))]
#![allow(missing_docs)]

use farsa_body::{ArmAndHand, InverseKinematics, MuscleVariant, Robot, Tabletop};

#[test]
fn a_robot_reads_back_as_it_was() {
    let robot = Tabletop::default().scene(&ArmAndHand::default()).expect("a valid scene");
    let text = serde_json::to_string(&robot).expect("numbers and names");
    assert_eq!(serde_json::from_str::<Robot>(&text).expect("what was written"), robot);
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
