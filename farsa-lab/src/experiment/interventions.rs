//! Test protocols that change what a controller senses and computes.

use std::borrow::Cow;
use std::ops::Range;

use crate::experiment::evaluator::Evaluation;
use crate::experiment::intervention::{Intervention, NOTHING};
use crate::experiment::protocol::{Case, CaseId, Protocol};

/// Test protocols of an experiment, together with the change of the controller in each case.
///
/// ```
/// use farsa_lab::advanced::{CaseId, Intervention, Interventions};
///
/// let all = Interventions::default()
///     .with_lesions([("camera", 0..3), ("touch", 3..4)], [("neuron 1".to_owned(), 0)])
///     .with_noise(&[0.0, 0.1]);
/// let protocols = all.protocols();
/// assert_eq!(protocols[0].cases[1].row, "no camera");
/// let case = CaseId { protocol: 0, case: 3 };
/// assert_eq!(all.of(Some(case)), Some(&Intervention::lesion(0)));
/// assert_eq!(all.of(None), None);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Interventions {
    protocols: Vec<(Protocol, Vec<Intervention>)>,
}

impl Interventions {
    /// Default levels for [`with_noise`](Self::with_noise). They are suitable for inputs from 0 to 1.
    pub const NOISE: [f32; 5] = [0.0, 0.05, 0.1, 0.2, 0.4];

    /// Appends a protocol, with a change for each of its cases. Cases without a change leave the controller as it is.
    #[must_use]
    pub fn with_protocol(mut self, protocol: Protocol, interventions: Vec<Intervention>) -> Self {
        self.protocols.push((protocol, interventions));
        self
    }

    /// Appends a protocol `name` with a change for each case. Its first case is `intact`, and has no change.
    ///
    /// If the names of two cases are equal, or a name is not printable, the protocol is silently omitted.
    #[must_use]
    pub fn with_cases<R: Into<String>>(
        self,
        name: &str,
        summary: &str,
        cases: impl IntoIterator<Item = (R, Intervention)>,
    ) -> Self {
        let (rows, mut interventions): (Vec<String>, Vec<_>) =
            cases.into_iter().map(|(row, intervention)| (row.into(), intervention)).unzip();
        interventions.insert(0, Intervention::default());
        let mut protocol = Protocol::from_list(name, summary, ["intact"]);
        protocol.cases.extend(rows.into_iter().map(|row| Case::new(row, "")));
        if Protocol::check(std::slice::from_ref(&protocol)).is_err() {
            return self;
        }
        self.with_protocol(protocol, interventions)
    }

    /// Appends the protocol `lesions`, which cuts each group of inputs and silences each neuron, one at a time.
    #[must_use]
    pub fn with_lesions<G: AsRef<str>>(
        self,
        groups: impl IntoIterator<Item = (G, Range<usize>)>,
        neurons: impl IntoIterator<Item = (String, usize)>,
    ) -> Self {
        let groups =
            groups.into_iter().map(|(name, inputs)| (format!("no {}", name.as_ref()), Intervention::cut(inputs)));
        let neurons = neurons.into_iter().map(|(name, neuron)| (format!("no {name}"), Intervention::lesion(neuron)));
        let summary = "one group of inputs is cut, or one neuron is silent";
        self.with_cases("lesions", summary, groups.chain(neurons))
    }

    /// Appends the protocol `noise`, which adds noise to every input. There is a case for each level.
    #[must_use]
    pub fn with_noise(self, levels: &[f32]) -> Self {
        let summary = "every input changes at every step by a random number up to this";
        let protocol = Protocol::from_list("noise", summary, levels.iter().map(ToString::to_string));
        self.with_protocol(protocol, levels.iter().copied().map(Intervention::noise).collect())
    }

    /// Gets all protocols. Use this for [`TaskInfo::protocols`](crate::TaskInfo::protocols).
    pub fn protocols(&self) -> Vec<Protocol> {
        self.protocols.iter().map(|(protocol, _)| protocol.clone()).collect()
    }

    /// Computes the change of an evaluation. This combines the change of its case with that of the test itself.
    pub fn applied(&self, evaluation: &Evaluation<'_>) -> Cow<'_, Intervention> {
        let of_case = self.of(evaluation.case).unwrap_or(&NOTHING);
        evaluation.intervention.map_or(Cow::Borrowed(of_case), |other| Cow::Owned(of_case.and(other)))
    }

    /// Gets the change of a case. If there is no case, this returns `None`.
    pub fn of(&self, case: Option<CaseId>) -> Option<&Intervention> {
        let CaseId { protocol, case } = case?;
        self.protocols.get(protocol)?.1.get(case)
    }

    /// Gets the name of a protocol, and the index of the case in it. This is useful for cases that need more than a
    /// change of the controller.
    pub fn named(&self, case: Option<CaseId>) -> Option<(&str, usize)> {
        let CaseId { protocol, case } = case?;
        self.protocols.get(protocol).map(|(protocol, _)| (protocol.name.as_str(), case))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cases_are_found_and_those_that_cannot_be_named_are_left_out() {
        let all = Interventions::default()
            .with_protocol(Protocol::from_list("own", "", ["a", "b"]), Vec::new())
            .with_lesions([("eyes", 0..3), ("skin", 3..5)], [])
            .with_lesions([("same", 0..1), ("same", 1..2)], [])
            .with_noise(&[0.0, 0.25]);
        let names: Vec<String> = all.protocols().into_iter().map(|protocol| protocol.name).collect();
        assert_eq!(names, ["own", "lesions", "noise"]);
        Protocol::check(&all.protocols()).unwrap();
        let at = |protocol, case| Some(CaseId { protocol, case });
        assert_eq!((all.of(at(0, 1)), all.named(at(0, 1))), (None, Some(("own", 1))));
        assert_eq!(all.of(at(1, 0)), Some(&Intervention::default()));
        assert_eq!(all.of(at(1, 2)), Some(&Intervention::cut(3..5)));
        assert_eq!(all.of(at(2, 1)), Some(&Intervention::noise(0.25)));
        assert_eq!((all.of(at(3, 0)), all.of(at(1, 9)), all.named(None)), (None, None, None));

        // The change of the test is added to that of the case.
        let plain = Evaluation::new(&[], crate::EpisodeId::default());
        let of_case = Evaluation { case: at(1, 2), ..plain };
        assert_eq!((&*all.applied(&plain), &*all.applied(&of_case)), (&NOTHING, &Intervention::cut(3..5)));
        let other = Intervention::lesion(4);
        let both = Evaluation { intervention: Some(&other), ..of_case };
        assert_eq!(*all.applied(&both), Intervention::cut(3..5).and(&other));
    }
}
