//! Meshes with fewer triangles for drawing, by clusters of points on a grid.
//!
//! All points of a cell become one point, which minimizes the distances to the planes of the triangles around it
//! (Lindstrom 2000). Flat surfaces therefore remain flat, and edges remain sharp.

use std::collections::BTreeMap;

use crate::mesh::triangles::{Mesh, add, squares};
use crate::vector::{cross, dot, sub};

/// Most cells along the longest edge of a mesh.
const FINEST: usize = 256;
/// Weight that draws a point to the mean of its cell, relative to the planes.
const PULL: f64 = 1e-3;

/// Points of a cell and the planes of the triangles at them.
#[derive(Clone, Default)]
struct Cluster {
    sum: [f64; 3],
    count: f64,
    /// Sums of the products of normals [xx, yy, zz, xy, xz, yz] and of normals times offsets.
    products: [f64; 6],
    offsets: [f64; 3],
}

impl Mesh {
    /// Joins equal points and removes triangles without three different ones, or with an absent one.
    pub(crate) fn welded(&self) -> Self {
        let mut numbers: BTreeMap<[u64; 3], usize> = BTreeMap::new();
        let mut points = Vec::new();
        let mut number = |point: [f64; 3]| {
            // The sum makes 0 of -0.
            *numbers.entry(point.map(|x| (x + 0.0).to_bits())).or_insert_with(|| {
                points.push(point);
                points.len() - 1
            })
        };
        let present = self.triangles.iter().filter(|corners| corners.iter().all(|i| *i < self.points.len()));
        let triangles: Vec<_> = present.map(|corners| corners.map(|i| number(self.points[i]))).collect();
        Self { points, triangles: distinct(triangles) }
    }

    /// Returns a welded mesh with at most `most` triangles. Every point is in the cell of an original one.
    pub(crate) fn simplified(&self, most: usize) -> Self {
        let mesh = self.welded();
        if mesh.triangles.len() <= most {
            return mesh;
        }
        // A single cell has no triangle.
        let (mut coarse, mut fine) = (1, FINEST + 1);
        while fine - coarse > 1 {
            let cells = usize::midpoint(coarse, fine);
            let places = mesh.cells(cells);
            let triangles = mesh.triangles.iter().map(|corners| corners.map(|i| places[i])).collect();
            if distinct(triangles).len() <= most {
                coarse = cells;
            } else {
                fine = cells;
            }
        }
        mesh.clustered(coarse)
    }

    /// Returns the least corner and the length of a cell, with this number of cells along the longest edge.
    fn grid(&self, cells: usize) -> ([f64; 3], f64) {
        let mut ends = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for point in &self.points {
            ends = [[0, 1, 2].map(|k| ends[0][k].min(point[k])), [0, 1, 2].map(|k| ends[1][k].max(point[k]))];
        }
        let longest = (0..3).map(|k| ends[1][k] - ends[0][k]).fold(0.0, f64::max);
        (ends[0], longest / cells as f64)
    }

    /// Returns the cell of each point, numbered along z, y and x.
    fn cells(&self, cells: usize) -> Vec<usize> {
        let (low, size) = self.grid(cells);
        // The last cell contains the greatest coordinate.
        let along = |point: &[f64; 3], k: usize| (((point[k] - low[k]) / size) as usize).min(cells - 1);
        self.points.iter().map(|point| (along(point, 0) * cells + along(point, 1)) * cells + along(point, 2)).collect()
    }

    fn clustered(&self, cells: usize) -> Self {
        let (low, size) = self.grid(cells);
        let of_points = self.cells(cells);
        let mut places = of_points.clone();
        places.sort_unstable();
        places.dedup();
        let numbers: Vec<usize> = of_points.iter().map(|cell| places.binary_search(cell).unwrap_or(0)).collect();
        let middle = |place: usize| {
            let place = [place / (cells * cells), place / cells % cells, place % cells];
            [0, 1, 2].map(|k| low[k] + size * (place[k] as f64 + 0.5))
        };
        let mut clusters = vec![Cluster::default(); places.len()];
        for (point, number) in self.points.iter().zip(&numbers) {
            let cluster = &mut clusters[*number];
            cluster.sum = [0, 1, 2].map(|k| cluster.sum[k] + point[k]);
            cluster.count += 1.0;
        }
        let numbered: Vec<[usize; 3]> = self.triangles.iter().map(|corners| corners.map(|i| numbers[i])).collect();
        for (corners, numbers) in self.corners().zip(&numbered) {
            let [a, b, c] = corners;
            let normal = cross(sub(b, a), sub(c, a));
            for number in numbers {
                let offset = dot(normal, sub(a, middle(places[*number])));
                let cluster = &mut clusters[*number];
                cluster.products = add(cluster.products, squares(normal), 1.0);
                cluster.offsets = [0, 1, 2].map(|k| cluster.offsets[k] + offset * normal[k]);
            }
        }
        let points = clusters.iter().zip(&places).map(|(cluster, place)| cluster.point(middle(*place), size)).collect();
        Self { points, triangles: distinct(numbered) }.welded()
    }
}

impl Cluster {
    /// Computes the point of the cell around `middle` that is nearest to all planes.
    fn point(&self, middle: [f64; 3], size: f64) -> [f64; 3] {
        let mean = [0, 1, 2].map(|k| self.sum[k] / self.count - middle[k]);
        let [xx, yy, zz, xy, xz, yz] = self.products;
        let pull = PULL * (xx + yy + zz);
        let rows = [[xx + pull, xy, xz], [xy, yy + pull, yz], [xz, yz, zz + pull]];
        let right = [0, 1, 2].map(|k| self.offsets[k] + pull * mean[k]);
        // Cramer's rule, whose determinant is at least the cube of the pull.
        let crossed = [cross(rows[1], rows[2]), cross(rows[2], rows[0]), cross(rows[0], rows[1])];
        let determinant = dot(rows[0], crossed[0]);
        let best = [0, 1, 2].map(|k| {
            let solved = (0..3).map(|i| crossed[i][k] * right[i]).sum::<f64>() / determinant;
            if solved.is_finite() { solved } else { mean[k] }
        });
        [0, 1, 2].map(|k| middle[k] + best[k].clamp(-size / 2.0, size / 2.0))
    }
}

/// Removes triangles without three different points, and repetitions of a triangle.
fn distinct(mut triangles: Vec<[usize; 3]>) -> Vec<[usize; 3]> {
    triangles.retain(|[a, b, c]| a != b && b != c && c != a);
    for triangle in &mut triangles {
        let least = (0..3).fold(0, |least, k| if triangle[k] < triangle[least] { k } else { least });
        triangle.rotate_left(least);
    }
    triangles.sort_unstable();
    triangles.dedup();
    triangles
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::norm;
    use farsa_num::sin_cos;
    use proptest::prelude::*;

    /// A closed ellipsoid of half axes `half`.
    fn ellipsoid(half: [f64; 3], rings: usize) -> Mesh {
        let point = |i: usize, j: usize| {
            let (up, out) = sin_cos((i as f64 / rings as f64 - 0.5) * std::f64::consts::PI);
            let out = if i.is_multiple_of(rings) { 0.0 } else { out };
            let (s, c) = sin_cos(j as f64 / rings as f64 * std::f64::consts::TAU);
            [half[0] * out * c, half[1] * out * s, half[2] * up]
        };
        let mut mesh = Mesh::default();
        for (i, j) in (0..rings).flat_map(|i| (0..rings).map(move |j| (i, j))) {
            let first = mesh.points.len();
            mesh.points.extend([
                point(i, j),
                point(i, (j + 1) % rings),
                point(i + 1, (j + 1) % rings),
                point(i + 1, j),
            ]);
            mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        }
        mesh
    }

    /// A cube of edge 2 with `n` squares along each edge.
    fn cube(n: usize) -> Mesh {
        let mut mesh = Mesh::default();
        for (axis, side, i, j) in (0..3)
            .flat_map(|a| [-1.0, 1.0].map(|s| (a, s)))
            .flat_map(|(a, s)| (0..n * n).map(move |k| (a, s, k / n, k % n)))
        {
            let corner = |i: usize, j: usize| {
                let mut point = [side; 3];
                point[(axis + 1) % 3] = 2.0 * i as f64 / n as f64 - 1.0;
                point[(axis + 2) % 3] = 2.0 * j as f64 / n as f64 - 1.0;
                point
            };
            let first = mesh.points.len();
            mesh.points.extend([corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)]);
            let [b, d] = if side > 0.0 { [first + 1, first + 3] } else { [first + 3, first + 1] };
            mesh.triangles.extend([[first, b, first + 2], [first, first + 2, d]]);
        }
        mesh
    }

    /// Checks that every edge of a closed surface has as many triangles in one direction as in the other.
    fn is_closed(mesh: &Mesh) -> bool {
        let mut edges: BTreeMap<[usize; 2], i32> = BTreeMap::new();
        for [a, b, c] in &mesh.triangles {
            for [from, to] in [[a, b], [b, c], [c, a]] {
                *edges.entry([*from.min(to), *from.max(to)]).or_default() += if from < to { 1 } else { -1 };
            }
        }
        edges.values().all(|sum| *sum == 0)
    }

    #[test]
    fn small_meshes_are_only_welded() {
        let mesh = ellipsoid([1.0, 2.0, 3.0], 8);
        let simple = mesh.simplified(2 * 8 * 8);
        // The poles have no quadrilaterals.
        assert_eq!((simple.points.len(), simple.triangles.len()), (7 * 8 + 2, 2 * 8 * 8 - 16));
        assert!(is_closed(&simple));
        let broken = Mesh { points: vec![[0.0; 3]; 3], triangles: vec![[0, 1, 2], [0, 1, 7]] };
        assert_eq!(broken.simplified(10).triangles.len(), 0);
    }

    #[test]
    fn a_cube_keeps_its_corners_and_faces() {
        let simple = cube(40).simplified(500);
        assert!(simple.triangles.len() > 100 && simple.triangles.len() <= 500, "{}", simple.triangles.len());
        assert!(is_closed(&simple));
        for point in &simple.points {
            let off = point.iter().map(|x| (x.abs() - 1.0).abs()).fold(1.0, f64::min);
            assert!(off < 2e-3, "{point:?} is not on a face");
        }
        let corner = |point: &&[f64; 3]| point.iter().all(|x| (x.abs() - 1.0).abs() < 5e-3);
        assert_eq!(simple.points.iter().filter(corner).count(), 8);
    }

    #[test]
    fn a_ball_remains_round() {
        let simple = ellipsoid([1.0; 3], 100).simplified(2000);
        assert!(simple.triangles.len() > 1000 && simple.triangles.len() <= 2000);
        assert!(is_closed(&simple));
        assert!(simple.points.iter().all(|point| (norm(point) - 1.0).abs() < 0.01));
    }

    proptest! {
        #[test]
        fn points_are_in_cells_of_original_ones(
            points in prop::collection::vec(prop::array::uniform3(-1.0..1.0_f64), 3..120),
            picks in prop::collection::vec(prop::array::uniform3(0_usize..130), 1..300),
            flat in prop::array::uniform3(0.0..2.0_f64), most in 0_usize..100,
        ) {
            let points: Vec<[f64; 3]> = points.into_iter().map(|p| [0, 1, 2].map(|k| p[k] * flat[k])).collect();
            let mesh = Mesh { points, triangles: picks };
            let simple = mesh.simplified(most);
            prop_assert!(simple.triangles.len() <= most);
            prop_assert!(simple.triangles.iter().flatten().all(|i| *i < simple.points.len()));
            prop_assert_eq!(&simple, &mesh.simplified(most));
            for cells in [1, 3, 16] {
                let clustered = mesh.welded().clustered(cells);
                let (_, size) = mesh.welded().grid(cells);
                for point in &clustered.points {
                    // A naive search. Two points of a cell differ by at most its length along each axis.
                    let near = |p: &[f64; 3]| (0..3).all(|k| (p[k] - point[k]).abs() <= size * (1.0 + 1e-9) + 1e-12);
                    prop_assert!(mesh.points.iter().any(near), "{point:?}");
                }
            }
        }

        #[test]
        fn closed_surfaces_keep_their_bounds(half in prop::array::uniform3(0.5..2.0_f64), cells in 10_usize..20) {
            // No half is shorter than a cell. The triangles of a thin body would vanish over several cells of its length.
            let mesh = ellipsoid(half, 24).welded();
            let clustered = mesh.clustered(cells);
            let (_, size) = mesh.grid(cells);
            for k in 0..3 {
                let end = |mesh: &Mesh| mesh.points.iter().map(|p| p[k]).fold(f64::NEG_INFINITY, f64::max);
                // Cells whose triangles all vanish have no point.
                prop_assert!(end(&clustered) <= end(&mesh) + size && end(&clustered) >= end(&mesh) - 2.0 * size);
            }
        }
    }
}
