//! Triangles of primitives, for bodies that are drawn with meshes.

use farsa_body::robot::Shape;
use farsa_num::sin_cos;

use crate::mesh::solid::Solid;
use crate::mesh::triangles::Mesh;

/// Number of edges around an axis, and of rings of a quarter of a circle.
const AROUND: usize = 24;
const QUARTER: usize = 6;

impl Solid {
    /// Returns the triangles of a solid in its own frame, none for a plane and for a mesh.
    pub(crate) fn tessellated(&self) -> Mesh {
        match *self {
            Self::Native(Shape::Sphere { radius }) => around(&arc(radius, 0.0)),
            Self::Native(Shape::Capsule { radius, half_length }) => around(&arc(radius, half_length)),
            Self::Native(Shape::Box { half }) => cuboid(half),
            Self::Native(Shape::Cylinder { radius, half_length: z }) | Self::Cylinder { radius, half_length: z } => {
                around(&[[0.0, -z], [radius, -z], [radius, z], [0.0, z]])
            }
            Self::Ellipsoid(axes) => around(&arc(1.0, 0.0)).map(|point| [0, 1, 2].map(|k| point[k] * axes[k])),
            Self::Native(Shape::Plane) | Self::Mesh(_) => Mesh::default(),
        }
    }
}

/// Returns the profile of a capsule from its lower to its upper end, as distances from the axis and heights.
fn arc(radius: f64, half_length: f64) -> Vec<[f64; 2]> {
    let ring = |k: usize, end: f64| {
        let (sine, cosine) = sin_cos((k as f64 / QUARTER as f64 - 1.0) * std::f64::consts::FRAC_PI_2);
        // All points of a pole are equal.
        let cosine = if k == 0 { 0.0 } else { cosine };
        [radius * cosine, end * (half_length - radius * sine)]
    };
    let lower = (0..=QUARTER).map(|k| ring(k, -1.0));
    lower.chain((0..=QUARTER).rev().map(|k| ring(k, 1.0))).collect()
}

/// Turns a profile around the z axis.
fn around(profile: &[[f64; 2]]) -> Mesh {
    let mut mesh = Mesh::default();
    for [radius, z] in profile {
        mesh.points.extend((0..AROUND).map(|j| {
            let (sine, cosine) = sin_cos(j as f64 * (std::f64::consts::TAU / AROUND as f64));
            [radius * cosine, radius * sine, *z]
        }));
    }
    for (ring, j) in (1..profile.len()).flat_map(|ring| (0..AROUND).map(move |j| (ring, j))) {
        let number = |ring: usize, j: usize| ring * AROUND + j % AROUND;
        let [a, b] = [number(ring - 1, j), number(ring - 1, j + 1)];
        let [c, d] = [number(ring, j + 1), number(ring, j)];
        mesh.triangles.extend([[a, b, c], [a, c, d]]);
    }
    mesh
}

fn cuboid(half: [f64; 3]) -> Mesh {
    let sign = |i: usize, bit: usize| if i & bit == 0 { -1.0 } else { 1.0 };
    let points = (0..8).map(|i| [0, 1, 2].map(|k| half[k] * sign(i, 1 << k))).collect();
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    Mesh { points, triangles: faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::mass::MeshInertia;

    #[test]
    fn solids_keep_their_volume() {
        let density = 3.0;
        for solid in [
            Solid::Native(Shape::Sphere { radius: 0.5 }),
            Solid::Native(Shape::Capsule { radius: 0.2, half_length: 0.4 }),
            Solid::Native(Shape::Box { half: [0.1, 0.2, 0.3] }),
            Solid::Cylinder { radius: 0.3, half_length: 0.1 },
            Solid::Ellipsoid([0.1, 0.2, 0.4]),
        ] {
            // All faces look outward.
            let mesh = solid.tessellated().welded();
            let volume = mesh.mass(MeshInertia::Exact).expect("a closed surface").mass;
            let expected = solid.mass_properties(None, density).mass / density;
            assert!(volume > 0.95 * expected && volume <= expected * (1.0 + 1e-9), "{solid:?}: {volume} {expected}");
        }
        assert_eq!(Solid::Native(Shape::Plane).tessellated().triangles.len(), 0);
    }
}
