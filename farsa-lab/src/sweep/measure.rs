//! Measures of a check: one number with an interval from several runs.

use crate::error::Error;
use crate::evaluation::test::{self, TEST_SEED};
use crate::evaluation::test_table::Table;
use crate::experiment::evaluator::TaskInfo;
use crate::experiment::outcome::NO_CRITERION;
use crate::figures::bootstrap::mean_interval;
use crate::figures::order_interval::order_interval;
use crate::figures::proportion::Proportion;
use crate::figures::significant::significant;
use crate::figures::statistics::median;
use crate::run::config_file::Entry;
use crate::run::plan::Plan;
use crate::run::record_file::RunRecord;
use crate::run::records::Checkpoint;
use crate::store::directory::Directory;
use crate::store::log::Line;
use crate::sweep::sweep_file::wrong;

const MEASURES: [&str; 4] = ["trials", "runs", "mean", "median"];
/// Columns of a run's fitness, and the beginning of the columns of its test.
const COLUMNS: [&str; 5] = ["fitness.best", "fitness.mean", "fitness.worst", "fitness.evaluations", "test.fitness"];
const TEST: &str = "test.";

/// Keys of a measure, as they are in a file.
#[derive(Default)]
pub(super) struct MeasureKeys {
    pub(super) measure: Option<Entry<String>>,
    pub(super) column: Option<Entry<String>>,
    pub(super) least: Option<Entry<f64>>,
}

/// A number computed from several runs.
#[derive(Debug, PartialEq)]
pub(crate) struct Measure {
    statistic: Statistic,
    /// Place of the measure or of its column in a file.
    place: String,
}

#[derive(Debug, PartialEq)]
enum Statistic {
    /// Share of the test trials of all champions that succeed.
    Trials,
    /// Share of the runs with at least this share of successful trials, or with at least this mean of a column.
    Runs { column: Option<Column>, least: f64 },
    /// Mean of a column: over the means of several runs, or over the trials of a single one.
    Mean(Column),
    /// Median of a column, as the mean.
    Median(Column),
}

#[derive(Debug, PartialEq)]
enum Column {
    /// Column of the test of the champion.
    Test(String),
    /// Best (0), mean (1) or worst (2) fitness of the last generation.
    Fitness(usize),
    /// Evaluations up to the first generation whose best fitness is at least this, or infinity.
    Evaluations { least: f64 },
}

/// Values of one run.
#[derive(Debug, PartialEq)]
pub(crate) enum Sample {
    Successes(Proportion),
    /// Values of all trials, or one value. Not empty.
    Values(Vec<f64>),
}

/// A number with its 95 % interval, if it has one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Estimate {
    pub(crate) value: f64,
    pub(crate) interval: Option<[f64; 2]>,
}

impl MeasureKeys {
    /// Builds the measure of a check at `place`.
    ///
    /// # Errors
    /// [`Error::Setting`] with the key.
    pub(super) fn measure(self, place: &str, has_test: bool) -> Result<Measure, Error> {
        let lacks = |key: &str, why: &str| wrong(&Entry { value: key.to_owned(), place: place.to_owned() }, why);
        let Self { measure, column, least } = self;
        let Some(Entry { value: name, place: at }) = measure else {
            return Err(lacks("measure", "is missing in this table [[checks]]"));
        };
        let is_evaluations = column.as_ref().is_some_and(|column| column.value == COLUMNS[3]);
        let surplus = match (name.as_str(), &column, &least) {
            ("trials", Some(Entry { place, .. }), _) => Some(("column", place)),
            ("trials", _, Some(Entry { place, .. })) => Some(("least", place)),
            ("mean" | "median", _, Some(Entry { place, .. })) if !is_evaluations => Some(("least", place)),
            _ => None,
        };
        if let Some((key, place)) = surplus {
            let key = Entry { value: key.to_owned(), place: place.clone() };
            return Err(wrong(&key, &format!("is not a part of the measure `{name}`")));
        }
        let place = column.as_ref().map_or_else(|| at.clone(), |column| column.place.clone());
        let least = |why: &str| least.map(|least| least.value).ok_or_else(|| lacks("least", why));
        let statistic = match name.as_str() {
            "trials" => Statistic::Trials,
            "runs" if is_evaluations => {
                let key = Entry { value: "column".to_owned(), place };
                return Err(wrong(&key, "is not a part of the measure `runs`: use `mean` or `median`"));
            }
            "runs" => {
                let column = column.map(|column| Column::new(&column, 0.0)).transpose()?;
                Statistic::Runs { column, least: least("is missing: the least value of a run that counts")? }
            }
            "mean" | "median" => {
                let column = column.ok_or_else(|| lacks("column", "is missing: the values of the measure"))?;
                let reached = if is_evaluations { least("is missing: the fitness to reach")? } else { 0.0 };
                let column = Column::new(&column, reached)?;
                if name == "mean" { Statistic::Mean(column) } else { Statistic::Median(column) }
            }
            _ => return Err(Error::unknown(&at, "measure", &name, MEASURES)),
        };
        let measure = Measure { statistic, place };
        if measure.is_of_test() && !has_test {
            return Err(lacks("test.trials", "is missing: the measure is one of tests"));
        }
        Ok(measure)
    }
}

impl Column {
    fn new(name: &Entry<String>, least: f64) -> Result<Self, Error> {
        if let Some(column) = name.value.strip_prefix(TEST).filter(|column| !column.is_empty()) {
            return Ok(Self::Test(column.into()));
        }
        match COLUMNS.iter().position(|column| *column == name.value) {
            Some(number @ 0..3) => Ok(Self::Fitness(number)),
            Some(3) => Ok(Self::Evaluations { least }),
            _ => Err(Error::unknown(&name.place, "column", &name.value, COLUMNS)),
        }
    }

    fn text(&self) -> String {
        match self {
            Self::Test(column) => format!("{TEST}{column}"),
            Self::Fitness(number) => COLUMNS[*number].into(),
            Self::Evaluations { least } => format!("evaluations to fitness {}", significant(*least)),
        }
    }
}

impl Measure {
    /// Formats the measure.
    pub(crate) fn text(&self) -> String {
        match &self.statistic {
            Statistic::Trials => "successful trials".into(),
            Statistic::Runs { column: None, least } => format!("runs with success >= {}", significant(*least)),
            Statistic::Runs { column: Some(column), least } => {
                format!("runs with {} >= {}", column.text(), significant(*least))
            }
            Statistic::Mean(column) => format!("mean {}", column.text()),
            Statistic::Median(column) => format!("median {}", column.text()),
        }
    }

    fn column(&self) -> Option<&Column> {
        match &self.statistic {
            Statistic::Trials => None,
            Statistic::Runs { column, .. } => column.as_ref(),
            Statistic::Mean(column) | Statistic::Median(column) => Some(column),
        }
    }

    /// Checks if the measure needs the tests of the champions.
    fn is_of_test(&self) -> bool {
        matches!(self.column(), None | Some(Column::Test(_)))
    }

    /// Checks that an experiment has a criterion of success where the measure counts successes.
    ///
    /// # Errors
    /// [`Error::Setting`].
    pub(crate) fn check(&self, info: &TaskInfo) -> Result<(), Error> {
        if self.column().is_some() || info.has_success {
            return Ok(());
        }
        let key = Entry { value: "measure".to_owned(), place: self.place.clone() };
        Err(wrong(&key, &format!("counts successes, and the experiment has {NO_CRITERION}")))
    }

    /// Reads the values of a finished run, or `None` without the test that is needed.
    ///
    /// # Errors
    /// The errors of reading a run, and [`Error::Setting`] for an unknown column.
    pub(crate) fn sample(
        &self,
        plan: &Plan<'_>,
        directory: &Directory,
        trials: Option<u32>,
    ) -> Result<Option<Sample>, Error> {
        if !self.is_of_test() {
            let checkpoint = Checkpoint::read(plan, directory)?;
            let lines = RunRecord::read(plan, directory, &checkpoint)?.lines;
            return Ok(self.fitness(&lines).map(|value| Sample::Values(vec![value])));
        }
        let Some(trials) = trials else { return Ok(None) };
        if test::repeated(plan, directory, trials as usize, TEST_SEED)?.is_none() {
            return Ok(None);
        }
        test::read(directory)?.map(|(table, _)| self.tested(&table)).transpose()
    }

    /// Computes the value of a run's log, `None` for an empty one.
    fn fitness(&self, lines: &[Line]) -> Option<f64> {
        match self.column()? {
            Column::Test(_) => None,
            Column::Fitness(number) => lines.last().map(|line| line.row[*number]),
            Column::Evaluations { least } => {
                let first = lines.iter().position(|line| line.row[0] >= *least);
                let evaluations = |first| lines[..=first].iter().map(|line| line.evaluations as f64).sum();
                Some(first.map_or(f64::INFINITY, evaluations))
            }
        }
    }

    /// Returns the values of a test.
    fn tested(&self, table: &Table) -> Result<Sample, Error> {
        let Some(Column::Test(name)) = self.column() else {
            let trials = table.trials();
            let successes = trials.iter().filter(|trial| trial.success).count();
            return Ok(Sample::Successes(Proportion { successes, of: trials.len() }));
        };
        let values = table.numbers(name).ok_or_else(|| {
            let columns: Vec<String> = table.names().map(|column| format!("{TEST}{column}")).collect();
            let columns = columns.iter().map(String::as_str);
            Error::unknown(&self.place, "column", &format!("{TEST}{name}"), columns)
        })?;
        if values.is_empty() {
            let key = Entry { value: format!("{TEST}{name}"), place: self.place.clone() };
            return Err(wrong(&key, "has no number in the test"));
        }
        Ok(Sample::Values(values))
    }

    /// Computes the number of some runs with its interval: Wilson's for shares, between order statistics for a median, and the
    /// bootstrap's for a mean.
    pub(crate) fn estimate(&self, samples: &[Sample]) -> Option<Estimate> {
        if samples.is_empty() {
            return None;
        }
        match &self.statistic {
            Statistic::Trials => {
                let sum = |[successes, of]: [usize; 2], sample: &Sample| match sample {
                    Sample::Successes(trials) => [successes + trials.successes, of + trials.of],
                    Sample::Values(_) => [successes, of],
                };
                let [successes, of] = samples.iter().fold([0, 0], sum);
                Some(share(Proportion { successes, of }))
            }
            Statistic::Runs { least, .. } => {
                let successes = samples.iter().filter(|sample| sample.mean() >= *least).count();
                Some(share(Proportion { successes, of: samples.len() }))
            }
            Statistic::Mean(_) => {
                let values = units(samples);
                let interval = if values.iter().all(|x| x.is_finite()) { mean_interval(&values) } else { None };
                Some(Estimate { value: mean(&values), interval })
            }
            Statistic::Median(_) => {
                let values = units(samples);
                Some(Estimate { value: median(&values)?, interval: order_interval(&values) })
            }
        }
    }
}

impl Sample {
    /// Computes the share of successes or the mean.
    fn mean(&self) -> f64 {
        match self {
            Self::Successes(Proportion { successes, of }) => *successes as f64 / *of as f64,
            Self::Values(values) => mean(values),
        }
    }
}

/// Returns the values that count as independent: one of each run, or all of a single run.
fn units(samples: &[Sample]) -> Vec<f64> {
    match samples {
        [Sample::Values(values)] => values.clone(),
        several => several.iter().map(Sample::mean).collect(),
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn share(proportion: Proportion) -> Estimate {
    let value = proportion.successes as f64 / proportion.of.max(1) as f64;
    Estimate { value, interval: Some(proportion.interval()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measure(name: &str, column: Option<&str>, least: Option<f64>) -> Measure {
        let entry = |value: &str| Entry { value: value.to_owned(), place: "my.toml line 4".to_owned() };
        let least = least.map(|value| Entry { value, place: String::new() });
        let keys = MeasureKeys { measure: Some(entry(name)), column: column.map(entry), least };
        keys.measure("my.toml line 1", true).unwrap()
    }

    fn successes(counts: &[(usize, usize)]) -> Vec<Sample> {
        counts.iter().map(|&(successes, of)| Sample::Successes(Proportion { successes, of })).collect()
    }

    fn table() -> Table {
        let text = "index,trial,steps,success,fitness,height,end\n0,0,6,true,1.5,0.25,time\n1,1,6,false,NaN,,fall\n\
                    2,0,4,true,0.5,0.75,time\n";
        let lines = text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect();
        Table::from_lines(lines, 2).unwrap()
    }

    #[test]
    fn shares_have_the_intervals_of_all_trials_and_of_runs() {
        let samples = successes(&[(3, 10), (10, 10), (5, 10)]);
        let found = measure("trials", None, None).estimate(&samples).unwrap();
        assert_eq!(found, Estimate { value: 0.6, interval: Some(Proportion { successes: 18, of: 30 }.interval()) });
        let found = measure("runs", None, Some(0.5)).estimate(&samples).unwrap();
        assert_eq!(found, Estimate { value: 2.0 / 3.0, interval: Some(Proportion { successes: 2, of: 3 }.interval()) });
        assert_eq!(measure("trials", None, None).estimate(&[]), None);
    }

    #[test]
    fn several_runs_count_by_their_means_and_one_by_its_trials() {
        let values = |rows: &[&[f64]]| rows.iter().map(|row| Sample::Values(row.to_vec())).collect::<Vec<_>>();
        let one = values(&[&[1.0, 3.0, 3.0, 5.0, 4.0, 2.0]]);
        let found = measure("median", Some("test.height"), None).estimate(&one).unwrap();
        assert_eq!(found, Estimate { value: 3.0, interval: Some([1.0, 5.0]) });
        let several = values(&[&[1.0, 3.0], &[4.0, 6.0]]);
        let found = measure("mean", Some("test.height"), None).estimate(&several).unwrap();
        assert_eq!(found, Estimate { value: 3.5, interval: Some([2.0, 5.0]) });
        let found = measure("median", Some("test.height"), None).estimate(&several).unwrap();
        assert_eq!(found, Estimate { value: 3.5, interval: None });
        let found = measure("runs", Some("test.height"), Some(5.0)).estimate(&several).unwrap();
        assert_eq!(found.value, 0.5);
        let unsolved = values(&[&[1.0], &[f64::INFINITY]]);
        let found = measure("mean", Some("fitness.evaluations"), Some(2.0)).estimate(&unsolved).unwrap();
        assert_eq!(found, Estimate { value: f64::INFINITY, interval: None });
    }

    #[test]
    fn columns_are_those_of_the_test_and_of_the_log() {
        let found = measure("mean", Some("test.height"), None).tested(&table()).unwrap();
        assert_eq!(found, Sample::Values(vec![0.25, 0.75]));
        let found = measure("trials", None, None).tested(&table()).unwrap();
        assert_eq!(found, Sample::Successes(Proportion { successes: 2, of: 3 }));
        let error = measure("mean", Some("test.hight"), None).tested(&table()).unwrap_err();
        let why = "my.toml line 4: unknown column `test.hight`; the nearest is `test.height`";
        assert_eq!(error.to_string(), why);
        let error = measure("mean", Some("test.end"), None).tested(&table()).unwrap_err();
        assert_eq!(error.to_string(), "my.toml line 4: `test.end`: has no number in the test");

        let line =
            |best: f64, evaluations| Line { row: [best, best - 1.0, 0.0], each: Vec::new(), evaluations, failed: 0 };
        let lines = [line(1.0, 10), line(4.0, 12), line(3.0, 14)];
        for (column, least, value) in [
            ("fitness.best", None, 3.0),
            ("fitness.mean", None, 2.0),
            ("fitness.worst", None, 0.0),
            ("fitness.evaluations", Some(1.0), 10.0),
            ("fitness.evaluations", Some(3.5), 22.0),
            ("fitness.evaluations", Some(4.5), f64::INFINITY),
        ] {
            assert_eq!(measure("mean", Some(column), least).fitness(&lines), Some(value), "{column} {least:?}");
        }
        assert_eq!(measure("mean", Some("fitness.best"), None).fitness(&[]), None);
    }
}
