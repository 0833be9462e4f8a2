//! A test protocol as a run was tested by it.

use crate::error::Error;
use crate::evaluation::protocols::files::{self, ProtocolRecord};
use crate::evaluation::protocols::found::FoundCase;
use crate::experiment::evaluator::Evaluator;
use crate::experiment::protocol::{Case, Protocol};
use crate::store::directory::Directory;

/// A protocol as a run was tested by it.
pub(crate) struct TestedProtocol {
    pub(crate) protocol: Protocol,
    pub(crate) found: Vec<FoundCase>,
    /// None if a process was killed before it wrote one.
    pub(crate) record: Option<ProtocolRecord>,
}

impl TestedProtocol {
    /// Those of the evaluator's protocols of which a directory holds the results.
    ///
    /// # Errors
    /// [`Error::Damaged`], [`Error::Io`].
    pub(crate) fn all(directory: &Directory, evaluator: &dyn Evaluator) -> Result<Vec<Self>, Error> {
        let (protocols, terms) = (evaluator.protocols(), evaluator.terms());
        Protocol::check(&protocols)?;
        let read = |protocol: Protocol| -> Result<Option<Self>, Error> {
            let found = files::read(directory, &protocol.name)?;
            Ok(found.map(|(table, record)| Self { protocol, found: FoundCase::all(&table, &terms), record }))
        };
        protocols.into_iter().filter_map(|protocol| read(protocol).transpose()).collect()
    }

    /// The cases, in the order of the table.
    pub(crate) fn cases(&self) -> Vec<Case> {
        self.found.iter().map(FoundCase::case).collect()
    }
}
