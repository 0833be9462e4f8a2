//! MAP-Elites and CMA-ME, compared with a transcription, on the arm and by digests.

use std::collections::BTreeMap;

use crate::errors;
use farsa_evo::archives::{Addition, Archive, Cells, CvtCells, Emitter, GridCells, MapElites, MapElitesConfig};
use farsa_evo::covariance::{CmaEs, CmaEsConfig};
use farsa_evo::{EvoError, Fitness, Record, ScoreShape, Scores, Snapshot, Strategy, check_strategy};
use farsa_num::{Domain, Stream};
use proptest::prelude::*;

#[path = "../../examples/arm/planar_arm.rs"]
mod planar_arm;
use planar_arm::{ANGLES, JOINTS, PLACES, judge};

const BOUNDS: [[f64; 2]; 3] = [[-5.0, 5.0], [0.0, 1.0], [-1.0, 3.0]];

fn grid() -> GridCells {
    GridCells::new(vec![[-3.0, 5.0], [-3.0, 5.0]], vec![6, 5]).unwrap()
}

/// Each emitter alone, and all together.
fn configs() -> [MapElitesConfig; 4] {
    let gaussian = Emitter::Gaussian { batch: 9, sigma: 0.1 };
    let line = Emitter::IsoLine { batch: 10, iso_sigma: 0.02, line_sigma: 0.3 };
    let improvement = Emitter::Improvement { batch: 8, mean: vec![0.5; 3], sigma: 0.4 };
    let config = |emitters| MapElitesConfig { bounds: BOUNDS.to_vec(), emitters };
    [
        config(vec![gaussian.clone()]),
        config(vec![line.clone()]),
        config(vec![improvement.clone(); 2]),
        config(vec![gaussian, improvement, line]),
    ]
}

/// A cost, and measures that often change. One evaluation in eleven fails.
fn plain(genes: &[f64], row: &mut [f64]) {
    let sum: f64 = genes.iter().sum();
    let cost = if sum.to_bits().is_multiple_of(11) { f64::NAN } else { genes[0] * genes[0] + (genes[1] - 0.3).abs() };
    row.copy_from_slice(&[-cost, sum, genes[2] - genes[0]]);
}

fn scores<C: Cells + Clone>(search: &MapElites<C>) -> Scores {
    let mut values = vec![0.0; 3 * search.ask().len()];
    search.ask().iter().zip(values.chunks_mut(3)).for_each(|(genes, row)| plain(genes, row));
    Scores::nan_as_failed(search.score_shape(), values).unwrap()
}

#[test]
fn it_conforms() {
    let cells = CvtCells::new(40, &[[-3.0, 5.0]; 2], 400, 3).unwrap();
    for config in configs() {
        check_strategy(|| MapElites::new(config.clone(), grid(), 7), 30).unwrap();
        check_strategy(|| MapElites::new(config.clone(), cells.clone(), 7), 30).unwrap();
    }
}

/// An elite of the transcription: genes and objective.
type Naive = (Vec<f64>, f64, [u32; 2]);

fn mirrored(mut x: f64, [low, high]: [f64; 2]) -> f64 {
    while !(low..=high).contains(&x) {
        x = if x < low { 2.0 * low - x } else { 2.0 * high - x };
    }
    x
}

/// Both variation emitters, by the formulas of their sources.
#[test]
fn generations_are_those_of_a_transcription() {
    for which in [0, 1] {
        let config = configs()[which].clone();
        let mut search = MapElites::new(config.clone(), grid(), 11).unwrap();
        let (mut elites, mut order): (BTreeMap<usize, Naive>, Vec<usize>) = (BTreeMap::new(), Vec::new());
        for generation in 0..25 {
            let scores = scores(&search);
            for (i, genes) in search.ask().iter().enumerate() {
                let objective = scores.objectives(i)[0];
                let place = |x: f64, parts: f64| ((x + 3.0) / 8.0 * parts).floor().clamp(0.0, parts - 1.0) as usize;
                let cell = place(scores.measures(i)[0], 6.0) * 5 + place(scores.measures(i)[1], 5.0);
                let better = elites.get(&cell).is_none_or(|elite| objective > elite.1);
                if !scores.is_failed(i) && better {
                    if !elites.contains_key(&cell) {
                        order.push(cell);
                    }
                    elites.insert(cell, (genes.to_vec(), objective, [generation, i as u32]));
                }
            }
            search.tell_scores(&scores).unwrap();
            let archive = search.archive();
            assert!(archive.elites().map(|elite| elite.cell).eq(order.iter().copied()));
            let [count, sum] = search.diagnostics()[..] else { panic!("says two numbers") };
            let total: f64 = elites.values().map(|elite| elite.1).sum();
            assert!(count == elites.len() as f64 && (sum - total).abs() <= 1e-12 * total.abs(), "{sum} {total}");
            for (cell, (genes, objective, [born, individual])) in &elites {
                let elite = archive.elite(*cell).unwrap();
                assert_eq!((elite.genes, elite.objective), (&genes[..], *objective));
                assert_eq!((elite.generation, elite.individual as u32), (*born, *individual));
            }
            for (i, genes) in search.ask().iter().enumerate() {
                let stream = &mut Stream::new(11, Domain::Mutation, 0, i as u32, generation + 1);
                let draw = |stream: &mut Stream| elites[&order[stream.below(order.len() as u32) as usize]].clone();
                let (first, mut normal) = (draw(stream), vec![0.0; 3]);
                let (sigma, second, along) = match config.emitters[0] {
                    Emitter::Gaussian { sigma, .. } => (sigma, first.clone(), 0.0),
                    Emitter::IsoLine { iso_sigma, line_sigma, .. } => {
                        let second = draw(stream);
                        (iso_sigma, second, line_sigma * stream.normal_pair_f64()[0])
                    }
                    Emitter::Improvement { .. } => unreachable!(),
                };
                stream.fill_normal(&mut normal);
                for gene in 0..3 {
                    let (gene_1, gene_2, [low, high]) = (first.0[gene], second.0[gene], BOUNDS[gene]);
                    let want = mirrored(
                        gene_1 + sigma * (high - low) * normal[gene] + along * (gene_2 - gene_1),
                        BOUNDS[gene],
                    );
                    assert!((genes[gene] - want).abs() <= 1e-12, "{generation} {i}: {} {want}", genes[gene]);
                }
                let mut named: Vec<usize> = [first.2, second.2]
                    .into_iter()
                    .take(1 + which)
                    .filter_map(|[born, individual]| (born == generation).then_some(individual as usize))
                    .collect();
                named.dedup();
                assert_eq!(search.genealogy().unwrap().parents_of(i), named);
            }
        }
        assert!(order.len() > 10, "{which}: {order:?}");
    }
}

/// The improvement emitter equals CMA-ES without negative weights if the better half always fills empty cells.
#[test]
fn an_improvement_emitter_whose_better_half_improves_is_cma_es() {
    let mean = vec![0.0; 4];
    let config = MapElitesConfig {
        bounds: vec![[-1e6, 1e6]; 4],
        emitters: vec![Emitter::Improvement { batch: 12, mean: mean.clone(), sigma: 0.5 }],
    };
    let cells = GridCells::new(vec![[0.0, 1000.0]], vec![1000]).unwrap();
    let mut search = MapElites::new(config, cells, 5).unwrap();
    let alone = CmaEsConfig { population: 12, active: false, ..CmaEsConfig::new(mean, 0.5) };
    let mut alone = CmaEs::new(alone, 5).unwrap();
    for generation in 0..20_u32 {
        assert_eq!(search.ask(), alone.ask(), "{generation}");
        let cost =
            |genes: &[f64]| -genes.iter().zip(1..).map(|(x, i)| f64::from(i) * (x - 3.0) * (x - 3.0)).sum::<f64>();
        let values: Vec<f64> = search.ask().iter().map(cost).collect();
        let mut sorted = values.clone();
        sorted.sort_by(|a, b| b.total_cmp(a));
        // The better half fills empty cells, and the evaluations of the rest fail.
        let row = |(i, value): (u32, &f64)| {
            let objective = if *value >= sorted[5] { *value } else { f64::NAN };
            [objective, f64::from(12 * generation + i)]
        };
        let rows: Vec<f64> = (0..).zip(&values).flat_map(row).collect();
        search.tell_scores(&Scores::nan_as_failed(search.score_shape(), rows).unwrap()).unwrap();
        alone.tell_values(&values).unwrap();
    }
}

#[test]
fn an_improvement_emitter_without_improvement_restarts_from_an_elite() {
    let [_, _, config, _] = configs();
    let mut search = MapElites::new(config, grid(), 3).unwrap();
    // The archive is still empty, so that the emitter restarts from its own mean.
    let failed = vec![f64::NAN; 3 * 16];
    let failed = Scores::nan_as_failed(search.score_shape(), failed).unwrap();
    search.tell_scores(&failed).unwrap();
    let near = |search: &MapElites<GridCells>, centre: &[f64]| {
        let far = |(x, centre): (&f64, &f64)| (x - centre).abs() > 4.0 * 0.4;
        search.ask().iter().filter(|genes| !genes.iter().zip(centre).any(far)).count()
    };
    assert!(search.archive().is_empty() && near(&search, &[0.5; 3]) == 16);
    // After one elite without further improvement it restarts from that elite.
    let mut rows = vec![f64::NAN; 3 * 16];
    rows[..3].copy_from_slice(&[1.0, 0.0, 0.0]);
    let elite = search.ask().get(0).unwrap().to_vec();
    search.tell_scores(&Scores::nan_as_failed(search.score_shape(), rows).unwrap()).unwrap();
    search.tell_scores(&failed).unwrap();
    assert_eq!((search.archive().len(), near(&search, &elite)), (1, 16));
}

/// A tenth of the cells and a seventh of the evaluations of the example `arm`, which has 10 000 cells.
#[test]
fn cma_me_fills_the_arms_cells() {
    let cells = CvtCells::new(1000, &PLACES, 10_000, 1).unwrap();
    let config = MapElitesConfig::cma_me(vec![ANGLES; JOINTS], 5, 30, 0.1);
    let mut search = MapElites::new(config, cells, 1).unwrap();
    search.evolve(100, judge).unwrap();
    // The reachable disk is 78.5 % of its square, and cells at its edge count as reachable.
    assert!((750..850).contains(&search.archive().len()), "{}", search.archive().len());
    let mean = search.archive().sum() / search.archive().len() as f64;
    assert!(mean > -0.3, "{mean}");
    for elite in search.archive().elites() {
        let mut row = [0.0; 3];
        judge(elite.genes, &mut row);
        assert_eq!((elite.objective, elite.measures), (row[0], &row[1..]));
        assert_eq!(search.archive().cells().cell(elite.measures), elite.cell);
    }
}

#[test]
fn a_thousand_generations_are_rebuilt() {
    let config = MapElitesConfig::cma_me(vec![ANGLES; JOINTS], 4, 25, 0.1);
    let fresh = || MapElites::new(config.clone(), GridCells::new(PLACES.to_vec(), vec![30, 30]).unwrap(), 3).unwrap();
    let mut search = fresh();
    let mut record = Record::new(&mut search).unwrap();
    let mut asked = Vec::new();
    for generation in 0..1000 {
        if generation % 333 == 0 {
            asked.push((generation, search.ask().clone()));
        }
        let mut values = vec![0.0; 300];
        search.ask().iter().zip(values.chunks_mut(3)).for_each(|(genes, row)| judge(genes, row));
        let scores = Scores::new(search.score_shape(), values).unwrap();
        record.tell_scores(&mut search, &scores).unwrap();
    }
    for (generation, genomes) in asked {
        assert_eq!(record.genomes(&mut fresh(), generation).unwrap(), genomes);
    }
    let mut again = fresh();
    record.rebuild(&mut again, 1000).unwrap();
    assert_eq!(again, search);
}

#[test]
fn it_keeps_its_bits() {
    let cells = CvtCells::new(40, &[[-3.0, 5.0]; 2], 400, 3).unwrap();
    let got = configs().map(|config| {
        let mut search = MapElites::new(config, cells.clone(), 2015).unwrap();
        search.evolve(50, plain).unwrap();
        search.ask().digest()
    });
    let want = [0xdf8e_dad7_360f_a700, 0xd8be_db41_1681_ae44, 0x511e_1ded_431d_cbd3, 0x3cc2_6879_ee6b_99db];
    assert_eq!(got, want, "{got:#018x?}");
}

#[test]
fn impossible_configurations_are_refused() {
    let error = |config: MapElitesConfig| MapElites::new(config, grid(), 0).unwrap_err();
    let refused = |emitter: Emitter| match error(MapElitesConfig { bounds: BOUNDS.to_vec(), emitters: vec![emitter] }) {
        EvoError::OutOfRange { field, value, .. } => (field, value),
        other => panic!("{other}"),
    };
    assert_eq!(refused(Emitter::Gaussian { batch: 5, sigma: 1.5 }), ("sigma of the Gaussian emitter", 1.5));
    let line = |iso_sigma, line_sigma| Emitter::IsoLine { batch: 5, iso_sigma, line_sigma };
    assert_eq!(refused(line(-0.1, 0.2)), ("iso_sigma of the iso-line emitter", -0.1));
    assert_eq!(refused(line(0.1, 11.0)), ("line_sigma of the iso-line emitter", 11.0));
    let improvement = |batch, mean: &[f64], sigma| Emitter::Improvement { batch, mean: mean.to_vec(), sigma };
    assert_eq!(refused(improvement(1, &[0.5; 3], 0.1)), ("the batch of an emitter", 1.0));
    assert_eq!(refused(improvement(5, &[0.5; 2], 0.1)), ("the number of genes of a mean", 2.0));
    assert_eq!(refused(improvement(5, &[0.5, 2.0, 0.5], 0.1)), ("the mean of an emitter", 2.0));
    assert_eq!(refused(improvement(5, &[0.5; 3], 0.0)), ("sigma of the improvement emitter", 0.0));
    let gaussian = || Emitter::Gaussian { batch: 5, sigma: 0.1 };
    let none = MapElitesConfig { bounds: BOUNDS.to_vec(), emitters: Vec::new() };
    assert_eq!(error(none), errors::no_individuals());
    assert_eq!(error(MapElitesConfig { bounds: Vec::new(), emitters: vec![gaussian()] }), errors::no_genes());
    let frozen = MapElitesConfig { bounds: vec![[1.0; 2]], emitters: vec![improvement(5, &[1.0], 0.1)] };
    assert!(matches!(error(frozen), EvoError::OutOfRange { field: "the high end of a gene", value: 1.0, .. }));
    let many = GridCells::new(vec![[0.0, 1.0]; 2], vec![1 << 14, 1 << 14]).unwrap();
    let error = MapElites::new(MapElitesConfig::new(BOUNDS.to_vec()), many, 0).unwrap_err();
    assert_eq!(error, errors::too_large(1 << 28, 3));
    let mut search = MapElites::new(MapElitesConfig::new(BOUNDS.to_vec()), grid(), 1).unwrap();
    let (expected, found) = (ScoreShape::new(1, 2), ScoreShape::FITNESS);
    assert_eq!(search.tell(&[Fitness::WORST; 100]), Err(errors::score_shape(expected, found)));
    let mut archive = Archive::new(grid(), 3).unwrap();
    let lengths = |genes, ranges| Err(errors::lengths(genes, ranges, ranges));
    assert_eq!(archive.add(&[0.0; 2], 1.0, &[0.0; 2]), lengths(2, 3));
    assert_eq!(archive.add(&[0.0; 3], 1.0, &[0.0; 3]), lengths(3, 2));
    assert_eq!(archive.add(&[0.0; 3], f64::NAN, &[0.0; 2]), Ok(Addition::None));
    assert_eq!(archive.add(&[0.0; 3], 1.0, &[0.0, f64::INFINITY]), Ok(Addition::None));
}

#[test]
fn a_damaged_state_is_refused() {
    let [.., config] = configs();
    let mut search = MapElites::new(config, grid(), 3).unwrap();
    (0..5).for_each(|_| search.tell_scores(&scores(&search)).unwrap());
    let (before, state) = (search.clone(), search.save());
    let elites = search.archive().len();
    let first = 8;
    // The state lists an additional elite in every other cell.
    let empty = search.archive().cells().cells() - elites;
    assert_eq!(search.largest_state(), state.len() + empty * (12 + 8 * 6));
    let last = first + (elites - 1) * (12 + 8 * 6);
    // The number of elites, the wrong cell for its measures, a failed objective, a gene out of its bounds, a zero step
    // size.
    let changes: [(usize, Vec<u8>); 6] = [
        (4, (elites as u32 + 1).to_le_bytes().into()),
        (first, 77_u32.to_le_bytes().into()),
        (first + 12, f64::NEG_INFINITY.to_le_bytes().into()),
        (first + 36, 7.0_f64.to_le_bytes().into()),
        (last, state[first..first + 60].into()),
        (last + 60 + 4, vec![0; 8]),
    ];
    for (at, bytes) in changes {
        let mut damaged = state.clone();
        damaged[at..at + bytes.len()].copy_from_slice(&bytes);
        assert!(search.restore(&damaged).is_err(), "{at}");
        assert_eq!(search, before);
    }
    assert_eq!(search.restore(&[0; 4]), Err(errors::state_length(8, 4)));
    search.restore(&state).unwrap();
    assert_eq!(search, before);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn genes_stay_within_bounds_and_elites_never_fall(
        seed: u64,
        which in 0_usize..4,
        sigma in 1e-3_f64..1e6,
        reported in proptest::collection::vec(proptest::num::f64::NORMAL | proptest::num::f64::INFINITE, 10 * 81),
    ) {
        let mut config = configs()[which].clone();
        for emitter in &mut config.emitters {
            if let Emitter::Improvement { sigma: step, .. } = emitter {
                *step = sigma;
            }
        }
        let mut search = MapElites::new(config, grid(), seed).unwrap();
        for values in reported.chunks_exact(3 * search.ask().len()).take(10) {
            let scores = Scores::nan_as_failed(search.score_shape(), values.to_vec()).unwrap();
            let before = search.archive().clone();
            search.tell_scores(&scores).unwrap();
            for elite in before.elites() {
                prop_assert!(search.archive().elite(elite.cell).is_some_and(|now| now.objective >= elite.objective));
            }
            for genes in search.ask() {
                prop_assert!(genes.iter().zip(&BOUNDS).all(|(gene, [low, high])| low <= gene && gene <= high));
            }
        }
    }
}
