//! A wall as the step of a planar world has it.

use farsa_num::sin_cos;

use crate::arena::description::Wall;

/// A wall.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slab {
    pub(crate) centre: [f32; 2],
    /// Unit vector along its length.
    pub(crate) axis: [f32; 2],
    /// Half its length and thickness.
    pub(crate) half: [f32; 2],
    /// Half the sides of the upright rectangle around it.
    pub(crate) around: [f32; 2],
    pub(crate) height: f32,
    pub(crate) color: [f32; 3],
}

impl Slab {
    pub(crate) fn from_wall(wall: &Wall) -> Self {
        let narrow = |x: [f64; 2]| x.map(|x| x as f32);
        // Walls along the axes are exactly so.
        let (sine, cosine) = sin_cos(wall.heading);
        let [a, b] = wall.size.map(|x| 0.5 * x);
        let around = [a * cosine.abs() + b * sine.abs(), a * sine.abs() + b * cosine.abs()];
        Self {
            centre: narrow(wall.centre),
            axis: narrow([cosine, sine]),
            half: narrow([a, b]),
            around: narrow(around),
            height: wall.height as f32,
            color: wall.color.map(|x| x as f32),
        }
    }

    /// Returns whether some of it may be within `range` [m] of a place.
    #[inline]
    pub(crate) fn within_reach(&self, from: [f32; 2], range: f32) -> bool {
        (0..2).all(|k| (from[k] - self.centre[k]).abs() <= self.around[k] + range)
    }
}
