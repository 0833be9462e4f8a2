//! Masses of meshes by MuJoCo's four rules.

use std::collections::BTreeMap;

use farsa_body::robot::MassProperties;

use crate::mesh::hull::hull;
use crate::mesh::triangles::{Mesh, add, squares};
use crate::vector::{cross, dot, norm, sub};

/// Least volume [m3] and area [m2], and least area of a triangle whose direction counts [m2], as in MuJoCo.
const LEAST: f64 = 1e-15;
const LEAST_FACE: f64 = 3.2e-8;

/// Attribute `inertia` of a mesh in an MJCF.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub(crate) enum MeshInertia {
    /// A sum over tetrahedra, none of them negative, from an apex within to each triangle. The apex is first the middle
    /// of the surface, then the center of mass found with it. The sum is exact for a solid that is visible from the apex
    /// in full, and too heavy for other meshes. It ignores the direction of triangles.
    #[default]
    Legacy,
    /// The solid within the triangles, which must be closed and seen counterclockwise from outside.
    Exact,
    /// The solid within the convex hull.
    Convex,
    /// The triangles alone, with the density of the solid taken per area [kg/m2]. MuJoCo gives them the middle of the
    /// surface as center.
    Shell,
}

impl MeshInertia {
    pub(crate) const WORDS: [&'static str; 4] = ["convex", "exact", "legacy", "shell"];

    pub(crate) fn from_word(word: Option<&str>) -> Self {
        match word {
            Some("convex") => Self::Convex,
            Some("exact") => Self::Exact,
            Some("shell") => Self::Shell,
            _ => Self::Legacy,
        }
    }
}

impl Mesh {
    /// Computes the mass properties of a mesh of density 1, or the reason why it has none. Points without triangles are
    /// those of their hull.
    pub(crate) fn mass(&self, rule: MeshInertia) -> Result<MassProperties, &'static str> {
        let hulled;
        let mesh = if rule == MeshInertia::Convex || self.triangles.is_empty() {
            hulled = Self { points: self.points.clone(), triangles: hull(&self.points)? };
            &hulled
        } else {
            self
        };
        if rule == MeshInertia::Exact && !mesh.is_oriented() {
            return Err("its triangles do not all face outwards, so that it has no exact mass");
        }
        let (area, middle) = mesh.middle();
        if area < LEAST {
            return Err("its surface is too small for a mass");
        }
        let (mass, centre, second) = if rule == MeshInertia::Shell {
            (area, middle, mesh.surface(middle))
        } else {
            let signed = rule != MeshInertia::Legacy;
            let (volume, moment, _) = mesh.moments(middle, signed);
            let centre = [0, 1, 2].map(|k| middle[k] + moment[k] / volume);
            let (volume, _, second) = mesh.moments(centre, signed);
            (volume, centre, second)
        };
        if mass.is_nan() || mass < LEAST {
            return Err(if mass < 0.0 {
                "its volume is negative, so its triangles face inwards"
            } else {
                "its volume is too small for a mass; inertia=\"shell\" gives it that of its surface"
            });
        }
        let [xx, yy, zz, xy, xz, yz] = second;
        let inertia = [yy + zz, xx + zz, xx + yy, -xy, -xz, -yz];
        let body = MassProperties { mass, centre, inertia };
        if body.is_physical(true) { Ok(body) } else { Err("its inertia is not that of a body") }
    }

    /// Area of the surface and its middle.
    fn middle(&self) -> (f64, [f64; 3]) {
        let (mut area, mut middle) = (0.0, [0.0; 3]);
        for [a, b, c] in self.corners() {
            let part = norm(&cross(sub(b, a), sub(c, a))) / 2.0;
            area += part;
            middle = [0, 1, 2].map(|k| middle[k] + part * (a[k] + b[k] + c[k]) / 3.0);
        }
        (area, middle.map(|x| if area > 0.0 { x / area } else { x }))
    }

    /// Computes the second moment of the surface about its middle [xx, yy, zz, xy, xz, yz, m4].
    pub(crate) fn surface_about_middle(&self) -> [f64; 6] {
        let (area, middle) = self.middle();
        if area > 0.0 { self.surface(middle) } else { [0.0; 6] }
    }

    fn surface(&self, about: [f64; 3]) -> [f64; 6] {
        self.corners().fold([0.0; 6], |sum, corners| {
            let [a, b, c] = corners.map(|corner| sub(corner, about));
            let part = norm(&cross(sub(b, a), sub(c, a))) / 24.0;
            [a, b, c, [0, 1, 2].map(|k| a[k] + b[k] + c[k])].iter().fold(sum, |sum, v| add(sum, squares(*v), part))
        })
    }

    /// Volume, its first and second moments [xx, yy, zz, xy, xz, yz] about an apex.
    fn moments(&self, apex: [f64; 3], signed: bool) -> (f64, [f64; 3], [f64; 6]) {
        let (mut volume, mut first, mut second) = (0.0, [0.0; 3], [0.0; 6]);
        for corners in self.corners() {
            let [a, b, c] = corners.map(|corner| sub(corner, apex));
            let part = dot(a, cross(b, c)) / 6.0;
            let part = if signed { part } else { part.abs() };
            volume += part;
            let sum = [0, 1, 2].map(|k| a[k] + b[k] + c[k]);
            first = [0, 1, 2].map(|k| first[k] + part * sum[k] / 4.0);
            // The integral of the products over a tetrahedron with one corner at the origin.
            second = [a, b, c, sum].iter().fold(second, |second, v| add(second, squares(*v), part / 20.0));
        }
        (volume, first, second)
    }

    /// Checks that no two triangles pass an edge in the same direction. Small triangles do not count.
    fn is_oriented(&self) -> bool {
        let mut numbers: BTreeMap<[u64; 3], usize> = BTreeMap::new();
        let mut edges = Vec::with_capacity(3 * self.triangles.len());
        for corners in self.corners() {
            let [a, b, c] = corners;
            if norm(&cross(sub(b, a), sub(c, a))) / 2.0 <= LEAST_FACE {
                continue;
            }
            let [a, b, c] = corners.map(|corner| {
                let next = numbers.len();
                // MuJoCo's points are `f32`.
                *numbers.entry(corner.map(|x| u64::from((x as f32 + 0.0).to_bits()))).or_insert(next)
            });
            edges.extend([[a, b], [b, c], [c, a]]);
        }
        edges.sort_unstable();
        edges.windows(2).all(|pair| pair[0] != pair[1])
    }
}
