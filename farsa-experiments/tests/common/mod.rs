//! Checks of several experiments.
#![allow(clippy::unwrap_used)]

use farsa_lab::advanced::{CaseId, Lanes};
use farsa_lab::{EpisodeId, Evaluation, Evaluator, Outcome};
use farsa_num::{Domain, Instructions, Stream};

/// Random individuals.
const INDIVIDUALS: usize = 6;

fn random(evaluator: &dyn Evaluator, number: u32) -> Vec<f32> {
    let mut stream = Stream::new(2, Domain::InitialGenome, number, 0, 0);
    evaluator.info().parameters.into_iter().map(|one| stream.range_f64(one.ends[0], one.ends[1]) as f32).collect()
}

/// Evaluates random individuals in the given number of plain trials and cases of all test protocols, alone and in lanes. All
/// numbers of lanes and all instruction sets of this machine give the same outcomes.
pub(crate) fn assert_lanes_are_alone(evaluator: &mut dyn Evaluator, count: usize, trials: u32) {
    let parameters: Vec<Vec<f32>> = (0..INDIVIDUALS as u32).map(|number| random(evaluator, number)).collect();
    let protocols = evaluator.info().protocols;
    let evaluations: Vec<Evaluation<'_>> = (0..count)
        .map(|number| {
            let id = EpisodeId { seed: 4, generation: 1, individual: 0, trial: number as u32 % trials };
            let protocol = number % protocols.len();
            let case = CaseId { protocol, case: number * 7 % protocols[protocol].cases.len() };
            let case = (number % 3 > 0).then_some(case);
            Evaluation { number, case, ..Evaluation::new(&parameters[number % INDIVIDUALS], id) }
        })
        .collect();
    let alone: Vec<Outcome> = evaluations.iter().map(|one| evaluator.evaluate(*one, None)).collect();
    assert!(alone.iter().all(Outcome::is_finite));
    assert!(alone.iter().any(|one| one.terms != alone[0].terms));
    for lanes in [8, 16] {
        for instructions in Instructions::available() {
            let in_lanes = evaluator.in_lanes().unwrap();
            in_lanes.use_lanes(Lanes::new(lanes, instructions).unwrap()).unwrap();
            let mut left = evaluations.iter().copied();
            let mut together: Vec<Option<Outcome>> = vec![None; alone.len()];
            in_lanes.run_in_lanes(&mut || left.next(), &mut |number, outcome| together[number] = Some(outcome));
            for (number, (one, other)) in alone.iter().zip(&together).enumerate() {
                assert_eq!(Some(one), other.as_ref(), "{lanes} lanes, {instructions:?}, evaluation {number}");
            }
        }
    }
}
