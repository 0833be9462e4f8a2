//! Reflection of parts in the plane y = 0. It converts a right arm to a left arm.
//!
//! The x and z axes of a frame are reflected, and the y axis is reflected and inverted, so that the frame remains
//! right-handed. Coordinates are subtracted from 0 and not negated, so that no negative zeros occur.

use crate::pose::Pose;
use crate::robot::mass_properties::MassProperties;

/// The image of a point or a length along the axes [m].
pub(crate) fn point([x, y, z]: [f64; 3]) -> [f64; 3] {
    [x, 0.0 - y, z]
}

/// The image of an axis of turning: the image turns about it by the same angle.
pub(crate) fn axis([x, y, z]: [f64; 3]) -> [f64; 3] {
    [0.0 - x, y, 0.0 - z]
}

/// The image of a frame.
pub(crate) fn pose(pose: Pose<f64>) -> Pose<f64> {
    let [x, y, z, w] = pose.rotation;
    Pose { position: point(pose.position), rotation: [-x, y, -z, w] }
}

/// The image of a body.
pub(crate) fn body(body: MassProperties) -> MassProperties {
    let [xx, yy, zz, xy, xz, yz] = body.inertia;
    MassProperties { mass: body.mass, centre: point(body.centre), inertia: [xx, yy, zz, -xy, xz, -yz] }
}
