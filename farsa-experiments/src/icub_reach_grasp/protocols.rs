//! Test protocols of `icub-reach-grasp`, and the conditions of each of their cases.

use std::borrow::Cow;

use farsa_lab::Evaluation;
use farsa_lab::advanced::{CaseId, Intervention, Interventions, Protocol};

use crate::icub_reach_grasp::config::{Config, SENSORS};
use crate::icub_reach_grasp::episode::Lifting;
use crate::icub_reach_grasp::senses::Senses;

/// Number of cells along x and y into which the tested area is divided. The area is the same in all conditions.
pub const CELLS: [u32; 2] = [4, 4];
/// Trials of a case.
const TRIALS: u32 = 24;
/// Errors of the offsets in the eye's image.
const NOISE: [f32; 5] = [0.0, 0.025, 0.05, 0.1, 0.2];
/// The inputs that feel touch.
const TOUCH: core::ops::Range<usize> = 6..SENSORS;

/// The protocols of a configuration, with what each case is.
#[derive(Clone, Debug)]
pub(crate) struct Protocols {
    interventions: Interventions,
}

impl Protocols {
    /// All protocols.
    pub(crate) fn new(config: &Config) -> Self {
        let rows = (1..=CELLS[0]).map(|x| format!("x {x}"));
        let columns = (1..=CELLS[1]).map(|y| format!("y {y}"));
        let areas = Protocol::from_table("areas", "parts of the area in which the ball lies", rows, columns)
            .with_axes("forwards", "leftwards")
            .with_trials(TRIALS);
        let levels = NOISE.iter().map(ToString::to_string);
        let noise =
            Protocol::from_list("noise", "dx and dy change at every step by a random number up to this", levels)
                .with_trials(TRIALS);
        let groups = [("eye", 0..2), ("neck", 2..4), ("trunk", 4..6), ("touch", TOUCH)];
        let groups = groups.into_iter().map(|(name, inputs)| (format!("no {name}"), Intervention::cut(inputs)));
        let names = Senses::names();
        let single = TOUCH.map(|input| (format!("no touch of {}", names[input]), Intervention::cut(input..input + 1)));
        let hidden = (0..config.hidden as usize)
            .map(|neuron| (format!("no hidden neuron {}", neuron + 1), Intervention::lesion(neuron)));
        let summary = "some inputs are cut, or one neuron is silent";
        let interventions = Interventions::default()
            .with_protocol(areas, Vec::new())
            .with_cases("lesions", summary, groups.chain(single).chain(hidden))
            .with_protocol(noise, Vec::new());
        Self { interventions }
    }

    /// The protocols as the command shows them.
    pub(crate) fn list(&self) -> Vec<Protocol> {
        self.interventions.protocols()
    }

    /// The change of the network in an evaluation.
    pub(crate) fn applied(&self, evaluation: &Evaluation<'_>) -> Cow<'_, Intervention> {
        self.interventions.applied(evaluation)
    }

    /// The demands of a trial in a case.
    pub(crate) fn asked(&self, case: Option<CaseId>) -> Lifting {
        let plain = Lifting::default();
        match self.interventions.named(case) {
            Some(("areas", case)) => {
                let case = case as u32;
                Lifting { cell: Some([[case / CELLS[1], case % CELLS[1]], CELLS]), ..plain }
            }
            Some(("noise", case)) => Lifting { noise: NOISE.get(case).copied().unwrap_or_default(), ..plain },
            _ => plain,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use farsa_lab::EpisodeId;

    #[test]
    fn each_case_asks_what_its_name_says() {
        let all = Protocols::new(&Config::default());
        let list = all.list();
        Protocol::check(&list).unwrap();
        let names: Vec<(&str, usize)> = list.iter().map(|one| (one.name.as_str(), one.cases.len())).collect();
        assert_eq!(names, [("areas", 16), ("lesions", 1 + 4 + 9 + 6), ("noise", 5)]);
        let at = |protocol, case| Some(CaseId { protocol, case });
        assert_eq!(list[0].cases[6].name(), "x 2 y 3");
        assert_eq!(all.asked(at(0, 6)).cell, Some([[1, 2], CELLS]));
        assert_eq!(list[1].cases[5].row, "no touch of thumb tip");
        let plain = Evaluation::new(&[], EpisodeId::default());
        let done = |case| all.applied(&Evaluation { case, ..plain }).into_owned();
        assert_eq!(done(at(1, 5)), Intervention::cut(6..7));
        assert_eq!(done(at(1, 14)), Intervention::lesion(0));
        assert_eq!((list[2].cases[2].row.as_str(), all.asked(at(2, 2)).noise), ("0.05", 0.05));
        assert_eq!(all.asked(at(1, 3)), Lifting::default());
        assert_eq!(done(None), Intervention::default());
    }
}
