//! A trial of each of some cases of a protocol, step by step.

use farsa_body::Recorder;
use farsa_view::Schema;

use crate::error::Error;
use crate::evaluation::protocols::trial::CaseTrial;
use crate::evaluation::test::{Subject, whose};
use crate::experiment::evaluator::{Bodies, Evaluator};
use crate::experiment::lanes::LaneRequest;
use crate::experiment::outcome::Outcome;
use crate::experiment::protocol::{Case, CaseId, Protocol};
use crate::run::plan::Plan;
use crate::run::pool::Pool;
use crate::store::directory::Directory;

/// Which trials of a test by a protocol.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CaseSelection<'c> {
    /// Protocol's name.
    pub(crate) protocol: &'c str,
    /// Names or numbers of cases. Empty for all.
    pub(crate) cases: &'c [String],
    /// Number of the trial in each case.
    pub(crate) trial: u32,
    /// Seed of the test.
    pub(crate) seed: u64,
}

/// A run's champion in the selected cases, with the trials of `farsa test`. With several populations the first one's
/// champion comes first.
pub(crate) struct CaseTrials {
    evaluator: Box<dyn Evaluator>,
    subject: Subject,
    protocol: (usize, Protocol),
    /// Numbers of the cases.
    pub(crate) cases: Vec<usize>,
    pub(crate) trial: u32,
    pub(crate) seed: u64,
}

impl CaseTrials {
    /// Reads the champion and finds the cases.
    ///
    /// # Errors
    /// As for [`Protocol::find`], [`Protocol::case`] and [`Subject::read`], [`Error::Usage`] for too many cases.
    pub(crate) fn find(plan: &Plan<'_>, directory: &Directory, choice: CaseSelection<'_>) -> Result<Self, Error> {
        let pool = Pool::new(plan, 1, LaneRequest::ONE)?;
        let mut protocols = pool.info().protocols.clone();
        let number = Protocol::find(&protocols, choice.protocol, plan.experiment.name())?;
        let protocol = protocols.swap_remove(number);
        let mut cases = choice.cases.iter().map(|name| protocol.case(name)).collect::<Result<Vec<_>, _>>()?;
        if cases.is_empty() {
            cases = (0..protocol.cases.len()).collect();
        }
        if cases.len() > plan.limits.cases {
            let (name, count, limit) = (&protocol.name, cases.len(), plan.limits.cases);
            let why = format!("protocol `{name}` has {count} cases; {limit} are shown: name them with --case");
            return Err(Error::Usage(why));
        }
        let subject = Subject::read(plan, directory, &pool)?;
        let (evaluator, protocol) = (plan.evaluator()?, (number, protocol));
        Ok(Self { evaluator, subject, protocol, cases, trial: choice.trial, seed: choice.seed })
    }

    /// Gets the protocol.
    pub(crate) fn protocol(&self) -> &Protocol {
        &self.protocol.1
    }

    /// A case of a number of [`cases`](Self::cases).
    pub(crate) fn case(&self, number: usize) -> Case {
        self.protocol().cases.get(number).cloned().unwrap_or_default()
    }

    /// Whose trials they are.
    pub(crate) fn subject(&self) -> &Subject {
        &self.subject
    }

    /// Gets the evaluator.
    pub(crate) fn evaluator(&self) -> &dyn Evaluator {
        self.evaluator.as_ref()
    }

    /// Builds the schema of the recordings.
    pub(crate) fn schema(&self) -> Schema {
        let parameters = self.subject.tested().parameters.first();
        let with = |bodies: &dyn Bodies| parameters.map(|parameters| bodies.schema_with(parameters));
        self.evaluator.bodies().and_then(with).unwrap_or_else(|| self.evaluator.info().schema)
    }

    /// Protocol, champion, trial and seed in words.
    pub(crate) fn caption(&self) -> String {
        let Subject { generation, individual, individuals, .. } = &self.subject;
        let whose = whose(*generation, *individual, individuals);
        format!("{}, {whose}, trial {}, test seed {}", self.protocol().name, self.trial, self.seed)
    }

    /// Runs the trial in a case.
    ///
    /// # Errors
    /// [`Error::Other`] if it panics: the evaluator is not used again then.
    pub(crate) fn run(&mut self, case: usize, recorder: &mut dyn Recorder) -> Result<Outcome, Error> {
        let name = self.case(case).name();
        let panicked = |()| Error::Other(format!("trial {} of the case {name} panicked", self.trial));
        let case = CaseId { protocol: self.protocol.0, case };
        let of_case = CaseTrial { case, trial: self.trial as usize, seed: self.seed };
        of_case.run(self.evaluator.as_mut(), self.subject.tested(), recorder).map_err(panicked)
    }
}
