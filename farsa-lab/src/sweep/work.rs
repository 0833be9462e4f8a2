//! `farsa sweep`: the runs of all points, by any number of processes.

use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use serde::Serialize;

use crate::error::Error;
use crate::experiment::outcome::NO_CRITERION;
use crate::figures::significant::{percent, significant};
use crate::figures::statistics::{Quartiles, median};
use crate::run::laboratory::Laboratory;
use crate::run::plan::Plan;
use crate::run::pool::Pool;
use crate::run::queue::{Member, Queue, State, Work};
use crate::run::summary::{ChampionTest, Summary};
use crate::run::text_table::text_table;
use crate::sweep::points::Points;
use crate::sweep::sweep_file::SweepFile;

/// A sweep over a laboratory, with the folder of its runs.
pub(crate) struct Sweep<'s, 'e> {
    points: Points<'s, 'e>,
    seeds: &'s [u64],
    root: &'s Path,
    /// Last requested point. Its runs follow each other.
    latest: RefCell<Option<(usize, Plan<'e>)>>,
}

/// Selected runs, counted from 0. All runs are selected by default.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Selection {
    pub(crate) point: Option<usize>,
    pub(crate) replication: Option<usize>,
}

/// Results of the points.
#[derive(Debug, Serialize)]
pub(crate) struct Found {
    points: Vec<Point>,
}

#[derive(Debug, Serialize)]
struct Point {
    /// Number of the point, from 1, as in `--point`.
    #[serde(rename = "point")]
    number: usize,
    directory: String,
    /// Number of runs of the point.
    replications: usize,
    /// Number of finished runs.
    runs: Vec<Summary>,
    /// Median fitness of the champions.
    median: Option<f64>,
    /// Directories claimed by other processes.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    elsewhere: Vec<String>,
}

impl<'s, 'e> Sweep<'s, 'e> {
    /// Checks every value of every point.
    ///
    /// # Errors
    /// The errors of [`Points::new`].
    pub(crate) fn new(file: &'s SweepFile, laboratory: &'s Laboratory<'e>, root: &'s Path) -> Result<Self, Error> {
        let points = Points::new(file, laboratory)?;
        Ok(Self { points, seeds: &file.seeds, root, latest: RefCell::new(None) })
    }

    /// Returns the point and the seed of each selected run, point by point.
    ///
    /// # Errors
    /// [`Error::Usage`] for a number above the last.
    fn wanted(&self, which: Selection) -> Result<Vec<(usize, usize)>, Error> {
        let range = |option: &str, only: Option<usize>, count: usize| match only {
            None => Ok(0..count),
            Some(number) if number < count => Ok(number..number + 1),
            Some(number) => Err(Error::Usage(format!("{option} {}: there are {count}", number + 1))),
        };
        let points = range("--point", which.point, self.points.count())?;
        let seeds = range("--replication", which.replication, self.seeds.len())?;
        Ok(points.flat_map(|point| seeds.clone().map(move |seed| (point, seed))).collect())
    }

    fn directory(&self, point: usize) -> PathBuf {
        self.root.join(self.points.name(point))
    }

    fn member(&self, (point, seed): (usize, usize)) -> Result<Member<'e>, Error> {
        let mut latest = self.latest.borrow_mut();
        let mut plan = match &*latest {
            Some((known, plan)) if *known == point => plan.clone(),
            _ => latest.insert((point, self.points.plan(point)?)).1.clone(),
        };
        plan.seed = self.seeds[seed];
        let path = self.directory(point).join(plan.name());
        let place = format!("point {} of {}", point + 1, self.points.count());
        let name = match self.seeds.len() {
            seeds if self.points.count() == 1 => format!("replication {} of {seeds}", seed + 1),
            1 => place,
            seeds => format!("{place}, replication {} of {seeds}", seed + 1),
        };
        Ok(Member { plan, path, name })
    }

    /// Checks that every selected point can begin, without its directories.
    ///
    /// # Errors
    /// The errors of [`work`](Self::work) about the selection and its points.
    pub(crate) fn ready(&self, which: Selection, ready: &dyn Fn(&Plan<'e>) -> Result<(), Error>) -> Result<(), Error> {
        self.check(&self.wanted(which)?, ready)
    }

    /// Checks that every point of some runs can begin.
    fn check(&self, runs: &[(usize, usize)], pool: &dyn Fn(&Plan<'e>) -> Result<(), Error>) -> Result<(), Error> {
        let mut points: Vec<usize> = runs.iter().map(|(point, _)| *point).collect();
        points.dedup();
        points.into_iter().try_for_each(|point| {
            let plan = self.points.plan(point)?;
            let ready = pool(&plan).and_then(|()| plan.strategy().map(drop));
            ready.map_err(|error| self.points.located(point, error))
        })
    }

    /// Returns the directories of the selected runs.
    ///
    /// # Errors
    /// The errors of [`work`](Self::work) about the selection.
    pub(crate) fn directories(&self, which: Selection) -> Result<Vec<PathBuf>, Error> {
        self.wanted(which)?.into_iter().map(|run| Ok(self.member(run)?.path)).collect()
    }

    /// Evolves the selected and unclaimed runs one after the other, and calls `after` with the summary of each.
    ///
    /// An existing directory of the same run is continued, or skipped if it is finished. All points and directories are checked
    /// before the first run starts.
    ///
    /// # Errors
    /// [`Error::Usage`] for a number above the last, the errors of a point that cannot begin, and those of [`Queue::check`] and
    /// [`Queue::work`].
    pub(crate) fn work(
        &self,
        which: Selection,
        ready: &dyn Fn(&Plan<'e>) -> Result<(), Error>,
        pool: &dyn Fn(&Plan<'e>) -> Result<Pool<'e>, Error>,
        after: &dyn Fn(&mut Summary) -> Result<(), Error>,
        stop: impl FnOnce() -> &'static AtomicBool,
        (program, quiet): (&str, bool),
    ) -> Result<Found, Error> {
        let runs = self.wanted(which)?;
        self.check(&runs, ready)?;
        let member = |index: usize| self.member(runs[index]);
        let queue = Queue { count: runs.len(), member: &member, pool, after, program, quiet };
        let left = queue.check()?;
        let states = queue.work(&left, stop())?;
        queue.tell_of_others(&states);
        Ok(self.found(&runs, states.into_iter().map(Some)))
    }

    /// Returns the existing results of the selected runs.
    ///
    /// # Errors
    /// The errors of [`work`](Self::work) before its first evaluation.
    pub(crate) fn list(
        &self,
        which: Selection,
        ready: &dyn Fn(&Plan<'e>) -> Result<(), Error>,
    ) -> Result<Found, Error> {
        let runs = self.wanted(which)?;
        self.check(&runs, ready)?;
        let states = runs.iter().map(|run| {
            let Member { plan, path, .. } = self.member(*run)?;
            Ok(match Work::of_run(&plan, &path)? {
                Work::Done(summary) => Some(State::Finished { summary, skipped: true }),
                Work::Left { .. } => None,
            })
        });
        let states: Vec<Option<State>> = states.collect::<Result<_, Error>>()?;
        Ok(self.found(&runs, states.into_iter()))
    }

    fn found(&self, runs: &[(usize, usize)], states: impl Iterator<Item = Option<State>>) -> Found {
        let mut points: Vec<Point> = Vec::new();
        for (&(point, _), state) in runs.iter().zip(states) {
            if points.last().is_none_or(|last| last.number != point + 1) {
                points.push(Point {
                    number: point + 1,
                    directory: self.directory(point).display().to_string(),
                    replications: 0,
                    runs: Vec::new(),
                    median: None,
                    elsewhere: Vec::new(),
                });
            }
            let Some(last) = points.last_mut() else { continue };
            last.replications += 1;
            match state {
                Some(State::Finished { summary, .. }) => last.runs.push(*summary),
                Some(State::Elsewhere(path)) => last.elsewhere.push(path.display().to_string()),
                None => {}
            }
        }
        for point in &mut points {
            point.median = median(&point.fitness());
        }
        Found { points }
    }
}

impl Point {
    fn fitness(&self) -> Vec<f64> {
        self.runs.iter().filter_map(Summary::fitness).collect()
    }

    /// Iterates over the tests of its champions.
    fn tests(&self) -> impl Iterator<Item = ChampionTest> {
        self.runs.iter().filter_map(|run| run.test)
    }

    /// Formats the median share of success in the tests of its champions.
    fn success(&self) -> String {
        if self.tests().any(|test| !test.has_criterion) {
            return NO_CRITERION.into();
        }
        let shares: Vec<f64> = self.tests().filter_map(|test| test.success).collect();
        percent(median(&shares).unwrap_or(f64::NAN))
    }

    /// Counts the trials that broke down in the tests of its champions.
    fn broken_down(&self) -> usize {
        self.tests().map(|test| test.broken_down).sum()
    }

    /// Counts its finished runs without a fitness, and those whose tested trials all broke down.
    fn without_value(&self) -> usize {
        let is_missing =
            |run: &&Summary| run.fitness().is_none() || run.test.is_some_and(|test| test.fitness.is_none());
        self.runs.iter().filter(is_missing).count()
    }

    /// Counts the failed evaluations of its finished runs.
    fn failed(&self) -> u64 {
        self.runs.iter().map(|run| run.failed).sum()
    }
}

impl Found {
    /// Iterates over the directories of the finished runs.
    pub(crate) fn directories(&self) -> impl Iterator<Item = &Path> {
        self.points.iter().flat_map(|point| &point.runs).map(|run| run.directory.as_path())
    }

    /// Iterates over the summaries of the runs.
    pub(crate) fn summaries(&mut self) -> impl Iterator<Item = &mut Summary> {
        self.points.iter_mut().flat_map(|point| &mut point.runs)
    }

    /// Formats a table with a line for each point.
    pub(crate) fn text(&self) -> String {
        let some = self.points.iter().any(|point| point.failed() > 0);
        let tested = self.points.iter().flat_map(|point| &point.runs).any(|run| run.test.is_some());
        let [broken_down, missing] =
            [Point::broken_down, Point::without_value].map(|count| self.points.iter().any(|point| count(point) > 0));
        let mut head = vec!["point", "finished", "median fitness", "quartiles"];
        head.extend(some.then_some("failed"));
        head.extend(tested.then_some("median success"));
        head.extend(broken_down.then_some("broken down"));
        head.extend(missing.then_some("without value"));
        head.push("directory");
        let mut rows = vec![head.into_iter().map(str::to_owned).collect::<Vec<_>>()];
        rows.extend(self.points.iter().map(|point| {
            let [middle, quartiles] = match Quartiles::from_values(&point.fitness()) {
                None => ["–".to_owned(), "–".to_owned()],
                Some(Quartiles { lower, median, upper }) => {
                    [significant(median), format!("{} to {}", significant(lower), significant(upper))]
                }
            };
            let finished = format!("{} of {}", point.runs.len(), point.replications);
            let mut row = vec![point.number.to_string(), finished, middle, quartiles];
            row.extend(some.then(|| point.failed().to_string()));
            row.extend(tested.then(|| point.success()));
            row.extend(broken_down.then(|| point.broken_down().to_string()));
            row.extend(missing.then(|| point.without_value().to_string()));
            row.push(point.directory.clone());
            row
        }));
        text_table(&rows, 0..3)
    }
}
