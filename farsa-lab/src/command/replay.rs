//! `farsa replay`: trials of a run, or of a protocol's cases; and `farsa live`.

use std::io::{self, Write};

use serde::Serialize;

use crate::command::arguments::subcommands::{LiveArgs, ReplayArgs};
use crate::command::cli::say;
use crate::command::invocation::Invocation;
use crate::error::Error;
use crate::escaped::escaped;
use crate::evaluation::replayed::Replayed;
use crate::evaluation::{protocols, replay};
use crate::json::pretty;
use crate::live::page;
use crate::run::world_choice;
use crate::store::bounded;
use crate::store::replace::create_result;

/// The most bytes of a module.
const MOST_MODULE: u64 = 100_000_000;
/// What begins a file that is compressed by gzip.
const GZIP: [u8; 2] = [0x1f, 0x8b];

impl Invocation<'_, '_> {
    pub(super) fn replay(&self, args: &ReplayArgs) -> Result<(), Error> {
        let (directory, mut plan) = self.existing(&args.directory)?;
        world_choice::visit(&mut plan, args.world.name.as_deref())?;
        let other = args.compare.as_deref().map(|path| self.existing(path)).transpose()?;
        let other = other.as_ref().map(|(directory, plan)| (plan, directory));
        let (which, lesion) = (args.which.which(), args.lesion.as_deref());
        let out = || -> Result<Box<dyn Write>, Error> {
            match &args.out {
                Some(path) => Ok(Box::new(create_result(path)?)),
                None => Ok(Box::new(io::stdout().lock())),
            }
        };
        match (args.choice()?, &args.html) {
            (None, None) => self.replayed(args, replay::replay(&plan, &directory, which, lesion, out)?),
            (None, Some(path)) => self.replayed(args, replay::page(&plan, &directory, which, lesion, other, path)?),
            (Some(choice), None) => self.replayed(args, protocols::replay::replay(&plan, &directory, choice, out)?),
            (Some(choice), Some(path)) => {
                self.replayed(args, protocols::replay::page(&plan, &directory, choice, other, path)?)
            }
        }
    }

    /// Writes a page that runs an agent by itself.
    pub(super) fn live(&self, args: &LiveArgs) -> Result<(), Error> {
        let (directory, plan) = self.existing(&args.directory)?;
        let given = args.module.as_deref().map(|path| bounded::read(path, MOST_MODULE)).transpose()?;
        let module = given
            .as_deref()
            .or_else(|| self.laboratory.live_module())
            .ok_or_else(|| Error::Usage("this program has no module for pages: give one with --module".into()))?;
        if !module.starts_with(&GZIP) {
            return Err(Error::Usage("the module is not compressed by gzip".into()));
        }
        let generations = &args.generations;
        let found = page::page(self.laboratory, (&plan, &directory), generations, module, &args.html)?;
        self.summary(args.json, &format!("{}\n", found.summary), &|| pretty(&found))
    }

    /// Says what a replay came to, beside the steps.
    fn replayed<S: Serialize>(&self, args: &ReplayArgs, mut found: Replayed<S>) -> Result<(), Error> {
        found.file = args.html.as_ref().or(args.out.as_ref()).map(|path| path.display().to_string());
        if args.json {
            let summary = pretty(&found)?;
            // The standard output is free only when the steps went elsewhere.
            if found.file.is_some() {
                return say(&summary);
            }
            let _ = write!(io::stderr(), "{summary}");
        } else if !self.quiet {
            let _ = writeln!(io::stderr(), "{}", escaped(&found.summary));
        }
        Ok(())
    }
}
