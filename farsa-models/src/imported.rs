//! A robot from a file or a text, in either format.

use std::path::Path;

use farsa_body::robot::Robot;

use crate::context::Context;
use crate::error::ReadError;
use crate::files::ModelFiles;
use crate::frame::Frame;
use crate::mjcf;
use crate::options::ReadOptions;
use crate::urdf;
use crate::warnings::{Warning, Warnings};
use crate::xml::tree::Tree;

/// A robot that was read from a file.
///
/// **Content.** URDF: links, inertials, joints except `planar` and `spherical` ones, limits, damping, collision shapes.
/// A joint's largest effort makes a [`Torque`](farsa_body::actuators::Torque) of the joint's name.
///
/// MJCF: `compiler`, `default` classes, `include`, bodies and `frame`s, inertials or the geoms' inertias. Hinges,
/// slides and free joints have range, damping, armature and `ref`. Geoms and contact pairs have exclusions and surfaces
/// at rest. Motors, position and velocity actuators act on joints (also as `general`).
///
/// Unknown names are errors, with the nearest valid name. A part without a counterpart in a description is listed in
/// [`Imported::warnings`]. It is an error if its omission would make another robot: ball joints, `attach`, `replicate`,
/// `composite`, `flexcomp`.
///
/// **Rules of translation.**
/// - *Several joints of a MuJoCo body* make segments between them, named after body and joint. Each has a small share
///   of the body's mass ([`ReadOptions::between`]), because a description has one joint a segment, and every moving
///   segment a mass.
/// - *A joint off its body's origin*: the segment's frame is at the joint, and [`Imported::frames`] has the body's
///   frame.
/// - *Fixed links* stay segments. Only if a moving one has no mass itself it takes over that of the links fixed to it.
/// - *Several bodies in the world* are one description. A URDF has one root.
/// - *Shapes that we lack*: a cylinder becomes the capsule of its radius and length, or a ball of its radius if it is
///   flatter than that. An ellipsoid the capsule along its longest axis with the radius of the next. In a URDF a
///   cylinder with equal spheres at its ends is a capsule, as [`urdf::write`](crate::urdf::write()) writes it. Masses
///   are those of the true shapes.
/// - *Meshes* (STL, OBJ) become the smallest by volume of a ball, a capsule and a box that contain all their points.
///   Capsule and box are along the mesh's own axes or the principal axes of its surface. Meshes that can touch nothing
///   are left out.
/// - *Visuals*: visuals of a URDF, except those of links with a mesh, become [`Visual`](farsa_body::robot::Visual)s. So
///   do geoms of an MJCF of group 1 or 2 that can touch nothing. Their colors are those without a texture. Colors of
///   other geoms are listed, because cameras do not see visuals.
/// - *Bounds*: radii and halves of lengths and edges of 1e9 m or more are errors. Ends of ranges and efforts from 1e9
///   on become infinite. The robot is written and read back unchanged, except for the parts that
///   [`mjcf::write`](crate::mjcf::write()) and [`urdf::write`](crate::urdf::write()) list.
/// - *Contacts of MuJoCo* are springs and dampers here: stiffness and damping are those at rest at full impedance.
/// - *Commands* are efforts and joint positions. MuJoCo's, before its gears, are other numbers.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Imported {
    /// The robot, valid.
    pub robot: Robot,
    /// Where the file's links or bodies are in it, in the file's order.
    pub frames: Vec<Frame>,
    /// The omitted and replaced parts, in alphabetical order.
    pub warnings: Vec<Warning>,
}

impl Imported {
    /// Reads a URDF or MJCF file. The root element decides between the two.
    ///
    /// The file may be a pipe, which is read to its end or [`Limits::bytes`](crate::Limits::bytes). Files that the
    /// model names must be regular ones.
    ///
    /// # Errors
    /// The fault and its line: see [`ReadError`].
    pub fn from_file(path: &Path, options: &ReadOptions) -> Result<Self, ReadError> {
        let mut files = ModelFiles::new(path.parent(), options)?;
        let text = files.model(path)?;
        Self::read(&path.display().to_string(), &text, files, options)
    }

    /// Reads the text of a URDF or MJCF. Without [`ReadOptions::root`] it must name no files.
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
    /// The fault and its line: see [`ReadError`].
    pub fn from_text(text: &str, options: &ReadOptions) -> Result<Self, ReadError> {
        Self::read("text", text, ModelFiles::new(None, options)?, options)
    }

    fn read(file: &str, text: &str, files: ModelFiles, options: &ReadOptions) -> Result<Self, ReadError> {
        let mut context = Context { files, options, warnings: Warnings::default(), elements: 0 };
        let tree = Tree::parse(file, text, &mut context)?;
        let root = tree.root();
        let (robot, frames) = match root.tag() {
            "robot" => urdf::read::read(&tree, &mut context)?,
            "mujoco" => mjcf::read::read(&tree, &mut context)?,
            _ => return Err(root.unknown("root of a model", root.tag(), ["robot", "mujoco"])),
        };
        robot.validate().map_err(|error| ReadError::Robot { file: file.into(), error })?;
        Ok(Self { robot, frames, warnings: context.warnings.list() })
    }

    /// Where the link or body of this name in the file is.
    pub fn frame(&self, name: &str) -> Option<&Frame> {
        self.frames.iter().find(|frame| frame.name == name)
    }
}
