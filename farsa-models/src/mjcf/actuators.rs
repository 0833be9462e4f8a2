//! Actuators of an MJCF file.

use farsa_body::actuators::{Held, Law, Servo, Torque, Velocity};
use farsa_body::ports::JointId;
use farsa_body::robot::Robot;

use crate::context::Context;
use crate::error::ReadError;
use crate::mjcf::bodies::Bodies;
use crate::mjcf::classes::{ACTUATORS, Classed, Classes};
use crate::mjcf::compiler::Compiler;
use crate::mjcf::gains::{ClassGains, Gains};
use crate::mjcf::names::Names;
use crate::warnings::Warnings;
use crate::xml::tree::Element;

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
                Ok(id) => law(&classed, gains.of(&classed)?, compiler, &mut context.warnings)?.map(|law| (id, law)),
            };
            match law {
                Ok(_) if !acts(&classed, compiler)? => {
                    let why = "left out: the model's `option` disables it";
                    context.warnings.add(element.place(), format!("actuator {}", element.tag()), why);
                    element.leave();
                }
                Ok((id, law)) => {
                    let name = element.attribute("name").filter(|name| !name.is_empty()).map(String::from);
                    let name = name.unwrap_or_else(|| names.generate("actuator", format!("actuator{index}")));
                    robot.add_actuator(&name, id, law);
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
        "group",
    ];
    // Attributes of some kinds only. MuJoCo checks that other kinds do not have them.
    let ignored = [
        ("tendon site refsite slidersite cranksite cranklength body", "actuators act on joints"),
        ("user", "only for show"),
        ("lengthrange inheritrange range velrange posrange", "the range of commands is the caller's"),
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

/// Returns the law of an actuator, or the reason why a description has none.
fn law(
    classed: &Classed<'_, '_>,
    gains: Gains,
    compiler: &Compiler,
    warnings: &mut Warnings,
) -> Result<Result<Law<f64>, &'static str>, ReadError> {
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
    let control = classed.largest("ctrllimited", "ctrlrange", automatic, warnings)?;
    let control = control.filter(|_| compiler.flags.clamp_control);
    let (law, ignored, why) = if stiffness == 0.0 && damping == 0.0 {
        // A factor of 0 is no force, whatever the command.
        let control = if gain == 0.0 { 0.0 } else { control.map_or(f64::INFINITY, |control| control * gain.abs()) };
        (Law::Torque(Torque { limit: limit.min(control) }), None, "")
    } else {
        let range = control.map(|_| "`ctrlrange`");
        let why = "the range of commands is the caller's";
        if stiffness > 0.0 {
            (Law::Servo(Servo { stiffness, damping, limit }), range, why)
        } else if of_speed {
            (Law::Velocity(Velocity { gain: damping, limit }), range, why)
        } else if limit.is_finite() {
            (Law::Held(Held { stiffness, damping }), Some("`forcerange`"), "a damped motor has no largest effort")
        } else {
            (Law::Held(Held { stiffness, damping }), range, why)
        }
    };
    if let Some(attribute) = ignored {
        warnings.add(element.place(), format!("actuator {} {attribute}", element.tag()), why);
    }
    Ok(Ok(law))
}
