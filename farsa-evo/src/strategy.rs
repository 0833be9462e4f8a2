//! What every search strategy over genes offers.

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

/// What has to be recorded of a generation so that it can be rebuilt, [`Strategy::record_kind`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum RecordKind {
    /// The order of the individuals, best first, equals by index: for strategies that depend on nothing else.
    Order,
    /// The values of fitness, or all numbers of the scores.
    Values,
    /// The genomes themselves: for strategies that take too long to be told again.
    Genomes,
}

/// A search over genomes that is asked for a generation and told how well it did. Its genes are 16-bit words or reals.
///
/// The caller evaluates [`ask`](Strategy::ask)'s genomes in any order and on any number of threads, then calls
/// [`tell`](Strategy::tell) once. A strategy is a pure function of its configuration, its seed and what it was told, so a
/// [`Record`](crate::Record) of that rebuilds any past generation without evaluating anything. Implementations draw random
/// numbers only from [`farsa_num::Stream`]s named by seed, individual and generation.
///
/// Three methods are required; the others have defaults that fit a strategy of one population that depends on the values of
/// fitness. A strategy that wants several objectives, or a measures, says so
/// ([`score_shape`](Strategy::score_shape)) and takes [`Scores`] in the place of fitness
/// ([`tell_scores`](Strategy::tell_scores)); its fitness, by which it is logged, is the first objective.
pub trait Strategy<G: Gene = u16> {
    /// The number of the generation that waits for its fitness, from 0.
    fn generation(&self) -> u32;

    /// The genomes of the current generation [individuals x genes], those of one population after the other.
    fn ask(&self) -> &Population<G>;

    /// Takes the fitness \[individuals\] of the current generation and makes the next one.
    ///
    /// # Errors
    /// [`EvoError::FitnessCount`] or [`EvoError::LastGeneration`], or [`EvoError::ScoreShape`] by a strategy that wants more than
    /// fitness; the strategy is then unchanged.
    fn tell(&mut self, fitness: &[Fitness]) -> Result<(), EvoError>;

    /// How many objectives and measures it is told of each individual: one objective, if nothing else is said.
    fn score_shape(&self) -> ScoreShape {
        ScoreShape::FITNESS
    }

    /// Takes the scores of the current generation, of the shape that it is [`score_shape`](Strategy::score_shape), and makes the
    /// next one; what has but one objective is told as fitness.
    ///
    /// # Errors
    /// [`EvoError::ScoreShape`] for another shape, and those of [`tell`](Strategy::tell); the strategy is then unchanged.
    fn tell_scores(&mut self, scores: &Scores) -> Result<(), EvoError> {
        ScoreShape::FITNESS.check(scores.shape())?;
        self.tell(&scores.fitness())
    }

    /// Number of populations, each of as many individuals.
    fn populations(&self) -> usize {
        1
    }

    /// What has to be recorded of a generation so that it can be rebuilt.
    fn record_kind(&self) -> RecordKind {
        RecordKind::Values
    }

    /// The fitness \[individuals\] that individuals are ranked by if this is what the evaluation gave; of several objectives the
    /// first.
    fn ranked_by(&self, fitness: &[Fitness]) -> Vec<Fitness> {
        fitness.to_vec()
    }

    /// The best individual of each population, counted through all of them, given the fitness that they are
    /// [`ranked_by`](Strategy::ranked_by) \[individuals\]; among equals the lower index.
    fn champions(&self, ranked_by: &[Fitness]) -> Vec<usize> {
        let size = (ranked_by.len() / self.populations().max(1)).max(1);
        let best = |own| Statistics::from_fitness(own).map_or(0, |summary| summary.best_index);
        ranked_by.chunks(size).enumerate().map(|(population, own)| population * size + best(own)).collect()
    }

    /// How the state is saved and taken back, if it can be; else a strategy goes on by being told everything again.
    fn snapshot(&mut self) -> Option<&mut dyn Snapshot> {
        None
    }

    /// Who descends from whom, where individuals have parents.
    fn genealogy(&self) -> Option<&dyn Genealogy> {
        None
    }

    /// Whom each individual meets, where the strategy says so; else that is the caller's choice.
    fn opponents(&self) -> Option<&dyn Opponents<G>> {
        None
    }

    /// What is kept beyond a generation, where the result of a search is more than its champion.
    fn collection(&self) -> Option<&dyn Collection> {
        None
    }

    /// Whether the champion of a search is the best individual of all generations instead of the last one's, as of a strategy
    /// whose generations are not meant to be better than those before: one that fills an archive, or only guesses.
    ///
    /// By default where something is [kept](Strategy::collection).
    fn champion_is_best_ever(&self) -> bool {
        self.collection().is_some()
    }

    /// Numbers of its own about the latest generation that it was told, such as a step size: as many each time, empty if there
    /// are none.
    fn diagnostics(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Takes plain values \[individuals\]; a NaN is a failed evaluation.
    ///
    /// # Errors
    /// Those of [`tell`](Strategy::tell).
    fn tell_values(&mut self, values: &[f64]) -> Result<(), EvoError> {
        let fitness: Vec<Fitness> = values.iter().copied().map(Fitness::nan_as_failed).collect();
        self.tell(&fitness)
    }

    /// Evaluates so many generations, where `judge` writes the objectives and then the measures of a genome \[genes\] into
    /// a row [m + d] of zeros, and returns the best individual of them by the first objective; a NaN is a failed evaluation.
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

    /// Evaluates so many generations, where `evaluate` says how good a genome \[genes\] is, and returns the best individual
    /// of them; a NaN is a failed evaluation.
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
    /// [`EvoError::NoBest`] for no generations, [`EvoError::LastGeneration`].
    fn maximize(&mut self, generations: u32, mut evaluate: impl FnMut(&[G]) -> f64) -> Result<Champion<G>, EvoError>
    where
        Self: Sized,
    {
        let mut champion = None;
        for _ in 0..generations {
            let fitness: Vec<Fitness> =
                self.ask().iter().map(|genes| Fitness::nan_as_failed(evaluate(genes))).collect();
            Champion::keep(&mut champion, self.generation(), self.ask(), &fitness)?;
            self.tell(&fitness)?;
        }
        champion.ok_or(EvoError::NoBest { generation: self.generation() })
    }
}

/// The ability to say whose children the individuals of a generation are.
pub trait Genealogy {
    /// The parents of an individual of the generation that waits for its fitness, as indices in the generation before;
    /// none in generation 0, for an individual without parents, and for one that does not exist.
    fn parents_of(&self, individual: usize) -> Vec<usize>;
}

/// The ability to say whom each individual of a generation meets, [`Strategy::meetings`](crate::Strategy::meetings): for
/// strategies of several populations that are told what was earned against each opponent.
///
/// Such a strategy is judged by 1 + m objectives for m opponents: the fitness of all trials, and then the fitness of the trials
/// against each opponent, in their order. In trial `t` an individual meets the opponent of number `t` modulo m, so that there
/// have to be m trials or more.
pub trait Opponents<G: Gene = u16> {
    /// Number of opponents m that each individual of a generation meets, at least 1.
    fn count(&self) -> usize;

    /// The genomes that an individual of the generation that waits for its fitness meets in the trials of an opponent: one of each
    /// other population, in the order of the populations. Individuals are counted through all populations, opponents from 0
    /// to m - 1; nobody is met beyond the last of either.
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
    /// All that are kept, in an order that says nothing.
    fn members(&self) -> Vec<Member<'_>>;
}

/// The number of the next generation, if `fitness` has one value for each of `population` individuals.
pub(crate) fn next_generation(generation: u32, population: usize, fitness: &[Fitness]) -> Result<u32, EvoError> {
    if fitness.len() != population {
        return Err(EvoError::FitnessCount { expected: population, found: fitness.len() });
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
