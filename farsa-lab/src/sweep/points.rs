//! Points of a sweep: the settings that vary, and the names of the points.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use farsa_num::crc32;

use crate::error::Error;
use crate::experiment::settings::Value;
use crate::run::config_file::Entry;
use crate::run::laboratory::Laboratory;
use crate::run::plan::Plan;
use crate::strategy::settings::STRATEGY;
use crate::sweep::sweep_file::{Axis, SweepFile};

/// Largest numbers of points, and of runs of all points.
const MAX_POINTS: usize = 10_000;
const MAX_RUNS: usize = 100_000;
/// Bytes of the longest name that is not cut. File systems allow 255, and temporary names are longer.
const MAX_NAME_BYTES: usize = 160;

/// Points of a sweep file, with distinct names and valid settings.
pub(crate) struct Points<'f, 'e> {
    file: &'f SweepFile,
    laboratory: &'f Laboratory<'e>,
    names: Vec<String>,
}

impl<'f, 'e> Points<'f, 'e> {
    /// Checks every value of every point.
    ///
    /// # Errors
    /// [`Error::Usage`] for too many points and for two equal ones, and the errors of [`Plan::from_file`], with the line.
    pub(crate) fn new(file: &'f SweepFile, laboratory: &'f Laboratory<'e>) -> Result<Self, Error> {
        let rows = file.axes.iter().map(|axis| axis.rows.len());
        let count = rows.clone().try_fold(1_usize, usize::checked_mul).filter(|count| *count <= MAX_POINTS);
        let name = &file.base.name;
        let Some(count) = count else {
            let rows: Vec<String> = rows.map(|rows| rows.to_string()).collect();
            return Err(Error::Usage(format!("{name}: more than {MAX_POINTS} points: {}", rows.join(" x "))));
        };
        let seeds = file.seeds.len();
        if count * seeds > MAX_RUNS {
            return Err(Error::Usage(format!("{name}: more than {MAX_RUNS} runs: {count} points of {seeds}")));
        }
        let mut points = Self { file, laboratory, names: Vec::new() };
        let mut known: BTreeMap<String, usize> = BTreeMap::new();
        for point in 0..count {
            let name = points.name_of(point)?;
            if let Some(first) = known.insert(name.clone(), point) {
                let place = points.values(point).last().map_or("", |(_, entry)| &entry.place);
                let (point, first) = (point + 1, first + 1);
                return Err(Error::Usage(format!("{place}: point {point} is point {first} again: {name}")));
            }
            points.names.push(name);
        }
        Ok(points)
    }

    pub(crate) fn count(&self) -> usize {
        self.names.len()
    }

    /// Returns the name of a point, counted from 0, made of the values that vary.
    pub(crate) fn name(&self, point: usize) -> &str {
        self.names.get(point).map_or("", String::as_str)
    }

    /// Returns the plan of a point, with the first seed.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub(crate) fn plan(&self, point: usize) -> Result<Plan<'e>, Error> {
        let mut file = self.file.base.clone();
        for (key, Entry { value, place }) in self.values(point) {
            file.put(&key.value, value.clone(), place)?;
        }
        let mut plan = Plan::from_file(self.laboratory, &file)?;
        plan.seed = self.file.seeds.first().copied().unwrap_or(plan.seed);
        Ok(plan)
    }

    /// Returns an error about a point, with the place of its value.
    pub(crate) fn located(&self, point: usize, error: Error) -> Error {
        let mut whole = self.file.base.name.clone();
        if !self.file.axes.is_empty() {
            let _ = write!(whole, ": point {} ({})", point + 1, self.name(point));
        }
        match error {
            Error::Setting { place, key, why } if place.is_empty() && !key.is_empty() => {
                let own = self.values(point).find(|(name, _)| name.value == key);
                let place = own.map_or(whole, |(_, entry)| entry.place.clone());
                Error::Setting { place, key, why }
            }
            Error::Other(why) | Error::Usage(why) => Error::Usage(format!("{whole}: {why}")),
            other => other,
        }
    }

    /// Iterates over the keys that vary with their values at a point. The last key varies first.
    fn values(&self, point: usize) -> impl Iterator<Item = (&'f Entry<String>, &'f Entry<Value>)> {
        let mut rest = point;
        let mut rows: Vec<(&Axis, usize)> = Vec::new();
        for axis in self.file.axes.iter().rev() {
            rows.push((axis, rest % axis.rows.len()));
            rest /= axis.rows.len();
        }
        rows.into_iter().rev().flat_map(|(axis, row)| axis.keys.iter().zip(&axis.rows[row]))
    }

    /// Formats the values that vary as the name of a folder.
    fn name_of(&self, point: usize) -> Result<String, Error> {
        let plan = self.plan(point)?;
        let keys: Vec<&str> = self.file.axes.iter().flat_map(|axis| &axis.keys).map(|key| key.value.as_str()).collect();
        let last = |key: &str| match key {
            STRATEGY => "strategy".to_owned(),
            key => key.rsplit('.').next().unwrap_or_default().to_owned(),
        };
        let parts = self.values(point).map(|(Entry { value: key, .. }, entry)| {
            let short = last(key);
            let short = if keys.iter().filter(|other| last(other) == short).count() > 1 { key.clone() } else { short };
            // The run has the same number for 1 and 1.0.
            format!("{short}={}", plain(plan.settings.get(key).unwrap_or(&entry.value)))
        });
        Ok(folder(&parts.collect::<Vec<_>>().join(",")))
    }
}

/// Formats a value without quotes.
fn plain(value: &Value) -> String {
    match value {
        Value::Word(word) => word.clone(),
        Value::Numbers(numbers) => numbers.iter().map(|x| format!("{x:?}")).collect::<Vec<_>>().join("_"),
        other => other.to_string(),
    }
}

/// Returns a name that is valid on every file system and in shells. A changed name ends with its checksum.
fn folder(name: &str) -> String {
    let kept: String = name
        .chars()
        .map(|letter| if letter.is_ascii_alphanumeric() || "._,=+-".contains(letter) { letter } else { '_' })
        .take(MAX_NAME_BYTES)
        .collect();
    // The numbers of a list are joined by the replacement letter.
    if kept == name { kept } else { format!("{kept}-{:08x}", crc32(name.as_bytes())) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::settings::Setting;
    use crate::run::experiment::SimpleExperiment;

    const TOY: SimpleExperiment = SimpleExperiment {
        name: "toy",
        summary: "nothing",
        conditions: &["rough", "smooth"],
        settings: |_| {
            vec![
                Setting::number("world.step", 0.01, 0.0..=1e9),
                Setting::whole("trial.step", 1, 1..=1_000_000),
                Setting::numbers("arm.lengths", &[1.0, 2.0], 0.0..=5.0),
                Setting::text("world.map", ""),
            ]
        },
        prepare: |_| Err(Error::Other("never".into())),
    };

    fn names(text: &str) -> Result<Vec<String>, String> {
        let file = SweepFile::parse("my.toml", &format!("experiment = \"toy\"\n{text}")).map_err(|e| e.to_string())?;
        let laboratory = Laboratory::new(&[&TOY]);
        Points::new(&file, &laboratory).map(|points| points.names.clone()).map_err(|error| error.to_string())
    }

    #[test]
    fn every_row_goes_with_every_other() {
        let found = names(
            "[grid]\ncondition = [\"smooth\", \"rough\"]\ntrial.step = [3, 5]\n[list]\narm.lengths = [[1, 2], [0.5, 3]]\nworld.step = [1, 0.1]\n",
        );
        let expected = [
            "condition=smooth,trial.step=3,lengths=1.0_2.0,world.step=1.0",
            "condition=smooth,trial.step=3,lengths=0.5_3.0,world.step=0.1",
            "condition=smooth,trial.step=5,lengths=1.0_2.0,world.step=1.0",
            "condition=smooth,trial.step=5,lengths=0.5_3.0,world.step=0.1",
            "condition=rough,trial.step=3,lengths=1.0_2.0,world.step=1.0",
            "condition=rough,trial.step=3,lengths=0.5_3.0,world.step=0.1",
            "condition=rough,trial.step=5,lengths=1.0_2.0,world.step=1.0",
            "condition=rough,trial.step=5,lengths=0.5_3.0,world.step=0.1",
        ];
        assert_eq!(found.unwrap(), expected);
    }

    #[test]
    fn a_point_has_its_own_values_and_those_of_all() {
        let text = "experiment = \"toy\"\nseed = [8, 3]\nworld.map = \"m\"\n[grid]\ncondition = [\"rough\", \"smooth\"]\ntrial.step = [3, 5]\n";
        let file = SweepFile::parse("my.toml", text).unwrap();
        let laboratory = Laboratory::new(&[&TOY]);
        let points = Points::new(&file, &laboratory).unwrap();
        let plan = points.plan(2).unwrap();
        assert_eq!((plan.condition.as_str(), plan.seed, plan.name().as_str()), ("smooth", 8, "toy-smooth-8"));
        assert_eq!((plan.settings.whole("trial.step").unwrap(), plan.settings.text("world.map").unwrap()), (3, "m"));
        let error = points.located(2, Error::setting("trial.step", "is odd"));
        assert_eq!(error.to_string(), "my.toml line 6: `trial.step`: is odd");
        let error = points.located(2, Error::setting("world.map", "is lost"));
        assert_eq!(error.to_string(), "my.toml: point 3 (condition=smooth,step=3): `world.map`: is lost");
    }

    #[test]
    fn names_are_of_files_and_differ() {
        let found = names("[grid]\nworld.map = [\"a/b c\", \"a_b_c\", \"..\", \"a\\nb\", \"é\"]\n").unwrap();
        assert_eq!(found[1..3], ["map=a_b_c".to_owned(), "map=..".to_owned()]);
        for name in &found {
            assert!(name.starts_with("map=") && name.bytes().all(|b| b.is_ascii_graphic() && b != b'/'), "{name}");
        }
        assert!(found[0].starts_with("map=a_b_c-") && found[3].starts_with("map=a_b-"), "{found:?}");
        let long = "x".repeat(400);
        let found = names(&format!("[grid]\nworld.map = [\"{long}\", \"{long}y\"]\n")).unwrap();
        assert!(found[0] != found[1] && found.iter().all(|name| name.len() == MAX_NAME_BYTES + 9), "{found:?}");
    }

    #[test]
    fn mistakes_are_found_with_their_line() {
        let many = (1..=101).map(|step| step.to_string()).collect::<Vec<_>>().join(", ");
        for (text, message) in [
            (
                "[grid]\ntrial.stpe = [1]\n".to_owned(),
                "my.toml line 3: unknown key `trial.stpe`; the nearest is `trial.step`",
            ),
            ("[grid]\ntrial.step = [1,\n0]\n".into(), "my.toml line 4: `trial.step`: 0 is outside 1 to 1000000"),
            (
                "[grid]\ntrial.step = [1]\n[wrld]\n".into(),
                "my.toml line 4: unknown section `wrld`; the nearest is `world`",
            ),
            (
                "[grid]\ncondition = [\"smoth\"]\n".into(),
                "my.toml line 3: unknown condition `smoth`; the nearest is `smooth`",
            ),
            ("[grid]\nworld.step = [1, 2, 1.0]\n".into(), "my.toml line 3: point 3 is point 1 again: step=1.0"),
            (
                format!("[grid]\ntrial.step = [{many}]\nworld.step = [{many}]\n"),
                "my.toml: more than 10000 points: 101 x 101",
            ),
            (
                format!("replications = 10000\n[grid]\ntrial.step = [{many}]\n"),
                "my.toml: more than 100000 runs: 101 points of 10000",
            ),
        ] {
            assert_eq!(names(&text).unwrap_err(), message);
        }
    }
}
