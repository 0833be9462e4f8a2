//! Coevolution with generalist selection, compared with a transcription of its source and on games.

use crate::errors;
use farsa_evo::coevolution::{GeneralistCoevolution, GeneralistConfig};
use farsa_evo::words::Mutation;
use farsa_evo::{EvoError, Fitness, RecordKind, ScoreShape, Scores, Snapshot, Strategy, check_strategy};
use farsa_num::{Domain, Stream};
use proptest::prelude::*;

fn configs() -> [GeneralistConfig; 5] {
    let small = GeneralistConfig { members: 6, newcomers: 3, opponents: 4, iterations: 3, ..GeneralistConfig::new(3) };
    [
        small,
        GeneralistConfig { newcomers: 1, opponents: 1, iterations: 1, mutation: Mutation::Flip, ..small },
        GeneralistConfig { newcomers: 6, opponents: 6, gene_bits: 5, mutation_rate: 0.3, ..small },
        GeneralistConfig { members: 1, newcomers: 1, opponents: 1, genes: 1, ..small },
        GeneralistConfig { opponents: 3, iterations: 2, mutation_rate: 0.0, ..small },
    ]
}

/// Reward of a genome against another in the generation. The game has no best player, and rewards are eighths, so that
/// sums are exact.
fn reward(generation: u32, side: usize, genes: &[u16], other: &[u16]) -> f64 {
    let [a, b] = [genes[0], other[genes.len() / 2]].map(u32::from);
    let roll = (a.wrapping_mul(2_654_435_761) ^ b.wrapping_mul(40_503).rotate_left(9)) >> 7;
    f64::from((roll + generation + side as u32 * 3) % 17) / 8.0
}

/// The source's algorithm for both populations, with its explicit loops.
struct Transcription {
    config: GeneralistConfig,
    seed: u64,
    generation: u32,
    /// Members and newcomers of each population.
    everyone: [Vec<Vec<u16>>; 2],
}

impl Transcription {
    fn new(config: GeneralistConfig, seed: u64) -> Self {
        let size = config.members + config.newcomers;
        let genome = |side: usize, index: usize| {
            let mut stream = Stream::new(seed, Domain::InitialGenome, side as u32, index as u32, 0);
            let mut genes = vec![0; config.genes];
            farsa_evo::words::randomize(&mut genes, &mut stream);
            genes.iter().map(|gene| gene >> (16 - config.gene_bits)).collect()
        };
        let everyone = [0, 1].map(|side| (0..size).map(|index| genome(side, index)).collect());
        Self { config, seed, generation: 0, everyone }
    }

    /// Runs a round. Calls `seen` with the individuals of both populations and with the opponents of each.
    fn round(&mut self, mut seen: impl FnMut(u32, [&[Vec<u16>]; 2], [Vec<Vec<u16>>; 2])) {
        let GeneralistConfig { members, newcomers, opponents, iterations, .. } = self.config;
        let size = members + newcomers;
        let mut matrix = [vec![vec![0.0; size]; size], vec![vec![0.0; size]; size]];
        let mut first = 0;
        while first < size {
            let columns: Vec<usize> = (first..first + opponents).map(|column| column % size).collect();
            let others = |side: usize| columns.iter().map(|&column| self.everyone[1 - side][column].clone()).collect();
            seen(self.generation, [&self.everyone[0], &self.everyone[1]], [others(0), others(1)]);
            for side in 0..2 {
                for index in 0..size {
                    for &column in columns.iter().take(size - first) {
                        let [a, b] = [&self.everyone[side][index], &self.everyone[1 - side][column]];
                        matrix[side][index][column] = reward(self.generation, side, a, b);
                    }
                }
            }
            first += opponents;
            self.generation += 1;
        }
        // The best individuals become members and take the worst places first.
        let mut places = [Vec::new(), Vec::new()];
        for side in 0..2 {
            let mean = |index: usize| matrix[side][index][..members].iter().sum::<f64>() / members as f64;
            let mut order: Vec<usize> = (0..size).collect();
            order.sort_by(|&a, &b| mean(b).total_cmp(&mean(a)).then(a.cmp(&b)));
            let going = order[members..].iter().rev().filter(|index| **index < members);
            let coming = order[..members].iter().rev().filter(|index| **index >= members);
            places[side] = (0..members).collect();
            going.zip(coming).for_each(|(&member, &newcomer)| places[side][member] = newcomer);
        }
        let mut trained = [Vec::new(), Vec::new()];
        let mut against = [Vec::new(), Vec::new()];
        for side in 0..2 {
            let mut stream = Stream::new(self.seed, Domain::Mutation, 2 + side as u32, 0, self.generation);
            let mut chosen = vec![stream.below(members as u32) as usize];
            let column =
                |other: usize| places[side].iter().map(|&index| matrix[side][index][other]).collect::<Vec<_>>();
            while chosen.len() < opponents {
                let apart = |other: usize| -> f64 {
                    let sums = chosen.iter().map(|&opponent| {
                        let [a, b] = [column(places[1 - side][other]), column(places[1 - side][opponent])];
                        a.iter().zip(&b).map(|(a, b)| (a - b).abs()).sum::<f64>()
                    });
                    sums.sum()
                };
                let mut next = None;
                for other in (0..members).filter(|other| !chosen.contains(other)) {
                    if next.is_none_or(|next| apart(other) > apart(next)) {
                        next = Some(other);
                    }
                }
                chosen.extend(next);
            }
            let genome = |side: usize, index: usize| self.everyone[side][places[side][index]].clone();
            against[side] = chosen.iter().map(|&other| genome(1 - side, other)).collect::<Vec<_>>();
            let mut order: Vec<usize> = (0..members).collect();
            for place in 0..newcomers {
                order.swap(place, place + stream.below((members - place) as u32) as usize);
                trained[side].push(genome(side, order[place]));
            }
        }
        let resting =
            [0, 1].map(|side| places[side].iter().map(|&index| self.everyone[side][index].clone()).collect::<Vec<_>>());
        let tried = size / newcomers;
        for _ in 0..iterations {
            let individuals = [0, 1].map(|side| {
                let candidate = |index: usize| {
                    let mut genes = trained[side][index / tried].clone();
                    if !index.is_multiple_of(tried) {
                        let mut stream =
                            Stream::new(self.seed, Domain::Mutation, side as u32, index as u32, self.generation);
                        let GeneralistConfig { mutation, mutation_rate, gene_bits, .. } = self.config;
                        let mutation = farsa_evo::words::BitMutation::new(mutation, mutation_rate).unwrap();
                        mutation.with_gene_bits(gene_bits).unwrap().apply(&mut genes, &mut stream);
                    }
                    genes
                };
                (0..size).map(candidate).collect::<Vec<Vec<u16>>>()
            });
            seen(self.generation, [&individuals[0], &individuals[1]], against.clone());
            for side in 0..2 {
                for newcomer in 0..newcomers {
                    let fitness = |genes: &Vec<u16>| -> f64 {
                        against[side].iter().map(|other| reward(self.generation, side, genes, other)).sum()
                    };
                    let mut best = &individuals[side][newcomer * tried];
                    for genes in &individuals[side][newcomer * tried..(newcomer + 1) * tried] {
                        if fitness(genes) > fitness(best) {
                            best = genes;
                        }
                    }
                    trained[side][newcomer].clone_from(best);
                }
            }
            self.generation += 1;
        }
        self.everyone = [0, 1].map(|side| [&resting[side][..], &trained[side][..]].concat());
    }
}

/// Returns the scores of a game: the total reward, and the reward against each opponent.
fn played(search: &GeneralistCoevolution, game: impl Fn(usize, &[u16], &[u16]) -> f64) -> Scores {
    let (opponents, size) = (search.opponents().unwrap(), search.config().size());
    let mut rows = Vec::new();
    for (individual, genes) in search.ask().iter().enumerate() {
        let met = (0..opponents.count()).map(|opponent| opponents.opponents_of(individual, opponent)[0]);
        let rewards: Vec<f64> = met.map(|other| game(individual / size, genes, other)).collect();
        rows.push(rewards.iter().sum());
        rows.extend(rewards);
    }
    Scores::new(search.score_shape(), rows).unwrap()
}

fn next(search: &mut GeneralistCoevolution) {
    let generation = search.generation();
    let scores = played(search, |side, genes, other| reward(generation, side, genes, other));
    search.tell_scores(&scores).unwrap();
}

#[test]
fn individuals_and_opponents_are_those_of_the_transcription() {
    for (config, seed) in configs().into_iter().zip(5..) {
        let mut search = GeneralistCoevolution::new(config, seed).unwrap();
        let mut plain = Transcription::new(config, seed);
        let size = config.size();
        for _ in 0..6 {
            plain.round(|generation, asked, met| {
                assert_eq!(search.generation(), generation);
                for side in 0..2 {
                    for index in 0..size {
                        let individual = side * size + index;
                        assert_eq!(
                            search.ask().get(individual).unwrap(),
                            asked[side][index],
                            "{index} of {generation}"
                        );
                        for (opponent, genes) in met[side].iter().enumerate() {
                            assert_eq!(search.opponents().unwrap().opponents_of(individual, opponent), [&genes[..]]);
                        }
                    }
                }
                next(&mut search);
            });
            for side in 0..2 {
                assert!(search.members(side).iter().eq(plain.everyone[side][..config.members].iter()));
            }
        }
        assert_eq!(search.generation(), 6 * config.round());
    }
}

#[test]
fn its_bits_stay() {
    let config = GeneralistConfig { genes: 40, members: 20, newcomers: 5, opponents: 7, ..configs()[0] };
    let mut search = GeneralistCoevolution::new(config, 11).unwrap();
    let mut digests = Vec::new();
    for generation in 0..60 {
        if generation % 20 == 19 {
            digests.push(search.ask().digest());
        }
        next(&mut search);
    }
    assert_eq!(digests, [0x876a_718a_9d7a_2744, 0x58b8_121a_d6d9_8bac, 0x3dac_e7d9_7921_7f99]);
}

#[test]
fn it_conforms() {
    for config in configs() {
        check_strategy(|| GeneralistCoevolution::new(config, 7), 40).unwrap();
    }
    let config = configs()[0];
    let mut search = GeneralistCoevolution::new(config, 7).unwrap();
    assert_eq!((search.populations(), search.record_kind()), (2, RecordKind::Values));
    assert_eq!(search.score_shape(), ScoreShape::new(5, 0));
    let expected = search.score_shape();
    let refused = Err(errors::score_shape(expected, ScoreShape::FITNESS));
    assert_eq!(search.tell(&[Fitness::WORST; 18]), refused);
}

#[test]
fn the_best_of_all_encounters_is_the_champion() {
    let config = configs()[0];
    let (mut search, size) = (GeneralistCoevolution::new(config, 3).unwrap(), config.size());
    let mut sums = vec![0.0; 2 * size];
    assert_eq!(search.diagnostics(), [0.0; 4], "nothing was replaced yet");
    for generation in 0..config.encounters() {
        let fitness = played(&search, |side, genes, other| reward(generation, side, genes, other)).fitness();
        sums.iter_mut().zip(&fitness).for_each(|(sum, fitness)| *sum += fitness.get());
        let ranked_by = search.ranked_by(&fitness);
        for (ranked_by, sum) in ranked_by.iter().zip(&sums) {
            assert_eq!(ranked_by.get(), sum / f64::from(generation + 1));
        }
        for (side, best) in search.champions(&ranked_by).into_iter().enumerate() {
            assert!(best / size == side && sums[side * size..(side + 1) * size].iter().all(|sum| sums[best] >= *sum));
        }
        next(&mut search);
    }
    let fitness: Vec<Fitness> = (0..2 * size).map(|i| Fitness::nan_as_failed(i as f64)).collect();
    assert!(search.is_training() && search.ranked_by(&fitness) == fitness);
}

#[test]
fn parents_are_the_copied_individuals() {
    for config in configs() {
        let config = GeneralistConfig { mutation_rate: 0.0, ..config };
        let mut search = GeneralistCoevolution::new(config, 9).unwrap();
        let mut before = search.ask().clone();
        for generation in 0..3 * config.round() {
            for individual in 0..2 * config.size() {
                let parents = search.parents_of_all(individual);
                let rests = generation % config.round() == 0 && individual % config.size() < config.members;
                assert_eq!(parents.len(), usize::from(generation > 0 && !rests), "{individual} of {generation}");
                for parent in parents {
                    assert_eq!(parent / config.size(), individual / config.size());
                    assert_eq!(before.get(parent), search.ask().get(individual));
                }
            }
            assert!(search.parents_of_all(2 * config.size()).is_empty());
            before = search.ask().clone();
            next(&mut search);
        }
    }
}

trait Parents {
    fn parents_of_all(&self, individual: usize) -> Vec<usize>;
}

impl Parents for GeneralistCoevolution {
    fn parents_of_all(&self, individual: usize) -> Vec<usize> {
        self.genealogy().unwrap().parents_of(individual)
    }
}

#[test]
fn impossible_configurations_are_refused_with_their_numbers() {
    let refused = |change: fn(&mut GeneralistConfig)| {
        let mut config = GeneralistConfig::new(4);
        change(&mut config);
        GeneralistCoevolution::new(config, 1).unwrap_err()
    };
    let setting = |error| match error {
        EvoError::OutOfRange { field, value, .. } => (field, value),
        other => panic!("{other}"),
    };
    assert_eq!(refused(|c| c.genes = 0), errors::no_genes());
    assert_eq!(refused(|c| c.members = 0), errors::no_individuals());
    assert_eq!(setting(refused(|c| c.newcomers = 0)), ("the number of newcomers", 0.0));
    assert_eq!(setting(refused(|c| c.newcomers = 7)), ("the number of newcomers", 7.0));
    assert_eq!(setting(refused(|c| c.newcomers = 160)), ("the number of newcomers", 160.0));
    assert_eq!(setting(refused(|c| c.opponents = 0)), ("the number of opponents", 0.0));
    assert_eq!(setting(refused(|c| c.opponents = 81)), ("the number of opponents", 81.0));
    assert_eq!(setting(refused(|c| c.iterations = 0)), ("the generations of training", 0.0));
    assert_eq!(refused(|c| c.gene_bits = 17), errors::gene_bits(17));
    assert_eq!(refused(|c| c.mutation_rate = -0.5), errors::rate(-0.5));
    assert!(matches!(refused(|c| c.mutation_rate = f64::NAN), EvoError::Config { field: "mutation_rate", .. }));
    let many = errors::too_large(40_000, 20_000);
    assert_eq!(refused(|c| [c.members, c.newcomers] = [10_000; 2]), many);
    assert!(matches!(refused(|c| c.members = usize::MAX), EvoError::Config { field: "population", .. }));
}

#[test]
fn damaged_states_are_refused_and_change_nothing() {
    for config in configs() {
        let mut search = GeneralistCoevolution::new(config, 4).unwrap();
        for generation in 0..2 * config.round() + 2 {
            let (before, state) = (search.clone(), search.save());
            let mut other = GeneralistCoevolution::new(config, 4).unwrap();
            other.restore(&state).unwrap();
            assert_eq!(other, before, "{generation}");
            for length in (0..state.len()).step_by(5) {
                assert!(search.restore(&state[..length]).is_err() && search == before);
            }
            assert!(search.restore(&[&state[..], &[0]].concat()).is_err() && search == before);
            next(&mut search);
        }
        // An origin of the other population, a NaN fitness, a gene with too many bits.
        let at = 4 + 4 * config.genes * config.size();
        while search.generation() % config.round() != config.encounters() {
            next(&mut search);
        }
        let (before, state) = (search.clone(), search.save());
        for (place, bytes) in
            [(at, f64::NAN.to_le_bytes().to_vec()), (at + 16, (config.size() as u32).to_le_bytes().to_vec())]
        {
            let mut bent = state.clone();
            bent[place..place + bytes.len()].copy_from_slice(&bytes);
            assert!(search.restore(&bent).is_err(), "{place}");
            assert_eq!(search, before);
        }
        if config.gene_bits < 16 {
            let bent = [&state[..5], &[0xff], &state[6..]].concat();
            assert_eq!(search.restore(&bent).unwrap_err(), {
                let bits = u64::from(u16::from_le_bytes([state[4], 0xff]));
                errors::state_content("a gene", bits)
            });
        }
    }
}

proptest! {
    /// A search that continues from a saved state equals the uninterrupted one, with any failures.
    #[test]
    fn a_search_continues_from_its_state(seed: u64, failing in 0_u32..8, rounds in 1_u32..3) {
        let config = configs()[0];
        let mut search = GeneralistCoevolution::new(config, seed).unwrap();
        let mut again = GeneralistCoevolution::new(config, seed).unwrap();
        for generation in 0..rounds * config.round() {
            let game = |side: usize, genes: &[u16], other: &[u16]| {
                let fails = u32::from(genes[0] ^ other[0]) % 16 < failing;
                if fails { f64::NEG_INFINITY } else { reward(generation, side, genes, other) }
            };
            let scores = played(&search, game);
            search.tell_scores(&scores).unwrap();
            let mut other = GeneralistCoevolution::new(config, seed).unwrap();
            other.restore(&again.save()).unwrap();
            other.tell_scores(&scores).unwrap();
            again = other;
            prop_assert_eq!(&search, &again);
        }
    }
}

/// Rock, paper, scissors in one gene outweighs the number of ones in the other. The right kind wins with any strength, and
/// no kind is best. Strength grows nevertheless, from about 8 of 16 bits in a random genome.
#[test]
fn members_become_better_against_all() {
    let small = GeneralistConfig { mutation_rate: 0.06, ..GeneralistConfig::new(2) };
    let config = GeneralistConfig { members: 12, newcomers: 4, opponents: 4, iterations: 5, ..small };
    let strength = |genes: &[u16]| f64::from(genes[0].count_ones());
    let game = |_: usize, genes: &[u16], other: &[u16]| {
        let kind = [0.0, 20.0, -20.0][usize::from((genes[1] % 3 + 3 - other[1] % 3) % 3)];
        kind + strength(genes) - strength(other)
    };
    for seed in 0..5 {
        let mut search = GeneralistCoevolution::new(config, seed).unwrap();
        for _ in 0..60 * config.round() {
            let scores = played(&search, game);
            search.tell_scores(&scores).unwrap();
        }
        for side in 0..2 {
            let least = search.members(side).iter().map(strength).fold(16.0, f64::min);
            assert!(least >= 12.0, "{least} of population {side}, seed {seed}");
        }
    }
}
