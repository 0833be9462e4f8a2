//! The planar arm of 12 joints, as the repertoire of arm configurations of pyribs has it.

use std::f64::consts::PI;

use farsa_num::sin_cos;

/// Joints, each with a link of length 1.
pub(crate) const JOINTS: usize = 12;

/// The range of each joint angle [rad].
pub(crate) const ANGLES: [f64; 2] = [-PI, PI];

/// The range of both coordinates of the arm's end.
pub(crate) const PLACES: [[f64; 2]; 2] = [[-(JOINTS as f64), JOINTS as f64]; 2];

/// Minus the variance of the joint angles, and where the arm ends.
pub(crate) fn judge(angles: &[f64], row: &mut [f64]) {
    let count = angles.len() as f64;
    let mean = angles.iter().sum::<f64>() / count;
    let variance = angles.iter().map(|angle| (angle - mean) * (angle - mean)).sum::<f64>() / count;
    let (mut sum, mut x, mut y) = (0.0, 0.0, 0.0);
    for angle in angles {
        sum += angle;
        let (sine, cosine) = sin_cos(sum);
        x += cosine;
        y += sine;
    }
    row.copy_from_slice(&[-variance, x, y]);
}
