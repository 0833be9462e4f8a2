//! `farsa replay`: trials of a run, or of a protocol's cases.

use std::io::{self, Write as _};

use crate::command::arguments::subcommands::ReplayArgs;
use crate::command::cli::say;
use crate::command::invocation::Invocation;
use crate::error::Error;
use crate::escaped::escaped;
use crate::evaluation::protocols::chosen::Choice;
use crate::evaluation::{protocols, replay};
use crate::json::pretty;
use crate::run::plan::Plan;
use crate::run::world_choice;
use crate::store::directory::Directory;
use crate::store::replace::create_result;

impl Invocation<'_, '_> {
    pub(super) fn replay(&self, args: &ReplayArgs) -> Result<(), Error> {
        let (directory, mut plan) = self.existing(&args.directory)?;
        world_choice::visit(&mut plan, args.world.name.as_deref())?;
        if let Some(choice) = args.choice()? {
            return self.replay_cases(args, &plan, &directory, choice);
        }
        let which = args.which.which();
        let mut found = match (&args.html, &args.out) {
            (Some(path), _) => {
                let other = args.compare.as_deref().map(|path| self.existing(path)).transpose()?;
                let other = other.as_ref().map(|(directory, plan)| (plan, directory));
                replay::page(&plan, &directory, which, other, path)?
            }
            (None, Some(path)) => replay::replay(&plan, &directory, which, &mut create_result(path)?)?,
            (None, None) => replay::replay(&plan, &directory, which, &mut io::stdout().lock())?,
        };
        found.file = args.file();
        self.replayed(args, &found.summary, &|| pretty(&found))
    }

    /// Trials of a protocol's cases.
    fn replay_cases(
        &self,
        args: &ReplayArgs,
        plan: &Plan<'_>,
        directory: &Directory,
        choice: Choice<'_>,
    ) -> Result<(), Error> {
        let mut found = match (&args.html, &args.out) {
            (Some(path), _) => {
                let other = args.compare.as_deref().map(|path| self.existing(path)).transpose()?;
                let other = other.as_ref().map(|(directory, plan)| (plan, directory));
                protocols::replay::page(plan, directory, choice, other, path)?
            }
            (None, Some(path)) => {
                protocols::replay::replay(plan, directory, choice, || Ok(Box::new(create_result(path)?)))?
            }
            (None, None) => protocols::replay::replay(plan, directory, choice, || Ok(Box::new(io::stdout().lock())))?,
        };
        found.file = args.file();
        self.replayed(args, &found.summary, &|| pretty(&found))
    }

    /// Says what a replay came to, beside the steps.
    fn replayed(&self, args: &ReplayArgs, summary: &str, all: &dyn Fn() -> Result<String, Error>) -> Result<(), Error> {
        if args.json {
            // The standard output is free only when the steps went elsewhere.
            if args.file().is_some() {
                return say(&all()?);
            }
            let _ = write!(io::stderr(), "{}", all()?);
        } else if !self.quiet {
            let _ = writeln!(io::stderr(), "{}", escaped(summary));
        }
        Ok(())
    }
}
