//! A test protocol with its results in a run.

use crate::error::Error;
use crate::evaluation::protocols::case_summary::CaseSummary;
use crate::evaluation::protocols::files::{self, ProtocolRecord};
use crate::evaluation::protocols::states::States;
use crate::experiment::evaluator::Evaluator;
use crate::experiment::protocol::{Case, Protocol};
use crate::store::directory::Directory;

/// A test protocol with its results in a run.
pub(crate) struct TestedProtocol {
    pub(crate) protocol: Protocol,
    pub(crate) found: Vec<CaseSummary>,
    /// `None` if a process was killed before writing it.
    pub(crate) record: Option<ProtocolRecord>,
    /// Recorded states of the same test, if any.
    pub(crate) states: Option<States>,
}

impl TestedProtocol {
    /// Returns the protocols with results in a directory, and the others.
    ///
    /// # Errors
    /// [`Error::File`], [`Error::Io`].
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
            // States of an earlier test are of other trials.
            let own = |of: &ProtocolRecord| record.as_ref().is_some_and(|record| record.same_test(of));
            let states = states.filter(|(_, of)| of.as_ref().is_some_and(own)).map(|(states, _)| states);
            tested.push(Self { protocol, found: CaseSummary::all(&table, &terms), record, states });
        }
        Ok((tested, others))
    }

    /// Lists the cases in the order of the table.
    pub(crate) fn cases(&self) -> Vec<Case> {
        self.found.iter().map(CaseSummary::case).collect()
    }
}
