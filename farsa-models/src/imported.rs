//! Reading of a robot from a file or a text, in either format.

use std::path::Path;

use farsa_body::robot::Robot;

use crate::context::Context;
use crate::drawn::DrawnMesh;
use crate::error::ReadError;
use crate::files::ModelFiles;
use crate::frame::Frame;
use crate::mjcf::read::ModelParts;
use crate::mjcf::{self, Keyframe};
use crate::options::ReadOptions;
use crate::urdf;
use crate::warnings::{Warning, Warnings};
use crate::xml::tree::Tree;

/// A robot that was read from a file.
///
/// **Content.** A URDF is read with its links, inertials, limits, damping, friction of joints and collision shapes.
/// Joints can be of any type except `planar` and `spherical`. If a joint has a maximum effort, it becomes a
/// [`Torque`](farsa_body::actuators::Torque) with the name of the joint. Largest speeds are read with
/// [`ReadOptions::joint_speeds`].
///
/// An MJCF is read with `compiler`, `default` classes, `include`, bodies and `frame`s. Inertials are used if they
/// exist, and otherwise inertias of the geoms. Hinges and slides have range, damping, armature, `ref`, dry friction, a
/// spring and the laws of their limits. Keyframes are read as postures at rest. Geoms and contact pairs have exclusions and surfaces at rest. Actuators on
/// joints can be motors, position and velocity actuators (also as `general`). Flags of `option` that change the robot
/// are applied. Gravity is in [`Imported::gravity`], because it belongs to the world.
///
/// If a name is unknown, you get an error with the nearest valid name. Parts that a description cannot hold are listed
/// in [`Imported::warnings`], and so is every attribute of an MJCF that nothing has read. However, if leaving them out
/// would make a different robot, this is an error. Examples are ball joints, `attach`, `replicate`, `composite` and
/// `flexcomp`.
///
/// **Rules of translation.**
/// - *Several joints of a MuJoCo body* are separated by additional segments, which are named after body and joint. Since
///   every moving segment needs a mass, each of them gets a small share of the body's mass ([`ReadOptions::between`]).
/// - *Limits* follow MuJoCo 4. Equal ends of a range are no limit. The `actuatorfrcrange` of a joint limits each of its
///   actuators. A `ctrlrange` becomes the [`command_range`](farsa_body::robot::Actuator::command_range) of the actuator,
///   in the unit of its command. For a motor with equal ends it becomes the largest effort.
/// - *A pair that is declared twice* has the springs and dampers of both declarations.
/// - *If a joint is not at its body's origin*, the frame of the segment is at the joint. You can get the frame of the
///   body from [`Imported::frames`].
/// - *Fixed links* remain segments. If a moving link has no mass, it takes over the mass of the links fixed to it.
/// - *Several bodies in the world* belong to a single description. A URDF always has one root.
/// - *Cylinders* become capsules with the same radius and length. If this is impossible because a cylinder is too flat,
///   it becomes a ball of its radius. With [`ReadOptions::cylinders`] they remain cylinders. In a URDF, a cylinder with
///   equal spheres at its ends is a capsule, as [`urdf::write`](crate::urdf::write()) writes it.
/// - *Ellipsoids* become capsules along their longest axis, with the radius of the second longest. As for cylinders,
///   masses are still computed from the true shapes.
/// - *Meshes* (STL, OBJ) become a ball, a capsule or a box that contains all points, whichever has the least volume.
///   Capsule and box use either the axes of the mesh or the principal axes of its surface. Masses of an MJCF's meshes
///   follow its attribute `inertia`, and a primitive with a mesh has MuJoCo's sizes. Concave faces of an OBJ are
///   covered once, whereas MuJoCo divides some of them wrongly.
/// - *Drawn meshes* are in [`Imported::meshes`]. These are visuals with a mesh, geoms of a mesh that cannot touch anything
///   and are in groups 0 to 2, and otherwise the meshes of colliders. They have at most 2000 triangles each and 20 000
///   together.
/// - *Visuals* of a URDF become [`Visual`](farsa_body::robot::Visual)s, except for links with a mesh. Geoms of an MJCF
///   also become visuals if they are in group 1 or 2 and cannot touch anything. Textures are ignored. Colors of other
///   geoms are listed as warnings, since cameras do not see visuals.
/// - *Bounds*: radii and halves of lengths and edges must be below 1e9 m. If an end of a range or an effort is at least
///   1e9, it becomes infinite. Robots survive writing and reading, except for the parts that
///   [`mjcf::write`](crate::mjcf::write()) and [`urdf::write`](crate::urdf::write()) list.
/// - *Contacts of MuJoCo* become springs and dampers with an inertia and a margin, whose impedance changes with the
///   depth. Pyramids of friction are read for a `condim` of 3. Other friction is round, with the numbers of the file's
///   cones.
/// - *Commands* are efforts and joint positions. Note that MuJoCo uses different numbers, before its gears.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Imported {
    /// Robot description. It is always valid.
    pub robot: Robot,
    /// Frames of all links or bodies, in the order of the file.
    pub frames: Vec<Frame>,
    /// Gravity [m/s2], if an MJCF sets it.
    pub gravity: Option<[f64; 3]>,
    /// False if an MJCF disables all contacts. The robot then has no pairs.
    pub contacts: bool,
    /// States from which a simulation can start: the configuration of the file, without a name, and the keyframes of an MJCF.
    pub keyframes: Vec<Keyframe>,
    /// Warnings about omitted and replaced parts, in alphabetical order.
    pub warnings: Vec<Warning>,
    /// Meshes that views draw instead of colliders.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Vec::is_empty"))]
    pub meshes: Vec<DrawnMesh>,
}

impl Imported {
    /// Reads a URDF or MJCF file. Its root element determines the format.
    ///
    /// You can also pass a pipe. It is read until it ends or until [`Limits::bytes`](crate::Limits::bytes) is
    /// exceeded. Other files that the model names must be regular files.
    ///
    /// # Errors
    /// Returns the fault and its line, see [`ReadError`].
    pub fn from_file(path: impl AsRef<Path>, options: &ReadOptions) -> Result<Self, ReadError> {
        let path = path.as_ref();
        let mut files = ModelFiles::new(path.parent(), options)?;
        let text = files.model(path)?;
        Self::read(&path.display().to_string(), &text, files, options)
    }

    /// Reads a robot from the text of a URDF or MJCF. If the text names other files, you need to set
    /// [`ReadOptions::root`].
    ///
    /// ```
    /// use farsa_models::{Imported, ReadOptions};
    ///
    /// let text = r#"<mujoco><worldbody><body name="rod" pos="0 0 1">
    ///     <joint name="hinge" axis="0 1 0" range="-90 90"/><geom type="capsule" fromto="0 0 0 0 0 -0.5" size="0.01"/>
    /// </body></worldbody></mujoco>"#;
    /// let imported = Imported::from_text(text, &ReadOptions::default())?;
    /// assert_eq!(imported.robot.joint("hinge").map(|joint| joint.index()), Some(0));
    ///
    /// let error = Imported::from_text(&text.replace("axis", "axes"), &ReadOptions::default()).unwrap_err();
    /// assert_eq!(error.to_string(), "text line 2: unknown attribute of joint `axes`; the nearest is `axis`");
    /// # Ok::<(), farsa_models::ReadError>(())
    /// ```
    ///
    /// # Errors
    /// Returns the fault and its line, see [`ReadError`].
    pub fn from_text(text: &str, options: &ReadOptions) -> Result<Self, ReadError> {
        Self::read("text", text, ModelFiles::new(None, options)?, options)
    }

    fn read(file: &str, text: &str, files: ModelFiles, options: &ReadOptions) -> Result<Self, ReadError> {
        let mut context = Context { files, options, warnings: Warnings::default(), elements: 0 };
        let tree = Tree::parse(file, text, &mut context)?;
        let root = tree.root();
        let parts = match root.tag() {
            "robot" => {
                let (robot, frames, meshes) = urdf::read::read(&tree, &mut context)?;
                let keyframes = vec![Keyframe::of_file(&robot, &[])];
                ModelParts { robot, frames, gravity: None, contacts: true, keyframes, meshes }
            }
            "mujoco" => mjcf::read::read(&tree, &mut context)?,
            _ => return Err(root.unknown("root of a model", root.tag(), ["robot", "mujoco"])),
        };
        let ModelParts { robot, frames, gravity, contacts, keyframes, meshes } = parts;
        robot.validate().map_err(|error| ReadError::Robot { file: file.into(), error })?;
        Ok(Self { robot, frames, gravity, contacts, keyframes, warnings: context.warnings.list(), meshes })
    }

    /// Finds the frame of a link or body by its name in the file. If there is no such name, this returns `None`.
    pub fn frame(&self, name: &str) -> Option<&Frame> {
        self.frames.iter().find(|frame| frame.name == name)
    }
}
