//! Experiment, condition, seed and settings of a run.

use std::fmt::Write as _;
use std::path::Path;

use farsa_evo::{ObservationStatistics, ScoreShape};
use farsa_num::crc32;

use crate::error::Error;
use crate::experiment::evaluator::{Evaluator, TaskInfo};
use crate::experiment::genotype::Genotype;
use crate::experiment::settings::{Paragraph, Settings, Value};
use crate::limits::Limits;
use crate::run::config_file::{ConfigFile, Entry};
use crate::run::experiment::Experiment;
use crate::run::laboratory::Laboratory;
use crate::store::bounded;
use crate::store::identity::{FILE, Identity, VALUES_VERSION};
use crate::strategy::any_strategy::AnyStrategy;
use crate::strategy::definition::{StrategyDefinition, StrategyStart};
use crate::strategy::history::Fresh;
use crate::strategy::known;
use crate::strategy::settings::{GENERATIONS, NORMALISE, POPULATION, chosen, complete};

/// Largest seed of a run. Bit 63 marks the trials of a test.
pub(crate) const MAX_SEED: u64 = i64::MAX as u64;

/// Bytes of the largest file that an experiment names.
const MAX_BYTES: u64 = 1_000_000_000;

/// A run before its first evaluation.
#[derive(Clone)]
pub(crate) struct Plan<'e> {
    pub(crate) experiment: &'e dyn Experiment,
    pub(crate) condition: String,
    /// Requested strategy, if it is not the default of the experiment.
    chosen: Option<&'static dyn StrategyDefinition>,
    pub(crate) seed: u64,
    pub(crate) settings: Settings,
    /// Settings with another world, for trials outside the world of the run. They are not part of the identity.
    pub(crate) elsewhere: Option<Settings>,
    pub(crate) limits: Limits,
}

impl<'e> Plan<'e> {
    /// Plans an experiment with its defaults under a condition, by default the first, and with its default strategy.
    pub(crate) fn new(experiment: &'e dyn Experiment, condition: Option<&str>, place: &str) -> Result<Self, Error> {
        Self::with_strategy(experiment, condition, place, None)
    }

    /// Plans an experiment with a given strategy. `place` is where the condition was named, for errors.
    pub(crate) fn with_strategy(
        experiment: &'e dyn Experiment,
        condition: Option<&str>,
        place: &str,
        strategy: Option<&'static dyn StrategyDefinition>,
    ) -> Result<Self, Error> {
        let conditions = experiment.conditions();
        let condition = match condition {
            None => conditions.first().copied().unwrap_or_default(),
            // The configuration of a run without conditions has no condition.
            Some("") if conditions.is_empty() => "",
            Some(name) => conditions
                .iter()
                .find(|&&known| known == name)
                .ok_or_else(|| Error::unknown(place, "condition", name, conditions.iter().copied()))?,
        };
        let (own, table) = (experiment.strategy(condition), experiment.settings(condition));
        let other = strategy.filter(|other| other.name() != own.name());
        let settings = Settings::new(match other {
            None => complete(table, own.settings()),
            Some(other) => chosen(table, other.name(), other.settings()),
        })?;
        Ok(Self {
            experiment,
            condition: condition.into(),
            chosen: other,
            seed: 1,
            settings,
            elsewhere: None,
            limits: Limits::default(),
        })
    }

    /// Applies the seed and the values of a configuration file. The caller handles experiment and condition.
    pub(crate) fn apply(&mut self, file: &ConfigFile) -> Result<(), Error> {
        if let Some(seed) = &file.seed {
            self.seed = seed.value;
        }
        for (key, Entry { value, place }) in &file.entries {
            match value {
                Some(value) => self.set(place, key, value.clone())?,
                None => self.settings.section(place, key)?,
            }
        }
        let too_many = |place| Err(Error::Usage(format!("{place}: more keys than a configuration has")));
        file.beyond.as_ref().map_or(Ok(()), too_many)
    }

    pub(crate) fn set(&mut self, place: &str, key: &str, value: Value) -> Result<(), Error> {
        known::check_key(self.definition(), &self.settings, place, key)?;
        self.settings.set(place, key, value)
    }

    /// Plans the run of a complete configuration file.
    pub(crate) fn from_file(laboratory: &Laboratory<'e>, file: &ConfigFile) -> Result<Self, Error> {
        let experiment = laboratory.of_configuration(file)?;
        let place = file.condition.as_ref().map_or("", |entry| &entry.place);
        let condition = file.condition.as_ref().map(|entry| entry.value.as_str());
        let strategy =
            file.strategy.as_ref().map(|entry| laboratory.strategy(&entry.value, &entry.place)).transpose()?;
        let mut plan = Self::with_strategy(experiment, condition, place, strategy)?;
        plan.apply(file)?;
        Ok(plan)
    }

    /// Returns the strategy of the run.
    pub(crate) fn definition(&self) -> &'static dyn StrategyDefinition {
        self.chosen.unwrap_or_else(|| self.experiment.strategy(&self.condition))
    }

    /// Gets the name of the strategy, if it is not the default of the experiment.
    pub(crate) fn chosen_strategy(&self) -> Option<&'static str> {
        self.chosen.map(StrategyDefinition::name)
    }

    /// Returns the number of individuals of each population.
    ///
    /// # Errors
    /// The errors of [`strategy`](Self::strategy).
    pub(crate) fn size(&self) -> Result<usize, Error> {
        match self.settings.count(POPULATION) {
            Ok(size) if size > 0 => Ok(size),
            _ => self.strategy().map(|strategy| strategy.individuals() / strategy.populations()),
        }
    }

    /// Returns empty statistics of the observed channels, or `None` where observations are not normalized.
    ///
    /// # Errors
    /// [`Error::Setting`] for an experiment whose observations cannot be normalized.
    pub(crate) fn no_observations(&self) -> Result<Option<ObservationStatistics>, Error> {
        if !self.definition().normalises_observations(&self.settings) {
            return Ok(None);
        }
        let task = self.prepared(&self.settings_with(2)?)?;
        let (name, populations) = (self.experiment.name(), task.info().populations.len());
        match (populations, task.info().observations) {
            (1, 0) => Err(Error::setting(NORMALISE, format!("{name} does not say what its controllers observe"))),
            (1, channels) => {
                ObservationStatistics::new(channels).map(Some).map_err(|error| Error::setting(NORMALISE, error))
            }
            _ => Err(Error::setting(NORMALISE, format!("{name} has {populations} populations; it is for one"))),
        }
    }

    /// Starts the strategy at its first generation.
    ///
    /// # Errors
    /// [`Error::Setting`] and [`Error::Usage`] for a strategy that does not start or has other populations or genes than the
    /// experiment's.
    pub(crate) fn strategy(&self) -> Result<AnyStrategy, Error> {
        self.no_observations()?;
        let task = self.prepared(&self.settings_with(2)?)?;
        let TaskInfo { populations, parameters, trials, .. } = task.info();
        let (populations, genes) = (populations.len(), parameters.len());
        let (objectives, ranges) = task.behavior().map_or((1, Vec::new()), |behaviour| {
            let ranges: Vec<[f64; 2]> = behaviour.measures().iter().map(|value| value.ends).collect();
            (1 + behaviour.objectives().len(), ranges)
        });
        drop(task);
        let (name, experiment) = (self.definition().name(), self.experiment.name());
        if populations == 0 {
            return Err(Error::Other(format!("{experiment}: no population")));
        }
        let start = StrategyStart {
            populations,
            trials,
            genes,
            gene_bits: self.experiment.gene_bits(),
            objectives,
            measures: &ranges,
            settings: &self.settings,
            seed: self.seed,
            evaluator: &|| self.evaluator(),
            limits: self.limits,
        };
        let strategy = self.definition().start(&start).map_err(|error| self.of_strategy(error))?;
        let (groups, length) = (strategy.populations(), strategy.genes());
        if (groups, length) != (populations, genes) {
            return Err(self.unfit(format!(
                "the strategy `{name}` has {groups} populations of {length} genes where {experiment} has {populations} of {genes}"
            )));
        }
        let wanted = strategy.score_shape();
        if let Some(opponents) = strategy.opponents() {
            if wanted != ScoreShape::new(1 + opponents, 0) || !(1..=trials).contains(&opponents) {
                return Err(self.unfit(format!(
                    "the strategy `{name}` wants {wanted} of {opponents} opponents where {experiment} has {trials} trials"
                )));
            }
            return Ok(strategy);
        }
        if wanted.objectives > objectives || ![0, ranges.len()].contains(&wanted.measures) {
            let available = ScoreShape::new(objectives, ranges.len());
            return Err(self.unfit(format!("the strategy `{name}` wants {wanted} where {experiment} has {available}")));
        }
        Ok(strategy)
    }

    /// Returns a function that starts the strategy.
    pub(crate) fn fresh(&self) -> Fresh<'_> {
        Box::new(|| self.strategy())
    }

    /// Prepares the experiment for one thread.
    pub(crate) fn evaluator(&self) -> Result<Box<dyn Evaluator>, Error> {
        self.prepared(&self.settings_of_trials()?)
    }

    /// Returns the settings of trials. A population size of 0 is replaced by the size that the strategy chooses, because an
    /// experiment with several populations needs it.
    pub(crate) fn settings_of_trials(&self) -> Result<Settings, Error> {
        let size = if self.settings.count(POPULATION).is_ok_and(|size| size == 0) { self.size()? } else { 0 };
        self.settings_with(size)
    }

    /// Returns the settings with `size` instead of a population size of 0.
    fn settings_with(&self, size: usize) -> Result<Settings, Error> {
        let mut settings = self.elsewhere.as_ref().unwrap_or(&self.settings).clone();
        if settings.count(POPULATION).is_ok_and(|size| size == 0) {
            settings.set("", POPULATION, Value::Whole(i64::try_from(size).unwrap_or(i64::MAX)))?;
        }
        Ok(settings)
    }

    /// Returns the genotype of the parameters of an evaluator.
    pub(crate) fn genotype(&self, evaluator: &dyn Evaluator) -> Genotype {
        Genotype::new(&evaluator.info().parameters, self.experiment.gene_bits())
    }

    /// Returns the number of generations.
    pub(crate) fn generations(&self) -> Result<u32, Error> {
        u32::try_from(self.settings.whole(GENERATIONS)?).map_err(|_| Error::setting(GENERATIONS, "is too large"))
    }

    /// Formats the name of the run's directory below `runs/`.
    pub(crate) fn name(&self) -> String {
        let seed = self.seed.to_string();
        let parts = [self.experiment.name(), &self.condition, self.chosen_strategy().unwrap_or_default(), &seed];
        parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("-")
    }

    /// Returns everything that the results depend on, with the content of files.
    ///
    /// # Errors
    /// [`Error::Usage`] for a file that cannot be read, and the errors of [`Experiment::files`].
    pub(crate) fn identity(&self) -> Result<Identity, Error> {
        let settings = self.settings.table().iter().filter(|setting| setting.key() != GENERATIONS);
        let mut settings: Vec<(String, Value)> = settings
            .filter_map(|setting| Some((setting.key().to_owned(), self.settings.get(setting.key()).ok()?.clone())))
            .collect();
        for path in self.experiment.files(&self.condition, &self.settings).map_err(Error::into_usage)? {
            let bytes = bounded::read_regular(&path, MAX_BYTES).map_err(Error::into_usage)?;
            settings.push((format!("{FILE}{}", path.display()), Value::Word(format!("{:08x}", crc32(&bytes)))));
        }
        if let Some(text) = self.experiment.definition() {
            settings.push(("definition".into(), Value::Word(format!("{:08x}", crc32(text.as_bytes())))));
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

    /// Checks that a record, read from a file of `directory`, belongs to the planned run.
    ///
    /// # Errors
    /// [`Error::Usage`], [`Error::File`], and the errors of [`identity`](Self::identity).
    pub(crate) fn same_run(&self, record: &Identity, directory: &Path) -> Result<(), Error> {
        let mut asked = self.identity()?;
        // A run that is older than the conditions of its experiment has the first of them.
        if record.condition.is_empty() && self.experiment.conditions().first() == Some(&self.condition.as_str()) {
            asked.condition.clear();
        }
        record.same_run(&asked, directory)
    }

    /// Returns the complete configuration as TOML, with the documentation, unit and source of every value.
    pub(crate) fn to_toml(&self) -> Result<String, Error> {
        let mut text =
            String::from("# The complete configuration of a run; `run --config` with this file repeats it.\n");
        // Writing into a string cannot fail.
        let _ = writeln!(text, "experiment = {:?}", self.experiment.name());
        if let Some(definition) = self.experiment.definition() {
            let _ = writeln!(text, "# The file that describes it.\ndefinition = {}", Paragraph(definition));
        }
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use std::path::PathBuf;

    use crate::experiment::settings::Setting;

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
        let again = Plan::from_file(&Laboratory::new(&[&Toy]), &file).unwrap();
        assert_eq!(again.identity().unwrap(), plan.identity().unwrap());
        assert_eq!(again.settings, plan.settings);
        assert_eq!(again.name(), "toy-without-7");
    }

    #[test]
    fn mistakes_are_found_with_their_line() {
        let error = |text: &str| {
            let plan =
                ConfigFile::parse("my.toml", text).and_then(|file| Plan::from_file(&Laboratory::new(&[&Toy]), &file));
            plan.map(|_| ()).unwrap_err().to_string()
        };
        let head = "experiment = \"toy\"\n";
        for (text, message) in [
            ("[World]\nStep = 1", "my.toml line 3: unknown key `World.Step`; the nearest is `world.step`"),
            ("[wrold]", "my.toml line 2: unknown section `wrold`; the nearest is `world`"),
            ("[robot.am]\n[world]\nstpe = 1", "my.toml line 2: unknown section `robot.am`; the nearest is `robot.arm`"),
            ("seed = {}", "my.toml line 2: unknown section `seed`; there are `evolution`, `robot.arm` and `world`"),
            ("zz = 1\naa = 2", &format!("my.toml line 2: unknown key `zz`; {THERE_ARE}")),
            ("\"a\\nerror: b\" = 2", &format!("my.toml line 2: unknown key `a\\nerror: b`; {THERE_ARE}")),
            ("world.step = 1\nworld.step = 2", "my.toml line 3: duplicate key `step`"),
            ("[world]\n[evolution]\n[world]", "my.toml line 4: duplicate key `world`"),
            (
                "world = 1\nworld.step = 2",
                "my.toml line 3: cannot extend value of type integer with a dotted key `world`",
            ),
            ("world.step = 0.1\n\"world.step\" = 0.1", "my.toml line 3: `world.step`: is set twice"),
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
        assert_eq!(
            error("experiment = \"toi\"\n[evolution]\n[robot]\n"),
            "my.toml line 1: unknown experiment `toi`; the nearest is `toy`"
        );
        Plan::from_file(
            &Laboratory::new(&[&Toy]),
            &ConfigFile::parse("my.toml", &format!("{head}[evolution]\n[robot]\n")).unwrap(),
        )
        .unwrap();
        assert_eq!(error("experiment = \"toi\""), "my.toml line 1: unknown experiment `toi`; the nearest is `toy`");
        assert_eq!(error(""), "my.toml: names no experiment");
        assert!(error(&format!("{head}[world\n")).starts_with("my.toml line 2: "));
        let deep = format!("{head}# {}\n{} = 1\n", ".".repeat(99), vec!["a"; 100].join("."));
        assert_eq!(error(&deep), "my.toml line 3: recursion limit");
        let deep = format!("{head}{}", "x = {a=".repeat(1000));
        assert!(error(&deep).starts_with("my.toml line 2: "), "{}", error(&deep));
        assert!(error(&format!("{head}seed = 1\nseed = 2\n")).starts_with("my.toml line 3: "));
    }

    /// All keys of the experiment.
    const THERE_ARE: &str = "there are `evolution.generations`, `evolution.mutation`, `evolution.mutation_rate`, \
        `evolution.parents`, `evolution.population`, `robot.arm.lengths`, `world.kind`, `world.map` and `world.step`";

    #[test]
    fn many_unknown_keys_are_refused_at_the_first() {
        // In alphabetical order the first would be k0. Counting lines from the top for each key would take minutes.
        let keys: Vec<String> = (0..45_000).rev().map(|number| format!("k{number}=1\n")).collect();
        let file = ConfigFile::parse("my.toml", &format!("{}experiment=\"toy\"\n", keys.concat())).unwrap();
        let error = Plan::from_file(&Laboratory::new(&[&Toy]), &file).map(|_| ()).unwrap_err().to_string();
        assert_eq!(error, format!("my.toml line 1: unknown key `k44999`; {THERE_ARE}"));
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
        // A run that is older than the conditions has the first, not the second.
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
        assert_eq!(Plan::from_file(&Laboratory::new(&[&Toy]), &file).unwrap().settings, plan.settings);
        let run = plan.identity().unwrap();
        assert_eq!((run.settings.len(), run.files().count()), (without.settings.len() + 1, 1));
        run.same_run(&plan.identity().unwrap(), Path::new("d")).unwrap();
        fs::write(&path, "here be none").unwrap();
        let error = run.same_run(&plan.identity().unwrap(), Path::new("d")).unwrap_err();
        let (name, message) = (path.display().to_string(), error.to_string());
        assert!(message.starts_with(&format!("{name}: is another file than the run in d was made with")), "{message}");
        fs::remove_file(&path).unwrap();
        let message = plan.identity().unwrap_err().to_string();
        assert!(message.starts_with(&format!("cannot read {name}: ")), "{message}");
        fs::File::create(&path).unwrap().set_len(MAX_BYTES + 1).unwrap();
        let message = plan.identity().unwrap_err().to_string();
        assert_eq!(message, format!("{name}: has more than 1000000000 bytes, the most that is read of it"));
        fs::remove_file(&path).unwrap();
        fs::create_dir(&path).unwrap();
        assert_eq!(plan.identity().unwrap_err().to_string(), format!("{name}: is not a regular file"));
        fs::remove_dir(&path).unwrap();
    }
}
