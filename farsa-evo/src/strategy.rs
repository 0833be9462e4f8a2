//! Interface that all search strategies implement.

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

/// Content that a record needs in order to rebuild a generation, see [`Strategy::record_kind`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum RecordKind {
    /// Only the order of the individuals, best first, with ties broken by index. Use this if the strategy depends on
    /// nothing else.
    Order,
    /// Fitness values, or all numbers of the scores if the strategy requires scores.
    Values,
    /// Whole genomes. This is for strategies that are too slow to replay.
    Genomes,
}

/// A search by ask and tell over genomes of integers (`u16`) or reals (`f64`).
///
/// You evaluate the genomes of [`ask`](Strategy::ask) in any order and on any number of threads, and then call
/// [`tell`](Strategy::tell) once. A strategy is a pure function of its configuration, its seed and the reported
/// fitness. This means that a [`Record`](crate::Record) of the fitness can rebuild any past generation without
/// evaluations. If you implement a strategy, draw random numbers only from a [`farsa_num::Stream`] that is identified
/// by seed, individual and generation.
///
/// Only three methods are required. The defaults of the others are suitable for a strategy with one population that
/// depends on the values of fitness. If your strategy has several objectives or uses measures, it must return another
/// [`score_shape`](Strategy::score_shape) and take [`Scores`] in [`tell_scores`](Strategy::tell_scores). In that case
/// the first objective is shown as fitness in logs.
pub trait Strategy<G: Gene = u16> {
    /// Gets the number of the generation that is waiting for its fitness, starting at 0.
    fn generation(&self) -> u32;

    /// Gets the genomes to evaluate in the current generation [individuals x genes]. If there are several populations,
    /// their genomes follow one another. Calling this again before [`tell`](Strategy::tell) returns the same genomes.
    fn ask(&self) -> &Population<G>;

    /// Takes the fitness \[individuals\] of the current generation and advances to the next one.
    ///
    /// # Errors
    /// Returns [`EvoError::Shape`] for a wrong number of values, or if the strategy requires scores.
    /// [`EvoError::LastGeneration`]. The strategy is then unchanged.
    fn tell(&mut self, fitness: &[Fitness]) -> Result<(), EvoError>;

    /// Number of objectives and measures that the strategy requires for each individual. By default this is a single
    /// objective.
    fn score_shape(&self) -> ScoreShape {
        ScoreShape::FITNESS
    }

    /// Takes the scores of the current generation, which must have the shape [`score_shape`](Strategy::score_shape),
    /// and advances to the next one. By default, scores with a single objective are passed on to
    /// [`tell`](Strategy::tell) as fitness.
    ///
    /// # Errors
    /// Returns [`EvoError::Shape`] for another shape, and the errors of [`tell`](Strategy::tell). The strategy is then
    /// unchanged.
    fn tell_scores(&mut self, scores: &Scores) -> Result<(), EvoError> {
        ScoreShape::FITNESS.check(scores.shape())?;
        self.tell(&scores.fitness())
    }

    /// Number of populations, which all have the same size.
    fn populations(&self) -> usize {
        1
    }

    /// Determines what a record has to store so that it can rebuild a generation.
    fn record_kind(&self) -> RecordKind {
        RecordKind::Values
    }

    /// Computes the fitness \[individuals\] by which individuals are ranked, given the fitness of the evaluation or its
    /// first objective. By default the fitness is used as it is.
    fn ranked_by(&self, fitness: &[Fitness]) -> Vec<Fitness> {
        fitness.to_vec()
    }

    /// Finds the best individual of each population, given the fitness returned by [`ranked_by`](Strategy::ranked_by)
    /// \[individuals\]. Indices count through all populations. If several individuals are equally good, the one with
    /// the lowest index wins.
    fn champions(&self, ranked_by: &[Fitness]) -> Vec<usize> {
        let size = (ranked_by.len() / self.populations().max(1)).max(1);
        let best = |own| Statistics::from_fitness(own).map_or(0, |summary| summary.best_index);
        ranked_by.chunks(size).enumerate().map(|(population, own)| population * size + best(own)).collect()
    }

    /// Gives access to saving and restoring the state. If this returns `None`, the strategy can only be resumed by
    /// replaying its record.
    fn snapshot(&mut self) -> Option<&mut dyn Snapshot> {
        None
    }

    /// Gives access to the parents of individuals. It is `None` for strategies without parents.
    fn genealogy(&self) -> Option<&dyn Genealogy> {
        None
    }

    /// Gives access to the opponents of each individual. It is `None` unless the strategy chooses opponents itself.
    fn opponents(&self) -> Option<&dyn Opponents<G>> {
        None
    }

    /// Gives access to the individuals that are kept beyond a generation, such as an archive. Use this if the result of
    /// a strategy is more than a champion.
    fn collection(&self) -> Option<&dyn Collection> {
        None
    }

    /// Checks whether the champion of a search is the best individual of all generations instead of the last one. This
    /// holds for strategies whose generations do not improve on earlier ones, such as an archive or random search.
    ///
    /// By default where something is [kept](Strategy::collection).
    fn champion_is_best_ever(&self) -> bool {
        self.collection().is_some()
    }

    /// Numbers that describe the latest generation, such as a step size. Their count never changes during a search. The
    /// default is an empty list.
    fn diagnostics(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Takes plain values \[individuals\] instead of [`Fitness`]. This is a shorthand for [`tell`](Strategy::tell) in
    /// which a NaN becomes a failed evaluation.
    ///
    /// # Errors
    /// Returns the errors of [`tell`](Strategy::tell).
    fn tell_values(&mut self, values: &[f64]) -> Result<(), EvoError> {
        let fitness: Vec<Fitness> = values.iter().copied().map(Fitness::nan_as_failed).collect();
        self.tell(&fitness)
    }

    /// Evaluates the given number of generations and returns the best individual by the first objective. For each
    /// genome \[genes\], `judge` gets a row [m + d] of zeros and writes the objectives and then the measures into it.
    /// If it writes a NaN, the evaluation has failed.
    ///
    /// # Errors
    /// Returns [`EvoError::NoBest`] for no generations, [`EvoError::LastGeneration`].
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

    /// Evaluates the given number of generations and returns the best individual. This is the simplest way to run a
    /// search with a single objective. If `evaluate` returns NaN for a genome \[genes\], that evaluation has failed.
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
    /// Returns [`EvoError::Shape`] for a strategy that requires scores. The errors of [`evolve`](Strategy::evolve).
    fn maximize(&mut self, generations: u32, mut evaluate: impl FnMut(&[G]) -> f64) -> Result<Champion<G>, EvoError>
    where
        Self: Sized,
    {
        self.score_shape().check(ScoreShape::FITNESS)?;
        self.evolve(generations, |genes, row| row.fill(evaluate(genes)))
    }
}

/// A strategy that can report the parents of its individuals.
pub trait Genealogy {
    /// Finds the parents of an individual of the current generation, as indices in the previous one. If the individual
    /// has no parents or does not exist, the list is empty. This is also the case in generation 0.
    fn parents_of(&self, individual: usize) -> Vec<usize>;
}

/// A strategy that chooses the opponents of each individual, see [`Strategy::opponents`](crate::Strategy::opponents).
/// Use this for strategies with several populations that depend on the fitness against each opponent.
///
/// With m opponents, the scores of such a strategy have 1 + m objectives. The first objective is the fitness over all
/// trials, and the others are the fitness over the trials against each opponent. Trial `t` is played against opponent
/// `t` modulo m, so you need at least m trials.
pub trait Opponents<G: Gene = u16> {
    /// Number of opponents m that each individual has in a generation. This is always at least 1.
    fn count(&self) -> usize;

    /// Gets the genomes that form one opponent of an individual, one genome from each other population in their order.
    /// Individuals are counted through all populations and opponents from 0 to m - 1. If either number is out of range,
    /// the list is empty.
    fn opponents_of(&self, individual: usize, opponent: usize) -> Vec<&[G]>;
}

/// An individual that a strategy keeps, either an elite of an archive or a member of a front.
///
/// Together, its generation and index are enough to find its genes in a [`Record`](crate::Record).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Member<'a> {
    /// Number of its cell, if the collection is divided into cells.
    pub cell: Option<usize>,
    /// Its objectives \[m\], in the units that the experiment uses.
    pub objectives: &'a [f64],
    /// Its measures \[d\].
    pub measures: &'a [f64],
    /// Generation in which it was evaluated.
    pub generation: u32,
    /// Its index in that generation, counted through all populations.
    pub individual: usize,
}

/// A strategy that keeps individuals beyond their generation, such as an archive of elites or the front of several
/// objectives.
pub trait Collection {
    /// Gets all members. Note that their order is arbitrary.
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
