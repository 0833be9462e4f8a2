//! The experiments and strategies that a command knows by name.

use std::path::Path;

use crate::error::Error;
use crate::experiment::definition::Experiment;
use crate::run::config_file::ConfigFile;
use crate::run::imported_file::ImportedFile;
use crate::store::bounded;
use crate::strategy::definition::StrategyDefinition;
use crate::strategy::known;

/// Experiments and strategies by name: what the command is over.
///
/// ```no_run
/// use std::process::ExitCode;
///
/// use farsa_lab::{Experiment, Laboratory, StrategyDefinition};
///
/// fn command(experiments: &[&dyn Experiment], mine: &'static dyn StrategyDefinition) -> ExitCode {
///     Laboratory::new(experiments).with_strategy(mine).main()
/// }
/// ```
#[derive(Clone)]
pub struct Laboratory<'e> {
    experiments: Vec<&'e dyn Experiment>,
    strategies: Vec<&'static dyn StrategyDefinition>,
    files: Option<ExperimentFiles>,
    module: Option<(&'static [u8], &'static [&'static str])>,
}

/// Makes an experiment of a text, which is the content of a file of a name; it may name these strategies.
///
/// Files that the text names are read from `folder`. A text that a run has kept comes without one, wherever the command is
/// called: it has in it what it needs, and reads no file.
///
/// # Errors
/// What is wrong with the text, with file, line and key, and a file that it names and cannot have.
pub type ReadExperiment = fn(
    name: &str,
    text: &str,
    folder: Option<&Path>,
    strategies: &[&'static dyn StrategyDefinition],
) -> Result<Box<dyn Experiment>, Error>;

/// Makes the text of a file `name` of a text in another format, which is the content of `file`.
///
/// # Errors
/// What is wrong with the text, with file, line and key.
pub type ImportExperiment = fn(file: &str, name: &str, text: &str) -> Result<ImportedFile, Error>;

/// How experiments are described by files.
#[derive(Clone, Copy)]
pub struct ExperimentFiles {
    /// Makes an experiment of a text.
    pub read: ReadExperiment,
    /// The schema of the files, as JSON.
    pub schema: fn() -> String,
    /// What a new file may begin as, the default one first.
    pub templates: &'static [Template],
    /// Converts a configuration of the 2013 program into such a file; `None` in programs without `farsa import FILE.ini`.
    pub import: Option<ImportExperiment>,
}

/// What a new file may begin as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Template {
    /// Its name.
    pub name: &'static str,
    /// What it describes, in one line.
    pub summary: &'static str,
    /// The file.
    pub text: &'static str,
}

/// What names of files end with that describe an experiment.
pub(crate) const FILE: &str = ".toml";
/// The most bytes of such a file.
pub(crate) const MAX_BYTES: u64 = 1_000_000;

impl<'e> Laboratory<'e> {
    /// These experiments, in the order in which they are listed, with the strategies of this crate.
    pub fn new(experiments: &[&'e dyn Experiment]) -> Self {
        Self { experiments: experiments.to_vec(), strategies: known::strategies().to_vec(), files: None, module: None }
    }

    /// Adds a strategy for `--strategy NAME`; one of the same name goes.
    #[must_use]
    pub fn with_strategy(mut self, strategy: &'static dyn StrategyDefinition) -> Self {
        self.strategies.retain(|other| other.name() != strategy.name());
        self.strategies.push(strategy);
        self
    }

    /// Takes files for experiments, too: `farsa run NAME.toml`.
    #[must_use]
    pub fn with_files(self, files: ExperimentFiles) -> Self {
        Self { files: Some(files), ..self }
    }

    /// Makes pages that run agents by themselves, too: `farsa live`; `module` is these experiments as WebAssembly, compressed by
    /// gzip or xz, and `lacking` names the worlds ([`ENGINE`](crate::ENGINE)) that it is built without.
    #[must_use]
    pub fn with_live_module(self, module: &'static [u8], lacking: &'static [&'static str]) -> Self {
        Self { module: Some((module, lacking)), ..self }
    }

    /// The module of live pages and the worlds that it lacks, if there is one.
    pub(crate) fn live_module(&self) -> Option<(&'static [u8], &'static [&'static str])> {
        self.module
    }

    /// The experiments.
    pub fn experiments(&self) -> &[&'e dyn Experiment] {
        &self.experiments
    }

    /// The strategies.
    pub fn strategies(&self) -> &[&'static dyn StrategyDefinition] {
        &self.strategies
    }

    /// How experiments are described by files.
    ///
    /// # Errors
    /// [`Error::Usage`] for a program that takes none.
    pub(crate) fn files(&self) -> Result<&ExperimentFiles, Error> {
        self.files.as_ref().ok_or_else(|| Error::Usage("this program takes no files for experiments".into()))
    }

    /// The experiment of a text that names files in a folder, or none.
    ///
    /// It lasts as long as the process, like those that are built in; a process reads few.
    fn described(&self, name: &str, text: &str, folder: Option<&Path>) -> Result<&'e dyn Experiment, Error> {
        Ok(Box::leak((self.files()?.read)(name, text, folder, &self.strategies)?))
    }

    /// The experiment that a configuration names or describes.
    ///
    /// # Errors
    /// [`Error::Usage`] where it does neither, and those of [`experiment`](Self::experiment).
    pub(crate) fn of_configuration(&self, file: &ConfigFile) -> Result<&'e dyn Experiment, Error> {
        match (&file.experiment, &file.definition) {
            (Some(name), Some(text)) => self.described(&format!("{}{FILE}", name.value), &text.value, None),
            (Some(name), None) => self.experiment(&name.value, &name.place),
            (None, _) => Err(Error::Usage(format!("{}: names no experiment", file.name))),
        }
    }

    /// The experiment of a name, which stands at `place`, or of a file.
    ///
    /// # Errors
    /// [`Error::Unknown`] with the nearest name, [`Error::Io`] and what is wrong with a file.
    pub(crate) fn experiment(&self, name: &str, place: &str) -> Result<&'e dyn Experiment, Error> {
        if name.ends_with(FILE) {
            let path = Path::new(name);
            let text = bounded::read_stream_text(path, MAX_BYTES).map_err(|error| match error {
                error @ Error::Damaged { .. } => Error::Usage(error.to_string()),
                other => other,
            })?;
            return self.described(name, &text, path.parent());
        }
        let names = self.experiments.iter().map(|experiment| experiment.name());
        let found = self.experiments.iter().copied().find(|experiment| experiment.name() == name);
        found.ok_or_else(|| Error::unknown(place, "experiment", name, names))
    }

    /// The strategy of a name, which stands at `place`.
    ///
    /// # Errors
    /// [`Error::Unknown`] with the nearest name.
    pub(crate) fn strategy(&self, name: &str, place: &str) -> Result<&'static dyn StrategyDefinition, Error> {
        known::find(&self.strategies, name, place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Says what it was given, as an error.
    fn read(
        name: &str,
        text: &str,
        folder: Option<&Path>,
        _: &[&'static dyn StrategyDefinition],
    ) -> Result<Box<dyn Experiment>, Error> {
        Err(Error::Other(format!("{name}, {text}, {folder:?}")))
    }

    /// What a run has kept may come from anyone: it names no files of the folder where the command is called.
    #[test]
    fn only_files_of_the_user_have_a_folder() {
        let files = ExperimentFiles { read, schema: String::new, templates: &[], import: None };
        let laboratory = Laboratory::new(&[]).with_files(files);
        let said = |found: Result<&dyn Experiment, Error>| found.err().map(|error| error.to_string());
        for name in ["own", "below/own", "/own"] {
            let config = format!("experiment = \"{name}\"\ndefinition = \"text\"\n");
            let config = ConfigFile::parse("config.toml", &config).unwrap();
            assert_eq!(said(laboratory.of_configuration(&config)), Some(format!("{name}.toml, text, None")));
        }
        let folder = std::env::temp_dir().join(format!("farsa-laboratory-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let path = folder.join("own.toml");
        std::fs::write(&path, "text").unwrap();
        let path = path.display().to_string();
        assert_eq!(said(laboratory.experiment(&path, "")), Some(format!("{path}, text, {:?}", Some(&folder))));
        std::fs::remove_dir_all(folder).unwrap();
    }
}
