//! A configuration file, and the settings of a command line.

use std::path::Path;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::error::Error;
use crate::experiment::settings::Value;
use crate::store::bounded;

/// The most bytes that are read of a configuration.
const MOST_BYTES: u64 = 16_000_000;

/// A value and where in a file it stands.
#[derive(Debug)]
pub(crate) struct Entry<T> {
    pub(crate) value: T,
    pub(crate) place: String,
}

/// What a configuration file says, before an experiment has seen it.
#[derive(Debug)]
pub(crate) struct ConfigFile {
    pub(crate) name: String,
    pub(crate) experiment: Option<Entry<String>>,
    pub(crate) condition: Option<Entry<String>>,
    pub(crate) seed: Option<Entry<u64>>,
    pub(crate) values: Vec<(String, Entry<Value>)>,
}

impl ConfigFile {
    /// Reads a file that the user names.
    ///
    /// # Errors
    /// [`Error::Io`], or [`Error::Setting`] or [`Error::Usage`] with the line.
    pub(crate) fn read(path: &Path) -> Result<Self, Error> {
        // What is wrong with it is wrong with what was asked for.
        let text = bounded::read_text(path, MOST_BYTES).map_err(|error| match error {
            error @ Error::Damaged { .. } => Error::Usage(error.to_string()),
            other => other,
        })?;
        Self::parse(&path.display().to_string(), &text)
    }

    /// Reads the configuration of a run.
    ///
    /// # Errors
    /// As [`read`](Self::read), and [`Error::Damaged`].
    pub(crate) fn read_own(path: &Path) -> Result<Self, Error> {
        Self::parse(&path.display().to_string(), &bounded::read_own_text(path, MOST_BYTES)?)
    }

    /// Reads a text; errors name it.
    pub(crate) fn parse(name: &str, text: &str) -> Result<Self, Error> {
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
    fn a_file_is_text_that_ends() {
        let path = std::env::temp_dir().join(format!("farsa config {}", std::process::id()));
        std::fs::write(&path, b"seed = 1\ncondition = \"\xff\"\n").unwrap();
        let wrong = |found: Result<ConfigFile, Error>| found.map(|_| ()).unwrap_err();
        let (given, own) = (wrong(ConfigFile::read(&path)), wrong(ConfigFile::read_own(&path)));
        let why = format!("{}: line 2: the byte 0xff is no text (UTF-8)", path.display());
        assert_eq!((given.to_string(), given.exit_code()), (why.clone(), 2));
        assert_eq!((own.to_string(), own.exit_code()), (why, 1));
        std::fs::remove_file(&path).unwrap();
        if cfg!(unix) {
            let endless = wrong(ConfigFile::read("/dev/zero".as_ref())).to_string();
            assert_eq!(endless, "/dev/zero: has more than 16000000 bytes, the most that is read of it");
            assert_eq!(
                wrong(ConfigFile::read_own("/dev/zero".as_ref())).to_string(),
                "/dev/zero: is not a regular file"
            );
        }
    }
}
