//! Bodies to be placed.

use core::f32::consts::PI;

use farsa_body::Pose;
use farsa_body::ports::BodyId;
use farsa_num::Stream;
use farsa_physics::arena::ArenaError;

/// A body to be placed, with those that were placed before it.
#[derive(Debug)]
pub struct Spot<'s> {
    /// Number among the bodies of the rule, from 0.
    pub number: usize,
    /// Radius of the body \[m\], 0 for a robot with joints.
    pub radius: f64,
    /// Distance from the center from which distances are measured \[m\].
    pub(crate) edge: f64,
    /// True for an obstacle, false for an area.
    pub(crate) solid: bool,
    /// True if a heading is drawn.
    pub(crate) turns: bool,
    /// Sides of the arena \[m\].
    pub(crate) size: [f64; 2],
    /// Obstacles in the arena with their least distance \[m\].
    pub(crate) others: &'s mut [(BodyId, f32)],
    /// Areas in the arena with their radius \[m\].
    pub(crate) areas: &'s [(BodyId, f64)],
    /// Positions in the space of a robot with joints, with the reach of what is there \[m\].
    pub(crate) earlier: &'s [([f32; 3], f64)],
    /// Numbers of the points that earlier rules chose.
    pub(crate) chosen: &'s [usize],
    /// Number of the point that this rule chooses.
    pub(crate) choice: Option<usize>,
    /// Reason if there is no place.
    pub(crate) lacks: Option<ArenaError>,
}

impl Spot<'_> {
    /// Returns the pose at a position \[m\]. Robots on wheels and blocks get a heading, drawn uniformly.
    pub fn facing(&self, position: [f32; 3], stream: &mut Stream) -> Pose {
        if !self.turns {
            return Pose::at(position);
        }
        let [x, y, _] = position;
        Pose::planar([x, y], stream.range(-PI, PI))
    }
}
