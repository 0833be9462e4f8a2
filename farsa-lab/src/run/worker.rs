//! Ranks except the first: they evaluate the same search and write no files.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use farsa_evo::RecordWriter;

use crate::error::Error;
use crate::ranks::exchange::{Exchange, Status, WorkerCommand};
use crate::run::begin::search_state;
use crate::run::catch_panic::catch_panic;
use crate::run::config_file::ConfigFile;
use crate::run::coordinator::{barrier, facts, shut_down};
use crate::run::evaluation_backend::Unfinished;
use crate::run::plan::Plan;
use crate::run::pool::Pool;
use crate::run::record_file::RunRecord;
use crate::run::records::Checkpoint;
use crate::run::search_state::SearchState;
use crate::store::checksummed;
use crate::store::directory::Directory;

/// Functions with which a worker prepares a run.
pub(crate) struct Worker<'f, 'e> {
    /// Returns the plan of a configuration.
    pub(crate) plan: &'f dyn Fn(&ConfigFile) -> Result<Plan<'e>, Error>,
    /// Prepares the threads of this rank.
    pub(crate) pool: &'f dyn Fn(&Plan<'e>) -> Result<Pool<'e>, Error>,
    pub(crate) stop: &'f AtomicBool,
}

impl Worker<'_, '_> {
    /// Runs the commands of rank 0 until one of them ends the program, and returns the exit code. Rank 0 reports errors.
    ///
    /// # Errors
    /// An error when ranks are lost.
    pub(crate) fn follow(&self, exchange: &Exchange<'_>) -> Result<u8, Error> {
        loop {
            match exchange.command(None)? {
                WorkerCommand::End(code) => return Ok(code),
                WorkerCommand::Run { directory, config, checkpoint, record } => {
                    let prepared = catch_panic(|| self.prepare(directory.as_ref(), &config, &checkpoint, record));
                    match prepared.unwrap_or_else(|why| Err(Error::Other(format!("panicked: {why}")))) {
                        Err(error) => drop(exchange.begin(Err(error))),
                        Ok((plan, pool, search_state, record)) => {
                            if exchange.begin(facts(&plan)).is_ok() {
                                self.run(pool, search_state, record)?;
                            }
                        }
                    }
                }
            }
        }
    }

    /// Restores a run from its checkpoint.
    fn prepare(
        &self,
        directory: &Path,
        config: &str,
        checkpoint: &[u8],
        record: Vec<u8>,
    ) -> Result<(Plan<'_>, Pool<'_>, SearchState, RecordWriter), Error> {
        let directory = Directory::at(directory.into());
        let plan = (self.plan)(&ConfigFile::parse(&directory.config().display().to_string(), config)?)?;
        let pool = (self.pool)(&plan)?;
        let checkpoint: Checkpoint =
            checksummed::open(checkpoint).map_err(|why| Error::damaged(&directory.checkpoint(), why))?;
        let run_record = RunRecord::from_content(&plan, &directory, &checkpoint, record)?;
        let search_state = search_state(&plan, &directory, &checkpoint, &run_record, pool.genotype())?;
        Ok((plan, pool, search_state, run_record.record.writer()))
    }

    /// Evaluates generations until rank 0 ends the run or a rank has an error.
    fn run(&self, mut pool: Pool<'_>, mut search_state: SearchState, mut record: RecordWriter) -> Result<(), Error> {
        let status = loop {
            let generation = search_state.search.generation();
            let result = catch_panic(|| {
                barrier(&pool, self.stop)?;
                search_state.generation(&mut pool.until(self.stop), &|| {}, |search, judgements| {
                    search.tell(&mut record, judgements)
                })
            });
            match result {
                Ok(Ok(_)) => {}
                Ok(Err(Unfinished::Stopped)) => break Status::Stop,
                Ok(Err(Unfinished::Error(error))) => break Status::failed(&error),
                Err(why) => break Status::failed(&Error::strategy_panicked(generation, &why)),
            }
        };
        shut_down(&pool, &status)
    }
}
