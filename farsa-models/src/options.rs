//! Options for reading models.

use std::path::PathBuf;

/// Limits on the size of a model, so that reading takes bounded time and memory.
///
/// You usually don't need to change these, unless your model is unusually large.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct Limits {
    /// Maximum size of a file [bytes].
    pub bytes: usize,
    /// Maximum size of all files together [bytes]. Note that a mesh of a URDF counts each time it is used.
    pub all_bytes: usize,
    /// Maximum number of elements in a model, including those of included files.
    ///
    /// If you write URDF with this crate, a segment with a capsule takes 12 elements, and any other shape takes 4. This
    /// means that a robot with more than 4000 segments may exceed the default.
    pub elements: usize,
    /// Maximum depth of nested elements. Since bodies of an MJCF are nested, this also limits the length of a chain.
    pub depth: usize,
    /// Maximum number of attributes of an element, and of namespaces in a model. All elements together may have eight
    /// each.
    pub attributes: usize,
    /// Maximum number of elements in the `default` classes of an MJCF.
    pub defaults: usize,
    /// Maximum number of geoms in an MJCF that may touch others. Reading compares each pair of them, so its time grows
    /// quadratically.
    pub contacts: usize,
    /// Maximum number of files to open, which includes the model itself, included files and meshes. Files of a URDF count
    /// at each use.
    pub files: usize,
}

impl Default for Limits {
    /// Creates the default limits.
    ///
    /// They allow 32 MiB for each file and 1 GiB in total. A model can have 100 000 elements, which may be nested 30
    /// 000 deep, with 64 attributes each, and 2000 files. There can be 1000 defaults, and 2000 geoms that may touch.
    /// This means that reading takes seconds, and a few hundred MiB of memory at most.
    fn default() -> Self {
        Self {
            bytes: 32 << 20,
            all_bytes: 1 << 30,
            elements: 100_000,
            depth: 30_000,
            attributes: 64,
            defaults: 1000,
            contacts: 2000,
            files: 2000,
        }
    }
}

/// Treatment of meshes that may touch something.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Meshes {
    /// Replaces each mesh by a ball, capsule or box around all its points, whichever has the least volume. See
    /// [`Imported`](crate::Imported).
    #[default]
    Fit,
    /// Leaves them out with a warning. This doesn't open their files.
    Leave,
}

/// Treatment of masses and inertias that are physically impossible. By default they are errors.
///
/// Note that the `compiler` element of MJCF has the same settings (`boundmass`, `boundinertia`, `balanceinertia`). These
/// are always respected, and also change fixed bodies.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct Repair {
    /// Minimum mass of moving bodies [kg].
    pub least_mass: f64,
    /// Minimum principal moment of inertia of moving bodies [kg m2].
    pub least_inertia: f64,
    /// If one moment exceeds the sum of the others, replaces all three by their mean.
    pub balance: bool,
}

/// Options for reading a model.
///
/// Use [`ReadOptions::default`] to read strictly.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct ReadOptions {
    /// Folder that must contain all files used by the model. If this is `None`, the folder of the model is used. Absolute
    /// paths and `file://` are allowed below it.
    pub root: Option<PathBuf>,
    /// Folders with packages, for paths like `package://name/...`. Each of them is searched for a folder `name`, and after
    /// them the folders from the model's up to the root.
    pub packages: Vec<PathBuf>,
    /// Lets the root of a URDF move freely instead of fixing it in the world. This has no effect on a root with the name
    /// `world`, which always is the world.
    pub floating: bool,
    /// Reads `velocity` of the limits of a URDF as the largest speeds of its joints. This is off by default, because many
    /// files have numbers that their authors never tested. 0 and numbers from 1000 are no limits.
    pub joint_speeds: bool,
    /// Reads cylinders as such. By default they become capsules, because cylinders can touch spheres, capsules and planes
    /// only.
    pub cylinders: bool,
    /// Treatment of meshes.
    pub meshes: Meshes,
    /// Treatment of impossible masses.
    pub repair: Repair,
    /// Fraction of mass and inertia for segments between the joints of a body. This only matters if a body has several
    /// joints.
    pub between: f64,
    /// Limits on the size of the model.
    pub limits: Limits,
}

impl Default for ReadOptions {
    fn default() -> Self {
        Self {
            root: None,
            packages: Vec::new(),
            floating: false,
            joint_speeds: false,
            cylinders: false,
            meshes: Meshes::Fit,
            repair: Repair::default(),
            between: 1e-3,
            limits: Limits::default(),
        }
    }
}
