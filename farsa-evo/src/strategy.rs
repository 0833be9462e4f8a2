//! What every search strategy over genes offers.

use alloc::vec::Vec;

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
