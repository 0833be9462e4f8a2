//! Tables `[[checks]]` of a study.

use std::collections::BTreeSet;
use std::path::Path;

use toml::de::DeTable;

use crate::error::Error;
use crate::experiment::settings::Value;
use crate::run::config_file::{ConfigFile, Entry, FileKey, MAX_BYTES};
use crate::store::bounded;
use crate::sweep::measure::{Measure, MeasureKeys};
use crate::sweep::sweep_file::{Added, SweepFile, wrong};

/// Keys of a check that are not settings.
const KEYS: [&str; 12] = [
    "name",
    "experiment",
    "condition",
    "seed",
    "replications",
    "measure",
    "column",
    "least",
    "published",
    "source",
    "expected",
    "quick",
];
/// Beginning of the keys that `--quick` uses instead of others.
const QUICK: &str = "quick.";
/// Bytes of the longest name of a check, which is a directory.
const MAX_NAME_BYTES: usize = 60;

/// File of a sweep or of several checks.
#[derive(Debug)]
pub(crate) enum Study {
    Sweep(Box<SweepFile>),
    Checks(Vec<Check>),
}

/// A published figure, and the runs that are compared with it.
#[derive(Debug)]
pub(crate) struct Check {
    /// Name, also of the directory.
    pub(crate) name: String,
    pub(crate) sweep: SweepFile,
    pub(crate) measure: Measure,
    pub(crate) published: Value,
    pub(crate) source: String,
    /// Least and greatest value that agree.
    pub(crate) expected: [f64; 2],
    /// True if the range was declared for `--quick`.
    pub(crate) is_quick: bool,
}

/// Keys of a check that are not part of a sweep.
#[derive(Default)]
struct CheckKeys {
    name: Option<Entry<String>>,
    measure: MeasureKeys,
    published: Option<Value>,
    source: Option<String>,
    expected: Option<[f64; 2]>,
}

impl Study {
    /// Reads a file named by the user, with the values of [quick] if `quick` is true.
    ///
    /// # Errors
    /// As [`ConfigFile::read`], with the line. Both variants of every check are read.
    pub(crate) fn read(path: &Path, quick: bool) -> Result<Self, Error> {
        let text = bounded::read_stream_text(path, MAX_BYTES)?;
        Self::parse(&path.display().to_string(), &text, quick)
    }

    /// Parses a text, named in errors.
    pub(crate) fn parse(name: &str, text: &str, quick: bool) -> Result<Self, Error> {
        let mut checks: Option<Vec<Check>> = None;
        let mut first: Option<Entry<String>> = None;
        let mut take = |found: &FileKey<'_>| {
            if found.key == "checks" {
                checks = Some(listed(found, quick)?);
                return Ok(true);
            }
            first.get_or_insert_with(|| Entry { value: found.key.into(), place: found.place.into() });
            // The key of a sweep is read by its own parser.
            Ok(true)
        };
        ConfigFile::parse_beside(name, text, &mut take)?;
        match (checks, first) {
            (None, _) if quick => Err(Error::Usage(format!("--quick: {name} has no [[checks]]"))),
            (None, _) => SweepFile::parse(name, text).map(|file| Self::Sweep(Box::new(file))),
            (Some(_), Some(other)) => Err(wrong(&other, "is outside [[checks]], where no other key is valid")),
            (Some(checks), None) => Ok(Self::Checks(checks)),
        }
    }
}

/// Reads all checks.
fn listed(found: &FileKey<'_>, quick: bool) -> Result<Vec<Check>, Error> {
    let mut names = BTreeSet::new();
    let check = |(table, place): (&DeTable<'_>, String)| {
        let mut overridden = BTreeSet::new();
        let full = Check::from_table(table, &place, found.places, None, &mut overridden)?;
        let mut known = overridden.clone();
        if known.contains("measure") {
            // Another measure has its own column and bound.
            known.extend(["column", "least"].map(str::to_owned));
        }
        let short = Check::from_table(table, &place, found.places, Some(&known), &mut overridden)?;
        if !names.insert(full.name.clone()) {
            let key = Entry { value: "name".to_owned(), place };
            return Err(wrong(&key, &format!("`{}` names another check already", full.name)));
        }
        Ok(if quick { short } else { full })
    };
    found.tables()?.into_iter().map(check).collect()
}

impl Check {
    /// Reads a check, with the values of its table `quick` for the keys in `quick`. Collects the keys of this table.
    fn from_table(
        table: &DeTable<'_>,
        place: &str,
        places: &dyn Fn(usize) -> String,
        quick: Option<&BTreeSet<String>>,
        overridden: &mut BTreeSet<String>,
    ) -> Result<Self, Error> {
        let (mut keys, mut added) = (CheckKeys::default(), Added::default());
        let mut settings: Vec<(String, Value, String)> = Vec::new();
        let mut take = |found: &FileKey<'_>| match found.key.strip_prefix(QUICK) {
            Some("name") => Err(wrong(&named(found), "belongs outside [checks.quick]")),
            Some(key) => {
                overridden.insert(key.to_owned());
                let renamed = FileKey { key, ..*found };
                if quick.is_some() && !keys.take(&renamed)? && !added.take(&renamed)? {
                    settings.push((key.to_owned(), renamed.value()?, found.place.to_owned()));
                }
                Ok(true)
            }
            None if quick.is_some_and(|quick| quick.contains(found.key)) => Ok(true),
            None => Ok(found.key == "quick" && found.value.is_none() || keys.take(found)? || added.take(found)?),
        };
        let mut base = ConfigFile::from_table(place, table, places, &mut take)?;
        for (key, value, place) in settings {
            base.put(&key, value, &place)?;
        }
        let is_quick = quick.is_some_and(|quick| quick.contains("expected"));
        keys.into_check(SweepFile::new(base, added)?, place, is_quick)
    }
}

impl CheckKeys {
    /// Handles a key that is not part of a sweep.
    fn take(&mut self, found: &FileKey<'_>) -> Result<bool, Error> {
        let word = || match found.value()? {
            Value::Word(word) if !word.is_empty() => Ok(word),
            _ => Err(wrong(&named(found), "is not a text in quotes")),
        };
        match found.key {
            "name" => {
                let value = word()?;
                let is_plain = value.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'-');
                if !is_plain || value.len() > MAX_NAME_BYTES {
                    let why = format!("is not a name of at most {MAX_NAME_BYTES} letters, digits and hyphens");
                    return Err(wrong(&named(found), &why));
                }
                self.name = Some(Entry { value, place: found.place.into() });
            }
            "measure" => self.measure.measure = Some(Entry { value: word()?, place: found.place.into() }),
            "column" => self.measure.column = Some(Entry { value: word()?, place: found.place.into() }),
            "least" => {
                let least = number(&found.value()?).filter(|least| least.is_finite());
                let value = least.ok_or_else(|| wrong(&named(found), "is not a finite number"))?;
                self.measure.least = Some(Entry { value, place: found.place.into() });
            }
            "published" => match found.value()? {
                value @ (Value::Word(_) | Value::Whole(_) | Value::Number(_)) => self.published = Some(value),
                _ => return Err(wrong(&named(found), "is neither a number nor a text, such as \"none\"")),
            },
            "source" => self.source = Some(word()?),
            "expected" => {
                let range = match found.value()? {
                    Value::Numbers(range) => <[f64; 2]>::try_from(range).ok(),
                    _ => None,
                };
                let why = "is not a range [LEAST, GREATEST]";
                let range = range.filter(|[low, high]| low <= high).ok_or_else(|| wrong(&named(found), why))?;
                self.expected = Some(range);
            }
            "grid" | "list" => return Err(wrong(&named(found), "belongs outside [[checks]]: a check has one point")),
            key if key.starts_with("grid.") || key.starts_with("list.") => {
                return Err(wrong(&named(found), "belongs outside [[checks]]: a check has one point"));
            }
            key if key.starts_with("test.every") => {
                return Err(wrong(&named(found), "belongs outside [[checks]], which test champions only"));
            }
            key if found.value.is_some() && !key.contains('.') && !KEYS.contains(&key) => {
                return Err(Error::unknown(found.place, "key", key, KEYS));
            }
            _ => return Ok(false),
        }
        Ok(true)
    }

    fn into_check(self, sweep: SweepFile, place: &str, is_quick: bool) -> Result<Check, Error> {
        let lacks = |key: &str| {
            let key = Entry { value: key.to_owned(), place: place.to_owned() };
            wrong(&key, "is missing in this table [[checks]]")
        };
        let Self { name, measure, published, source, expected } = self;
        let name = name.ok_or_else(|| lacks("name"))?.value;
        if sweep.base.experiment.is_none() {
            return Err(lacks("experiment"));
        }
        let measure = measure.measure(place, sweep.test_trials.is_some())?;
        let published = published.ok_or_else(|| lacks("published"))?;
        let source = source.ok_or_else(|| lacks("source"))?;
        let expected = expected.ok_or_else(|| lacks("expected"))?;
        Ok(Check { name, sweep, measure, published, source, expected, is_quick })
    }
}

/// Returns a key with its place.
fn named(found: &FileKey<'_>) -> Entry<String> {
    Entry { value: found.key.into(), place: found.place.into() }
}

/// Converts a number of either type.
pub(super) fn number(value: &Value) -> Option<f64> {
    match value {
        Value::Whole(whole) => Some(*whole as f64),
        Value::Number(number) => Some(*number),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = "[[checks]]\nname = \"walk\"\nexperiment = \"toy\"\nreplications = 8\ntrial.steps = 100\ntest.trials = 20\n\
                        measure = \"mean\"\ncolumn = \"test.height [m]\"\npublished = 0.5\nsource = \"Garcia1998\"\n\
                        expected = [0.4, inf]\n";

    fn checks(text: &str, quick: bool) -> Vec<Check> {
        match Study::parse("my.toml", text, quick) {
            Ok(Study::Checks(checks)) => checks,
            other => panic!("{text}: {other:?}"),
        }
    }

    fn steps(check: &Check) -> &Value {
        let entry = check.sweep.base.entries.iter().find(|(key, _)| key == "trial.steps");
        entry.and_then(|(_, entry)| entry.value.as_ref()).expect("a value")
    }

    #[test]
    fn quick_values_replace_others() {
        let quick =
            "[checks.quick]\nreplications = 2\ntrial.steps = 10\ntest.trials = 5\nexpected = [-inf, 0.3]\nw.x = true\n";
        let text = format!("{GOOD}{quick}{}", GOOD.replace("walk", "run"));
        for is_quick in [false, true] {
            let found = checks(&text, is_quick);
            assert_eq!([found[0].name.as_str(), found[1].name.as_str()], ["walk", "run"]);
            let [first, second] = [&found[0], &found[1]];
            let numbers = |check: &Check| (check.sweep.seeds.len(), check.sweep.test_trials, check.expected);
            assert_eq!((numbers(second), second.is_quick), ((8, Some(20), [0.4, f64::INFINITY]), false));
            assert_eq!(second.measure.text(), "mean test.height [m]");
            assert_eq!(second.published, Value::Number(0.5));
            if is_quick {
                assert_eq!((numbers(first), first.is_quick), ((2, Some(5), [f64::NEG_INFINITY, 0.3]), true));
                assert_eq!((steps(first), first.sweep.base.entries.len()), (&Value::Whole(10), 2));
                let places: Vec<&str> =
                    first.sweep.base.entries.iter().map(|(_, entry)| entry.place.as_str()).collect();
                assert_eq!(places, ["my.toml line 14", "my.toml line 17"]);
            } else {
                assert_eq!((numbers(first), first.is_quick), (numbers(second), false));
                assert_eq!((steps(first), first.sweep.base.entries.len()), (&Value::Whole(100), 1));
            }
        }
    }

    #[test]
    fn a_quick_measure_has_its_own_column() {
        let found = checks(&format!("{GOOD}quick.measure = \"trials\"\n"), true);
        assert_eq!((found[0].measure.text().as_str(), found[0].is_quick), ("successful trials", false));
    }

    #[test]
    fn a_sweep_remains_one() {
        let text = "experiment = \"toy\"\n[grid]\na.b = [1, 2]\n";
        assert!(matches!(Study::parse("my.toml", text, false), Ok(Study::Sweep(_))));
        let error = Study::parse("my.toml", text, true).unwrap_err();
        assert_eq!((error.to_string().as_str(), error.exit_code()), ("--quick: my.toml has no [[checks]]", 2));
    }

    #[test]
    fn mistakes_are_found_with_their_line() {
        let with = |line: &str| format!("{GOOD}{line}\n");
        let instead = |key: &str, line: &str| {
            let lines = GOOD.lines().map(|old| if old.starts_with(key) { line } else { old });
            lines.flat_map(|line| [line, "\n"]).collect::<String>()
        };
        for (text, message) in [
            ("checks = 3\n".to_owned(), "my.toml line 1: `checks`: is not a list of tables [[checks]]"),
            ("checks = [3]\n".into(), "my.toml line 1: `checks`: is not a list of tables [[checks]]"),
            (format!("seed = 3\n{GOOD}"), "my.toml line 1: `seed`: is outside [[checks]], where no other key is valid"),
            (with("mesure = 3"), "my.toml line 12: unknown key `mesure`; the nearest is `measure`"),
            (instead("name", ""), "my.toml line 1: `name`: is missing in this table [[checks]]"),
            (
                instead("name", "name = \"a/b\""),
                "my.toml line 2: `name`: is not a name of at most 60 letters, digits and hyphens",
            ),
            (format!("{GOOD}{GOOD}"), "my.toml line 12: `name`: `walk` names another check already"),
            (instead("experiment", ""), "my.toml line 1: `experiment`: is missing in this table [[checks]]"),
            (instead("source", ""), "my.toml line 1: `source`: is missing in this table [[checks]]"),
            (instead("published", ""), "my.toml line 1: `published`: is missing in this table [[checks]]"),
            (
                instead("published", "published = true"),
                "my.toml line 9: `published`: is neither a number nor a text, such as \"none\"",
            ),
            (instead("expected", ""), "my.toml line 1: `expected`: is missing in this table [[checks]]"),
            (instead("expected", "expected = [2, 1]"), "my.toml line 11: `expected`: is not a range [LEAST, GREATEST]"),
            (
                instead("expected", "expected = [nan, 1]"),
                "my.toml line 11: `expected`: is not a range [LEAST, GREATEST]",
            ),
            (instead("measure", "measure = \"meen\""), "my.toml line 7: unknown measure `meen`; the nearest is `mean`"),
            (
                instead("column", "column = \"fitness.bset\""),
                "my.toml line 8: unknown column `fitness.bset`; the nearest is `fitness.best`",
            ),
            (instead("column", ""), "my.toml line 1: `column`: is missing: the values of the measure"),
            (
                instead("column", "column = \"fitness.evaluations\""),
                "my.toml line 1: `least`: is missing: the fitness to reach",
            ),
            (with("least = 3"), "my.toml line 12: `least`: is not a part of the measure `mean`"),
            (
                instead("measure", "measure = \"trials\""),
                "my.toml line 8: `column`: is not a part of the measure `trials`",
            ),
            (instead("test.trials", ""), "my.toml line 1: `test.trials`: is missing: the measure is one of tests"),
            (with("grid.a = [1]"), "my.toml line 12: `grid.a`: belongs outside [[checks]]: a check has one point"),
            (
                with("test.every = 3"),
                "my.toml line 12: `test.every`: belongs outside [[checks]], which test champions only",
            ),
            (with("quick.name = \"b\""), "my.toml line 12: `quick.name`: belongs outside [checks.quick]"),
            (with("quick.measure = \"medain\""), "my.toml line 12: unknown measure `medain`; the nearest is `median`"),
            (
                with("quick.measure = \"runs\""),
                "my.toml line 1: `least`: is missing: the least value of a run that counts",
            ),
            (with("quick.test.trial = 1"), "my.toml line 12: unknown key `test.trial`; the nearest is `test.trials`"),
        ] {
            for quick in [false, true] {
                let error = Study::parse("my.toml", &text, quick).expect_err(&text);
                assert_eq!((error.to_string().as_str(), error.exit_code()), (message, 2), "{text}");
            }
        }
    }
}
