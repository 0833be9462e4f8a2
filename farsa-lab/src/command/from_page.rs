//! `farsa run --from`: the run of a page as a run of the command.

use std::path::{Path, PathBuf};

use crate::command::arguments::subcommands::RunArgs;
use crate::command::champion_test::Tests;
use crate::command::interrupt::stop_on_signals;
use crate::command::invocation::Invocation;
use crate::error::Error;
use crate::experiment::settings::Value;
use crate::live::run_state::StateMark;
use crate::live::saved_run::SavedRun;
use crate::run::config_file::ConfigFile;
use crate::run::plan::Plan;
use crate::run::records::Checkpoint;
use crate::run::summary::Summary;
use crate::run::{begin, evolve};
use crate::store::directory::Directory;
use crate::strategy::settings::GENERATIONS;

impl<'e> Invocation<'e, '_> {
    /// Evolves the generations of a page in a new directory, compares the state after them with the page's, and continues for
    /// `--generations` in all.
    ///
    /// # Errors
    /// [`Error::Usage`] for another state, whose run is kept, for fewer generations than the page has, and the errors of a run.
    pub(super) fn run_from_page(&self, file: &Path, args: &RunArgs) -> Result<(Summary, Plan<'e>), Error> {
        let SavedRun { config, mark } = SavedRun::read(file)?;
        let place = file.display().to_string();
        let mut plan = Plan::from_file(self.laboratory, &ConfigFile::parse(&place, &config)?)?;
        let whole = |generations: u32| Value::Whole(i64::from(generations));
        if let Some(generations) = args.generations {
            plan.set("--generations", GENERATIONS, Value::Whole(generations))?;
            if plan.generations()? < mark.generation {
                return Err(Error::Usage(format!("{place}: has finished {} generations already", mark.generation)));
            }
        } else if mark.generation > 0 {
            plan.set(&place, GENERATIONS, whole(mark.generation))?;
        }
        let pool = self.pool(args, &plan)?;
        self.warn(&plan.evaluator()?.info().warnings);
        let path = args.out.clone().unwrap_or_else(|| PathBuf::from("runs").join(plan.name()));
        self.make_room(args.force, &plan, &path)?;
        let directory = begin::create(&plan, &path)?;
        let evolved = |plan: &Plan<'e>, pool| {
            evolve::continue_run(plan, &directory, pool, stop_on_signals(), self.program, self.quiet)
        };
        let mut summary = if mark.generation == 0 {
            evolved(&plan, pool)?
        } else {
            let mut repeated = plan.clone();
            repeated.set(&place, GENERATIONS, whole(mark.generation))?;
            let summary = evolved(&repeated, pool)?;
            let found = state_of(&repeated, &directory)?;
            if found != Some(mark) {
                return Err(Error::Usage(format!(
                    "{place}: the state after generation {} differs from this program's, whose run is in {}",
                    mark.generation - 1,
                    path.display()
                )));
            }
            if plan.generations()? > mark.generation { evolved(&plan, self.pool(args, &plan)?)? } else { summary }
        };
        self.test_run(&mut summary, Tests::of_champions(args.test), &args.workers)?;
        Ok((summary, plan))
    }
}

/// Identifies the state of a run.
fn state_of(plan: &Plan<'_>, directory: &Directory) -> Result<Option<StateMark>, Error> {
    let Checkpoint { generation, state, .. } = Checkpoint::read(plan, directory)?;
    Ok(state.map(|state| StateMark::new(generation, &state)))
}
