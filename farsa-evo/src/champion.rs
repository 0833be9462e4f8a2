//! Best individual that a search has found so far.

use alloc::vec::Vec;

use crate::error::EvoError;
use crate::fitness::Fitness;
use crate::gene::Gene;
use crate::population::Population;
use crate::statistics::Statistics;

/// Best individual that a search has found so far, together with its genome.
///
/// A strategy does not keep its champion by itself. Note that if fitness is noisy, the best individual so far is also
/// the luckiest one. If you need it anyway, you can keep it like this:
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
    /// Generation in which it was evaluated.
    pub generation: u32,
    /// Index of the individual in that generation.
    pub individual: usize,
    /// Fitness of the individual, in the unit that the experiment uses.
    pub fitness: Fitness,
    /// Genome of the individual \[genes\].
    pub genome: Vec<G>,
}

impl<G: Gene> Champion<G> {
    /// Replaces the best individual so far if a generation contains a better one, given the fitness \[individuals\] of
    /// its population. Note that an equally good individual does not replace an earlier one.
    ///
    /// # Errors
    /// Returns [`EvoError::Shape`]. The best individual so far is then unchanged.
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
