//! Selection by the outcomes of encounters, compared with a transcription of its source and on a game without a best player.

use crate::errors;
use farsa_evo::coevolution::{Outcomes, Replacement};
use farsa_evo::{EvoError, Fitness};
use farsa_num::Stream;
use proptest::prelude::*;

/// Chooses opponents as the source does, which sums all differences again for each candidate.
fn transcribed_opponents(matrix: &[Vec<f64>], first: usize, count: usize) -> Vec<usize> {
    let mut unselected: Vec<usize> = (0..matrix[0].len()).filter(|opponent| *opponent != first).collect();
    let mut selected = vec![first];
    while selected.len() < count {
        let (mut place, mut most) = (0, 0.0);
        for (i, &candidate) in unselected.iter().enumerate() {
            let mut difference = 0.0;
            for &other in &selected {
                for row in matrix {
                    difference += (row[candidate] - row[other]).abs();
                }
            }
            if difference > most {
                (place, most) = (i, difference);
            }
        }
        selected.push(unselected.remove(place));
    }
    selected
}

/// Replaces the worst members by the best newcomers, in rising order of both, as the source does. Its search for the next
/// member stops one place too early if nearly all are newcomers. This one continues to the end.
fn transcribed_replacements(means: &[f64], newcomers: usize) -> Vec<(usize, usize)> {
    let members = means.len() - newcomers;
    let mut order: Vec<usize> = (0..means.len()).collect();
    // Rising order. Among equals the higher index is first and counts as worse.
    order.sort_by(|&a, &b| means[a].total_cmp(&means[b]).then(b.cmp(&a)));
    let skip = |mut place: usize| {
        while place < order.len() && order[place] >= members {
            place += 1;
        }
        place
    };
    let (mut pairs, mut replaced) = (Vec::new(), skip(0));
    for i in 0..members {
        if order[i + newcomers] >= members {
            pairs.push((order[replaced], order[i + newcomers]));
            replaced = skip(replaced + 1);
        }
    }
    pairs
}

fn any_matrix() -> impl Strategy<Value = Vec<Vec<f64>>> {
    // Eighths, so that sums in any order are exact.
    (1_usize..9, 2_usize..9).prop_flat_map(|(opponents, individuals)| {
        let outcome = (0_u32..9).prop_map(|eighths| f64::from(eighths) / 8.0);
        proptest::collection::vec(proptest::collection::vec(outcome, opponents), individuals)
    })
}

proptest! {
    #[test]
    fn opponents_are_those_of_the_transcription(matrix in any_matrix(), seed: u64) {
        let opponents = matrix[0].len();
        let outcomes = Outcomes::new(opponents, matrix.concat()).unwrap();
        for count in 1..=opponents {
            let found = outcomes.differing_opponents(count, &mut Stream::from_seed(seed)).unwrap();
            prop_assert_eq!(&found, &transcribed_opponents(&matrix, found[0], count));
        }
    }

    #[test]
    fn the_best_of_all_stay(matrix in any_matrix(), share in 0.0_f64..1.0) {
        let individuals = matrix.len();
        let newcomers = (share * individuals as f64) as usize;
        let outcomes = Outcomes::new(matrix[0].len(), matrix.concat()).unwrap();
        let fitness = outcomes.fitness();
        let found = outcomes.replacements(newcomers).unwrap();
        let means: Vec<f64> = fitness.iter().map(|fitness| fitness.get()).collect();
        let want = transcribed_replacements(&means, newcomers);
        prop_assert_eq!(found.iter().map(|r| (r.member, r.newcomer)).collect::<Vec<_>>(), want);
        let members = individuals - newcomers;
        let mut stay: Vec<usize> = (0..members).collect();
        for Replacement { member, newcomer } in found {
            prop_assert!(member < members && newcomer >= members && fitness[newcomer] > fitness[member]);
            stay[member] = newcomer;
        }
        let least = stay.iter().map(|&individual| fitness[individual]).min();
        prop_assert!((0..individuals).filter(|i| !stay.contains(i)).all(|i| Some(fitness[i]) <= least));
    }
}

/// In rock, paper, scissors a newcomer that beats one opponent and loses to another fails. One that draws with all passes.
#[test]
fn opportunists_do_not_pass() {
    let outcomes = [
        [0.5, 0.5, 0.0], // Draws with two, loses to the third.
        [0.5, 0.0, 0.5],
        [1.0, 0.0, 0.0], // Newcomers: one that beats only the first,
        [0.5, 0.5, 0.5], // and one that draws with all.
    ];
    let outcomes = Outcomes::new(3, outcomes.concat()).unwrap();
    assert_eq!(outcomes.replacements(2).unwrap(), [Replacement { member: 1, newcomer: 3 }]);
    assert_eq!((outcomes.individuals(), outcomes.opponents()), (4, 3));
    assert_eq!(outcomes.of(2).unwrap().iter().map(|o| o.get()).collect::<Vec<_>>(), [1.0, 0.0, 0.0]);
    assert!(outcomes.of(4).is_none());
}

#[test]
fn failed_encounters_rank_last_and_choose_no_opponent() {
    let values = vec![0.1, 0.1, 0.2, f64::NAN, 1.0, 0.9, 0.2, 0.2, 0.1];
    let outcomes = Outcomes::new(3, values).unwrap();
    assert_eq!(outcomes.fitness()[1], Fitness::WORST);
    assert_eq!(outcomes.replacements(1).unwrap(), [Replacement { member: 1, newcomer: 2 }]);
    let chosen = outcomes.differing_opponents(3, &mut Stream::from_seed(1)).unwrap();
    assert_eq!(
        {
            let mut sorted = chosen;
            sorted.sort_unstable();
            sorted
        },
        [0, 1, 2]
    );
}

#[test]
fn impossible_sizes_are_refused() {
    assert_eq!(Outcomes::new(0, vec![1.0]), Err(errors::no_individuals()));
    assert_eq!(Outcomes::new(3, Vec::new()), Err(errors::no_individuals()));
    assert_eq!(Outcomes::new(3, vec![0.0; 5]), Err(errors::fitness_count(6, 5)));
    let outcomes = Outcomes::new(2, vec![0.0; 6]).unwrap();
    for count in [0, 3] {
        let refused = outcomes.differing_opponents(count, &mut Stream::from_seed(1));
        assert!(matches!(refused, Err(EvoError::OutOfRange { value, .. }) if value == count as f64));
    }
    assert!(matches!(outcomes.replacements(3), Err(EvoError::OutOfRange { value: 3.0, .. })));
    assert_eq!(outcomes.replacements(0), Ok(Vec::new()));
}
