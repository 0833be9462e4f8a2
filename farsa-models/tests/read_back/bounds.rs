//! Bounds of a file's masses. The expected numbers are those of MuJoCo 4.0.0.

use farsa_body::robot::MassProperties;
use farsa_models::{Imported, ReadOptions};
use farsa_physics::articulated::{Model, Options, Scratch, inverse_dynamics, mass_matrix};

use crate::read;

fn model(bounds: &str, bodies: &str) -> Imported {
    let text = format!(
        "<mujoco><compiler {bounds}/><worldbody><body name='arm'><joint name='hinge' axis='0 1 0'/>\
         <geom size='0.1'/>{bodies}</body></worldbody></mujoco>"
    );
    read(&text).unwrap_or_else(|error| panic!("{error}"))
}

/// The mass matrix of a hinge, and its effort at rest.
fn hinge(imported: &Imported) -> [f64; 2] {
    let model = Model::<f64>::new(&imported.robot, &Options::default()).unwrap();
    let mut scratch = Scratch::new((), &model);
    let (mut matrix, mut effort) = ([0.0], [0.0]);
    scratch.forward_kinematics((), &model, &[0.0; 2]);
    mass_matrix((), model.links(), scratch.links(), &mut matrix);
    inverse_dynamics((), model.links(), model.gravity(), &[0.0], scratch.links(), &mut effort);
    [matrix[0], effort[0]]
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-9
}

#[test]
fn a_file_bounds_every_body_also_fixed_ones() {
    let bodies = "<body name='empty' pos='1 0 0.5' euler='30 0 0'/>\
        <body name='weightless' pos='0 0 2'><geom size='0.1' pos='0.3 0 0' mass='0'/></body>\
        <body name='small' pos='0 0 1'><geom size='0.01' pos='0.2 0 0'/></body>";
    let bounded = model("boundmass='0.5' boundinertia='0.25'", bodies);
    let segments = &bounded.robot.segments;
    assert!(segments[1..].iter().all(|segment| segment.mass == 0.5), "{segments:?}");
    assert!(segments.iter().all(|segment| close(segment.inertia[0], 0.25)), "{segments:?}");
    // A body without mass has its place in its parent as its center.
    assert_eq!([1, 2, 3].map(|k| segments[k].centre), [[1.0, 0.0, 0.5], [0.0, 0.0, 2.0], [0.2, 0.0, 0.0]]);
    let [inertia, effort] = hinge(&bounded);
    assert!(close(inertia, 11.955_256_350_946) && close(effort, -10.791), "{inertia} {effort}");
    assert!(bounded.warnings.iter().any(|note| note.what == "mass or inertia" && note.count == 4));
}

#[test]
fn a_bound_of_moments_alone_and_the_balance_reach_fixed_bodies() {
    let fixed = "<body name='fixed' pos='0 0 1'><inertial mass='1' pos='0.1 0 0' diaginertia='1 0.1 0.3'/></body>";
    let balanced = model("boundmass='0.5' boundinertia='0.25' balanceinertia='true'", fixed);
    assert!(close(balanced.robot.segments[1].inertia[1], 1.55 / 3.0));
    let [inertia, effort] = hinge(&balanced);
    assert!(close(inertia, 1.776_666_666_667) && close(effort, -0.981), "{inertia} {effort}");
    let turning = model("boundinertia='0.25'", "<body name='empty' pos='0 0 1'/>");
    assert!(close(hinge(&turning)[0], 0.5));
}

#[test]
fn segments_between_joints_keep_their_share() {
    let text = "<mujoco><compiler boundmass='0.5' boundinertia='0.25'/><worldbody><body name='arm'>\
        <joint name='slide' type='slide' axis='1 0 0'/><joint name='hinge' axis='0 1 0'/>\
        <geom size='0.1' pos='0.1 0 0'/></body></worldbody></mujoco>";
    let robot = Imported::from_text(text, &ReadOptions::default()).unwrap().robot;
    let both = robot.segments.iter().map(farsa_body::robot::Segment::mass_properties);
    let MassProperties { mass, inertia, .. } = both.reduce(|sum, part| sum.with(&part)).unwrap();
    assert!(close(mass, 4.188_790_204_786) && close(inertia[1], 0.25), "{mass} {inertia:?}");
}
