//! What a rank other than the first does in a run: it holds the same search, evaluates what rank 0 gives it, and writes nothing.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use farsa_evo::RecordWriter;

use crate::error::Error;
use crate::ranks::exchange::{Exchange, Order, Status};
use crate::run::begin::progression;
use crate::run::config_file::ConfigFile;
use crate::run::contained::contained;
use crate::run::evaluations::Unfinished;
use crate::run::leading::{facts, leave, meet};
use crate::run::plan::Plan;
use crate::run::pool::Pool;
use crate::run::progression::Progression;
use crate::run::records::Checkpoint;
use crate::run::told::Told;
use crate::store::directory::Directory;
use crate::store::sealed;

/// How a rank prepares what rank 0 orders.
pub(crate) struct Following<'f, 'e> {
    /// The plan of a configuration.
    pub(crate) plan: &'f dyn Fn(&ConfigFile) -> Result<Plan<'e>, Error>,
    /// This rank's threads.
    pub(crate) pool: &'f dyn Fn(&Plan<'e>) -> Result<Pool<'e>, Error>,
    pub(crate) stop: &'f AtomicBool,
}

impl Following<'_, '_> {
    /// Follows one run after the other until rank 0 says with which exit code to end. What goes wrong here is said by rank 0.
    ///
    /// # Errors
    /// When ranks are lost.
    pub(crate) fn follow(&self, exchange: &Exchange<'_>) -> Result<u8, Error> {
        loop {
            match exchange.order(None)? {
                Order::End(code) => return Ok(code),
                Order::Run { directory, config, checkpoint, record } => {
                    let prepared = contained(|| self.prepare(directory.as_ref(), &config, &checkpoint, record));
                    match prepared.unwrap_or_else(|why| Err(Error::Other(format!("panicked: {why}")))) {
                        Err(error) => drop(exchange.begin(Err(error))),
                        Ok((plan, pool, progression, record)) => {
                            if exchange.begin(facts(&plan)).is_ok() {
                                self.run(pool, progression, record)?;
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
    ) -> Result<(Plan<'_>, Pool<'_>, Progression, RecordWriter), Error> {
        let directory = Directory::at(directory.into());
        let plan = (self.plan)(&ConfigFile::parse(&directory.config().display().to_string(), config)?)?;
        let pool = (self.pool)(&plan)?;
        let checkpoint: Checkpoint =
            sealed::open(checkpoint).map_err(|why| Error::damaged(&directory.checkpoint(), why))?;
        let told = Told::from_content(&plan, &directory, &checkpoint, record)?;
        let progression = progression(&plan, &directory, &checkpoint, &told, pool.genotype())?;
        Ok((plan, pool, progression, told.record.writer()))
    }

    /// Generation after generation, until rank 0 says that the run is over or somebody has an error.
    fn run(&self, mut pool: Pool<'_>, mut progression: Progression, mut record: RecordWriter) -> Result<(), Error> {
        let status = loop {
            let generation = progression.search.generation();
            let result = contained(|| {
                meet(&pool, self.stop)?;
                progression.generation(&mut pool.until(self.stop), &|| {}, |search, judgements| {
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
        leave(&pool, &status)
    }
}
