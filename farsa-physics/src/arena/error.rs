//! What no planar world can be built from.

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
    /// There is no robot.
    NoRobots,
    /// There are more of something than there are numbers for them.
    TooMany {
        /// Of what.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// How many there can be.
        most: usize,
    },
    /// A number is not within what is possible.
    Range {
        /// Whose number.
        part: Part,
        /// Which number.
        what: &'static str,
        /// The number.
        value: f64,
        /// What is possible, both ends included.
        range: [f64; 2],
    },
    /// Two parts overlap where they start.
    Overlap {
        /// The two.
        parts: [Part; 2],
        /// How deep one lies in the other [m].
        depth: f64,
    },
    /// Something starts outside of the arena.
    Outside {
        /// What.
        part: Part,
        /// Where it starts [m].
        at: [f64; 2],
        /// Its radius; 0 for an area, of which the middle counts, and for a corner of a convex obstacle [m].
        radius: f64,
        /// The arena is [0, width] x [0, depth] [m].
        size: [f64; 2],
    },
    /// Two corners of a prism are one.
    SameCorner {
        /// The prism.
        part: Part,
        /// The numbers of the corners.
        corners: [usize; 2],
        /// How far they are apart [m].
        distance: f64,
    },
    /// A corner of a prism lies within the hull of the others: it is not convex.
    Dent {
        /// The prism.
        part: Part,
        /// The number of the corner.
        corner: usize,
        /// How deep it lies [m].
        depth: f64,
    },
    /// The corners of a prism do not follow each other around it.
    OutOfTurn {
        /// The prism.
        part: Part,
        /// The numbers of the corners where a side begins and ends that has corners on both hands.
        side: [usize; 2],
        /// The number of the first of them on the outer hand.
        corner: usize,
    },
    /// Points are so close to each other or to a plane that no closed hull of them is found.
    NoHull {
        /// The obstacle.
        part: Part,
        /// The number of its points.
        points: usize,
    },
    /// Something needs a feature of this crate that it was compiled without.
    NeedsFeature {
        /// What.
        part: Part,
        /// The name of the feature.
        feature: &'static str,
    },
    /// A robot may go farther in a step than its hull's radius, and so through another.
    StepTooLong {
        /// The robot.
        robot: usize,
        /// How far it may go in a step [m].
        travel: f64,
        /// The radius of its hull [m].
        radius: f64,
    },
    /// No free place was found.
    NoFreePlace {
        /// In so many tries.
        tries: u32,
        /// For a disc of this radius [m].
        radius: f32,
        /// How far the best place lies from where it would be free [m].
        short: f32,
    },
    /// No batch has so many worlds.
    Lanes {
        /// The number asked for.
        lanes: usize,
        /// The nearest possible.
        nearest: usize,
    },
}

impl fmt::Display for ArenaError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoRobots => write!(f, "an arena without robots: add at least one"),
            Self::TooMany { what, count, most } => write!(f, "{count} {what}: there can be at most {most}"),
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
            Self::SameCorner { part, corners: [i, j], distance } => {
                write!(f, "corners {i} and {j} of {part} are {distance} m apart: leave one of them out")
            }
            Self::Dent { part, corner, depth } => {
                write!(
                    f,
                    "corner {corner} of {part} lies {depth} m within the hull of the others: leave it out, or make it two obstacles"
                )
            }
            Self::OutOfTurn { part, side: [i, j], corner } => {
                write!(
                    f,
                    "corners of {part} are out of turn: {corner} lies on the outer side of the line from {i} to {j}; name them one after the other around it"
                )
            }
            Self::NoHull { part, points } => {
                write!(
                    f,
                    "no closed hull of the {points} points of {part}: leave out points that are close to others or to a face"
                )
            }
            Self::NeedsFeature { part, feature } => {
                write!(f, "{part} is a hull of points: that needs the feature `{feature}` of farsa-physics")
            }
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
