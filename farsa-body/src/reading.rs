//! Robots from files: what is asked of the readers, and what they answer.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::string::{String, ToString as _};
use std::vec::Vec;

use crate::markup_tree::Tree;
use crate::model_files::ModelFiles;
use crate::ports::BodyId;
use crate::pose::Pose;
use crate::read_error::{Place, ReadError};
use crate::read_mjcf;
use crate::read_urdf;
use crate::robot::description::Robot;

/// How much a model may hold, so that reading it takes bounded time and memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Bytes of a file.
    pub bytes: usize,
    /// Bytes of all files, a mesh counted each time that it is used.
    pub all_bytes: usize,
    /// Elements of a model, its included files counted.
    pub elements: usize,
    /// Elements within each other.
    pub depth: usize,
    /// Attributes of an element, and name spaces of a model; all elements together may have eight each.
    pub attributes: usize,
    /// Elements in the `default` classes of an MJCF.
    pub defaults: usize,
    /// Geoms of an MJCF that may touch others, and degrees of freedom of a robot with contacts: what takes time as their
    /// square or cube.
    pub contacts: usize,
    /// Files that are opened: the model, included ones, and meshes each time that they are used.
    pub files: usize,
}

impl Default for Limits {
    /// 32 MiB a file and 1 GiB in all, 100 000 elements 200 deep with 64 attributes each, 2000 files; 1000 defaults, 2000
    /// geoms that may touch and degrees of freedom. A few hundred MiB of memory at most, and seconds.
    fn default() -> Self {
        Self {
            bytes: 32 << 20,
            all_bytes: 1 << 30,
            elements: 100_000,
            depth: 200,
            attributes: 64,
            defaults: 1000,
            contacts: 2000,
            files: 2000,
        }
    }
}

/// What becomes of meshes that may touch something.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Meshes {
    /// Each becomes the smallest by volume of the ball, capsule and box that hold all its points; see [`Reading`].
    #[default]
    Fit,
    /// They are left out, without looking at their files, and noted.
    Leave,
}

/// What to do about masses that no body can have; by default they are errors.
///
/// MJCF's `compiler` has the same settings (`boundmass`, `boundinertia`, `balanceinertia`), which are obeyed there anyway.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Repair {
    /// Least mass of what moves [kg].
    pub least_mass: f64,
    /// Least principal moment of inertia of what moves [kg m2].
    pub least_inertia: f64,
    /// Gives moments of which one exceeds the sum of the others their mean.
    pub balance: bool,
}

/// How to read a model; [`ReadOptions::default`] reads it strictly.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadOptions {
    /// The folder that all files that the model names must lie in; `None` for the folder of the model itself.
    pub root: Option<PathBuf>,
    /// Folders that hold packages, for `package://name/...`: each is looked in for a folder `name`.
    pub packages: Vec<PathBuf>,
    /// Whether a URDF's root moves freely instead of standing fixed in the world; one called `world` is the world anyway.
    pub floating: bool,
    /// What becomes of meshes.
    pub meshes: Meshes,
    /// What to do about impossible masses.
    pub repair: Repair,
    /// The share of a body's mass and inertia that each of the segments between its joints gets, where it has several.
    pub between: f64,
    /// How much the model may hold.
    pub limits: Limits,
}

impl Default for ReadOptions {
    fn default() -> Self {
        Self {
            root: None,
            packages: Vec::new(),
            floating: false,
            meshes: Meshes::Fit,
            repair: Repair::default(),
            between: 1e-3,
            limits: Limits::default(),
        }
    }
}

/// Where a link or body of the file is in the robot.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Its name in the file, or `bodyN` for MJCF's N-th if it has none.
    pub name: String,
    /// The segment that it is fixed to; `None` for the world.
    pub body: Option<BodyId>,
    /// Where its frame is in the segment's; the identity unless a joint is off the body's origin.
    pub placement: Pose<f64>,
}

/// Something that the file says and the robot does not.
#[derive(Clone, Debug, PartialEq)]
pub struct Note {
    /// Where it stands first.
    pub place: Place,
    /// The element, with the attribute if that alone is meant.
    pub what: String,
    /// What became of it and why.
    pub why: String,
    /// How often.
    pub count: usize,
}

impl core::fmt::Display for Note {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Self { place, what, why, count } = self;
        match count {
            1 => write!(f, "{place}: {what}: {why}"),
            _ => write!(f, "{place} and {} more: {what}: {why}", count - 1),
        }
    }
}

/// A robot that was read from a file.
///
/// **What is read.** URDF: links, inertials, joints but `planar` and `spherical` ones, limits, damping, collision shapes;
/// a joint's largest effort makes a [`Torque`](crate::Torque) of the joint's name. MJCF: `compiler`, `default` classes,
/// `include`, bodies and `frame`s, inertials or the geoms' inertias, hinges, slides and free joints with range, damping,
/// armature and `ref`, geoms, contact pairs with exclusions and surfaces as they are at rest, motors, position and velocity
/// actuators on joints (also as `general`). Names that the format does not know are errors, with the nearest that it does.
/// What a description has no place for is listed in [`Reading::notes`], or an error where leaving it out would make
/// another robot: ball joints, `attach`, `replicate`, `composite`, `flexcomp`.
///
/// **Rules of translation.**
/// - *Several joints of a MuJoCo body* make segments between them, called after body and joint, each with a small share of
///   the body's mass ([`ReadOptions::between`]): a description has one joint a segment, and all that moves has a mass.
/// - *A joint off its body's origin*: the segment's frame is at the joint; [`Reading::frames`] says where the body's is.
/// - *Fixed links* stay segments. Only if a moving one has no mass itself it takes over that of the links fixed to it.
/// - *Several bodies in the world* are one description; a URDF has one root.
/// - *Shapes that we lack*: a cylinder becomes the capsule of its radius and length, or a ball of its radius if it is
///   flatter than that; an ellipsoid the capsule along its longest axis with the radius of the next. In a URDF a cylinder
///   with equal spheres at its ends is a capsule, as [`Robot::to_urdf`] writes it. Masses are those of the true shapes.
/// - *Meshes* (STL, OBJ) become the smallest by volume of a ball, a capsule and a box that hold all their points, the
///   latter two along the mesh's own axes or the principal axes of its surface; meshes that can touch nothing are left out.
/// - *Contacts of MuJoCo* are springs and dampers here: stiffness and damping are those at rest at full impedance.
/// - *Commands* are efforts and joint positions; MuJoCo's, before its gears, are other numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// The robot; valid.
    pub robot: Robot,
    /// Where the file's links or bodies are in it, in the file's order.
    pub frames: Vec<Frame>,
    /// What was left out or replaced, in alphabetical order.
    pub notes: Vec<Note>,
}

impl Reading {
    /// Reads a URDF or MJCF file; which of them it is its root element says.
    ///
    /// # Errors
    /// What is wrong, with the line: see [`ReadError`].
    pub fn of_file(path: &Path, options: &ReadOptions) -> Result<Self, ReadError> {
        let mut files = ModelFiles::new(path.parent(), options)?;
        let text = files.model(path)?;
        Self::read(&path.display().to_string(), &text, files, options)
    }

    /// Reads the text of a URDF or MJCF; without [`ReadOptions::root`] it must name no files.
    ///
    /// ```
    /// use farsa_body::{Reading, ReadOptions};
    ///
    /// let text = r#"<mujoco><worldbody><body name="rod" pos="0 0 1">
    ///     <joint name="hinge" axis="0 1 0" range="-90 90"/><geom type="capsule" fromto="0 0 0 0 0 -0.5" size="0.01"/>
    /// </body></worldbody></mujoco>"#;
    /// let reading = Reading::of_text(text, &ReadOptions::default())?;
    /// assert_eq!(reading.robot.joint("hinge").map(|joint| joint.index()), Some(0));
    ///
    /// let error = Reading::of_text(&text.replace("axis", "axes"), &ReadOptions::default()).unwrap_err();
    /// assert_eq!(error.to_string(), "text line 2: unknown attribute of joint `axes`; the nearest is `axis`");
    /// # Ok::<(), farsa_body::ReadError>(())
    /// ```
    ///
    /// # Errors
    /// What is wrong, with the line: see [`ReadError`].
    pub fn of_text(text: &str, options: &ReadOptions) -> Result<Self, ReadError> {
        Self::read("text", text, ModelFiles::new(None, options)?, options)
    }

    fn read(file: &str, text: &str, files: ModelFiles, options: &ReadOptions) -> Result<Self, ReadError> {
        let mut reader = Reader { files, options, notes: Notes::default(), elements: 0 };
        let tree = Tree::parse(file, text, &mut reader)?;
        let root = tree.root();
        let (robot, frames) = match root.tag() {
            "robot" => read_urdf::read(&tree, &mut reader)?,
            "mujoco" => read_mjcf::read(&tree, &mut reader)?,
            _ => return Err(root.unknown("root of a model", root.tag(), ["robot", "mujoco"])),
        };
        robot.validate().map_err(|error| ReadError::Robot { file: file.into(), error })?;
        Ok(Self { robot, frames, notes: reader.notes.list() })
    }

    /// Where the link or body of this name in the file is.
    pub fn frame(&self, name: &str) -> Option<&Frame> {
        self.frames.iter().find(|frame| frame.name == name)
    }
}

/// What both readers carry along.
pub(crate) struct Reader<'o> {
    pub(crate) files: ModelFiles,
    pub(crate) options: &'o ReadOptions,
    pub(crate) notes: Notes,
    /// Elements met so far.
    pub(crate) elements: usize,
}

/// Notes, equal ones counted.
#[derive(Default)]
pub(crate) struct Notes {
    all: BTreeMap<(String, String), (Place, usize)>,
}

impl Notes {
    pub(crate) fn add(&mut self, place: Place, what: impl Into<String>, why: impl Into<String>) {
        self.all.entry((what.into(), why.into())).or_insert((place, 0)).1 += 1;
    }

    fn list(self) -> Vec<Note> {
        let note = |((what, why), (place, count))| Note { place, what, why, count };
        self.all.into_iter().map(note).collect()
    }
}
