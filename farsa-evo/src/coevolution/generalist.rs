//! Competitive co-evolution in which a variation stays that is good against all, not against some.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::{Domain, Stream};

use crate::coevolution::generalist_config::GeneralistConfig;
use crate::coevolution::outcomes::{Outcomes, Replacement};
use crate::error::EvoError;
use crate::fitness::Fitness;
use crate::population::Population;
use crate::score_shape::ScoreShape;
use crate::scores::Scores;
use crate::snapshot::{Snapshot, StateReader, largest, push_genes, push_reals};
use crate::statistics::Statistics;
use crate::strategy::Opponents;
use crate::strategy::{Genealogy, Strategy, next_scored};
use crate::words::mutation::{BitMutation, randomize_bits};

/// The populations.
const SIDES: usize = 2;
/// The trial of the streams that choose opponents and newcomers, plus the number of the population. Mutation uses that
/// number alone.
const CHOICE: u32 = SIDES as u32;

/// Competitive co-evolution of two populations with the generalist selection of Simione and Nolfi. A trained individual
/// stays only if it is better against all opponents.
///
/// A round has two phases. In the *encounters* each member and newcomer is evaluated against all of the other population, m
/// opponents in a generation. The members of the next phase are those with the highest mean against all members of the
/// other population ([`Outcomes::replacements`]).
///
/// In the *training*, copies of randomly drawn members become newcomers and evolve for some generations. Their opponents
/// are m members of the other population that differ most ([`Outcomes::differing_opponents`]). In each generation a
/// newcomer is evaluated with mutated copies, and the best of them replaces it, the lowest index among equals. Members rest
/// meanwhile. Generation 0 begins with encounters of random genomes.
///
/// [`Opponents`] returns the opponents of each individual. Scores have 1 + m objectives ([`Strategy::score_shape`]), the
/// fitness of all trials and the fitness against each opponent. If m does not divide the encounters, their last generation
/// repeats the first opponents, which counts for the fitness alone.
///
/// Individuals are ranked by fitness, during encounters by its mean over their generations so far. The champion of the last
/// generation of encounters, [`encounters`] - 1 of a round, is therefore the best against all. The champion of a generation
/// of training is the best against m.
///
/// With M members and E newcomers, a generation is M and then E individuals of each population, in training M / E + 1 for
/// each newcomer. Individual `i` of population `p` draws from the stream (seed, [`Domain::InitialGenome`], trial `p`, `i`,
/// 0). Its mutation in generation `g` draws from (seed, [`Domain::Mutation`], trial `p`, `i`, `g`). Opponents and then
/// newcomers draw from (seed, [`Domain::Mutation`], trial `p` + 2, 0, `g`).
///
/// Source: \[Simione2020\], by its program `generalist.py`. Deviations: both populations evolve at once, where the source
/// alternates. Members are evaluated again in every round, because trials differ, where the source keeps outcomes. Each
/// side has its own outcome, where in the source one side has 1 less the other's. Newcomers evolve by selection and
/// mutation of integer genes, where the source uses a natural evolution strategy with Adam. Opponents are chosen after the
/// selection of both populations. For ties and failures see [`Outcomes`].
///
/// [`encounters`]: GeneralistConfig::encounters
///
/// ```
/// use farsa_evo::{Opponents, Strategy};
/// use farsa_evo::coevolution::{GeneralistCoevolution, GeneralistConfig};
///
/// // The side with more ones in a genome wins.
/// let ones = |genes: &[u16]| f64::from(genes[0].count_ones());
/// let config = GeneralistConfig { members: 6, newcomers: 2, opponents: 4, iterations: 3, ..GeneralistConfig::new(1) };
/// let mut search = GeneralistCoevolution::new(config, 1)?;
/// for _ in 0..60 * config.round() {
///     let opponents = search.opponents().expect("it says whom each meets");
///     let mut rows = Vec::new();
///     for (individual, genes) in search.ask().iter().enumerate() {
///         let earned: Vec<f64> = (0..4).map(|of| ones(genes) - ones(opponents.opponents_of(individual, of)[0])).collect();
///         rows.push(earned.iter().sum::<f64>() / 4.0);
///         rows.extend(earned);
///     }
///     search.tell_scores(&farsa_evo::Scores::new(search.score_shape(), rows)?)?;
/// }
/// assert!((0..2).all(|side| search.members(side).iter().all(|genes| ones(genes) == 16.0)));
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct GeneralistCoevolution {
    config: GeneralistConfig,
    mutation: BitMutation,
    seed: u64,
    generation: u32,
    sides: [Side; SIDES],
    population: Population,
}

/// The state of a population except its genomes.
#[derive(Clone, Debug, PartialEq)]
struct Side {
    members: Population,
    /// The opponents of its newcomers, members of the other population [opponents x genes]. Zeros in encounters.
    opponents: Population,
    /// The outcomes against the individuals of the other population [size x size]. Zeros beyond the encounters so far and
    /// in training.
    outcomes: Vec<Fitness>,
    /// The sums of fitness over the encounters so far \[size\], zeros in training.
    sums: Vec<Fitness>,
    /// The individual of the previous generation from which each newcomer derives \[newcomers\]. Zeros where there was
    /// none.
    origins: Vec<u32>,
    /// Members that the latest encounters replaced, and the mean that members earned in them against members.
    selected: [Fitness; 2],
}

const NOTHING: Fitness = Fitness::nan_as_failed(0.0);

impl Side {
    fn new(config: &GeneralistConfig, population: &Population, side: usize) -> Result<Self, EvoError> {
        let size = config.size();
        let mut members = Population::new(config.members, config.genes)?;
        let own = population.iter().skip(side * size);
        members.iter_mut().zip(own).for_each(|(genes, own)| genes.copy_from_slice(own));
        Ok(Self {
            members,
            opponents: Population::new(config.opponents, config.genes)?,
            outcomes: vec![NOTHING; size * size],
            sums: vec![NOTHING; size],
            origins: vec![0; config.newcomers],
            selected: [NOTHING; 2],
        })
    }
}

impl GeneralistCoevolution {
    /// Creates a new co-evolution with a random initial generation.
    ///
    /// # Errors
    /// Returns the errors of [`GeneralistConfig::validate`].
    pub fn new(config: GeneralistConfig, seed: u64) -> Result<Self, EvoError> {
        config.validate()?;
        let (mutation, size) = (config.bit_mutation()?, config.size());
        let mut population = Population::new(SIDES * size, config.genes)?;
        for (individual, genes) in population.iter_mut().enumerate() {
            let (side, own) = ((individual / size) as u32, (individual % size) as u32);
            let mut stream = Stream::new(seed, Domain::InitialGenome, side, own, 0);
            randomize_bits(genes, config.gene_bits, &mut stream);
        }
        let sides = [Side::new(&config, &population, 0)?, Side::new(&config, &population, 1)?];
        Ok(Self { config, mutation, seed, generation: 0, sides, population })
    }

    /// Gets the configuration that this search was created with.
    pub fn config(&self) -> &GeneralistConfig {
        &self.config
    }

    /// Gets the seed that this search was created with.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// Gets the genomes of the members of a population [members x genes]. Use 0 for the first population and any other
    /// number for the second.
    pub fn members(&self, population: usize) -> &Population {
        let [first, second] = &self.sides;
        if population == 0 { &first.members } else { &second.members }
    }

    /// Checks whether the current generation belongs to the training phase.
    pub fn is_training(&self) -> bool {
        self.place() >= self.config.encounters()
    }

    /// The number of the current generation within its round.
    fn place(&self) -> u32 {
        self.generation % self.config.round()
    }

    /// Columns of outcomes from before a generation, 0 in training.
    fn known(&self, generation: u32) -> usize {
        let place = generation % self.config.round();
        let known = (place as usize).saturating_mul(self.config.opponents).min(self.config.size());
        if place < self.config.encounters() { known } else { 0 }
    }

    /// Bytes of a state at a generation.
    fn state_length(&self, generation: u32) -> usize {
        let GeneralistConfig { genes, members, newcomers, opponents, .. } = self.config;
        let (size, encounters) = (self.config.size(), self.config.encounters());
        let selected = if generation < encounters { 0 } else { 16 + 4 * newcomers };
        let phase = if generation % self.config.round() < encounters {
            8 * size * (1 + self.known(generation))
        } else {
            2 * genes * (members + opponents)
        };
        4 + SIDES * (2 * size * genes + selected + phase)
    }

    /// Keeps what was earned in a generation of encounters.
    fn keep(&mut self, scores: &Scores) {
        let (size, m) = (self.config.size(), self.config.opponents);
        let first = self.place() as usize * m;
        for (number, side) in self.sides.iter_mut().enumerate() {
            for (own, (row, sum)) in side.outcomes.chunks_exact_mut(size).zip(&mut side.sums).enumerate() {
                let told = scores.objectives(number * size + own).split_first();
                let (fitness, earned) = told.unwrap_or((&f64::NAN, &[]));
                *sum = Fitness::nan_as_failed(sum.get() + fitness);
                let cells = row.iter_mut().skip(first);
                // A row ends before the repeated opponents of the last generation, which count for fitness alone.
                cells.zip(earned).for_each(|(cell, earned)| *cell = Fitness::nan_as_failed(*earned));
            }
        }
    }

    /// Selects the members of both populations, and then their newcomers and the opponents of these.
    fn select(&mut self, generation: u32) -> Result<(), EvoError> {
        let GeneralistConfig { members, newcomers, opponents, .. } = self.config;
        let size = self.config.size();
        // The individuals that each population keeps, and the matrix of those in `rows` against those in `columns`.
        let matrix = |side: &Side, rows: &[usize], columns: &[usize]| {
            let cell = |row: usize, column: usize| side.outcomes.get(row * size + column).map_or(f64::NAN, |x| x.get());
            Outcomes::new(columns.len(), rows.iter().flat_map(|&r| columns.iter().map(move |&c| cell(r, c))).collect())
        };
        let (all, first): (Vec<usize>, Vec<usize>) = ((0..size).collect(), (0..members).collect());
        let mut kept = [first.clone(), first.clone()];
        for (side, kept) in self.sides.iter_mut().zip(&mut kept) {
            // Opponents are the other population's members alone, since its newcomers are not yet selected.
            let replaced = matrix(side, &all, &first)?.replacements(newcomers)?;
            for &Replacement { member, newcomer } in &replaced {
                kept[member] = newcomer;
            }
            side.selected = [replaced.len() as f64, 0.0].map(Fitness::nan_as_failed);
        }
        // A second loop, because opponents are drawn from the members that the other population has selected.
        for (number, side) in self.sides.iter_mut().enumerate() {
            let [own, other] = if number == 0 { [&kept[0], &kept[1]] } else { [&kept[1], &kept[0]] };
            let genome = |of: usize, individual: usize| self.population.get(of * size + individual).unwrap_or_default();
            for (genes, &individual) in side.members.iter_mut().zip(own) {
                genes.copy_from_slice(genome(number, individual));
            }
            let outcomes = matrix(side, own, other)?;
            let sum: f64 = outcomes.fitness().iter().map(|fitness| fitness.get()).sum();
            side.selected[1] = Fitness::nan_as_failed(sum / members as f64);
            let mut stream = Stream::new(self.seed, Domain::Mutation, CHOICE + number as u32, 0, generation);
            let chosen = outcomes.differing_opponents(opponents, &mut stream)?;
            for (genes, opponent) in side.opponents.iter_mut().zip(chosen) {
                genes.copy_from_slice(genome(1 - number, other[opponent]));
            }
            // The first elements of a random order.
            let mut order = own.clone();
            for (place, origin) in side.origins.iter_mut().enumerate() {
                order.swap(place, place + stream.below((members - place) as u32) as usize);
                *origin = (number * size + order[place]) as u32;
            }
            side.outcomes.fill(NOTHING);
            side.sums.fill(NOTHING);
        }
        Ok(())
    }

    /// Keeps the best of what was tried for each newcomer.
    fn improve(&mut self, scores: &Scores) {
        let (size, tried) = (self.config.size(), self.config.candidates());
        let fitness = scores.fitness();
        for (number, (side, own)) in self.sides.iter_mut().zip(fitness.chunks(size)).enumerate() {
            for (place, (origin, own)) in side.origins.iter_mut().zip(own.chunks(tried)).enumerate() {
                let best = Statistics::from_fitness(own).map_or(0, |summary| summary.best_index);
                *origin = (number * size + place * tried + best) as u32;
            }
        }
    }

    /// The individuals of a generation of training: each newcomer and mutated copies of it.
    fn candidates(&self, generation: u32) -> Result<Population, EvoError> {
        let (size, tried) = (self.config.size(), self.config.candidates());
        let mut next = Population::new(SIDES * size, self.config.genes)?;
        for (individual, genes) in next.iter_mut().enumerate() {
            let (side, own) = (individual / size, individual % size);
            let origin = self.sides[side].origins.get(own / tried).map_or(0, |origin| *origin as usize);
            genes.copy_from_slice(self.population.get(origin).unwrap_or_default());
            // The first candidate is unchanged, so a newcomer can stay as it is.
            if !own.is_multiple_of(tried) {
                let mut stream = Stream::new(self.seed, Domain::Mutation, side as u32, own as u32, generation);
                self.mutation.apply(genes, &mut stream);
            }
        }
        Ok(next)
    }

    /// The individuals of a round's encounters: members, then newcomers.
    fn everyone(&self) -> Result<Population, EvoError> {
        let mut next = Population::new(SIDES * self.config.size(), self.config.genes)?;
        let newcomer = |origin: &u32| self.population.get(*origin as usize).unwrap_or_default();
        let all = self.sides.iter().flat_map(|side| side.members.iter().chain(side.origins.iter().map(newcomer)));
        next.iter_mut().zip(all).for_each(|(genes, own)| genes.copy_from_slice(own));
        Ok(next)
    }
}

impl Strategy for GeneralistCoevolution {
    fn generation(&self) -> u32 {
        self.generation
    }

    fn ask(&self) -> &Population {
        &self.population
    }

    fn score_shape(&self) -> ScoreShape {
        ScoreShape::new(1 + self.config.opponents, 0)
    }

    fn tell(&mut self, fitness: &[Fitness]) -> Result<(), EvoError> {
        self.tell_scores(&Scores::from_fitness(fitness))
    }

    fn tell_scores(&mut self, scores: &Scores) -> Result<(), EvoError> {
        let generation = next_scored(self.generation, self.population.len(), self.score_shape(), scores)?;
        let (place, encounters) = (self.place(), self.config.encounters());
        if place < encounters {
            self.keep(scores);
            if place + 1 == encounters {
                self.select(generation)?;
                self.population = self.candidates(generation)?;
            }
        } else {
            self.improve(scores);
            if place + 1 == self.config.round() {
                self.population = self.everyone()?;
                self.sides.iter_mut().for_each(|side| side.opponents.as_mut_slice().fill(0));
            } else {
                self.population = self.candidates(generation)?;
            }
        }
        self.generation = generation;
        Ok(())
    }

    fn populations(&self) -> usize {
        SIDES
    }

    /// During encounters the mean over their generations so far.
    fn ranked_by(&self, fitness: &[Fitness]) -> Vec<Fitness> {
        if self.is_training() {
            return fitness.to_vec();
        }
        let sums = self.sides.iter().flat_map(|side| &side.sums);
        let mean = |(sum, own): (&Fitness, &Fitness)| (sum.get() + own.get()) / f64::from(self.place() + 1);
        sums.zip(fitness).map(|both| Fitness::nan_as_failed(mean(both))).collect()
    }

    fn opponents(&self) -> Option<&dyn Opponents> {
        Some(self)
    }

    fn snapshot(&mut self) -> Option<&mut dyn Snapshot> {
        Some(self)
    }

    fn genealogy(&self) -> Option<&dyn Genealogy> {
        Some(self)
    }

    /// The number of members of each population that the latest encounters replaced, and the mean outcome of its members
    /// against members. Zeros before.
    fn diagnostics(&self) -> Vec<f64> {
        (0..2).flat_map(|number| self.sides.iter().map(move |side| side.selected[number].get())).collect()
    }
}

impl Opponents for GeneralistCoevolution {
    fn count(&self) -> usize {
        self.config.opponents
    }

    fn opponents_of(&self, individual: usize, opponent: usize) -> Vec<&[u16]> {
        let (size, m) = (self.config.size(), self.config.opponents);
        let side = individual / size;
        let (Some(own), true) = (self.sides.get(side), opponent < m) else { return Vec::new() };
        let met = if self.is_training() {
            own.opponents.get(opponent)
        } else {
            // The last generation of encounters begins again with the first opponents where m does not divide the
            // size.
            let column = (self.place() as usize * m + opponent) % size;
            self.population.get((1 - side) * size + column)
        };
        met.into_iter().collect()
    }
}

/// In encounters, after their first generation, everyone is its own parent. Members rest during training, and then have none.
impl Genealogy for GeneralistCoevolution {
    fn parents_of(&self, individual: usize) -> Vec<usize> {
        let (size, place) = (self.config.size(), self.place());
        let (own, tried) = (individual % size, self.config.candidates());
        let Some(side) = self.sides.get(individual / size).filter(|_| self.generation > 0) else { return Vec::new() };
        let newcomer = match place {
            0 => own.checked_sub(self.config.members),
            _ if place < self.config.encounters() => return vec![individual],
            _ => Some(own / tried),
        };
        newcomer.and_then(|newcomer| side.origins.get(newcomer)).map(|origin| *origin as usize).into_iter().collect()
    }
}

impl Snapshot for GeneralistCoevolution {
    fn save(&self) -> Vec<u8> {
        let mut state = Vec::with_capacity(self.state_length(self.generation));
        state.extend(self.generation.to_le_bytes());
        push_genes(&mut state, &self.population);
        let known = self.known(self.generation);
        for side in &self.sides {
            if self.generation >= self.config.encounters() {
                push_reals(&mut state, &side.selected.map(Fitness::get));
                state.extend(side.origins.iter().flat_map(|origin| origin.to_le_bytes()));
            }
            if self.is_training() {
                push_genes(&mut state, &side.members);
                push_genes(&mut state, &side.opponents);
            } else {
                let rows = side.outcomes.chunks_exact(self.config.size());
                let cells = rows.flat_map(|row| row.iter().take(known)).chain(&side.sums);
                state.extend(cells.flat_map(|fitness| fitness.get().to_le_bytes()));
            }
        }
        state
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), EvoError> {
        let generation = StateReader::new(state, state.len())?.u32()?;
        let mut reader = StateReader::new(state, self.state_length(generation))?;
        reader.u32()?;
        let (config, size, most) = (self.config, self.config.size(), largest(self.config.gene_bits));
        let mut population = Population::new(SIDES * size, config.genes)?;
        reader.genes(&mut population, most)?;
        let known = self.known(generation);
        let mut sides = [Side::new(&config, &population, 0)?, Side::new(&config, &population, 1)?];
        for (number, side) in sides.iter_mut().enumerate() {
            if generation >= config.encounters() {
                for number in &mut side.selected {
                    *number = reader.fitness()?;
                }
                for origin in &mut side.origins {
                    *origin = reader.u32()?;
                    if *origin as usize / size != number {
                        let (individual, population) = (*origin as usize, SIDES * size);
                        return Err(EvoError::no_such_individual(individual, population));
                    }
                }
            }
            if generation % config.round() >= config.encounters() {
                reader.genes(&mut side.members, most)?;
                reader.genes(&mut side.opponents, most)?;
            } else {
                let rows = side.outcomes.chunks_exact_mut(size);
                for cell in rows.flat_map(|row| row.iter_mut().take(known)).chain(&mut side.sums) {
                    *cell = reader.fitness()?;
                }
            }
        }
        (self.generation, self.sides, self.population) = (generation, sides, population);
        Ok(())
    }
}
