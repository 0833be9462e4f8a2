//! Visuals of URDF files, and geoms of MJCF files that touch nothing.

use farsa_body::Pose;
use farsa_body::robot::{Shape, Visual};
use farsa_models::mjcf::{self, MjcfOptions};
use farsa_models::urdf;

use crate::read;

/// A link with a collision shape and these visuals.
fn link(visuals: &str) -> String {
    format!(
        "<robot name='r'><material name='sky'><color rgba='0.2 0.4 0.8 0.5'/></material><link name='base'>\
         <collision><geometry><box size='2 2 2'/></geometry></collision>{visuals}</link></robot>"
    )
}

#[test]
fn visuals_have_their_own_colours_or_those_of_materials() {
    let text = link(
        "<visual><origin xyz='1 0 0'/><geometry><sphere radius='0.5'/></geometry>\
         <material name='mine'><color rgba='1 0.5 0 1'/></material></visual>\
         <visual><geometry><capsule radius='0.1' length='2'/></geometry><material name='sky'/></visual>\
         <visual><geometry><box size='1 2 3'/></geometry></visual>",
    );
    let found = read(&text).unwrap();
    let body = found.robot.body("base");
    let expected = [
        Visual::new(body, Shape::Sphere { radius: 0.5 }, Pose::at([1.0, 0.0, 0.0])).with_color([1.0, 0.5, 0.0]),
        Visual::new(body, Shape::Capsule { radius: 0.1, half_length: 1.0 }, Pose::identity())
            .with_color([0.2, 0.4, 0.8]),
        Visual::new(body, Shape::Box { half: [0.5, 1.0, 1.5] }, Pose::identity()),
    ];
    assert_eq!(found.robot.visuals, expected);
    assert_eq!((found.robot.colliders.len(), found.warnings), (1, Vec::new()));
    let again = read(&urdf::write(&found.robot).unwrap()).unwrap().robot;
    assert_eq!(again.visuals, expected);
    let again = read(&mjcf::write(&found.robot, &MjcfOptions::default()).unwrap()).unwrap().robot;
    assert_eq!((again.visuals.as_slice(), again.colliders), (&expected[..], found.robot.colliders));
}

#[test]
fn a_link_with_a_visual_that_cannot_be_read_looks_like_its_colliders() {
    let ball = "<visual><geometry><sphere radius='0.5'/></geometry></visual>";
    for (other, why) in [
        ("<geometry><mesh filename='none.stl'/></geometry>", "with a mesh"),
        ("<geometry><box size='1 1 0'/></geometry>", "must be positive"),
        ("", "no geometry"),
    ] {
        let found = read(&link(&format!("{ball}<visual>{other}</visual>"))).unwrap();
        assert!(found.robot.visuals.is_empty(), "{other}");
        let [warning] = found.warnings.as_slice() else { panic!("{:?}", found.warnings) };
        assert!(warning.what == "visual" && warning.why.contains(why), "{warning}");
    }
}

#[test]
fn geoms_of_the_groups_for_show_are_drawn_and_no_colliders() {
    let text = "<mujoco><default><default class='visual'><geom contype='0' conaffinity='0' group='2'/></default></default>\
         <worldbody><body name='b'><joint name='j'/><inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/>\
         <geom class='visual' size='0.5' rgba='1 0 0 1'/><geom name='paired' class='visual' size='0.1'/>\
         <geom name='probe' contype='0' conaffinity='0' size='0.2' rgba='0 1 0 1'/><geom name='hull' group='2' size='0.4'/>\
         </body><geom name='floor' type='plane' size='1 1 1'/></worldbody>\
         <contact><pair geom1='paired' geom2='floor'/></contact></mujoco>";
    let found = read(text).unwrap();
    let ball = Visual::new(found.robot.body("b"), Shape::Sphere { radius: 0.5 }, Pose::identity());
    assert_eq!(found.robot.visuals, [ball.with_color([1.0, 0.0, 0.0])]);
    let names: Vec<&str> = found.robot.colliders.iter().map(|collider| collider.name.as_str()).collect();
    assert_eq!(names, ["floor", "paired", "probe", "hull"]);
    let lost: Vec<&str> = found.warnings.iter().map(|warning| warning.what.as_str()).collect();
    assert_eq!(lost, ["contype, conaffinity", "geom `rgba`"]);
}
