//! A robot as a model file of MuJoCo.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use farsa_body::Pose;
use farsa_body::actuators::{Held, Law};
use farsa_body::robot::{Actuator, Collider, JointKind, Pair, Robot, RobotError, Segment, Shape, SoftContact, Visual};
use farsa_num::Scalar;

use crate::bounds::{check_sizes, effort_in_file, range_in_file, separated};
use crate::mjcf::inverse_weight::{InverseWeights, inverse_weights};
use crate::mjcf::keyframes::Keyframe;
use crate::mjcf::limits::{STIFF, limit_attributes};
use crate::mjcf::surface::{attributes, solimp, yielding_of_pyramid};
use crate::mjcf::written_inertia::inertial;
use crate::xml::write::{
    GROUND, Lines, colliders_by_body, friction_of_ground, numbers, quoted, segment_names, visuals_by_body,
};

/// Options of a MuJoCo model that a robot description does not contain.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct MjcfOptions {
    /// Time step of MuJoCo [s]. Parameters of contacts depend on it.
    pub time_step: f64,
    /// Vector of gravity [m/s2].
    pub gravity: [f64; 3],
    /// Ratio of the stiffness of friction to that of the normal. Creep is inversely proportional to it.
    pub impedance_ratio: f64,
    /// Named states from which a simulation can start.
    pub keyframes: Vec<Keyframe>,
}

impl Default for MjcfOptions {
    fn default() -> Self {
        Self { time_step: 0.0025, gravity: [0.0, 0.0, -9.81], impedance_ratio: 10.0, keyframes: Vec::new() }
    }
}

/// Least and largest impedance that MuJoCo allows.
const SOFTEST: f64 = 0.0001;
const STIFFEST: f64 = 0.9999;

/// Groups of visuals, and of the colliders that are not drawn because of them.
const VISUAL: &str = " group=\"2\"";
const HIDDEN: &str = " group=\"3\"";

/// Time constants whose squares are numbers [s].
const TIME_CONSTANTS: [f64; 2] = [1e-150, 1e150];

/// Time constant [s] and impedance of a contact that yields by force / `stiffness` at rest, for a step of `h` [s].
///
/// MuJoCo's contact force is `(aref - a) d / ((1 - d) w)` with `aref = -b v - k d x`, `k = 1 / (d tau)^2`: at rest a
/// spring of `1 / (tau^2 (1 - d) w)`, in motion one that also acts like a mass of `d / ((1 - d) w)`. `w` is the sum of
/// the two bodies' inverse weights. The time constant is the shortest that MuJoCo accepts. The impedance then makes the
/// spring ours. Where a time constant so short requests less than 0.5, it is lengthened instead.
fn impedance(stiffness: f64, w: f64, h: f64) -> (f64, f64) {
    let kw = stiffness * w;
    if kw <= 0.0 {
        return (2.0 * h, STIFFEST);
    }
    let tau = (2.0 * h).max(Scalar::sqrt(2.0 / kw)).clamp(TIME_CONSTANTS[0], TIME_CONSTANTS[1]);
    (tau, (1.0 - 1.0 / (tau * tau * kw)).clamp(SOFTEST, STIFFEST))
}

/// Writes a robot as a model in MJCF, the format of MuJoCo.
///
/// Segments, joints, inertias and shapes are exact to the last digit, and only pairs of the description may touch. Some
/// parts are replaced, since MuJoCo does not have them:
/// - muscle pairs and custom laws with a stiffness are `motor`s with the commanded effort, and the caller evaluates the
///   law
/// - position servos are position actuators with a force range, torque motors motors with a control range
/// - a contact point without an inertia has our stiffness at rest, but critical damping, and the mass of heavier
///   bodies, without which MuJoCo's contacts are unstable at steps of this size
/// - friction is elliptic and creeps by force / (2 tau stiffness impedance ratio), and that of soft pairs gets this
///   ratio, too. Only if all pairs with friction are pyramids, these are written
/// - friction on the ground is `frictionloss` of each sliding joint by itself, with a comment in the file
/// - visuals are geoms of group 2, and the colliders behind them geoms of group 3, which MuJoCo does not show
/// - joint stops without a law are MuJoCo's, as stiff as the step allows.
///
/// If a segment is called `world`, a `_` is appended to its name. Note that MuJoCo 4.0.0 refuses planes on segments that
/// move, and chains of more than 496 bodies. They are written nevertheless.
///
/// # Errors
/// Returns the errors of [`Robot::validate`]. You get [`RobotError::Value`] if an option is not finite, or if the step or
/// the ratio is not positive. This also happens for a shape of 1e9 m or more, which no reader would accept.
pub fn write(robot: &Robot, options: &MjcfOptions) -> Result<String, RobotError> {
    check(options)?;
    let InverseWeights { bodies: weights, joints } = inverse_weights(robot)?;
    check_sizes(robot)?;
    let mut out = Lines::default();
    out.open(&format!("mujoco model={}", quoted(&robot.name)));
    let is_pyramid = |pair: &Pair| pair.soft.is_some_and(|soft| soft.is_pyramid);
    let pyramids = robot.pairs.iter().any(is_pyramid)
        && robot.pairs.iter().all(|pair| is_pyramid(pair) || pair.surface.friction == 0.0);
    head(robot, &mut out, options, pyramids);
    out.open("worldbody");
    let nested = nested(robot);
    bodies(robot, &nested, (&joints, options.time_step), &mut out);
    out.close("worldbody");
    out.open("contact");
    for pair in &robot.pairs {
        out.line(&pair_line(robot, pair, &weights, options.time_step, pyramids));
    }
    out.close("contact");
    out.open("actuator");
    for actuator in &robot.actuators {
        out.line(&actuator_line(robot, actuator));
    }
    out.close("actuator");
    if !options.keyframes.is_empty() {
        out.open("keyframe");
        for keyframe in &options.keyframes {
            let state = numbers(&state(robot, &nested, keyframe));
            out.line(&format!("<key name={} qpos=\"{state}\"/>", quoted(&keyframe.name)));
        }
        out.close("keyframe");
    }
    out.close("mujoco");
    Ok(out.text)
}

fn head(robot: &Robot, out: &mut Lines, options: &MjcfOptions, pyramids: bool) {
    let is_custom = |law: &Law<f64>| match law {
        Law::MusclePair(_) => true,
        Law::Held(held) => held.stiffness > 0.0,
        _ => false,
    };
    if robot.actuators.iter().any(|actuator| is_custom(&actuator.law)) {
        out.line(
            "<!-- MuJoCo has no such muscles: the motors of their joints exert the torque that they are told; leave \
             them at 0 and use qfrc_applied, with stiffness and damping in dof_damping, for implicit muscles. -->",
        );
    }
    if !robot.grounds.is_empty() {
        out.line(GROUND);
    }
    out.line("<compiler angle=\"radian\" autolimits=\"false\" inertiafromgeom=\"false\" fusestatic=\"false\"/>");
    let (h, gravity) = (options.time_step, numbers(&options.gravity));
    let (cone, ratio) = if pyramids { ("pyramidal", 1.0) } else { ("elliptic", options.impedance_ratio) };
    out.line(&format!(
        "<option timestep=\"{h:?}\" gravity=\"{gravity}\" integrator=\"implicitfast\" cone=\"{cone}\" \
         impratio=\"{ratio:?}\"/>"
    ));
    // A stop reacts as fast as MuJoCo allows and yields by a hundredth of what a free joint would.
    let stop = format!("solreflimit=\"{:?} 1.0\" solimplimit=\"{STIFF:?} {STIFF:?} 0.001 0.5 2.0\"", 2.0 * h);
    out.open("default");
    out.line(&format!("<joint {stop}/>"));
    out.line("<geom contype=\"0\" conaffinity=\"0\"/>");
    out.close("default");
}

/// The shapes of the world and the bodies with theirs.
fn bodies(robot: &Robot, nested: &[(usize, usize)], (weights, h): (&[f64], f64), out: &mut Lines) {
    let names = segment_names(robot, "world");
    let (colliders, losses) = (colliders_by_body(robot), friction_of_ground(robot));
    let visuals = visuals_by_body(robot);
    geoms(&colliders[0], &visuals[0], out);
    let mut open = 0;
    for &(i, depth) in nested {
        while open > depth {
            out.close("body");
            open -= 1;
        }
        open += 1;
        let segment = &robot.segments[i];
        out.open(&format!("body name={}{}", quoted(&names[i]), placed(&segment.joint.placement)));
        if let Some(joint) = joint(segment, losses[i], [weights[i], h]) {
            out.line(&joint);
        }
        if let Some(inertial) = inertial(segment) {
            out.line(&inertial);
        }
        geoms(&colliders[i + 1], &visuals[i + 1], out);
    }
    for _ in 0..open {
        out.close("body");
    }
}

fn pair_line(robot: &Robot, pair: &Pair, weights: &[f64], h: f64, pyramids: bool) -> String {
    let [a, b] = pair.colliders.map(|i| &robot.colliders[i]);
    let weight = |collider: &Collider| collider.body.map_or(0.0, |body| weights[body.index()]);
    let surface = &pair.surface;
    let w = weight(a) + weight(b);
    let edges =
        if pyramids && surface.friction > 0.0 { yielding_of_pyramid(surface.friction, 3.0, 1.0)[0] } else { 1.0 };
    let numbers_of_pair = |soft: SoftContact| [surface.stiffness, surface.damping, soft.inertia];
    let of_file = pair.soft.and_then(|soft| attributes(numbers_of_pair(soft), w * edges));
    let (solref, d) = of_file.unwrap_or_else(|| {
        let (tau, d) = impedance(surface.stiffness, w, h);
        ([tau, 1.0], d)
    });
    let (dimensions, rolling) = match surface.rolling_friction {
        rolling if rolling > 0.0 => (6, rolling),
        _ if pyramids && surface.friction == 0.0 => (1, 0.0),
        _ => (3, 0.0),
    };
    let friction = numbers(&[surface.friction, surface.friction, rolling, rolling, rolling]);
    let (solref, solimp) = (numbers(&solref), numbers(&solimp(d, pair.soft.and_then(|soft| soft.impedance))));
    let margin = pair.soft.map_or(0.0, |soft| soft.margin);
    let margin = if margin > 0.0 { format!(" margin=\"{margin:?}\"") } else { String::new() };
    format!(
        "<pair geom1={} geom2={} condim=\"{dimensions}\" friction=\"{friction}\" solref=\"{solref}\" \
         solimp=\"{solimp}\"{margin}/>",
        quoted(&a.name),
        quoted(&b.name)
    )
}

fn actuator_line(robot: &Robot, actuator: &Actuator) -> String {
    let joint = &robot.segments[actuator.joint.index()].joint;
    let head = format!("name={} joint={}", quoted(&actuator.name), quoted(&joint.name));
    // MuJoCo's ranges have two ends.
    let commands = actuator.command_range.map_or_else(String::new, |range| {
        format!(" ctrllimited=\"true\" ctrlrange=\"{}\"", numbers(&separated(range_in_file(range))))
    });
    match actuator.law {
        Law::Servo(servo) => format!(
            "<position {head} kp=\"{:?}\" kv=\"{:?}\"{commands}{}/>",
            servo.stiffness,
            servo.damping,
            limited("force", servo.limit)
        ),
        Law::Torque(motor) if actuator.command_range.is_some() => {
            format!("<motor {head}{commands}{}/>", limited("force", motor.limit))
        }
        Law::Torque(motor) => format!("<motor {head}{}/>", limited("ctrl", motor.limit)),
        Law::Velocity(motor) => {
            format!("<velocity {head} kv=\"{:?}\"{commands}{}/>", motor.gain, limited("force", motor.limit))
        }
        Law::Held(Held { stiffness: 0.0, damping }) => {
            let bias = numbers(&[0.0, 0.0, -damping]);
            format!("<general {head} gainprm=\"1.0\" biastype=\"affine\" biasprm=\"{bias}\"{commands}/>")
        }
        Law::MusclePair(_) | Law::Held(_) => format!("<motor {head}/>"),
    }
}

/// MuJoCo's `qpos`: the joints in the order in which the bodies are nested.
fn state(robot: &Robot, nested: &[(usize, usize)], keyframe: &Keyframe) -> Vec<f64> {
    let mut joints = vec![0.0; robot.segments.len()];
    for (joint, q) in robot.joints().zip(&keyframe.joints) {
        joints[joint.index()] = *q;
    }
    // The first of two poses of a body counts.
    let given: BTreeMap<usize, Pose<f64>> =
        keyframe.bodies.iter().rev().map(|(body, at)| (body.index(), *at)).collect();
    let mut state = Vec::new();
    for &(i, _) in nested {
        let joint = &robot.segments[i].joint;
        match joint.kind {
            JointKind::Revolute | JointKind::Prismatic => state.push(joints[i]),
            JointKind::Fixed => {}
            JointKind::Floating => {
                let Pose { position, rotation: [x, y, z, w] } = given.get(&i).copied().unwrap_or(joint.placement);
                state.extend(position.into_iter().chain([w, x, y, z]));
            }
        }
    }
    state
}

/// Gets the segments with how deep they are nested, in depth-first order, in which MuJoCo counts bodies.
fn nested(robot: &Robot) -> Vec<(usize, usize)> {
    // The children of the world and of each segment in reverse, because the top of the stack comes next.
    let mut children = vec![Vec::new(); robot.segments.len() + 1];
    for (i, segment) in robot.segments.iter().enumerate().rev() {
        children[segment.parent.map_or(0, |parent| parent.index() + 1)].push(i);
    }
    let mut order = Vec::with_capacity(robot.segments.len());
    let mut open: Vec<(usize, usize)> = children[0].iter().map(|i| (*i, 0)).collect();
    while let Some((i, depth)) = open.pop() {
        order.push((i, depth));
        open.extend(children[i + 1].iter().map(|child| (*child, depth + 1)));
    }
    order
}

fn check(options: &MjcfOptions) -> Result<(), RobotError> {
    let wrong = |field, value| RobotError::Value { part: "MJCF".into(), field, value };
    for (field, value) in [("time step", options.time_step), ("impedance ratio", options.impedance_ratio)] {
        if !(value > 0.0 && value.is_finite()) {
            return Err(wrong(field, value));
        }
    }
    let states = options.keyframes.iter().flat_map(|keyframe| &keyframe.joints);
    match options.gravity.iter().chain(states).find(|x| !x.is_finite()) {
        Some(value) => Err(wrong("gravity or keyframe", *value)),
        None => Ok(()),
    }
}

/// Formats the attributes of a limit, none for an infinite one.
fn limited(what: &str, limit: f64) -> String {
    if limit.is_infinite() {
        return String::new();
    }
    let limit = effort_in_file(limit);
    format!(" {what}limited=\"true\" {what}range=\"{}\"", numbers(&[-limit, limit]))
}

/// Formats the attributes of a place, none for the identity.
fn placed(pose: &Pose<f64>) -> String {
    let mut text = String::new();
    // Writing into a string cannot fail.
    if pose.position != [0.0; 3] {
        let _ = write!(text, " pos=\"{}\"", numbers(&pose.position));
    }
    if pose.rotation != Pose::identity().rotation {
        let [x, y, z, w] = pose.rotation;
        let _ = write!(text, " quat=\"{}\"", numbers(&[w, x, y, z]));
    }
    text
}

/// A joint with this inverse weight in a file for this step, if the segment has one, with what friction takes from it.
fn joint(segment: &Segment, loss: f64, [weight, h]: [f64; 2]) -> Option<String> {
    let joint = &segment.joint;
    let name = if joint.name.is_empty() { String::new() } else { format!(" name={}", quoted(&joint.name)) };
    let kind = match joint.kind {
        JointKind::Fixed => return None,
        JointKind::Floating => return Some(format!("<freejoint{name}/>")),
        JointKind::Revolute => "hinge",
        JointKind::Prismatic => "slide",
    };
    let range = if joint.range.iter().all(|end| end.is_infinite()) {
        " limited=\"false\"".into()
    } else {
        // MuJoCo's limits have two ends.
        format!(" limited=\"true\" range=\"{}\"", numbers(&separated(range_in_file(joint.range))))
    };
    let (axis, armature, damping) = (numbers(&joint.axis), joint.armature, joint.damping);
    let spring = if joint.stiffness > 0.0 {
        format!(" stiffness=\"{:?}\" springref=\"{:?}\"", joint.stiffness, joint.rest)
    } else {
        String::new()
    };
    let stop = joint.stop.map_or_else(String::new, |stop| limit_attributes(stop, weight, h));
    let loss = loss + joint.friction;
    let loss = if loss > 0.0 { format!(" frictionloss=\"{loss:?}\"") } else { String::new() };
    Some(format!(
        "<joint{name} type=\"{kind}\" axis=\"{axis}\"{range} armature=\"{armature:?}\" damping=\"{damping:?}\"{spring}{stop}{loss}/>"
    ))
}

/// The shapes of a body.
fn geoms(colliders: &[&Collider], visuals: &[&Visual], out: &mut Lines) {
    for collider in colliders {
        let hidden = !visuals.is_empty() && collider.body.is_some();
        let group = if hidden { HIDDEN } else { "" };
        out.line(&geom(&Visual::from(*collider), &format!(" name={}", quoted(&collider.name)), group));
    }
    for visual in visuals {
        out.line(&geom(visual, "", VISUAL));
    }
}

/// Type and sizes of a shape.
pub(super) fn kind_and_sizes(shape: &Shape) -> (&'static str, Vec<f64>) {
    match *shape {
        Shape::Sphere { radius } => ("sphere", vec![radius]),
        Shape::Capsule { radius, half_length } => ("capsule", vec![radius, half_length]),
        Shape::Cylinder { radius, half_length } => ("cylinder", vec![radius, half_length]),
        Shape::Box { half } => ("box", half.to_vec()),
        // Infinite. The third number is the distance of the lines drawn on it.
        Shape::Plane => ("plane", vec![0.0, 0.0, 1.0]),
    }
}

/// A geom of a shape, with the attributes of its name and group.
fn geom(shape: &Visual, name: &str, group: &str) -> String {
    let (kind, size) = kind_and_sizes(&shape.shape);
    let at = placed(&shape.placement);
    let color = shape.color.map_or_else(String::new, |color| format!(" rgba=\"{} 1.0\"", numbers(&color)));
    format!("<geom{name} type=\"{kind}\" size=\"{}\"{at}{group}{color}/>", numbers(&size))
}

#[cfg(test)]
mod tests {
    use super::*;
    use farsa_body::robots::ArmAndHand;

    #[test]
    fn contacts_yield_as_ours_at_rest() {
        for (stiffness, w, h) in [(2e5, 22.0, 0.01), (2e5, 0.3, 0.0025), (100.0, 1.0, 1e-4)] {
            let (tau, d) = impedance(stiffness, w, h);
            assert!(tau >= 2.0 * h && (0.5..=STIFFEST).contains(&d), "{tau} {d}");
            let spring = 1.0 / (tau * tau * (1.0 - d) * w);
            assert!((spring / stiffness - 1.0).abs() < 1e-9, "{spring} instead of {stiffness}");
        }
        assert_eq!(impedance(1e9, 100.0, 0.01).1, STIFFEST);
        assert_eq!(impedance(1e5, 0.0, 0.01), (0.02, STIFFEST));
    }

    #[test]
    fn colours_and_friction_on_the_ground_are_written() {
        let text = write(&crate::xml::write::ball_on_the_ground(), &MjcfOptions::default()).expect("a valid robot");
        assert_eq!(text.matches("<!-- Friction on the ground").count(), 1);
        assert_eq!(text.matches(" rgba=\"1.0 0.5 0.0 1.0\"/>").count(), 1, "{text}");
        assert_eq!(
            (text.matches("frictionloss=\"1.5\"").count(), text.matches("frictionloss=\"0.03\"").count()),
            (2, 1)
        );
        let read = crate::Imported::from_text(&text, &crate::ReadOptions::default()).expect("a valid file");
        let friction = read.robot.segments.iter().map(|segment| segment.joint.friction);
        assert_eq!(friction.collect::<Vec<_>>(), [1.5, 1.5, 0.03]);
    }

    #[test]
    fn impossible_options_are_refused() {
        let robot = ArmAndHand::default().robot().expect("a valid robot");
        let refused = |options: MjcfOptions| assert!(write(&robot, &options).is_err(), "{options:?}");
        refused(MjcfOptions { time_step: 0.0, ..MjcfOptions::default() });
        refused(MjcfOptions { impedance_ratio: f64::NAN, ..MjcfOptions::default() });
        refused(MjcfOptions { gravity: [f64::INFINITY, 0.0, 0.0], ..MjcfOptions::default() });
        assert!(write(&robot, &MjcfOptions::default()).is_ok());
    }
}
