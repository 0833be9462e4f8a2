//! `manifest.json`: program version, machine and timings. No result depends on it.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::Path;
use std::thread;
use std::time::{SystemTime, UNIX_EPOCH};

use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::experiment::lanes::LanesInfo;
use crate::store::bounded::read_regular_text;
use crate::store::identity::Identity;
use crate::store::replace::replace;

/// Version of the format.
const FORMAT: u32 = 1;
/// Bytes of the largest manifest. A session takes about five hundred.
const MAX_BYTES: u64 = 64 << 20;

/// Manifest of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Manifest {
    /// Version of the format.
    pub(crate) format: u32,
    pub(crate) experiment: String,
    pub(crate) condition: String,
    pub(crate) seed: u64,
    /// [`crate::advanced::VALUES_VERSION`].
    pub(crate) values_version: u32,
    /// [`crate::Experiment::values_version`].
    pub(crate) experiment_version: u32,
    /// Files that trials depend on, with the CRC-32 of their content.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub(crate) files: BTreeMap<String, String>,
    /// Files of imported genotypes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) imported: Vec<String>,
    /// One session for the start and one for each resumption.
    pub(crate) sessions: Vec<Session>,
}

/// Work of one process.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Session {
    pub(crate) farsa: String,
    pub(crate) machine: Machine,
    pub(crate) threads: usize,
    /// Number of lanes in each thread, and their instructions.
    #[serde(flatten)]
    pub(crate) lanes: LanesInfo,
    /// Start time in seconds since 1970, UTC.
    pub(crate) started_unix: u64,
    pub(crate) seconds: f64,
    pub(crate) first_generation: u32,
    /// Finished generations.
    pub(crate) generations: u32,
    pub(crate) evaluations: u64,
}

/// Machine of a session.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Machine {
    os: String,
    architecture: String,
    processor: String,
    logical_processors: usize,
}

impl Manifest {
    /// Creates the manifest of a new run.
    pub(crate) fn new(identity: &Identity) -> Self {
        Self {
            format: FORMAT,
            experiment: identity.experiment.clone(),
            condition: identity.condition.clone(),
            seed: identity.seed,
            values_version: identity.values_version,
            experiment_version: identity.experiment_version,
            files: identity.files().map(|(path, crc)| (path.to_owned(), crc.to_string().replace('"', ""))).collect(),
            imported: Vec::new(),
            sessions: Vec::new(),
        }
    }

    /// Reads the file.
    ///
    /// # Errors
    /// [`Error::Io`], and [`Error::File`] for another format.
    pub(crate) fn read(path: &Path) -> Result<Self, Error> {
        Self::from_text(path, &read_regular_text(path, MAX_BYTES)?)
    }

    /// Parses the text of a manifest.
    pub(crate) fn from_text(path: &Path, text: &str) -> Result<Self, Error> {
        #[derive(Deserialize)]
        struct Format {
            format: u32,
        }
        let damaged = |error: serde_json::Error| Error::damaged(path, error);
        let Format { format } = serde_json::from_str(text).map_err(damaged)?;
        if format != FORMAT {
            return Err(Error::damaged(path, format!("has format {format}, this program reads format {FORMAT}")));
        }
        serde_json::from_str(text).map_err(damaged)
    }

    /// Reads the manifest of a run, or creates one if the file is missing.
    ///
    /// # Errors
    /// As [`read`](Self::read). An unreadable file may still be useful to the user.
    pub(crate) fn read_or_new(path: &Path, identity: &Identity) -> Result<Self, Error> {
        match fs::symlink_metadata(path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(Self::new(identity)),
            _ => Self::read(path),
        }
    }

    /// Writes the file.
    pub(crate) fn write(&self, path: &Path) -> Result<(), Error> {
        replace(path, self.text(path)?.as_bytes())
    }

    /// Formats the manifest.
    pub(crate) fn text(&self, path: &Path) -> Result<String, Error> {
        let mut text = serde_json::to_string_pretty(self).map_err(|error| Error::Io {
            doing: "write",
            path: path.into(),
            source: io::Error::other(error),
        })?;
        text.push('\n');
        Ok(text)
    }
}

impl Session {
    /// Starts a session.
    pub(crate) fn new(threads: usize, lanes: LanesInfo, first_generation: u32) -> Self {
        Self {
            farsa: env!("CARGO_PKG_VERSION").into(),
            machine: Machine::here(),
            threads,
            lanes,
            started_unix: SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs()),
            seconds: 0.0,
            first_generation,
            generations: 0,
            evaluations: 0,
        }
    }
}

impl Machine {
    /// Gets the number of processors that a process may use.
    pub(crate) fn cores(&self) -> usize {
        self.logical_processors
    }

    /// Describes the machine in a few words.
    pub(crate) fn describe(&self) -> String {
        let Self { os, architecture, processor, logical_processors } = self;
        let processor = if processor.is_empty() { "unknown processor" } else { processor };
        format!("{processor}, {logical_processors} logical processors, {os} {architecture}")
    }

    /// Describes the machine of this process.
    pub(crate) fn here() -> Self {
        // Only Linux has a file with the processor's name.
        let processor = fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| {
            let line = text.lines().find(|line| line.starts_with("model name"))?;
            Some(line.split_once(':')?.1.trim().to_owned())
        });
        Self {
            os: std::env::consts::OS.into(),
            architecture: std::env::consts::ARCH.into(),
            processor: processor.unwrap_or_default(),
            logical_processors: thread::available_parallelism().map_or(1, usize::from),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::lanes::Lanes;

    #[test]
    fn a_session_from_before_there_were_lanes_had_one() {
        let session = Session::new(2, Lanes::best().info(), 7);
        let mut json = serde_json::to_value(&session).unwrap();
        assert_eq!(serde_json::from_value::<Session>(json.clone()).unwrap(), session);
        let fields = json.as_object_mut().unwrap();
        assert!(fields.remove("lanes").is_some() && fields.remove("simd").is_some());
        assert_eq!(serde_json::from_value::<Session>(json).unwrap().lanes, Lanes::one().info());
    }
}
