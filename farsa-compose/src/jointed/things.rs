//! Objects of the scene.

use farsa_body::Pose;
use farsa_body::ports::BodyId;
use farsa_body::robot::{Collider, Joint, MassProperties, Robot, Segment, Shape};
use farsa_lab::Error;
use farsa_num::{Scalar, sin_cos};
use farsa_view::shape::{Geometry, Role, SceneObject, screen_color};

use crate::check::source::Source;
use crate::document::{self, Object};

/// A named thing.
#[derive(Clone, Debug)]
pub(crate) struct Thing {
    pub(crate) name: String,
    pub(crate) what: What,
    /// Greatest distance of the surface from the center [m].
    pub(crate) reach: f64,
    /// Coefficient of friction with other things.
    pub(crate) friction: f64,
    /// Mass, 0 for fixed things [kg].
    pub(crate) mass: f64,
    /// Collider of the thing.
    pub(crate) collider: Option<usize>,
}

/// Kind of a thing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum What {
    /// A movable body.
    Body(BodyId),
    /// A marker, by number.
    Marker(usize),
    /// A fixed obstacle.
    Wall,
}

/// A visible place without contacts.
#[derive(Clone, Debug)]
pub(crate) struct Marker {
    pub(crate) name: String,
    pub(crate) radius: f64,
    pub(crate) color: [f64; 3],
    /// Initial position [m].
    pub(crate) at: [f64; 3],
}

/// Reads a point whose height is optional.
fn in_space(at: Option<&[f64]>, height: f64) -> [f64; 3] {
    match at {
        Some(&[x, y, z]) => [x, y, z],
        Some(&[x, y]) => [x, y, height],
        _ => [0.0, 0.0, height],
    }
}

impl Thing {
    /// Adds an object of the document to a scene.
    pub(crate) fn add(
        object: &Object,
        robot: &mut Robot,
        markers: &mut Vec<Marker>,
        drawn: &mut Vec<SceneObject>,
        (path, source): (&str, &Source),
    ) -> Result<Self, Error> {
        let Object { name, at, heading, shape, .. } = object;
        let (sine, cosine) = sin_cos(0.5 * heading.to_radians());
        // Without a height in the document, a thing rests on the plane z = 0.
        let pose = |height| Pose { position: in_space(at.as_deref(), height), rotation: [0.0, 0.0, sine, cosine] };
        let mut moving = |shape: Shape, geometry: Geometry, inertia: MassProperties, pose, color| {
            let body = robot.add_segment(Segment::new(name, None, Joint::floating(pose), inertia));
            let collider =
                robot.add_collider(Collider::new(name, Some(body), shape, Pose::identity()).with_color(color));
            let object = SceneObject::new(name, geometry, Pose::identity(), Role::Object);
            drawn.push(object.on_body(body).with_color(screen_color(color)));
            (What::Body(body), Some(collider))
        };
        let (reach, friction, mass, (what, collider)) = match *shape {
            Some(document::Shape::Ball { radius, mass, friction, color }) => {
                let inertia = MassProperties::sphere(mass, radius);
                let made = moving(Shape::Sphere { radius }, Geometry::Sphere { radius }, inertia, pose(radius), color);
                (radius, friction, mass, made)
            }
            Some(document::Shape::Block { size, mass, friction, color }) => {
                let half = size.map(|x| 0.5 * x);
                let inertia = MassProperties::cuboid(mass, half);
                let made = moving(Shape::Box { half }, Geometry::Box { half }, inertia, pose(half[2]), color);
                // The corners of a box are its points farthest from the center.
                (length(half), friction, mass, made)
            }
            Some(document::Shape::Wall { size: [along, across], height, color }) => {
                let (half, pose) = ([0.5 * along, 0.5 * across, 0.5 * height], pose(0.5 * height));
                let collider =
                    robot.add_collider(Collider::new(name, None, Shape::Box { half }, pose).with_color(color));
                let object = SceneObject::new(name, Geometry::Box { half }, pose, Role::Ground);
                drawn.push(object.with_color(screen_color(color)));
                (length(half), 0.0, 0.0, (What::Wall, Some(collider)))
            }
            Some(document::Shape::Marker { radius, color }) => {
                markers.push(Marker { name: name.clone(), radius, color, at: in_space(at.as_deref(), 0.0) });
                (0.0, 0.0, 0.0, (What::Marker(markers.len() - 1), None))
            }
            Some(
                document::Shape::Cylinder { .. } | document::Shape::Disc { .. } | document::Shape::Rectangle { .. },
            )
            | None => {
                let why = "is for robots on wheels; next to one with joints are walls, blocks, balls and markers";
                return Err(source.wrong(path, why));
            }
        };
        Ok(Self { name: name.clone(), what, reach, friction, mass, collider })
    }
}

fn length([x, y, z]: [f64; 3]) -> f64 {
    Scalar::sqrt(x * x + y * y + z * z)
}
