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
use crate::shell::resume_command;
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
        if let Some(file) = plan.experiment.files(&plan.condition, &plan.settings)?.first() {
            return Err(Error::Usage(format!("{place}: a page reads no files, and the run needs {}", file.display())));
        }
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
        let last = plan.generations()?;
        let evolved = |plan: &Plan<'e>, pool| {
            let summary = evolve::continue_run(plan, &directory, pool, stop_on_signals(), self.program, self.quiet);
            summary.map_err(|error| match error {
                Error::Interrupted { .. } => {
                    let resume = resume_command(self.program, directory.path());
                    Error::Interrupted { resume: format!("{resume} --generations {last}") }
                }
                error => error,
            })
        };
        let mut repeated = None;
        if mark.generation > 0 {
            let mut until = plan.clone();
            until.set(&place, GENERATIONS, whole(mark.generation))?;
            repeated = Some(evolved(&until, pool)?);
        }
        if state_of(&plan, &directory)? != Some(mark) {
            return Err(Error::Usage(format!(
                "{place}: the state after {} generations differs from this program's, whose run is in {}",
                mark.generation,
                path.display()
            )));
        }
        let mut summary = match repeated {
            Some(summary) if last == mark.generation => summary,
            _ => evolved(&plan, self.pool(args, &plan)?)?,
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
