//! Experiments and strategies that a command finds by name.

use std::path::Path;

use crate::error::Error;
use crate::escaped::Quoted;
use crate::run::config_file::ConfigFile;
use crate::run::experiment::Experiment;
use crate::run::imported_file::ImportedFile;
use crate::run::vocabulary::{Part, Vocabulary};
use crate::store::bounded;
use crate::strategy::definition::StrategyDefinition;
use crate::strategy::known;

/// A collection of experiments and strategies, and the command that runs them.
///
/// Use it in the `main` function of your program:
///
/// ```no_run
/// use std::process::ExitCode;
///
/// use farsa_lab::{Experiment, Laboratory};
/// use farsa_lab::strategy::StrategyDefinition;
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
    parts: Vec<Part>,
    module: Option<(&'static [u8], &'static [&'static str])>,
}

/// Builds an experiment from the text of a file with the given name. The text may use the given strategies and parts.
///
/// If the text refers to other files, they are read from `folder`. Note that the text stored in a run has no folder, since
/// it already contains everything and reads no file.
///
/// # Errors
/// Returns an error with file, line and key if the text is invalid, or an error in one of the files that it refers to.
pub type ReadExperiment =
    fn(name: &str, text: &str, folder: Option<&Path>, vocabulary: Vocabulary<'_>) -> Result<Box<dyn Experiment>, Error>;

/// Converts the content of `file`, in another format, into the text of an experiment file `name`.
///
/// # Errors
/// Returns an error with file, line and key if the text is invalid.
pub type ImportExperiment = fn(file: &str, name: &str, text: &str) -> Result<ImportedFile, Error>;

/// Functions that read experiments from files.
#[derive(Clone, Copy)]
pub struct ExperimentFiles {
    /// Builds an experiment from a text.
    pub read: ReadExperiment,
    /// Generates the schema of files with these parts, as JSON.
    pub schema: fn(parts: &[Part]) -> Result<String, Error>,
    /// Templates for a new file. Put the default template first.
    pub templates: &'static [Template],
    /// Files of a crate with custom parts, for `farsa new --parts`, by their paths in it. `NAME` is replaced by its name.
    pub crate_with_parts: &'static [(&'static str, &'static str)],
    /// Converts a configuration of the 2013 program into such a file. Use `None` if your program does not need
    /// `farsa import FILE.ini`.
    pub import: Option<ImportExperiment>,
}

/// A template for a new experiment file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Template {
    /// Name of the template.
    pub name: &'static str,
    /// Short description of the experiment, in one line.
    pub summary: &'static str,
    /// Text of the new file.
    pub text: &'static str,
}

/// Extension of files that describe experiments.
pub(crate) const FILE: &str = ".toml";
/// Bytes of the largest experiment file.
pub(crate) const MAX_BYTES: u64 = 1_000_000;

impl<'e> Laboratory<'e> {
    /// Creates a laboratory with the given experiments and all strategies of this crate.
    ///
    /// This order is also the one in which experiments are listed.
    pub fn new(experiments: &[&'e dyn Experiment]) -> Self {
        let strategies = known::strategies().to_vec();
        Self { experiments: experiments.to_vec(), strategies, files: None, parts: Vec::new(), module: None }
    }

    /// Adds a strategy for `--strategy NAME`. If there already is a strategy with this name, it is replaced.
    #[must_use]
    pub fn with_strategy(mut self, strategy: &'static dyn StrategyDefinition) -> Self {
        self.strategies.retain(|other| other.name() != strategy.name());
        self.strategies.push(strategy);
        self
    }

    /// Adds support for experiments from files, as in `farsa run NAME.toml`.
    #[must_use]
    pub fn with_files(self, files: ExperimentFiles) -> Self {
        Self { files: Some(files), ..self }
    }

    /// Adds a part that experiment files may name, such as a sensor of your crate.
    ///
    /// Parts are created by the crate that reads the files. See `farsa_compose::part`.
    #[must_use]
    pub fn with_part(mut self, part: Part) -> Self {
        self.parts.push(part);
        self
    }

    /// Adds interactive pages for `farsa live`.
    ///
    /// The `module` is a program with these experiments, compiled to WebAssembly and compressed by gzip or xz. Use `lacking`
    /// to name the worlds ([`ENGINE`](crate::advanced::ENGINE)) that it does not include.
    #[must_use]
    pub fn with_live_module(self, module: &'static [u8], lacking: &'static [&'static str]) -> Self {
        Self { module: Some((module, lacking)), ..self }
    }

    /// Gets the module of live pages and the worlds that it lacks.
    pub(crate) fn live_module(&self) -> Option<(&'static [u8], &'static [&'static str])> {
        self.module
    }

    /// Gets the experiments, in the order in which they are listed.
    pub fn experiments(&self) -> &[&'e dyn Experiment] {
        &self.experiments
    }

    /// Gets all strategies, including those added by [`with_strategy`](Self::with_strategy).
    pub fn strategies(&self) -> &[&'static dyn StrategyDefinition] {
        &self.strategies
    }

    /// Returns the strategies and parts that a file may name.
    pub(crate) fn vocabulary(&self) -> Vocabulary<'_> {
        Vocabulary { strategies: &self.strategies, parts: &self.parts }
    }

    /// Returns the functions that read experiments from files.
    ///
    /// # Errors
    /// [`Error::Usage`] for a program without them.
    pub(crate) fn files(&self) -> Result<&ExperimentFiles, Error> {
        self.files.as_ref().ok_or_else(|| Error::Usage("this program takes no files for experiments".into()))
    }

    /// Builds the experiment of a text, with the folder of the files that it names.
    ///
    /// The experiment is leaked. A process reads few of them.
    fn described(&self, name: &str, text: &str, folder: Option<&Path>) -> Result<&'e dyn Experiment, Error> {
        let read = (self.files()?.read)(name, text, folder, self.vocabulary());
        Ok(Box::leak(read.map_err(Error::into_usage)?))
    }

    /// Returns the experiment that a configuration names or describes.
    ///
    /// # Errors
    /// [`Error::Usage`] for a configuration without an experiment, and the errors of [`experiment`](Self::experiment).
    pub(crate) fn of_configuration(&self, file: &ConfigFile) -> Result<&'e dyn Experiment, Error> {
        match (&file.experiment, &file.definition) {
            (Some(name), Some(text)) => self.described(&format!("{}{FILE}", name.value), &text.value, None),
            (Some(name), None) => self.experiment(&name.value, &name.place),
            (None, _) => Err(Error::Usage(format!("{}: names no experiment", file.name))),
        }
    }

    /// Returns the experiment with a name found at `place`, or of a file.
    ///
    /// # Errors
    /// [`Error::Setting`] with the nearest name, [`Error::Usage`], and the errors of a file.
    pub(crate) fn experiment(&self, name: &str, place: &str) -> Result<&'e dyn Experiment, Error> {
        if is_file(name) {
            let path = Path::new(name);
            let text = bounded::read_stream_text(path, MAX_BYTES).map_err(|error| match file_of(name) {
                Some(other) if !path.exists() => missing(place, name, &other),
                _ => error,
            })?;
            return self.described(name, &text, path.parent());
        }
        if let Some(file) = self.file(name) {
            return self.experiment(&file, place);
        }
        let names = self.experiments.iter().map(|experiment| experiment.name());
        let found = self.experiments.iter().copied().find(|experiment| experiment.name() == name);
        found.ok_or_else(|| match self.files.and_then(|_| file_of(name)) {
            Some(file) => missing(place, name, &file),
            None => Error::unknown(place, "experiment", name, names),
        })
    }

    /// Returns the experiment of a text in place of the file of this name.
    ///
    /// # Errors
    /// The errors of the text.
    pub(crate) fn experiment_of_text(&self, name: &str, text: &str) -> Result<&'e dyn Experiment, Error> {
        self.described(name, text, Path::new(name).parent())
    }

    /// Returns the file of a name: the name itself, or NAME.toml if this is a file and no built-in experiment has the name.
    pub(crate) fn file(&self, name: &str) -> Option<String> {
        if is_file(name) {
            return Some(name.into());
        }
        let built_in = self.experiments.iter().any(|experiment| experiment.name() == name);
        let file = format!("{name}{FILE}");
        (self.files.is_some() && !built_in && Path::new(&file).is_file()).then_some(file)
    }

    /// Returns the strategy with a name found at `place`.
    ///
    /// # Errors
    /// [`Error::Setting`] with the nearest name.
    pub(crate) fn strategy(&self, name: &str, place: &str) -> Result<&'static dyn StrategyDefinition, Error> {
        known::find(&self.strategies, name, place)
    }
}

/// Checks if a name is that of a file.
pub(crate) fn is_file(name: &str) -> bool {
    name.to_lowercase().ends_with(FILE)
}

/// Builds the error of a name that is almost that of a file.
fn missing(place: &str, name: &str, file: &str) -> Error {
    let why = format!("there is no experiment {}; the file is {}", Quoted(name), Quoted(file));
    Error::Setting { place: place.into(), key: String::new(), why }
}

/// Finds the file of an experiment whose name lacks `.toml`, or has other capitals.
fn file_of(name: &str) -> Option<String> {
    let path = Path::new(name);
    let stem = path.file_name()?.to_str()?;
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let wanted = [stem.to_lowercase(), format!("{}{FILE}", stem.to_lowercase())];
    let entries = std::fs::read_dir(folder.unwrap_or(Path::new("."))).ok()?;
    let files = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let found = files.filter(|file| file.to_lowercase().ends_with(FILE) && wanted.contains(&file.to_lowercase()));
    // The name that differs least: the capitals as given come first.
    let found = found.min_by_key(|file| (!file.starts_with(stem), file.clone()))?;
    Some(folder.map_or(found.clone(), |folder| folder.join(&found).display().to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns its arguments as an error.
    fn read(name: &str, text: &str, folder: Option<&Path>, _: Vocabulary<'_>) -> Result<Box<dyn Experiment>, Error> {
        Err(Error::Other(format!("{name}, {text}, {folder:?}")))
    }

    #[test]
    fn files_are_named_without_extension_and_in_other_capitals() {
        let files = ExperimentFiles {
            read,
            schema: |_| Ok(String::new()),
            templates: &[],
            crate_with_parts: &[],
            import: None,
        };
        let laboratory = Laboratory::new(&[]).with_files(files);
        let folder = std::env::temp_dir().join(format!("farsa-names-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        for name in ["follow.toml", "Other.TOML"] {
            std::fs::write(folder.join(name), "text").unwrap();
        }
        let path = |name: &str| folder.join(name).display().to_string();
        let found = |name: &str| laboratory.experiment(&path(name), "").err().unwrap();
        for (name, file) in [
            ("Follow", "follow.toml"),
            ("FOLLOW.TOML", "follow.toml"),
            ("other", "Other.TOML"),
            ("other.toml", "Other.TOML"),
        ] {
            let error = found(name);
            let wanted = format!("there is no experiment `{}`; the file is `{}`", path(name), path(file));
            assert_eq!((error.to_string(), error.exit_code()), (wanted, 2));
        }
        for (name, file) in [("follow.toml", "follow.toml"), ("follow", "follow.toml"), ("Other.TOML", "Other.TOML")] {
            assert!(found(name).to_string().starts_with(&format!("{}, text", path(file))));
        }
        assert!(found("folow").to_string().contains("unknown experiment"));
        let absent = found("absent.toml");
        assert!(absent.to_string().starts_with("cannot read ") && absent.exit_code() == 2, "{absent}");
        std::fs::remove_dir_all(folder).unwrap();
    }

    /// A run directory may be untrusted, so its text cannot name files of the current folder.
    #[test]
    fn only_files_of_the_user_have_a_folder() {
        let files = ExperimentFiles {
            read,
            schema: |_| Ok(String::new()),
            templates: &[],
            crate_with_parts: &[],
            import: None,
        };
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
