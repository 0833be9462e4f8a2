//! The configuration of an experiment: flat `section.key` settings with types, limits, units and sources.

use std::collections::BTreeMap;
use std::fmt;
use std::ops::RangeInclusive;

use serde::Serialize;

use crate::error::Error;
use crate::escaped::shortened;

pub(crate) use crate::experiment::value::Paragraph;
pub use crate::experiment::value::Value;

/// Where a default comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Source {
    /// Stated by the experiment's source.
    Given,
    /// Follows from what the source states.
    Derived,
    /// Ours: the source does not say.
    #[default]
    Chosen,
}

impl Source {
    /// The word for it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Given => "given",
            Self::Derived => "derived",
            Self::Chosen => "chosen",
        }
    }
}

/// The values a setting may have.
#[derive(Debug, Clone, PartialEq)]
enum Allowed {
    Flag,
    Whole(RangeInclusive<i64>),
    Number(RangeInclusive<f64>),
    Word(Vec<String>),
    Text,
    /// As many numbers as in the default, each in the range.
    Numbers(RangeInclusive<f64>),
}

/// One thing that can be set, with its default and where that comes from.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    key: String,
    default: Value,
    allowed: Allowed,
    unit: String,
    source: Source,
    doc: String,
}

impl Setting {
    fn new(key: &str, default: Value, allowed: Allowed) -> Self {
        Self { key: key.into(), default, allowed, unit: String::new(), source: Source::default(), doc: String::new() }
    }

    /// A number within limits, both included. Keys are `section.name`, lower-case with underscores or hyphens.
    pub fn number(key: &str, default: f64, range: RangeInclusive<f64>) -> Self {
        Self::new(key, Value::Number(default), Allowed::Number(range))
    }

    /// A whole number within limits, both included.
    pub fn whole(key: &str, default: i64, range: RangeInclusive<i64>) -> Self {
        Self::new(key, Value::Whole(default), Allowed::Whole(range))
    }

    /// Yes or no.
    pub fn flag(key: &str, default: bool) -> Self {
        Self::new(key, Value::Flag(default), Allowed::Flag)
    }

    /// One of a few words.
    pub fn word(key: &str, default: &str, choices: &[&str]) -> Self {
        let choices = choices.iter().map(|&choice| choice.to_owned()).collect();
        Self::new(key, Value::Word(default.into()), Allowed::Word(choices))
    }

    /// Any text, such as the path of a file.
    pub fn text(key: &str, default: &str) -> Self {
        Self::new(key, Value::Word(default.into()), Allowed::Text)
    }

    /// A list of as many numbers as the default has, each within limits, both included.
    pub fn numbers(key: &str, default: &[f64], range: RangeInclusive<f64>) -> Self {
        Self::new(key, Value::Numbers(default.to_vec()), Allowed::Numbers(range))
    }

    /// Adds the unit, in the way it is written after a number: `cm`, `rad/s`.
    pub fn unit(mut self, unit: &str) -> Self {
        self.unit = unit.into();
        self
    }

    /// Says that the default is stated by the experiment's source.
    pub fn given(mut self) -> Self {
        self.source = Source::Given;
        self
    }

    /// Says that the default follows from what the source states.
    pub fn derived(mut self) -> Self {
        self.source = Source::Derived;
        self
    }

    /// Adds one sentence that says what it is and, for a chosen default, why that.
    pub fn doc(mut self, doc: &str) -> Self {
        self.doc = doc.into();
        self
    }

    /// The same with another default, for an experiment that gives a strategy's setting one of its own.
    ///
    /// # Errors
    /// What is wrong with a value that it cannot have.
    pub fn with_default(&self, value: Value) -> Result<Self, String> {
        Ok(Self { default: self.check(value)?, ..self.clone() })
    }

    /// The key.
    pub fn key(&self) -> &str {
        &self.key
    }

    /// The default.
    pub fn default_value(&self) -> &Value {
        &self.default
    }

    /// The unit; empty if there is none.
    pub fn unit_name(&self) -> &str {
        &self.unit
    }

    /// Where the default comes from.
    pub fn source(&self) -> Source {
        self.source
    }

    /// What it is.
    pub fn doc_text(&self) -> &str {
        &self.doc
    }

    /// The allowed values in words: `0.0 to 1.0`, `filter, two-tap or evonet`.
    pub fn allowed(&self) -> String {
        match &self.allowed {
            Allowed::Flag => "true or false".into(),
            Allowed::Text => "any text".into(),
            Allowed::Whole(range) => format!("{} to {}", range.start(), range.end()),
            Allowed::Number(range) => format!("{:?} to {:?}", range.start(), range.end()),
            Allowed::Word(choices) => match choices.split_last() {
                Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
                _ => choices.concat(),
            },
            Allowed::Numbers(range) => {
                format!("{} numbers, each {:?} to {:?}", self.length(), range.start(), range.end())
            }
        }
    }

    fn length(&self) -> usize {
        match &self.default {
            Value::Numbers(list) => list.len(),
            _ => 1,
        }
    }

    /// Checks a value; a whole number is taken where a number is wanted.
    fn check(&self, value: Value) -> Result<Value, String> {
        let outside = |x: &dyn fmt::Display| Err(format!("{x} is outside {}", self.allowed()));
        let shown = |value: &Value| shortened(&value.to_string()).into_owned();
        match (&self.allowed, value) {
            (Allowed::Flag, value @ Value::Flag(_)) | (Allowed::Text, value @ Value::Word(_)) => Ok(value),
            // What was written is no longer known: 1.50 and 1.5 are one number, but not one name of a file.
            (Allowed::Text, value) => Err(format!("{0} is not a text; write it in quotes: \"{0}\"", shown(&value))),
            (Allowed::Whole(range), Value::Whole(n)) if range.contains(&n) => Ok(Value::Whole(n)),
            (Allowed::Whole(_), Value::Whole(n)) => outside(&n),
            (Allowed::Number(_), Value::Whole(n)) => self.check(Value::Number(n as f64)),
            (Allowed::Number(range), Value::Number(x)) if range.contains(&x) => Ok(Value::Number(x)),
            (Allowed::Number(_) | Allowed::Whole(_), Value::Number(x)) if x.is_nan() => {
                Err("NaN is not a number".into())
            }
            (Allowed::Number(_), Value::Number(x)) => outside(&x),
            (Allowed::Word(choices), Value::Word(word)) => {
                if choices.contains(&word) {
                    Ok(Value::Word(word))
                } else {
                    let error = Error::unknown("", "choice", &word, choices.iter().map(String::as_str));
                    Err(format!("{error} ({})", self.allowed()))
                }
            }
            // TOML has them as numbers, and the command line has TOML.
            (Allowed::Word(choices), Value::Number(x)) if !x.is_finite() => {
                let word = choices.iter().find(|choice| choice.eq_ignore_ascii_case(&x.to_string())).cloned();
                word.map(Value::Word).ok_or_else(|| format!("{x} is not {}", self.wanted()))
            }
            (Allowed::Numbers(range), Value::Numbers(list)) => {
                if list.len() != self.length() {
                    return Err(format!("{} numbers where {} are wanted", list.len(), self.length()));
                }
                match list.iter().find(|x| !range.contains(x)) {
                    None => Ok(Value::Numbers(list)),
                    Some(x) if x.is_nan() => Err("NaN is not a number".into()),
                    Some(x) => outside(x),
                }
            }
            (_, value) => Err(format!("{} is not {}", shown(&value), self.wanted())),
        }
    }

    fn wanted(&self) -> String {
        match &self.allowed {
            Allowed::Flag => "true or false".into(),
            Allowed::Text => "a text".into(),
            Allowed::Whole(_) => "a whole number".into(),
            Allowed::Number(_) => "a number".into(),
            Allowed::Word(_) => format!("one of {}", self.allowed()),
            Allowed::Numbers(_) => format!("a list of {} numbers", self.length()),
        }
    }
}

/// The complete configuration of a run: a checked value for every setting of the experiment's table.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    table: Vec<Setting>,
    values: BTreeMap<String, Value>,
}

impl Settings {
    /// The defaults of a table.
    ///
    /// # Errors
    /// [`Error::Setting`] when a key is not of the form `section.name`, stands twice, or has a default outside its own
    /// limits: mistakes in the experiment.
    pub fn new(table: Vec<Setting>) -> Result<Self, Error> {
        let mut values = BTreeMap::new();
        for setting in &table {
            if !is_key(&setting.key) {
                return Err(Error::setting(&setting.key, "is not of the form `section.name` in a-z, 0-9, - and _"));
            }
            let value = setting.check(setting.default.clone()).map_err(|why| Error::setting(&setting.key, why))?;
            if values.insert(setting.key.clone(), value).is_some() {
                return Err(Error::setting(&setting.key, "stands twice in the experiment's table"));
            }
        }
        Ok(Self { table, values })
    }

    /// The table, in its order.
    pub fn table(&self) -> &[Setting] {
        &self.table
    }

    /// Sets a value; `place` says where it stands, for the error (`my.toml line 3`, `--set`).
    ///
    /// # Errors
    /// [`Error::Unknown`] with the nearest key, or [`Error::Setting`] when the value is not allowed; nothing is then
    /// changed.
    pub fn set(&mut self, place: &str, key: &str, value: Value) -> Result<(), Error> {
        let Some(setting) = self.table.iter().find(|setting| setting.key == key) else {
            return Err(Error::unknown(place, "key", key, self.table.iter().map(Setting::key)));
        };
        let value = setting.check(value).map_err(|why| Error::Setting { place: place.into(), key: key.into(), why })?;
        self.values.insert(key.into(), value);
        Ok(())
    }

    /// Whether there is a section of this name, or some within it.
    ///
    /// # Errors
    /// [`Error::Unknown`] with the nearest section.
    pub(crate) fn section(&self, place: &str, name: &str) -> Result<(), Error> {
        let sections = || self.table.iter().filter_map(|setting| Some(setting.key.rsplit_once('.')?.0));
        let within =
            |section: &str| section.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'));
        if sections().any(within) { Ok(()) } else { Err(Error::unknown(place, "section", name, sections())) }
    }

    /// Whether the table has such a key.
    pub fn has(&self, key: &str) -> bool {
        self.values.contains_key(key)
    }

    /// A value, whatever its type.
    ///
    /// # Errors
    /// [`Error::Unknown`] when the table has no such key.
    pub fn get(&self, key: &str) -> Result<&Value, Error> {
        self.values.get(key).ok_or_else(|| Error::unknown("", "key", key, self.table.iter().map(Setting::key)))
    }

    /// A number.
    ///
    /// # Errors
    /// [`Error::Unknown`] when the table has no such key, [`Error::Setting`] when it holds something else.
    pub fn number(&self, key: &str) -> Result<f64, Error> {
        match self.get(key)? {
            &Value::Number(x) => Ok(x),
            other => Err(Self::other_kind(key, other, "a number")),
        }
    }

    /// A whole number.
    ///
    /// # Errors
    /// As [`number`](Self::number).
    pub fn whole(&self, key: &str) -> Result<i64, Error> {
        match self.get(key)? {
            &Value::Whole(n) => Ok(n),
            other => Err(Self::other_kind(key, other, "a whole number")),
        }
    }

    /// A whole number that counts something.
    ///
    /// # Errors
    /// As [`number`](Self::number), and [`Error::Setting`] for a negative one.
    pub fn count(&self, key: &str) -> Result<usize, Error> {
        usize::try_from(self.whole(key)?).map_err(|_| Error::setting(key, "cannot be counted to"))
    }

    /// Yes or no.
    ///
    /// # Errors
    /// As [`number`](Self::number).
    pub fn flag(&self, key: &str) -> Result<bool, Error> {
        match self.get(key)? {
            &Value::Flag(flag) => Ok(flag),
            other => Err(Self::other_kind(key, other, "true or false")),
        }
    }

    /// One of the setting's words.
    ///
    /// # Errors
    /// As [`number`](Self::number).
    pub fn word(&self, key: &str) -> Result<&str, Error> {
        match self.get(key)? {
            Value::Word(word) => Ok(word),
            other => Err(Self::other_kind(key, other, "a word")),
        }
    }

    /// Any text.
    ///
    /// # Errors
    /// As [`number`](Self::number).
    pub fn text(&self, key: &str) -> Result<&str, Error> {
        match self.get(key)? {
            Value::Word(text) => Ok(text),
            other => Err(Self::other_kind(key, other, "a text")),
        }
    }

    /// A list of numbers.
    ///
    /// # Errors
    /// As [`number`](Self::number).
    pub fn numbers(&self, key: &str) -> Result<&[f64], Error> {
        match self.get(key)? {
            Value::Numbers(list) => Ok(list),
            other => Err(Self::other_kind(key, other, "a list of numbers")),
        }
    }

    /// A list of exactly N numbers.
    ///
    /// # Errors
    /// As [`number`](Self::number), and [`Error::Setting`] for another count.
    pub fn array<const N: usize>(&self, key: &str) -> Result<[f64; N], Error> {
        let found = self.numbers(key)?;
        found.try_into().map_err(|_| Error::setting(key, format!("{} numbers, not {N}", found.len())))
    }

    fn other_kind(key: &str, value: &Value, wanted: &str) -> Error {
        Error::setting(key, format!("the experiment reads {wanted} where its table has {value}"))
    }
}

/// Whether a key can stand in a table of a TOML file without quotes.
fn is_key(key: &str) -> bool {
    let bare = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-' || c == '_';
    key.contains('.') && key.split('.').all(|part| !part.is_empty() && part.chars().all(bare))
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
        assert_eq!(s, settings());
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
