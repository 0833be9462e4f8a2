//! The error of planar worlds.

use core::fmt;

/// A part of an arena, by its number in the arena's list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The arena as a whole.
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

/// Why a planar world cannot be built, or a place in it not be found.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ArenaError {
    /// Too few or too many parts of one kind.
    Count {
        /// The kind of parts.
        what: &'static str,
        /// The number of parts.
        count: usize,
        /// The least and the greatest number.
        range: [usize; 2],
    },
    /// A number is not within what is possible.
    Range {
        /// Whose number.
        part: Part,
        /// Which number.
        what: &'static str,
        /// The number.
        value: f64,
        /// The permitted range, both ends included.
        range: [f64; 2],
    },
    /// Two parts overlap where they start.
    Overlap {
        /// The two.
        parts: [Part; 2],
        /// The depth of the overlap [m].
        depth: f64,
    },
    /// Something starts outside of the arena.
    Outside {
        /// The part.
        part: Part,
        /// Where it starts [m].
        at: [f64; 2],
        /// Its radius, or 0 for an area, of which the middle counts, and for a corner of a convex obstacle [m].
        radius: f64,
        /// The arena is [0, width] x [0, depth] [m].
        size: [f64; 2],
    },
    /// A convex obstacle whose points have no hull.
    Convex {
        /// The obstacle.
        part: Part,
        /// The fault.
        fault: ConvexFault,
    },
    /// A robot may go farther in a step than its hull's radius, and so through another.
    StepTooLong {
        /// The robot.
        robot: usize,
        /// The largest distance in a step [m].
        travel: f64,
        /// The radius of its hull [m].
        radius: f64,
    },
    /// No free place was found.
    NoFreePlace {
        /// The number of tries.
        tries: u32,
        /// For a disc of this radius [m].
        radius: f32,
        /// The overlap at the best place [m].
        short: f32,
    },
    /// A number of worlds without a batch.
    Lanes {
        /// The number asked for.
        lanes: usize,
        /// The nearest possible.
        nearest: usize,
    },
}

/// The fault of a convex obstacle.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ConvexFault {
    /// Two corners of a prism at one place.
    SameCorner {
        /// The numbers of the corners.
        corners: [usize; 2],
        /// The distance between them [m].
        distance: f64,
    },
    /// A corner of a prism within the hull of the others, so that the prism is not convex.
    Dent {
        /// The number of the corner.
        corner: usize,
        /// The depth of the corner within the hull [m].
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
        /// The number of points.
        points: usize,
    },
    /// An obstacle that needs a feature of this crate.
    NeedsFeature {
        /// The name of the feature.
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
