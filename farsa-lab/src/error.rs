//! Why a command did not do what it was asked, and the exit code that says so.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use crate::escaped::{MAX_SHOWN, OneLine, Quoted};

/// The most names that a message lists.
const MOST_LISTED: usize = 12;

/// What went wrong, with the name of the thing it went wrong with.
#[derive(Debug)]
#[non_exhaustive]
pub enum Error {
    /// An unknown name.
    Unknown {
        /// Where the name stands, such as `my.toml line 3` or `--set`; empty if it is plain from the command line.
        place: String,
        /// What it should be the name of.
        what: &'static str,
        /// The name.
        name: String,
        /// The valid name that looks most like it, if there are any.
        nearest: Option<String>,
        /// All valid names, where they are few and none looks like it.
        valid: Vec<String>,
    },
    /// What is wrong with a file, one thing after the other; never empty.
    Several(Vec<Self>),
    /// A value that a setting cannot have.
    Setting {
        /// Where the value stands, such as `my.toml line 3` or `--set`; empty if that is not known.
        place: String,
        /// The setting's key; empty if it is a file as a whole.
        key: String,
        /// What is wrong with the value.
        why: String,
    },
    /// A command line or a configuration that makes no sense as a whole.
    Usage(String),
    /// A run that was asked to go on with another value of a setting.
    OtherConfiguration {
        /// The run's directory.
        directory: PathBuf,
        /// The setting's key.
        key: String,
        /// The value of the run.
        run: String,
        /// The value asked for.
        asked: String,
    },
    /// A run that depends on a file whose content is no longer what it was.
    OtherFile {
        /// The file.
        path: PathBuf,
        /// The run's directory.
        directory: PathBuf,
        /// CRC-32 of the file that the run was made with.
        run: String,
        /// CRC-32 of the file as it is.
        found: String,
    },
    /// A run whose trials would differ in this program.
    OtherVersion {
        /// The file that says so.
        path: PathBuf,
        /// Which version differs.
        what: String,
        /// The version in the file.
        file: u32,
        /// The version of this program.
        program: u32,
    },
    /// A directory that is in use, so that nothing can be written there.
    Occupied {
        /// The directory.
        directory: PathBuf,
        /// By what, and what to do about it.
        why: String,
    },
    /// A directory that holds no run.
    NoRun {
        /// The directory.
        directory: PathBuf,
        /// What is missing.
        why: String,
    },
    /// A file of a run that is truncated, altered or none of ours.
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        why: String,
    },
    /// The operating system refused to read or write.
    Io {
        /// What was being done.
        doing: &'static str,
        /// The file or directory.
        path: PathBuf,
        /// Its reason.
        source: io::Error,
    },
    /// The strategy panicked, which is a mistake in it; a trial that panics is a failed trial.
    Panicked {
        /// The generation.
        generation: u32,
        /// Its message, and the place in the source.
        why: String,
    },
    /// A trial that was replayed panicked, as the process has said already.
    TrialPanicked {
        /// The generation.
        generation: u32,
        /// The individual.
        individual: u32,
        /// Its trial.
        trial: u32,
    },
    /// What went wrong on another rank of those that run a command together.
    Rank {
        /// Its number.
        rank: usize,
        /// The exit code of the error there.
        code: u8,
        /// Its message.
        why: String,
    },
    /// Anything else an experiment has to complain about.
    Other(String),
    /// The user pressed Ctrl-C; all finished generations are kept.
    Interrupted {
        /// How to go on.
        resume: String,
    },
}

impl Error {
    /// A value that does not go together with others; for [`Experiment::prepare`](crate::Experiment::prepare).
    pub fn setting(key: &str, why: impl fmt::Display) -> Self {
        Self::Setting { place: String::new(), key: key.into(), why: why.to_string() }
    }

    /// An unknown name, with the nearest of the valid ones, or with all of them where they are few and none is near.
    pub fn unknown<'a>(place: &str, what: &'static str, name: &str, valid: impl IntoIterator<Item = &'a str>) -> Self {
        let mut few: Vec<&str> = Vec::new();
        let listed = valid.into_iter().inspect(|one| {
            if few.len() <= MOST_LISTED && !few.contains(one) {
                few.push(one);
            }
        });
        let nearest = nearest(name, listed);
        let near = nearest.is_some_and(|(letters, valid)| is_near(name, valid, letters));
        if near || few.len() > MOST_LISTED {
            few.clear();
        }
        few.sort_unstable();
        Self::Unknown {
            place: place.into(),
            what,
            name: name.into(),
            nearest: nearest.map(|(_, valid)| valid.into()),
            valid: few.into_iter().map(str::to_owned).collect(),
        }
    }

    /// What is wrong with a file, of one error or more; a single one stays what it is.
    pub fn several(mut all: Vec<Self>) -> Self {
        match all.pop() {
            Some(only) if all.is_empty() => only,
            last => {
                all.extend(last);
                Self::Several(all)
            }
        }
    }

    /// An error of the operating system, as a function for `map_err`.
    pub fn io(doing: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::Io { doing, path: path.into(), source }
    }

    /// A file that would be larger than any that is read in its place, and is not written.
    pub(crate) fn too_large(path: &Path, bytes: u64, most: u64) -> Self {
        Self::Other(format!("{}: would have {bytes} bytes, more than the {most} that are read of it", path.display()))
    }

    /// A file that cannot be what it should be.
    pub(crate) fn damaged(path: &Path, why: impl fmt::Display) -> Self {
        Self::Damaged { path: path.into(), why: why.to_string() }
    }

    /// The process's exit code: 2 for a wrong command line or configuration, 130 after Ctrl-C, 1 otherwise.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Unknown { .. }
            | Self::Setting { .. }
            | Self::Usage(_)
            | Self::OtherConfiguration { .. }
            | Self::Occupied { .. }
            | Self::NoRun { .. } => 2,
            Self::OtherVersion { .. }
            | Self::OtherFile { .. }
            | Self::Damaged { .. }
            | Self::Io { .. }
            | Self::Panicked { .. }
            | Self::TrialPanicked { .. }
            | Self::Other(_) => 1,
            Self::Rank { code, .. } => *code,
            Self::Several(all) => all.iter().map(Self::exit_code).max().unwrap_or(1),
            Self::Interrupted { .. } => 130,
        }
    }
}

/// What robots, worlds, sensors, networks and strategies cannot be built from, so that `?` suffices in
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
                Self::Unknown { place: String::new(), what: "camera", name, nearest, valid: Vec::new() }
            }
            other => Self::Other(other.to_string()),
        }
    }
}

/// The name that takes the fewest changed, added, dropped or swapped letters, of several one that begins like this; letters of
/// the other case count least. Of a name
/// longer than any, the beginning is compared. With it comes how many letters that are.
fn nearest<'a>(name: &str, valid: impl IntoIterator<Item = &'a str>) -> Option<(usize, &'a str)> {
    let name: String = name.chars().take(MAX_SHOWN).collect();
    let lower = name.to_lowercase();
    let length = lower.chars().count();
    let distance = strsim::damerau_levenshtein;
    let mut best: Option<(usize, &str)> = None;
    for valid in valid {
        let other = valid.to_lowercase();
        // Each letter that one has more is one to drop: most names need not be compared.
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

/// Whether one may have been meant by the other, so many letters apart: half of the longer one is right, or one is in the other.
fn is_near(name: &str, valid: &str, letters: usize) -> bool {
    let [name, valid] = [name, valid].map(|text| text.chars().take(MAX_SHOWN).collect::<String>().to_lowercase());
    let longest = name.chars().count().max(valid.chars().count());
    2 * letters <= longest || !name.is_empty() && (valid.contains(&name) || name.contains(&valid))
}

impl fmt::Display for Error {
    /// In one line: what a message repeats of files and names is escaped where it would begin another.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let start = |f: &mut fmt::Formatter<'_>, place: &str| {
            if place.is_empty() { Ok(()) } else { write!(f, "{}: ", OneLine(place)) }
        };
        match self {
            Self::Unknown { place, what, name, nearest, valid } => {
                start(f, place)?;
                write!(f, "unknown {what} {}", Quoted(name))?;
                match (nearest, valid.as_slice()) {
                    (None, []) => write!(f, "; there is none"),
                    (Some(nearest), []) => write!(f, "; the nearest is {}", Quoted(nearest)),
                    (_, [only]) => write!(f, "; the only one is {}", Quoted(only)),
                    (_, [first @ .., last]) => {
                        write!(f, "; there are ")?;
                        for (index, name) in first.iter().enumerate() {
                            write!(f, "{}{}", if index > 0 { ", " } else { "" }, Quoted(name))?;
                        }
                        write!(f, " and {}", Quoted(last))
                    }
                }
            }
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
            Self::OtherConfiguration { directory, key, run, asked } => write!(
                f,
                "the run in {} has {} = {}, not {}: another configuration is another run",
                OneLine(directory.display()),
                Quoted(key),
                OneLine(run),
                OneLine(asked)
            ),
            Self::OtherFile { path, directory, run, found } => write!(
                f,
                "{}: is another file than the run in {} was made with (CRC-32 {}, not {})",
                OneLine(path.display()),
                OneLine(directory.display()),
                OneLine(found),
                OneLine(run)
            ),
            Self::OtherVersion { path, what, file, program } => write!(
                f,
                "{}: made with version {file} of {}, this program has version {program}: \
                 the same genes would give other results",
                OneLine(path.display()),
                OneLine(what)
            ),
            Self::Occupied { directory, why } | Self::NoRun { directory, why } => {
                write!(f, "{}: {}", OneLine(directory.display()), OneLine(why))
            }
            Self::Damaged { path, why } => write!(f, "{}: {}", OneLine(path.display()), OneLine(why)),
            Self::Io { doing, path, source } => write!(f, "cannot {doing} {}: {source}", OneLine(path.display())),
            Self::Panicked { generation, why } => {
                write!(f, "the strategy panicked in generation {generation}: {}", OneLine(why))
            }
            Self::TrialPanicked { generation, individual, trial } => {
                write!(f, "trial {trial} of individual {individual} of generation {generation} panicked")
            }
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
        let said = |name: &str, valid: &[&str]| Error::unknown("", "key", name, valid.iter().copied()).to_string();
        let keys = ["fixed", "kind", "neurons", "kind"];
        assert_eq!(said("hidden", &keys), "unknown key `hidden`; there are `fixed`, `kind` and `neurons`");
        assert_eq!(said("hidden", &["kind"]), "unknown key `hidden`; the only one is `kind`");
        assert_eq!(said("hidden", &[]), "unknown key `hidden`; there is none");
        assert_eq!(said("neuron", &keys), "unknown key `neuron`; the nearest is `neurons`");
        // A name that contains the other, or is contained, is near.
        assert_eq!(said("neu", &keys), "unknown key `neu`; the nearest is `neurons`");
        assert_eq!(said("network.kind", &keys), "unknown key `network.kind`; the nearest is `kind`");
        let letters: Vec<String> = ('a'..='z').map(|letter| letter.to_string()).collect();
        let valid: Vec<&str> = letters.iter().map(String::as_str).collect();
        assert_eq!(said("ö", &valid[..2]), "unknown key `ö`; there are `a` and `b`");
        assert!(said("ö", &valid[..12]).ends_with(", `k` and `l`"));
        assert_eq!(said("ö", &valid[..13]), "unknown key `ö`; the nearest is `a`");
    }

    #[test]
    fn several_errors_stand_in_their_order() {
        let one = || Error::setting("a", "is wrong");
        assert_eq!(Error::several(vec![one()]).to_string(), "`a`: is wrong");
        let both = Error::several(vec![one(), Error::Other("b".into())]);
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
            (Error::NoRun { directory: path(), why: evil.into() }, format!("{shown}: {shown}")),
            (
                Error::io("read", &path())(io::ErrorKind::NotFound.into()),
                format!("cannot read {shown}: entity not found"),
            ),
            (
                Error::OtherConfiguration { directory: path(), key: evil.into(), run: evil.into(), asked: evil.into() },
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
