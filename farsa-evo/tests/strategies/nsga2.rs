//! NSGA-II, compared with a transcription of its source, on the ZDT problems and by digests.

#![allow(clippy::disallowed_methods)]

use crate::errors;
use farsa_evo::coevolution::Populations;
use farsa_evo::pareto::{Nsga2, Nsga2Config, dominates, hypervolume};
use farsa_evo::{EvoError, Fitness, Record, ScoreShape, Scores, Snapshot, Strategy, check_strategy};
use farsa_num::{Domain, Stream};
use proptest::prelude::*;

#[path = "../../examples/zdt/problems.rs"]
mod problems;
use problems::{REFERENCE, Zdt};

fn configs() -> [Nsga2Config; 4] {
    let bounds = vec![[-5.0, 5.0], [0.0, 1.0], [2.0, 2.0], [-1.0, 3.0]];
    let base = Nsga2Config { population: 12, ..Nsga2Config::new(bounds, 2) };
    [
        base.clone(),
        Nsga2Config { objectives: 3, population: 15, crossover_eta: 2.0, mutation_eta: 5.0, ..base.clone() },
        Nsga2Config { objectives: 1, crossover_rate: 0.0, mutation_rate: 1.0, ..base.clone() },
        Nsga2Config { population: 1, objectives: 4, ..base },
    ]
}

/// Up to four conflicting objectives. One evaluation in eleven fails.
fn judge(genes: &[f64], row: &mut [f64]) {
    let sum: f64 = genes.iter().sum();
    let objectives = [-(genes[0] - 1.0).abs(), -sum * sum, (2.0 * genes[1]).floor(), genes[3] - genes[0]];
    row.copy_from_slice(&objectives[..row.len()]);
    if sum.to_bits().is_multiple_of(11) {
        row[0] = f64::NAN;
    }
}

fn scores(search: &Nsga2) -> Scores {
    let width = search.config().objectives;
    let mut values = vec![0.0; width * search.ask().len()];
    search.ask().iter().zip(values.chunks_mut(width)).for_each(|(genes, row)| judge(genes, row));
    Scores::nan_as_failed(search.score_shape(), values).unwrap()
}

#[test]
fn it_conforms() {
    for config in configs() {
        check_strategy(|| Nsga2::new(config.clone(), 7), 40).unwrap();
    }
    let [config, ..] = configs();
    check_strategy(|| Populations::new(3, 7, |seed| Nsga2::new(config.clone(), seed)), 20).unwrap();
}

/// An individual of the transcription: genes, objectives, front and distance.
#[derive(Clone)]
struct Naive {
    genes: Vec<f64>,
    objectives: Vec<f64>,
    front: usize,
    distance: f64,
    evaluated: Option<usize>,
}

/// Returns the next parents as the source describes them, with fronts by peeling and distances by sorting each objective.
fn survivors(candidates: &[Naive], size: usize) -> Vec<Naive> {
    let (mut rest, mut next, mut number): (Vec<Naive>, Vec<Naive>, usize) = (candidates.to_vec(), Vec::new(), 0);
    while next.len() < size {
        let alone = |a: &Naive| !rest.iter().any(|b| dominates(&b.objectives, &a.objectives));
        let (mut front, behind): (Vec<Naive>, Vec<Naive>) = rest.iter().cloned().partition(alone);
        for (individual, distance) in front.iter_mut().zip(vec![0.0; rest.len()]) {
            (individual.front, individual.distance) = (number, distance);
        }
        for m in 0..candidates[0].objectives.len() {
            let mut order: Vec<usize> = (0..front.len()).collect();
            order.sort_by(|a, b| front[*a].objectives[m].partial_cmp(&front[*b].objectives[m]).unwrap());
            let value: Vec<f64> = order.iter().map(|i| front[*i].objectives[m]).collect();
            let range = value[value.len() - 1] - value[0];
            for (place, i) in order.iter().enumerate() {
                if place == 0 || place + 1 == order.len() {
                    front[*i].distance = f64::INFINITY;
                } else if range > 0.0 {
                    front[*i].distance += (value[place + 1] - value[place - 1]) / range;
                }
            }
        }
        if next.len() + front.len() > size {
            front.sort_by(|a, b| b.distance.partial_cmp(&a.distance).unwrap());
        }
        next.extend(front);
        (rest, number) = (behind, number + 1);
    }
    next.truncate(size);
    next
}

fn rival(parents: &[Naive], stream: &mut Stream) -> usize {
    let [a, b] = [0, 1].map(|_| stream.below(parents.len() as u32) as usize);
    let (first, second) = (&parents[a], &parents[b]);
    let better = second.front < first.front || (second.front == first.front && second.distance > first.distance);
    if better { b } else { a }
}

/// `realcross` of Deb's program, for one gene of one child.
fn cross(a: f64, b: f64, [yl, yu]: [f64; 2], eta: f64, stream: &mut Stream) -> f64 {
    if stream.uniform_f64() >= 0.5 || (a - b).abs() <= 1e-14 * (yu - yl) {
        return a;
    }
    let (y1, y2) = (a.min(b), a.max(b));
    let rand = stream.uniform_f64();
    let child = |beta: f64, sign: f64| {
        let alpha = 2.0 - beta.powf(-(eta + 1.0));
        let betaq = if rand <= 1.0 / alpha { rand * alpha } else { 1.0 / (2.0 - rand * alpha) }.powf(1.0 / (eta + 1.0));
        (0.5 * ((y1 + y2) + sign * betaq * (y2 - y1))).clamp(yl, yu)
    };
    let upper = stream.uniform_f64() < 0.5;
    if upper { child(1.0 + 2.0 * (yu - y2) / (y2 - y1), 1.0) } else { child(1.0 + 2.0 * (y1 - yl) / (y2 - y1), -1.0) }
}

/// `real_mutate_ind` of Deb's program, for one gene.
fn mutate(y: f64, [yl, yu]: [f64; 2], config: &Nsga2Config, stream: &mut Stream) -> f64 {
    if stream.uniform_f64() >= config.mutation_rate || yl >= yu {
        return y;
    }
    let (delta1, delta2) = ((y - yl) / (yu - yl), (yu - y) / (yu - yl));
    let (rnd, eta) = (stream.uniform_f64(), config.mutation_eta);
    let deltaq = if rnd < 0.5 {
        (2.0 * rnd + (1.0 - 2.0 * rnd) * (1.0 - delta1).powf(eta + 1.0)).powf(1.0 / (eta + 1.0)) - 1.0
    } else {
        let val = 2.0 * (1.0 - rnd) + 2.0 * (rnd - 0.5) * (1.0 - delta2).powf(eta + 1.0);
        1.0 - val.powf(1.0 / (eta + 1.0))
    };
    (y + deltaq * (yu - yl)).clamp(yl, yu)
}

#[test]
fn generations_are_those_of_a_transcription() {
    for config in configs() {
        let mut search = Nsga2::new(config.clone(), 11).unwrap();
        let mut parents: Vec<Naive> = Vec::new();
        for generation in 1..20 {
            let scores = scores(&search);
            for parent in &mut parents {
                parent.evaluated = None;
            }
            parents.extend(search.ask().iter().enumerate().map(|(i, genes)| {
                let objectives = scores.objectives(i).to_vec();
                Naive { genes: genes.to_vec(), objectives, front: 0, distance: 0.0, evaluated: Some(i) }
            }));
            search.tell_scores(&scores).unwrap();
            parents = survivors(&parents, config.population);
            assert!(search.parents().map(|(genes, _)| genes).eq(parents.iter().map(|parent| &parent.genes[..])));
            assert!(search.parents().map(|(_, m)| m).eq(parents.iter().map(|parent| &parent.objectives[..])));
            assert_eq!(search.front().count(), parents.iter().filter(|parent| parent.front == 0).count());
            for (i, genes) in search.ask().iter().enumerate() {
                let stream = &mut Stream::new(11, Domain::Mutation, 0, i as u32, generation);
                let first = rival(&parents, stream);
                let (mut want, mut named) = (parents[first].genes.clone(), vec![first]);
                if stream.uniform_f64() < config.crossover_rate {
                    let second = rival(&parents, stream);
                    named.push(second);
                    for (gene, range) in config.bounds.iter().enumerate() {
                        let other = parents[second].genes[gene];
                        want[gene] = cross(want[gene], other, *range, config.crossover_eta, stream);
                    }
                }
                for (gene, range) in want.iter_mut().zip(&config.bounds) {
                    *gene = mutate(*gene, *range, &config, stream);
                }
                for (got, want) in genes.iter().zip(&want) {
                    assert!((got - want).abs() <= 1e-12 * want.abs().max(1.0), "{generation} {i}: {got} {want}");
                }
                named.dedup();
                let named: Vec<usize> = named.into_iter().filter_map(|parent| parents[parent].evaluated).collect();
                assert_eq!(search.genealogy().unwrap().parents_of(i), named);
            }
        }
    }
}

/// 100 individuals, 25 000 evaluations. The best 100 points have a hypervolume 0.4 to 0.6 % below that of the true front.
#[test]
fn it_finds_the_fronts_of_the_zdt_problems() {
    for problem in Zdt::ALL {
        let mut search = Nsga2::new(Nsga2Config::new(problem.bounds(), 2), 1).unwrap();
        search.evolve(250, |genes, row| problem.judge(genes, row)).unwrap();
        let points: Vec<[f64; 2]> = search.front().map(|(_, objectives)| [objectives[0], objectives[1]]).collect();
        let share = hypervolume(&points, REFERENCE) / problem.largest_hypervolume();
        assert!((0.97..1.0).contains(&share), "{}: {share}", problem.name());
    }
}

/// Integrates the hypervolumes of the true fronts.
#[test]
fn the_true_fronts_have_their_hypervolume() {
    let above = |problem: Zdt| problem.largest_hypervolume();
    // 1.21 less the area below 1 - sqrt(x), and below 1 - x^2.
    assert!((above(Zdt::One) - (1.21 - 1.0 / 3.0)).abs() < 1e-4 && (above(Zdt::Two) - (1.21 - 2.0 / 3.0)).abs() < 1e-4);
    assert_eq!(above(Zdt::One), above(Zdt::Four));
    // The front of ZDT6 begins at 0.2807753191 and equals that of ZDT2 from there.
    let start: f64 = 0.280_775_319_1;
    let want = 1.1 * (1.1 - start) - (1.0 - start) + (1.0 - start.powi(3)) / 3.0;
    assert!((above(Zdt::Six) - want).abs() < 1e-4, "{} {want}", above(Zdt::Six));
}

#[test]
fn a_thousand_generations_are_rebuilt() {
    let config = Nsga2Config::new(Zdt::Four.bounds(), 2);
    let fresh = || Nsga2::new(config.clone(), 3).unwrap();
    let mut search = fresh();
    let mut record = Record::new(&mut search).unwrap();
    let mut asked = Vec::new();
    for generation in 0..1000 {
        if generation % 333 == 0 {
            asked.push((generation, search.ask().clone()));
        }
        let mut values = vec![0.0; 200];
        search.ask().iter().zip(values.chunks_mut(2)).for_each(|(genes, row)| Zdt::Four.judge(genes, row));
        let scores = Scores::new(search.score_shape(), values).unwrap();
        record.tell_scores(&mut search, &scores).unwrap();
    }
    for (generation, genomes) in asked {
        assert_eq!(record.genomes(&mut fresh(), generation).unwrap(), genomes);
    }
    let mut again = fresh();
    record.rebuild(&mut again, 1000).unwrap();
    assert_eq!(again, search);
    let members = Strategy::collection(&search).map(|collection| collection.members().len());
    assert!(members.is_some_and(|members| members > 0), "{members:?}");
}

#[test]
fn it_keeps_its_bits() {
    let got = configs().map(|config| {
        let mut search = Nsga2::new(config, 2002).unwrap();
        search.evolve(50, judge).unwrap();
        search.ask().digest()
    });
    let want = [0xf9c9_5956_94d7_b196, 0x7bbe_e0b8_2449_a8cd, 0xd8cc_935e_1f7c_e05c, 0x35c8_4a5f_df42_580d];
    assert_eq!(got, want, "{got:#018x?}");
}

#[test]
fn impossible_configurations_are_refused() {
    let refused = |change: &dyn Fn(&mut Nsga2Config)| {
        let mut config = Nsga2Config::new(vec![[0.0, 1.0]; 3], 2);
        change(&mut config);
        match Nsga2::new(config, 0).unwrap_err() {
            EvoError::OutOfRange { field, value, .. } => (field, value),
            other => panic!("{other}"),
        }
    };
    assert_eq!(refused(&|c| c.bounds[1] = [2.0, 1.0]), ("the high end of a gene", 1.0));
    assert_eq!(refused(&|c| c.objectives = 0), ("the number of objectives", 0.0));
    assert_eq!(refused(&|c| c.crossover_rate = -0.5), ("the crossover rate", -0.5));
    assert_eq!(refused(&|c| c.crossover_eta = 1001.0), ("eta of simulated binary crossover", 1001.0));
    assert_eq!(refused(&|c| c.mutation_rate = 1.5), ("the mutation rate", 1.5));
    assert_eq!(refused(&|c| c.mutation_eta = -1.0), ("eta of polynomial mutation", -1.0));
    let error = |config| Nsga2::new(config, 0).unwrap_err();
    let base = Nsga2Config::new(vec![[0.0, 1.0]; 3], 2);
    assert_eq!(error(Nsga2Config::new(Vec::new(), 2)), errors::no_genes());
    assert_eq!(error(Nsga2Config { population: 0, ..base.clone() }), errors::no_individuals());
    let many = Nsga2Config { objectives: usize::MAX, ..base };
    assert_eq!(error(many), errors::too_large(200, usize::MAX));
}

#[test]
fn a_damaged_state_is_refused() {
    let [config, ..] = configs();
    let mut search = Nsga2::new(config, 3).unwrap();
    (0..3).for_each(|_| search.tell_scores(&scores(&search)).unwrap());
    let (before, state) = (search.clone(), search.save());
    let (genes, objectives) = (4 + 4 * 8 * 12, 4 + 6 * 8 * 12);
    // A gene out of its bounds, a NaN objective, a gap between fronts, a future generation, an individual out of range,
    // a negative distance.
    let changes: [(usize, Vec<u8>); 6] = [
        (4, 7.0_f64.to_le_bytes().into()),
        (genes, vec![0xff; 8]),
        (objectives, 5_u32.to_le_bytes().into()),
        (objectives + 4, 3_u32.to_le_bytes().into()),
        (objectives + 8, 12_u32.to_le_bytes().into()),
        (objectives + 12, (-1.0_f64).to_le_bytes().into()),
    ];
    for (at, bytes) in changes {
        let mut damaged = state.clone();
        damaged[at..at + bytes.len()].copy_from_slice(&bytes);
        assert!(search.restore(&damaged).is_err(), "{at}");
        assert_eq!(search, before);
    }
    assert_eq!(search.restore(&[]), Err(errors::state_length(4, 0)));
    search.restore(&state).unwrap();
    assert_eq!(search, before);
}

#[test]
fn fitness_alone_is_refused() {
    let [two_objectives, _, one_objective, _] = configs();
    let mut search = Nsga2::new(two_objectives, 1).unwrap();
    let (expected, found) = (ScoreShape::new(2, 0), ScoreShape::FITNESS);
    assert_eq!(search.tell(&[Fitness::WORST; 12]), Err(errors::score_shape(expected, found)));
    // With one objective, plain fitness suffices.
    let mut search = Nsga2::new(one_objective, 1).unwrap();
    search.tell(&[Fitness::WORST; 12]).unwrap();
    assert_eq!(search.generation(), 1);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn no_parent_is_lost_to_a_worse_one(
        seed: u64,
        which in 0_usize..3,
        reported in proptest::collection::vec(proptest::num::f64::ANY, 8 * 45),
    ) {
        let config = configs()[which].clone();
        let (bounds, m, size) = (config.bounds.clone(), config.objectives, config.population);
        let mut search = Nsga2::new(config, seed).unwrap();
        for values in reported.chunks_exact(m * size).take(8) {
            let scores = Scores::nan_as_failed(search.score_shape(), values.to_vec()).unwrap();
            let before: Vec<Vec<f64>> = search.parents().map(|(_, objectives)| objectives.to_vec()).collect();
            search.tell_scores(&scores).unwrap();
            let after: Vec<Vec<f64>> = search.parents().map(|(_, objectives)| objectives.to_vec()).collect();
            prop_assert_eq!(after.len(), size);
            // Elitism: each parent survives, or dominates no survivor of the last front.
            for lost in before.iter().filter(|row| !after.contains(row)) {
                prop_assert!(!after.iter().any(|row| dominates(lost, row)));
            }
            for genes in search.ask() {
                prop_assert!(genes.iter().zip(&bounds).all(|(gene, [low, high])| low <= gene && gene <= high));
            }
        }
    }
}
