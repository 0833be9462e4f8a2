//! Collision meshes of a URDF, replaced by their shapes.

use farsa_body::robot::Visual;

use crate::context::Context;
use crate::error::ReadError;
use crate::urdf::geometry::{origin, solid};
use crate::urdf::write::shapes;
use crate::xml::merge::Changes;
use crate::xml::tree::Element;
use crate::xml::write::Lines;

/// Returns the changes that replace each mesh that may touch something, or `None` without one.
pub(crate) fn without_meshes(root: Element<'_>, context: &mut Context<'_>) -> Result<Option<Changes>, ReadError> {
    let mut changes = Changes::default();
    for collision in root.all("link").flat_map(|link| link.all("collision")) {
        let Some(geometry) = collision.one("geometry")? else { continue };
        if geometry.all("mesh").next().is_none() {
            continue;
        }
        let placement = origin(collision, context)?;
        let Some(solid) = solid(geometry, context)? else { continue };
        let (shape, inner, _) = solid.shape(context.options);
        let mut out = Lines::default();
        shapes(
            &mut out,
            &Visual::new(None, shape, placement.compose(&inner)),
            collision.attribute("name"),
            "collision",
        );
        changes.replaced.insert(collision.index(), out.text);
    }
    Ok(Some(changes).filter(|changes| !changes.replaced.is_empty()))
}
