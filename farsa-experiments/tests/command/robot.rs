//! `farsa robot`: what is in a model file.

use std::fs;

use crate::tool::{farsa, ok, say, scratch};

#[test]
fn what_was_exported_is_told_and_written_again() {
    let here = scratch("robot");
    ok(farsa(), &here, "export robot reach-grasp-lift --set world.substeps=4 --format mjcf --out hand.xml");
    let told = ok(farsa(), &here, "robot hand.xml");
    for part in
        ["hand.xml: ", " 27 joints", "  J27 ", "left out or replaced:", "gravity 0 0 -9.81 m/s2", "option `timestep`"]
    {
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
        assert!(said.code == Some(2) && said.err.contains(message), "{arguments}: {said:?}");
    }
    let told = ok(farsa(), &here, "robot light.urdf --least-mass 0.1 --least-inertia 0.001");
    assert!(told.contains("turns") && told.contains("without end"), "{told}");
}

/// The written model, as `farsa robot --json` prints it.
fn told(here: &std::path::Path, file: &str) -> serde_json::Value {
    serde_json::from_str(&ok(farsa(), here, &format!("robot {file} --json"))).expect("JSON")
}

fn mass(model: &serde_json::Value) -> f64 {
    model["mass"].as_f64().expect("a mass")
}

#[test]
fn robots_of_wheels_are_written_with_their_sensors() {
    let here = scratch("robot-wheels");
    ok(farsa(), &here, "new follow");
    for (number, (experiment, infrared)) in [
        ("discrimination --condition e-puck", 8),
        ("discrimination", 8),
        ("foraging", 24),
        ("predator-prey", 24),
        ("braitenberg", 8),
        ("follow.toml", 8),
    ]
    .into_iter()
    .enumerate()
    {
        for (format, element) in [("urdf", "<link"), ("mjcf", "<body")] {
            let text =
                ok(farsa(), &here, &format!("export robot {experiment} --format {format} --out {number}.{format}"));
            assert_eq!(text, "", "{experiment}");
            let text = fs::read_to_string(here.join(format!("{number}.{format}"))).expect("the file");
            let count = text.matches(&format!("{element} name=\"infrared ")).count();
            assert_eq!(count, infrared, "{experiment} as {format}");
            assert_eq!(text.contains("timestep=\"0.0025\""), format == "mjcf", "{experiment} as {format}");
            let model = told(&here, &format!("{number}.{format}"));
            let joints = model["joints"].as_array().expect("joints");
            let names: Vec<_> = joints.iter().filter_map(|joint| joint["name"].as_str()).collect();
            assert_eq!(names, ["left wheel", "right wheel"], "{experiment} as {format}");
        }
    }
    // As large as in the settings.
    let wide = "discrimination --condition e-puck --set robot.radius=0.035";
    ok(farsa(), &here, &format!("export robot {wide} --format urdf --out wide.urdf"));
    let ratio = mass(&told(&here, "wide.urdf")) / mass(&told(&here, "0.urdf"));
    let wider = 0.035 / 0.0275;
    assert!((ratio - wider * wider).abs() < 1e-9, "{ratio}");
}

#[test]
fn the_body_of_a_champion_is_written() {
    let here = scratch("robot-champion");
    ok(farsa(), &here, "run body-evolution --generations 1 --population 24 --quiet --set trial.count=1 --out r");
    ok(farsa(), &here, "export robot r --format urdf --out champion.urdf");
    ok(farsa(), &here, "export robot body-evolution --format urdf --out middle.urdf");
    let [champion, middle] = ["champion.urdf", "middle.urdf"].map(|file| told(&here, file));
    assert_eq!(champion["joints"].as_array().map(Vec::len), middle["joints"].as_array().map(Vec::len));
    assert!((mass(&champion) - mass(&middle)).abs() > 1e-3, "{champion} {middle}");
    // The same from a directory that is called like an experiment, by its path.
    fs::rename(here.join("r"), here.join("body-evolution")).expect("a directory");
    let again = ok(farsa(), &here, "export robot ./body-evolution --format urdf");
    assert_eq!(again, fs::read_to_string(here.join("champion.urdf")).expect("the file"));
    let experiment = ok(farsa(), &here, "export robot body-evolution --format urdf");
    assert_eq!(experiment, fs::read_to_string(here.join("middle.urdf")).expect("the file"));
    for (arguments, message) in [
        ("export robot ./nothing --format urdf", "./nothing: there is no such directory"),
        ("export robot . --format urdf", "holds no run"),
        ("export robot nothing.toml --format urdf", "nothing.toml"),
        ("export robot body-evolutoin --format urdf", "the nearest is `body-evolution`"),
        (
            "export robot ./body-evolution --condition powered --format urdf",
            "--condition powered: a run has a condition",
        ),
        ("export robot ./body-evolution --population 1 --format urdf", "--population: unknown population `1`"),
        ("export robot foraging --population 0 --format urdf", "for the directory of a run, and foraging is none"),
        ("export robot minimal-cognition --format urdf", "minimal-cognition has no robot to export"),
    ] {
        let said = say(farsa(), &here, arguments);
        assert!(said.code == Some(2) && said.err.contains(message), "{arguments}: {said:?}");
    }
}
