//! The interface of all search strategies.

use alloc::vec;
use alloc::vec::Vec;

use crate::champion::Champion;
use crate::error::EvoError;
use crate::fitness::Fitness;
use crate::gene::Gene;
use crate::population::Population;
use crate::score_shape::ScoreShape;
use crate::scores::Scores;
use crate::snapshot::Snapshot;
use crate::statistics::Statistics;

/// The content of a record that rebuilds a generation, see [`Strategy::record_kind`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum RecordKind {
    /// The order of the individuals, best first, equals by index: for strategies that depend on nothing else.
    Order,
    /// The values of fitness, or all numbers of the scores.
    Values,
    /// The genomes, for strategies that are too slow to replay.
    Genomes,
}

/// A search by ask and tell over genomes of integers (`u16`) or reals (`f64`).
///
/// The caller evaluates the genomes of [`ask`](Strategy::ask) in any order and on any number of threads, then calls
/// [`tell`](Strategy::tell) once. A strategy is a pure function of its configuration, its seed and the reported fitness. A
/// [`Record`](crate::Record) of the fitness therefore rebuilds any past generation without evaluations. Implementations
/// draw random numbers only from [`farsa_num::Stream`]s that seed, individual and generation name.
///
/// Three methods are required. The defaults of the others fit a strategy with one population that depends on the values of
/// fitness. A strategy with several objectives, or with measures, returns another [`score_shape`](Strategy::score_shape)
/// and takes [`Scores`] in [`tell_scores`](Strategy::tell_scores). Its fitness in logs is the first objective.
pub trait Strategy<G: Gene = u16> {
    /// The number of the generation that waits for its fitness, from 0.
    fn generation(&self) -> u32;

    /// The genomes of the current generation [individuals x genes], those of one population after the other.
    fn ask(&self) -> &Population<G>;

    /// Takes the fitness \[individuals\] of the current generation and makes the next one.
    ///
    /// # Errors
    /// [`EvoError::Shape`] for a wrong number of values, or if the strategy requires scores. [`EvoError::LastGeneration`]. The
    /// strategy is then unchanged.
    fn tell(&mut self, fitness: &[Fitness]) -> Result<(), EvoError>;

    /// The number of objectives and measures that it requires of each individual, by default one objective.
    fn score_shape(&self) -> ScoreShape {
        ScoreShape::FITNESS
    }

    /// Takes the scores of the current generation, which have the shape [`score_shape`](Strategy::score_shape), and makes
    /// the next one. Scores of one objective are passed on as fitness.
    ///
    /// # Errors
    /// [`EvoError::Shape`] for another shape, and the errors of [`tell`](Strategy::tell). The strategy is then
    /// unchanged.
    fn tell_scores(&mut self, scores: &Scores) -> Result<(), EvoError> {
        ScoreShape::FITNESS.check(scores.shape())?;
        self.tell(&scores.fitness())
    }

    /// Number of populations, each of as many individuals.
    fn populations(&self) -> usize {
        1
    }

    /// The content of a record that rebuilds a generation.
    fn record_kind(&self) -> RecordKind {
        RecordKind::Values
    }

    /// Returns the fitness \[individuals\] by which individuals are ranked, given the fitness of the evaluation or its
    /// first objective.
    fn ranked_by(&self, fitness: &[Fitness]) -> Vec<Fitness> {
        fitness.to_vec()
    }

    /// Returns the best individual of each population, counted through all populations, given the fitness of
    /// [`ranked_by`](Strategy::ranked_by) \[individuals\]. The lower index wins among equals.
    fn champions(&self, ranked_by: &[Fitness]) -> Vec<usize> {
        let size = (ranked_by.len() / self.populations().max(1)).max(1);
        let best = |own| Statistics::from_fitness(own).map_or(0, |summary| summary.best_index);
        ranked_by.chunks(size).enumerate().map(|(population, own)| population * size + best(own)).collect()
    }

    /// The ability to save and restore the state. A strategy without it resumes by replaying its record.
    fn snapshot(&mut self) -> Option<&mut dyn Snapshot> {
        None
    }

    /// The parents of individuals, for strategies that have them.
    fn genealogy(&self) -> Option<&dyn Genealogy> {
        None
    }

    /// The opponents of each individual, for strategies that choose them.
    fn opponents(&self) -> Option<&dyn Opponents<G>> {
        None
    }

    /// The individuals that are kept beyond a generation, for strategies whose result is more than a champion.
    fn collection(&self) -> Option<&dyn Collection> {
        None
    }

    /// Returns true if the champion of a search is the best individual of all generations instead of the last one. This
    /// holds for strategies whose generations do not improve on earlier ones, such as an archive or random search.
    ///
    /// By default where something is [kept](Strategy::collection).
    fn champion_is_best_ever(&self) -> bool {
        self.collection().is_some()
    }

    /// Numbers about the latest generation, such as a step size. Their count never changes, and they are empty by default.
    fn diagnostics(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Takes plain values \[individuals\]. A NaN is a failed evaluation.
    ///
    /// # Errors
    /// The errors of [`tell`](Strategy::tell).
    fn tell_values(&mut self, values: &[f64]) -> Result<(), EvoError> {
        let fitness: Vec<Fitness> = values.iter().copied().map(Fitness::nan_as_failed).collect();
        self.tell(&fitness)
    }

    /// Evaluates the given number of generations and returns the best individual by the first objective. `judge` writes the
    /// objectives and then the measures of a genome \[genes\] into a row [m + d] of zeros. A NaN is a failed evaluation.
    ///
    /// # Errors
    /// [`EvoError::NoBest`] for no generations, [`EvoError::LastGeneration`].
    fn evolve(&mut self, generations: u32, mut judge: impl FnMut(&[G], &mut [f64])) -> Result<Champion<G>, EvoError>
    where
        Self: Sized,
    {
        let (mut champion, shape) = (None, self.score_shape());
        for _ in 0..generations {
            let mut values = vec![0.0; self.ask().len() * shape.width()];
            self.ask().iter().zip(values.chunks_exact_mut(shape.width())).for_each(|(genes, row)| judge(genes, row));
            let scores = Scores::nan_as_failed(shape, values)?;
            Champion::keep(&mut champion, self.generation(), self.ask(), &scores.fitness())?;
            self.tell_scores(&scores)?;
        }
        champion.ok_or(EvoError::NoBest { generation: self.generation() })
    }

    /// Evaluates the given number of generations and returns the best individual. `evaluate` returns the fitness of a
    /// genome \[genes\], and a NaN is a failed evaluation.
    ///
    /// ```
    /// use farsa_evo::Strategy;
    /// use farsa_evo::words::{GaConfig, TruncationGa};
    ///
    /// let mut evolution = TruncationGa::new(GaConfig::new(2), 1)?;
    /// let ones = |genes: &[u16]| genes.iter().map(|gene| f64::from(gene.count_ones())).sum();
    /// let champion = evolution.maximize(40, ones)?;
    /// assert_eq!(champion.genome, [u16::MAX; 2]);
    /// # Ok::<(), farsa_evo::EvoError>(())
    /// ```
    ///
    /// # Errors
    /// [`EvoError::Shape`] for a strategy that requires scores. The errors of [`evolve`](Strategy::evolve).
    fn maximize(&mut self, generations: u32, mut evaluate: impl FnMut(&[G]) -> f64) -> Result<Champion<G>, EvoError>
    where
        Self: Sized,
    {
        self.score_shape().check(ScoreShape::FITNESS)?;
        self.evolve(generations, |genes, row| row.fill(evaluate(genes)))
    }
}

/// The ability to report the parents of individuals.
pub trait Genealogy {
    /// Returns the parents of an individual of the current generation, as indices in the previous one. Empty in generation
    /// 0, for an individual without parents and beyond the last individual.
    fn parents_of(&self, individual: usize) -> Vec<usize>;
}

/// The ability to choose the opponents of each individual, see [`Strategy::opponents`](crate::Strategy::opponents). It is
/// for strategies of several populations that depend on the fitness against each opponent.
///
/// The scores of such a strategy have 1 + m objectives for m opponents. The first is the fitness of all trials, the others
/// are the fitness of the trials against each opponent. In trial `t` the opponent is number `t` modulo m, so at least m
/// trials are required.
pub trait Opponents<G: Gene = u16> {
    /// Number of opponents m of each individual in a generation, at least 1.
    fn count(&self) -> usize;

    /// Returns the genomes of an individual's opponent of the given number, one of each other population in their order.
    /// Individuals are counted through all populations, opponents from 0 to m - 1. Empty beyond the last of either.
    fn opponents_of(&self, individual: usize, opponent: usize) -> Vec<&[G]>;
}

/// An individual that a strategy keeps: an elite of an archive, or a member of a front.
///
/// Where it comes from, its generation and index, is enough to find its genes in a [`Record`](crate::Record).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Member<'a> {
    /// The number of its cell, where there are cells.
    pub cell: Option<usize>,
    /// Its objectives \[m\], in the experiment's own units.
    pub objectives: &'a [f64],
    /// Its measures \[d\].
    pub measures: &'a [f64],
    /// The generation in which it was evaluated.
    pub generation: u32,
    /// Its index in that generation, counted through all populations.
    pub individual: usize,
}

/// The ability to keep individuals beyond their generation: an archive of elites, or the front of several objectives.
pub trait Collection {
    /// All members, in arbitrary order.
    fn members(&self) -> Vec<Member<'_>>;
}

/// The number of the next generation, if `fitness` has one value for each of `population` individuals.
pub(crate) fn next_generation(generation: u32, population: usize, fitness: &[Fitness]) -> Result<u32, EvoError> {
    if fitness.len() != population {
        return Err(EvoError::fitness_count(population, fitness.len()));
    }
    generation.checked_add(1).ok_or(EvoError::LastGeneration)
}

/// The number of the next generation, if there are scores of this shape for each of `population` individuals.
pub(crate) fn next_scored(
    generation: u32,
    population: usize,
    shape: ScoreShape,
    scores: &Scores,
) -> Result<u32, EvoError> {
    scores.check(shape, population)?;
    generation.checked_add(1).ok_or(EvoError::LastGeneration)
}
