//! Things beside the robot, as parts of the scene.

use farsa_body::Pose;
use farsa_body::ports::BodyId;
use farsa_body::robot::{Collider, Joint, MassProperties, Robot, Segment, Shape};
use farsa_lab::Error;
use farsa_num::{Scalar, sin_cos};
use farsa_view::{Geometry, Role, SceneObject, screen_color};

use crate::check::places::Places;
use crate::document::{Object, ObjectKind};

/// A thing that a name means.
#[derive(Clone, Debug)]
pub(crate) struct Thing {
    pub(crate) name: String,
    pub(crate) what: What,
    /// How far its surface is from its middle at most [m].
    pub(crate) reach: f64,
    /// Coefficient of friction with what is no robot.
    pub(crate) friction: f64,
    /// Mass, or 0 of what does not move [kg].
    pub(crate) mass: f64,
    /// Its collider.
    pub(crate) collider: Option<usize>,
}

/// What a thing is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum What {
    /// A body that moves.
    Body(BodyId),
    /// A marker by its number.
    Marker(usize),
    /// Something that stands.
    Wall,
}

/// A place that is seen and touches nothing.
#[derive(Clone, Debug)]
pub(crate) struct Marker {
    pub(crate) name: String,
    pub(crate) radius: f64,
    pub(crate) color: [f64; 3],
    /// Where it is at first [m].
    pub(crate) at: [f64; 3],
}

/// A point of which the height may be left open.
fn in_space(at: Option<&[f64]>, height: f64) -> [f64; 3] {
    match at {
        Some(&[x, y, z]) => [x, y, z],
        Some(&[x, y]) => [x, y, height],
        _ => [0.0, 0.0, height],
    }
}

impl Thing {
    /// Adds an object of the document to a scene; walls in grey are drawn so.
    ///
    /// # Errors
    /// [`Error::Setting`] for what there is beside robots on wheels only.
    pub(crate) fn add(
        object: &Object,
        robot: &mut Robot,
        markers: &mut Vec<Marker>,
        drawn: &mut Vec<SceneObject>,
        (path, places): (&str, &Places),
    ) -> Result<Self, Error> {
        let Object { name, at, heading, kind } = object;
        let (sine, cosine) = sin_cos(0.5 * heading.to_radians());
        let pose = |height| Pose { position: in_space(at.as_deref(), height), rotation: [0.0, 0.0, sine, cosine] };
        let mut moving = |shape: Shape, geometry: Geometry, inertia: MassProperties, pose, color| {
            let body = robot.add_segment(Segment::new(name, None, Joint::floating(pose), inertia));
            let collider =
                robot.add_collider(Collider::new(name, Some(body), shape, Pose::identity()).with_color(color));
            let object = SceneObject::new(name, geometry, Pose::identity(), Role::Object);
            drawn.push(object.on_body(body).with_color(screen_color(color)));
            (What::Body(body), Some(collider))
        };
        let (reach, friction, mass, (what, collider)) = match *kind {
            ObjectKind::Ball { radius, mass, friction, color } => {
                let inertia = MassProperties::sphere(mass, radius);
                let made = moving(Shape::Sphere { radius }, Geometry::Sphere { radius }, inertia, pose(radius), color);
                (radius, friction, mass, made)
            }
            ObjectKind::Block { size, mass, friction, color } => {
                let half = size.map(|x| 0.5 * x);
                let inertia = MassProperties::cuboid(mass, half);
                let made = moving(Shape::Box { half }, Geometry::Box { half }, inertia, pose(half[2]), color);
                (length(half), friction, mass, made)
            }
            ObjectKind::Wall { size: [along, across], height, color } => {
                let (half, pose) = ([0.5 * along, 0.5 * across, 0.5 * height], pose(0.5 * height));
                let collider =
                    robot.add_collider(Collider::new(name, None, Shape::Box { half }, pose).with_color(color));
                let object = SceneObject::new(name, Geometry::Box { half }, pose, Role::Ground);
                drawn.push(object.with_color(screen_color(color)));
                (length(half), 0.0, 0.0, (What::Wall, Some(collider)))
            }
            ObjectKind::Marker { radius, color } => {
                markers.push(Marker { name: name.clone(), radius, color, at: in_space(at.as_deref(), 0.0) });
                (0.0, 0.0, 0.0, (What::Marker(markers.len() - 1), None))
            }
            ObjectKind::Cylinder { .. } | ObjectKind::Disc { .. } | ObjectKind::Rectangle { .. } => {
                let why = "is for robots on wheels; beside one with joints are walls, blocks, balls and markers";
                return Err(places.wrong(path, why));
            }
        };
        Ok(Self { name: name.clone(), what, reach, friction, mass, collider })
    }
}

fn length([x, y, z]: [f64; 3]) -> f64 {
    Scalar::sqrt(x * x + y * y + z * z)
}
