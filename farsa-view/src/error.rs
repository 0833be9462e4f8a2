//! Why something cannot be shown.

use std::fmt;

/// What cannot be shown, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error {
    /// An unknown name of a camera.
    UnknownCamera {
        /// The name.
        name: String,
        /// The valid name that looks most like it.
        nearest: Option<String>,
    },
    /// A size that no picture has.
    Size {
        /// Width and height [pixels].
        size: [u32; 2],
        /// What is wrong with it.
        why: String,
    },
    /// A text that should be JSON and is not, and why.
    NotJson(String),
}

impl Error {
    /// An unknown camera, with the name that takes the fewest changed, added, dropped or swapped letters.
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
