//! File of a sweep.

use std::collections::BTreeMap;

use crate::error::Error;
use crate::evaluation::generations::Sampling;
use crate::evaluation::test::TEST_SEED;
use crate::experiment::settings::Value;
use crate::limits::MAX_TRIALS;
use crate::run::config_file::{ConfigFile, Entry, FileKey};
use crate::run::plan::MAX_SEED;
use crate::strategy::settings::STRATEGY;

/// Largest number of replications of a point, and of values in a list.
const MAX_SEEDS: i64 = 10_000;
/// Keys of the table `test`.
const TESTS: [&str; 3] = ["trials", "every", "every_trials"];
/// Trials of the test of every n-th generation where no number is given.
const SAMPLED_TRIALS: u32 = 20;

/// A configuration in which some settings have several values.
#[derive(Debug)]
pub(crate) struct SweepFile {
    /// Settings common to all points.
    pub(crate) base: ConfigFile,
    /// Settings that vary. Each row of one axis is combined with each row of the others.
    pub(crate) axes: Vec<Axis>,
    /// Distinct seeds of every point, at least one.
    pub(crate) seeds: Vec<u64>,
    /// Trials of the test of each champion, if there is one.
    pub(crate) test_trials: Option<u32>,
    /// Tests of the best of every n-th generation, if there are any.
    pub(crate) sampling: Option<Sampling>,
}

/// Keys with values that change together.
#[derive(Debug)]
pub(crate) struct Axis {
    pub(crate) keys: Vec<Entry<String>>,
    /// A value for each key, in at least one row.
    pub(crate) rows: Vec<Vec<Entry<Value>>>,
}

/// Parts of a sweep file that are not a configuration.
#[derive(Default)]
pub(super) struct Added {
    grid: Vec<Column>,
    list: Vec<Column>,
    replications: Option<Entry<u32>>,
    seeds: Option<Entry<Vec<u64>>>,
    /// Whole numbers of the table `test` by their names.
    tests: BTreeMap<String, Entry<u32>>,
}

type Column = (Entry<String>, Vec<Entry<Value>>);

impl SweepFile {
    /// Parses a text, named in errors.
    pub(crate) fn parse(name: &str, text: &str) -> Result<Self, Error> {
        let mut added = Added::default();
        let base = ConfigFile::parse_beside(name, text, &mut |found| added.take(found))?;
        let file = Self::new(base, added)?;
        if file.axes.is_empty() {
            return Err(Error::Usage(format!("{name}: neither [grid] nor [list] has a setting: nothing varies")));
        }
        Ok(file)
    }

    /// Combines a configuration with the other keys. Without axes, there is one point.
    pub(super) fn new(base: ConfigFile, added: Added) -> Result<Self, Error> {
        let Added { grid, list, replications, seeds, tests } = added;
        let mut axes: Vec<Axis> = Vec::new();
        for (key, values) in grid {
            let rows = values.into_iter().map(|value| vec![value]).collect();
            axes.push(Axis { keys: vec![key], rows });
        }
        axes.extend(Axis::side_by_side(list)?);
        let keys: Vec<&Entry<String>> = axes.iter().flat_map(|axis| &axis.keys).collect();
        for (index, key) in keys.iter().enumerate() {
            let other = keys.iter().take(index).find(|other| other.value == key.value).map(|other| &other.place);
            let own = base.entries.iter().find(|(other, _)| *other == key.value).map(|(_, entry)| &entry.place);
            let named = [("condition", &base.condition), (STRATEGY, &base.strategy)];
            let named = named.into_iter().find(|(name, _)| key.value == *name);
            let named = named.and_then(|(_, entry)| entry.as_ref()).map(|entry| &entry.place);
            if let Some(first) = other.or(own).or(named) {
                let line = first.rsplit(' ').next().unwrap_or_default();
                return Err(wrong(key, &format!("has a value in line {line} already")));
            }
        }
        let seeds = seeds_of(&base, replications, seeds)?;
        let test = |key: &str| tests.get(key).map(|entry| entry.value);
        let sampling = match (test("every"), tests.get("every_trials")) {
            (Some(every), trials) => {
                let trials = trials.map_or(SAMPLED_TRIALS, |entry| entry.value);
                Some(Sampling { every, trials, seed: TEST_SEED })
            }
            (None, Some(Entry { place, .. })) => {
                let key = Entry { value: "test.every_trials".to_owned(), place: place.clone() };
                return Err(wrong(&key, "needs test.every, the generations from one test to the next"));
            }
            (None, None) => None,
        };
        Ok(Self { base, axes, seeds, test_trials: test("trials"), sampling })
    }
}

impl Added {
    /// Handles a key that is not part of a configuration.
    pub(super) fn take(&mut self, found: &FileKey<'_>) -> Result<bool, Error> {
        let key = |key: &str| Entry { value: key.to_owned(), place: found.place.to_owned() };
        match found.key.split_once('.') {
            None if ["grid", "list"].contains(&found.key) => {
                // An empty table has no values.
                if found.value.is_some() { Err(wrong(&key(found.key), "is a table of lists")) } else { Ok(true) }
            }
            None if found.key == "replications" => {
                let count = match found.value()? {
                    Value::Whole(count @ 1..=MAX_SEEDS) => u32::try_from(count).ok(),
                    _ => None,
                };
                let why = format!("is not a whole number from 1 to {MAX_SEEDS}");
                let value = count.ok_or_else(|| wrong(&key(found.key), &why))?;
                self.replications = Some(Entry { value, place: found.place.into() });
                Ok(true)
            }
            None if found.key == "seed" && found.is_list() => {
                self.seeds = Some(Entry { value: listed_seeds(found)?, place: found.place.into() });
                Ok(true)
            }
            None if found.key == "test" && found.value.is_none() => Ok(true),
            Some(("test", name)) => {
                if !TESTS.contains(&name) {
                    let known = TESTS.map(|name| format!("test.{name}"));
                    let known = known.iter().map(String::as_str);
                    return Err(Error::unknown(found.place, "key", &format!("test.{name}"), known));
                }
                let count = match found.value()? {
                    Value::Whole(count) => u32::try_from(count).ok().filter(|count| (1..=MAX_TRIALS).contains(count)),
                    _ => None,
                };
                let why = format!("is not a whole number from 1 to {MAX_TRIALS}");
                let value = count.ok_or_else(|| wrong(&key(found.key), &why))?;
                self.tests.insert(name.to_owned(), Entry { value, place: found.place.into() });
                Ok(true)
            }
            Some((table @ ("grid" | "list"), name)) => {
                let key = key(name);
                match name {
                    "seed" | "replications" => {
                        let why = "belongs outside [grid] and [list]: every point has all seeds";
                        return Err(wrong(&key, why));
                    }
                    "experiment" => return Err(wrong(&key, "belongs outside [grid] and [list]: a sweep has one")),
                    _ => {}
                }
                let values = found.list().map_err(|error| match error {
                    Error::Setting { place, why, .. } => Error::Setting { place, key: name.into(), why },
                    other => other,
                })?;
                if values.is_empty() {
                    return Err(wrong(&key, "has no value"));
                }
                if table == "grid" { &mut self.grid } else { &mut self.list }.push((key, values));
                Ok(true)
            }
            _ => Ok(false),
        }
    }
}

impl Axis {
    /// Combines columns into one axis, or none.
    fn side_by_side(columns: Vec<Column>) -> Result<Option<Self>, Error> {
        let Some((first, values)) = columns.first() else { return Ok(None) };
        let rows = values.len();
        if let Some((key, values)) = columns.iter().find(|(_, values)| values.len() != rows) {
            let why = format!(
                "has {} values where `{}` has {rows}: in [list] they stand side by side",
                values.len(),
                first.value
            );
            return Err(wrong(key, &why));
        }
        let (keys, columns): (Vec<_>, Vec<_>) = columns.into_iter().unzip();
        let row = |row: usize| columns.iter().filter_map(|column| column.get(row).cloned()).collect();
        Ok(Some(Self { keys, rows: (0..rows).map(row).collect() }))
    }
}

/// Builds the error of a value.
pub(super) fn wrong(key: &Entry<String>, why: &str) -> Error {
    Error::Setting { place: key.place.clone(), key: key.value.clone(), why: why.into() }
}

/// Reads the seeds of a list.
fn listed_seeds(found: &FileKey<'_>) -> Result<Vec<u64>, Error> {
    let mut seeds: Vec<u64> = Vec::new();
    for Entry { value, place } in found.list()? {
        let key = Entry { value: "seed".to_owned(), place };
        let seed = match value {
            Value::Whole(seed) => u64::try_from(seed).ok(),
            _ => None,
        };
        let seed = seed.ok_or_else(|| wrong(&key, "is not a whole number from 0 to 9223372036854775807"))?;
        if seeds.contains(&seed) {
            return Err(wrong(&key, &format!("{seed} is listed twice")));
        }
        seeds.push(seed);
    }
    if seeds.is_empty() {
        return Err(wrong(&Entry { value: "seed".into(), place: found.place.into() }, "has no value"));
    }
    Ok(seeds)
}

/// Lists the seeds of every point: the listed ones, or one for each replication.
fn seeds_of(
    base: &ConfigFile,
    replications: Option<Entry<u32>>,
    seeds: Option<Entry<Vec<u64>>>,
) -> Result<Vec<u64>, Error> {
    if let Some(seeds) = seeds {
        return match replications {
            Some(Entry { place, .. }) => {
                let key = Entry { value: "replications".to_owned(), place };
                Err(wrong(&key, &format!("cannot be combined with a list of {} seeds", seeds.value.len())))
            }
            None => Ok(seeds.value),
        };
    }
    let first = base.seed.as_ref().map_or(1, |seed| seed.value);
    let (count, place) = replications.map_or((1, String::new()), |entry| (u64::from(entry.value), entry.place));
    let Some(last) = first.checked_add(count - 1).filter(|last| *last <= MAX_SEED) else {
        let key = Entry { value: "replications".to_owned(), place };
        return Err(wrong(&key, &format!("{count} from seed {first}: the largest seed is {MAX_SEED}")));
    };
    Ok((first..=last).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grid_and_a_list_are_axes() {
        let text = "experiment = \"cart\"\nseed = 5\nreplications = 2\n[trial]\nsteps = 10\n[grid]\n\
                    condition = [\"a\", \"b\"]\nw.x = [\n  1,\n  2.5,\n]\n[list]\nw.y = [1, 2, 3]\nw.z = [[1], [2, 3], []]\n";
        let file = SweepFile::parse("my.toml", text).unwrap();
        assert_eq!(file.seeds, [5, 6]);
        assert_eq!(file.base.entries.len(), 1);
        let shape: Vec<(Vec<&str>, usize)> = file
            .axes
            .iter()
            .map(|axis| (axis.keys.iter().map(|key| key.value.as_str()).collect(), axis.rows.len()))
            .collect();
        assert_eq!(shape, [(vec!["condition"], 2), (vec!["w.x"], 2), (vec!["w.y", "w.z"], 3)]);
        let Entry { value, place } = &file.axes[1].rows[1][0];
        assert_eq!((value, place.as_str()), (&Value::Number(2.5), "my.toml line 10"));
        assert_eq!(file.axes[2].rows[1][1].value, Value::Numbers(vec![2.0, 3.0]));
        let seeds = SweepFile::parse("my.toml", "seed = [9, 2]\n[grid]\na.b = [1]\n").unwrap();
        assert_eq!((seeds.seeds, seeds.test_trials), (vec![9, 2], None));
        let tested = SweepFile::parse("my.toml", "[grid]\na.b = [1]\n[test]\ntrials = 50\n").unwrap();
        assert_eq!((tested.base.entries.len(), tested.test_trials, tested.sampling), (0, Some(50), None));
        for (line, trials) in [("", 20), ("every_trials = 7\n", 7)] {
            let text = format!("[grid]\na.b = [1]\n[test]\nevery = 10\n{line}");
            let tested = SweepFile::parse("my.toml", &text).unwrap();
            let sampling = Sampling { every: 10, trials, seed: 1 };
            assert_eq!((tested.test_trials, tested.sampling), (None, Some(sampling)));
        }
    }

    #[test]
    fn mistakes_are_found_with_their_line() {
        let grid = "[grid]\na.b = [1]\n";
        for (text, message) in [
            ("seed = 1\n".to_owned(), "my.toml: neither [grid] nor [list] has a setting: nothing varies"),
            ("[grid]\n[list]\n".into(), "my.toml: neither [grid] nor [list] has a setting: nothing varies"),
            ("grid = 1\n".into(), "my.toml line 1: `grid`: is a table of lists"),
            ("[grid]\na.b = 1\n".into(), "my.toml line 2: `a.b`: is not a list of values"),
            ("[grid]\na.b = []\n".into(), "my.toml line 2: `a.b`: has no value"),
            (
                "[grid]\na.b = [\n1,\n1979-05-27]\n".into(),
                "my.toml line 4: `a.b`: is not a flag, number, word or list of numbers",
            ),
            ("[grid]\na.b = [1]\n[list]\na.b = [2]\n".into(), "my.toml line 4: `a.b`: has a value in line 2 already"),
            ("a.b = 1\n[grid]\na.b = [2]\n".into(), "my.toml line 3: `a.b`: has a value in line 1 already"),
            (
                "condition = \"x\"\n[grid]\ncondition = [\"y\"]\n".into(),
                "my.toml line 3: `condition`: has a value in line 1 already",
            ),
            (
                "[grid]\nseed = [1, 2]\n".into(),
                "my.toml line 2: `seed`: belongs outside [grid] and [list]: every point has all seeds",
            ),
            (
                "[list]\nexperiment = [\"a\"]\n".into(),
                "my.toml line 2: `experiment`: belongs outside [grid] and [list]: a sweep has one",
            ),
            (
                "[list]\na.b = [1, 2]\na.c = [1]\n".into(),
                "my.toml line 3: `a.c`: has 1 values where `a.b` has 2: in [list] they stand side by side",
            ),
            (
                format!("replications = 0\n{grid}"),
                "my.toml line 1: `replications`: is not a whole number from 1 to 10000",
            ),
            (
                format!("replications = 10001\n{grid}"),
                "my.toml line 1: `replications`: is not a whole number from 1 to 10000",
            ),
            (
                format!("{grid}[test]\ntrials = 0\n"),
                "my.toml line 4: `test.trials`: is not a whole number from 1 to 100000000",
            ),
            (
                format!("{grid}[test]\ntrial = 5\n"),
                "my.toml line 4: unknown key `test.trial`; the nearest is `test.trials`",
            ),
            (format!("seed = [1, 2, 1]\n{grid}"), "my.toml line 1: `seed`: 1 is listed twice"),
            (format!("seed = []\n{grid}"), "my.toml line 1: `seed`: has no value"),
            (
                format!("seed = [1,\n-1]\n{grid}"),
                "my.toml line 2: `seed`: is not a whole number from 0 to 9223372036854775807",
            ),
            (
                format!("seed = [1, 3]\nreplications = 2\n{grid}"),
                "my.toml line 2: `replications`: cannot be combined with a list of 2 seeds",
            ),
            (
                format!("seed = 9223372036854775807\nreplications = 2\n{grid}"),
                "my.toml line 2: `replications`: 2 from seed 9223372036854775807: the largest seed is 9223372036854775807",
            ),
        ] {
            let error = SweepFile::parse("my.toml", &text).unwrap_err();
            assert_eq!((error.to_string().as_str(), error.exit_code()), (message, 2), "{text}");
        }
        let many = "1,".repeat(10_001);
        let error = SweepFile::parse("my.toml", &format!("seed = [{many}]\n{grid}")).unwrap_err();
        assert_eq!(error.to_string(), "my.toml line 1: `seed`: is a list of more than 10000");
    }
}
