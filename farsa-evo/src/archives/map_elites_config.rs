//! What MAP-Elites needs to know.

use alloc::vec::Vec;

use crate::archives::emitter::Emitter;
use crate::error::EvoError;
use crate::population::Population;
use crate::real::bounds::{check_bounds, check_setting};

/// What a [`MapElites`](crate::archives::MapElites) needs to know besides its cells; a plain value that is checked where it is used.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MapElitesConfig {
    /// The range of each gene, low to high \[genes\], -1e100 to 1e100; equal ends freeze a gene, but for the improvement
    /// emitter, which needs a range.
    pub bounds: Vec<[f64; 2]>,
    /// Who makes the individuals of a generation, one emitter's after the other's.
    pub emitters: Vec<Emitter>,
}

impl MapElitesConfig {
    /// 100 individuals of the iso-line emitter with the deviations of \[Mouret2018\]. The number is ours.
    pub fn new(bounds: Vec<[f64; 2]>) -> Self {
        Self { bounds, emitters: Vec::from([Emitter::IsoLine { batch: 100, iso_sigma: 0.01, line_sigma: 0.2 }]) }
    }

    /// CMA-ME: so many improvement emitters of \[Fontaine2020\], all starting in the middle of the bounds, each with a batch of
    /// individuals and a step size in the unit of the genes.
    pub fn cma_me(bounds: Vec<[f64; 2]>, emitters: usize, batch: usize, sigma: f64) -> Self {
        let mean: Vec<f64> = bounds.iter().map(|[low, high]| 0.5 * (low + high)).collect();
        let emitters = (0..emitters).map(|_| Emitter::Improvement { batch, mean: mean.clone(), sigma }).collect();
        Self { bounds, emitters }
    }

    /// Individuals of a generation.
    pub fn population(&self) -> usize {
        self.emitters.iter().fold(0, |sum: usize, emitter| sum.saturating_add(emitter.batch()))
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`EvoError::NoIndividuals`] for no emitters, [`EvoError::NoGenes`], [`EvoError::TooLarge`], [`EvoError::Setting`].
    pub fn validate(&self) -> Result<(), EvoError> {
        check_bounds(self.population(), &self.bounds)?;
        self.emitters.iter().try_for_each(|emitter| emitter.check(&self.bounds))?;
        if self.emitters.iter().any(|emitter| matches!(emitter, Emitter::Improvement { .. })) {
            Population::check(self.bounds.len(), self.bounds.len())?;
            for &[low, high] in &self.bounds {
                check_setting(low < high, "the high end of a gene", high, "above its low end")?;
            }
        }
        Ok(())
    }
}
