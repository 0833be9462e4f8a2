//! `farsa robot`: what is in a model file.

use std::fs;

use crate::tool::{farsa, ok, say, scratch};

#[test]
fn what_was_exported_is_told_and_written_again() {
    let here = scratch("robot");
    ok(farsa(), &here, "export robot reach-grasp-lift --format mjcf --out hand.xml");
    let told = ok(farsa(), &here, "robot hand.xml");
    for part in ["hand.xml: ", " 27 joints", "  J27 ", "left out or replaced:", "option: gravity"] {
        assert!(told.contains(part), "no {part}: {told}");
    }
    let json = ok(farsa(), &here, "robot hand.xml --json");
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(json["joints"].as_array().map(Vec::len), Some(27));
    ok(farsa(), &here, "robot hand.xml --format mjcf --out again.xml");
    let parts = |name: &str, element: &str| {
        let text = fs::read_to_string(here.join(name)).expect("the file");
        text.lines().filter(|line| line.contains(element)).map(str::to_owned).collect::<Vec<_>>()
    };
    for element in ["<body ", "<joint ", "<inertial ", "<geom "] {
        assert_eq!(parts("hand.xml", element), parts("again.xml", element));
    }
    let said = say(farsa(), &here, "robot hand.xml --format urdf --out again.xml");
    assert!(said.code == Some(2) && said.err.contains("again.xml: there is one already"), "{said:?}");
}

#[test]
fn what_is_wrong_is_said_with_its_line() {
    let here = scratch("robot-wrong");
    let link = "<link name='a'/>\n<link name='b'/>\n";
    let joint = "<joint name='j' type='revolute'><parent link='a'/><child link='bb'/></joint>";
    fs::write(here.join("wrong.urdf"), format!("<robot name='r'>\n{link}{joint}</robot>")).expect("a file");
    fs::write(here.join("empty.urdf"), "<robots/>").expect("a file");
    let continuous = joint.replace("bb", "b").replace("revolute", "continuous");
    fs::write(here.join("light.urdf"), format!("<robot name='r'>\n{link}{continuous}</robot>")).expect("a file");
    for (arguments, message) in [
        ("robot wrong.urdf", "wrong.urdf line 4: unknown link `bb`; the nearest is `b`"),
        ("robot empty.urdf", "unknown root of a model `robots`; the nearest is `robot`"),
        ("robot none.urdf", "none.urdf: "),
        ("robot light.urdf", "see `Repair`; or --least-mass, --least-inertia, --balance"),
        ("robot light.urdf --least-mass -1", "must be a number from 0 on"),
    ] {
        let said = say(farsa(), &here, arguments);
        assert!(said.code != Some(0) && said.err.contains(message), "{arguments}: {said:?}");
    }
    let told = ok(farsa(), &here, "robot light.urdf --least-mass 0.1 --least-inertia 0.001");
    assert!(told.contains("turns") && told.contains("without end"), "{told}");
}
