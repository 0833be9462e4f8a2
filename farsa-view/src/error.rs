//! Errors of pictures and pages.

use std::fmt;

/// Error of drawing a picture or writing a page.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error {
    /// There is no camera with this name.
    UnknownCamera {
        /// Name that was not found.
        name: String,
        /// Valid name that is most similar.
        nearest: Option<String>,
    },
    /// A picture cannot have this size.
    Size {
        /// Width and height [pixels].
        size: [u32; 2],
        /// Description of the fault.
        why: String,
    },
    /// A text is not valid JSON. This contains the reason.
    NotJson(String),
    /// A mesh cannot be drawn. This contains the reason.
    Mesh(String),
}

impl Error {
    /// Creates the error of an unknown camera, with the name of the least edit distance.
    pub(crate) fn unknown_camera(name: &str, valid: [&str; 5]) -> Self {
        let nearest = valid.into_iter().min_by_key(|candidate| strsim::damerau_levenshtein(name, candidate));
        Self::UnknownCamera { name: name.into(), nearest: nearest.map(str::to_owned) }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownCamera { name, nearest } => {
                write!(f, "unknown camera `{name}`")?;
                match nearest {
                    Some(nearest) => write!(f, "; the nearest is `{nearest}`"),
                    None => write!(f, "; there is none"),
                }
            }
            Self::Size { size: [width, height], why } => write!(f, "a picture of {width} x {height}: {why}"),
            Self::Mesh(why) => write!(f, "a mesh {why}"),
            Self::NotJson(why) => write!(f, "no JSON: {why}"),
        }
    }
}

impl std::error::Error for Error {}
