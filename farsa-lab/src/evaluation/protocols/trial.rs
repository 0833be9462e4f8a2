//! A single trial of a protocol's case, step by step.

use farsa_body::Recorder;

use crate::evaluation::test::Tested;
use crate::evaluation::trials::episode;
use crate::experiment::evaluator::{Evaluation, Evaluator};
use crate::experiment::outcome::Outcome;
use crate::experiment::protocol::CaseId;
use crate::run::catch_panic::catch_printed_panic;

/// Which trial of a test by a protocol.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CaseTrial {
    pub(crate) case: CaseId,
    /// Its number in the case.
    pub(crate) trial: usize,
    /// Seed of the test.
    pub(crate) seed: u64,
}

impl CaseTrial {
    /// Runs the trial as `farsa test` does. With several populations the first one's champion comes first.
    ///
    /// # Errors
    /// That it panicked: the evaluator is not used again then.
    pub(crate) fn run(
        self,
        evaluator: &mut dyn Evaluator,
        tested: Tested<'_>,
        recorder: &mut dyn Recorder,
    ) -> Result<Outcome, ()> {
        let Some((parameters, others)) = tested.parameters.split_first() else { return Err(()) };
        let opponents: Vec<&[f32]> = others.iter().map(Vec::as_slice).collect();
        let id = episode(self.trial, evaluator.info().trials, self.seed);
        let normalisation = tested.normalisation;
        let case = Some(self.case);
        let evaluation = Evaluation { opponents: &opponents, normalisation, case, ..Evaluation::new(parameters, id) };
        catch_printed_panic(|| evaluator.evaluate(evaluation, Some(recorder)))
    }
}
