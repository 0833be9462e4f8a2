//! Faults with their place and the nearest name, and MuJoCo's rules.

use std::fmt::Write as _;

use farsa_body::actuators::{Law, Torque};
use farsa_body::kinematics::KinematicTree;
use farsa_models::{Imported, ReadOptions, Repair};

use crate::{message, read};

const LINK: &str =
    r#"<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>"#;

/// A URDF of links `a`, `b`, `c` and this between them.
fn urdf(rest: &str) -> String {
    let mut text = String::from("<robot name=\"r\">\n");
    for name in ["a", "b", "c"] {
        let _ = writeln!(text, "<link name=\"{name}\">{LINK}</link>");
    }
    text + rest + "</robot>"
}

fn hinge(name: &str, parent: &str, child: &str) -> String {
    format!(
        "<joint name=\"{name}\" type=\"revolute\"><parent link=\"{parent}\"/><child link=\"{child}\"/>\
         <limit lower=\"-1\" upper=\"1\" effort=\"2\" velocity=\"3\"/></joint>\n"
    )
}

/// Elements that would add or change parts are refused, other programs' notes are listed.
#[test]
fn unprocessed_and_misplaced_elements_of_a_urdf_are_refused() {
    let processed = "is not processed; `xacro FILE` writes the URDF to read";
    let spaces =
        "xmlns:xacro=\"http://www.ros.org/wiki/xacro\" xmlns:x=\"http://ros.org/wiki/xacro\" xmlns:d=\"http://d\"";
    let text = |rest: &str| {
        urdf(&(hinge("j", "a", "b") + &hinge("k", "b", "c") + rest)).replace("<robot", &format!("<robot {spaces}"))
    };
    for (part, expected) in [
        ("<xacro:leg name=\"left\"/>", format!("text line 7: xacro:leg `left`: {processed}")),
        ("<x:include filename=\"a\"/>", format!("text line 7: xacro:include: {processed}")),
        (
            "<material name=\"m\"/><link name=\"${side}_leg\"/>",
            format!("text line 7: link `${{side}}_leg`: name \"${{side}}_leg\" {processed}"),
        ),
        ("<leg side=\"1\"/>", "text line 7: unknown element of robot `leg`; the nearest is `link`".into()),
        ("<d:joint name=\"l\"/>", "text line 7: unknown element of robot `d:joint`; the nearest is `joint`".into()),
        ("<mass value=\"1\"/>", "text line 7: unknown element of robot `mass`; the nearest is `link`".into()),
    ] {
        assert_eq!(message(&text(part)), expected);
    }
    let misplaced = text("").replacen("<inertial>", "<xacro:inertia mass=\"1\"/><inertial>", 1);
    assert_eq!(message(&misplaced), format!("text line 2: xacro:inertia: {processed}"));
    let misplaced = text("").replacen("<inertial>", "<mass value=\"1\"/><inertial>", 1);
    assert_eq!(message(&misplaced), "text line 2: unknown element of link `mass`; the nearest is `visual`");
    let noted = text("<gazebo><xacro:a/><b c=\"${d}\"/></gazebo><ros2_control name=\"$(arg a)\"/>");
    let noted = noted.replacen("<inertial>", "<contact/><d:note/><inertial>", 1);
    let reading = read(&noted).unwrap();
    assert_eq!(reading.warnings.len(), 5, "{:?}", reading.warnings);
}

#[test]
fn faults_of_a_urdf_are_told_with_place_and_nearest_name() {
    let sound = hinge("j", "a", "b") + &hinge("k", "b", "c");
    let reading = read(&urdf(&sound)).unwrap();
    assert_eq!(reading.robot.joints().count(), 2);
    assert_eq!(reading.warnings.len(), 1, "the velocity: {:?}", reading.warnings);
    for (change, expected) in [
        (("parent link=\"a\"", "parent link=\"aa\""), "text line 5: unknown link `aa`; the nearest is `a`"),
        (("type=\"revolute\"", "type=\"revolut\""), "text line 5: unknown type `revolut`; the nearest is `revolute`"),
        (
            ("type=\"revolute\"", "type=\"planar\""),
            "text line 5: joint `j`: planar joints cannot be described; two or three joints can",
        ),
        (("<limit", "<limits"), "text line 5: unknown element of joint `limits`; the nearest is `limit`"),
        (("<limit", "<limit/><limit"), "text line 5: a second limit of joint `j`, the first is in line 5"),
        (("<mass", "<mass value=\"1\"/><mass"), "text line 2: a second mass of `inertial`, the first is in line 2"),
        (("upper=", "uper="), "text line 5: unknown attribute of limit `uper`; the nearest is `upper`"),
        (("upper=\"1\"", "upper=\"-2\""), "text line 5: limit: upper is \"-2\", but must not be below lower"),
        (("upper=\"1\"", "upper=\"one\""), "text line 5: limit: upper is \"one\", but must be of numbers"),
        (("<parent link=\"a\"/>", ""), "text line 5: joint `j` has no parent"),
        (("link name=\"b\"", "link name=\"a\""), "text line 3: a second link `a`, the first is in line 2"),
        (("joint name=\"k\"", "joint name=\"j\""), "text line 6: a second joint `j`, the first is in line 5"),
        (
            ("<mass value=\"1\"/>", "<mass value=\"-1\"/>"),
            "text line 2: mass: value is \"-1\", but must not be negative",
        ),
        (("<mass value=\"1\"/>", ""), "text line 2: inertial has no mass"),
        (
            ("ixx=\"1\"", "ixx=\"3\""),
            "text line 2: a: no body has mass 1 and inertia [3.0, 1.0, 1.0, 0.0, 0.0, 0.0]; see `Repair`",
        ),
        (("</robot>", "</root>"), "text line 7: expected 'robot' tag, not 'root'"),
        (("<robot name", "<robots name"), "text line 7: expected 'robots' tag, not 'robot'"),
    ] {
        let text = urdf(&sound).replacen(change.0, change.1, 1);
        assert_eq!(message(&text), expected);
    }
    assert_eq!(message("<robots/>"), "text line 1: unknown root of a model `robots`; the nearest is `robot`");
    assert_eq!(message("<robot/>"), "text line 1: robot has no link");
    assert_eq!(message("<robot>\n<!-- a -- b --></robot>"), "text line 2: comment contains '--'");
    assert_eq!(
        message(&urdf(&hinge("j", "a", "b"))),
        "text line 4: 2 links hang on nothing (a, c); a robot has one root"
    );
    let ring = hinge("j", "a", "b") + &hinge("k", "b", "c") + &hinge("l", "c", "a");
    assert_eq!(message(&urdf(&ring)), "text line 2: links carry each other: a, c, b");
    let apart = hinge("k", "b", "c") + &hinge("l", "c", "b");
    assert_eq!(message(&urdf(&apart)), "text line 3: links carry each other: b, c");
    let twice = sound.clone() + &hinge("l", "a", "c");
    assert!(message(&urdf(&twice)).starts_with("text line 7: a second joint that carries the same link as `k`"));
    let massless = urdf(&sound).replacen(LINK, "", 3);
    assert!(message(&massless).contains("line 3: b: a body that moves cannot have mass 0"), "{}", message(&massless));
    let repair = Repair { least_mass: 0.1, least_inertia: 1e-4, balance: false };
    let repaired = Imported::from_text(&massless, &ReadOptions { repair, ..ReadOptions::default() }).unwrap();
    assert_eq!(repaired.robot.segments[1].mass, 0.1);
}

#[test]
fn the_old_properties_of_a_joint_are_listed() {
    let text = urdf(&(hinge("j", "a", "b") + &hinge("k", "b", "c")));
    let old = read(&text.replacen("<limit", "<joint_properties damping=\"0.5\"/><limit", 1)).unwrap();
    // Pinocchio 4.1.0 skips them, too.
    assert_eq!(old.robot, read(&text).unwrap().robot);
    assert!(old.warnings.iter().any(|note| note.what == "joint_properties"), "{:?}", old.warnings);
}

/// An MJCF with this in the body `b`.
fn mjcf(inner: &str) -> String {
    format!(
        "<mujoco>\n<worldbody>\n<body name=\"b\">\n<geom name=\"g\" size=\"0.1\"/>\n{inner}\n</body>\n</worldbody>\n</mujoco>"
    )
}

#[test]
fn faults_of_an_mjcf_are_told_with_place_and_nearest_name() {
    for (inner, expected) in [
        ("<joint axs=\"1 0 0\"/>", "text line 5: unknown attribute of joint `axs`; the nearest is `axis`"),
        ("<joint type=\"hing\"/>", "text line 5: unknown type `hing`; the nearest is `hinge`"),
        ("<joint type=\"ball\"/>", "text line 5: joint: ball joints cannot be described; three hinges can"),
        ("<joint class=\"leg\"/>", "text line 5: unknown class `leg`; the nearest is `main`"),
        ("<joint axis=\"0 0 0\"/>", "text line 5: joint: axis is \"0 0 0\", but must be a direction"),
        (
            "<joint limited=\"true\" range=\"10 -10\"/>",
            "text line 5: joint: range is \"10 -10\", but must end after it begins",
        ),
        ("<joint limited=\"true\"/>", "text line 5: joint has no range"),
        ("<joint/><freejoint/>", "text line 3: body `b`: a free joint beside others"),
        ("<body name=\"b\"/>", "text line 5: a second body `b`, the first is in line 3"),
        (
            "<body><freejoint/></body>",
            "text line 5: body: a free joint on a body; only bodies in the world can be free",
        ),
        ("<geom name=\"h\" type=\"mesh\"/>", "text line 5: geom `h` has no mesh"),
        ("<geom name=\"h\" type=\"mesh\" mesh=\"m\"/>", "text line 5: unknown mesh `m`; there is none"),
        ("<geom type=\"box\" size=\"1 2\"/>", "text line 5: geom: size is \"1 2\", but a box has 3"),
        (
            "<geom type=\"capsule\" size=\"1\" fromto=\"0 0 0 0 0 0\"/>",
            "text line 5: geom: fromto is \"0 0 0 0 0 0\", but must be two points",
        ),
        ("<geom size=\"-1\"/>", "text line 5: geom: size is \"-1\", but must be positive, below 1e9"),
        ("<geom size=\"1\" quat=\"0 0 0 0\"/>", "text line 5: geom: quat is \"0 0 0 0\", but must be a direction"),
        (
            "<geom size=\"1\" quat=\"1 0 0 0\" euler=\"1 2 3\"/>",
            "text line 5: geom: euler is \"1 2 3\", but there is `quat` already",
        ),
        (
            "<inertial mass=\"1\" diaginertia=\"1 1 3\"/>",
            "text line 3: b: no body has mass 1 and inertia [1.0, 1.0, 3.0, 0.0, 0.0, 0.0]; see `Repair`",
        ),
        ("<bodie/>", "text line 5: unknown element of body `bodie`; the nearest is `body`"),
        ("<inertial mass=\"1\"/>", "text line 5: inertial has no diaginertia or fullinertia"),
    ] {
        assert_eq!(message(&mjcf(inner)), expected, "{inner}");
    }
    let replicate = message(&mjcf("<replicate count=\"3\"/>"));
    assert!(replicate.starts_with("text line 5: replicate: makes bodies by MuJoCo's rules"), "{replicate}");
    let with = |section: &str| mjcf("<joint name=\"hip\"/>").replace("</mujoco>", &format!("{section}</mujoco>"));
    for (section, expected) in [
        ("<actuator><motor joint=\"hipp\"/></actuator>", "text line 8: unknown joint `hipp`; the nearest is `hip`"),
        ("<contact><pair geom1=\"g\" geom2=\"f\"/></contact>", "text line 8: unknown geom `f`; the nearest is `g`"),
        ("<contact><exclude body1=\"b\" body2=\"c\"/></contact>", "text line 8: unknown body `c`; the nearest is `b`"),
        ("<compiler angle=\"degrees\"/>", "text line 8: unknown angle `degrees`; the nearest is `degree`"),
        (
            "<compiler coordinate=\"global\"/>",
            "text line 8: compiler: global coordinates, which MuJoCo gave up in version 2.3.4",
        ),
        ("<default><joints/></default>", "text line 8: unknown element of default `joints`; the nearest is `joint`"),
        (
            "<default><joint dampng=\"1\"/></default>",
            "text line 8: unknown attribute of joint `dampng`; the nearest is `damping`",
        ),
        ("<include file=\"a.xml\"/>", "text line 8: \"a.xml\" names a file, and no folder was given"),
    ] {
        assert_eq!(message(&with(section)), expected);
    }
    let huge = with("<compiler boundmass=\"1\"/>").replace("size=\"0.1\"", "size=\"0.1\" density=\"0\"");
    assert!(message(&huge).contains("a body that moves"), "a mass without inertia: {}", message(&huge));
}

#[test]
fn mujocos_rules_are_followed() {
    let text = r#"<mujoco model="m"><compiler angle="radian" eulerseq="zyx"/>
      <default><geom density="500"/><joint damping="1"/>
        <default class="leg"><geom type="capsule" size="0.1"/><joint damping="2" axis="0 1 0"/>
          <default class="foot"><joint armature="3"/></default></default></default>
      <worldbody><geom name="floor" type="plane" size="1 1 1"/>
        <body name="hip" childclass="leg" pos="0 0 1"><freejoint/><geom fromto="0 0 0 0 0 -1" contype="2"/>
          <frame pos="0 0 -1" euler="0 0 0.5"><body name="knee"><joint name="k" pos="0 0 0.5" range="-1 2" ref="0.5" class="foot"/>
            <geom type="box" size="0.1 0.1 0.1" mass="2"/></body></frame></body></worldbody>
      <actuator><position joint="k" kp="10" kv="1" gear="2" forcerange="-3 3"/><general joint="k" gainprm="4" ctrlrange="-1 1"/>
        <velocity name="v" joint="k" kv="5"/><muscle joint="k"/></actuator></mujoco>"#;
    let Imported { robot, warnings, frames, .. } = read(text).unwrap();
    let knee = &robot.segments[robot.body("knee").unwrap().index()];
    assert_eq!((knee.joint.damping, knee.joint.armature, knee.joint.axis), (2.0, 3.0, [0.0, 1.0, 0.0]));
    assert_eq!(knee.joint.range, [-1.0, 2.0]);
    assert_eq!(knee.mass, 2.0);
    // The segment is at the joint, the body half a meter below it.
    assert_eq!(frames[1].placement.position, [0.0, 0.0, -0.5]);
    let tree = KinematicTree::new(&robot).unwrap();
    let pose = tree.poses(&[0.5])[1].compose(&frames[1].placement);
    assert!(
        (0..3).all(|k| (pose.position[k] - [0.0, 0.0, 0.0][k]).abs() < 1e-15),
        "at its reference as in the file: {pose:?}"
    );
    let volume = std::f64::consts::PI * 0.01 * (1.0 + 4.0 / 3.0 * 0.1);
    assert!((robot.segments[0].mass - 500.0 * volume).abs() < 1e-12);
    let laws: Vec<Law<f64>> = robot.actuators.iter().map(|actuator| actuator.law).collect();
    assert_eq!(laws[0], Law::Servo(farsa_body::actuators::Servo { stiffness: 40.0, damping: 4.0, limit: 6.0 }));
    assert_eq!(laws[1], Law::Torque(Torque { limit: 4.0 }));
    assert_eq!(laws[2], Law::Velocity(farsa_body::actuators::Velocity { gain: 5.0, limit: f64::INFINITY }));
    assert_eq!(laws.len(), 3);
    assert!(
        warnings.iter().any(|note| note.what == "actuator muscle" && note.why.starts_with("left out")),
        "{warnings:?}"
    );
    // Hip and knee do not touch, because one carries the other. The hip's bits match the floor's by its affinity only.
    let pairs: Vec<[&str; 2]> =
        robot.pairs.iter().map(|p| p.colliders.map(|i| robot.colliders[i].name.as_str())).collect();
    assert_eq!(pairs, [["floor", "geom1"], ["floor", "geom2"]]);
}
