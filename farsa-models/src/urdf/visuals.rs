//! Visuals of a URDF's links.

use std::collections::BTreeMap;

use farsa_body::Pose;
use farsa_body::ports::BodyId;
use farsa_body::robot::{Robot, Visual};

use crate::context::Context;
use crate::drawn::DrawnMesh;
use crate::error::ReadError;
use crate::mesh::triangles::Mesh;
use crate::options::Meshes;
use crate::urdf::geometry::{Placed, joined, origin, outward_mesh, solid};
use crate::xml::tree::Element;

/// The colors of the materials that have one, by name, red, green and blue [0..1].
pub(super) fn colors(model: Element<'_>) -> BTreeMap<&str, [f64; 3]> {
    model.all("material").filter_map(|material| Some((material.attribute("name")?, own_color(material)?))).collect()
}

fn own_color(material: Element<'_>) -> Option<[f64; 3]> {
    let [red, green, blue, _] = material.one("color").ok()??.array::<4>("rgba").ok()??;
    Some([red, green, blue].map(|shade| shade.clamp(0.0, 1.0)))
}

/// A collider of a mesh, with its element and the place of the mesh in its segment.
pub(super) struct MeshCollider<'t> {
    pub(super) element: Element<'t>,
    pub(super) collider: usize,
    pub(super) placement: Pose<f64>,
}

/// Look of a visual.
enum Look {
    Solid(Placed),
    Mesh(Mesh, Pose<f64>),
}

/// Adds the visuals of a link, or none of them if one cannot be read. Returns the meshes of a link with a mesh, for whose
/// other visuals there are also meshes.
///
/// A fault is a warning, because nothing depends on them.
pub(super) fn visuals(
    robot: &mut Robot,
    body: Option<BodyId>,
    link: Element<'_>,
    colors: &BTreeMap<&str, [f64; 3]>,
    context: &mut Context<'_>,
) -> Vec<DrawnMesh> {
    let mut meshes = Vec::new();
    let (mut solids, mut shades) = (Vec::new(), Vec::new());
    for visual in link.all("visual") {
        let material = visual.all("material").next();
        let named = || colors.get(material?.attribute("name")?).copied();
        let color = material.and_then(own_color).or_else(named);
        let has_mesh = visual.all("geometry").any(|geometry| geometry.all("mesh").next().is_some());
        let why = match looked(visual, context) {
            Ok(Some(Look::Solid(placed))) => {
                solids.push(placed);
                shades.push(color);
                continue;
            }
            Ok(Some(Look::Mesh(mesh, pose))) => {
                meshes.push(DrawnMesh { color, ..DrawnMesh::new(&mesh, &pose, body) });
                continue;
            }
            Ok(None) => "those of a link with a mesh are left out".into(),
            Err(error) if has_mesh => format!("those of a link with a mesh are left out: {error}"),
            Err(error) => format!("those of the link are left out: {error}"),
        };
        context.warnings.add(visual.place(), "visual", why);
        return Vec::new();
    }
    if !meshes.is_empty() {
        let others = solids.iter().zip(shades).map(|((_, solid, pose, _), color)| {
            let mesh = DrawnMesh::new(&solid.tessellated(), pose, body);
            DrawnMesh { color, ..mesh }
        });
        return meshes.into_iter().chain(others).collect();
    }
    // The color of the first of the three elements of a capsule counts.
    for (first, shape, placement) in joined(&solids, "visual", context) {
        let color = shades.get(first).copied().flatten();
        robot.add_visual(Visual { color, ..Visual::new(body, shape, placement) });
    }
    Vec::new()
}

/// Reads the meshes of colliders, which are drawn instead of the shapes fitted to them.
pub(super) fn collision_meshes(
    body: Option<BodyId>,
    touching: &[MeshCollider<'_>],
    context: &mut Context<'_>,
) -> Vec<DrawnMesh> {
    let mut meshes = Vec::new();
    for MeshCollider { element, collider, placement } in touching {
        match outward_mesh(*element, context) {
            Ok(mesh) => {
                let drawn = DrawnMesh::new(&mesh, placement, body);
                meshes.push(DrawnMesh { collider: Some(*collider), ..drawn });
            }
            Err(error) => context.warnings.add(element.place(), "drawn mesh", format!("left out: {error}")),
        }
    }
    meshes
}

/// Reads the look of a visual, or `None` for a mesh that is left out.
fn looked(visual: Element<'_>, context: &mut Context<'_>) -> Result<Option<Look>, ReadError> {
    let placement = origin(visual, context)?;
    let geometry = visual.one("geometry")?.ok_or_else(|| visual.missing("geometry"))?;
    if let Some(element) = geometry.all("mesh").next() {
        let read = context.options.meshes == Meshes::Fit;
        return read.then(|| Ok(Look::Mesh(outward_mesh(element, context)?, placement))).transpose();
    }
    let solid = solid(geometry, context)?;
    Ok(solid.map(|solid| Look::Solid((String::new(), solid, placement, visual.place()))))
}
