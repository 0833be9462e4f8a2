//! Steering away from seen objects, for controllers without evolution.

use crate::team::config::EYES;
use crate::team::eyes::eye_angles;

/// Where infrared channels look: how far to the left, and whether within 60 degrees of ahead.
pub(crate) fn eyes(robot: &farsa_body::robots::MobileRobot) -> [(f32, bool); EYES] {
    eye_angles(robot).map(|angle| {
        let (sine, cosine) = farsa_num::sin_cos(angle);
        (sine as f32, cosine > 0.49)
    })
}

/// The turn away from objects ahead \[0 right..1 left\], or `None` without any.
pub(crate) fn away(eyes: &[(f32, bool); EYES], x: &[f32]) -> Option<f32> {
    let ahead = || eyes.iter().zip(x).filter(|((_, ahead), x)| *ahead && **x > 0.0);
    let left: f32 = ahead().map(|((left, _), x)| left * x).sum();
    ahead().next().map(|_| if left > 0.0 { 0.0 } else { 1.0 })
}
