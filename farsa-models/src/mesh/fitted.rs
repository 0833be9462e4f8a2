//! Primitives that MuJoCo fits to a mesh.

use farsa_body::Pose;
use farsa_body::robot::MassProperties;

use crate::mesh::principal_axes::sorted_axes;
use crate::mesh::triangles::Mesh;
use farsa_num::Scalar;

/// Boxes of a mesh along the principal axes of its mass, the longest along z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Boxes {
    /// Center of mass and principal axes.
    frame: Pose<f64>,
    /// Half edges of the solid box with the same moments [m].
    inertial: [f64; 3],
    /// Center and half edges of the box around all points, in that frame [m].
    around: [[f64; 3]; 2],
}

impl Boxes {
    /// Computes the boxes of a mesh whose mass has density 1.
    pub(crate) fn new(mesh: &Mesh, mass: &MassProperties) -> Self {
        let ([a, b, c], rotation) = sorted_axes(mass.inertia);
        // A box of mass m and half edges x, y, z has the moments m (y^2 + z^2) / 3 and so on.
        let edge = |square: f64| 0.5 * Scalar::sqrt((6.0 * square / mass.mass).max(0.0));
        let inertial = [edge(b + c - a), edge(a + c - b), edge(a + b - c)];
        let frame = Pose { position: mass.centre, rotation };
        let mut ends = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for point in &mesh.points {
            let point = frame.transform_back(*point);
            ends = [[0, 1, 2].map(|k| ends[0][k].min(point[k])), [0, 1, 2].map(|k| ends[1][k].max(point[k]))];
        }
        let [low, high] = ends;
        let around = [[0, 1, 2].map(|k| f64::midpoint(low[k], high[k])), [0, 1, 2].map(|k| (high[k] - low[k]) / 2.0)];
        Self { frame, inertial, around }
    }

    /// Returns the sizes of a kind of geom as an MJCF has them, and its place. `around` is the compiler's `fitaabb`.
    pub(crate) fn primitive(&self, kind: &str, around: bool, scale: f64) -> (Vec<f64>, Pose<f64>) {
        let (half, place) = if around {
            (self.around[1], self.frame.compose(&Pose::at(self.around[0])))
        } else {
            (self.inertial, self.frame)
        };
        let [x, y, z] = half;
        let sizes = match (kind, around) {
            ("sphere", false) => vec![(x + y + z) / 3.0],
            ("sphere", true) => vec![x.max(y).max(z)],
            ("capsule", false) => vec![f64::midpoint(x, y), (z - f64::midpoint(x, y) / 2.0).max(0.0)],
            ("capsule", true) => vec![x.max(y), z - x.max(y)],
            ("cylinder", false) => vec![f64::midpoint(x, y), z],
            ("cylinder", true) => vec![x.max(y), z],
            _ => vec![x, y, z],
        };
        (sizes.into_iter().map(|size| size * scale).collect(), place)
    }
}
