//! What every search strategy over genes offers.

use alloc::vec::Vec;

use crate::champion::Champion;
use crate::error::EvoError;
use crate::fitness::Fitness;
use crate::population::Population;

/// A search over genomes of 16-bit genes that is asked for a generation and told how well it did.
///
/// The caller evaluates [`ask`](Strategy::ask)'s genomes in any order and on any number of threads, then calls
/// [`tell`](Strategy::tell) once. Implementations draw random numbers only from [`farsa_num::Stream`]s named by seed,
/// individual and generation, so that any past genome can be rebuilt without evaluating anything.
pub trait Strategy {
    /// The number of the generation that waits for its fitness, from 0.
    fn generation(&self) -> u32;

    /// The genomes of the current generation [individuals x genes].
    fn ask(&self) -> &Population;

    /// Takes the fitness \[individuals\] of the current generation and makes the next one.
    ///
    /// # Errors
    /// [`EvoError::FitnessCount`] or [`EvoError::LastGeneration`]; the strategy is then unchanged.
    fn tell(&mut self, fitness: &[Fitness]) -> Result<(), EvoError>;

    /// The same with plain values \[individuals\]; a NaN is a failed life.
    ///
    /// # Errors
    /// Those of [`tell`](Strategy::tell).
    fn tell_values(&mut self, values: &[f64]) -> Result<(), EvoError> {
        let fitness: Vec<Fitness> = values.iter().copied().map(Fitness::nan_as_failed).collect();
        self.tell(&fitness)
    }

    /// Lives so many generations, in which `evaluate` says how good a genome \[genes\] is, and returns the best individual
    /// of them; a NaN is a failed life.
    ///
    /// ```
    /// use farsa_evo::{GaConfig, Strategy, TruncationGa};
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
    fn maximize(&mut self, generations: u32, mut evaluate: impl FnMut(&[u16]) -> f64) -> Result<Champion, EvoError>
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

    /// The genomes of this or an earlier generation [individuals x genes], bit for bit as they were evaluated.
    ///
    /// # Errors
    /// [`EvoError::NoSuchGeneration`] when it lies ahead.
    fn genomes_at(&self, generation: u32) -> Result<Population, EvoError>;

    /// The genome \[genes\] of one individual of this or an earlier generation.
    ///
    /// # Errors
    /// [`EvoError::NoSuchGeneration`] when it lies ahead, [`EvoError::NoSuchIndividual`] beyond the population.
    fn genome_of(&self, generation: u32, individual: usize) -> Result<Vec<u16>, EvoError>;
}

/// The number of the next generation, if `fitness` has one value for each of `population` individuals.
pub(crate) fn next_generation(generation: u32, population: usize, fitness: &[Fitness]) -> Result<u32, EvoError> {
    if fitness.len() != population {
        return Err(EvoError::FitnessCount { expected: population, found: fitness.len() });
    }
    generation.checked_add(1).ok_or(EvoError::LastGeneration)
}
