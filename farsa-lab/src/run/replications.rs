//! `farsa run --replications`: one plan under consecutive seeds, each in its own directory.

use std::fmt::Write as _;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use serde::Serialize;

use crate::error::Error;
use crate::escaped::OneLine;
use crate::figures::significant::significant;
use crate::figures::statistics::{Quartiles, median};
use crate::run::plan::{MAX_SEED, Plan};
use crate::run::pool::Pool;
use crate::run::queue::{Member, Queue, State};
use crate::run::summary::{ChampionTest, Summary};
use crate::run::text_table::text_table;

/// Selected replications of a plan.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Selection {
    /// Number of replications, at least one. The first has the seed of the plan, and each next one the next seed.
    pub(crate) count: u32,
    /// Number of a single selected replication, from 1.
    pub(crate) only: Option<u32>,
}

/// Results of the replications that this process found finished or has finished, in the order of their seeds.
#[derive(Debug, Serialize)]
pub(crate) struct Replications {
    #[serde(rename = "replications")]
    runs: Vec<Replication>,
    /// Median fitness of the champions.
    median: Option<f64>,
    /// Directories claimed by other processes.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    elsewhere: Vec<String>,
}

#[derive(Debug, Serialize)]
struct Replication {
    #[serde(flatten)]
    summary: Summary,
    /// True if all generations were finished before this process began.
    skipped: bool,
}

impl Selection {
    /// Lists the seeds with the numbers of their replications.
    ///
    /// # Errors
    /// [`Error::Usage`] for a number above the count, and for seeds above the largest.
    pub(crate) fn seeds(self, first: u64) -> Result<Vec<(u32, u64)>, Error> {
        let Self { count, only } = self;
        if first.checked_add(u64::from(count) - 1).is_none_or(|last| last > MAX_SEED) {
            return Err(Error::Usage(format!(
                "{count} replications from seed {first}: the largest seed is {MAX_SEED}"
            )));
        }
        let numbers = match only {
            None => 1..=count,
            Some(number) if number <= count => number..=number,
            Some(number) => return Err(Error::Usage(format!("--replication {number}: there are {count}"))),
        };
        Ok(numbers.map(|number| (number, first + u64::from(number - 1))).collect())
    }
}

/// Evolves the unclaimed replications of a plan one after the other, each in `root`/NAME.
///
/// An existing directory of the same run is continued, or skipped if it is finished. All directories are checked before the first
/// run starts.
///
/// # Errors
/// The errors of [`Selection::seeds`], [`Queue::check`] and [`Queue::work`].
pub(crate) fn run<'e>(
    plan: &Plan<'e>,
    which: Selection,
    root: &Path,
    pool: &dyn Fn(&Plan<'e>) -> Result<Pool<'e>, Error>,
    stop: impl FnOnce() -> &'static AtomicBool,
    program: &str,
    quiet: bool,
) -> Result<Replications, Error> {
    let seeds = which.seeds(plan.seed)?;
    // A refused run leaves no directory behind.
    drop(pool(plan)?);
    let member = |index: usize| {
        let (number, seed) = seeds[index];
        let mut plan = plan.clone();
        plan.seed = seed;
        let path = root.join(plan.name());
        Ok(Member { plan, path, name: format!("replication {number} of {}", which.count) })
    };
    let queue = Queue { count: seeds.len(), member: &member, pool, after: &|_| Ok(()), program, quiet };
    let left = queue.check()?;
    let states = queue.work(&left, stop())?;
    queue.tell_of_others(&states);
    let (mut runs, mut elsewhere) = (Vec::new(), Vec::new());
    for state in states {
        match state {
            State::Finished { summary, skipped } => runs.push(Replication { summary: *summary, skipped }),
            State::Elsewhere(path) => elsewhere.push(path.display().to_string()),
        }
    }
    let fitness = runs.iter().filter_map(|run: &Replication| run.summary.fitness()).collect::<Vec<_>>();
    Ok(Replications { median: median(&fitness), runs, elsewhere })
}

impl Replications {
    /// Iterates over the summaries of the runs.
    pub(crate) fn summaries(&mut self) -> impl Iterator<Item = &mut Summary> {
        self.runs.iter_mut().map(|run| &mut run.summary)
    }

    /// Formats a table with a line for each replication and the statistics of their champions.
    pub(crate) fn text(&self) -> String {
        let failed = self.runs.iter().any(|run| run.summary.failed > 0);
        let tested = self.runs.iter().any(|run| run.summary.test.is_some());
        let broken_down = self.runs.iter().any(|run| run.summary.test.is_some_and(|test| test.broken_down > 0));
        let mut head = vec!["directory", "seed", "generations", "champion", "fitness"];
        head.extend(failed.then_some("failed"));
        head.extend(["test success", "test fitness"].iter().filter(|_| tested));
        head.extend(broken_down.then_some("broken down"));
        let mut rows = vec![head.into_iter().map(str::to_owned).collect::<Vec<_>>()];
        rows.extend(self.runs.iter().map(|Replication { summary, .. }| {
            let Summary { directory, seed, generations, champion, .. } = summary;
            let individual = champion.as_ref().map(|champion| champion.individual.to_string()).unwrap_or_default();
            let fitness = summary.fitness().map_or_else(|| "–".into(), significant);
            let mut row =
                vec![OneLine(directory.display()).to_string(), seed.to_string(), generations.to_string(), individual];
            row.push(fitness);
            row.extend(failed.then(|| summary.failed.to_string()));
            row.extend(ChampionTest::cells(summary.test.as_ref()).into_iter().filter(|_| tested));
            let failures = summary.test.map_or_else(|| "–".into(), |test| test.broken_down.to_string());
            row.extend(broken_down.then_some(failures));
            row
        }));
        let mut text = text_table(&rows, 1..9);
        let fitness: Vec<f64> = self.runs.iter().filter_map(|run| run.summary.fitness()).collect();
        if let Some(Quartiles { lower, median, upper }) = Quartiles::from_values(&fitness) {
            // Writing into a string cannot fail.
            let [lower, median, upper] = [lower, median, upper].map(significant);
            let _ = writeln!(text, "champions' fitness: median {median}, quartiles {lower} and {upper}");
        }
        if fitness.len() < self.runs.len() {
            let (without, all) = (self.runs.len() - fitness.len(), self.runs.len());
            let _ = writeln!(text, "champions without a fitness: {without} of {all}");
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_names_the_seed_that_all_would_give_it() {
        let seeds = |count, only, first| Selection { count, only }.seeds(first);
        let all = seeds(4, None, 7).unwrap();
        assert_eq!(all, [(1, 7), (2, 8), (3, 9), (4, 10)]);
        for number in 1..=4 {
            assert_eq!(seeds(4, Some(number), 7).unwrap(), [all[number as usize - 1]]);
        }
        assert_eq!(seeds(4, Some(5), 7).unwrap_err().to_string(), "--replication 5: there are 4");
        assert_eq!(seeds(2, None, MAX_SEED - 1).unwrap().len(), 2);
        // The seeds are refused even if that of the selected replication exists.
        for first in [MAX_SEED, u64::MAX] {
            assert!(seeds(2, Some(1), first).unwrap_err().to_string().contains("the largest seed is"));
        }
    }
}
