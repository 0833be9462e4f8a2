//! Errors of reading a robot from a file, together with their location in the file.

use std::fmt;

use farsa_body::robot::RobotError;

/// Location in a file.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SourceLocation {
    /// Name of the file, as it was given.
    pub file: String,
    /// Number of the line, from 1.
    pub line: usize,
}

impl fmt::Display for SourceLocation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} line {}", self.file, self.line)
    }
}

/// Error of reading a robot from a file. It usually names the file and the line of the fault.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ReadError {
    /// A file could not be read by the operating system, or is not text.
    File {
        /// Path of the file.
        path: String,
        /// Reason given by the operating system.
        why: String,
    },
    /// A path leads out of the folders that may be read, or to a file that does not exist.
    Path {
        /// Location of the path in the model.
        place: SourceLocation,
        /// Path as written in the model.
        path: String,
        /// Description of the fault.
        why: &'static str,
    },
    /// A model is larger than the [`Limits`](crate::Limits) allow. If you trust the file, you can raise them.
    TooMuch {
        /// Location at which the limit was exceeded.
        place: SourceLocation,
        /// Name of the parts that were counted.
        what: &'static str,
        /// Value of the limit.
        limit: usize,
    },
    /// The XML is not a valid model.
    ///
    /// There are several possible reasons, such as wrong syntax, a document type, a repeated or unknown name, a
    /// missing part or an impossible value. You also get this error if there are several roots, or if links form a
    /// loop.
    Malformed {
        /// Location of the fault.
        place: SourceLocation,
        /// Description of the fault.
        why: String,
    },
    /// A part is valid, but a robot description cannot hold it. Leaving it out would change the robot.
    Unsupported {
        /// Location of the part.
        place: SourceLocation,
        /// Name of the element.
        element: String,
        /// Description of the part, and of a way to avoid it.
        why: String,
    },
    /// A mass or an inertia is impossible, or it is missing for a body that moves. You may be able to fix this with
    /// [`Repair`](crate::Repair).
    Mass {
        /// Location of the body.
        place: SourceLocation,
        /// Name of the body.
        body: String,
        /// Mass of the body [kg].
        mass: f64,
        /// Inertia of the body [xx, yy, zz, xy, xz, yz, kg m2].
        inertia: [f64; 6],
    },
    /// A file of a mesh does not contain a valid mesh.
    Mesh {
        /// Location at which the model names the mesh.
        place: SourceLocation,
        /// Path of the file of the mesh.
        path: String,
        /// Description of the fault.
        why: String,
    },
    /// A robot was read, but is not valid for any other reason.
    Robot {
        /// Path of the model.
        file: String,
        /// Error of the robot description.
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

/// Finds the name of `valid` that takes the fewest changed, added or dropped letters. The first of several.
pub(crate) fn nearest<'a>(name: &str, valid: impl IntoIterator<Item = &'a str>) -> Option<(&'a str, usize)> {
    valid.into_iter().map(|candidate| (candidate, distance(name, candidate))).min_by_key(|(_, distance)| *distance)
}

/// Counts the changed, added or dropped letters between two names, of which the first 64 letters count.
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
