//! A robot as a URDF file.

use std::collections::BTreeSet;

use farsa_body::Pose;
use farsa_body::actuators::Law;
use farsa_body::robot::{Collider, Joint, JointKind, Robot, RobotError, Segment, Shape, Visual};
use farsa_num::{atan2, sin_cos};

use crate::bounds::{ENDLESS, check_sizes, range_in_file};
use crate::vector::norm;
use crate::xml::write::{
    GROUND, Lines, colliders_by_body, friction_of_ground, has_inertial, numbers, quoted, segment_names, unused,
    visuals_by_body,
};

/// Name of the link that represents the world.
const WORLD: &str = "world";

/// URDF requires a largest speed. Joints without one have this [rad/s or m/s].
pub(super) const MAX_SPEED: f64 = 1000.0;

/// Half the edge length of the block that represents a plane [m].
const PLANE: f64 = 50.0;

/// Writes a robot as a URDF file with links, inertias, joints and collision shapes.
///
/// All links belong to the root link `world`. If a segment already has this name, a `_` is appended to it. Floating
/// segments use a joint of type `floating`, which some readers reject. A capsule is written as a cylinder with a
/// sphere at either end, and a plane as a block of 100 m. If a joint has no name, it gets the name of its segment.
///
/// Links keep their visuals. If colliders have colors, and a link has no visuals, they are written as visuals as
/// well. Since URDF has no friction on the ground, it becomes friction of each sliding joint by itself. A comment in
/// the file mentions this.
///
/// Note that armatures, springs, pairs and surfaces are lost. Actuators only keep their largest effort, which for a
/// muscle pair is moment arm times largest active tension. URDF also requires a maximum speed, which is always 1000.
///
/// # Errors
/// Returns the errors of [`Robot::validate`], and [`RobotError::Value`] for a shape of 1e9 m or more. No reader would
/// accept such a shape.
pub fn write(robot: &Robot) -> Result<String, RobotError> {
    robot.validate()?;
    check_sizes(robot)?;
    let mut out = Lines::default();
    out.line("<?xml version=\"1.0\"?>");
    out.open(&format!("robot name={}", quoted(&robot.name)));
    let names = segment_names(robot, WORLD);
    let (colliders, visuals) = (colliders_by_body(robot), visuals_by_body(robot));
    if !robot.grounds.is_empty() {
        out.line(GROUND);
    }
    let shown = robot.colliders.iter().any(|collider| collider.color.is_some());
    link(&mut out, WORLD, None, (&colliders[0], &visuals[0]), shown);
    for (i, name) in names.iter().enumerate() {
        link(&mut out, name, Some(&robot.segments[i]), (&colliders[i + 1], &visuals[i + 1]), shown);
    }
    let joints = joint_names(robot, &names);
    let (efforts, losses) = (efforts(robot), friction_of_ground(robot));
    for (i, segment) in robot.segments.iter().enumerate() {
        let parent = segment.parent.map_or(WORLD, |parent| names[parent.index()].as_str());
        joint(
            &mut out,
            &segment.joint,
            [&joints[i], parent, &names[i]],
            [efforts[i], losses[i] + segment.joint.friction],
        );
    }
    out.close("robot");
    Ok(out.text)
}

/// A link with its mass, its colliders, which are `shown` or not where it has no visuals, and those. The world's
/// without segment.
fn link(
    out: &mut Lines,
    name: &str,
    segment: Option<&Segment>,
    (colliders, visuals): (&[&Collider], &[&Visual]),
    shown: bool,
) {
    out.open(&format!("link name={}", quoted(name)));
    if let Some(Segment { mass, centre, inertia: [xx, yy, zz, xy, xz, yz], .. }) =
        segment.filter(|segment| has_inertial(segment))
    {
        out.open("inertial");
        out.line(&format!("<origin xyz=\"{}\" rpy=\"0.0 0.0 0.0\"/>", numbers(centre)));
        out.line(&format!("<mass value=\"{mass:?}\"/>"));
        let upper = [("ixx", xx), ("ixy", xy), ("ixz", xz), ("iyy", yy), ("iyz", yz), ("izz", zz)];
        let upper: Vec<String> = upper.iter().map(|(name, x)| format!("{name}=\"{}\"", numbers(&[**x]))).collect();
        out.line(&format!("<inertia {}/>", upper.join(" ")));
        out.close("inertial");
    }
    for visual in visuals {
        shapes(out, visual, None, "visual");
    }
    for collider in colliders {
        if shown && visuals.is_empty() {
            shapes(out, &Visual::from(*collider), Some(&collider.name), "visual");
        }
        shapes(out, &Visual::from(*collider), Some(&collider.name), "collision");
    }
    out.close("link");
}

/// Gets the joints' names, the nameless ones' made of their segments'.
fn joint_names(robot: &Robot, segments: &[String]) -> Vec<String> {
    let taken: BTreeSet<&str> = robot.segments.iter().map(|segment| segment.joint.name.as_str()).collect();
    // Made names differ from each other as their segments' do.
    let name = |(own, segment): (&str, &String)| {
        if own.is_empty() { unused(&format!("{segment}_joint"), &taken) } else { own.to_owned() }
    };
    robot.segments.iter().map(|segment| segment.joint.name.as_str()).zip(segments).map(name).collect()
}

/// A joint with its name and those of its parent and child, its largest effort and its friction.
fn joint(out: &mut Lines, joint: &Joint, [name, parent, child]: [&str; 3], [effort, friction]: [f64; 2]) {
    let endless = joint.range.iter().all(|end| end.is_infinite());
    let kind = match joint.kind {
        JointKind::Revolute if endless => "continuous",
        JointKind::Revolute => "revolute",
        JointKind::Prismatic => "prismatic",
        JointKind::Fixed => "fixed",
        JointKind::Floating => "floating",
    };
    out.open(&format!("joint name={} type=\"{kind}\"", quoted(name)));
    out.line(&origin(&joint.placement));
    out.line(&format!("<parent link={}/>", quoted(parent)));
    out.line(&format!("<child link={}/>", quoted(child)));
    if joint.kind.is_single() {
        let length = norm(&joint.axis);
        out.line(&format!("<axis xyz=\"{}\"/>", numbers(&joint.axis.map(|x| x / length))));
        let range = if kind == "continuous" {
            String::new()
        } else {
            let [low, high] = range_in_file(joint.range);
            format!("lower=\"{:?}\" upper=\"{:?}\" ", low + 0.0, high + 0.0)
        };
        let speed = joint.speed_limit.unwrap_or(MAX_SPEED);
        out.line(&format!("<limit {range}effort=\"{effort:?}\" velocity=\"{speed:?}\"/>"));
        out.line(&format!("<dynamics damping=\"{:?}\" friction=\"{friction:?}\"/>", joint.damping));
    }
    out.close("joint");
}

/// Computes the sum of what the actuators of each segment's joint may exert.
fn efforts(robot: &Robot) -> Vec<f64> {
    let mut efforts = vec![0.0; robot.segments.len()];
    for actuator in &robot.actuators {
        efforts[actuator.joint.index()] += match actuator.law {
            Law::MusclePair(pair) => pair.moment_arm * pair.tension,
            Law::Servo(servo) => servo.limit,
            Law::Torque(motor) => motor.limit,
            Law::Velocity(motor) => motor.limit,
            Law::Held(_) => ENDLESS,
        };
    }
    efforts.into_iter().map(|sum: f64| sum.min(ENDLESS)).collect()
}

/// The elements of one shape, of kind `collision` or `visual`, with a name or without.
pub(super) fn shapes(out: &mut Lines, shape: &Visual, name: Option<&str>, kind: &str) {
    let mut element = |end: &str, along: f64, geometry: &str| {
        let placement = shape.placement.compose(&Pose::at([0.0, 0.0, along]));
        let name = name.map_or_else(String::new, |name| format!(" name={}", quoted(&format!("{name}{end}"))));
        out.open(&format!("{kind}{name}"));
        out.line(&origin(&placement));
        out.line(&format!("<geometry>{geometry}</geometry>"));
        if let Some(color) = shape.color.filter(|_| kind == "visual") {
            let rgba = numbers(&color);
            out.line(&format!("<material name={}><color rgba=\"{rgba} 1.0\"/></material>", quoted(&rgba)));
        }
        out.close(kind);
    };
    let ball = |radius: f64| format!("<sphere radius=\"{radius:?}\"/>");
    let tube = |radius: f64, half: f64| format!("<cylinder radius=\"{radius:?}\" length=\"{:?}\"/>", 2.0 * half);
    let block = |half: [f64; 3]| format!("<box size=\"{}\"/>", numbers(&half.map(|x| 2.0 * x)));
    match shape.shape {
        Shape::Sphere { radius } => element("", 0.0, &ball(radius)),
        Shape::Box { half } => element("", 0.0, &block(half)),
        Shape::Plane => element("", -PLANE, &block([PLANE; 3])),
        Shape::Cylinder { radius, half_length } => element("", 0.0, &tube(radius, half_length)),
        Shape::Capsule { radius, half_length } => {
            element("", 0.0, &tube(radius, half_length));
            element("_start", -half_length, &ball(radius));
            element("_end", half_length, &ball(radius));
        }
    }
}

fn origin(pose: &Pose<f64>) -> String {
    format!("<origin xyz=\"{}\" rpy=\"{}\"/>", numbers(&pose.position), numbers(&roll_pitch_yaw(pose)))
}

/// Computes the angles about the fixed axes x, then y, then z that make a pose's rotation [rad].
///
/// Yaw is measured after roll is undone: where the pitch is upright roll and yaw are one turn, and whatever was found for
/// roll, their composition stays right.
fn roll_pitch_yaw(pose: &Pose<f64>) -> [f64; 3] {
    let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| pose.rotate(axis));
    let roll = atan2(y[2], z[2]);
    let pitch = atan2(-x[2], norm(&[y[2], z[2]]));
    let (s, c) = sin_cos(roll);
    let yaw = atan2(s * z[0] - c * y[0], c * y[1] - s * z[1]);
    [roll, pitch, yaw]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_compose_to_the_rotation() {
        let h = std::f64::consts::FRAC_1_SQRT_2;
        let upright = [[0.0, h, 0.0, h], [0.0, -h, 0.0, h], [0.5, 0.5, 0.5, 0.5], [0.5, -0.5, -0.5, 0.5]];
        let near = [[1e-9, h, 0.0, h], [0.3, 0.4, -0.3, 0.4 + 1e-8]];
        let other = [[0.0, 0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 0.0], [0.1, -0.7, 0.3, 0.2], [-0.3, 0.1, 0.9, -0.4]];
        for q in upright.into_iter().chain(near).chain(other) {
            let rotation = q.map(|x| x / norm(&q));
            let pose = Pose { rotation, ..Pose::identity() };
            let [roll, pitch, yaw] = roll_pitch_yaw(&pose);
            let about = |axis: usize, angle: f64| {
                let (s, c) = sin_cos(angle / 2.0);
                let mut rotation = [0.0, 0.0, 0.0, c];
                rotation[axis] = s;
                Pose { rotation, ..Pose::identity() }
            };
            let made = about(2, yaw).compose(&about(1, pitch)).compose(&about(0, roll));
            for v in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
                let (a, b) = (made.rotate(v), pose.rotate(v));
                assert!((0..3).all(|k| (a[k] - b[k]).abs() < 1e-15), "{q:?}: {a:?} {b:?}");
            }
        }
    }

    #[test]
    fn colours_and_friction_on_the_ground_are_written() {
        let text = write(&crate::xml::write::ball_on_the_ground()).expect("a valid robot");
        assert_eq!(text.matches("<!-- Friction on the ground").count(), 1);
        let piece = "<material name=\"1.0 0.5 0.0\"><color rgba=\"1.0 0.5 0.0 1.0\"/></material>";
        assert_eq!((text.matches("<visual ").count(), text.matches(piece).count()), (2, 1), "{text}");
        assert_eq!((text.matches("friction=\"1.5\"").count(), text.matches("friction=\"0.03\"").count()), (2, 1));
        let read = crate::Imported::from_text(&text, &crate::ReadOptions::default()).expect("a valid file");
        let friction = read.robot.segments.iter().map(|segment| segment.joint.friction);
        assert_eq!(friction.collect::<Vec<_>>(), [1.5, 1.5, 0.03]);
    }

    #[test]
    fn names_are_unique() {
        use farsa_body::robot::{Joint, MassProperties};
        let mut robot = Robot::new("two");
        let ball = MassProperties::sphere(1.0, 0.1);
        let first =
            Joint::revolute("world_joint", [0.0, 0.0, 2.0], Pose::identity(), [f64::NEG_INFINITY, f64::INFINITY]);
        robot.add_segment(Segment::new("arm", None, first, ball));
        robot.add_segment(Segment::new("world", None, Joint::fixed(Pose::identity()), ball));
        let text = write(&robot).expect("a valid robot");
        assert!(
            text.contains("<link name=\"world_\">") && text.contains("<joint name=\"world__joint\" type=\"fixed\">")
        );
        assert!(text.contains("type=\"continuous\"") && text.contains("<axis xyz=\"0.0 0.0 1.0\"/>"), "{text}");
        assert!(!text.contains("lower"));
    }
}
