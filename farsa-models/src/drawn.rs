//! Meshes that views draw.

use farsa_body::Pose;
use farsa_body::ports::BodyId;

use crate::mesh::hull::hull;
use crate::mesh::triangles::Mesh;

/// Most triangles of a mesh and of a robot.
const MAX_OF_MESH: usize = 2000;
const MAX_OF_ROBOT: usize = 20_000;

/// A mesh that views draw. It has no contacts and no mass.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct DrawnMesh {
    /// Segment to which the mesh is attached, or `None` for the world.
    pub body: Option<BodyId>,
    /// Index of the collider that the mesh replaces, or `None` for a visual, which replaces all colliders of its segment.
    pub collider: Option<usize>,
    /// Points in the frame of the segment or the world [m].
    pub points: Vec<[f64; 3]>,
    /// Corners of each triangle as indices of points, counterclockwise from outside.
    pub triangles: Vec<[usize; 3]>,
    /// Red, green and blue components of the color (between 0 and 1), if the file has one.
    pub color: Option<[f64; 3]>,
}

impl DrawnMesh {
    /// Creates the visual of a mesh at a pose in the frame of its segment. Points without triangles become their hull.
    pub(crate) fn new(mesh: &Mesh, pose: &Pose<f64>, body: Option<BodyId>) -> Self {
        let simple = simplified(mesh);
        let points = simple.points.iter().map(|point| pose.transform(*point)).collect();
        Self { body, collider: None, points, triangles: simple.triangles, color: None }
    }
}

/// Returns a mesh with few triangles.
pub(crate) fn simplified(mesh: &Mesh) -> Mesh {
    if mesh.triangles.is_empty() {
        let triangles = hull(&mesh.points).unwrap_or_default();
        return Mesh { points: mesh.points.clone(), triangles }.simplified(MAX_OF_MESH);
    }
    mesh.simplified(MAX_OF_MESH)
}

/// Simplifies the largest meshes further until the robot has few triangles, and removes empty meshes.
pub(crate) fn bounded(mut meshes: Vec<DrawnMesh>) -> Vec<DrawnMesh> {
    let mut order: Vec<usize> = (0..meshes.len()).collect();
    order.sort_by_key(|i| meshes[*i].triangles.len());
    let mut room = MAX_OF_ROBOT;
    for (done, i) in order.iter().enumerate() {
        // Small meshes leave a part of their share to larger ones.
        let share = room / (order.len() - done);
        let DrawnMesh { points, triangles, .. } = &mut meshes[*i];
        if triangles.len() > share {
            let mesh = Mesh { points: std::mem::take(points), triangles: std::mem::take(triangles) };
            let mesh = mesh.simplified(share);
            (*points, *triangles) = (mesh.points, mesh.triangles);
        }
        room -= triangles.len();
    }
    meshes.retain(|mesh| !mesh.triangles.is_empty());
    meshes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::solid::Solid;
    use farsa_body::robot::Shape;

    #[test]
    fn large_meshes_share_the_room_that_small_ones_leave() {
        let ball = Solid::Native(Shape::Sphere { radius: 0.1 }).tessellated();
        let cube = Solid::Native(Shape::Box { half: [0.1; 3] }).tessellated();
        let of_ball = ball.welded().triangles.len();
        let drawn = |mesh: &Mesh| DrawnMesh::new(mesh, &Pose::at([0.0, 0.0, 1.0]), None);
        let count = MAX_OF_ROBOT / of_ball + 2;
        let meshes = bounded((0..count).flat_map(|_| [drawn(&ball), drawn(&cube)]).collect());
        let total: usize = meshes.iter().map(|mesh| mesh.triangles.len()).sum();
        assert!(total <= MAX_OF_ROBOT && total > MAX_OF_ROBOT / 2, "{total}");
        assert_eq!(meshes.iter().filter(|mesh| mesh.triangles.len() == 12).count(), count);
        assert!(meshes.iter().flat_map(|mesh| &mesh.points).all(|point| (point[2] - 1.0).abs() < 0.11));
        let few: usize = bounded(vec![drawn(&cube); MAX_OF_ROBOT]).iter().map(|mesh| mesh.triangles.len()).sum();
        assert!(few <= MAX_OF_ROBOT);
        assert_eq!(bounded(vec![drawn(&Mesh::default())]).len(), 0);
    }
}
