//! A configuration file, and the settings of a command line.

use std::collections::BTreeSet;
use std::path::Path;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::error::Error;
use crate::escaped::{CUT, MAX_SHOWN, OneLine, Quoted, shortened};
use crate::experiment::settings::Value;
use crate::store::bounded;
use crate::strategy::settings::STRATEGY;

/// Bytes of the largest configuration. It may contain the definition of an experiment with embedded files.
pub(crate) const MAX_BYTES: u64 = 4_000_000;
/// A number of keys above that of the settings of any experiment.
const MAX_KEYS: usize = 10_000;
/// Largest number of values of a list that a [`FileKey`] returns.
const MAX_LISTED: usize = 10_000;
/// Keys that are not settings.
const RESERVED: [&str; 4] = ["experiment", "definition", "condition", "seed"];

/// A value with its place in a file.
#[derive(Debug, Clone)]
pub(crate) struct Entry<T> {
    pub(crate) value: T,
    pub(crate) place: String,
}

/// Content of a configuration file, before it is applied to an experiment.
#[derive(Debug, Clone)]
pub(crate) struct ConfigFile {
    pub(crate) name: String,
    pub(crate) experiment: Option<Entry<String>>,
    /// Text that describes the experiment, if it comes from a file.
    pub(crate) definition: Option<Entry<String>>,
    pub(crate) condition: Option<Entry<String>>,
    /// Value of `name` in the section `strategy`.
    pub(crate) strategy: Option<Entry<String>>,
    pub(crate) seed: Option<Entry<u64>>,
    /// Keys and values in their order. An empty section is a key without a value.
    pub(crate) entries: Vec<(String, Entry<Option<Value>>)>,
    /// Place of the first key above the limit.
    pub(crate) beyond: Option<String>,
}

impl ConfigFile {
    /// Reads a file named by the user.
    ///
    /// # Errors
    /// [`Error::Setting`] or [`Error::Usage`] with the line.
    pub(crate) fn read(path: &Path) -> Result<Self, Error> {
        let text = bounded::read_stream_text(path, MAX_BYTES)?;
        Self::parse(&path.display().to_string(), &text)
    }

    /// Reads the configuration of a run.
    ///
    /// # Errors
    /// As [`read`](Self::read), [`Error::Io`] and [`Error::File`].
    pub(crate) fn read_regular(path: &Path) -> Result<Self, Error> {
        Self::parse(&path.display().to_string(), &bounded::read_regular_text(path, MAX_BYTES)?)
    }

    /// Parses a text, named `name` in errors.
    pub(crate) fn parse(name: &str, text: &str) -> Result<Self, Error> {
        Self::parse_beside(name, text, &mut |_| Ok(false))
    }

    /// Parses a text with some keys that are not a configuration: those for which `take` returns true.
    ///
    /// # Errors
    /// The errors of [`read`](Self::read) and of `take`.
    pub(crate) fn parse_beside(
        name: &str,
        text: &str,
        take: &mut dyn FnMut(&FileKey<'_>) -> Result<bool, Error>,
    ) -> Result<Self, Error> {
        let lines = Lines::new(text);
        let place = |offset: usize| format!("{} line {}", OneLine(name), lines.line(offset));
        let table = DeTable::parse(text).map_err(|error| {
            let span = error.span();
            let offset = span.as_ref().map_or_else(|| deepest(text), |span| Some(span.start));
            let at = offset.map_or_else(|| OneLine(name).to_string(), place);
            // The message does not name the key.
            let about_key = ["duplicate key", "cannot extend"].iter().any(|start| error.message().starts_with(start));
            let key = span.and_then(|span| text.get(span)).filter(|key| about_key && !key.is_empty());
            let key = key.map_or_else(String::new, |key| format!(" {}", Quoted(key)));
            Error::Usage(format!("{at}: {}{key}", error.message()))
        })?;
        Self::from_table(name, table.get_ref(), &place, take)
    }

    /// Reads the keys of a table, as [`parse_beside`](Self::parse_beside) does. `place` returns the place of a byte.
    pub(crate) fn from_table(
        name: &str,
        table: &DeTable<'_>,
        place: &dyn Fn(usize) -> String,
        take: &mut dyn FnMut(&FileKey<'_>) -> Result<bool, Error>,
    ) -> Result<Self, Error> {
        let mut keys = Keys::default();
        keys.collect(table, None);
        // The table is in alphabetical order.
        keys.found.sort_unstable_by_key(|key| key.offset);
        let mut seen = BTreeSet::new();
        let mut file = Self {
            name: name.into(),
            experiment: None,
            definition: None,
            condition: None,
            strategy: None,
            seed: None,
            entries: Vec::new(),
            beyond: None,
        };
        for found in &keys.found {
            let reserved = found.table.is_none() && found.value.is_some() && RESERVED.contains(&found.name);
            if file.entries.len() == MAX_KEYS && !reserved {
                file.beyond.get_or_insert_with(|| place(found.offset));
                continue;
            }
            let (key, at) = (keys.path(found), place(found.offset));
            if take(&FileKey { key: &key, place: &at, value: found.value, places: place })? {
                continue;
            }
            let Some(value) = found.value else {
                file.entries.push((key, Entry { value: None, place: at }));
                continue;
            };
            let wrong = |why: &str| Error::Setting { place: at.clone(), key: key.clone(), why: why.into() };
            let value = plain(value).map_err(&wrong)?;
            if !key.ends_with(CUT) && !seen.insert(key.clone()) {
                return Err(wrong("is set twice"));
            }
            file.put(&key, value, &at)?;
        }
        Ok(file)
    }

    /// Adds a value of a new key.
    ///
    /// # Errors
    /// [`Error::Setting`] for a name or seed of another type.
    pub(crate) fn put(&mut self, key: &str, value: Value, place: &str) -> Result<(), Error> {
        let wrong = |why: &str| Error::Setting { place: place.into(), key: key.into(), why: why.into() };
        let place = place.to_owned();
        match (key, value) {
            ("experiment", Value::Word(word)) => self.experiment = Some(Entry { value: word, place }),
            ("definition", Value::Word(word)) => self.definition = Some(Entry { value: word, place }),
            ("condition", Value::Word(word)) => self.condition = Some(Entry { value: word, place }),
            (STRATEGY, Value::Word(word)) => self.strategy = Some(Entry { value: word, place }),
            ("experiment" | "definition" | "condition" | STRATEGY, _) => return Err(wrong("is not a name in quotes")),
            ("seed", Value::Whole(seed)) if seed >= 0 => {
                self.seed = Some(Entry { value: seed.unsigned_abs(), place });
            }
            ("seed", _) => return Err(wrong("is not a whole number from 0 to 9223372036854775807")),
            (_, value) => self.entries.push((key.into(), Entry { value: Some(value), place })),
        }
        Ok(())
    }
}

/// A key of a file, for readers of more keys than those of a configuration.
pub(crate) struct FileKey<'t> {
    /// Key with the names of its tables.
    pub(crate) key: &'t str,
    pub(crate) place: &'t str,
    /// `None` for an empty table.
    pub(crate) value: Option<&'t Spanned<DeValue<'t>>>,
    /// Returns the place of a byte of the file.
    pub(crate) places: &'t dyn Fn(usize) -> String,
}

impl<'t> FileKey<'t> {
    /// Lists the tables of an array of tables with the places of their heads.
    ///
    /// # Errors
    /// [`Error::Setting`] for any other value.
    pub(crate) fn tables(&self) -> Result<Vec<(&'t DeTable<'t>, String)>, Error> {
        let wrong = || {
            let why = format!("is not a list of tables [[{}]]", self.key);
            Error::Setting { place: self.place.into(), key: self.key.into(), why }
        };
        let Some(DeValue::Array(items)) = self.value.map(Spanned::get_ref) else { return Err(wrong()) };
        let table = |item: &'t Spanned<DeValue<'t>>| match item.get_ref() {
            DeValue::Table(table) => Ok((table, (self.places)(item.span().start))),
            _ => Err(wrong()),
        };
        items.iter().map(table).collect()
    }

    pub(crate) fn is_list(&self) -> bool {
        matches!(self.value.map(Spanned::get_ref), Some(DeValue::Array(_)))
    }

    /// Lists the values of a list with their places.
    ///
    /// # Errors
    /// [`Error::Setting`] for a value that is not a list, or for an element that cannot be the value of a setting.
    pub(crate) fn list(&self) -> Result<Vec<Entry<Value>>, Error> {
        let wrong = |place: String, why: &str| Error::Setting { place, key: self.key.into(), why: why.into() };
        let Some(DeValue::Array(items)) = self.value.map(Spanned::get_ref) else {
            return Err(wrong(self.place.into(), "is not a list of values"));
        };
        if items.len() > MAX_LISTED {
            return Err(wrong(self.place.into(), &format!("is a list of more than {MAX_LISTED}")));
        }
        let values = items.iter().map(|item| {
            let place = (self.places)(item.span().start);
            plain(item).map(|value| Entry { value, place: place.clone() }).map_err(|why| wrong(place, why))
        });
        values.collect()
    }

    /// Returns the value.
    ///
    /// # Errors
    /// [`Error::Setting`] for a value that no setting can have.
    pub(crate) fn value(&self) -> Result<Value, Error> {
        let value = self.value.map_or(Err("is an empty table"), plain);
        value.map_err(|why| Error::Setting { place: self.place.into(), key: self.key.into(), why: why.into() })
    }
}

/// Finds the start of the line with a key of too many parts. The error of toml has no position for it.
fn deepest(text: &str) -> Option<usize> {
    // The limit of toml.
    let many = |line: &str| line.matches('.').count() >= 79;
    let refused = |line: &str| DeTable::parse_recoverable(line).1.iter().any(|error| error.span().is_none());
    let mut start = 0;
    text.split_inclusive('\n').find_map(|line| {
        let here = start;
        start += line.len();
        (many(line) && refused(line)).then_some(here)
    })
}

/// Starts of the lines of a text.
struct Lines(Vec<usize>);

impl Lines {
    fn new(text: &str) -> Self {
        Self(std::iter::once(0).chain(text.match_indices('\n').map(|(end, _)| end + 1)).collect())
    }

    /// Gets the line of a byte, from 1.
    fn line(&self, offset: usize) -> usize {
        self.0.partition_point(|&start| start <= offset)
    }
}

/// A key with its value, or an empty table.
struct Key<'t> {
    offset: usize,
    /// Number of its table, `None` for the root table.
    table: Option<usize>,
    name: &'t str,
    value: Option<&'t Spanned<DeValue<'t>>>,
}

/// Keys of a file. Their names are joined late, because a long name of a table would be repeated in each key.
#[derive(Default)]
struct Keys<'t> {
    /// Name and parent of each table.
    tables: Vec<(Option<usize>, &'t str)>,
    found: Vec<Key<'t>>,
}

impl<'t> Keys<'t> {
    fn collect(&mut self, table: &'t DeTable<'t>, number: Option<usize>) {
        for (name, value) in table {
            let (offset, name) = (name.span().start, name.get_ref().as_ref());
            match value.get_ref() {
                DeValue::Table(inner) if inner.is_empty() => {
                    self.found.push(Key { offset, table: number, name, value: None });
                }
                DeValue::Table(inner) => {
                    self.tables.push((number, name));
                    self.collect(inner, Some(self.tables.len() - 1));
                }
                _ => self.found.push(Key { offset, table: number, name, value: Some(value) }),
            }
        }
    }

    /// Formats the full key, shortened if it is longer than that of any setting.
    fn path(&self, key: &Key<'t>) -> String {
        let (mut names, mut table) = (vec![key.name], key.table);
        while let Some(&(above, name)) = table.and_then(|number| self.tables.get(number)) {
            names.push(name);
            table = above;
        }
        let mut path = String::new();
        for (number, name) in names.iter().rev().enumerate() {
            if number > 0 {
                path.push('.');
            }
            path.extend(name.chars().take(MAX_SHOWN + 1));
        }
        shortened(&path).into_owned()
    }
}

/// Converts a TOML value into the value of a setting.
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

/// Splits `key=value` of `--set`. A value that is not TOML is a word.
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
    use crate::experiment::settings::{Setting, Settings};

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
    fn words_may_look_like_numbers() {
        let choices = &["none", "nan", "inf", "-inf"];
        let mut s = Settings::new(vec![Setting::word("fault.kind", "none", choices)]).unwrap();
        for (given, word) in [("nan", "nan"), ("NaN", "nan"), ("inf", "inf"), ("+inf", "inf"), ("-inf", "-inf")] {
            let (key, value) = assignment(&format!("fault.kind={given}")).unwrap();
            s.set("--set", &key, value).unwrap();
            assert_eq!(s.word("fault.kind").unwrap(), word);
        }
    }

    #[test]
    fn values_print_as_toml() {
        for (value, text) in [
            (Value::Number(1.0), "1.0"),
            (Value::Number(1e-9), "1e-9"),
            (Value::Numbers(vec![1.0, -0.5]), "[1.0, -0.5]"),
            (Value::Word("two-tap".into()), "\"two-tap\""),
            (Value::Whole(-3), "-3"),
            (
                Value::Word("C:\\a \"b\"\t\u{1}\u{7f}é\u{301}'".into()),
                "\"C:\\\\a \\\"b\\\"\\t\\u0001\\u007Fé\u{301}'\"",
            ),
        ] {
            assert_eq!(value.to_string(), text);
            assert_eq!(assignment(&format!("a.b={text}")).unwrap().1, value);
        }
    }

    #[test]
    fn keys_stand_in_the_order_of_the_file() {
        let text = "seed = 3\n[w]\nz = 1\na = 2\n\n[w.empty]\n[b]\n\"\".seed = {}\nx = { y.z = 4 }\n";
        let file = ConfigFile::parse("my\n.toml", text).unwrap();
        let keys: Vec<_> = file.entries.iter().map(|(key, entry)| (key.as_str(), entry.place.as_str())).collect();
        let place = |line: u32| format!("my\\n.toml line {line}");
        let places = [3, 4, 6, 8, 9].map(place);
        let expected = ["w.z", "w.a", "w.empty", "b..seed", "b.x.y.z"];
        assert_eq!(keys, expected.into_iter().zip(places.iter().map(String::as_str)).collect::<Vec<_>>());
        assert_eq!(file.entries.iter().filter(|(_, entry)| entry.value.is_none()).count(), 2);
        assert_eq!(file.seed.map(|seed| seed.value), Some(3));
        // This is not the seed of the run.
        assert!(ConfigFile::parse("my.toml", "\"\".seed = 3").unwrap().seed.is_none());
    }

    #[test]
    fn names_and_keys_do_not_multiply() {
        use std::fmt::Write as _;
        // Repeating the name of the table in each key would take 2e10 bytes.
        let mut text = format!("[{}]\n", "a".repeat(1_000_000));
        for number in 0..2 * MAX_KEYS {
            writeln!(text, "k{number} = {number}").unwrap();
        }
        let file = ConfigFile::parse("my.toml", &text).unwrap();
        assert_eq!(file.entries.len(), MAX_KEYS);
        assert!(file.entries.iter().all(|(key, _)| key.len() == MAX_SHOWN + CUT.len()));
        assert_eq!(file.beyond.as_deref(), Some("my.toml line 10002"));
    }

    #[test]
    fn a_configuration_may_have_the_largest_number_of_keys() {
        use std::fmt::Write as _;
        // Each key has a value, blanks and a comment.
        let mut keys = String::new();
        for number in 0..MAX_KEYS {
            writeln!(keys, "k{number} = 0.5  # [m]").unwrap();
        }
        assert_eq!(ConfigFile::parse("my.toml", &keys).unwrap().entries.len(), MAX_KEYS);
    }

    #[test]
    fn a_file_is_text_that_ends() {
        let path = std::env::temp_dir().join(format!("farsa config {}", std::process::id()));
        std::fs::write(&path, b"seed = 1\ncondition = \"\xff\"\n").unwrap();
        let wrong = |found: Result<ConfigFile, Error>| found.map(|_| ()).unwrap_err();
        let (given, own) = (wrong(ConfigFile::read(&path)), wrong(ConfigFile::read_regular(&path)));
        let why = format!("{}: line 2: the byte 0xff is no text (UTF-8)", path.display());
        assert_eq!((given.to_string(), given.exit_code()), (why.clone(), 2));
        assert_eq!((own.to_string(), own.exit_code()), (why, 1));
        std::fs::remove_file(&path).unwrap();
        if cfg!(unix) {
            let endless = wrong(ConfigFile::read("/dev/zero".as_ref())).to_string();
            assert_eq!(endless, "/dev/zero: has more than 4000000 bytes, the most that is read of it");
            assert_eq!(
                wrong(ConfigFile::read_regular("/dev/zero".as_ref())).to_string(),
                "/dev/zero: is not a regular file"
            );
        }
    }
}
