//! A robot from an MJCF file.

use farsa_body::robot::{MassProperties, Robot};

use crate::context::Context;
use crate::error::{ReadError, SourceLocation};
use crate::frame::Frame;
use crate::mesh::solid::scaled;
use crate::mjcf::actuators::actuators;
use crate::mjcf::bodies::Bodies;
use crate::mjcf::classes::{ACTUATORS, Classes};
use crate::mjcf::compiler::{Compiler, MUJOCO};
use crate::mjcf::contacts::contacts;
use crate::repair::repair_masses;
use crate::xml::tree::Tree;

pub(crate) fn read(tree: &Tree, context: &mut Context<'_>) -> Result<(Robot, Vec<Frame>), ReadError> {
    let model = tree.root();
    model.check(&["model"], &[], &mut context.warnings)?;
    let ignored = [
        ("option", "gravity, steps and solvers are the world's"),
        ("size statistic visual", MUJOCO),
        ("sensor", "sensors are made beside the robot"),
        ("keyframe", "postures are not described"),
        ("custom extension", "a user's own"),
        ("tendon", "a description has no tendons"),
        ("equality", "a description has no loops: what it joins is apart"),
        ("deformable", "all bodies are rigid"),
    ];
    let read = ["compiler", "default", "asset", "worldbody", "contact", "actuator"];
    model.check_children(&read, &ignored, &mut context.warnings)?;
    let compiler = Compiler::from_model(model, context)?;
    let classes = Classes::from_model(model, context.options.limits.defaults)?;
    for element in classes.elements() {
        let valid = ["joint", "geom", "pair", "mesh"].contains(&element.tag()) || ACTUATORS.contains(&element.tag());
        if !valid {
            context.warnings.add(
                element.place(),
                format!("default {}", element.tag()),
                "of elements that are not read",
            );
        }
    }
    let mut robot = Robot::new(model.attribute("model").unwrap_or_default());
    let mut locations: Vec<SourceLocation> = Vec::new();
    let mut bodies = Bodies::new(model, &compiler, &classes, context)?;
    bodies.read(&mut robot, &mut locations, context)?;
    repair_masses(&mut robot, &locations, &compiler.repair, &mut context.warnings)?;
    if compiler.total_mass > 0.0 {
        let sum: f64 = robot.segments.iter().map(|segment| segment.mass).sum();
        for segment in robot.segments.iter_mut().filter(|_| sum > 0.0) {
            let MassProperties { mass, inertia, .. } = scaled(&segment.mass_properties(), compiler.total_mass / sum);
            (segment.mass, segment.inertia) = (mass, inertia);
        }
    }
    actuators(model, &mut robot, &compiler, &classes, &bodies, context)?;
    contacts(model, &mut robot, &classes, &bodies, context)?;
    Ok((robot, bodies.frames))
}
