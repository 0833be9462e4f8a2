//! Meshes of a model's file for pages. They are stored with the text of a run, next to the model.

use std::path::Path;

use farsa_body::ports::BodyId;
use farsa_body::robot::Robot;
use farsa_models::{DrawnMesh, Imported, ReadOptions};
use farsa_view::shape::{SceneMesh, screen_color};

/// Returns the name of the text with the meshes of a model.
pub(crate) fn text_name(model: &str) -> String {
    format!("{model}.meshes")
}

/// Returns the text with the meshes of a model, or `None` without any.
///
/// A model that cannot be read has none, because its fault is reported when the robot is built.
pub(crate) fn text_of(model: &Path, options: &ReadOptions) -> Option<String> {
    let Imported { meshes, .. } = Imported::from_file(model, options).ok()?;
    let meshes: Vec<SceneMesh> = meshes.iter().filter_map(scene_mesh).collect();
    (!meshes.is_empty()).then(|| SceneMesh::text(&meshes))
}

/// Converts a mesh for pages, or returns `None` if it is too large for them.
fn scene_mesh(mesh: &DrawnMesh) -> Option<SceneMesh> {
    let DrawnMesh { body, collider, points, triangles, color } = mesh;
    let mut made = SceneMesh::new(*body, points, triangles).ok()?;
    (made.collider, made.color) = (*collider, color.map(screen_color));
    Some(made)
}

/// Reads the meshes of a robot from their text.
pub(crate) fn read(text: &str, robot: &Robot) -> Result<Vec<SceneMesh>, String> {
    let meshes = SceneMesh::from_text(text).map_err(|error| error.to_string())?;
    for mesh in &meshes {
        let body = mesh.body.map(BodyId::index).filter(|body| *body >= robot.segments.len());
        let collider = mesh.collider.filter(|collider| *collider >= robot.colliders.len());
        if let Some(absent) = body.or(collider) {
            return Err(format!("a mesh is on the absent body or collider {absent}"));
        }
    }
    Ok(meshes)
}
