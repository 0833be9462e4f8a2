//! Identity of a run: everything that its results depend on.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::error::{Error, FileFault};
use crate::experiment::settings::Value;

/// Version of the values that this library computes.
///
/// It is increased whenever a change in the crates below experiments leads to different trials in every world, for the
/// same configuration, seed and genes. A change in an experiment, or of one kind of world, increases
/// [`Experiment::values_version`](crate::Experiment::values_version) of the experiments concerned.
pub const VALUES_VERSION: u32 = 3;

/// Start of the keys of file checksums in the settings of an [`Identity`]. Keys of settings have no blanks.
pub(crate) const FILE: &str = "CRC-32 of ";

/// Everything that the results of a run depend on. It is part of every file that is only valid for one run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Identity {
    pub(crate) experiment: String,
    pub(crate) condition: String,
    pub(crate) seed: u64,
    pub(crate) values_version: u32,
    pub(crate) experiment_version: u32,
    /// Every setting except the number of generations, followed by the checksums of files.
    pub(crate) settings: Vec<(String, Value)>,
}

impl Identity {
    /// Checks that `asked` is the same run as this one, read from a file of `directory`.
    ///
    /// Settings that only one of them has belong to another version with equal values.
    pub(crate) fn same_run(&self, asked: &Self, directory: &Path) -> Result<(), Error> {
        let pairs = [
            ("experiment", &self.experiment, &asked.experiment),
            ("condition", &self.condition, &asked.condition),
            ("seed", &self.seed.to_string(), &asked.seed.to_string()),
        ];
        let mut differing = pairs
            .into_iter()
            .filter(|(_, run, asked)| run != asked)
            .map(|(k, r, a)| (k.to_owned(), r.clone(), a.clone()));
        let mut settings = self.settings.iter().filter_map(|(key, run)| {
            let (_, asked) = asked.settings.iter().find(|(other, _)| other == key)?;
            (run != asked).then(|| (key.clone(), run.to_string(), asked.to_string()))
        });
        match differing.next().or_else(|| settings.next()) {
            None => Ok(()),
            Some((key, run, asked)) if key.starts_with(FILE) => {
                let [run, actual] = [run, asked].map(|checksum| checksum.replace('"', ""));
                let directory = directory.display();
                let why =
                    format!("is another file than the run in {directory} was made with (CRC-32 {actual}, not {run})");
                Err(Error::damaged(key[FILE.len()..].as_ref(), why))
            }
            Some((key, run, asked)) => Err(Error::other_configuration(directory, &key, &run, &asked)),
        }
    }

    /// Iterates over the files that the results depend on, with the checksums of their content.
    pub(crate) fn files(&self) -> impl Iterator<Item = (&str, &Value)> {
        self.settings.iter().filter_map(|(key, value)| Some((key.strip_prefix(FILE)?, value)))
    }

    /// Checks that this program computes the trials of the file `path` in the same way.
    pub(crate) fn same_values(&self, program: &Self, path: &Path) -> Result<(), Error> {
        let versions = [
            ("FARSA's values".to_owned(), self.values_version, program.values_version),
            (format!("the values of {}", self.experiment), self.experiment_version, program.experiment_version),
        ];
        match versions.into_iter().find(|(_, file, program)| file != program) {
            None => Ok(()),
            Some((what, file, program)) => {
                let why = format!(
                    "made with version {file} of {what}, this program has version {program}: \
                     the same genes would give other results"
                );
                Err(Error::File { path: path.into(), why, fault: FileFault::OtherVersion })
            }
        }
    }
}
