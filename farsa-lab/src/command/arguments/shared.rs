//! Arguments that several subcommands share.

use std::ops::RangeInclusive;
use std::thread;

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser as _};

use crate::error::Error;
use crate::experiment::lanes::{LaneRequest, SIMD};
use crate::experiment::settings::Value;
use crate::run::config_file;
use crate::run::experiment::Experiment;
use crate::run::plan::Plan;
use crate::run::pool::Pool;

/// Returns a parser of whole numbers within a range.
pub(crate) fn whole<T: Copy + Into<i128> + TryFrom<i128>>(
    range: RangeInclusive<T>,
) -> impl Fn(&str) -> Result<T, String> + Clone {
    let (low, high): (i128, i128) = ((*range.start()).into(), (*range.end()).into());
    move |text: &str| {
        let number = text.parse::<i128>().ok().filter(|number| (low..=high).contains(number));
        let number = number.and_then(|number| T::try_from(number).ok());
        number.ok_or_else(|| format!("not a whole number from {low} to {high}"))
    }
}

/// The condition and settings of an experiment.
#[derive(Args)]
pub(crate) struct VariantArgs {
    /// A condition of the experiment [default: the first]
    #[arg(long, value_name = "NAME")]
    pub(crate) condition: Option<String>,
    /// Change a setting, repeatable
    #[arg(long, value_name = "KEY=VALUE", value_parser = config_file::assignment)]
    pub(crate) set: Vec<(String, Value)>,
}

impl VariantArgs {
    /// Returns the plan of an experiment under this condition with these settings.
    ///
    /// # Errors
    /// [`Error::Setting`].
    pub(crate) fn plan<'e>(&self, experiment: &'e dyn Experiment) -> Result<Plan<'e>, Error> {
        let mut plan = Plan::new(experiment, self.condition.as_deref(), "")?;
        self.apply(&mut plan)?;
        Ok(plan)
    }

    /// Changes the settings of a plan.
    ///
    /// # Errors
    /// [`Error::Setting`].
    pub(crate) fn apply(&self, plan: &mut Plan<'_>) -> Result<(), Error> {
        self.set.iter().try_for_each(|(key, value)| plan.set("--set", key, value.clone()))
    }
}

/// The threads and lanes of an evaluation.
#[derive(Args)]
pub(crate) struct WorkerArgs {
    #[command(flatten)]
    threads: Threads,
    #[command(flatten)]
    lanes: LanesArgs,
}

impl WorkerArgs {
    /// Creates a pool of threads.
    ///
    /// # Errors
    /// Errors of [`Pool::new`].
    pub(crate) fn pool<'e>(&self, plan: &Plan<'e>) -> Result<Pool<'e>, Error> {
        Pool::new(plan, self.threads(), self.lanes())
    }

    /// Checks that a plan can be evaluated, with one thread to save time.
    ///
    /// # Errors
    /// Errors of [`Pool::new`].
    pub(crate) fn check(&self, plan: &Plan<'_>) -> Result<(), Error> {
        Pool::new(plan, 1, self.lanes()).map(drop)
    }

    /// Creates a pool for one of several processes, by default with its part of the processors.
    ///
    /// # Errors
    /// Errors of [`Pool::new`].
    pub(crate) fn pool_shared<'e>(&self, plan: &Plan<'e>, sharing: usize) -> Result<Pool<'e>, Error> {
        let threads = self.threads.threads.map_or_else(|| self.threads() / sharing.max(1), usize::from);
        Pool::new(plan, threads, self.lanes())
    }

    pub(crate) fn threads(&self) -> usize {
        self.threads.count()
    }

    pub(crate) fn lanes(&self) -> LaneRequest {
        self.lanes.wanted()
    }
}

#[derive(Args)]
struct Threads {
    /// Threads (results do not depend on their number) [default: all processors]
    #[arg(long, value_name = "T", value_parser = whole(1_u16..=4096))]
    threads: Option<u16>,
}

impl Threads {
    fn count(&self) -> usize {
        self.threads.map_or_else(|| thread::available_parallelism().map_or(1, usize::from), usize::from)
    }
}

/// The world of the trials.
#[derive(Args)]
pub(crate) struct WorldArgs {
    /// The world, where the experiment has several (world.engine): articulated, arena or rapier [default: the run's]
    #[arg(long = "world", value_name = "NAME")]
    pub(crate) name: Option<String>,
}

/// Arguments that contradict the configuration of a saved page.
pub(crate) const FIXED_BY_PAGE: [&str; 12] = [
    "experiment",
    "condition",
    "set",
    "strategy",
    "seed",
    "population",
    "name",
    "config",
    "resume",
    "replications",
    "replication",
    "groups",
];

/// Parallel trials.
#[derive(Args)]
struct LanesArgs {
    /// Parallel trials per thread (results do not depend on them)
    #[arg(long, value_name = "L", default_value = "auto", value_parser = PossibleValuesParser::new(["1", "8", "16", "auto"]))]
    lanes: String,
    /// Instructions of parallel trials (results do not depend on them)
    #[arg(long, value_name = "SET", default_value = "auto", value_parser = simd())]
    simd: Simd,
}

#[derive(Clone, Copy)]
struct Simd(Option<&'static str>);

/// Parses the name of an instruction set, `None` for `auto`.
fn simd() -> impl clap::builder::TypedValueParser<Value = Simd> {
    let known = |name: String| Simd(SIMD.into_iter().find(|known| *known == name));
    PossibleValuesParser::new(SIMD.into_iter().chain(["auto"])).map(known)
}

impl LanesArgs {
    fn wanted(&self) -> LaneRequest {
        LaneRequest { count: self.lanes.parse().ok(), simd: self.simd.0 }
    }
}
