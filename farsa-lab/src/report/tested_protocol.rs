//! A test protocol as a run was tested by it.

use crate::error::Error;
use crate::evaluation::protocols::files::{self, ProtocolRecord};
use crate::evaluation::protocols::found::FoundCase;
use crate::evaluation::protocols::states::States;
use crate::experiment::evaluator::Evaluator;
use crate::experiment::protocol::{Case, Protocol};
use crate::store::directory::Directory;

/// A protocol as a run was tested by it.
pub(crate) struct TestedProtocol {
    pub(crate) protocol: Protocol,
    pub(crate) found: Vec<FoundCase>,
    /// None if a process was killed before it wrote one.
    pub(crate) record: Option<ProtocolRecord>,
    /// The states that were recorded in the same test, if any were.
    pub(crate) states: Option<States>,
}

impl TestedProtocol {
    /// Those of the evaluator's protocols of which a directory holds the results, and those that were not run.
    ///
    /// # Errors
    /// [`Error::Damaged`], [`Error::Io`].
    pub(crate) fn all(directory: &Directory, evaluator: &dyn Evaluator) -> Result<(Vec<Self>, Vec<Protocol>), Error> {
        let (protocols, terms) = (evaluator.info().protocols, evaluator.info().terms);
        Protocol::check(&protocols)?;
        let (mut tested, mut others) = (Vec::new(), Vec::new());
        for protocol in protocols {
            let Some((table, record)) = files::read(directory, &protocol.name)? else {
                others.push(protocol);
                continue;
            };
            let states = States::read(directory, &protocol.name)?;
            // Those of an earlier test are of other trials.
            let own = |of: &ProtocolRecord| record.as_ref().is_some_and(|record| record.same_test(of));
            let states = states.filter(|(_, of)| of.as_ref().is_some_and(own)).map(|(states, _)| states);
            tested.push(Self { protocol, found: FoundCase::all(&table, &terms), record, states });
        }
        Ok((tested, others))
    }

    /// The cases, in the order of the table.
    pub(crate) fn cases(&self) -> Vec<Case> {
        self.found.iter().map(FoundCase::case).collect()
    }
}
