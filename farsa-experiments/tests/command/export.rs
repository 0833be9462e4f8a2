//! `farsa export`: model files for other simulators.

use std::fs;

use crate::tool::{farsa, ok, own, say, scratch};

#[test]
fn the_robot_is_written_once() {
    let here = scratch("export");
    let printed = ok(farsa(), &here, "export robot reach-grasp-lift --format mjcf");
    for part in ["name=\"J27\"", "<freejoint", "timestep=\"0.0025\"", "<key name=\"start4\"", "geom1=\"sphere\""] {
        assert!(printed.contains(part), "no {part}");
    }
    let to_file = "export robot reach-grasp-lift --condition no-labels --format mjcf --out robot.xml";
    assert_eq!(ok(farsa(), &here, to_file), "");
    assert_eq!(fs::read_to_string(here.join("robot.xml")).expect("the file"), printed);
    let said = say(farsa(), &here, to_file);
    assert!(said.code == Some(2) && said.err.contains("robot.xml: there is one already"), "{said:?}");
    let coarse = ok(farsa(), &here, "export robot reach-grasp-lift --format mjcf --set world.substeps=1");
    assert!(coarse.contains("timestep=\"0.01\""));
    let urdf = ok(farsa(), &here, "export robot reach-grasp-lift --format urdf");
    assert!(urdf.starts_with("<?xml") && urdf.contains("<link name=\"palm\">"));
}

#[test]
fn what_cannot_be_exported_is_said() {
    let here = scratch("export-nothing");
    for (program, arguments, word) in [
        (own(), "export robot cart --format mjcf", "cart has no robot"),
        (own(), "export robot crat --format mjcf", "`cart`"),
        (farsa(), "export robot reach-grasp-lift --format mjfc", "'mjcf'"),
        (farsa(), "export robot reach-grasp-lift", "--format"),
        (farsa(), "export robot reach-grasp-lift --format urdf --set world.substep=2", "world.substeps"),
        (farsa(), "export robto reach-grasp-lift", "'robot'"),
    ] {
        let said = say(program, &here, arguments);
        assert_eq!(said.code, Some(2), "{arguments}: {said:?}");
        assert!(said.err.contains(word), "{arguments}: no {word} in {said:?}");
    }
}
