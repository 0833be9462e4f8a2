//! What a run is: all that its results depend on.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::experiment::settings::Value;

/// Grows by one whenever the same configuration, seed and genes come to other trials through a change in the crates that
/// experiments are built of; see [`Experiment::values_version`](crate::Experiment::values_version) for changes in an experiment itself.
pub const VALUES_VERSION: u32 = 3;

/// What the checksums of files begin with among the settings of an [`Identity`]; no setting's key has a blank in it.
pub(crate) const FILE: &str = "CRC-32 of ";

/// All that the results of a run depend on; it stands in every file whose content means nothing without it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Identity {
    pub(crate) experiment: String,
    pub(crate) condition: String,
    pub(crate) seed: u64,
    pub(crate) values_version: u32,
    pub(crate) experiment_version: u32,
    /// Every setting but the number of generations, which a run does not depend on up to the last of them; then the
    /// checksums of files.
    pub(crate) settings: Vec<(String, Value)>,
}

impl Identity {
    /// Whether `asked` means the same run as this one, which was read from a file of `directory`.
    ///
    /// Settings that only one of them knows belong to another version with equal values.
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
                let (path, directory) = (key[FILE.len()..].into(), directory.into());
                Err(Error::OtherFile { path, directory, run: run.replace('"', ""), found: asked.replace('"', "") })
            }
            Some((key, run, asked)) => Err(Error::OtherConfiguration { directory: directory.into(), key, run, asked }),
        }
    }

    /// The files that the results depend on, each with the checksum of its content.
    pub(crate) fn files(&self) -> impl Iterator<Item = (&str, &Value)> {
        self.settings.iter().filter_map(|(key, value)| Some((key.strip_prefix(FILE)?, value)))
    }

    /// Whether this program computes the trials that the file `path` speaks of.
    pub(crate) fn same_values(&self, program: &Self, path: &Path) -> Result<(), Error> {
        let versions = [
            ("FARSA's values".to_owned(), self.values_version, program.values_version),
            (format!("the values of {}", self.experiment), self.experiment_version, program.experiment_version),
        ];
        match versions.into_iter().find(|(_, file, program)| file != program) {
            None => Ok(()),
            Some((what, file, program)) => Err(Error::OtherVersion { path: path.into(), what, file, program }),
        }
    }
}
