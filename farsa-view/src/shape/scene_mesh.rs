//! Triangle meshes of pages, and their text.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use farsa_body::ports::BodyId;
use serde_json::{Value, json};

use crate::error::Error;
use crate::shape::appearance::Color;
use crate::shape::vector::Vector;

/// Largest coordinate of a stored point.
const COUNTS: f64 = 32767.0;

/// A triangle mesh that pages draw instead of colliders. Pictures draw the colliders.
///
/// Points are stored with 16 bits for each coordinate, relative to the box around the mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneMesh {
    /// Body with which the mesh moves. Use `None` for a fixed mesh.
    pub body: Option<BodyId>,
    /// Index of the collider that the mesh replaces. `None` replaces all colliders of the body.
    pub collider: Option<usize>,
    /// Color of the mesh. If this is `None`, the color of its body is used.
    pub color: Option<Color>,
    /// Center of the box around the mesh, in the frame of the body or in the world [m].
    pub centre: Vector,
    /// Half the edge lengths of this box [m].
    half: Vector,
    points: Vec<[i16; 3]>,
    triangles: Vec<[u16; 3]>,
}

impl SceneMesh {
    /// Creates a mesh from points in the frame of its body [m] and the indices of the corners of triangles.
    ///
    /// # Errors
    /// Returns [`Error::Mesh`] if there is no triangle, an absent point, one above the 65536th or an infinite number.
    pub fn new(body: Option<BodyId>, points: &[Vector], triangles: &[[usize; 3]]) -> Result<Self, Error> {
        let end = |sign: f64| [0, 1, 2].map(|k| points.iter().map(|p| sign * p[k]).fold(f64::NEG_INFINITY, f64::max));
        let (low, high) = (end(-1.0).map(|x| -x), end(1.0));
        let centre = [0, 1, 2].map(|k| f64::midpoint(low[k], high[k]));
        let half = [0, 1, 2].map(|k| (high[k] - low[k]) / 2.0);
        let count = |x: f64, half: f64| if half > 0.0 { (x / half * COUNTS).round() as i16 } else { 0 };
        let stored = points.iter().map(|p| [0, 1, 2].map(|k| count(p[k] - centre[k], half[k])));
        let corner = |i: usize| u16::try_from(i).map_err(|_| Error::Mesh(format!("has no point {i}")));
        let corners = triangles.iter().flatten().map(|i| corner(*i)).collect::<Result<Vec<_>, _>>()?;
        let (triangles, _) = corners.as_chunks::<3>();
        let mesh = Self {
            body,
            collider: None,
            color: None,
            centre,
            half,
            points: stored.collect(),
            triangles: triangles.into(),
        };
        mesh.checked()
    }

    /// Replaces only this collider.
    pub fn instead_of(self, collider: usize) -> Self {
        Self { collider: Some(collider), ..self }
    }

    /// Sets the color.
    pub fn with_color(self, color: Color) -> Self {
        Self { color: Some(color), ..self }
    }

    /// Half the edge lengths of the box around the mesh [m].
    pub(crate) fn half(&self) -> Vector {
        self.half
    }

    /// Checks if pages draw the mesh instead of a collider.
    pub(crate) fn replaces(&self, collider: usize, body: Option<BodyId>) -> bool {
        self.collider.map_or(body.is_some() && body == self.body, |index| index == collider)
    }

    fn checked(self) -> Result<Self, Error> {
        let wrong = |why: &str| Err(Error::Mesh(why.into()));
        let sizes = self.half.iter().all(|x| *x >= 0.0) && self.half.iter().chain(&self.centre).all(|x| x.abs() < 1e9);
        if self.triangles.is_empty() || !sizes {
            return wrong("has no triangle or an invalid size");
        }
        match self.triangles.iter().flatten().find(|i| usize::from(**i) >= self.points.len()) {
            Some(absent) => wrong(&format!("has no point {absent}")),
            None => Ok(self),
        }
    }

    /// Returns points and triangles for a page, each as base64.
    pub(crate) fn data(&self) -> Value {
        let points: Vec<u8> = self.points.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        let corners: Vec<u8> = self.triangles.iter().flatten().flat_map(|i| i.to_le_bytes()).collect();
        json!({"points": STANDARD.encode(points), "triangles": STANDARD.encode(corners)})
    }

    /// Writes meshes as a text that [`SceneMesh::from_text`] reads.
    pub fn text(meshes: &[Self]) -> String {
        let one = |mesh: &Self| {
            let mut value = mesh.data();
            value["body"] = json!(mesh.body.map(BodyId::index));
            value["collider"] = json!(mesh.collider);
            value["color"] = json!(mesh.color);
            value["centre"] = json!(mesh.centre);
            value["half"] = json!(mesh.half);
            value
        };
        meshes.iter().map(one).collect::<Value>().to_string()
    }

    /// Reads meshes from the text of [`SceneMesh::text`].
    ///
    /// # Errors
    /// Returns [`Error::NotJson`] for another text, and [`Error::Mesh`] for meshes that no page can draw.
    pub fn from_text(text: &str) -> Result<Vec<Self>, Error> {
        let values: Vec<Value> = serde_json::from_str(text).map_err(|error| Error::NotJson(error.to_string()))?;
        values
            .iter()
            .map(|value| {
                Self::from_value(value)
                    .ok_or_else(|| Error::Mesh("lacks a key or has an invalid one".into()))?
                    .checked()
            })
            .collect()
    }

    fn from_value(value: &Value) -> Option<Self> {
        let number = |key: &str| match &value[key] {
            Value::Null => Some(None),
            number => number.as_u64().map(Some),
        };
        let vector = |key: &str| match value[key].as_array()?.as_slice() {
            [x, y, z] => Some([x.as_f64()?, y.as_f64()?, z.as_f64()?]),
            _ => None,
        };
        let words = |key: &str| -> Option<Vec<[u16; 3]>> {
            let bytes = STANDARD.decode(value[key].as_str()?).ok()?;
            let (points, rest) = bytes.as_chunks::<6>();
            let word = |six: &[u8; 6]| [0, 2, 4].map(|k| u16::from_le_bytes([six[k], six[k + 1]]));
            rest.is_empty().then(|| points.iter().map(word).collect())
        };
        let color = || {
            let shades: Vec<u8> = vector("color")?.into_iter().filter_map(|x| u8::try_from(x as i64).ok()).collect();
            shades.try_into().ok()
        };
        Some(Self {
            body: number("body")?.map(|body| u16::try_from(body).map(BodyId)).transpose().ok()?,
            collider: number("collider")?.map(usize::try_from).transpose().ok()?,
            color: if value["color"].is_null() { None } else { Some(color()?) },
            centre: vector("centre")?,
            half: vector("half")?,
            points: words("points")?.into_iter().map(|point| point.map(u16::cast_signed)).collect(),
            triangles: words("triangles")?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tetrahedron() -> SceneMesh {
        let points = [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 2.0, 1.0], [0.0, 0.0, 4.0]];
        SceneMesh::new(Some(BodyId(3)), &points, &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]).unwrap()
    }

    #[test]
    fn texts_are_read_back() {
        let meshes = [tetrahedron().instead_of(7).with_color([1, 2, 255]), SceneMesh { body: None, ..tetrahedron() }];
        assert_eq!(SceneMesh::from_text(&SceneMesh::text(&meshes)).unwrap(), meshes);
        assert_eq!((meshes[0].centre, meshes[0].half), ([0.5, 1.0, 2.5], [0.5, 1.0, 1.5]));
        assert_eq!(meshes[0].points[3], [-32767, -32767, 32767]);
        assert!(meshes[0].replaces(7, None) && !meshes[0].replaces(6, Some(BodyId(3))));
        assert!(tetrahedron().replaces(6, Some(BodyId(3))) && !meshes[1].replaces(6, None));
    }

    #[test]
    fn meshes_that_no_page_can_draw_are_refused() {
        let flat = SceneMesh::new(None, &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &[[0, 1, 2]]).unwrap();
        assert_eq!(flat.half, [0.5, 0.5, 0.0]);
        for (points, triangles) in [
            (vec![[0.0; 3]; 3], vec![[0, 1, 3]]),
            (vec![[0.0; 3]; 3], vec![]),
            (vec![[f64::NAN; 3]; 3], vec![[0, 1, 2]]),
            (vec![[0.0; 3], [1e300, 0.0, 0.0], [0.0; 3]], vec![[0, 1, 2]]),
            (vec![[0.0; 3]; 3], vec![[0, 1, 1 << 16]]),
        ] {
            assert!(matches!(SceneMesh::new(None, &points, &triangles), Err(Error::Mesh(_))), "{points:?}");
        }
        let text = SceneMesh::text(&[tetrahedron()]);
        assert!(matches!(SceneMesh::from_text("{"), Err(Error::NotJson(_))));
        for (from, to) in [
            ("\"body\":3", "\"body\":70000"),
            ("\"body\":3", "\"body\":-1"),
            ("\"collider\":null", "\"collider\":1.5"),
            ("\"color\":null", "\"color\":[300,0,0]"),
            ("\"half\"", "\"other\""),
            ("AAAC", "//8C"),
            ("1.5]", "-1.5]"),
            ("1.5]", "1.5,1]"),
        ] {
            assert!(text.contains(from), "{from} {text}");
            assert!(matches!(SceneMesh::from_text(&text.replace(from, to)), Err(Error::Mesh(_))), "{from}");
        }
    }
}
