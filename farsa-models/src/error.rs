//! Why a robot could not be read from a file, and where in the file.

use std::fmt;

use farsa_body::robot::RobotError;

/// A line of a file.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SourceLocation {
    /// The file, as it was named.
    pub file: String,
    /// The line, from 1.
    pub line: usize,
}

impl fmt::Display for SourceLocation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} line {}", self.file, self.line)
    }
}

/// Why no robot could be made of a file.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ReadError {
    /// The operating system does not read a file, or it is no text.
    File {
        /// The file.
        path: String,
        /// Its reason.
        why: String,
    },
    /// A file's path leads out of the folders that may be read, or to nothing.
    Path {
        /// The place of the path.
        place: SourceLocation,
        /// The path.
        path: String,
        /// The fault.
        why: &'static str,
    },
    /// More of something than the [`Limits`](crate::Limits) allow.
    TooMuch {
        /// Where the limit was passed.
        place: SourceLocation,
        /// The kind of parts.
        what: &'static str,
        /// The limit.
        limit: usize,
    },
    /// XML that is not a valid model.
    ///
    /// The reason may be the syntax, a document type, an unknown or repeated name, a missing part, an impossible value,
    /// several roots, or links that carry each other.
    Malformed {
        /// The place.
        place: SourceLocation,
        /// The fault.
        why: String,
    },
    /// A valid part that a description cannot hold, and whose omission would change the robot.
    Unsupported {
        /// The place.
        place: SourceLocation,
        /// The element.
        element: String,
        /// The part that cannot be held, and a remedy.
        why: String,
    },
    /// A mass or inertia that a body cannot have, or that one that moves cannot do with.
    Mass {
        /// Where the body is.
        place: SourceLocation,
        /// Its name.
        body: String,
        /// Its mass [kg].
        mass: f64,
        /// Its inertia [xx, yy, zz, xy, xz, yz, kg m2].
        inertia: [f64; 6],
    },
    /// A mesh's file that contains no mesh.
    Mesh {
        /// Where the mesh is named.
        place: SourceLocation,
        /// The file.
        path: String,
        /// The fault.
        why: String,
    },
    /// The robot that the file describes is not valid for another reason.
    Robot {
        /// The file.
        file: String,
        /// The reason.
        error: RobotError,
    },
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File { path, why } => write!(f, "{path}: {why}"),
            Self::Path { place, path, why } => write!(f, "{place}: {path:?} {why}"),
            Self::TooMuch { place, what, limit } => write!(f, "{place}: more than {limit} {what}"),
            Self::Malformed { place, why } => write!(f, "{place}: {why}"),
            Self::Unsupported { place, element, why } => write!(f, "{place}: {element}: {why}"),
            Self::Mass { place, body, mass, inertia } => {
                let hint = if *mass > 0.0 && inertia.iter().any(|x| *x != 0.0) {
                    "no body has"
                } else {
                    "a body that moves cannot have"
                };
                write!(f, "{place}: {body}: {hint} mass {mass} and inertia {inertia:?}; see `Repair`")
            }
            Self::Mesh { place, path, why } => write!(f, "{place}: {path:?}: {why}"),
            Self::Robot { file, error } => write!(f, "{file}: {error}"),
        }
    }
}

impl std::error::Error for ReadError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Robot { error, .. } => Some(error),
            _ => None,
        }
    }
}

/// The error of a second part where only one can be.
pub(crate) fn repeated(place: SourceLocation, what: &str, name: &str, first: usize) -> ReadError {
    ReadError::Malformed { place, why: format!("a second {what} `{name}`, the first is in line {first}") }
}

/// The name of `valid` that takes the fewest changed, added or dropped letters. The first of several.
pub(crate) fn nearest<'a>(name: &str, valid: impl IntoIterator<Item = &'a str>) -> Option<(&'a str, usize)> {
    valid.into_iter().map(|candidate| (candidate, distance(name, candidate))).min_by_key(|(_, distance)| *distance)
}

/// The number of changed, added or dropped letters between two names, of which the first 64 letters count.
fn distance(a: &str, b: &str) -> usize {
    let letters: Vec<char> = b.chars().take(64).collect();
    let mut row: Vec<usize> = (0..=letters.len()).collect();
    for (i, x) in a.chars().take(64).enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, y) in letters.iter().enumerate() {
            let changed = diagonal + usize::from(x != *y);
            diagonal = row[j + 1];
            row[j + 1] = changed.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[letters.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_name_takes_the_fewest_letters() {
        assert_eq!(distance("kitten", "sitting"), 3);
        assert_eq!(distance("", "abc"), 3);
        assert_eq!(distance("abc", ""), 3);
        assert_eq!(nearest("revolut", ["fixed", "revolute", "prismatic"]), Some(("revolute", 1)));
        assert_eq!(nearest("x", []), None);
    }
}
