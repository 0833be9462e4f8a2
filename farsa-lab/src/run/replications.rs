//! `farsa run --replications`: one plan under one seed after the other, each in a directory of its own.

use std::fmt::Write as _;
use std::io::{self, Write as _};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use serde::Serialize;

use crate::error::Error;
use crate::escaped::{OneLine, escaped};
use crate::figures::statistics::{Quartiles, median};
use crate::run::begin;
use crate::run::evolve;
use crate::run::plan::{LARGEST_SEED, Plan};
use crate::run::pool::Pool;
use crate::run::records::{Champions, Checkpoint};
use crate::run::summary::{Summary, Winner};
use crate::store::directory::{Directory, vacant};

/// What came of all replications, in the order of their seeds.
#[derive(Debug, Serialize)]
pub(crate) struct Replications {
    replications: Vec<Replication>,
    /// Of the champions' fitness.
    median: Option<f64>,
}

#[derive(Debug, Serialize)]
struct Replication {
    #[serde(flatten)]
    summary: Summary,
    /// Whether all was done before.
    skipped: bool,
}

/// Evolves `count` runs of a plan, with its seed and those that follow, in `root`/NAME each.
///
/// A run that is there and the same is gone on with, and skipped once it is finished; before anything is started it is
/// made sure that every place has such a run or none.
///
/// # Errors
/// [`Error::Interrupted`] after the flag of `stop` became true, and what [`run::go_on`] says about the run that failed.
/// The runs before it are kept, those after it not begun.
pub(crate) fn run<'e>(
    mut plan: Plan<'e>,
    count: u32,
    root: &Path,
    pool: &dyn Fn(&Plan<'e>) -> Result<Pool<'e>, Error>,
    stop: impl FnOnce() -> &'static AtomicBool,
    program: &str,
    quiet: bool,
) -> Result<Replications, Error> {
    let first = plan.seed;
    let Some(last) = first.checked_add(u64::from(count) - 1).filter(|last| *last <= LARGEST_SEED) else {
        return Err(Error::Usage(format!(
            "{count} replications from seed {first}: the largest seed is {LARGEST_SEED}"
        )));
    };
    // What is refused leaves no directory behind.
    drop(pool(&plan)?);
    for seed in first..=last {
        plan.seed = seed;
        finished(&plan, &root.join(plan.name()))?;
    }
    let tell = |line: String| {
        if !quiet {
            // A user who closed the error stream does not want to know.
            let _ = writeln!(io::stderr(), "{}", escaped(&line));
        }
    };
    let stop = stop();
    let interrupted = || Error::Interrupted { resume: again(program) };
    let mut replications = Vec::new();
    for (number, seed) in (1..=count).zip(first..=last) {
        plan.seed = seed;
        let path = root.join(plan.name());
        let place = OneLine(path.display());
        let which = format!("replication {number} of {count}");
        // Asked again: another process may have been at it meanwhile.
        if let Some(summary) = finished(&plan, &path)? {
            tell(format!("{which}: {place}: all {} generations are finished already", summary.generations));
            replications.push(Replication { summary, skipped: true });
            continue;
        }
        if stop.load(Ordering::Relaxed) {
            return Err(interrupted());
        }
        let directory = if path.join("config.toml").is_file() {
            tell(format!("{which}: {place}: goes on"));
            Directory::open(&path)?
        } else {
            tell(format!("{which}: {place}"));
            begin::create(&plan, &path)?
        };
        let summary =
            evolve::go_on(&plan, &directory, pool(&plan)?, stop, program, quiet).map_err(|error| match error {
                Error::Interrupted { .. } => interrupted(),
                error => error,
            })?;
        tell(summary.text());
        replications.push(Replication { summary, skipped: false });
    }
    let fitness = replications.iter().filter_map(Replication::fitness).collect::<Vec<_>>();
    Ok(Replications { median: median(&fitness), replications })
}

/// What came of the run at a place if it has all its generations; none if it is to be begun or gone on with.
///
/// # Errors
/// [`Error::Occupied`] by other files, [`Error::OtherConfiguration`] by another run, [`Error::Usage`] by one that has more
/// generations already, and whatever keeps the run from being gone on with.
fn finished(plan: &Plan<'_>, path: &Path) -> Result<Option<Summary>, Error> {
    let Ok(directory) = Directory::open(path) else { return vacant(path).map(|()| None) };
    let file = directory.checkpoint();
    let Checkpoint { identity, generation: done, .. } = Checkpoint::read(plan, &directory)?;
    identity.same_values(&plan.identity()?, &file)?;
    let asked = plan.generations()?;
    if done < asked {
        return Ok(None);
    }
    if done > asked {
        return Err(Error::Usage(format!("{}: has finished {done} generations already", path.display())));
    }
    let champions = Winner::from_champions(&Champions::read(plan, &directory)?);
    Ok(Some(Summary {
        directory: path.display().to_string(),
        experiment: identity.experiment,
        condition: identity.condition,
        seed: identity.seed,
        generations: done,
        evaluations: 0,
        seconds: 0.0,
        champion: champions.first().cloned(),
        champions: if champions.len() > 1 { champions } else { Vec::new() },
    }))
}

/// The command line of this process, to be repeated.
fn again(program: &str) -> String {
    let arguments = std::env::args_os().skip(1).map(|word| quoted(&word.to_string_lossy()));
    std::iter::once(quoted(program)).chain(arguments).collect::<Vec<_>>().join(" ")
}

/// A word as a shell takes it, left as it is wherever that will do.
fn quoted(word: &str) -> String {
    let plain = |letter: char| letter.is_ascii_alphanumeric() || "-_./=,:+@%".contains(letter);
    if !word.is_empty() && word.chars().all(plain) {
        return word.into();
    }
    // Only a word with a zero byte cannot be quoted, and no process is started with one.
    shlex::try_quote(word).map_or_else(|_| word.into(), std::borrow::Cow::into_owned)
}

impl Replication {
    fn fitness(&self) -> Option<f64> {
        self.summary.champion.as_ref().map(|champion| champion.fitness)
    }
}

impl Replications {
    /// A table with a line per replication, and what their champions say together.
    pub(crate) fn text(&self) -> String {
        let mut rows = vec![["directory", "seed", "generations", "champion", "fitness"].map(str::to_owned)];
        rows.extend(self.replications.iter().map(|Replication { summary, .. }| {
            let Summary { directory, seed, generations, champion, .. } = summary;
            let [individual, fitness] = champion.as_ref().map_or_else(Default::default, |champion| {
                [champion.individual.to_string(), format!("{:?}", champion.fitness)]
            });
            [OneLine(directory).to_string(), seed.to_string(), generations.to_string(), individual, fitness]
        }));
        let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
        let widths = [0, 1, 2, 3, 4].map(width);
        let mut text = String::new();
        for [directory, seed, generations, individual, fitness] in &rows {
            let [a, b, c, d, _] = widths;
            // Writing into a string cannot fail. Numbers of many lengths are easiest compared from their first figure.
            let _ = writeln!(text, "{directory:<a$}  {seed:>b$}  {generations:>c$}  {individual:>d$}  {fitness}");
        }
        let fitness = self.replications.iter().filter_map(Replication::fitness).collect::<Vec<_>>();
        if let Some(Quartiles { lower, median, upper }) = Quartiles::from_values(&fitness) {
            let _ = writeln!(text, "champions' fitness: median {median:.2}, quartiles {lower:.2} and {upper:.2}");
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_a_shell_would_change_is_quoted() {
        let words = ["run", "--set", "cart.friction=0.5", "my runs", "it's", "", "a*b"];
        let line = words.map(quoted).join(" ");
        assert!(line.starts_with("run --set cart.friction=0.5 "), "{line}");
        assert_eq!(shlex::split(&line).unwrap(), words);
    }
}
