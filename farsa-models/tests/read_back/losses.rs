//! Parts of an MJCF that are left out are listed, and declarations that MuJoCo accepts are read.

use farsa_models::{Imported, ReadOptions};
use serde_json::Value;

use crate::{fixture, message, read};

fn notes(text: &str) -> Vec<String> {
    read(text).unwrap_or_else(|error| panic!("{error}")).warnings.iter().map(ToString::to_string).collect()
}

/// Returns a model with an element of the schema, with these attributes besides the needed ones.
fn model(path: &str, attributes: &str) -> String {
    let body = "<body name='b'><joint name='j'/><geom name='g' size='0.1'/></body><geom name='h' size='0.1'/>";
    let needs = |name: &str, value: &str| {
        let given = attributes.split('=').next().unwrap_or_default() == name;
        if given { String::new() } else { format!("{name}='{value}'") }
    };
    let (section, tag) = path.split_once('/').unwrap_or(("", path));
    let element = |needed: &str| format!("<{tag} {attributes} {needed}/>");
    let (before, inner, after) = match (section, tag) {
        ("", "compiler" | "option") => (element(""), String::new(), String::new()),
        ("", "body") => (String::new(), format!("<body {attributes}/>"), String::new()),
        ("option", _) => (format!("<option>{}</option>", element("")), String::new(), String::new()),
        ("default", _) => (format!("<default>{}</default>", element("")), String::new(), String::new()),
        ("asset", _) => (format!("<asset>{}</asset>", element(&needs("name", "m"))), String::new(), String::new()),
        ("body", "inertial") => {
            let needed = [needs("mass", "1"), needs("diaginertia", "1 1 1")].join(" ");
            (String::new(), format!("<body>{}<geom size='1'/></body>", element(&needed)), String::new())
        }
        ("body", "geom") => (String::new(), format!("<body>{}</body>", element(&needs("size", "1"))), String::new()),
        ("body", _) => (String::new(), format!("<body>{}<geom size='1'/></body>", element("")), String::new()),
        ("contact", "pair") => {
            let needed = [needs("geom1", "g"), needs("geom2", "h")].join(" ");
            (String::new(), String::new(), format!("<contact>{}</contact>", element(&needed)))
        }
        ("contact", _) => {
            let needed = [needs("body1", "b"), needs("body2", "world")].join(" ");
            (String::new(), String::new(), format!("<contact>{}</contact>", element(&needed)))
        }
        _ => (String::new(), String::new(), format!("<actuator>{}</actuator>", element(&needs("joint", "j")))),
    };
    format!("<mujoco>{before}<worldbody>{body}{inner}</worldbody>{after}</mujoco>")
}

#[test]
fn every_attribute_of_mujocos_schema_is_known() {
    // fixtures/schema.py, from mj_printSchema of MuJoCo 4.0.0.
    let schema: Value = serde_json::from_str(&fixture("schema.json")).unwrap();
    let elements = schema["elements"].as_object().unwrap();
    assert!(elements.len() > 35);
    for (path, attributes) in elements {
        for attribute in attributes.as_array().unwrap().iter().map(|name| name.as_str().unwrap()) {
            // The value may be wrong. The attribute is not.
            if let Err(error) = read(&model(path, &format!("{attribute}='1'"))) {
                assert!(!error.to_string().contains("unknown attribute"), "{path} {attribute}: {error}");
            }
        }
        let error = message(&model(path, "nonsense='1'"));
        assert!(error.contains("unknown attribute of ") && error.contains("`nonsense`"), "{path}: {error}");
    }
}

#[test]
fn attributes_and_elements_without_effect_are_listed() {
    for (path, attribute, note) in [
        ("actuator/motor", "kp='2'", "motor `kp`: has no effect here"),
        ("body/joint", "type='free' axis='1 0 0'", "joint `axis`: has no effect here"),
        ("body/geom", "fitscale='2'", "geom `fitscale`: has no effect here"),
        ("actuator/position", "inheritrange='1'", "actuator position `inheritrange`: the joint has no range"),
    ] {
        let text = model(path, attribute);
        let found = notes(&text);
        assert!(found.iter().any(|found| found.ends_with(note)), "{note}: {found:?}");
    }
    let plugin = model("body/geom", "").replace("<geom  size='1'/>", "<geom size='1'><plugin/></geom>");
    assert_eq!(notes(&plugin)[1..], ["text line 1: plugin: is not read in geom"]);
    let range = model("compiler", "").replace("<compiler  />", "<compiler><lengthrange/></compiler>");
    assert!(notes(&range).contains(&"text line 1: lengthrange: how MuJoCo computes".into()));
    // A pair and a mass of 0 have no need of these, and neither has MuJoCo.
    let quiet = model("body/geom", "contype='0' conaffinity='0' group='1' friction='2' solref='0.1' condim='1'");
    let found = notes(&quiet);
    assert_eq!(found, ["text line 1: contype, conaffinity: became 1 pairs"], "the pair of the other geoms");
}

#[test]
fn free_joints_list_what_they_cannot_have() {
    let text = |option: &str, joint: &str| {
        format!(
            "<mujoco>{option}<default><joint armature='0.5' damping='0.7' stiffness='3' frictionloss='0.1'/></default>\
             <worldbody><body>{joint}<geom size='0.1'/></body></worldbody></mujoco>"
        )
    };
    let lost = |option: &str, joint: &str| -> Vec<String> {
        let of_joint = |note: &String| note.contains("free joint");
        notes(&text(option, joint)).into_iter().filter(of_joint).collect()
    };
    let expected = ["armature", "damping", "frictionloss", "stiffness"]
        .map(|name| format!("text line 1: free joint `{name}`: left out: free bodies have none"));
    assert_eq!(lost("", "<joint type='free'/>"), expected);
    let flag = "<option><flag damper='disable' spring='disable' frictionloss='disable'/></option>";
    assert_eq!(lost(flag, "<joint type='free'/>"), expected[..1]);
    // MuJoCo gives none of the defaults to a `freejoint`.
    assert!(lost("", "<freejoint/>").is_empty());
    assert!(lost("", "<joint type='free' armature='0' damping='0' stiffness='0' frictionloss='0'/>").is_empty());
}

#[test]
fn a_pair_that_is_declared_twice_has_the_springs_of_both() {
    let text = |pairs: &str| {
        format!(
            "<mujoco><option cone='elliptic'/><worldbody><body pos='0 0 1'><freejoint/><geom name='g' size='0.1'/></body>\
             <body pos='0 0 2'><freejoint/><geom name='h' size='0.1'/></body></worldbody>\n<contact>{pairs}</contact></mujoco>"
        )
    };
    let first = "<pair geom1='g' geom2='h' condim='3' friction='0.4' solref='0.02'/>";
    let second = "<pair geom1='h' geom2='g' condim='3' friction='1' solref='0.04'/>";
    let surface = |pairs: &str| {
        let robot = read(&text(pairs)).unwrap().robot;
        assert_eq!(robot.pairs.len(), 1, "{pairs}");
        robot.pairs[0].surface
    };
    let [a, b, both] = [first, second, &[first, second].concat()].map(surface);
    // MuJoCo 4.0.0 makes two contacts (`ncon` 2), whose forces add up: 1 + 1/4 of the stiffness, and the friction of each.
    assert_eq!(both.stiffness, a.stiffness + b.stiffness);
    assert!((both.stiffness / a.stiffness - 1.25).abs() < 1e-12 && both.damping == a.damping + b.damping);
    assert!((both.friction - (0.4 + 0.25) / 1.25).abs() < 1e-12, "{both:?}");
    let note = "text line 2: pair: declared already: a contact has the springs and dampers of both";
    assert!(notes(&text(&[first, second].concat())).contains(&note.into()));
    assert!(!notes(&text(first)).contains(&note.into()));
}

#[test]
fn an_exclude_that_is_declared_twice_is_read() {
    let text = "<mujoco><worldbody><body name='a'><freejoint/><geom size='0.1'/></body>\
         <body name='b'><freejoint/><geom size='0.1'/></body></worldbody>\n<contact><exclude body1='a' body2='b'/>\n\
         <exclude body1='b' body2='a'/></contact></mujoco>";
    let read = read(text).unwrap();
    assert!(read.robot.pairs.is_empty());
    assert_eq!(read.warnings[0].to_string(), "text line 3: exclude: declared already");
}

#[test]
fn joints_of_one_body_pass_masses_of_fixed_bodies_on() {
    let text = "<mujoco><compiler angle='radian'/><worldbody><body name='stage' pos='1 0 0'>\
         <joint name='x' type='slide' axis='1 0 0'/><joint name='y' type='slide' axis='0 1 0' pos='0 0 0.1'/>\
         <joint name='z' axis='0 0 1' pos='0.2 0 0'/>\
         <body name='load' pos='0 0 0.5'><geom size='0.1' mass='2'/></body></body></worldbody></mujoco>";
    let options = ReadOptions { between: 0.125, ..ReadOptions::default() };
    let Imported { robot, frames, .. } = Imported::from_text(text, &options).unwrap();
    let masses: Vec<f64> = robot.segments.iter().map(|segment| segment.mass).collect();
    assert_eq!(masses, [0.25, 0.25, 1.5, 0.0]);
    // Half a meter above the body, in the frame of each joint. MuJoCo: body_subtreemass 2, subtree_com 1 0 0.5.
    let centers: Vec<[f64; 3]> = robot.segments[..3].iter().map(|segment| segment.centre).collect();
    assert_eq!(centers, [[0.0, 0.0, 0.5], [0.0, 0.0, 0.4], [-0.2, 0.0, 0.5]]);
    // A ball of 2 kg has 2/5 m r2 = 0.008 kg m2.
    let moments: f64 = robot.segments.iter().map(|segment| segment.inertia[2]).sum();
    assert!((moments - 0.008).abs() < 1e-15, "{moments}");
    assert_eq!(frames[0].name, "stage");
    // The body keeps a mass, and does not receive that of moving bodies.
    let own = text.replace("<body name='load'", "<geom size='0.1' mass='1'/><body name='load'");
    let masses: Vec<f64> =
        Imported::from_text(&own, &options).unwrap().robot.segments.iter().map(|segment| segment.mass).collect();
    assert_eq!(masses, [0.125, 0.125, 0.75, 2.0]);
    let moving = text.replace("<geom size='0.1' mass='2'/>", "<joint/><geom size='0.1' mass='2'/>");
    assert!(message(&moving).contains("a body that moves cannot have mass 0"), "{}", message(&moving));
}
