//! A robot from an MJCF file.

use farsa_body::robot::{MassProperties, Robot};

use crate::context::Context;
use crate::drawn::DrawnMesh;
use crate::error::{ReadError, SourceLocation};
use crate::frame::Frame;
use crate::mesh::solid::scaled;
use crate::mjcf::actuators::actuators;
use crate::mjcf::bodies::Bodies;
use crate::mjcf::classes::{ACTUATORS, Classes};
use crate::mjcf::compiler::Compiler;
use crate::mjcf::contacts::contacts;
use crate::mjcf::flags::Flags;
use crate::mjcf::keyframes::{Keyframe, keyframes};
use crate::mjcf::reasons::{FIT, MUJOCO};
use crate::repair::{check_masses, move_fixed_masses};
use crate::xml::tree::Tree;

/// Content of a model.
pub(crate) struct ModelParts {
    pub(crate) robot: Robot,
    pub(crate) frames: Vec<Frame>,
    pub(crate) gravity: Option<[f64; 3]>,
    pub(crate) contacts: bool,
    pub(crate) keyframes: Vec<Keyframe>,
    pub(crate) meshes: Vec<DrawnMesh>,
}

pub(crate) fn read(tree: &Tree, context: &mut Context<'_>) -> Result<ModelParts, ReadError> {
    let model = tree.root();
    model.check(&["model"], &[], &mut context.warnings)?;
    let ignored = [
        ("size statistic visual", MUJOCO),
        ("sensor", "sensors are made beside the robot"),
        ("custom extension", "a user's own"),
        ("tendon", "a description has no tendons"),
        ("deformable", "all bodies are rigid"),
    ];
    let read = ["compiler", "option", "default", "asset", "worldbody", "contact", "actuator", "equality", "keyframe"];
    model.check_children(&read, &ignored, &mut context.warnings)?;
    let compiler = Compiler::from_model(model, context)?;
    for element in model.all("equality") {
        if compiler.flags.equality {
            context.warnings.add(element.place(), "equality", "a description has no loops: what it joins is apart");
        }
        element.leave();
    }
    let classes = Classes::from_model(model, context.options.limits.defaults)?;
    for element in classes.elements() {
        let tag = element.tag();
        if tag == "mesh" {
            element.check(&["scale", "inertia"], &[("maxhullvert", FIT)], &mut context.warnings)?;
        } else if !["joint", "geom", "pair"].contains(&tag) && !ACTUATORS.contains(&tag) {
            context.warnings.add(element.place(), format!("default {tag}"), "of elements that are not read");
        }
    }
    let mut robot = Robot::new(model.attribute("model").unwrap_or_default());
    let mut locations: Vec<SourceLocation> = Vec::new();
    let mut bodies = Bodies::new(model, &compiler, &classes, context)?;
    bodies.read(&mut robot, &mut locations, context)?;
    move_fixed_masses(&mut robot, &locations, &mut context.warnings);
    bodies.share_masses(&mut robot, context.options.between);
    check_masses(&mut robot, &locations, &context.options.repair, &mut context.warnings)?;
    if compiler.total_mass > 0.0 {
        let sum: f64 = robot.segments.iter().map(|segment| segment.mass).sum();
        for segment in robot.segments.iter_mut().filter(|_| sum > 0.0) {
            let MassProperties { mass, inertia, .. } = scaled(&segment.mass_properties(), compiler.total_mass / sum);
            (segment.mass, segment.inertia) = (mass, inertia);
        }
    }
    bodies.set_stops(&mut robot).map_err(|error| ReadError::Robot { file: model.place().file, error })?;
    actuators(model, &mut robot, &compiler, &classes, &bodies, context)?;
    contacts(model, &mut robot, &classes, &bodies, &compiler.flags, context)?;
    let keyframes = keyframes(model, &robot, &bodies.references, context)?;
    let meshes = bodies.drawn(&robot, context);
    // Defaults and meshes may be of no element that was read. Their attributes are all of the format.
    model.list_unread(&["default", "mesh", "name", "class", "childclass"], &mut context.warnings);
    let Flags { gravity, contact, .. } = compiler.flags;
    Ok(ModelParts { robot, frames: bodies.frames, gravity, contacts: contact, keyframes, meshes })
}
