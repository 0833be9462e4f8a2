//! Command on several ranks, of which rank 0 executes it.

use std::path::PathBuf;
use std::rc::Rc;

use crate::command::arguments::subcommands::{Command, RunArgs};
use crate::command::interrupt::stop_on_signals;
use crate::command::invocation::Invocation;
use crate::error::Error;
use crate::ranks::exchange::{Exchange, WorkerCommand};
use crate::ranks::facts::Facts;
use crate::run::coordinator;
use crate::run::plan::Plan;
use crate::run::replications::Replications;
use crate::run::worker::Worker;

/// Role of a rank.
pub(crate) enum Part {
    /// The rank executes the command, and the others wait for its orders.
    Leads,
    /// The rank has followed to the end, with this exit code.
    Followed(u8),
}

/// True if the other ranks wait for orders.
pub(crate) fn awaits_orders(command: &Command) -> bool {
    matches!(command, Command::Run(RunArgs { groups: None, .. }))
}

impl Invocation<'_, '_> {
    /// Checks that all ranks have the same command, and follows rank 0 on all others.
    ///
    /// # Errors
    /// [`Error::Rank`] for the first rank that has another command or cannot start. The others then end, too.
    pub(crate) fn take_part(&self, command: &Command) -> Result<Part, Error> {
        if self.exchange.is_alone() {
            return Ok(Part::Leads);
        }
        self.exchange.begin(self.facts(command))?;
        match command {
            _ if !self.exchange.is_follower() => Ok(Part::Leads),
            // Each group has its coordinator.
            Command::Run(RunArgs { groups: Some(_), .. }) => Ok(Part::Leads),
            Command::Run(args) => self.follow(args).map(Part::Followed),
            _ => Ok(Part::Followed(0)),
        }
    }

    /// Returns the arguments that must be equal on all ranks. Threads and lanes may differ.
    fn facts(&self, command: &Command) -> Result<Facts, Error> {
        let Command::Run(args) = command else { return Ok(vec![("command".into(), "another than run".into())]) };
        let mut facts = argument_facts(args);
        let (_, plan) = self.planned_from_file(args)?;
        self.pool(args, &plan)?;
        facts.extend(coordinator::facts(&plan)?);
        Ok(facts)
    }

    /// Follows rank 0 through its runs, and returns its exit code.
    fn follow(&self, args: &RunArgs) -> Result<u8, Error> {
        let worker = Worker {
            plan: &|file| Plan::from_file(self.laboratory, file),
            pool: &|plan| self.pool(args, plan),
            stop: stop_on_signals(),
        };
        worker.follow(&self.exchange)
    }

    /// Ends the other ranks.
    ///
    /// # Errors
    /// Errors of sending messages.
    pub(crate) fn dismiss(&self, code: u8) -> Result<(), Error> {
        if self.exchange.is_alone() { Ok(()) } else { self.exchange.command(Some(&WorkerCommand::End(code))).map(drop) }
    }

    /// Makes replications in parallel groups of ranks, in turn. Returns `None` on ranks without a summary.
    ///
    /// # Errors
    /// [`Error::Usage`] for more groups than ranks, and on rank 0 the first error of a group. Other groups continue.
    pub(crate) fn replicate_in_groups(
        &self,
        args: &RunArgs,
        count: u32,
        groups: u32,
    ) -> Result<Option<Replications>, Error> {
        let ranks = self.exchange.ranks();
        let (rank, size, groups) = (ranks.rank(), ranks.size(), groups as usize);
        if groups > size {
            let ranks = if size == 1 { "is 1 rank" } else { "are too few ranks" };
            return Err(Error::Usage(format!("--groups {groups}: there {ranks}")));
        }
        let group = rank * groups / size;
        let members = ranks.split(group)?;
        let part = Invocation {
            program: self.program,
            laboratory: self.laboratory,
            quiet: self.quiet || group > 0,
            exchange: Rc::new(Exchange::new(&*members)),
            sharing: self.sharing,
        };
        let result = if part.exchange.is_follower() {
            part.follow(args).map(drop)
        } else {
            let result = (group as u32 + 1..=count)
                .step_by(groups)
                .try_for_each(|number| part.replicate(args, count, Some(number)).map(drop));
            let code = result.as_ref().map_or_else(Error::exit_code, |()| 0);
            let dismissed = part.dismiss(code);
            result.and(dismissed)
        };
        self.exchange.begin(result.map(|()| Facts::new()))?;
        if rank > 0 {
            return Ok(None);
        }
        // All runs are finished, so this only reads their results.
        let reader = Invocation { quiet: true, exchange: Rc::default(), ..part };
        reader.replicate(args, count, None).map(Some)
    }
}

/// Returns the arguments that select runs and their directories.
fn argument_facts(args: &RunArgs) -> Facts {
    let none = || "none".to_owned();
    let number = |number: Option<u32>| number.map_or_else(none, |number| number.to_string());
    let path = |path: &Option<PathBuf>| path.as_ref().map_or_else(none, |path| path.display().to_string());
    let facts = [
        ("command", "run".into()),
        ("--replications", number(args.replications)),
        ("--replication", number(args.replication)),
        ("--groups", number(args.groups)),
        ("--out", path(&args.out)),
        ("--resume", path(&args.resume)),
        ("--force", args.force.to_string()),
    ];
    facts.map(|(name, value)| (name.to_owned(), value)).into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    use crate::ranks::facts;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        run: RunArgs,
    }

    #[test]
    fn ranks_with_other_directories_are_refused() {
        let of = |line: &str| argument_facts(&Line::try_parse_from(line.split(' ')).unwrap().run);
        let own = of("run cart --out a");
        facts::same(&[own.clone(), of("run cart --out a --threads 2")]).unwrap();
        for (other, message) in [
            ("run cart --out b", "rank 1: `--out` is b there and a on rank 0"),
            ("run cart", "rank 1: `--out` is none there and a on rank 0"),
            ("run cart --out a --force", "rank 1: `--force` is true there and false on rank 0"),
            ("run --resume a", "rank 1: `--out` is none there and a on rank 0"),
        ] {
            assert_eq!(facts::same(&[own.clone(), of(other)]).unwrap_err().to_string(), message);
        }
    }
}
