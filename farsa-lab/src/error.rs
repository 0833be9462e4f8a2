//! Errors of the laboratory and their exit codes.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use crate::escaped::{MAX_SHOWN, OneLine, Quoted};

/// Maximum number of names in a message.
const MAX_LISTED: usize = 12;

/// Error of the laboratory. Variants are grouped by how you can react to them.
#[derive(Debug)]
#[non_exhaustive]
pub enum Error {
    /// A wrong setting or an unknown name: correct it.
    Setting {
        /// Location, such as `my.toml line 3` or `--set`. Empty if unknown, or for the plain command line.
        place: String,
        /// Key of the setting. Empty for a whole file, and for an unknown name.
        key: String,
        /// Reason.
        why: String,
    },
    /// Several faults of one file, never empty: correct each.
    Several(Vec<Self>),
    /// A command line or configuration that is invalid as a whole: change it.
    Usage(String),
    /// A file or directory of a run that cannot be used: choose another, or repair it.
    File {
        /// File or directory.
        path: PathBuf,
        /// Reason.
        why: String,
        /// Kind of fault.
        fault: FileFault,
    },
    /// A failed call to the operating system: retry, or free space.
    Io {
        /// Verb of the attempted action.
        doing: &'static str,
        /// File or directory.
        path: PathBuf,
        /// Error of the system.
        source: io::Error,
    },
    /// A failure on another rank of the same command: see that rank.
    Rank {
        /// Number of the rank.
        rank: usize,
        /// Exit code of the failure.
        code: u8,
        /// Message of the failure.
        why: String,
    },
    /// Ctrl-C. All finished generations are kept: resume.
    Interrupted {
        /// Command that resumes.
        resume: String,
    },
    /// Any other failure of an experiment, a strategy or a world.
    Other(String),
}

/// Kind of fault of a run's file or directory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileFault {
    /// Truncated, altered, or not a file of a run.
    Damaged,
    /// Made by another version, whose trials differ.
    OtherVersion,
    /// In use, or not empty.
    Occupied,
    /// Without a run.
    NoRun,
}

impl Error {
    /// Creates an error about values that contradict each other. Use this in
    /// [`Experiment::prepare`](crate::Experiment::prepare).
    pub fn setting(key: &str, why: impl fmt::Display) -> Self {
        Self::Setting { place: String::new(), key: key.into(), why: why.to_string() }
    }

    /// Creates an error about an unknown name.
    ///
    /// Its text contains the nearest valid name. If no name is similar, and there are only a few of them, it lists
    /// all of them.
    pub fn unknown<'a>(place: &str, what: &'static str, name: &str, valid: impl IntoIterator<Item = &'a str>) -> Self {
        let mut few: Vec<&str> = Vec::new();
        let listed = valid.into_iter().inspect(|name| {
            if few.len() <= MAX_LISTED && !few.contains(name) {
                few.push(name);
            }
        });
        let nearest = nearest(name, listed);
        let near = nearest.is_some_and(|(letters, valid)| is_near(name, valid, letters));
        if near || few.len() > MAX_LISTED {
            few.clear();
        }
        few.sort_unstable();
        Self::unknown_name(place, what, name, nearest.map(|(_, valid)| valid), &few)
    }

    /// Builds an error about an unknown name. `few` holds the valid names if none is near.
    fn unknown_name(place: &str, what: &str, name: &str, nearest: Option<&str>, few: &[&str]) -> Self {
        let alternatives = match (nearest, few) {
            (None, []) => "there is none".into(),
            (Some(nearest), []) => format!("the nearest is {}", Quoted(nearest)),
            (_, [only]) => format!("the only one is {}", Quoted(only)),
            (_, [first @ .., last]) => {
                let first: Vec<String> = first.iter().map(|name| Quoted(name).to_string()).collect();
                format!("there are {} and {}", first.join(", "), Quoted(last))
            }
        };
        let why = format!("unknown {what} {}; {alternatives}", Quoted(name));
        Self::Setting { place: place.into(), key: String::new(), why }
    }

    /// Combines all faults of a file. A single fault is returned as it is.
    pub fn several(mut faults: Vec<Self>) -> Self {
        match faults.pop() {
            Some(only) if faults.is_empty() => only,
            last => {
                faults.extend(last);
                Self::Several(faults)
            }
        }
    }

    /// Converts the error of a file or a text that the user names into one of usage, with the same message.
    pub(crate) fn into_usage(self) -> Self {
        match self {
            error @ (Self::Io { doing: "read", .. } | Self::File { fault: FileFault::Damaged, .. }) => {
                Self::Usage(error.to_string())
            }
            Self::Other(why) => Self::Usage(why),
            Self::Several(faults) => Self::Several(faults.into_iter().map(Self::into_usage).collect()),
            other => other,
        }
    }

    /// Creates a closure for `map_err`, which converts an error of the operating system.
    pub fn io(doing: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::Io { doing, path: path.into(), source }
    }

    /// Builds an error about a file that would exceed what is read of it.
    pub(crate) fn too_large(path: &Path, bytes: u64, most: u64) -> Self {
        Self::Other(format!("{}: would have {bytes} bytes, more than the {most} that are read of it", path.display()))
    }

    /// Builds an error about a damaged file.
    pub(crate) fn damaged(path: &Path, why: impl fmt::Display) -> Self {
        Self::File { path: path.into(), why: why.to_string(), fault: FileFault::Damaged }
    }

    /// Builds an error about a directory that is in use.
    pub(crate) fn occupied(path: &Path, why: &str) -> Self {
        Self::File { path: path.into(), why: why.into(), fault: FileFault::Occupied }
    }

    /// Builds an error about a directory without a run.
    pub(crate) fn no_run(path: &Path, why: &str) -> Self {
        Self::File { path: path.into(), why: why.into(), fault: FileFault::NoRun }
    }

    /// Builds an error about a run that was resumed with another value of a setting.
    pub(crate) fn other_configuration(directory: &Path, key: &str, run: &str, asked: &str) -> Self {
        Self::Usage(format!(
            "the run in {} has {} = {}, not {}: another configuration is another run",
            OneLine(directory.display()),
            Quoted(key),
            OneLine(run),
            OneLine(asked)
        ))
    }

    /// Builds an error about a strategy that panicked.
    pub(crate) fn strategy_panicked(generation: u32, why: &str) -> Self {
        Self::Other(format!("the strategy panicked in generation {generation}: {}", OneLine(why)))
    }

    /// Gets the exit code of the command.
    ///
    /// It is 2 for a wrong command line or configuration, 130 after Ctrl-C, and 1 in all other cases.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Setting { .. }
            | Self::Usage(_)
            | Self::File { fault: FileFault::Occupied | FileFault::NoRun, .. } => 2,
            Self::File { .. } | Self::Io { .. } | Self::Other(_) => 1,
            Self::Rank { code, .. } => *code,
            Self::Several(faults) => faults.iter().map(Self::exit_code).max().unwrap_or(1),
            Self::Interrupted { .. } => 130,
        }
    }
}

/// Errors of robots, worlds, sensors, networks and strategies, for `?` in
/// [`Experiment::prepare`](crate::Experiment::prepare).
macro_rules! others {
    ($($error:ty),+ $(,)?) => {
        $(impl From<$error> for Error {
            fn from(error: $error) -> Self {
                Self::Other(error.to_string())
            }
        })+
    };
}

others!(
    farsa_body::robot::RobotError,
    farsa_models::ReadError,
    farsa_body::ChannelError,
    farsa_physics::articulated::ModelError,
    farsa_physics::arena::ArenaError,
    farsa_nn::Error,
    farsa_evo::EvoError,
);

impl From<farsa_view::Error> for Error {
    fn from(error: farsa_view::Error) -> Self {
        match error {
            farsa_view::Error::UnknownCamera { name, nearest } => {
                Self::unknown_name("", "camera", &name, nearest.as_deref(), &[])
            }
            other => Self::Other(other.to_string()),
        }
    }
}

/// Finds the valid name with the smallest edit distance, and that distance in letters.
///
/// Among equally near names, one that starts with the given text wins. Case counts least. Only the beginning of an
/// overlong name is compared.
fn nearest<'a>(name: &str, valid: impl IntoIterator<Item = &'a str>) -> Option<(usize, &'a str)> {
    let name: String = name.chars().take(MAX_SHOWN).collect();
    let lower = name.to_lowercase();
    let length = lower.chars().count();
    let distance = strsim::damerau_levenshtein;
    let mut best: Option<(usize, &str)> = None;
    for valid in valid {
        let other = valid.to_lowercase();
        // The difference in length is a lower bound: most names need not be compared.
        if best.is_some_and(|(least, _)| other.chars().count().abs_diff(length) > least) {
            continue;
        }
        let letters = distance(&lower, &other);
        let rank = |valid: &str| (!valid.to_lowercase().starts_with(&lower), distance(&name, valid));
        let better = best.is_none_or(|(least, found)| letters < least || letters == least && rank(valid) < rank(found));
        if better {
            best = Some((letters, valid));
        }
    }
    best
}

/// Finds the valid name that is nearest. If there are no valid names, this returns `None`.
pub fn nearest_name<'a>(name: &str, valid: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    nearest(name, valid).map(|(_, valid)| valid)
}

/// Checks if half of the longer name agrees, or if one name contains the other.
fn is_near(name: &str, valid: &str, letters: usize) -> bool {
    let [name, valid] = [name, valid].map(|text| text.chars().take(MAX_SHOWN).collect::<String>().to_lowercase());
    let longest = name.chars().count().max(valid.chars().count());
    2 * letters <= longest || !name.is_empty() && (valid.contains(&name) || name.contains(&valid))
}

impl fmt::Display for Error {
    /// Writes one line. Control characters of repeated names are escaped.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let start = |f: &mut fmt::Formatter<'_>, place: &str| {
            if place.is_empty() { Ok(()) } else { write!(f, "{}: ", OneLine(place)) }
        };
        match self {
            Self::Several(all) => {
                for (index, error) in all.iter().enumerate() {
                    write!(f, "{}{error}", if index > 0 { "; " } else { "" })?;
                }
                Ok(())
            }
            Self::Setting { place, key, why } => {
                start(f, place)?;
                if !key.is_empty() {
                    write!(f, "{}: ", Quoted(key))?;
                }
                write!(f, "{}", OneLine(why))
            }
            Self::Usage(why) | Self::Other(why) => f.write_str(why),
            Self::File { path, why, .. } => write!(f, "{}: {}", OneLine(path.display()), OneLine(why)),
            Self::Io { doing, path, source } => write!(f, "cannot {doing} {}: {source}", OneLine(path.display())),
            Self::Rank { rank, why, .. } => write!(f, "rank {rank}: {}", OneLine(why)),
            Self::Interrupted { resume } => write!(f, "interrupted; go on with `{}`", OneLine(resume)),
        }
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Io { source, .. } => Some(source),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn the_nearest_name_is_offered() {
        let valid = ["evolution.population", "evolution.parents", "world.step"];
        assert_eq!(nearest("evolution.poplation", valid), Some((1, "evolution.population")));
        assert_eq!(nearest("step", valid), Some((6, "world.step")));
        assert_eq!(nearest("step", []), None);
        assert_eq!(nearest("World.Step", valid), Some((0, "world.step")));
        assert_eq!(nearest("WORLD.STEP", ["W", "WORLD.SEED", "world.step"]), Some((0, "world.step")));
        assert_eq!(nearest("ab", ["aB", "AB", "ab"]), Some((0, "ab")));
        let long = format!("world.step{}", "x".repeat(1 << 24));
        assert_eq!(nearest(&long, ["world.stop", "y"]).map(|(_, name)| name), Some("world.stop"));
        let error = Error::unknown("my.toml line 3", "key", "world.stpe", valid);
        assert_eq!(error.to_string(), "my.toml line 3: unknown key `world.stpe`; the nearest is `world.step`");
        assert_eq!(error.exit_code(), 2);
    }

    #[test]
    fn few_names_of_which_none_is_near_are_listed() {
        let message = |name: &str, valid: &[&str]| Error::unknown("", "key", name, valid.iter().copied()).to_string();
        let keys = ["fixed", "kind", "neurons", "kind"];
        assert_eq!(message("hidden", &keys), "unknown key `hidden`; there are `fixed`, `kind` and `neurons`");
        assert_eq!(message("hidden", &["kind"]), "unknown key `hidden`; the only one is `kind`");
        assert_eq!(message("hidden", &[]), "unknown key `hidden`; there is none");
        assert_eq!(message("neuron", &keys), "unknown key `neuron`; the nearest is `neurons`");
        // A name that contains the other, or is contained, is near.
        assert_eq!(message("neu", &keys), "unknown key `neu`; the nearest is `neurons`");
        assert_eq!(message("network.kind", &keys), "unknown key `network.kind`; the nearest is `kind`");
        let letters: Vec<String> = ('a'..='z').map(|letter| letter.to_string()).collect();
        let valid: Vec<&str> = letters.iter().map(String::as_str).collect();
        assert_eq!(message("ö", &valid[..2]), "unknown key `ö`; there are `a` and `b`");
        assert!(message("ö", &valid[..12]).ends_with(", `k` and `l`"));
        assert_eq!(message("ö", &valid[..13]), "unknown key `ö`; the nearest is `a`");
    }

    #[test]
    fn several_errors_stand_in_their_order() {
        let wrong = || Error::setting("a", "is wrong");
        assert_eq!(Error::several(vec![wrong()]).to_string(), "`a`: is wrong");
        let both = Error::several(vec![wrong(), Error::Other("b".into())]);
        assert_eq!((both.to_string().as_str(), both.exit_code()), ("`a`: is wrong; b", 2));
    }

    proptest! {
        #[test]
        fn no_name_that_is_passed_over_is_nearer(name in "[abAB]{0,8}", valid in vec("[abcAB]{0,8}", 0..8)) {
            let lower = name.to_lowercase();
            let distance = strsim::damerau_levenshtein;
            let naive = valid.iter().min_by_key(|valid| {
                let other = valid.to_lowercase();
                (distance(&lower, &other), !other.starts_with(&lower), distance(&name, valid))
            });
            let found = nearest(&name, valid.iter().map(String::as_str)).map(|(_, name)| name);
            prop_assert_eq!(found, naive.map(String::as_str));
        }
    }

    #[test]
    fn what_a_message_repeats_stays_on_its_line() {
        let (evil, shown) = ("a\nerror: \u{1b}[2J", "a\\nerror: \\u{1b}[2J");
        let path = || PathBuf::from(evil);
        for (error, message) in [
            (
                Error::unknown(evil, "key", evil, [evil]),
                format!("{shown}: unknown key `{shown}`; the nearest is `{shown}`"),
            ),
            (Error::setting(evil, evil), format!("`{shown}`: {shown}")),
            (Error::damaged(&path(), evil), format!("{shown}: {shown}")),
            (Error::no_run(&path(), evil), format!("{shown}: {shown}")),
            (
                Error::io("read", &path())(io::ErrorKind::NotFound.into()),
                format!("cannot read {shown}: entity not found"),
            ),
            (
                Error::other_configuration(&path(), evil, evil, evil),
                format!(
                    "the run in {shown} has `{shown}` = {shown}, not {shown}: another configuration is another run"
                ),
            ),
        ] {
            assert_eq!(error.to_string(), message);
        }
        let long = Error::unknown("", "key", &"k".repeat(1 << 20), ["a"]).to_string();
        assert_eq!(long, format!("unknown key `{}...`; the only one is `a`", "k".repeat(MAX_SHOWN)));
    }

    #[test]
    fn what_cannot_be_built_says_why() {
        fn wheels() -> Result<farsa_body::motors::WheelVelocity<u8>, Error> {
            Ok(farsa_body::motors::WheelVelocity::new([0, 1], -2.0)?)
        }
        let error = wheels().unwrap_err();
        assert_eq!((error.to_string().as_str(), error.exit_code()), ("largest speed is -2", 1));
    }
}
