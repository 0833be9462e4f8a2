//! A robot together with objects that only a general world can have.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use farsa_body::Pose;
use farsa_body::ports::{BodyId, PairId};
use farsa_body::robot::{Robot, RobotError, Shape};
use rapier3d::geometry::{SharedShape, TriMeshFlags};
use rapier3d::math::{Pose as Frame, Vector};
use rapier3d::parry::utils::Array2;

use crate::rapier::convert::{shape_of, upright};
use crate::rapier::error::RapierError;

/// The geometry of an object, in its own frame.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub enum Geometry {
    /// A sphere, capsule, box or plane. Robots can have these shapes, too.
    Simple(Shape),
    /// A cylinder about the z axis.
    Cylinder {
        /// Radius [m].
        radius: f64,
        /// Half its length [m].
        half_length: f64,
    },
    /// Convex hull of a set of points [m].
    Hull(Vec<[f32; 3]>),
    /// A surface made of triangles, which cannot move. Note that only its outside can be touched.
    Mesh {
        /// Vertices [m].
        vertices: Vec<[f32; 3]>,
        /// Indices of the vertices of each triangle, counter-clockwise as seen from outside.
        triangles: Vec<[u32; 3]>,
    },
    /// A landscape over a rectangle that is centered at the origin. It cannot move.
    HeightField {
        /// Heights above z = 0 [rows * columns. M]: row after row towards +y, in a row towards +x.
        heights: Vec<f32>,
        /// Number of rows and columns.
        size: [usize; 2],
        /// Extent along x and y [m].
        extent: [f64; 2],
    },
}

/// An object that is added to the scene next to the robot.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct SceneObject {
    /// Name of the object, which must be unique in the scene.
    pub name: String,
    /// Geometry of the object.
    pub geometry: Geometry,
    /// Initial pose in the frame of the world.
    pub placement: Pose<f64>,
    /// Mass [kg], which is distributed evenly. If this is `None`, the object does not move.
    pub mass: Option<f64>,
    /// Coefficient of sliding friction between the object and the robot. For two objects, the geometric mean of their
    /// coefficients is used.
    pub friction: f64,
}

impl SceneObject {
    /// Creates an object that can move. Its coefficient of friction is 0.5.
    pub fn movable(name: &str, geometry: Geometry, placement: Pose<f64>, mass: f64) -> Self {
        Self { name: name.into(), geometry, placement, mass: Some(mass), friction: 0.5 }
    }

    /// Creates an object that does not move. Its coefficient of friction is 0.5.
    pub fn fixed(name: &str, geometry: Geometry, placement: Pose<f64>) -> Self {
        Self { name: name.into(), geometry, placement, mass: None, friction: 0.5 }
    }
}

/// A robot and the objects around it.
///
/// The robot's colliders touch each other according to its pairs. An object touches all of them and all other objects,
/// except that two fixed parts do not touch. Bodies and pairs of objects are numbered after the robot's own.
#[derive(Clone, Debug, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Scene {
    /// Description of the robot.
    pub robot: Robot,
    /// All objects in the scene.
    pub objects: Vec<SceneObject>,
}

/// One of the two sides of a pair: a collider of the robot or an object, by its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    Collider(usize),
    SceneObject(usize),
}

impl Scene {
    /// Creates a scene that contains only a robot.
    pub fn new(robot: Robot) -> Self {
        Self { robot, objects: Vec::new() }
    }

    /// Adds an object and returns its body.
    pub fn add(&mut self, object: SceneObject) -> BodyId {
        self.objects.push(object);
        BodyId((self.robot.segments.len() + self.objects.len() - 1) as u16)
    }

    /// Finds the body of the segment or object with this name.
    pub fn body(&self, name: &str) -> Option<BodyId> {
        let object = || self.objects.iter().position(|object| object.name == name);
        self.robot.body(name).or_else(|| Some(BodyId((self.robot.segments.len() + object()?) as u16)))
    }

    /// Finds the pair of two colliders or objects with these names. Their order does not matter.
    pub fn pair(&self, a: &str, b: &str) -> Option<PairId> {
        let side = |name: &str| {
            let object = self.objects.iter().position(|object| object.name == name).map(Side::SceneObject);
            object.or_else(|| self.robot.collider(name).map(Side::Collider))
        };
        let (a, b) = (side(a)?, side(b)?);
        let position = self.sides().position(|pair| pair == [a, b] || pair == [b, a]);
        position.map(|number| PairId(number as u16))
    }

    /// Both sides of every pair, the robot's own first.
    pub(crate) fn sides(&self) -> impl Iterator<Item = [Side; 2]> {
        let robot = &self.robot;
        let rides = |collider: usize| robot.colliders.get(collider).is_some_and(|c| robot_moves(robot, c.body));
        let pairs = robot.pairs.iter().map(|pair| pair.colliders.map(Side::Collider));
        let others = self.objects.iter().enumerate().flat_map(move |(number, object)| {
            let moves = object.mass.is_some();
            let colliders = (0..robot.colliders.len()).filter(move |c| moves || rides(*c)).map(Side::Collider);
            let objects =
                (0..number).filter(move |other| moves || self.objects[*other].mass.is_some()).map(Side::SceneObject);
            colliders.chain(objects).map(move |other| [Side::SceneObject(number), other])
        });
        pairs.chain(others)
    }

    /// Looks whether objects can be built. The robot is looked at in other places.
    pub(crate) fn check(&self) -> Result<(), RapierError> {
        for (number, object) in self.objects.iter().enumerate() {
            let taken = self.objects[..number].iter().any(|other| other.name == object.name)
                || self.robot.segments.iter().any(|segment| segment.name == object.name)
                || self.robot.colliders.iter().any(|collider| collider.name == object.name);
            if taken {
                return Err(RobotError::Name { name: object.name.clone() }.into());
            }
            object.check()?;
        }
        Ok(())
    }
}

/// Returns whether a body of the robot moves.
fn robot_moves(robot: &Robot, mut body: Option<BodyId>) -> bool {
    while let Some(segment) = body.and_then(|body| robot.segments.get(body.index())) {
        if segment.joint.kind != farsa_body::robot::JointKind::Fixed {
            return true;
        }
        body = segment.parent;
    }
    false
}

impl SceneObject {
    fn fault(&self, why: String) -> RapierError {
        RapierError::SceneObject { name: self.name.clone(), why }
    }

    fn check(&self) -> Result<(), RapierError> {
        let value = |field: &'static str, value: f64, good: bool| {
            if good { Ok(()) } else { Err(self.fault(format!("{field} is {value}"))) }
        };
        let positive = |field, x: f64| value(field, x, (1e-6..=1e6).contains(&x));
        for x in self.placement.position {
            value("position", x, x.is_finite() && x.abs() <= 1e6)?;
        }
        let length: f64 = self.placement.rotation.iter().map(|x| x * x).sum();
        value("length of the rotation's quaternion, squared", length, (length - 1.0).abs() < 1e-6)?;
        value("friction", self.friction, (0.0..=1e6).contains(&self.friction))?;
        if let Some(mass) = self.mass {
            positive("mass", mass)?;
        }
        let points = |points: &[[f32; 3]]| {
            let far = points.iter().flatten().find(|x| !(x.is_finite() && x.abs() <= 1e6));
            far.map_or(Ok(()), |x| value("coordinate of a point", f64::from(*x), false))
        };
        let still = |geometry: &'static str| match self.mass {
            Some(_) => Err(self.fault(format!("a {geometry} does not move, so it has no mass"))),
            None => Ok(()),
        };
        match &self.geometry {
            Geometry::Simple(Shape::Sphere { radius }) => positive("radius", *radius),
            Geometry::Simple(Shape::Capsule { radius, half_length }) => {
                positive("radius", *radius)?;
                value("half length", *half_length, (0.0..=1e6).contains(half_length))
            }
            Geometry::Simple(Shape::Box { half }) => half.iter().try_for_each(|x| positive("half edge", *x)),
            Geometry::Simple(Shape::Plane) => still("plane"),
            Geometry::Simple(Shape::Cylinder { radius, half_length }) | Geometry::Cylinder { radius, half_length } => {
                positive("radius", *radius)?;
                positive("half length", *half_length)
            }
            Geometry::Hull(corners) => points(corners),
            Geometry::Mesh { vertices, triangles } => {
                still("mesh")?;
                points(vertices)?;
                value("number of triangles", triangles.len() as f64, !triangles.is_empty())?;
                let count = vertices.len();
                let lost = |vertex: &u32| *vertex as usize >= count;
                for (number, triangle) in triangles.iter().enumerate() {
                    if let Some(vertex) = triangle.iter().find(|vertex| lost(vertex)) {
                        let last = count.saturating_sub(1);
                        let why = format!("triangle {number} has vertex {vertex}; the last of {count} is {last}");
                        return Err(self.fault(why));
                    }
                }
                Ok(())
            }
            Geometry::HeightField { heights, size, extent } => {
                still("height field")?;
                let [rows, columns] = *size;
                if rows < 2 || columns < 2 || rows.checked_mul(columns) != Some(heights.len()) {
                    let heights = heights.len();
                    let why =
                        format!("{heights} heights for {rows} rows of {columns}, of which there are at least two");
                    return Err(self.fault(why));
                }
                let far = heights.iter().find(|x| !(x.is_finite() && x.abs() <= 1e6));
                far.map_or(Ok(()), |x| value("height", f64::from(*x), false))?;
                extent.iter().try_for_each(|x| positive("extent", *x))
            }
        }
    }

    /// The geometry as rapier has it, and its frame in the object's.
    pub(crate) fn shape(&self) -> Result<(SharedShape, Frame), RapierError> {
        let unusable = |why: String| self.fault(why);
        Ok(match &self.geometry {
            Geometry::Simple(shape) => shape_of(shape),
            Geometry::Cylinder { radius, half_length } => {
                (SharedShape::cylinder(*half_length as f32, *radius as f32), upright())
            }
            Geometry::Hull(points) => {
                let points: Vec<Vector> = points.iter().map(|point| Vector::from(*point)).collect();
                let hull = (points.len() > 3).then(|| SharedShape::convex_hull(&points)).flatten();
                // A flat hull has no mass.
                let hull = hull.filter(|hull| hull.mass_properties(1.0).mass() > 0.0);
                let why = || unusable(format!("{} points span no solid", points.len()));
                (hull.ok_or_else(why)?, Frame::IDENTITY)
            }
            Geometry::Mesh { vertices, triangles } => {
                let vertices = vertices.iter().map(|vertex| Vector::from(*vertex)).collect();
                let flags = TriMeshFlags::FIX_INTERNAL_EDGES;
                let mesh = SharedShape::trimesh_with_flags(vertices, triangles.clone(), flags);
                (mesh.map_err(|error| unusable(format!("{error}")))?, Frame::IDENTITY)
            }
            Geometry::HeightField { heights, size: [rows, columns], extent: [x, y] } => {
                // Upright, rapier's rows run towards -y. Its grid lies column after column.
                let at = |row: usize, column: usize| heights[(rows - 1 - row) * columns + column];
                let data = (0..*columns).flat_map(|column| (0..*rows).map(move |row| at(row, column))).collect();
                let grid = Array2::new(*rows, *columns, data);
                (SharedShape::heightfield(grid, Vector::new(*x as f32, 1.0, *y as f32)), upright())
            }
        })
    }
}
