//! The mirror image of parts at the plane y = 0: of a right arm it makes a left one.
//!
//! A frame's image has the images of its x and z axes and the opposite of that of y, so that it stays right-handed.
//! Points and axes are taken from 0 instead of negated, so that no zero becomes a negative one.

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
