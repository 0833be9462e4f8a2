//! Configuration of a run: the settings of an experiment and their values.

use std::collections::BTreeMap;

use crate::error::Error;

pub(crate) use crate::experiment::setting::AllowedValues;
pub use crate::experiment::setting::{Setting, Source};
pub(crate) use crate::experiment::value::Paragraph;
pub use crate::experiment::value::Value;

/// Complete configuration of a run. It has a valid value for every setting in the table of an experiment.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    table: Vec<Setting>,
    values: BTreeMap<String, Value>,
}

impl Settings {
    /// Creates a configuration with the default values of a table.
    ///
    /// # Errors
    /// Returns [`Error::Setting`] if a key is not of the form `section.name`, appears twice, or has a default outside
    /// its limits. Each of these is a mistake in the experiment.
    pub fn new(table: Vec<Setting>) -> Result<Self, Error> {
        let mut values = BTreeMap::new();
        for setting in &table {
            if !is_key(setting.key()) {
                return Err(Error::setting(setting.key(), "is not of the form `section.name` in a-z, 0-9, - and _"));
            }
            let value =
                setting.check(setting.default_value().clone()).map_err(|why| Error::setting(setting.key(), why))?;
            if values.insert(setting.key().to_owned(), value).is_some() {
                return Err(Error::setting(setting.key(), "stands twice in the experiment's table"));
            }
        }
        Ok(Self { table, values })
    }

    /// Gets the table of all settings, in the order of the experiment.
    pub fn table(&self) -> &[Setting] {
        &self.table
    }

    /// Sets the value of a key.
    ///
    /// Errors mention `place` as the location of the value, for example `my.toml line 3` or `--set`.
    ///
    /// # Errors
    /// Returns the errors of [`find`](Self::find), and [`Error::Setting`] if the value is not allowed. Nothing
    /// changes in case of an error.
    pub fn set(&mut self, place: &str, key: &str, value: Value) -> Result<(), Error> {
        let value = self.find(place, key)?.check(value).map_err(|why| Error::Setting {
            place: place.into(),
            key: key.into(),
            why,
        })?;
        self.values.insert(key.into(), value);
        Ok(())
    }

    /// Finds the setting of a key.
    ///
    /// Errors mention `place` as the location of the key.
    ///
    /// # Errors
    /// If there is no such key, returns [`Error::Setting`] with the nearest one. Some keys, such as the strategy, are
    /// options of the command instead. In this case the error names the option.
    pub fn find(&self, place: &str, key: &str) -> Result<&Setting, Error> {
        self.table.iter().find(|setting| setting.key() == key).ok_or_else(|| match elsewhere(key) {
            Some(why) => Error::Setting { place: place.into(), key: key.into(), why: why.into() },
            None => Error::unknown(place, "key", key, self.table.iter().map(Setting::key)),
        })
    }

    /// Gets the place of a value, if it is a default from a file. Otherwise this is empty.
    pub(crate) fn place(&self, key: &str) -> &str {
        let setting = self.table.iter().find(|setting| setting.key() == key);
        setting.filter(|setting| self.values.get(key) == Some(setting.default_value())).map_or("", Setting::place)
    }

    /// Checks that there is a section of this name, or a section within it.
    ///
    /// # Errors
    /// Returns [`Error::Setting`] with the name of the nearest section.
    pub(crate) fn section(&self, place: &str, name: &str) -> Result<(), Error> {
        let sections = || self.table.iter().filter_map(|setting| Some(setting.key().rsplit_once('.')?.0));
        let within =
            |section: &str| section.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'));
        if sections().any(within) { Ok(()) } else { Err(Error::unknown(place, "section", name, sections())) }
    }

    /// Checks if the table has this key.
    pub fn has(&self, key: &str) -> bool {
        self.values.contains_key(key)
    }

    /// Gets a value of any type. If you need a certain type, use a method such as [`number`](Self::number) instead.
    ///
    /// # Errors
    /// Returns [`Error::Setting`] if there is no such key.
    pub fn get(&self, key: &str) -> Result<&Value, Error> {
        self.values.get(key).ok_or_else(|| Error::unknown("", "key", key, self.table.iter().map(Setting::key)))
    }

    /// Gets a real number.
    ///
    /// # Errors
    /// Returns [`Error::Setting`] if there is no such key, or if its value has another type.
    pub fn number(&self, key: &str) -> Result<f64, Error> {
        match self.get(key)? {
            &Value::Number(x) => Ok(x),
            other => Err(Self::other_kind(key, other, "a number")),
        }
    }

    /// Gets a whole number. It can be negative.
    ///
    /// # Errors
    /// Returns the errors of [`number`](Self::number).
    pub fn whole(&self, key: &str) -> Result<i64, Error> {
        match self.get(key)? {
            &Value::Whole(n) => Ok(n),
            other => Err(Self::other_kind(key, other, "a whole number")),
        }
    }

    /// Gets a whole number as a count.
    ///
    /// # Errors
    /// Returns the errors of [`number`](Self::number), and [`Error::Setting`] if the number is negative.
    pub fn count(&self, key: &str) -> Result<usize, Error> {
        usize::try_from(self.whole(key)?).map_err(|_| Error::setting(key, "cannot be counted to"))
    }

    /// Gets a flag.
    ///
    /// # Errors
    /// Returns the errors of [`number`](Self::number).
    pub fn flag(&self, key: &str) -> Result<bool, Error> {
        match self.get(key)? {
            &Value::Flag(flag) => Ok(flag),
            other => Err(Self::other_kind(key, other, "true or false")),
        }
    }

    /// Gets a word. It is always a valid choice of its setting.
    ///
    /// # Errors
    /// Returns the errors of [`number`](Self::number).
    pub fn word(&self, key: &str) -> Result<&str, Error> {
        match self.get(key)? {
            Value::Word(word) => Ok(word),
            other => Err(Self::other_kind(key, other, "a word")),
        }
    }

    /// Gets a text.
    ///
    /// # Errors
    /// Returns the errors of [`number`](Self::number).
    pub fn text(&self, key: &str) -> Result<&str, Error> {
        match self.get(key)? {
            Value::Word(text) => Ok(text),
            other => Err(Self::other_kind(key, other, "a text")),
        }
    }

    /// Gets a list of numbers. If its length is fixed, [`array`](Self::array) is more convenient.
    ///
    /// # Errors
    /// Returns the errors of [`number`](Self::number).
    pub fn numbers(&self, key: &str) -> Result<&[f64], Error> {
        match self.get(key)? {
            Value::Numbers(list) => Ok(list),
            other => Err(Self::other_kind(key, other, "a list of numbers")),
        }
    }

    /// Gets a list of exactly `N` numbers.
    ///
    /// # Errors
    /// Returns the errors of [`number`](Self::number), and [`Error::Setting`] if the list has another length.
    pub fn array<const N: usize>(&self, key: &str) -> Result<[f64; N], Error> {
        let list = self.numbers(key)?;
        list.try_into().map_err(|_| Error::setting(key, format!("{} numbers, not {N}", list.len())))
    }

    fn other_kind(key: &str, value: &Value, wanted: &str) -> Error {
        Error::setting(key, format!("the experiment reads {wanted} where its table has {value}"))
    }
}

/// Checks whether a key is valid in a TOML table without quotes.
fn is_key(key: &str) -> bool {
    let bare = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-' || c == '_';
    key.contains('.') && key.split('.').all(|part| !part.is_empty() && part.chars().all(bare))
}

/// Finds the message for a key that is an option and not a setting, by its last part.
fn elsewhere(key: &str) -> Option<&'static str> {
    match key.rsplit('.').next()? {
        "strategy" | "algorithm" => {
            Some("is no setting; another strategy is `--strategy`, or `strategy.name` in a file")
        }
        "name" if key == "strategy.name" => Some("is no setting of this run; another strategy is `--strategy`"),
        "seed" => Some("is no setting; the seed is `--seed`, or `seed` before the sections of a file"),
        "condition" => {
            Some("is no setting; the condition is `--condition`, or `condition` before the sections of a file")
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settings() -> Settings {
        Settings::new(vec![
            Setting::number("world.step", 0.002, 0.001..=0.01).unit("s").doc("Time step."),
            Setting::whole("evolution.population", 100, 1..=10_000).given(),
            Setting::flag("noise.on", false),
            Setting::word("net.leak", "filter", &["filter", "two-tap", "evonet"]),
            Setting::numbers("start.sphere", &[1.0, 2.0], -5.0..=5.0).unit("cm"),
            Setting::text("robot.tables", ""),
        ])
        .unwrap()
    }

    #[test]
    fn values_are_checked_and_read_back() {
        let mut s = settings();
        s.set("", "world.step", Value::Number(0.005)).unwrap();
        s.set("", "start.sphere", Value::Numbers(vec![0.0, -5.0])).unwrap();
        s.set("", "net.leak", Value::Word("evonet".into())).unwrap();
        s.set("", "noise.on", Value::Flag(true)).unwrap();
        s.set("", "robot.tables", Value::Word("a \"b\"".into())).unwrap();
        assert_eq!(s.text("robot.tables").unwrap(), "a \"b\"");
        s.set("", "evolution.population", Value::Whole(7)).unwrap();
        assert_eq!(s.number("world.step").unwrap(), 0.005);
        assert_eq!(s.numbers("start.sphere").unwrap(), [0.0, -5.0]);
        assert_eq!(s.word("net.leak").unwrap(), "evonet");
        assert!(s.flag("noise.on").unwrap());
        assert_eq!(s.count("evolution.population").unwrap(), 7);
        assert!(s.number("world.stp").is_err() && s.number("noise.on").is_err());
    }

    #[test]
    fn wrong_values_are_named() {
        let mut s = settings();
        let mut wrong = |key: &str, value: Value| s.set("--set", key, value).unwrap_err().to_string();
        assert_eq!(wrong("world.step", Value::Number(f64::NAN)), "--set: `world.step`: NaN is not a number");
        assert_eq!(wrong("world.step", Value::Whole(1)), "--set: `world.step`: 1 is outside 0.001 to 0.01");
        assert_eq!(
            wrong("evolution.population", Value::Whole(0)),
            "--set: `evolution.population`: 0 is outside 1 to 10000"
        );
        assert_eq!(
            wrong("evolution.population", Value::Number(0.5)),
            "--set: `evolution.population`: 0.5 is not a whole number"
        );
        assert_eq!(
            wrong("net.leak", Value::Word("twotap".into())),
            "--set: `net.leak`: unknown choice `twotap`; the nearest is `two-tap` (filter, two-tap or evonet)"
        );
        assert_eq!(
            wrong("start.sphere", Value::Numbers(vec![0.0])),
            "--set: `start.sphere`: 1 numbers where 2 are wanted"
        );
        assert_eq!(
            wrong("start.sphere", Value::Numbers(vec![0.0, f64::NAN])),
            "--set: `start.sphere`: NaN is not a number"
        );
        assert_eq!(
            wrong("robot.tables", Value::Number(1.5)),
            "--set: `robot.tables`: 1.5 is not a text; write it in quotes: \"1.5\""
        );
        assert_eq!(
            wrong("net.leak", Value::Number(f64::NAN)),
            "--set: `net.leak`: NaN is not one of filter, two-tap or evonet"
        );
        let long = wrong("noise.on", Value::Word("a".repeat(1 << 20)));
        assert_eq!(long, format!("--set: `noise.on`: \"{}... is not true or false", "a".repeat(199)));
        assert_eq!(wrong("noise.no", Value::Flag(true)), "--set: unknown key `noise.no`; the nearest is `noise.on`");
        // Keys that are options. A setting of the same name is a setting.
        for (key, option) in [
            ("evolution.strategy", "`--strategy`"),
            ("search.algorithm", "`--strategy`"),
            ("strategy.name", "`--strategy`"),
            ("evolution.seed", "`--seed`"),
            ("condition", "`--condition`"),
        ] {
            let message = wrong(key, Value::Whole(1));
            assert!(
                message.starts_with(&format!("--set: `{key}`: is no setting")) && message.contains(option),
                "{message}"
            );
        }
        assert_eq!(s, settings());
        let mut settings = Settings::new(vec![Setting::whole("world.seed", 1, 1..=9)]).unwrap();
        settings.set("--set", "world.seed", Value::Whole(2)).unwrap();
    }

    #[test]
    fn a_table_that_contradicts_itself_is_refused() {
        assert!(Settings::new(vec![Setting::number("a.b", 2.0, 0.0..=1.0)]).is_err());
        assert!(Settings::new(vec![Setting::flag("a.b", true), Setting::flag("a.b", true)]).is_err());
        for key in ["seed", "a.", ".a", "a b.c", "a.B"] {
            assert!(Settings::new(vec![Setting::flag(key, true)]).is_err());
        }
    }
}
