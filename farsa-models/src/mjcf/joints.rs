//! Joints of an MJCF file.

use farsa_body::Pose;
use farsa_body::robot::{Joint, JointKind};

use crate::bounds::{joined, range_from_file};
use crate::context::Context;
use crate::error::{ReadError, SourceLocation};
use crate::mjcf::classes::Classed;
use crate::mjcf::compiler::Compiler;
use crate::mjcf::limits::Limits;
use crate::mjcf::reasons::SHOW;
use crate::vector::norm;
use crate::warnings::Warnings;
use crate::xml::tree::Element;

pub(crate) fn check_joint(element: Element<'_>, warnings: &mut Warnings) -> Result<(), ReadError> {
    let read = [
        "name",
        "class",
        "type",
        "pos",
        "axis",
        "range",
        "limited",
        "ref",
        "armature",
        "damping",
        "stiffness",
        "springref",
        "frictionloss",
        "solreflimit",
        "solimplimit",
        "actuatorfrcrange",
        "actuatorfrclimited",
    ];
    let ignored = [
        ("group", SHOW),
        ("springyield", "springs do not yield"),
        ("springdamper", "only `stiffness` and `damping` are read"),
        ("solreffriction solimpfriction", "how MuJoCo computes"),
        ("margin", "stops begin at the limits"),
        ("actuatorgravcomp", "weights are not compensated"),
        ("user", "a user's own"),
    ];
    element.check(&read, &ignored, warnings)
}

/// A joint of a body.
pub(crate) struct BodyJoint {
    /// Joint with its placement relative to its anchor.
    pub(crate) joint: Joint,
    /// Place in the frame that the previous joint left.
    pub(crate) anchor: [f64; 3],
    /// Position in the configuration of the file, `ref`.
    pub(crate) reference: f64,
    /// Largest effort of all actuators, and the line that gives it.
    pub(crate) effort: Option<(f64, SourceLocation)>,
    /// Numbers of the limits, if it has any.
    pub(crate) limits: Option<Limits>,
}

impl BodyJoint {
    pub(crate) fn free(element: Element<'_>) -> Self {
        let name = element.attribute("name").unwrap_or_default().into();
        let joint = Joint { name, ..Joint::floating(Pose::identity()) };
        Self { joint, anchor: [0.0; 3], reference: 0.0, effort: None, limits: None }
    }
}

/// Notes what a free joint cannot have.
fn check_free(classed: &Classed<'_, '_>, compiler: &Compiler, warnings: &mut Warnings) -> Result<(), ReadError> {
    let flags = &compiler.flags;
    for (name, applies) in [
        ("armature", true),
        ("damping", flags.damper),
        ("stiffness", flags.spring),
        ("frictionloss", flags.friction_loss),
    ] {
        let given = classed.list(name, 1, 3)?.is_some_and(|list| list.iter().any(|x| *x != 0.0));
        if applies && given {
            warnings.add(classed.element.place(), format!("free joint `{name}`"), "left out: free bodies have none");
        }
    }
    Ok(())
}

/// Reads a joint, at a place in its body's frame.
pub(crate) fn joint(
    classed: &Classed<'_, '_>,
    name: &str,
    within: &Pose<f64>,
    compiler: &Compiler,
    context: &mut Context<'_>,
) -> Result<BodyJoint, ReadError> {
    let element = classed.element;
    let kind = match classed.word("type", &["hinge", "slide", "ball", "free"])? {
        Some("slide") => JointKind::Prismatic,
        Some("ball") => return Err(element.unsupported("ball joints cannot be described; three hinges can")),
        Some("free") => {
            check_free(classed, compiler, &mut context.warnings)?;
            return Ok(BodyJoint::free(element));
        }
        _ => JointKind::Revolute,
    };
    let unit = if kind == JointKind::Revolute { compiler.angle } else { 1.0 };
    let anchor = within.transform(classed.array::<3>("pos")?.unwrap_or([0.0; 3]));
    let axis = within.rotate(classed.array::<3>("axis")?.unwrap_or([0.0, 0.0, 1.0]));
    if norm(&axis) <= 1e-6 {
        let source = classed.source("axis").unwrap_or(element);
        return Err(source.wrong("axis", source.attribute("axis").unwrap_or_default(), "but must be a direction"));
    }
    let ends = classed.limits("limited", "range", compiler.automatic_limits, &mut context.warnings)?;
    let ends = ends.filter(|_| compiler.flags.limit);
    let range =
        ends.map_or([f64::NEG_INFINITY, f64::INFINITY], |ends| range_from_file(joined(ends.map(|end| end * unit))));
    let flags = &compiler.flags;
    let [mut damping, mut stiffness] = [0.0; 2];
    for (number, name, of, applies) in
        [(&mut damping, "damping", "speed", flags.damper), (&mut stiffness, "stiffness", "stretch", flags.spring)]
    {
        // Numbers after the first belong to higher powers.
        let list = classed.list(name, 1, 3)?.filter(|_| applies).unwrap_or_else(|| vec![0.0]);
        if list.iter().skip(1).any(|x| *x != 0.0) {
            let why = format!("only what is proportional to the {of} is described");
            context.warnings.add(element.place(), format!("joint `{name}`"), why);
        }
        *number = list[0];
        if !(*number >= 0.0 && number.is_finite()) {
            return Err(element.wrong(name, &number.to_string(), "but must not be negative or endless"));
        }
    }
    let friction = classed.not_negative("frictionloss")?.filter(|_| flags.friction_loss).unwrap_or(0.0);
    let rest = classed.number("springref")?.unwrap_or(0.0) * unit;
    let mut joint = Joint::revolute(name, axis, Pose::identity(), range).with_damping(damping).with_friction(friction);
    if stiffness > 0.0 {
        joint = joint.with_spring(stiffness, rest);
    }
    joint.kind = kind;
    joint.armature = classed.not_negative("armature")?.unwrap_or(0.0);
    // `ref` is the joint's position in the configuration of the file. Positions have this meaning here, too. At
    // position 0 the segment is therefore moved back by `ref`, about or along the axis.
    let reference = classed.number("ref")?.unwrap_or(0.0) * unit;
    if reference != 0.0 {
        let length = norm(&axis);
        let axis = axis.map(|x| x / length);
        joint.placement = if kind == JointKind::Revolute {
            let (sine, cosine) = farsa_num::sin_cos(-reference / 2.0);
            let [x, y, z] = axis.map(|part| part * sine);
            Pose { rotation: [x, y, z, cosine], ..Pose::identity() }
        } else {
            Pose::at(axis.map(|part| -part * reference))
        };
    }
    let automatic = compiler.automatic_limits;
    let effort = classed.largest("actuatorfrclimited", "actuatorfrcrange", automatic, &mut context.warnings)?;
    let effort = effort.map(|largest| (largest, element.place()));
    let limits = if ends.is_some() { Some(Limits::from_joint(classed)?) } else { None };
    if limits.is_some_and(|limits| !limits.is_exact()) {
        context.warnings.add(element.place(), "solimplimit", "stops have the powers 1 and 2 only");
    }
    Ok(BodyJoint { joint, anchor, reference, effort, limits })
}
