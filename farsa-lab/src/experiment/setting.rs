//! A setting of an experiment: its key, its default, and which values it takes.

use std::fmt;
use std::ops::RangeInclusive;

use serde::Serialize;

use crate::error::Error;
use crate::escaped::shortened;
use crate::experiment::value::Value;

/// Origin of a default value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Source {
    /// Stated by the source of the experiment.
    Given,
    /// Derived from other statements of the source.
    Derived,
    /// Chosen here, since the source does not state it.
    #[default]
    Chosen,
}

impl Source {
    /// Gets the name of this origin.
    pub fn name(self) -> &'static str {
        match self {
            Self::Given => "given",
            Self::Derived => "derived",
            Self::Chosen => "chosen",
        }
    }
}

/// Values a setting may have.
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

/// Allowed values of a setting, for forms of other programs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct AllowedValues {
    /// Kind of the values: `flag`, `whole`, `number`, `word`, `text` or `numbers`.
    kind: &'static str,
    /// Least and largest number.
    #[serde(skip_serializing_if = "Option::is_none")]
    range: Option<[f64; 2]>,
    /// Possible words.
    #[serde(skip_serializing_if = "<[String]>::is_empty")]
    choices: Vec<String>,
}

/// A single setting, with its default, the origin of this default, and all values it may have.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    key: String,
    default: Value,
    allowed: Allowed,
    unit: String,
    source: Source,
    doc: String,
    /// Place of the default in a file, or empty.
    place: String,
}

impl Setting {
    fn new(key: &str, default: Value, allowed: Allowed) -> Self {
        Self {
            key: key.into(),
            default,
            allowed,
            unit: String::new(),
            source: Source::default(),
            doc: String::new(),
            place: String::new(),
        }
    }

    /// Creates a setting for a real number. Both limits are included.
    ///
    /// Keys have the form `section.name`, and are lower-case with underscores or hyphens.
    pub fn number(key: &str, default: f64, range: RangeInclusive<f64>) -> Self {
        Self::new(key, Value::Number(default), Allowed::Number(range))
    }

    /// Creates a setting for a whole number. Both limits are included.
    pub fn whole(key: &str, default: i64, range: RangeInclusive<i64>) -> Self {
        Self::new(key, Value::Whole(default), Allowed::Whole(range))
    }

    /// Creates a setting for a flag.
    pub fn flag(key: &str, default: bool) -> Self {
        Self::new(key, Value::Flag(default), Allowed::Flag)
    }

    /// Creates a setting for a word out of several choices.
    pub fn word(key: &str, default: &str, choices: &[&str]) -> Self {
        let choices = choices.iter().map(|&choice| choice.to_owned()).collect();
        Self::new(key, Value::Word(default.into()), Allowed::Word(choices))
    }

    /// Creates a setting for any text, such as the path of a file.
    pub fn text(key: &str, default: &str) -> Self {
        Self::new(key, Value::Word(default.into()), Allowed::Text)
    }

    /// Creates a setting for a list of numbers. It always has the same length as the default. Both limits are
    /// included.
    pub fn numbers(key: &str, default: &[f64], range: RangeInclusive<f64>) -> Self {
        Self::new(key, Value::Numbers(default.to_vec()), Allowed::Numbers(range))
    }

    /// Sets the unit, as it is written after a number, for example `cm` or `rad/s`.
    pub fn unit(mut self, unit: &str) -> Self {
        self.unit = unit.into();
        self
    }

    /// Marks the default as stated by the source of the experiment.
    pub fn given(mut self) -> Self {
        self.source = Source::Given;
        self
    }

    /// Marks the default as derived from the source.
    pub fn derived(mut self) -> Self {
        self.source = Source::Derived;
        self
    }

    /// Sets one sentence of documentation. If the default was chosen here, use it to give the reason.
    pub fn doc(mut self, doc: &str) -> Self {
        self.doc = doc.into();
        self
    }

    /// Sets the place of the default in a file, for errors about it, for example `my.toml line 3`.
    pub fn at(mut self, place: &str) -> Self {
        self.place = place.into();
        self
    }

    /// Replaces the default. This is useful if an experiment has a better default for a setting of a strategy.
    ///
    /// # Errors
    /// Returns a description of the fault if the value is outside the limits.
    pub fn with_default(&self, value: Value) -> Result<Self, String> {
        Ok(Self { default: self.check(value)?, ..self.clone() })
    }

    /// Gets the key.
    pub fn key(&self) -> &str {
        &self.key
    }

    /// Gets the default value.
    pub fn default_value(&self) -> &Value {
        &self.default
    }

    /// Gets the unit. This is empty for settings without a unit.
    pub fn unit_name(&self) -> &str {
        &self.unit
    }

    /// Gets the origin of the default.
    pub fn source(&self) -> Source {
        self.source
    }

    /// Gets the place of the default in a file. This is empty for other defaults.
    pub fn place(&self) -> &str {
        &self.place
    }

    /// Gets the documentation.
    pub fn doc_text(&self) -> &str {
        &self.doc
    }

    /// Describes all allowed values, for example `0.0 to 1.0` or `filter, two-tap or evonet`.
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

    /// Describes all allowed values with their kind and range.
    pub(crate) fn allowed_values(&self) -> AllowedValues {
        let (kind, range, choices) = match &self.allowed {
            Allowed::Flag => ("flag", None, Vec::new()),
            Allowed::Whole(range) => ("whole", Some([*range.start() as f64, *range.end() as f64]), Vec::new()),
            Allowed::Number(range) => ("number", Some([*range.start(), *range.end()]), Vec::new()),
            Allowed::Word(choices) => ("word", None, choices.clone()),
            Allowed::Text => ("text", None, Vec::new()),
            Allowed::Numbers(range) => ("numbers", Some([*range.start(), *range.end()]), Vec::new()),
        };
        AllowedValues { kind, range, choices }
    }

    /// Checks if this is the only allowed number.
    pub(crate) fn is_fixed_to(&self, value: &Value) -> bool {
        let is_single = match &self.allowed {
            Allowed::Whole(range) => range.start() >= range.end(),
            Allowed::Number(range) | Allowed::Numbers(range) => range.start() >= range.end(),
            Allowed::Flag | Allowed::Word(_) | Allowed::Text => false,
        };
        is_single && self.default == *value
    }

    fn length(&self) -> usize {
        match &self.default {
            Value::Numbers(list) => list.len(),
            _ => 1,
        }
    }

    /// Checks a value. A whole number is accepted as a number.
    pub(super) fn check(&self, value: Value) -> Result<Value, String> {
        let outside = |x: &dyn fmt::Display| Err(format!("{x} is outside {}", self.allowed()));
        let shown = |value: &Value| shortened(&value.to_string()).into_owned();
        match (&self.allowed, value) {
            (Allowed::Flag, value @ Value::Flag(_)) | (Allowed::Text, value @ Value::Word(_)) => Ok(value),
            // The written digits are lost: 1.50 and 1.5 are one number, but two names of files.
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
