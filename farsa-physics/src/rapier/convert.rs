//! Vectors, frames and shapes as rapier has them.

use farsa_body::robot::Shape;
use rapier3d::geometry::SharedShape;
use rapier3d::math::{Pose as Frame, Rotation, Vector};

use crate::articulated::model::Mount;
use crate::articulated::view::quaternion;

pub(crate) fn vector(v: [f64; 3]) -> Vector {
    v.map(|x| x as f32).into()
}

/// A frame as rapier has it.
pub(crate) fn pose(mount: &Mount<f64>) -> Frame {
    let q = quaternion(&mount.rotation).map(|x| x as f32);
    Frame::from_parts(vector(mount.position), Rotation::from_array(q).normalize())
}

/// A shape and its frame in that of the description's.
pub(crate) fn shape_of(shape: &Shape) -> (SharedShape, Frame) {
    let shape = match *shape {
        Shape::Cylinder { radius, half_length } => {
            return (SharedShape::cylinder(half_length as f32, radius as f32), upright());
        }
        Shape::Sphere { radius } => SharedShape::ball(radius as f32),
        Shape::Capsule { radius, half_length } => SharedShape::capsule_z(half_length as f32, radius as f32),
        Shape::Box { half } => {
            let [x, y, z] = half.map(|a| a as f32);
            SharedShape::cuboid(x, y, z)
        }
        Shape::Plane => SharedShape::halfspace(Vector::Z),
    };
    (shape, Frame::IDENTITY)
}

/// The frame of rapier's cylinders and height fields, which are upright along y.
pub(crate) fn upright() -> Frame {
    let quarter = core::f32::consts::FRAC_1_SQRT_2;
    Frame::from_rotation(Rotation::from_xyzw(quarter, 0.0, 0.0, quarter))
}
