//! Meshes of an MJCF that views draw.

use std::collections::BTreeMap;

use farsa_body::Pose;
use farsa_body::ports::BodyId;
use farsa_body::robot::Robot;

use crate::context::Context;
use crate::drawn::{DrawnMesh, bounded, simplified};
use crate::error::SourceLocation;
use crate::mesh::triangles::Mesh;
use crate::mjcf::classes::Classed;
use crate::mjcf::compiler::Compiler;
use crate::mjcf::geoms::MeshAssets;
use crate::options::Meshes;
use crate::xml::tree::Element;

/// Last group that MuJoCo's viewer shows.
const LAST_SHOWN: f64 = 2.0;

/// A geom of a mesh with its place in the robot.
pub(crate) struct MeshGeom<'t> {
    element: Element<'t>,
    mesh: &'t str,
    body: Option<BodyId>,
    placement: Pose<f64>,
    /// Collider of the geom, unless it touches nothing.
    collider: Option<usize>,
    color: Option<[f64; 3]>,
}

impl<'t> MeshGeom<'t> {
    /// Gets the mesh of a geom in a group that is shown or with a collider, unless it is transparent. The frame of its
    /// body is at `frame` in the segment.
    pub(crate) fn new(
        (classed, compiler, model): (&Classed<'t, '_>, &Compiler, Element<'t>),
        (body, frame): (Option<BodyId>, &Pose<f64>),
        collider: Option<usize>,
    ) -> Option<Self> {
        let mesh = classed.text("mesh").filter(|_| classed.text("type") == Some("mesh"))?;
        let group = classed.number("group").ok()?.unwrap_or(0.0);
        if collider.is_none() && group > LAST_SHOWN {
            return None;
        }
        let own = compiler.pose(classed.source("pos"), classed.source_of(&super::compiler::ROTATIONS)).ok()?;
        let placement = frame.compose(&own);
        let rgba = rgba(classed, model);
        if rgba.is_some_and(|[.., alpha]| alpha <= 0.0) {
            return None;
        }
        let color = rgba.map(|[red, green, blue, _]| [red, green, blue].map(|shade| shade.clamp(0.0, 1.0)));
        Some(Self { element: classed.element, mesh, body, placement, collider, color })
    }

    /// Line of the geom.
    pub(crate) fn place(&self) -> SourceLocation {
        self.element.place()
    }
}

/// Gets the color of a geom or of its material, and how opaque it is.
fn rgba<'t>(classed: &Classed<'t, '_>, model: Element<'t>) -> Option<[f64; 4]> {
    let own = classed.list("rgba", 4, 4).ok()?;
    let of_material = || {
        let name = classed.text("material")?;
        let mut materials = model.all("asset").flat_map(|asset| asset.all("material"));
        materials.find(|material| material.attribute("name") == Some(name))?.list("rgba", 4, 4).ok()?
    };
    own.or_else(of_material)?.try_into().ok()
}

/// Reads the meshes that are drawn. A mesh of a collider is drawn only if its segment has no visual.
///
/// A fault is a warning, because nothing depends on them.
pub(crate) fn drawn<'t>(
    geoms: &[MeshGeom<'t>],
    robot: &Robot,
    (assets, compiler): (&MeshAssets<'t, '_>, &Compiler),
    context: &mut Context<'_>,
) -> Vec<DrawnMesh> {
    if context.options.meshes == Meshes::Leave {
        return Vec::new();
    }
    let mut loaded: BTreeMap<&str, Option<Mesh>> = BTreeMap::new();
    let mut meshes: Vec<DrawnMesh> = Vec::new();
    let (shown, touching): (Vec<_>, Vec<_>) = geoms.iter().partition(|geom| geom.collider.is_none());
    let visual = |body: Option<BodyId>| robot.visuals.iter().any(|visual| visual.body == body);
    for geom in shown.into_iter().chain(touching) {
        let covers = |mesh: &DrawnMesh| mesh.collider.is_none() && !mesh.triangles.is_empty();
        let covered = meshes.iter().any(|mesh| mesh.body == geom.body && covers(mesh));
        if geom.collider.is_some() && geom.body.is_some() && (covered || visual(geom.body)) {
            continue;
        }
        let mesh = loaded.entry(geom.mesh).or_insert_with(|| {
            let read = assets.read(geom.element, geom.mesh, compiler, context);
            let warn = |error| context.warnings.add(geom.place(), "drawn mesh", format!("left out: {error}"));
            read.map_err(warn).ok().map(|mesh| simplified(&mesh))
        });
        if let Some(mesh) = mesh {
            let drawn = DrawnMesh::new(mesh, &geom.placement, geom.body);
            meshes.push(DrawnMesh { collider: geom.collider, color: geom.color, ..drawn });
        }
    }
    bounded(meshes)
}
