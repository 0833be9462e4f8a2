//! The best individual that a search has found.

use alloc::vec::Vec;

use crate::error::EvoError;
use crate::fitness::Fitness;
use crate::gene::Gene;
use crate::population::Population;
use crate::statistics::Statistics;

/// The best individual of a search so far, with its genome.
///
/// A strategy does not keep it. Where fitness is noisy, the best individual so far is also the luckiest. A search that
/// needs it keeps it like this:
///
/// ```
/// use farsa_evo::{Champion, Fitness, Strategy};
/// use farsa_evo::words::{GaConfig, TruncationGa};
///
/// let mut evolution = TruncationGa::new(GaConfig::new(4), 42)?;
/// let mut champion: Option<Champion> = None;
/// for _ in 0..30 {
///     let values: Vec<f64> = evolution.ask().iter().map(|genes| f64::from(genes[0])).collect();
///     let fitness: Vec<Fitness> = values.into_iter().map(Fitness::nan_as_failed).collect();
///     Champion::keep(&mut champion, evolution.generation(), evolution.ask(), &fitness)?;
///     evolution.tell(&fitness)?;
/// }
/// let champion = champion.expect("thirty generations");
/// assert_eq!(champion.fitness.get(), f64::from(champion.genome[0]));
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Champion<G = u16> {
    /// Its generation.
    pub generation: u32,
    /// Its index in that generation.
    pub individual: usize,
    /// Its fitness, in the experiment's own unit.
    pub fitness: Fitness,
    /// Its genome \[genes\].
    pub genome: Vec<G>,
}

impl<G: Gene> Champion<G> {
    /// Replaces the best so far by the best of a generation, if that is better, given the fitness \[individuals\] of its
    /// population. Among equals the earliest stays.
    ///
    /// # Errors
    /// [`EvoError::Shape`]. The best individual so far is then unchanged.
    pub fn keep(
        best: &mut Option<Self>,
        generation: u32,
        population: &Population<G>,
        fitness: &[Fitness],
    ) -> Result<(), EvoError> {
        let counts = || EvoError::fitness_count(population.len(), fitness.len());
        if fitness.len() != population.len() {
            return Err(counts());
        }
        let individual = Statistics::from_fitness(fitness).map_or(0, |summary| summary.best_index);
        let (Some(&fitness), Some(genome)) = (fitness.get(individual), population.get(individual)) else {
            return Err(counts());
        };
        if best.as_ref().is_none_or(|best| fitness > best.fitness) {
            *best = Some(Self { generation, individual, fitness, genome: genome.to_vec() });
        }
        Ok(())
    }
}
