//! Actuators of an MJCF file.

use farsa_body::actuators::{Held, Law, Servo, Torque, Velocity};
use farsa_body::robot::Robot;

use crate::context::Context;
use crate::error::ReadError;
use crate::mjcf::bodies::Bodies;
use crate::mjcf::classes::{ACTUATORS, Classed, Classes};
use crate::mjcf::compiler::Compiler;
use crate::mjcf::names::Names;
use crate::warnings::Warnings;
use crate::xml::tree::Element;

/// A spring of MuJoCo's: force = gain x control + position x length + speed x velocity.
///
/// Its documentation, "Computation, Actuation model": the kinds of actuators are shortcuts for `general`, with a fixed
/// `gainprm` and an affine `biasprm`. A servo is gain = kp, position = -kp, speed = -kv.
struct Gains {
    gain: f64,
    position: f64,
    speed: f64,
}

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
    let mut number = 0;
    for section in sections {
        section.check(&[], &[], &mut context.warnings)?;
        section.check_children(&ACTUATORS, &[("plugin", "plugins are MuJoCo's")], &mut context.warnings)?;
        for element in section.children().filter(|child| ACTUATORS.contains(&child.tag())) {
            check(element, &mut context.warnings)?;
            let index = number;
            number += 1;
            let classed = classes.with(element, 0)?;
            let Some(joint) = element.attribute("joint").or_else(|| element.attribute("jointinparent")) else {
                let why = "left out: it acts on no joint, but by a tendon, a site or a body";
                context.warnings.add(element.place(), format!("actuator {}", element.tag()), why);
                continue;
            };
            let Some(id) = bodies.joints.get(joint).copied() else {
                if bodies.names.has("joint", joint) {
                    context.warnings.add(
                        element.place(),
                        format!("actuator {}", element.tag()),
                        "left out: it acts on a free joint",
                    );
                    continue;
                }
                return Err(element.unknown("joint", joint, bodies.joints.keys().map(String::as_str)));
            };
            if let Some(law) = law(&classed, compiler, &mut context.warnings)? {
                let name = element.attribute("name").filter(|name| !name.is_empty()).map(String::from);
                let name = name.unwrap_or_else(|| names.generate("actuator", format!("actuator{index}")));
                robot.add_actuator(&name, id, law);
            } else {
                let why = "left out: a description has no such law";
                context.warnings.add(element.place(), format!("actuator {}", element.tag()), why);
            }
        }
    }
    Ok(())
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
    ];
    // Attributes of some kinds only. MuJoCo checks that other kinds do not have them.
    let ignored = [
        ("tendon site refsite slidersite cranksite cranklength body", "actuators act on joints"),
        ("group user", "only for show"),
        ("lengthrange inheritrange range velrange posrange", "the range of commands is the caller's"),
        ("actlimited actrange actdim actearly dynprm delay nsample interp input", "actuators have no states"),
        ("armature damping", "of the joint alone"),
        (
            "force scale lmin lmax vmax fpmax fvmax area diameter bias gain ki imax slewmax ffrange controller cogging \
             inductance lugre motorconst nominal resistance saturation thermal",
            "of a law that is left out",
        ),
    ];
    element.check(&read, &ignored, warnings)
}

/// Returns the law of an actuator, or `None` if a description has no such law.
fn law(classed: &Classed<'_, '_>, compiler: &Compiler, warnings: &mut Warnings) -> Result<Option<Law<f64>>, ReadError> {
    let element = classed.element;
    let number = |name: &'static str, default: f64| Ok::<_, ReadError>(classed.number(name)?.unwrap_or(default));
    let gains = match element.tag() {
        "motor" => Gains { gain: 1.0, position: 0.0, speed: 0.0 },
        "position" => {
            let stiffness = number("kp", 1.0)?;
            if classed.number("dampratio")?.is_some_and(|ratio| ratio != 0.0) {
                warnings.add(
                    element.place(),
                    "actuator position `dampratio`",
                    "left out: the servo has the damping of `kv` alone",
                );
            }
            if classed.number("timeconst")?.is_some_and(|constant| constant != 0.0) {
                warnings.add(element.place(), "actuator position `timeconst`", "left out: actuators have no states");
            }
            Gains { gain: stiffness, position: -stiffness, speed: -number("kv", 0.0)? }
        }
        "velocity" => {
            let damping = number("kv", 1.0)?;
            Gains { gain: damping, position: 0.0, speed: -damping }
        }
        "general" => {
            let plain = classed.text("dyntype").is_none_or(|kind| kind == "none")
                && classed.text("gaintype").is_none_or(|kind| kind == "fixed");
            let gain = classed.list("gainprm", 1, 20)?.map_or(1.0, |list| list[0]);
            let bias = classed.list("biasprm", 1, 20)?.unwrap_or_default();
            let bias = |i: usize| bias.get(i).copied().unwrap_or(0.0);
            match classed.text("biastype").unwrap_or("none") {
                "none" if plain => Gains { gain, position: 0.0, speed: 0.0 },
                "affine" if plain && bias(0) == 0.0 => Gains { gain, position: bias(1), speed: bias(2) },
                _ => return Ok(None),
            }
        }
        _ => return Ok(None),
    };
    let gear = classed.list("gear", 1, 6)?.map_or(1.0, |list| list[0]);
    let mut limit = f64::INFINITY;
    if let Some(force) = largest(classed, "forcelimited", "forcerange", compiler, warnings)? {
        limit = force * gear.abs();
    }
    // An actuator's length is gear x q, and its force is multiplied by the gear. So the gear acts twice between q and
    // the joint's torque, and once between the control and the torque.
    let (stiffness, damping) = (-gains.position * gear * gear, -gains.speed * gear * gear);
    let sound = [stiffness, damping, gear, gains.gain].iter().all(|x| x.is_finite());
    if !sound || stiffness < 0.0 || damping < 0.0 {
        return Ok(None);
    }
    if stiffness == 0.0 && damping == 0.0 {
        if let Some(control) = largest(classed, "ctrllimited", "ctrlrange", compiler, warnings)? {
            limit = limit.min(control * (gains.gain * gear).abs());
        }
        return Ok(Some(Law::Torque(Torque { limit })));
    }
    if stiffness == 0.0 {
        // The command is the joint's speed where the gain of the command is that of the speed.
        if limit.is_finite() && gear == 1.0 && (gains.gain - damping).abs() <= 1e-9 * damping {
            return Ok(Some(Law::Velocity(Velocity { gain: damping, limit })));
        }
        if limit.is_finite() {
            warnings.add(
                element.place(),
                format!("actuator {} `forcerange`", element.tag()),
                "such a law has no largest effort",
            );
        }
        return Ok(Some(Law::Held(Held { stiffness, damping })));
    }
    if (gains.gain + gains.position).abs() > 1e-9 * stiffness.abs() {
        let why = "the command is the wanted joint position, whatever the gain";
        warnings.add(element.place(), format!("actuator {} gain", element.tag()), why);
    }
    Ok(Some(Law::Servo(Servo { stiffness, damping, limit })))
}

/// Gets the larger end of a range if it holds.
fn largest(
    classed: &Classed<'_, '_>,
    limited: &'static str,
    range: &'static str,
    compiler: &Compiler,
    warnings: &mut Warnings,
) -> Result<Option<f64>, ReadError> {
    if !classed.limited(limited, range, compiler.automatic_limits)? {
        return Ok(None);
    }
    let Some(list) = classed.list(range, 2, 2)? else { return Err(classed.element.missing(range)) };
    let [low, high] = [list[0], list[1]];
    if low != -high {
        let why = "efforts are limited alike in both directions, by the larger end";
        warnings.add(classed.element.place(), format!("actuator `{range}`"), why);
    }
    Ok(Some(low.abs().max(high.abs())))
}
