//! `farsa replay`: trials of a run, or of a protocol's cases.

use std::io::{self, IsTerminal as _, Write};

use serde::Serialize;

use crate::command::arguments::subcommands::ReplayArgs;
use crate::command::cli::say;
use crate::command::invocation::Invocation;
use crate::error::Error;
use crate::escaped::escaped;
use crate::evaluation::replayed::Replayed;
use crate::evaluation::trial_changes::TrialChanges;
use crate::evaluation::{protocols, replay};
use crate::json::pretty;
use crate::run::world_choice;
use crate::store::replace::create_result;

impl Invocation<'_, '_> {
    pub(super) fn replay(&self, args: &ReplayArgs) -> Result<(), Error> {
        let (directory, mut plan) = self.existing(&args.directory)?;
        world_choice::visit(&mut plan, args.world.name.as_deref())?;
        let other = args.compare.as_deref().map(|path| self.existing(path)).transpose()?;
        let other = other.as_ref().map(|(directory, plan)| (plan, directory));
        let which = args.which.which();
        let changes = TrialChanges::read(args.lesion.as_deref(), args.changes.as_deref())?;
        let changes = changes.as_ref();
        let out = || -> Result<Box<dyn Write>, Error> {
            match &args.out {
                Some(path) => Ok(Box::new(create_result(path)?)),
                // Thousands of lines would hide the summary.
                None if io::stdout().is_terminal() => Ok(Box::new(io::sink())),
                None => Ok(Box::new(io::stdout().lock())),
            }
        };
        match (args.choice()?, &args.html) {
            (None, None) => self.replayed(args, replay::replay(&plan, &directory, which, changes, out)?),
            (None, Some(path)) => self.replayed(args, replay::page(&plan, &directory, which, changes, other, path)?),
            (Some(choice), None) => self.replayed(args, protocols::replay::replay(&plan, &directory, choice, out)?),
            (Some(choice), Some(path)) => {
                self.replayed(args, protocols::replay::page(&plan, &directory, choice, other, path)?)
            }
        }
    }

    /// Prints the summary of a replay.
    fn replayed<S: Serialize>(&self, args: &ReplayArgs, mut found: Replayed<S>) -> Result<(), Error> {
        found.file = args.html.as_ref().or(args.out.as_ref()).map(|path| path.display().to_string());
        if args.json {
            let summary = pretty(&found)?;
            // Standard output is free only if the steps are written to a file.
            if found.file.is_some() {
                return say(&summary);
            }
            let _ = write!(io::stderr(), "{summary}");
        } else if !self.quiet {
            let _ = writeln!(io::stderr(), "{}", escaped(&found.summary));
            if found.file.is_none() && io::stdout().is_terminal() {
                let _ = writeln!(io::stderr(), "for the steps add --out FILE, --html FILE, or `| less`");
            }
        }
        Ok(())
    }
}
