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
        /// Where the path stands.
        place: SourceLocation,
        /// The path.
        path: String,
        /// What is wrong with it.
        why: &'static str,
    },
    /// More of something than the [`Limits`](crate::Limits) allow.
    TooMuch {
        /// Where the limit was passed.
        place: SourceLocation,
        /// Of what.
        what: &'static str,
        /// The limit.
        limit: usize,
    },
    /// No XML, or XML that defines entities.
    Malformed {
        /// Where.
        place: SourceLocation,
        /// What is wrong.
        why: String,
    },
    /// A name that means nothing there.
    Unknown {
        /// Where.
        place: SourceLocation,
        /// What it should be the name of.
        what: String,
        /// The name.
        name: String,
        /// The valid name that looks most like it, if there are any.
        nearest: Option<String>,
    },
    /// An element without something that it needs.
    Missing {
        /// Where the element is.
        place: SourceLocation,
        /// The element.
        element: String,
        /// What it lacks.
        what: String,
    },
    /// An attribute whose value cannot be.
    Value {
        /// Where.
        place: SourceLocation,
        /// The element.
        element: String,
        /// The attribute.
        attribute: &'static str,
        /// Its value.
        value: String,
        /// What it should be.
        why: String,
    },
    /// A name or thing of which there may be one only.
    Twice {
        /// Where the second is.
        place: SourceLocation,
        /// What it is.
        what: String,
        /// Its name.
        name: String,
        /// The line of the first.
        first: usize,
    },
    /// Something that a description cannot hold and that would change the robot if it were left out.
    Unsupported {
        /// Where.
        place: SourceLocation,
        /// The element.
        element: String,
        /// What there is no place for, and what to do.
        why: String,
    },
    /// A tree with more than one root.
    Roots {
        /// Where the second root is.
        place: SourceLocation,
        /// The roots' names.
        names: Vec<String>,
    },
    /// Links that carry each other.
    Cycle {
        /// Where the first of them is.
        place: SourceLocation,
        /// Their names.
        names: Vec<String>,
    },
    /// A mass or inertia that a body cannot have, or that one that moves cannot do with.
    Mass {
        /// Where the body is.
        place: SourceLocation,
        /// Its name.
        body: String,
        /// Its mass [kg].
        mass: f64,
        /// Its inertia [xx, yy, zz, xy, xz, yz; kg m2].
        inertia: [f64; 6],
    },
    /// A mesh's file that is none.
    Mesh {
        /// Where the mesh is named.
        place: SourceLocation,
        /// The file.
        path: String,
        /// What is wrong with it.
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
            Self::Unknown { place, what, name, nearest } => {
                write!(f, "{place}: unknown {what} `{name}`")?;
                match nearest {
                    Some(nearest) => write!(f, "; the nearest is `{nearest}`"),
                    None => write!(f, "; there is none"),
                }
            }
            Self::Missing { place, element, what } => write!(f, "{place}: {element} has no {what}"),
            Self::Value { place, element, attribute, value, why } => {
                write!(f, "{place}: {element}: {attribute} is {value:?}, {why}")
            }
            Self::Twice { place, what, name, first } => {
                write!(f, "{place}: a second {what} `{name}`, the first is in line {first}")
            }
            Self::Unsupported { place, element, why } => write!(f, "{place}: {element}: {why}"),
            Self::Roots { place, names } => {
                write!(f, "{place}: {} links hang on nothing ({}); a robot has one root", names.len(), few(names))
            }
            Self::Cycle { place, names } => write!(f, "{place}: links carry each other: {}", few(names)),
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

/// The first names of a list.
fn few(names: &[String]) -> String {
    let shown: Vec<&str> = names.iter().take(8).map(String::as_str).collect();
    let rest = if names.len() > shown.len() { ", ..." } else { "" };
    format!("{}{rest}", shown.join(", "))
}

/// The name of `valid` that takes the fewest changed, added or dropped letters; the first of several.
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
