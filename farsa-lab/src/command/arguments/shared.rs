//! The words of the command line that several commands share.

use std::thread;

use clap::builder::{PossibleValuesParser, TypedValueParser as _};
use clap::{Args, value_parser};

use crate::error::Error;
use crate::experiment::definition::Experiment;
use crate::experiment::lanes::{SIMD, Wanted};
use crate::experiment::settings::Value;
use crate::run::config_file;
use crate::run::plan::Plan;
use crate::run::pool::Pool;

/// What of an experiment is meant.
#[derive(Args)]
pub(crate) struct VariantArgs {
    /// One of its conditions [default: its first]
    #[arg(long, value_name = "NAME")]
    pub(crate) condition: Option<String>,
    /// Change a setting; may be repeated
    #[arg(long, value_name = "KEY=VALUE", value_parser = config_file::assignment)]
    pub(crate) set: Vec<(String, Value)>,
}

impl VariantArgs {
    /// An experiment under this condition with these settings.
    ///
    /// # Errors
    /// [`Error::Unknown`] and [`Error::Setting`].
    pub(crate) fn plan<'e>(&self, experiment: &'e dyn Experiment) -> Result<Plan<'e>, Error> {
        let mut plan = Plan::new(experiment, self.condition.as_deref(), "")?;
        self.apply(&mut plan)?;
        Ok(plan)
    }

    /// Changes the settings of a plan.
    ///
    /// # Errors
    /// [`Error::Unknown`] and [`Error::Setting`].
    pub(crate) fn apply(&self, plan: &mut Plan<'_>) -> Result<(), Error> {
        self.set.iter().try_for_each(|(key, value)| plan.settings.set("--set", key, value.clone()))
    }
}

/// What evaluates the trials.
#[derive(Args)]
pub(crate) struct WorkerArgs {
    #[command(flatten)]
    threads: Threads,
    #[command(flatten)]
    lanes: LanesArgs,
}

impl WorkerArgs {
    /// Threads with a set-up each.
    ///
    /// # Errors
    /// Those of [`Pool::new`].
    pub(crate) fn pool<'e>(&self, plan: &Plan<'e>) -> Result<Pool<'e>, Error> {
        Pool::new(plan, self.threads(), self.lanes())
    }

    /// Whether a plan can be evaluated so; with one thread, which is made sooner than all.
    ///
    /// # Errors
    /// Those of [`Pool::new`].
    pub(crate) fn check(&self, plan: &Plan<'_>) -> Result<(), Error> {
        Pool::new(plan, 1, self.lanes()).map(drop)
    }

    /// The same where processes share the processors: without a number of threads, each takes its part of them.
    ///
    /// # Errors
    /// Those of [`Pool::new`].
    pub(crate) fn pool_shared<'e>(&self, plan: &Plan<'e>, sharing: usize) -> Result<Pool<'e>, Error> {
        let threads = self.threads.threads.map_or_else(|| self.threads() / sharing.max(1), usize::from);
        Pool::new(plan, threads, self.lanes())
    }

    pub(crate) fn threads(&self) -> usize {
        self.threads.count()
    }

    pub(crate) fn lanes(&self) -> Wanted {
        self.lanes.wanted()
    }
}

#[derive(Args)]
struct Threads {
    /// Threads to use [default: all processors]; the results are the same with any number
    #[arg(long, value_name = "T", value_parser = value_parser!(u16).range(1..=4096))]
    threads: Option<u16>,
}

impl Threads {
    fn count(&self) -> usize {
        self.threads.map_or_else(|| thread::available_parallelism().map_or(1, usize::from), usize::from)
    }
}

/// In which world.
#[derive(Args)]
pub(crate) struct WorldArgs {
    /// The world to run in, where the experiment has a choice (world.engine): articulated or arena, or rapier if built with
    /// it [default: the run's own]
    #[arg(long = "world", value_name = "NAME")]
    pub(crate) name: Option<String>,
}

/// How many trials at once.
#[derive(Args)]
struct LanesArgs {
    /// Trials side by side in each thread; the results are the same with any number
    #[arg(long, value_name = "L", default_value = "auto", value_parser = PossibleValuesParser::new(["1", "8", "16", "auto"]))]
    lanes: String,
    /// Instructions for trials side by side; the results are the same with any
    #[arg(long, value_name = "SET", default_value = "auto", value_parser = simd())]
    simd: Simd,
}

#[derive(Clone, Copy)]
struct Simd(Option<&'static str>);

/// The name of an instruction set, or none for `auto`.
fn simd() -> impl clap::builder::TypedValueParser<Value = Simd> {
    let known = |name: String| Simd(SIMD.into_iter().find(|known| *known == name));
    PossibleValuesParser::new(SIMD.into_iter().chain(["auto"])).map(known)
}

impl LanesArgs {
    fn wanted(&self) -> Wanted {
        Wanted { count: self.lanes.parse().ok(), simd: self.simd.0 }
    }
}
