//! Models as large as the limits allow are read and written in time and memory proportional to them.
//!
//! Operations that once took quadratic time are tested here at a size that would not end, or not fit. No test has a
//! clock.
use std::fmt::Write as _;

use farsa_body::robot::{Robot, Shape};
use farsa_models::mjcf::{self, MjcfOptions};
use farsa_models::{Imported, Limits, ReadOptions, urdf};

use crate::read;

/// The written text has more elements than the first one.
fn read_back(text: &str) -> Robot {
    let limits = Limits { elements: 1_000_000, ..Limits::default() };
    Imported::from_text(text, &ReadOptions { limits, ..ReadOptions::default() }).unwrap().robot
}

/// A URDF of hinges, each link on the one before.
fn chain(count: usize) -> String {
    let mass = "<inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial>";
    let mut text = format!("<robot name='chain'><link name='l0'>{mass}</link>");
    for i in 1..=count {
        let _ = write!(
            text,
            "<link name='l{i}'>{mass}</link><joint name='j{i}' type='continuous'><origin xyz='0 0 0.1'/>\
             <parent link='l{}'/><child link='l{i}'/><limit effort='1'/></joint>",
            i - 1
        );
    }
    text + "</robot>"
}

#[test]
fn many_free_bodies_are_written_and_read_back() {
    let body = "<body><freejoint/><geom size='0.1' contype='0' conaffinity='0'/></body>";
    let robot = read(&format!("<mujoco><worldbody>{}</worldbody></mujoco>", body.repeat(30_000))).unwrap().robot;
    let back = read_back(&mjcf::write(&robot, &MjcfOptions::default()).unwrap());
    assert_eq!(back, robot);
    let back = read_back(&urdf::write(&robot).unwrap());
    assert_eq!((back.segments.len(), back.colliders), (30_000, robot.colliders));
    assert_eq!(back.segments[29_999].joint.name, "body30000_joint");
}

#[test]
fn chains_are_written_and_read_back_whatever_their_length() {
    let robot = read(&chain(2000)).unwrap().robot;
    let text = mjcf::write(&robot, &MjcfOptions::default()).unwrap();
    // Indentation without end made this 16 MB.
    assert!(text.len() < 700 * 2000, "{} bytes", text.len());
    assert_eq!(read(&text).unwrap().robot, robot);
    // As deep as a URDF can be.
    let links = (1..25_000).fold(String::from("<link name='l0'/>"), |mut text, i| {
        let ends = format!("<parent link='l{}'/><child link='l{i}'/>", i - 1);
        let _ = write!(text, "<link name='l{i}'/><joint name='j{i}' type='fixed'>{ends}</joint>");
        text
    });
    let robot = read(&format!("<robot name='deep'>{links}</robot>")).unwrap().robot;
    let back = read(&mjcf::write(&robot, &MjcfOptions::default()).unwrap()).unwrap().robot;
    assert_eq!(back.segments.len(), 25_000);
    assert!(back.segments.iter().zip(&robot.segments).all(|(a, b)| (&a.name, a.parent) == (&b.name, b.parent)));
}

#[test]
fn many_geoms_ask_many_defaults() {
    let wide = "<geom rgba='1 1 1 1' user='1' margin='0' gap='0' fitscale='1' hfield='a' material='m'/>".repeat(990);
    let geoms = "<geom contype='0' conaffinity='0'/>".repeat(60_000);
    let text = format!(
        "<mujoco><default><geom size='0.1'/><geom size='0.2'/>{wide}</default><worldbody>{geoms}</worldbody></mujoco>"
    );
    let robot = read(&text).unwrap().robot;
    assert_eq!(robot.colliders.len(), 60_000);
    assert_eq!(robot.colliders[0].shape, Shape::Sphere { radius: 0.2 }, "the last default of a class holds");
}

#[test]
fn classes_hold_from_the_nearest_on() {
    let text = "<mujoco><default><geom size='1' euler='0 0 90' density='7'/><default class='a'><geom size='2'/>\
        <default class='b'><geom axisangle='0 0 1 180'/></default><default class='c'><geom size='3'/></default></default>\
        <default class='a'><geom size='4'/></default></default><worldbody>\
        <geom class='b'/><geom class='c'/><geom class='a'/><geom/><geom class='b' size='5' quat='1 0 0 0'/></worldbody></mujoco>";
    let robot = read(text).unwrap().robot;
    let radius = |i: usize| match robot.colliders[i].shape {
        Shape::Sphere { radius } => radius,
        _ => f64::NAN,
    };
    assert_eq!([0, 1, 2, 3, 4].map(radius), [4.0, 3.0, 4.0, 1.0, 5.0]);
    // The nearest class decides between several forms of a rotation.
    let turns = [0, 1, 4].map(|i| robot.colliders[i].placement.rotation[2]);
    let expected = [1.0, std::f64::consts::FRAC_1_SQRT_2, 0.0];
    assert!(turns.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15), "{turns:?}");
}

#[test]
fn a_mesh_is_read_once() {
    let points = (0..100_000).fold(String::new(), |mut text, i| {
        let _ = write!(text, "{} {} {} ", i % 7, i % 11, i % 13);
        text
    });
    let geoms = "<geom type='mesh' mesh='m'/>".repeat(1000);
    let asset = format!("<asset><mesh name='m' vertex='{points}' face='0 7 11' inertia='shell'/></asset>");
    let body = format!("<worldbody><body name='b'>{geoms}</body></worldbody>");
    let robot = read(&format!("<mujoco>{asset}{body}</mujoco>")).unwrap().robot;
    assert_eq!(robot.colliders.len(), 1000);
    assert!(
        robot.colliders.iter().all(|one| one.shape == Shape::Box { half: [3.0, 5.0, 6.0] }),
        "{:?}",
        robot.colliders[0]
    );
}
