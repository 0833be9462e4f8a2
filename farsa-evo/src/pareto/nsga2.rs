//! An elitist genetic algorithm with non-dominated sorting, for several objectives.

use alloc::vec;
use alloc::vec::Vec;
use core::cmp::Reverse;

use farsa_num::{Domain, Stream};

use crate::error::{EvoError, check_setting, check_share};
use crate::fitness::Fitness;
use crate::pareto::fronts::crowding_distances;
use crate::pareto::fronts::non_dominated_fronts;
use crate::population::Population;
use crate::real::bounds::{check_bounds, check_within, draw_within};
use crate::real::crossover::Crossover;
use crate::real::mutation::PolynomialMutation;
use crate::score_shape::ScoreShape;
use crate::scores::Scores;
use crate::snapshot::{Snapshot, StateReader, between_states, push_reals};
use crate::strategy::{Collection, Genealogy, Member, Strategy, next_scored};

/// Configuration of [`Nsga2`](crate::pareto::Nsga2).
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Nsga2Config {
    /// Range of each gene, from low to high \[genes\], -1e100 to 1e100. You can freeze a gene by giving it equal ends.
    pub bounds: Vec<[f64; 2]>,
    /// Number of objectives m, which must be at least 1.
    pub objectives: usize,
    /// Number of individuals N in each generation. There are also N parents.
    pub population: usize,
    /// Probability (0 to 1) that a child has two parents, `p_c`.
    pub crossover_rate: f64,
    /// Distribution index of crossover `eta_c`, 0 to 1000. With a larger index, children are closer to their parents.
    pub crossover_eta: f64,
    /// Probability (0 to 1) that a gene is mutated, `p_m`.
    pub mutation_rate: f64,
    /// Distribution index of mutation `eta_m`, 0 to 1000. With a larger index, steps are smaller.
    pub mutation_eta: f64,
}

impl Nsga2Config {
    /// Creates a configuration with the settings of \[Deb2002\] section IV. There are 100 individuals, and `p_c` is
    /// 0.9. On average one gene of a genome is mutated, and both indices are 20.
    pub fn new(bounds: Vec<[f64; 2]>, objectives: usize) -> Self {
        let mutation_rate = 1.0 / bounds.len().max(1) as f64;
        let (crossover_rate, crossover_eta, mutation_eta) = (0.9, 20.0, 20.0);
        Self { bounds, objectives, population: 100, crossover_rate, crossover_eta, mutation_rate, mutation_eta }
    }

    /// Checks whether a search can be created with these settings.
    ///
    /// # Errors
    /// Returns [`EvoError::Config`] for sizes, [`EvoError::OutOfRange`] for other numbers.
    pub fn validate(&self) -> Result<(), EvoError> {
        check_bounds(self.population, &self.bounds)?;
        check_setting(self.objectives > 0, "the number of objectives", self.objectives as f64, "1 or more")?;
        Population::check(self.population.saturating_mul(2), self.objectives)?;
        check_share("the crossover rate", self.crossover_rate)?;
        self.crossover().check()?;
        self.mutation().check()
    }

    pub(super) fn crossover(&self) -> Crossover {
        Crossover::SimulatedBinary { eta: self.crossover_eta }
    }

    pub(super) fn mutation(&self) -> PolynomialMutation {
        PolynomialMutation { rate: self.mutation_rate, eta: self.mutation_eta }
    }
}

/// NSGA-II over real genes within bounds. The better half of parents and offspring become the next parents. They rank by
/// non-dominated front, and within a front by crowding distance.
///
/// Every generation has N offspring. Parents keep their objectives and are not evaluated again. Each parent of a child is
/// the better of two, by front, then by crowding distance. Equals rank by index, parents before offspring. All individuals
/// dominate a failed evaluation.
///
/// Child `i` of generation `g` draws from the stream (seed, [`Domain::Mutation`], trial 0, `i`, `g`). The draws are the two
/// rivals for its first parent, the decision for a second, its rivals, the crossover and the mutation, gene after gene.
/// Individuals of generation 0 are uniform within the bounds, from (seed, [`Domain::InitialGenome`], trial 0, `i`, 0).
///
/// Source: \[Deb2002\], with simulated binary crossover \[Deb1995\] and polynomial mutation as in K. Deb's program.
/// Deviations: larger is better. Rivals are drawn one by one, with replacement, where the program lets each parent compete
/// twice. A crossover makes one of the two children, each gene from either with probability 1/2. There are no constraints.
///
/// ```
/// use farsa_evo::Strategy;
/// use farsa_evo::pareto::{Nsga2, Nsga2Config, hypervolume};
///
/// // Near 0 and near 2 at once: the trade-off lies between.
/// let mut search = Nsga2::new(Nsga2Config { population: 20, ..Nsga2Config::new(vec![[-10.0, 10.0]], 2) }, 1)?;
/// search.evolve(40, |genes, row| row.copy_from_slice(&[-genes[0] * genes[0], -(genes[0] - 2.0) * (genes[0] - 2.0)]))?;
/// assert!(search.front().all(|(genes, _)| (-0.1..=2.1).contains(&genes[0])));
/// let points: Vec<[f64; 2]> = search.front().map(|(_, objectives)| [objectives[0], objectives[1]]).collect();
/// // The whole trade-off dominates 13.33 of 16.
/// assert!(hypervolume(&points, [-4.0, -4.0]) > 12.5);
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Nsga2 {
    config: Nsga2Config,
    seed: u64,
    generation: u32,
    /// `None` before the first generation is reported.
    parents: Option<Parents>,
    /// The parents of each individual that waits, as indices of the parents, the same where there is one.
    chosen: Vec<[u32; 2]>,
    population: Population<f64>,
}

/// The survivors, the first fronts first.
#[derive(Clone, Debug, PartialEq)]
struct Parents {
    genes: Population<f64>,
    /// [parents x m]
    objectives: Vec<f64>,
    /// The rank of each survivor.
    standing: Vec<Standing>,
    /// The generation and the index of each.
    origins: Vec<[u32; 2]>,
}

/// The front of an individual and how much room it has there.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Standing {
    front: u32,
    distance: f64,
}

impl Standing {
    /// The crowded comparison: whether the other is better.
    fn is_below(self, other: Self) -> bool {
        other.front < self.front || other.front == self.front && other.distance > self.distance
    }
}

impl Nsga2 {
    /// Creates a new search with a random initial generation.
    ///
    /// # Errors
    /// Returns the errors of [`Nsga2Config::validate`].
    pub fn new(config: Nsga2Config, seed: u64) -> Result<Self, EvoError> {
        config.validate()?;
        let population = Population::new(config.population, config.bounds.len())?;
        let mut search = Self { config, seed, generation: 0, parents: None, chosen: Vec::new(), population };
        search.make();
        Ok(search)
    }

    /// Gets the configuration that this search was created with.
    pub fn config(&self) -> &Nsga2Config {
        &self.config
    }

    /// Gets the seed that this search was created with.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// An iterator over the genes \[genes\] and objectives \[m\] of the parents, beginning with the first front. It is
    /// empty before the first generation is reported.
    pub fn parents(&self) -> impl Iterator<Item = (&[f64], &[f64])> {
        let m = self.config.objectives;
        self.parents.iter().flat_map(move |parents| parents.genes.iter().zip(parents.objectives.chunks_exact(m)))
    }

    /// An iterator over the parents that no other parent dominates. Use this to get the result of a search.
    pub fn front(&self) -> impl Iterator<Item = (&[f64], &[f64])> {
        self.parents().take(self.front_size())
    }

    fn front_size(&self) -> usize {
        let standing = self.parents.iter().flat_map(|parents| &parents.standing);
        // Parents are sorted by front.
        standing.take_while(|standing| standing.front == 0).count()
    }

    /// Returns the better half of parents and reported individuals.
    fn select(&self, scores: &Scores) -> Result<Parents, EvoError> {
        let (size, m) = (self.population.len(), self.config.objectives);
        let old = self.parents.as_ref();
        let kept = old.map_or(0, |old| old.genes.len());
        // Parents come first, so they precede equal offspring.
        let mut objectives = old.map_or(Vec::new(), |old| old.objectives.clone());
        objectives.extend_from_slice(scores.values());
        let mut places: Vec<(usize, Standing)> = Vec::with_capacity(size);
        for (number, front) in non_dominated_fronts(&objectives, m).into_iter().enumerate() {
            let distances = crowding_distances(&objectives, m, &front);
            let standing = |distance| Standing { front: number as u32, distance };
            let mut front: Vec<_> = front.into_iter().zip(distances.into_iter().map(standing)).collect();
            let room = size - places.len();
            // A front that fits is taken as a whole. Only the last one needs an order, and the stable sort ranks
            // equals by index.
            if front.len() > room {
                front.sort_by_key(|(_, standing)| Reverse(Fitness::nan_as_failed(standing.distance)));
            }
            places.extend(front.into_iter().take(room));
        }
        let mut genes = Population::new(size, self.population.genome_len())?;
        for (row, (place, _)) in genes.iter_mut().zip(&places) {
            let from = place.checked_sub(kept).map_or_else(|| old?.genes.get(*place), |told| self.population.get(told));
            row.copy_from_slice(from.unwrap_or_default());
        }
        let origin = |place: usize| match place.checked_sub(kept) {
            Some(told) => [self.generation, told as u32],
            None => old.and_then(|old| old.origins.get(place)).copied().unwrap_or_default(),
        };
        let row = |place: usize| objectives.get(place * m..(place + 1) * m).unwrap_or_default();
        Ok(Parents {
            genes,
            objectives: places.iter().flat_map(|(place, _)| row(*place)).copied().collect(),
            standing: places.iter().map(|(_, standing)| *standing).collect(),
            origins: places.iter().map(|(place, _)| origin(*place)).collect(),
        })
    }

    /// Makes the individuals of this generation.
    fn make(&mut self) {
        let Nsga2Config { bounds, crossover_rate, .. } = &self.config;
        let (crossover, mutation) = (self.config.crossover(), self.config.mutation());
        self.chosen.clear();
        for (individual, genes) in self.population.iter_mut().enumerate() {
            let stream = |domain, generation| Stream::new(self.seed, domain, 0, individual as u32, generation);
            let Some(parents) = &self.parents else {
                draw_within(genes, bounds, &mut stream(Domain::InitialGenome, 0));
                continue;
            };
            let stream = &mut stream(Domain::Mutation, self.generation);
            let first = parents.tournament(stream);
            let mut second = first;
            genes.copy_from_slice(parents.genes.get(first).unwrap_or_default());
            if stream.uniform_f64() < *crossover_rate {
                second = parents.tournament(stream);
                crossover.apply(genes, parents.genes.get(second).unwrap_or_default(), bounds, stream);
            }
            mutation.apply(genes, bounds, stream);
            self.chosen.push([first as u32, second as u32]);
        }
    }

    /// Bytes of a state at a generation.
    fn state_length(&self, generation: u32) -> usize {
        let parent = 4 + 8 + 8 + 8 * (self.config.objectives + self.config.bounds.len());
        4 + if generation == 0 { 0 } else { parent * self.population.len() }
    }

    /// The parents of a generation above 0.
    fn read_parents(&self, reader: &mut StateReader<'_>, generation: u32) -> Result<Parents, EvoError> {
        let (size, m) = (self.population.len(), self.config.objectives);
        let mut genes = Population::new(size, self.population.genome_len())?;
        reader.reals(genes.as_mut_slice())?;
        check_within(&genes, &self.config.bounds)?;
        let mut objectives = vec![0.0; size * m];
        for x in &mut objectives {
            *x = reader.fitness()?.get();
        }
        let (mut standing, mut origins) = (Vec::with_capacity(size), Vec::with_capacity(size));
        for _ in 0..size {
            let (front, origin) = (reader.u32()?, [reader.u32()?, reader.u32()?]);
            let distance = reader.fitness()?.get();
            let last = standing.last().map_or(0, |last: &Standing| last.front);
            // Fronts begin at 0 and have no gaps.
            if front < last || front > last + 1 || standing.is_empty() && front > 0 {
                return Err(EvoError::state_content("the front of a parent", front.into()));
            }
            if distance < 0.0 {
                return Err(EvoError::state_content("a crowding distance", distance.to_bits()));
            }
            let [born, individual] = origin;
            if born >= generation {
                return Err(EvoError::no_such_generation(born, generation - 1));
            }
            if individual as usize >= size {
                return Err(EvoError::no_such_individual(individual as usize, size));
            }
            standing.push(Standing { front, distance });
            origins.push(origin);
        }
        Ok(Parents { genes, objectives, standing, origins })
    }
}

impl Parents {
    /// The better of two, the first drawn among equals.
    fn tournament(&self, stream: &mut Stream) -> usize {
        let size = self.standing.len() as u32;
        let [first, second] = [stream.below(size) as usize, stream.below(size) as usize];
        match (self.standing.get(first), self.standing.get(second)) {
            (Some(own), Some(other)) if own.is_below(*other) => second,
            _ => first,
        }
    }
}

impl Strategy<f64> for Nsga2 {
    fn generation(&self) -> u32 {
        self.generation
    }

    fn ask(&self) -> &Population<f64> {
        &self.population
    }

    fn score_shape(&self) -> ScoreShape {
        ScoreShape::new(self.config.objectives, 0)
    }

    fn tell(&mut self, fitness: &[Fitness]) -> Result<(), EvoError> {
        self.tell_scores(&Scores::from_fitness(fitness))
    }

    fn tell_scores(&mut self, scores: &Scores) -> Result<(), EvoError> {
        let generation = next_scored(self.generation, self.population.len(), self.score_shape(), scores)?;
        let parents = self.select(scores)?;
        (self.generation, self.parents) = (generation, Some(parents));
        self.make();
        Ok(())
    }

    fn snapshot(&mut self) -> Option<&mut dyn Snapshot> {
        Some(self)
    }

    fn genealogy(&self) -> Option<&dyn Genealogy> {
        Some(self)
    }

    fn collection(&self) -> Option<&dyn Collection> {
        Some(self)
    }

    /// The number of parents that no other parent dominates.
    fn diagnostics(&self) -> Vec<f64> {
        vec![self.front_size() as f64]
    }
}

/// The parents that no other parent dominates.
impl Collection for Nsga2 {
    fn members(&self) -> Vec<Member<'_>> {
        let origins = self.parents.iter().flat_map(|parents| &parents.origins);
        let member = |((_, objectives), origin): ((_, _), &[u32; 2])| {
            let [generation, individual] = *origin;
            Member { cell: None, objectives, measures: &[], generation, individual: individual as usize }
        };
        self.front().zip(origins).map(member).collect()
    }
}

/// Parents that survived an earlier generation were not in the one before, and are not named.
impl Genealogy for Nsga2 {
    fn parents_of(&self, individual: usize) -> Vec<usize> {
        let Some((parents, [first, second])) = self.parents.as_ref().zip(self.chosen.get(individual)) else {
            return Vec::new();
        };
        let mut chosen = vec![*first, *second];
        chosen.dedup();
        let latest = |parent: u32| {
            let [generation, individual] = *parents.origins.get(parent as usize)?;
            (generation.checked_add(1) == Some(self.generation)).then_some(individual as usize)
        };
        chosen.into_iter().filter_map(latest).collect()
    }
}

impl Snapshot for Nsga2 {
    fn snapshot_interval(&self) -> u32 {
        between_states(&self.population)
    }

    fn save(&self) -> Vec<u8> {
        let mut state = Vec::with_capacity(self.state_length(self.generation));
        state.extend(self.generation.to_le_bytes());
        if let Some(parents) = &self.parents {
            push_reals(&mut state, parents.genes.as_slice());
            push_reals(&mut state, &parents.objectives);
            for (standing, origin) in parents.standing.iter().zip(&parents.origins) {
                state.extend(standing.front.to_le_bytes());
                state.extend(origin.iter().flat_map(|number| number.to_le_bytes()));
                push_reals(&mut state, &[standing.distance]);
            }
        }
        state
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), EvoError> {
        let generation = StateReader::new(state, state.len())?.u32()?;
        let mut reader = StateReader::new(state, self.state_length(generation))?;
        reader.u32()?;
        self.parents = if generation == 0 { None } else { Some(self.read_parents(&mut reader, generation)?) };
        self.generation = generation;
        self.make();
        Ok(())
    }
}
