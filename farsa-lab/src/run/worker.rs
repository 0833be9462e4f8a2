//! What a rank other than the first does in a run: it holds the same search, evaluates what rank 0 gives it, and writes nothing.

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

/// How a rank prepares what rank 0 orders.
pub(crate) struct Worker<'f, 'e> {
    /// The plan of a configuration.
    pub(crate) plan: &'f dyn Fn(&ConfigFile) -> Result<Plan<'e>, Error>,
    /// This rank's threads.
    pub(crate) pool: &'f dyn Fn(&Plan<'e>) -> Result<Pool<'e>, Error>,
    pub(crate) stop: &'f AtomicBool,
}

impl Worker<'_, '_> {
    /// Follows one run after the other until rank 0 says with which exit code to end. What goes wrong here is said by rank 0.
    ///
    /// # Errors
    /// When ranks are lost.
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

    /// A run where its checkpoint left it.
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

    /// Generation after generation, until rank 0 says that the run is over or somebody has an error.
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
                Err(why) => break Status::failed(&Error::Panicked { generation, why }),
            }
        };
        shut_down(&pool, &status)
    }
}
