//! What was written is read as it was; what is wrong, hostile or damaged is refused with its place.
#![allow(missing_docs, clippy::unwrap_used)]

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use farsa_body::{ArmAndHand, JointKind, KinematicTree, Law, Pose, Robot, Shape, Tabletop, Torque};
use farsa_models::{Imported, Limits, Meshes, MjcfOptions, ReadError, ReadOptions, Repair, mjcf, urdf};
use proptest::prelude::*;

fn read(text: &str) -> Result<Imported, ReadError> {
    Imported::from_text(text, &ReadOptions::default())
}

fn fixture(name: &str) -> String {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/fixtures")).join(name);
    fs::read_to_string(path).unwrap()
}

fn scene() -> Robot {
    Tabletop::default().scene(&ArmAndHand::default()).unwrap()
}

/// The same robot, but for the laws and surfaces that a format does not have; those are compared by the caller.
fn same(written: &Robot, read: &Robot, tolerance: f64) {
    assert_eq!(read.name, written.name);
    assert_eq!(read.segments.len(), written.segments.len());
    let close = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| a == b || (a - b).abs() <= tolerance);
    for (a, b) in written.segments.iter().zip(&read.segments) {
        assert_eq!((&b.name, b.parent, b.joint.kind), (&a.name, a.parent, a.joint.kind));
        let poses = [&a.joint.placement, &b.joint.placement];
        assert!(close(&poses[0].position, &poses[1].position), "{}", a.name);
        let same: f64 = poses[0].rotation.iter().zip(&poses[1].rotation).map(|(a, b)| a * b).sum();
        assert!((same.abs() - 1.0).abs() <= tolerance.max(1e-15), "{}", a.name);
        assert!(
            close(&[a.mass], &[b.mass]) && close(&a.centre, &b.centre) && close(&a.inertia, &b.inertia),
            "{}",
            a.name
        );
        if a.joint.kind.is_single() {
            assert_eq!(b.joint.name, a.joint.name);
            let unit = |v: [f64; 3]| v.map(|x| x / v.iter().map(|x| x * x).sum::<f64>().sqrt());
            assert!(close(&unit(a.joint.axis), &unit(b.joint.axis)), "{}", a.joint.name);
            assert_eq!((b.joint.range, b.joint.damping), (a.joint.range, a.joint.damping));
        }
    }
    assert_eq!(read.colliders.len(), written.colliders.len());
    for a in &written.colliders {
        let b = &read.colliders[read.collider(&a.name).unwrap_or_else(|| panic!("collider {}", a.name))];
        assert_eq!(b.body, a.body);
        assert!(close(&a.placement.position, &b.placement.position), "{}", a.name);
    }
}

#[test]
fn mjcf_is_read_as_it_was_written() {
    for (name, robot) in [("tabletop", scene()), ("zoo", read(&fixture("zoo.xml")).unwrap().robot)] {
        let text = mjcf::write(&robot, &MjcfOptions::default()).unwrap();
        let reading = read(&text).unwrap();
        // To the last bit but for what the format does not say.
        let mut expected = robot.clone();
        for actuator in &mut expected.actuators {
            if let Law::MusclePair(_) | Law::Held(_) = actuator.law {
                actuator.law = Law::Torque(Torque { limit: f64::INFINITY });
            }
        }
        // Geoms stand with their bodies, bodies depth first: the lists may be in another order.
        same(&expected, &reading.robot, 0.0);
        assert_eq!(reading.robot.actuators, expected.actuators, "{name}");
        assert_eq!(reading.robot.segments, expected.segments, "{name}");
        for collider in &expected.colliders {
            let read = &reading.robot.colliders[reading.robot.collider(&collider.name).unwrap()];
            assert_eq!(read, collider, "{name}");
        }
        assert_eq!(reading.robot.pairs.len(), expected.pairs.len(), "{name}");
        for pair in &expected.pairs {
            let [a, b] = pair.colliders.map(|i| expected.colliders[i].name.as_str());
            let read = reading.robot.pairs[reading.robot.pair(a, b).unwrap().index()].surface;
            assert_eq!(read.friction, pair.surface.friction);
            assert_eq!(read.rolling_friction, pair.surface.rolling_friction);
            // The stiffness is written as a time constant and an impedance near 1.
            assert!((read.stiffness / pair.surface.stiffness - 1.0).abs() < 1e-8, "{name}: {a}, {b}: {read:?}");
        }
        let warnings: Vec<&str> = reading.warnings.iter().map(|note| note.what.as_str()).collect();
        assert_eq!(warnings, ["joint `solimplimit`", "joint `solreflimit`", "option"], "{name}");
    }
}

#[test]
fn the_zoo_is_described_as_the_readers_of_the_fixtures_say() {
    // Written by `mjcf::write` from tests/export.rs, where its numbers are compared with MuJoCo's.
    let reading = read(&fixture("zoo.xml")).unwrap();
    let robot = &reading.robot;
    assert_eq!(robot.name, "zoo & \"co\"");
    let kinds: Vec<JointKind> = robot.segments.iter().map(|segment| segment.joint.kind).collect();
    assert_eq!(kinds.iter().filter(|kind| **kind == JointKind::Prismatic).count(), 2);
    assert!(kinds.contains(&JointKind::Fixed) && kinds.contains(&JointKind::Floating));
    assert_eq!(robot.colliders.iter().filter(|collider| collider.shape == Shape::Plane).count(), 1);
    assert_eq!((robot.pairs.len(), robot.actuators.len()), (2, 2));
    assert!(robot.segments.iter().any(|segment| segment.joint.range == [f64::NEG_INFINITY, f64::INFINITY]));
}

#[test]
fn urdf_is_read_as_it_was_written() {
    for robot in [scene(), read(&fixture("zoo.xml")).unwrap().robot] {
        let reading = read(&urdf::write(&robot).unwrap()).unwrap();
        // A plane is a block in a URDF, whose middle is elsewhere.
        let mut expected = robot.clone();
        for collider in &mut expected.colliders {
            if collider.shape == Shape::Plane {
                collider.shape = Shape::Box { half: [50.0; 3] };
                collider.placement = collider.placement.compose(&Pose::at([0.0, 0.0, -50.0]));
            }
        }
        same(&expected, &reading.robot, 1e-14);
        for collider in &expected.colliders {
            let read = &reading.robot.colliders[reading.robot.collider(&collider.name).unwrap()];
            assert_eq!(read.shape, collider.shape, "{}", collider.name);
        }
        assert!(reading.robot.pairs.is_empty());
        // Efforts are kept, as motors.
        for actuator in &robot.actuators {
            let limit = match actuator.law {
                Law::MusclePair(pair) => pair.moment_arm * pair.tension,
                Law::Servo(servo) => servo.limit,
                Law::Torque(torque) => torque.limit,
                Law::Held(_) => f64::INFINITY,
            };
            let name = &robot.segments[actuator.joint.index()].joint.name;
            let read = reading.robot.actuator(name).map(|id| &reading.robot.actuators[id.index()]);
            assert_eq!(
                read.map(|read| (read.joint, read.law)),
                (limit > 0.0).then_some((actuator.joint, Law::Torque(Torque { limit })))
            );
        }
        let tree = KinematicTree::new(&robot).unwrap();
        let again = KinematicTree::new(&reading.robot).unwrap();
        let q = tree.zero();
        for (a, b) in tree.poses(&q).iter().zip(again.poses(&q)) {
            assert!((0..3).all(|k| (a.position[k] - b.position[k]).abs() < 1e-12));
        }
    }
}

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

fn message(text: &str) -> String {
    read(text).unwrap_err().to_string()
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
        ("<joint range=\"10 -10\"/>", "text line 5: joint: range is \"10 -10\", but must not end before it begins"),
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
    let Imported { robot, warnings, frames } = read(text).unwrap();
    let knee = &robot.segments[robot.body("knee").unwrap().index()];
    assert_eq!((knee.joint.damping, knee.joint.armature, knee.joint.axis), (2.0, 3.0, [0.0, 1.0, 0.0]));
    assert_eq!(knee.joint.range, [-1.0, 2.0]);
    assert_eq!(knee.mass, 2.0);
    // The segment is at the joint, the body half a metre below it.
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
    assert_eq!(laws[0], Law::Servo(farsa_body::Servo { stiffness: 40.0, damping: 4.0, limit: 6.0 }));
    assert_eq!(laws[1], Law::Torque(Torque { limit: 4.0 }));
    assert_eq!(laws[2], Law::Held(farsa_body::Held { stiffness: 0.0, damping: 5.0 }));
    assert_eq!(laws.len(), 3);
    assert!(
        warnings.iter().any(|note| note.what == "actuator muscle" && note.why.starts_with("left out")),
        "{warnings:?}"
    );
    // Hip and knee do not touch, one carries the other; the hip's bits meet nothing of the floor's but by its affinity.
    let pairs: Vec<[&str; 2]> =
        robot.pairs.iter().map(|p| p.colliders.map(|i| robot.colliders[i].name.as_str())).collect();
    assert_eq!(pairs, [["floor", "geom1"], ["floor", "geom2"]]);
}

#[test]
fn hostile_texts_are_refused_soon() {
    let deep = format!("<mujoco>{}{}</mujoco>", "<body>".repeat(1_000_000), "</body>".repeat(1_000_000));
    assert_eq!(message(&deep), "text line 1: more than 200 elements within each other");
    let many = format!("<mujoco>{}</mujoco>", "<geom/>".repeat(1_000_000));
    assert_eq!(message(&many), "text line 1: more than 100000 elements");
    let wide: String = (0..1_000_000).fold(String::from("<mujoco"), |mut text, i| {
        let _ = write!(text, " a{i}='1'");
        text
    });
    assert_eq!(message(&(wide + "/>")), "text line 1: more than 64 attributes of one element");
    let mut bomb = String::from("<!DOCTYPE robot [<!ENTITY a0 'lol'>");
    for i in 1..12 {
        let _ = write!(bomb, "<!ENTITY a{i} '{}'>", format!("&a{};", i - 1).repeat(10));
    }
    let bomb = bomb + "]>\n<robot name='&a11;'/>";
    assert_eq!(message(&bomb), "text line 1: a document type; models have none, and entities are not read");
    assert!(message("<robot name='&a;'/>").contains("unknown entity"), "{}", message("<robot name='&a;'/>"));
    // Geoms that may all touch each other are more pairs than a description holds.
    let geoms = "<body><freejoint/><geom size='1'/></body>".repeat(1000);
    assert!(
        message(&format!("<mujoco><worldbody>{geoms}</worldbody></mujoco>"))
            .ends_with("more than 65535 pairs of geoms that may touch")
    );
    let world = |body: &str, count| format!("<mujoco><worldbody>{}</worldbody></mujoco>", body.repeat(count));
    let touching = world("<geom size='1'/>", 3000);
    assert!(message(&touching).ends_with("more than 2000 geoms that may touch"), "{}", message(&touching));
    let free = world("<body><freejoint/><geom size='1' contype='0' conaffinity='0'/></body>", 2000);
    assert_eq!(read(&free).unwrap().robot.segments.len(), 2000);
    let free =
        free.replace("</worldbody>", "<geom name='g' size='1'/><body><joint/><geom size='1'/></body></worldbody>");
    assert_eq!(read(&free).unwrap().robot.pairs.len(), 1, "12 001 degrees of freedom");
    let defaults = format!("<mujoco><default>{}</default></mujoco>", "<geom/>".repeat(2000));
    assert_eq!(message(&defaults), "text line 1: more than 1000 defaults");
    let comments = format!("<mujoco>{}</mujoco>", "<!---->".repeat(1_000_000));
    assert_eq!(message(&comments), "text line 1: nodes limit reached");
    for text in
        ["", " ", "<", "<robot", "\u{0}", "<robot name='r'><link/>", "<mujoco><worldbody>", "<mujoco/><mujoco/>"]
    {
        assert!(read(text).is_err(), "{text}");
    }
}

/// A folder of this test's own.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(folder.join("model/meshes")).unwrap();
    folder
}

const TETRAHEDRON: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

#[test]
fn files_outside_are_not_read() {
    let folder = folder("paths");
    let model = folder.join("model/robot.xml");
    fs::write(folder.join("model/meshes/a.obj"), TETRAHEDRON).unwrap();
    fs::write(folder.join("secret.obj"), TETRAHEDRON).unwrap();
    let asset = |file: &str| {
        format!(
            "<mujoco><asset><mesh name=\"m\" file=\"{file}\"/></asset><worldbody><body><joint/><geom type=\"mesh\" mesh=\"m\"/></body></worldbody></mujoco>"
        )
    };
    let attempt = |file: &str, options: &ReadOptions| {
        fs::write(&model, asset(file)).unwrap();
        Imported::from_file(&model, options)
    };
    let strict = ReadOptions::default();
    let reading = attempt("meshes/a.obj", &strict).unwrap();
    assert!((reading.robot.segments[0].mass - 1000.0 / 6.0).abs() < 1e-9);
    assert!(attempt("./meshes/../meshes/a.obj", &strict).is_ok());
    let absolute = folder.join("secret.obj").display().to_string();
    for (file, why) in [
        ("../secret.obj", "leads out of the folder that may be read"),
        ("../nothing.obj", "leads out of the folder that may be read"),
        ("meshes/../../secret.obj", "leads out of the folder that may be read"),
        (absolute.as_str(), "is no path relative to the model's folder"),
        ("meshes/none.obj", "is not there"),
        ("file:///a.obj", "is an address; only files are read"),
        ("package://p/secret.obj", "names a package, and no folder with packages was given"),
    ] {
        let error = attempt(file, &strict).unwrap_err();
        assert!(matches!(&error, ReadError::Path { why: found, .. } if *found == why), "{file}: {error}");
    }
    assert!(matches!(attempt("meshes", &strict), Err(ReadError::File { .. })), "a folder is no file");
    let wider = ReadOptions { root: Some(folder.clone()), ..ReadOptions::default() };
    assert!(attempt("../secret.obj", &wider).is_ok(), "within the root that was given");
    assert!(attempt("../../secret.obj", &wider).is_err());
    let packages = ReadOptions { packages: vec![folder.clone()], ..ReadOptions::default() };
    assert!(attempt("package://model/meshes/a.obj", &packages).is_ok());
    for file in
        ["package://../secret.obj", "package://model/../../a.obj", "package:///secret.obj", "package://none/a.obj"]
    {
        assert!(attempt(file, &packages).is_err(), "{file}");
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(folder.join("secret.obj"), folder.join("model/meshes/link.obj")).unwrap();
        let error = attempt("meshes/link.obj", &strict).unwrap_err();
        assert!(error.to_string().ends_with("leads out of the folder that may be read"), "{error}");
    }
    let small = Limits { bytes: 400, ..Limits::default() };
    fs::write(folder.join("model/meshes/large.obj"), TETRAHEDRON.repeat(100)).unwrap();
    let error = attempt("meshes/large.obj", &ReadOptions { limits: small, ..ReadOptions::default() }).unwrap_err();
    assert!(matches!(error, ReadError::TooMuch { what: "bytes in a file", .. }), "{error}");
    let left = attempt("meshes/none.obj", &ReadOptions { meshes: Meshes::Leave, ..ReadOptions::default() });
    assert!(matches!(left, Err(ReadError::Mass { .. })), "what moves lost its only mass");
}

#[test]
fn included_files_stand_where_they_are_named() {
    let folder = folder("includes");
    let model = folder.join("model/robot.xml");
    let main = "<mujoco><include file='meshes/parts.xml'/><worldbody><body name='a'><include file='leg.xml'/></body></worldbody></mujoco>";
    fs::write(&model, main).unwrap();
    fs::write(
        folder.join("model/meshes/parts.xml"),
        "<mujocoinclude><default><geom size='0.5'/></default></mujocoinclude>",
    )
    .unwrap();
    fs::write(folder.join("model/leg.xml"), "<mujoco><joint name='k'/>\n<geom name='g' density='1'/></mujoco>")
        .unwrap();
    let reading = Imported::from_file(&model, &ReadOptions::default()).unwrap();
    assert_eq!(reading.robot.colliders[0].shape, Shape::Sphere { radius: 0.5 });
    assert!(reading.robot.joint("k").is_some());
    fs::write(folder.join("model/leg.xml"), "<mujoco>\n<include file='leg.xml'/></mujoco>").unwrap();
    let error = Imported::from_file(&model, &ReadOptions::default()).unwrap_err().to_string();
    assert_eq!(error, "leg.xml line 2: a second include of `leg.xml`, the first is in line 1");
    fs::write(folder.join("model/leg.xml"), "<mujoco>\n<join/></mujoco>").unwrap();
    let error = Imported::from_file(&model, &ReadOptions::default()).unwrap_err().to_string();
    assert_eq!(error, "leg.xml line 2: unknown element of body `join`; the nearest is `joint`");
}

/// A model with nearly everything that is read, small enough to be damaged often.
fn sample(urdf: bool) -> String {
    if urdf { fixture("zoo.urdf") } else { fixture("zoo.xml") }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn damaged_models_are_read_or_refused(
        urdf: bool,
        flips in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..6),
        cut in any::<prop::sample::Index>(),
        moved in (any::<prop::sample::Index>(), any::<prop::sample::Index>()),
        change in 0..4,
    ) {
        let text = sample(urdf);
        let mut lines: Vec<&str> = text.lines().collect();
        let (from, to) = (moved.0.index(lines.len()), moved.1.index(lines.len()));
        match change {
            0 => drop(lines.remove(from)),
            1 => lines.insert(to, lines[from]),
            2 => lines.swap(from, to),
            _ => lines.truncate(cut.index(lines.len())),
        }
        let mut bytes = lines.join("\n").into_bytes();
        for (at, byte) in flips {
            let at = at.index(bytes.len().max(1));
            if let Some(to) = bytes.get_mut(at) {
                *to = byte;
            }
        }
        let text = String::from_utf8_lossy(&bytes);
        if let Ok(reading) = read(&text) {
            prop_assert!(reading.robot.validate().is_ok());
        }
    }

    #[test]
    fn wild_numbers_are_read_or_refused(
        urdf: bool,
        at in any::<prop::sample::Index>(),
        value in prop::sample::select(vec!["nan", "inf", "-inf", "1e308", "-1e308", "1e-320", "0", "-1", "1e999", "", "x", "1 2", "99999999999999999999"]),
    ) {
        let text = sample(urdf);
        // Every run of digits in an attribute.
        let numbers: Vec<(usize, usize)> = {
            let bytes = text.as_bytes();
            let part = |b: u8| b.is_ascii_digit() || b == b'.' || b == b'-';
            let starts = (1..bytes.len()).filter(|i| part(bytes[*i]) && (bytes[i - 1] == b'"' || bytes[i - 1] == b' '));
            starts.map(|i| (i, i + bytes[i..].iter().take_while(|b| part(**b)).count())).collect()
        };
        let (from, to) = numbers[at.index(numbers.len())];
        let text = format!("{}{value}{}", &text[..from], &text[to..]);
        if let Ok(reading) = read(&text) {
            prop_assert!(reading.robot.validate().is_ok());
            prop_assert!(mjcf::write(&reading.robot, &MjcfOptions::default()).is_ok());
        }
    }
}
