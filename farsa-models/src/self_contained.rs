//! A model as one text that names no other file.

use std::path::{Path, PathBuf};

use crate::context::Context;
use crate::error::ReadError;
use crate::files::ModelFiles;
use crate::mjcf;
use crate::options::ReadOptions;
use crate::urdf;
use crate::warnings::Warnings;
use crate::xml::merge::{Changes, merged};
use crate::xml::tree::Tree;

/// A model as a text that names no other file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SelfContained {
    /// The text.
    pub text: String,
    /// Files that were read for it, starting with that of the model. A change of one of them may change the text.
    pub files: Vec<PathBuf>,
}

/// Reads a URDF or MJCF and returns it as a text that [`Imported::from_text`](crate::Imported::from_text) reads without
/// any file.
///
/// Included files are in their places. Meshes that may touch something are replaced by the shapes that
/// [`Imported`](crate::Imported) fits to them, and the bodies of an MJCF have the inertias of their geoms. A model that
/// needs no other file keeps its text. Other meshes and textures are still named, since no reader of this crate opens them.
///
/// # Errors
/// Returns the fault and its line, see [`ReadError`].
pub fn self_contained(path: &Path, options: &ReadOptions) -> Result<SelfContained, ReadError> {
    let mut files = ModelFiles::new(path.parent(), options)?;
    let text = files.model(path)?;
    let mut context = Context { files, options, warnings: Warnings::default(), elements: 0 };
    let tree = Tree::parse(&path.display().to_string(), &text, &mut context)?;
    let root = tree.root();
    let changes = match root.tag() {
        "robot" => urdf::without_meshes(root, &mut context)?,
        "mujoco" => mjcf::without_meshes(root, &mut context)?,
        _ => return Err(root.unknown("root of a model", root.tag(), ["robot", "mujoco"])),
    };
    let text = match changes {
        Some(changes) => merged(root, &changes),
        None if tree.has_includes() => merged(root, &Changes::default()),
        None => text,
    };
    Ok(SelfContained { text, files: context.files.opened() })
}
