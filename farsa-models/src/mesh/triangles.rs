//! Triangle meshes: their files, the shape that holds one, its mass.

use farsa_body::Pose;
use farsa_body::robot::Shape;
use farsa_num::Scalar;

use crate::bounds::MAX_SIZE;
use crate::mesh::polygon;
use crate::mesh::principal_axes::principal_axes;
use crate::vector::{norm, sub};

/// No shape is thinner [m].
const THINNEST: f64 = 1e-6;

/// Points and the triangles between them.
#[derive(Clone, Debug, PartialEq, Default)]
pub(crate) struct Mesh {
    pub(crate) points: Vec<[f64; 3]>,
    pub(crate) triangles: Vec<[usize; 3]>,
}

impl Mesh {
    /// Reads STL, binary or text, or OBJ. The name's ending decides between them.
    pub(crate) fn parse(name: &str, bytes: &[u8]) -> Result<Self, String> {
        let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending).to_ascii_lowercase();
        let mesh = match ending.as_str() {
            "stl" => Self::from_stl(bytes)?,
            "obj" => Self::from_obj(bytes)?,
            _ => return Err("meshes are read from STL and OBJ only; leave meshes out, or convert it".into()),
        };
        if mesh.points.is_empty() {
            return Err("there is no point in it".into());
        }
        if mesh.points.iter().flatten().any(|x| x.is_nan() || x.abs() >= MAX_SIZE) {
            return Err(format!("a coordinate is no number below {MAX_SIZE:e}"));
        }
        Ok(mesh)
    }

    /// Reads a binary STL if its size is that of its count of triangles, else text if it begins with `solid`.
    fn from_stl(bytes: &[u8]) -> Result<Self, String> {
        let count = bytes.get(80..84).and_then(|four| Some(u32::from_le_bytes(four.try_into().ok()?) as usize));
        let room = bytes.len().saturating_sub(84) / 50;
        if count.is_some_and(|count| count == room && (bytes.len() - 84).is_multiple_of(50)) {
            return Ok(Self::from_binary_stl(bytes));
        }
        let begin = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes).trim_ascii_start();
        let solid = begin.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
        let text = if solid { core::str::from_utf8(begin).ok() } else { None };
        match (text, count) {
            (Some(text), _) => Self::from_text_stl(text),
            // Some programs append to the triangles.
            (None, Some(count)) if count <= room => Ok(Self::from_binary_stl(bytes)),
            _ if solid => Err("a binary STL shorter than it says".into()),
            _ => Err("no STL: neither `solid` nor a count of triangles".into()),
        }
    }

    fn from_binary_stl(bytes: &[u8]) -> Self {
        let mut mesh = Self::default();
        let count = bytes.get(80..84).and_then(|four| Some(u32::from_le_bytes(four.try_into().ok()?) as usize));
        for facet in bytes[84..].chunks_exact(50).take(count.unwrap_or(0)) {
            let mut corners = facet[12..48]
                .chunks_exact(4)
                .map(|four| f64::from(f32::from_le_bytes([four[0], four[1], four[2], four[3]])));
            let mut corner = || [(); 3].map(|()| corners.next().unwrap_or(f64::NAN));
            mesh.triangle([corner(), corner(), corner()]);
        }
        mesh
    }

    fn from_text_stl(text: &str) -> Result<Self, String> {
        let mut mesh = Self::default();
        let mut corners = Vec::new();
        for (i, line) in text.lines().enumerate() {
            let mut words = line.split_whitespace();
            while let Some(word) = words.next() {
                match word.to_ascii_lowercase().as_str() {
                    // A name follows.
                    "solid" | "endsolid" => break,
                    "vertex" => corners.push(point(words.by_ref(), i)?),
                    "endfacet" => match corners.as_slice() {
                        [a, b, c] => {
                            mesh.triangle([*a, *b, *c]);
                            corners.clear();
                        }
                        _ => return Err(format!("line {}: a facet of {} points", i + 1, corners.len())),
                    },
                    _ => {}
                }
            }
        }
        Ok(mesh)
    }

    fn triangle(&mut self, corners: [[f64; 3]; 3]) {
        let first = self.points.len();
        self.points.extend(corners);
        self.triangles.push([first, first + 1, first + 2]);
    }

    fn from_obj(bytes: &[u8]) -> Result<Self, String> {
        let mut mesh = Self::default();
        // Comments may be in any encoding.
        for (i, line) in bytes.split(|byte| *byte == b'\n').enumerate() {
            let Ok(line) = core::str::from_utf8(line) else { continue };
            let mut words = line.split_whitespace();
            match words.next() {
                Some("v") => mesh.points.push(point(words, i)?),
                Some("f") => {
                    let corner = |word: &str| {
                        let number = word.split('/').next().and_then(|number| number.parse::<i64>().ok());
                        let count = mesh.points.len();
                        // Negative ones count from the last point.
                        let index = match number? {
                            n if n < 0 => count.checked_sub(usize::try_from(n.unsigned_abs()).ok()?)?,
                            n => usize::try_from(n).ok()?.checked_sub(1)?,
                        };
                        (index < count).then_some(index)
                    };
                    let face: Option<Vec<usize>> = words.map(corner).collect();
                    let face = face.ok_or_else(|| format!("line {}: a face with a point that is not there", i + 1))?;
                    let triangles = polygon::triangles(&mesh.points, &face);
                    mesh.triangles.extend(
                        triangles.ok_or_else(|| format!("line {}: a concave face of more than 500 corners", i + 1))?,
                    );
                }
                _ => {}
            }
        }
        Ok(mesh)
    }

    /// Swaps two corners of every triangle, after a reflection.
    pub(crate) fn turned_inside_out(mut self) -> Self {
        self.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        self
    }

    /// Changes every point of the mesh.
    pub(crate) fn map(mut self, change: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        for point in &mut self.points {
            *point = change(*point);
        }
        self
    }

    /// Finds the smallest by volume of a ball, a capsule and a box around all points, and where it is.
    ///
    /// Capsule and box are along the mesh's own axes or the principal axes of its surface (of its points, if it has no
    /// triangles), the capsule along the longest edge of the box. Both have the center of the box, but the capsule's
    /// ends move inwards as far as the points permit. The first of equal ones wins: own axes, box.
    pub(crate) fn fitted(&self) -> (Shape, Pose<f64>) {
        let mut spread = self.surface_about_middle();
        if spread.iter().all(|x| *x == 0.0) {
            let n = self.points.len().max(1) as f64;
            let mean = self.points.iter().fold([0.0; 3], |sum, p| [0, 1, 2].map(|k| sum[k] + p[k] / n));
            spread = self.points.iter().fold([0.0; 6], |sum, point| add(sum, squares(sub(*point, mean)), 1.0 / n));
        }
        let aligned = self.fitted_along(Pose::identity());
        let turned = self.fitted_along(Pose { position: [0.0; 3], rotation: principal_axes(spread).1 });
        let (_, shape, place) = if turned.0 < aligned.0 * (1.0 - 1e-9) { turned } else { aligned };
        (shape, place)
    }

    /// The smallest shape along the axes of a frame, and its volume.
    fn fitted_along(&self, frame: Pose<f64>) -> (f64, Shape, Pose<f64>) {
        let points: Vec<[f64; 3]> = self.points.iter().map(|point| frame.transform_back(*point)).collect();
        let (low, high) = points.iter().fold(([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]), |(low, high), p| {
            ([0, 1, 2].map(|k| low[k].min(p[k])), [0, 1, 2].map(|k| high[k].max(p[k])))
        });
        let middle = [0, 1, 2].map(|k| f64::midpoint(low[k], high[k]));
        let half = [0, 1, 2].map(|k| ((high[k] - low[k]) / 2.0).max(THINNEST));
        let points: Vec<[f64; 3]> = points.iter().map(|point| sub(*point, middle)).collect();
        let centred = frame.compose(&Pose::at(middle));

        let mut best = (8.0 * half[0] * half[1] * half[2], Shape::Box { half }, centred);
        let radius = points.iter().map(|point| norm(point)).fold(THINNEST, f64::max);
        let third = 4.0 / 3.0 * std::f64::consts::PI;
        let volume = third * radius * radius * radius;
        if volume < best.0 {
            best = (volume, Shape::Sphere { radius }, centred);
        }
        let long = (0..3).fold(0, |long, k| if half[k] > half[long] { k } else { long });
        let across = |p: &[f64; 3]| p[(long + 1) % 3] * p[(long + 1) % 3] + p[(long + 2) % 3] * p[(long + 2) % 3];
        let square = points.iter().map(across).fold(THINNEST * THINNEST, f64::max);
        let reach = |p: &[f64; 3]| Scalar::sqrt(square - across(p));
        let top = points.iter().map(|p| p[long] - reach(p)).fold(f64::NEG_INFINITY, f64::max);
        let bottom = points.iter().map(|p| p[long] + reach(p)).fold(f64::INFINITY, f64::min);
        let (radius, half_length) = (Scalar::sqrt(square), ((top - bottom) / 2.0).max(0.0));
        let volume = std::f64::consts::PI * square * 2.0 * half_length + third * square * radius;
        // A capsule of no length is a ball.
        if volume < best.0 * (1.0 - 1e-9) {
            let mut at = [0.0; 3];
            at[long] = f64::midpoint(top, bottom);
            let place = centred.compose(&Pose { position: at, rotation: z_to_axis(long) });
            best = (volume, Shape::Capsule { radius, half_length }, place);
        }
        best
    }

    pub(crate) fn corners(&self) -> impl Iterator<Item = [[f64; 3]; 3]> + '_ {
        self.triangles.iter().map(|corners| corners.map(|i| self.points.get(i).copied().unwrap_or_default()))
    }
}

/// Computes the rotation that takes z to an axis, and the axes after z to those after it.
pub(crate) fn z_to_axis(axis: usize) -> [f64; 4] {
    [[0.5, 0.5, 0.5, 0.5], [-0.5, -0.5, -0.5, 0.5], [0.0, 0.0, 0.0, 1.0]][axis]
}

/// Computes the products of a vector's parts [xx, yy, zz, xy, xz, yz].
pub(crate) fn squares([x, y, z]: [f64; 3]) -> [f64; 6] {
    [x * x, y * y, z * z, x * y, x * z, y * z]
}

pub(crate) fn add(mut sum: [f64; 6], more: [f64; 6], by: f64) -> [f64; 6] {
    for (to, from) in sum.iter_mut().zip(more) {
        *to += by * from;
    }
    sum
}

fn point<'a>(mut words: impl Iterator<Item = &'a str>, line: usize) -> Result<[f64; 3], String> {
    let mut number = || words.next().and_then(|word| word.parse::<f64>().ok());
    match (number(), number(), number()) {
        (Some(x), Some(y), Some(z)) => Ok([x, y, z]),
        _ => Err(format!("line {}: a point without three numbers", line + 1)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::mass::MeshInertia;
    use crate::mesh::solid::scaled;
    use farsa_body::robot::MassProperties;
    use proptest::prelude::*;
    use std::fmt::Write as _;

    /// A box as a closed mesh, as an OBJ with one square a face.
    fn cuboid([a, b, c]: [f64; 3]) -> Mesh {
        let mut text = String::new();
        for i in 0..8 {
            let sign = |bit: i32| if i & bit == 0 { -1.0 } else { 1.0 };
            writeln!(text, "v {} {} {}", a * sign(1), b * sign(2), c * sign(4)).expect("a string");
        }
        text += "f 1 3 4 2\nf 5/1 6/1 8/1 7/1\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf -7 -5 -1 -3\n";
        Mesh::parse("a.OBJ", text.as_bytes()).expect("an OBJ")
    }

    fn binary(mesh: &Mesh) -> Vec<u8> {
        let mut bytes = vec![0; 80];
        bytes.extend((mesh.triangles.len() as u32).to_le_bytes());
        for triangle in &mesh.triangles {
            bytes.extend([0; 12]);
            for corner in triangle.map(|i| mesh.points[i]).iter().flatten() {
                bytes.extend((*corner as f32).to_le_bytes());
            }
            bytes.extend([0; 2]);
        }
        bytes
    }

    #[test]
    fn a_box_is_a_box_in_every_format() {
        let half = [0.25, 0.5, 0.125];
        let mesh = cuboid(half);
        let ours = MassProperties::cuboid(2000.0 * 8.0 * half[0] * half[1] * half[2], half);
        let mut text = String::from("solid box\n");
        for triangle in &mesh.triangles {
            text += "facet normal 0 0 0\nouter loop\n";
            for [x, y, z] in triangle.map(|i| mesh.points[i]) {
                writeln!(text, " vertex {x} {y} {z:e}").expect("a string");
            }
            text += "endloop\nendfacet\n";
        }
        let shift = [1.0, -2.0, 3.0];
        // The size decides, not the header.
        let mut headed = binary(&mesh);
        headed[..22].copy_from_slice(b"solid facet of a part\n");
        let stl = |bytes: &[u8]| Mesh::parse("b.STL", bytes).expect("an STL");
        for mesh in [
            mesh.clone(),
            Mesh::parse("b.stl", &binary(&mesh)).expect("an STL"),
            stl(&headed),
            stl(&[&binary(&mesh)[..], b"a remark"].concat()),
            stl(text.as_bytes()),
            stl(format!("\u{feff} \r\n{}", text.to_uppercase().replace('\n', "\r\n")).as_bytes()),
            stl(text.replace("\n ", " ").replace("\nendloop\n", " endloop ").as_bytes()),
        ] {
            let solid = mesh.clone().map(|p| [0, 1, 2].map(|k| p[k] + shift[k])).mass(MeshInertia::Legacy);
            let solid = scaled(&solid.expect("a volume"), 2000.0);
            assert!((solid.mass - ours.mass).abs() < 1e-12 * ours.mass, "{solid:?}");
            assert!(
                (0..6).all(|k| (solid.inertia[k] - ours.inertia[k]).abs() < 1e-11 * ours.mass),
                "{solid:?} {ours:?}"
            );
            assert!((0..3).all(|k| (solid.centre[k] - shift[k]).abs() < 1e-14));
            let (shape, place) = mesh.fitted();
            let Shape::Box { half: found } = shape else { panic!("{shape:?}") };
            let mut lengths = [found[0], found[1], found[2]];
            lengths.sort_by(f64::total_cmp);
            assert!((0..3).all(|k| (lengths[k] - [0.125, 0.25, 0.5][k]).abs() < 1e-12), "{lengths:?}");
            assert!(norm(&place.position) < 1e-12);
        }
    }

    #[test]
    fn round_things_are_round() {
        let mut ball = Mesh::default();
        let mut rod = Mesh::default();
        for i in 0..60 {
            for j in 0..=30 {
                let (s, c) = farsa_num::sin_cos(f64::from(i) / 60.0 * std::f64::consts::TAU);
                let (up, out) = farsa_num::sin_cos((f64::from(j) / 30.0 - 0.5) * std::f64::consts::PI);
                ball.points.push([0.1 * out * c + 1.0, 0.1 * out * s, 0.1 * up]);
                let end = if j < 15 { -0.3 } else { 0.3 };
                // Along x.
                rod.points.push([0.1 * up + end, 0.1 * out * c, 0.1 * out * s]);
            }
        }
        let (Shape::Sphere { radius }, place) = ball.fitted() else { panic!("{:?}", ball.fitted()) };
        assert!((radius - 0.1).abs() < 1e-3 && (place.position[0] - 1.0).abs() < 1e-12);
        let (Shape::Capsule { radius, half_length }, place) = rod.fitted() else { panic!("{:?}", rod.fitted()) };
        assert!((radius - 0.1).abs() < 1e-3 && (half_length - 0.3).abs() < 2e-3, "{radius} {half_length}");
        assert!((place.rotate([0.0, 0.0, 1.0])[0].abs() - 1.0).abs() < 1e-9);
    }

    #[test]
    fn what_is_no_mesh_is_refused() {
        for (name, bytes) in [
            ("a.stl", &b""[..]),
            ("a.stl", b"solid\nendsolid"),
            ("a.stl", b"solid\nfacet\nvertex 1 2\n"),
            ("a.stl", b"solid\nfacet\nvertex 1 2 3\nendfacet"),
            ("a.stl", b"solid\nvertex 1 2 inf\nvertex 1 2 3\nvertex 1 2 3\nendfacet"),
            ("a.stl", b"no stl"),
            ("a.stl", &[255; 84]),
            ("a.obj", b"f 1 2 3"),
            ("a.obj", b"v 1 2 3\nf 1 2 3"),
            ("a.obj", b"v 1 2 x"),
            ("a.dae", b"<COLLADA/>"),
            ("a", b""),
        ] {
            assert!(Mesh::parse(name, bytes).is_err(), "{name}");
        }
        assert!(Mesh { points: vec![[1.0; 3]], triangles: vec![[0, 0, 0]] }.mass(MeshInertia::Legacy).is_err());
        let (shape, _) = Mesh { points: vec![[1.0; 3]], triangles: vec![] }.fitted();
        assert!(matches!(shape, Shape::Sphere { .. } | Shape::Capsule { .. }), "{shape:?}");
    }

    proptest! {
        #[test]
        fn all_points_are_inside(points in prop::collection::vec(prop::array::uniform3(-1.0..1.0_f64), 1..40), flat in prop::array::uniform3(0.0..2.0_f64)) {
            let mesh = Mesh { points, triangles: vec![] }.map(|p| [0, 1, 2].map(|k| p[k] * flat[k]));
            let (shape, place) = mesh.fitted();
            for point in &mesh.points {
                let [x, y, z] = place.transform_back(*point);
                let out = match shape {
                    Shape::Sphere { radius } => norm(&[x, y, z]) - radius,
                    Shape::Capsule { radius, half_length } => norm(&[x, y, (z.abs() - half_length).max(0.0)]) - radius,
                    Shape::Box { half } => (x.abs() - half[0]).max(y.abs() - half[1]).max(z.abs() - half[2]),
                    Shape::Cylinder { .. } | Shape::Plane => unreachable!(),
                };
                prop_assert!(out < 1e-9, "{shape:?} {out}");
            }
        }

        #[test]
        fn any_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..300), solid in any::<bool>()) {
            let bytes = if solid { [&b"solid "[..], &bytes].concat() } else { bytes };
            let _ = Mesh::parse("a.stl", &bytes);
            let _ = Mesh::parse("a.obj", &bytes);
        }
    }
}
