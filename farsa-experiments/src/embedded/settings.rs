//! The settings of an embedded experiment. Each of them sets one or more keys of the experiment's file.

use farsa_lab::advanced::Value;
use farsa_lab::{Error, Setting, Settings};
use serde::Deserialize;

/// All settings of an experiment, in the order of its configuration.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct NamedSettings {
    /// Setting for which errors of the file are reported.
    pub(crate) refused: String,
    setting: Vec<NamedSetting>,
}

/// A setting, and the keys of the file that its value goes to.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct NamedSetting {
    key: String,
    /// Keys of the file.
    #[serde(default)]
    sets: Vec<String>,
    /// Default of the setting. If it is missing, the value of the first key in the file is used.
    default: Option<toml::Value>,
    /// If true, a single number sets all numbers of a list in the file.
    #[serde(default)]
    scalar: bool,
    /// A list has one number for each key.
    #[serde(default)]
    list: bool,
    /// Least and greatest value.
    range: Option<[f64; 2]>,
    /// Words to choose from.
    #[serde(default)]
    choices: Vec<String>,
    #[serde(default)]
    unit: String,
    #[serde(default)]
    source: Source,
    /// Conditions whose default the source states. An empty list means all of them.
    #[serde(default)]
    given_in: Vec<String>,
    /// Conditions that have the setting. If the list is empty, all of them have it.
    #[serde(default)]
    conditions: Vec<String>,
    doc: String,
}

/// The origin of a default.
#[derive(Default, Deserialize, Clone, Copy, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
enum Source {
    Given,
    Derived,
    #[default]
    Chosen,
}

impl NamedSettings {
    /// Returns the settings under a condition. `file` are those of the file, with that condition's defaults.
    pub(crate) fn table(&self, condition: &str, file: &[Setting]) -> Vec<Setting> {
        self.under(condition).map(|named| named.setting(condition, file)).collect()
    }

    /// Sets the keys of the file, which have its defaults, to the values of the settings.
    ///
    /// # Errors
    /// [`Error::Setting`] for a value that the file cannot have.
    pub(crate) fn apply(&self, condition: &str, settings: &Settings, file: &mut Settings) -> Result<(), Error> {
        self.under(condition).try_for_each(|named| named.apply(settings, file))
    }

    fn under(&self, condition: &str) -> impl Iterator<Item = &NamedSetting> {
        let has = |named: &&NamedSetting| named.conditions.is_empty() || is_in(&named.conditions, condition);
        self.setting.iter().filter(has)
    }
}

impl NamedSetting {
    fn setting(&self, condition: &str, file: &[Setting]) -> Setting {
        let [low, high] = self.range.unwrap_or([f64::MIN, f64::MAX]);
        let setting = match self.default(file) {
            Value::Flag(flag) => Setting::flag(&self.key, flag),
            Value::Whole(number) => Setting::whole(&self.key, number, low as i64..=high as i64),
            Value::Number(number) => Setting::number(&self.key, number, low..=high),
            Value::Numbers(numbers) => Setting::numbers(&self.key, &numbers, low..=high),
            Value::Word(text) if self.choices.is_empty() => Setting::text(&self.key, &text),
            Value::Word(word) => {
                Setting::word(&self.key, &word, &self.choices.iter().map(String::as_str).collect::<Vec<_>>())
            }
        };
        let setting = setting.unit(&self.unit).doc(&self.doc);
        match self.source {
            Source::Given if self.given_in.is_empty() || is_in(&self.given_in, condition) => setting.given(),
            Source::Derived => setting.derived(),
            _ => setting,
        }
    }

    /// The default, or the values of the keys in the file.
    fn default(&self, file: &[Setting]) -> Value {
        let value = |key: &String| file.iter().find(|setting| setting.key() == key).map(Setting::default_value);
        match &self.default {
            Some(toml::Value::Integer(number)) => return Value::Whole(*number),
            Some(toml::Value::Float(number)) => return Value::Number(*number),
            Some(toml::Value::String(word)) => return Value::Word(word.clone()),
            _ => {}
        }
        if self.list {
            return Value::Numbers(self.sets.iter().filter_map(value).filter_map(number).collect());
        }
        match self.sets.first().and_then(value).expect("a setting without a default sets a key of the file") {
            Value::Numbers(numbers) if self.scalar => Value::Number(numbers[0]),
            value => value.clone(),
        }
    }

    /// Sets the keys of the file. A number sets each number of the file in proportion to the defaults of both: a key
    /// whose default is twice the setting's becomes twice its value.
    fn apply(&self, settings: &Settings, file: &mut Settings) -> Result<(), Error> {
        // Other strategies have other settings.
        if !settings.has(&self.key) {
            return Ok(());
        }
        let value = settings.get(&self.key)?;
        let default = number(settings.find("", &self.key)?.default_value());
        for (place, key) in self.sets.iter().enumerate() {
            let scaled = |to: f64, from: f64| default.filter(|default| *default != 0.0).map_or(to, |d| to * (from / d));
            let value = match (value, file.find("", key)?.default_value()) {
                (Value::Numbers(numbers), Value::Number(_)) => Value::Number(numbers[place]),
                (Value::Number(to), Value::Number(from)) => Value::Number(scaled(*to, *from)),
                (Value::Number(to), Value::Numbers(from)) => {
                    Value::Numbers(from.iter().map(|from| scaled(*to, *from)).collect())
                }
                (value, _) => value.clone(),
            };
            file.set("", key, value)?;
        }
        Ok(())
    }
}

/// The value of a number.
fn number(value: &Value) -> Option<f64> {
    if let Value::Number(number) = value { Some(*number) } else { None }
}

fn is_in(names: &[String], condition: &str) -> bool {
    names.iter().any(|name| name == condition)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{AGGREGATION, BRAITENBERG, DISCRIMINATION, DISCRIMINATION_CYLINDERS, FORAGING, PREDATOR_PREY};
    use farsa_lab::Experiment;

    const FILE: &str = r#"
        refused = "b"
        setting = [
            { key = "a.scalar", sets = ["b.size", "b.at"], scalar = true, doc = "" },
            { key = "a.cost", default = 0.5, sets = ["b.weight"], range = [0.0, 9.0], doc = "" },
            { key = "a.radii", sets = ["b.small", "b.large"], list = true, doc = "" },
        ]
    "#;

    #[test]
    fn values_go_to_the_file_in_proportion() {
        let named: NamedSettings = toml::from_str(FILE).unwrap();
        let number = |key: &str, value| Setting::number(key, value, -10.0..=10.0);
        let list = |key: &str, value: &[f64]| Setting::numbers(key, value, -10.0..=10.0);
        let file = vec![
            list("b.size", &[2.0, 2.0]),
            list("b.at", &[1.0, -2.0]),
            number("b.weight", -0.5),
            number("b.small", 0.1),
            number("b.large", 0.3),
        ];
        let mut settings = Settings::new(named.table("", &file)).unwrap();
        let mut values = Settings::new(file).unwrap();
        for (key, value) in [("a.scalar", 3.0), ("a.cost", 0.75)] {
            settings.set("", key, Value::Number(value)).unwrap();
        }
        settings.set("", "a.radii", Value::Numbers(vec![0.2, 0.7])).unwrap();
        named.apply("", &settings, &mut values).unwrap();
        assert_eq!(values.numbers("b.size").unwrap(), [3.0, 3.0]);
        assert_eq!(values.numbers("b.at").unwrap(), [1.5, -3.0]);
        assert_eq!(["b.weight", "b.small", "b.large"].map(|key| values.number(key).unwrap()), [-0.75, 0.2, 0.7]);
    }

    /// A run with the defaults is the file's.
    #[test]
    fn defaults_leave_the_file_as_it_is() {
        let wheeled = [&DISCRIMINATION, &DISCRIMINATION_CYLINDERS, &BRAITENBERG];
        for experiment in wheeled.into_iter().chain([&FORAGING, &AGGREGATION, &PREDATOR_PREY]) {
            let conditions = experiment.conditions();
            for condition in conditions.iter().chain(conditions.is_empty().then_some(&"")) {
                let (named, file) = experiment.halves(condition);
                let settings = Settings::new(experiment.settings(condition)).unwrap();
                let (mut values, plain) = (Settings::new(file.clone()).unwrap(), Settings::new(file).unwrap());
                named.apply(condition, &settings, &mut values).unwrap();
                for setting in plain.table() {
                    let key = setting.key();
                    assert_eq!(values.get(key).unwrap(), plain.get(key).unwrap(), "{} {key}", experiment.name());
                }
            }
        }
    }
}
