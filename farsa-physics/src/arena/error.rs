//! Errors of planar worlds.

use core::fmt;

/// A part of an arena, given by its number in the list of the arena.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The arena itself.
    Arena,
    /// A wall.
    Wall(usize),
    /// A convex obstacle.
    Convex(usize),
    /// A cylinder.
    Cylinder(usize),
    /// An area.
    Area(usize),
    /// A robot.
    Robot(usize),
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Arena => write!(f, "the arena"),
            Self::Wall(i) => write!(f, "wall {i}"),
            Self::Convex(i) => write!(f, "convex obstacle {i}"),
            Self::Cylinder(i) => write!(f, "cylinder {i}"),
            Self::Area(i) => write!(f, "area {i}"),
            Self::Robot(i) => write!(f, "robot {i}"),
        }
    }
}

/// An error that occurs if a planar world cannot be built, or if no free place can be found in it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ArenaError {
    /// There are too few or too many parts of one kind.
    Count {
        /// Kind of the parts.
        what: &'static str,
        /// Number of parts.
        count: usize,
        /// Smallest and largest number that is allowed.
        range: [usize; 2],
    },
    /// A number is outside of its allowed range.
    Range {
        /// Part that the number belongs to.
        part: Part,
        /// Name of the number.
        what: &'static str,
        /// Value that was given.
        value: f64,
        /// Allowed range, including both ends.
        range: [f64; 2],
    },
    /// Two parts overlap where they start.
    Overlap {
        /// Both parts.
        parts: [Part; 2],
        /// Depth of the overlap [m].
        depth: f64,
    },
    /// A part starts outside of the arena.
    Outside {
        /// Part that is outside.
        part: Part,
        /// Initial position of the part [m].
        at: [f64; 2],
        /// Its radius, or 0 for an area, of which the middle counts, and for a corner of a convex obstacle [m].
        radius: f64,
        /// Width and depth of the arena, which begins at the origin [m].
        size: [f64; 2],
    },
    /// A convex obstacle is invalid.
    Convex {
        /// Obstacle that is invalid.
        part: Part,
        /// Reason why it is invalid.
        fault: ConvexFault,
    },
    /// In a single step, a robot may move farther than the radius of its hull. It could then pass through another
    /// robot.
    StepTooLong {
        /// Number of the robot.
        robot: usize,
        /// Largest distance that it can move in a step [m].
        travel: f64,
        /// Radius of its hull [m].
        radius: f64,
    },
    /// No free place was found within the allowed number of tries.
    NoFreePlace {
        /// Number of tries.
        tries: u32,
        /// Radius of the disc [m].
        radius: f32,
        /// Overlap at the best place that was tried [m].
        short: f32,
    },
    /// A batch of this many worlds is not possible.
    Lanes {
        /// Requested number of worlds.
        lanes: usize,
        /// Nearest number that is possible.
        nearest: usize,
    },
}

/// Reason why a convex obstacle is invalid.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ConvexFault {
    /// Two corners of a prism are at the same place.
    SameCorner {
        /// Numbers of both corners.
        corners: [usize; 2],
        /// Distance between the corners [m].
        distance: f64,
    },
    /// A corner of a prism is within the hull of the others, so the prism is not convex.
    Dent {
        /// Number of the corner.
        corner: usize,
        /// Depth of the corner within the hull [m].
        depth: f64,
    },
    /// Corners of a prism that do not follow each other around it.
    OutOfTurn {
        /// The numbers of the corners of a side that has corners to its left and to its right.
        side: [usize; 2],
        /// The number of the first corner on its outer side.
        corner: usize,
    },
    /// Points so close to each other or to a plane that they have no closed hull.
    NoHull {
        /// Number of points.
        points: usize,
    },
    /// This obstacle requires a feature that the crate was built without.
    NeedsFeature {
        /// Name of the feature.
        feature: &'static str,
    },
}

impl fmt::Display for ArenaError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Count { what, count, range: [least, _] } if count < least => {
                write!(f, "an arena without {what}: add at least one")
            }
            Self::Count { what, count, range: [_, most] } => write!(f, "{count} {what}: there can be at most {most}"),
            Self::Range { part, what, value, range: [low, high] } => {
                write!(f, "{what} of {part} is {value}: must be in [{low}, {high}]")
            }
            Self::Overlap { parts: [a, b], depth } => write!(f, "{a} starts {depth:.6} m deep in {b}"),
            Self::Outside { part, at: [x, y], radius, size: [width, depth] } => {
                write!(
                    f,
                    "{part} of radius {radius} m starts at ({x}, {y}) m: not within [0, {width}] x [0, {depth}] m"
                )
            }
            Self::Convex { part, fault } => fault.write(f, part),
            Self::StepTooLong { robot, travel, radius } => {
                write!(
                    f,
                    "robot {robot} may go {travel} m in a step: at most the {radius} m of its hull's radius; take a shorter time step"
                )
            }
            Self::NoFreePlace { tries, radius, short } => {
                write!(f, "no free place for a disc of {radius} m in {tries} tries: the best lacked {short} m")
            }
            Self::Lanes { lanes, nearest } => write!(f, "no batch has {lanes} worlds: the nearest has {nearest}"),
        }
    }
}

impl core::error::Error for ArenaError {}

impl ConvexFault {
    fn write(&self, f: &mut fmt::Formatter<'_>, part: &Part) -> fmt::Result {
        match self {
            Self::SameCorner { corners: [i, j], distance } => {
                write!(f, "corners {i} and {j} of {part} are {distance} m apart: leave one of them out")
            }
            Self::Dent { corner, depth } => write!(
                f,
                "corner {corner} of {part} lies {depth} m within the hull of the others: leave it out, or make it two obstacles"
            ),
            Self::OutOfTurn { side: [i, j], corner } => write!(
                f,
                "corners of {part} are out of turn: {corner} lies on the outer side of the line from {i} to {j}; name them one after the other around it"
            ),
            Self::NoHull { points } => write!(
                f,
                "no closed hull of the {points} points of {part}: leave out points that are close to others or to a face"
            ),
            Self::NeedsFeature { feature } => {
                write!(f, "{part} is a hull of points: that needs the feature `{feature}` of farsa-physics")
            }
        }
    }
}
