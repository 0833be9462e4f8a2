//! What is to be run: an experiment, a condition, a seed and all settings; and the configuration file that says so.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use farsa_num::crc32;
use serde::{Deserialize, Serialize};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::VALUES_VERSION;
use crate::error::Error;
use crate::evolution::{self, GENERATIONS};
use crate::evaluator::Evaluator;
use crate::experiment::Experiment;
use crate::genotype::Genotype;
use crate::search::Search;
use crate::settings::{Settings, Value};

/// The largest seed of a run; bit 63 marks the lives of a test.
pub(crate) const LARGEST_SEED: u64 = i64::MAX as u64;

/// A run before its first life.
pub(crate) struct Plan<'e> {
    pub(crate) experiment: &'e dyn Experiment,
    pub(crate) condition: String,
    pub(crate) seed: u64,
    pub(crate) settings: Settings,
    /// The settings with another world, for lives that leave that of the run; none of the identity.
    pub(crate) elsewhere: Option<Settings>,
}

impl<'e> Plan<'e> {
    /// An experiment with its defaults under a condition, the first if none is named.
    pub(crate) fn new(experiment: &'e dyn Experiment, condition: Option<&str>, place: &str) -> Result<Self, Error> {
        let conditions = experiment.conditions();
        let condition = match condition {
            None => conditions.first().copied().unwrap_or_default(),
            // A run of an experiment without conditions writes none into its configuration.
            Some("") if conditions.is_empty() => "",
            Some(name) => conditions
                .iter()
                .find(|&&known| known == name)
                .ok_or_else(|| Error::unknown(place, "condition", name, conditions.iter().copied()))?,
        };
        let settings =
            Settings::new(evolution::complete(experiment.settings(condition), experiment.search(condition)))?;
        Ok(Self { experiment, condition: condition.into(), seed: 1, settings, elsewhere: None })
    }

    /// Takes the seed and the values of a configuration file; experiment and condition are the caller's business.
    pub(crate) fn apply(&mut self, file: &ConfigFile) -> Result<(), Error> {
        if let Some(seed) = &file.seed {
            self.seed = seed.value;
        }
        file.values.iter().try_for_each(|(key, entry)| self.settings.set(&entry.place, key, entry.value.clone()))
    }

    /// What a configuration file says, whole.
    pub(crate) fn of_file(experiments: &[&'e dyn Experiment], file: &ConfigFile) -> Result<Self, Error> {
        let Some(name) = &file.experiment else {
            return Err(Error::Usage(format!("{}: names no experiment", file.name)));
        };
        let experiment = find(experiments, &name.value, &name.place)?;
        let place = file.condition.as_ref().map_or("", |entry| &entry.place);
        let mut plan = Self::new(experiment, file.condition.as_ref().map(|entry| entry.value.as_str()), place)?;
        plan.apply(file)?;
        Ok(plan)
    }

    /// How the run searches.
    pub(crate) fn search(&self) -> Search {
        self.experiment.search(&self.condition)
    }

    /// The experiment made ready for one thread.
    pub(crate) fn evaluator(&self) -> Result<Box<dyn Evaluator>, Error> {
        self.experiment.prepare(&self.condition, self.elsewhere.as_ref().unwrap_or(&self.settings))
    }

    /// How genes stand for the parameters that an evaluator of this plan wants.
    pub(crate) fn genotype(&self, evaluator: &dyn Evaluator) -> Genotype {
        Genotype::new(&evaluator.parameters(), self.experiment.gene_bits())
    }

    /// Generations to evaluate.
    pub(crate) fn generations(&self) -> Result<u32, Error> {
        u32::try_from(self.settings.whole(GENERATIONS)?).map_err(|_| Error::setting(GENERATIONS, "is too large"))
    }

    /// The name of the run's directory below `runs/`.
    pub(crate) fn name(&self) -> String {
        let name = self.experiment.name();
        match self.condition.as_str() {
            "" => format!("{name}-{}", self.seed),
            condition => format!("{name}-{condition}-{}", self.seed),
        }
    }

    /// All that the results depend on, the content of files included.
    ///
    /// # Errors
    /// [`Error::Io`] for a file that cannot be read, and those of [`Experiment::files`].
    pub(crate) fn identity(&self) -> Result<Identity, Error> {
        let settings = self.settings.table().iter().filter(|setting| setting.key() != GENERATIONS);
        let mut settings: Vec<(String, Value)> = settings
            .filter_map(|setting| Some((setting.key().to_owned(), self.settings.get(setting.key()).ok()?.clone())))
            .collect();
        for path in self.experiment.files(&self.condition, &self.settings)? {
            let bytes = fs::read(&path).map_err(Error::io("read", &path))?;
            settings.push((format!("{FILE}{}", path.display()), Value::Word(format!("{:08x}", crc32(&bytes)))));
        }
        Ok(Identity {
            experiment: self.experiment.name().into(),
            condition: self.condition.clone(),
            seed: self.seed,
            values_version: VALUES_VERSION,
            experiment_version: self.experiment.values_version(),
            settings,
        })
    }

    /// Whether a record, which was read from a file of `directory`, is one of the run that is planned here.
    ///
    /// # Errors
    /// [`Error::OtherConfiguration`], [`Error::OtherFile`], and those of [`identity`](Self::identity).
    pub(crate) fn same_run(&self, record: &Identity, directory: &Path) -> Result<(), Error> {
        let mut asked = self.identity()?;
        // A run from before its experiment had conditions is one of what has become the first of them.
        if record.condition.is_empty() && self.experiment.conditions().first() == Some(&self.condition.as_str()) {
            asked.condition.clear();
        }
        record.same_run(&asked, directory)
    }

    /// The complete configuration as TOML, with the documentation, unit and source of every value.
    pub(crate) fn to_toml(&self) -> Result<String, Error> {
        let mut text =
            String::from("# The complete configuration of a run; `run --config` with this file repeats it.\n");
        // Writing into a string cannot fail.
        let _ = writeln!(text, "experiment = {:?}", self.experiment.name());
        if !self.condition.is_empty() {
            let _ = writeln!(text, "condition = {:?}", self.condition);
        }
        let _ = writeln!(text, "seed = {}", self.seed);
        let table = self.settings.table();
        let mut sections: Vec<&str> = Vec::new();
        for section in table.iter().filter_map(|setting| Some(setting.key().rsplit_once('.')?.0)) {
            if !sections.contains(&section) {
                sections.push(section);
            }
        }
        for section in sections {
            let _ = writeln!(text, "\n[{section}]");
            for setting in table {
                let Some((_, name)) = setting.key().rsplit_once('.').filter(|split| split.0 == section) else {
                    continue;
                };
                let unit = if setting.unit_name().is_empty() { "" } else { " " };
                let value = self.settings.get(setting.key())?;
                let changed = if value == setting.default_value() { "" } else { "not the default, which is " };
                let (doc, source, allowed) = (setting.doc_text(), setting.source().name(), setting.allowed());
                let _ = writeln!(text, "# {doc} [{allowed}{unit}{}; {changed}{source}]", setting.unit_name());
                let _ = writeln!(text, "{name} = {value}");
            }
        }
        Ok(text)
    }
}

/// The experiment of a name.
pub(crate) fn find<'e>(
    experiments: &[&'e dyn Experiment],
    name: &str,
    place: &str,
) -> Result<&'e dyn Experiment, Error> {
    let names = experiments.iter().map(|experiment| experiment.name());
    let found = experiments.iter().copied().find(|experiment| experiment.name() == name);
    found.ok_or_else(|| Error::unknown(place, "experiment", name, names))
}

/// What the checksums of files begin with among the settings of an [`Identity`]; no setting's key has a blank in it.
const FILE: &str = "CRC-32 of ";

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

    /// Whether this program lives the lives that the file `path` speaks of.
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

/// A value and where in a file it stands.
#[derive(Debug)]
pub(crate) struct Entry<T> {
    pub(crate) value: T,
    pub(crate) place: String,
}

/// What a configuration file says, before an experiment has seen it.
#[derive(Debug)]
pub(crate) struct ConfigFile {
    name: String,
    pub(crate) experiment: Option<Entry<String>>,
    pub(crate) condition: Option<Entry<String>>,
    seed: Option<Entry<u64>>,
    values: Vec<(String, Entry<Value>)>,
}

impl ConfigFile {
    /// Reads a file.
    ///
    /// # Errors
    /// [`Error::Io`], or [`Error::Setting`] or [`Error::Usage`] with the line.
    pub(crate) fn read(path: &Path) -> Result<Self, Error> {
        let text = fs::read_to_string(path).map_err(Error::io("read", path))?;
        Self::parse(&path.display().to_string(), &text)
    }

    fn parse(name: &str, text: &str) -> Result<Self, Error> {
        let place = |offset: usize| {
            let line = text.get(..offset).unwrap_or(text).matches('\n').count() + 1;
            format!("{name} line {line}")
        };
        let table = DeTable::parse(text).map_err(|error| {
            let place = error.span().map_or_else(|| name.to_owned(), |span| place(span.start));
            Error::Usage(format!("{place}: {}", error.message()))
        })?;
        let mut flat = Vec::new();
        flatten("", table.get_ref(), &place, &mut flat)?;
        let mut file = Self { name: name.into(), experiment: None, condition: None, seed: None, values: Vec::new() };
        for (key, entry) in flat {
            let wrong = |why: &str| Error::Setting { place: entry.place.clone(), key: key.clone(), why: why.into() };
            let word = || match &entry.value {
                Value::Word(word) => Ok(Some(Entry { value: word.clone(), place: entry.place.clone() })),
                _ => Err(wrong("is not a name in quotes")),
            };
            match key.as_str() {
                "experiment" => file.experiment = word()?,
                "condition" => file.condition = word()?,
                "seed" => match entry.value {
                    Value::Whole(seed) if seed >= 0 => {
                        file.seed = Some(Entry { value: seed.unsigned_abs(), place: entry.place });
                    }
                    _ => return Err(wrong("is not a whole number from 0 to 9223372036854775807")),
                },
                _ => file.values.push((key, entry)),
            }
        }
        Ok(file)
    }
}

/// Appends the values of a table and the tables in it under their full keys.
fn flatten(
    prefix: &str,
    table: &DeTable<'_>,
    place: &dyn Fn(usize) -> String,
    flat: &mut Vec<(String, Entry<Value>)>,
) -> Result<(), Error> {
    for (name, value) in table {
        let key = format!("{prefix}{}", name.get_ref());
        let place_of = place(name.span().start);
        if let DeValue::Table(inner) = value.get_ref() {
            flatten(&format!("{key}."), inner, place, flat)?;
        } else {
            let value = plain(value).map_err(|why| Error::Setting {
                place: place_of.clone(),
                key: key.clone(),
                why: why.into(),
            })?;
            flat.push((key, Entry { value, place: place_of }));
        }
    }
    Ok(())
}

/// A TOML value as a setting's value.
fn plain(value: &Spanned<DeValue<'_>>) -> Result<Value, &'static str> {
    match value.get_ref() {
        DeValue::Boolean(flag) => Ok(Value::Flag(*flag)),
        DeValue::String(word) => Ok(Value::Word(word.as_ref().into())),
        DeValue::Integer(n) => {
            i64::from_str_radix(n.as_str(), n.radix()).map(Value::Whole).map_err(|_| "is too large a number")
        }
        DeValue::Float(x) => x.as_str().parse().map(Value::Number).map_err(|_| "is not a number"),
        DeValue::Array(list) => {
            let numbers = list.iter().map(|item| match plain(item) {
                Ok(Value::Number(x)) => Ok(x),
                Ok(Value::Whole(n)) => Ok(n as f64),
                _ => Err("is not a list of numbers"),
            });
            numbers.collect::<Result<_, _>>().map(Value::Numbers)
        }
        DeValue::Datetime(_) | DeValue::Table(_) => Err("is not a flag, number, word or list of numbers"),
    }
}

/// Splits `key=value` as `--set` has it; what is no TOML value is a word.
pub(crate) fn assignment(text: &str) -> Result<(String, Value), String> {
    let (key, value) = text.split_once('=').ok_or("not of the form key=value")?;
    let (key, value) = (key.trim(), value.trim());
    let line = format!("x = {value}");
    let parsed = DeTable::parse(&line).ok().filter(|table| table.get_ref().len() == 1);
    let parsed = parsed.as_ref().and_then(|table| table.get_ref().get("x"));
    match parsed.map(plain) {
        Some(Ok(value)) => Ok((key.into(), value)),
        _ if value.eq_ignore_ascii_case("nan") => Ok((key.into(), Value::Number(f64::NAN))),
        _ => Ok((key.into(), Value::Word(value.into()))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::PathBuf;

    use crate::settings::Setting;

    struct Toy;

    impl Experiment for Toy {
        fn name(&self) -> &'static str {
            "toy"
        }
        fn summary(&self) -> &'static str {
            "nothing"
        }
        fn conditions(&self) -> &'static [&'static str] {
            &["with", "without"]
        }
        fn settings(&self, _: &str) -> Vec<Setting> {
            vec![
                Setting::number("world.step", 0.01, 0.001..=0.1).unit("s").doc("Time step."),
                Setting::numbers("robot.arm.lengths", &[1.0, 2.0], 0.0..=5.0).given(),
                Setting::word("world.kind", "flat", &["flat", "round"]),
                Setting::text("world.map", ""),
            ]
        }
        fn files(&self, _: &str, settings: &Settings) -> Result<Vec<PathBuf>, Error> {
            let map = settings.text("world.map")?;
            Ok(if map.is_empty() { Vec::new() } else { vec![map.into()] })
        }
        fn prepare(&self, _: &str, _: &Settings) -> Result<Box<dyn Evaluator>, Error> {
            Err(Error::Other("never".into()))
        }
    }

    #[test]
    fn the_complete_configuration_reads_back() {
        let mut plan = Plan::new(&Toy, Some("without"), "").unwrap();
        plan.seed = 7;
        plan.settings.set("", "world.kind", Value::Word("round".into())).unwrap();
        plan.settings.set("", "robot.arm.lengths", Value::Numbers(vec![0.1, 1e-9])).unwrap();
        let text = plan.to_toml().unwrap();
        assert!(text.contains("# Time step. [0.001 to 0.1 s; chosen]\nstep = 0.01\n"), "{text}");
        assert!(text.contains("not the default"), "{text}");
        let file = ConfigFile::parse("config.toml", &text).unwrap();
        let again = Plan::of_file(&[&Toy], &file).unwrap();
        assert_eq!(again.identity().unwrap(), plan.identity().unwrap());
        assert_eq!(again.settings, plan.settings);
        assert_eq!(again.name(), "toy-without-7");
    }

    #[test]
    fn mistakes_are_found_with_their_line() {
        let error = |text: &str| {
            let plan = ConfigFile::parse("my.toml", text).and_then(|file| Plan::of_file(&[&Toy], &file));
            plan.map(|_| ()).unwrap_err().to_string()
        };
        let head = "experiment = \"toy\"\n";
        for (text, message) in [
            ("[world]\nstpe = 1", "my.toml line 3: unknown key `world.stpe`; the nearest is `world.step`"),
            ("[wrold]\n\nstep = 1", "my.toml line 4: unknown key `wrold.step`; the nearest is `world.step`"),
            ("world.step = nan", "my.toml line 2: `world.step`: NaN is not a number"),
            ("world.step = \"a\"", "my.toml line 2: `world.step`: \"a\" is not a number"),
            ("condition = \"wit\"", "my.toml line 2: unknown condition `wit`; the nearest is `with`"),
            ("condition = 1", "my.toml line 2: `condition`: is not a name in quotes"),
            ("seed = -1", "my.toml line 2: `seed`: is not a whole number from 0 to 9223372036854775807"),
            ("world.step = 1979-05-27", "my.toml line 2: `world.step`: is not a flag, number, word or list of numbers"),
            ("robot.arm.lengths = [1, \"a\"]", "my.toml line 2: `robot.arm.lengths`: is not a list of numbers"),
        ] {
            assert_eq!(error(&format!("{head}{text}")), message);
        }
        assert_eq!(error("experiment = \"toi\""), "my.toml line 1: unknown experiment `toi`; the nearest is `toy`");
        assert_eq!(error(""), "my.toml: names no experiment");
        assert!(error(&format!("{head}[world\n")).starts_with("my.toml line 2: "));
        assert!(error(&format!("{head}seed = 1\nseed = 2\n")).starts_with("my.toml line 3: "));
    }

    #[test]
    fn assignments_are_toml_values_or_words() {
        assert_eq!(assignment("a.b=1").unwrap(), ("a.b".into(), Value::Whole(1)));
        assert_eq!(assignment("a.b = -1.5e-3").unwrap(), ("a.b".into(), Value::Number(-1.5e-3)));
        assert_eq!(assignment("a.b=[1, 2.5]").unwrap().1, Value::Numbers(vec![1.0, 2.5]));
        assert_eq!(assignment("a.b=two-tap").unwrap().1, Value::Word("two-tap".into()));
        assert_eq!(assignment("a.b=\"two-tap\"").unwrap().1, Value::Word("two-tap".into()));
        assert!(matches!(assignment("a.b=NaN").unwrap().1, Value::Number(x) if x.is_nan()));
        assert_eq!(assignment("a.b=1\ny=2").unwrap().1, Value::Word("1\ny=2".into()));
        assert!(assignment("a.b").is_err());
    }

    #[test]
    fn another_configuration_is_named() {
        let (plan, mut other) = (Plan::new(&Toy, None, "").unwrap(), Plan::new(&Toy, None, "").unwrap());
        other.settings.set("", GENERATIONS, Value::Whole(5)).unwrap();
        plan.identity().unwrap().same_run(&other.identity().unwrap(), Path::new("d")).unwrap();
        other.settings.set("", "world.step", Value::Number(0.02)).unwrap();
        let error = plan.identity().unwrap().same_run(&other.identity().unwrap(), Path::new("d")).unwrap_err();
        assert_eq!(
            error.to_string(),
            "the run in d has `world.step` = 0.01, not 0.02: another configuration is another run"
        );
        // Before there were conditions, it was the first: the other one is not.
        let old = Identity { condition: String::new(), ..plan.identity().unwrap() };
        plan.same_run(&old, Path::new("d")).unwrap();
        let without = Plan::new(&Toy, Some("without"), "").unwrap();
        let error = without.same_run(&old, Path::new("d")).unwrap_err().to_string();
        assert!(error.contains("`condition`"), "{error}");
        let mut newer = plan.identity().unwrap();
        newer.experiment_version = 2;
        let error = plan.identity().unwrap().same_values(&newer, Path::new("d/checkpoint.bin")).unwrap_err();
        assert!(error.to_string().starts_with("d/checkpoint.bin: made with version 1 of the values of toy"), "{error}");
    }

    #[test]
    fn a_file_that_changed_or_went_is_named() {
        let path = std::env::temp_dir().join(format!("farsa plan \"map\" {}", std::process::id()));
        fs::write(&path, "here be dragons").unwrap();
        let mut plan = Plan::new(&Toy, None, "").unwrap();
        let without = plan.identity().unwrap();
        plan.settings.set("", "world.map", Value::Word(path.display().to_string())).unwrap();
        let file = ConfigFile::parse("config.toml", &plan.to_toml().unwrap()).unwrap();
        assert_eq!(Plan::of_file(&[&Toy], &file).unwrap().settings, plan.settings);
        let run = plan.identity().unwrap();
        assert_eq!((run.settings.len(), run.files().count()), (without.settings.len() + 1, 1));
        run.same_run(&plan.identity().unwrap(), Path::new("d")).unwrap();
        fs::write(&path, "here be none").unwrap();
        let error = run.same_run(&plan.identity().unwrap(), Path::new("d")).unwrap_err();
        let (name, said) = (path.display().to_string(), error.to_string());
        assert!(said.starts_with(&format!("{name}: is another file than the run in d was made with")), "{said}");
        fs::remove_file(&path).unwrap();
        let said = plan.identity().unwrap_err().to_string();
        assert!(said.starts_with(&format!("cannot read {name}: ")), "{said}");
    }
}
