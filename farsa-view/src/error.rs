//! Errors of pictures and pages.

use std::fmt;

/// An error of a picture or page.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error {
    /// An unknown name of a camera.
    UnknownCamera {
        /// The name.
        name: String,
        /// The most similar valid name.
        nearest: Option<String>,
    },
    /// An invalid size of a picture.
    Size {
        /// Width and height [pixels].
        size: [u32; 2],
        /// The reason.
        why: String,
    },
    /// A text that is not valid JSON, with the reason.
    NotJson(String),
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
            Self::NotJson(why) => write!(f, "no JSON: {why}"),
        }
    }
}

impl std::error::Error for Error {}
