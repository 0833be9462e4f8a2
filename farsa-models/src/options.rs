//! Options of readers.

use std::path::PathBuf;

/// The largest size of a model, so that reading takes bounded time and memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct Limits {
    /// Bytes of a file.
    pub bytes: usize,
    /// Bytes of all files, a mesh of a URDF counted each time that it is used.
    pub all_bytes: usize,
    /// Elements of a model with its included files. Our URDF has 12 for a segment with a capsule and 4 for another
    /// shape. A robot of more than 4000 segments may therefore exceed it.
    pub elements: usize,
    /// Nested elements. Bodies of an MJCF are within their carriers, so that depth equals the length of a chain.
    pub depth: usize,
    /// Attributes of an element, and name spaces of a model. All elements together may have eight each.
    pub attributes: usize,
    /// Elements in the `default` classes of an MJCF.
    pub defaults: usize,
    /// Geoms of an MJCF that may touch others, each of which is compared with each.
    pub contacts: usize,
    /// Files that are opened: the model, included ones and meshes. Files of a URDF count at each use.
    pub files: usize,
}

impl Default for Limits {
    /// 32 MiB a file and 1 GiB in all, 100 000 elements 30 000 deep with 64 attributes each, 2000 files. 1000 defaults,
    /// 2000 geoms that may touch. A few hundred MiB of memory at most, and seconds.
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

/// The treatment of meshes that may touch something.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Meshes {
    /// Each becomes the smallest by volume of the ball, capsule and box that hold all its points. See
    /// [`Imported`](crate::Imported).
    #[default]
    Fit,
    /// They are left out, without looking at their files, and noted.
    Leave,
}

/// The treatment of masses that no body can have. By default they are errors.
///
/// MJCF's `compiler` has the same settings (`boundmass`, `boundinertia`, `balanceinertia`), which are obeyed there anyway.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct Repair {
    /// Least mass of what moves [kg].
    pub least_mass: f64,
    /// Least principal moment of inertia of what moves [kg m2].
    pub least_inertia: f64,
    /// Gives moments of which one exceeds the sum of the others their mean.
    pub balance: bool,
}

/// The options of a reader. [`ReadOptions::default`] reads strictly.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct ReadOptions {
    /// The folder that all files that the model names must lie in, or `None` for the folder of the model itself.
    pub root: Option<PathBuf>,
    /// Folders that hold packages, for `package://name/...`: each is looked in for a folder `name`.
    pub packages: Vec<PathBuf>,
    /// True if a URDF's root moves freely instead of standing fixed in the world. One called `world` is the world
    /// anyway.
    pub floating: bool,
    /// The treatment of meshes.
    pub meshes: Meshes,
    /// The treatment of impossible masses.
    pub repair: Repair,
    /// The share of a body's mass and inertia that each of the segments between its joints gets, where it has several.
    pub between: f64,
    /// The largest size of the model.
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
