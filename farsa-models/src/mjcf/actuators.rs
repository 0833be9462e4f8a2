//! Actuators of an MJCF file.

use farsa_body::actuators::{Held, Law, Servo, Torque, Velocity};
use farsa_body::ports::JointId;
use farsa_body::robot::Robot;

use crate::bounds::{effort_from_file, joined, range_from_file};
use crate::context::Context;
use crate::error::ReadError;
use crate::mjcf::bodies::Bodies;
use crate::mjcf::classes::{ACTUATORS, Classed, Classes};
use crate::mjcf::compiler::Compiler;
use crate::mjcf::gains::{ClassGains, Gains};
use crate::mjcf::names::Names;
use crate::warnings::Warnings;
use crate::xml::tree::Element;

/// A law and the range of its commands.
type Commanded = (Law<f64>, Option<[f64; 2]>);

/// Kinds of actuators that can be described.
const KINDS: [&str; 4] = ["general", "motor", "position", "velocity"];

/// Adds the actuators on joints whose law a description has. The others are noted.
pub(crate) fn actuators<'t>(
    model: Element<'t>,
    robot: &mut Robot,
    compiler: &Compiler,
    classes: &Classes<'t>,
    bodies: &Bodies<'t, '_>,
    context: &mut Context<'_>,
) -> Result<(), ReadError> {
    for element in classes.elements().filter(|element| ACTUATORS.contains(&element.tag())) {
        check(element, &mut context.warnings)?;
    }
    let sections: Vec<_> = model.all("actuator").collect();
    let mut names = Names::default();
    for element in sections.iter().flat_map(Element::children) {
        names.declare("actuator", element)?;
    }
    let gains = ClassGains::new(classes)?;
    let mut number = 0;
    for section in sections {
        section.check(&[], &[], &mut context.warnings)?;
        section.check_children(&ACTUATORS, &[("plugin", "plugins are MuJoCo's")], &mut context.warnings)?;
        for element in section.children().filter(|child| ACTUATORS.contains(&child.tag())) {
            check(element, &mut context.warnings)?;
            let index = number;
            number += 1;
            let classed = classes.with(element, classes.main())?;
            let law = match joint_of(&classed, bodies)? {
                Err(why) => Err(why),
                Ok(id) => {
                    let joint_range = robot.segments[id.index()].joint.range;
                    let law = law(&classed, gains.of(&classed)?, joint_range, compiler, &mut context.warnings)?;
                    law.map(|law| (id, law))
                }
            };
            match law {
                Ok(_) if !acts(&classed, compiler)? => {
                    let why = "left out: the model's `option` disables it";
                    context.warnings.add(element.place(), format!("actuator {}", element.tag()), why);
                    element.leave();
                }
                Ok((id, (law, command_range))) => {
                    let name = element.attribute("name").filter(|name| !name.is_empty()).map(String::from);
                    let name = name.unwrap_or_else(|| names.generate("actuator", format!("actuator{index}")));
                    let added = robot.add_actuator(&name, id, law);
                    robot.actuators[added.index()].command_range = command_range;
                }
                Err(why) => {
                    context.warnings.add(element.place(), format!("actuator {}", element.tag()), why);
                    element.leave();
                }
            }
        }
    }
    limit_joints(robot, bodies, &mut context.warnings);
    Ok(())
}

/// Finds the joint of an actuator, or the reason why it has none.
fn joint_of(classed: &Classed<'_, '_>, bodies: &Bodies<'_, '_>) -> Result<Result<JointId, &'static str>, ReadError> {
    let element = classed.element;
    let Some(joint) = element.attribute("joint").or_else(|| element.attribute("jointinparent")) else {
        return Ok(Err("left out: it acts on no joint, but by a tendon, a site or a body"));
    };
    match bodies.joints.get(joint) {
        Some(id) => Ok(Ok(*id)),
        None if bodies.names.has("joint", joint) => Ok(Err("left out: it acts on a free joint")),
        None => Err(element.unknown("joint", joint, bodies.joints.keys().map(String::as_str))),
    }
}

/// Checks whether the model's options let an actuator act.
fn acts(classed: &Classed<'_, '_>, compiler: &Compiler) -> Result<bool, ReadError> {
    let group = classed.number("group")?.unwrap_or(0.0);
    Ok(compiler.flags.actuation && !compiler.flags.passive_groups.contains(&group))
}

/// Applies the largest efforts of joints, `actuatorfrcrange`, to their actuators.
fn limit_joints(robot: &mut Robot, bodies: &Bodies<'_, '_>, warnings: &mut Warnings) {
    for (joint, largest, place) in &bodies.efforts {
        let mut count = 0;
        for actuator in robot.actuators.iter_mut().filter(|actuator| actuator.joint == *joint) {
            count += 1;
            match &mut actuator.law {
                Law::Servo(Servo { limit, .. })
                | Law::Torque(Torque { limit })
                | Law::Velocity(Velocity { limit, .. }) => {
                    *limit = limit.min(*largest);
                }
                Law::Held(_) | Law::MusclePair(_) => {
                    warnings.add(place.clone(), "joint `actuatorfrcrange`", "a damped motor has no largest effort");
                }
            }
        }
        if count > 1 {
            let why = "limits each actuator of a joint, and not their sum";
            warnings.add(place.clone(), "joint `actuatorfrcrange`", why);
        }
    }
}

fn check(element: Element<'_>, warnings: &mut Warnings) -> Result<(), ReadError> {
    let read = [
        "name",
        "class",
        "joint",
        "jointinparent",
        "gear",
        "ctrlrange",
        "ctrllimited",
        "forcerange",
        "forcelimited",
        "kp",
        "kv",
        "dampratio",
        "gaintype",
        "gainprm",
        "biastype",
        "biasprm",
        "dyntype",
        "timeconst",
        "inheritrange",
        "group",
    ];
    // Attributes of some kinds only. MuJoCo checks that other kinds do not have them.
    let ignored = [
        ("tendon site refsite slidersite cranksite cranklength body", "actuators act on joints"),
        ("user", "only for show"),
        ("lengthrange range velrange posrange", "the range of commands is `ctrlrange`"),
        ("actlimited actrange actdim actearly dynprm delay nsample interp input", "actuators have no states"),
        ("armature damping", "of the joint alone"),
        (
            "force scale tausmooth lmin lmax vmax fpmax fvmax area diameter bias gain ki imax slewmax ffrange controller cogging \
             inductance lugre motorconst nominal resistance saturation thermal",
            "of a law that is left out",
        ),
    ];
    element.check(&read, &ignored, warnings)
}

/// Returns the law of an actuator and the range of its commands, or the reason why a description has none.
fn law(
    classed: &Classed<'_, '_>,
    gains: Gains,
    joint_range: [f64; 2],
    compiler: &Compiler,
    warnings: &mut Warnings,
) -> Result<Result<Commanded, &'static str>, ReadError> {
    const NONE: &str = "left out: a description has no such law";
    let element = classed.element;
    let mut note = |attribute: &str, why: &str| {
        warnings.add(element.place(), format!("actuator {} {attribute}", element.tag()), why);
    };
    let Some([position, speed]) = gains.law().filter(|_| KINDS.contains(&element.tag())) else { return Ok(Err(NONE)) };
    let gear = classed.list("gear", 1, 6)?.map_or(1.0, |list| list[0]);
    // An actuator's length is gear x q, and its force is multiplied by the gear. So the gear acts twice between q and
    // the joint's torque, and once between the control and the torque.
    let (stiffness, damping, gain) = (-position * gear * gear, -speed * gear * gear, gains.gain * gear);
    if ![stiffness, damping, gain].iter().all(|x| x.is_finite()) || stiffness < 0.0 || damping < 0.0 {
        return Ok(Err(NONE));
    }
    if gains.has_ratio() {
        note("`dampratio`", "left out: the servo has no damping");
    }
    if gains.is_filtered() {
        note("`timeconst`", "left out: actuators have no states");
    }
    if stiffness > 0.0 && (gains.gain + position).abs() > 1e-9 * position.abs() {
        note("gain", "the command is the wanted joint position, whatever the gain");
    }
    // The command is the joint's speed where the gain of the command is that of the speed.
    let of_speed = (gains.gain + speed).abs() <= 1e-9 * speed.abs();
    let automatic = compiler.automatic_limits;
    let force = classed.largest("forcelimited", "forcerange", automatic, warnings)?;
    let limit = force.map_or(f64::INFINITY, |force| force * gear.abs());
    let control = control_range(classed, joint_range, automatic, warnings)?;
    let control = control.filter(|_| compiler.flags.clamp_control);
    // A command is the control times the factor between the control and the torque, per unit of the law.
    let commands = |unit: f64| {
        let [a, b] = control?.map(|end| end * gain / unit);
        (gain != 0.0).then(|| [a.min(b), a.max(b)])
    };
    let law = if stiffness == 0.0 && damping == 0.0 {
        // A factor of 0 is no force, whatever the command.
        let largest = commands(1.0).map_or(f64::INFINITY, |[low, high]| effort_from_file(low.abs().max(high.abs())));
        let limit = limit.min(if gain == 0.0 { 0.0 } else { largest });
        (Law::Torque(Torque { limit }), commands(1.0).filter(|[low, high]| *low != -high))
    } else if stiffness > 0.0 {
        (Law::Servo(Servo { stiffness, damping, limit }), commands(stiffness))
    } else if of_speed {
        (Law::Velocity(Velocity { gain: damping, limit }), commands(damping))
    } else {
        if limit.is_finite() {
            let what = format!("actuator {} `forcerange`", element.tag());
            warnings.add(element.place(), what, "a damped motor has no largest effort");
        }
        (Law::Held(Held { stiffness, damping }), commands(1.0))
    };
    Ok(Ok(law))
}

/// Returns the range of an actuator's control, if it is limited.
///
/// MuJoCo 4.0: a positive `inheritrange` of a servo makes it the range of the joint, scaled about its middle.
fn control_range(
    classed: &Classed<'_, '_>,
    joint_range: [f64; 2],
    automatic: bool,
    warnings: &mut Warnings,
) -> Result<Option<[f64; 2]>, ReadError> {
    let element = classed.element;
    let inherited = if element.tag() == "position" { classed.number("inheritrange")? } else { None };
    let Some(scale) = inherited.filter(|scale| *scale > 0.0) else {
        let ends = classed.limits("ctrllimited", "ctrlrange", automatic, warnings)?;
        return Ok(ends.map(|ends| range_from_file(joined(ends))));
    };
    if element.has("ctrlrange") {
        let text = element.attribute("ctrlrange").unwrap_or_default();
        return Err(element.wrong("ctrlrange", text, "but there is `inheritrange` already"));
    }
    if classed.word("ctrllimited", &["true", "false", "auto"])? == Some("false") {
        return Ok(None);
    }
    let [low, high] = joint_range;
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low) * scale);
    if !half.is_finite() {
        warnings.add(element.place(), "actuator position `inheritrange`", "the joint has no range");
        return Ok(None);
    }
    Ok(Some([middle - half, middle + half]))
}
