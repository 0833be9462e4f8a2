//! An archive that keeps the best individual of each cell.

use alloc::vec;
use alloc::vec::Vec;

use crate::archives::grid_cells::Cells;
use crate::error::EvoError;
use crate::population::Population;
use crate::real::bounds::check_within;
use crate::snapshot::{StateReader, push_reals};
use crate::strategy::Member;

/// The slot of a cell without an elite.
const EMPTY: u32 = u32::MAX;

/// An archive that keeps the best individual found so far for each cell. This individual is called the elite of the
/// cell.
///
/// ```
/// use farsa_evo::archives::{Addition, Archive, GridCells};
///
/// let mut archive = Archive::new(GridCells::new(vec![[0.0, 1.0]], vec![10])?, 2)?;
/// assert_eq!(archive.add(&[1.0, 2.0], 3.0, &[0.55])?, Addition::New);
/// assert_eq!(archive.add(&[0.0, 0.0], 2.5, &[0.51])?, Addition::None);
/// assert_eq!(archive.add(&[4.0, 4.0], 3.5, &[0.58])?, Addition::Better { by: 0.5 });
/// assert_eq!((archive.len(), archive.elite(5).map(|elite| elite.objective)), (1, Some(3.5)));
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Archive<C> {
    cells: C,
    genes: usize,
    /// The slot of each cell's elite.
    slots: Vec<u32>,
    /// The cell of each slot, in the order in which they were filled.
    filled: Vec<u32>,
    /// [slots x genes]
    genomes: Vec<f64>,
    /// \[slots\]
    objectives: Vec<f64>,
    /// [slots x d]
    measures: Vec<f64>,
    /// The generation and the individual \[slots\].
    origins: Vec<[u32; 2]>,
}

/// Result of adding an individual to an archive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Addition {
    /// It is the first individual of its cell.
    New,
    /// It is better than the elite of its cell and has replaced it.
    Better {
        /// Difference between the new and the previous objective.
        by: f64,
    },
    /// It was not added, since it is not better than the elite or its evaluation failed.
    None,
}

/// Best individual of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elite<'a> {
    /// Number of the cell.
    pub cell: usize,
    /// Genes of the individual \[genes\].
    pub genes: &'a [f64],
    /// Objective of the individual, in the unit that the experiment uses.
    pub objective: f64,
    /// Measures of the individual \[d\].
    pub measures: &'a [f64],
    /// Generation in which it was evaluated. This is 0 if you added it with [`Archive::add`].
    pub generation: u32,
    /// Index in that generation. This is 0 if you added it with [`Archive::add`].
    pub individual: usize,
}

impl<C: Cells> Archive<C> {
    /// Creates an empty archive for genomes with the given number of genes.
    ///
    /// # Errors
    /// Returns [`EvoError::Config`] for no genes, no cells, or more genes or measures of all cells than
    /// [`Population::MAX_GENES`].
    pub fn new(cells: C, genes: usize) -> Result<Self, EvoError> {
        Population::check(cells.cells(), genes)?;
        Population::check(cells.cells(), cells.measures())?;
        let slots = vec![EMPTY; cells.cells()];
        let (filled, genomes, objectives) = (Vec::new(), Vec::new(), Vec::new());
        Ok(Self { cells, genes, slots, filled, genomes, objectives, measures: Vec::new(), origins: Vec::new() })
    }

    /// Gets the division into cells.
    pub fn cells(&self) -> &C {
        &self.cells
    }

    /// Number of elites in the archive.
    pub fn len(&self) -> usize {
        self.filled.len()
    }

    /// Checks whether the archive has no elites.
    pub fn is_empty(&self) -> bool {
        self.filled.is_empty()
    }

    /// Gets the elite of a cell, or `None` if the cell is still empty.
    pub fn elite(&self, cell: usize) -> Option<Elite<'_>> {
        self.slots.get(cell).and_then(|slot| self.slot(*slot as usize))
    }

    /// An iterator over all elites, in the order in which their cells were filled.
    pub fn elites(&self) -> impl Iterator<Item = Elite<'_>> {
        (0..self.len()).filter_map(|slot| self.slot(slot))
    }

    /// Computes the sum of all objectives. If none of them is negative, this is the QD score.
    pub fn sum(&self) -> f64 {
        self.objectives.iter().sum()
    }

    /// Adds an individual with these genes \[genes\] and measures \[d\], provided that it is the first of its cell or
    /// better than the elite. An individual is never added if its objective is NaN or minus infinity, or if its
    /// measures are not finite.
    ///
    /// # Errors
    /// Returns [`EvoError::Shape`] for another number of genes or measures.
    pub fn add(&mut self, genes: &[f64], objective: f64, measures: &[f64]) -> Result<Addition, EvoError> {
        if genes.len() != self.genes {
            return Err(EvoError::lengths(genes.len(), self.genes, self.genes));
        }
        if measures.len() != self.cells.measures() {
            let d = self.cells.measures();
            return Err(EvoError::lengths(measures.len(), d, d));
        }
        Ok(self.insert(genes, objective, measures, [0, 0]))
    }

    /// The same for lengths that are right.
    pub(super) fn insert(&mut self, genes: &[f64], objective: f64, measures: &[f64], origin: [u32; 2]) -> Addition {
        // Negated, so that NaN is refused.
        if !(objective > f64::NEG_INFINITY && measures.iter().all(|x| x.is_finite())) {
            return Addition::None;
        }
        let cell = self.cells.cell(measures);
        let slot = self.slots[cell] as usize;
        // An empty cell has a slot beyond the last one.
        let Some(&elite) = self.objectives.get(slot) else {
            self.slots[cell] = self.filled.len() as u32;
            self.filled.push(cell as u32);
            self.genomes.extend_from_slice(genes);
            self.objectives.push(objective);
            self.measures.extend_from_slice(measures);
            self.origins.push(origin);
            return Addition::New;
        };
        if objective <= elite {
            return Addition::None;
        }
        // The slot stays, so the order of elites is that in which cells were filled.
        let d = measures.len();
        self.genomes[slot * self.genes..(slot + 1) * self.genes].copy_from_slice(genes);
        self.measures[slot * d..(slot + 1) * d].copy_from_slice(measures);
        (self.objectives[slot], self.origins[slot]) = (objective, origin);
        Addition::Better { by: objective - elite }
    }

    /// The elite of a slot, counted in the order in which cells were filled.
    pub(super) fn slot(&self, slot: usize) -> Option<Elite<'_>> {
        let d = self.cells.measures();
        let [generation, individual] = *self.origins.get(slot)?;
        Some(Elite {
            cell: *self.filled.get(slot)? as usize,
            genes: self.genomes.get(slot * self.genes..(slot + 1) * self.genes)?,
            objective: *self.objectives.get(slot)?,
            measures: self.measures.get(slot * d..(slot + 1) * d)?,
            generation,
            individual: individual as usize,
        })
    }

    /// All elites as what a strategy keeps.
    pub(super) fn members(&self) -> impl Iterator<Item = Member<'_>> {
        self.elites().zip(&self.objectives).map(|(elite, objective)| Member {
            cell: Some(elite.cell),
            objectives: core::slice::from_ref(objective),
            measures: elite.measures,
            generation: elite.generation,
            individual: elite.individual,
        })
    }

    /// Bytes of an elite that is saved.
    fn elite_length(&self) -> usize {
        4 + 8 + 8 * (1 + self.genes + self.cells.measures())
    }

    /// Bytes of a state with the given number of elites.
    pub(super) fn state_length(&self, elites: usize) -> usize {
        4 + elites.saturating_mul(self.elite_length())
    }

    pub(super) fn save(&self, state: &mut Vec<u8>) {
        state.extend((self.len() as u32).to_le_bytes());
        for elite in self.elites() {
            for number in [elite.cell as u32, elite.generation, elite.individual as u32] {
                state.extend(number.to_le_bytes());
            }
            push_reals(state, &[elite.objective]);
            push_reals(state, elite.measures);
            push_reals(state, elite.genes);
        }
    }

    /// The elites of a saved state, whose genes must be within bounds.
    pub(super) fn read(&self, reader: &mut StateReader<'_>, bounds: &[[f64; 2]]) -> Result<Self, EvoError>
    where
        C: Clone,
    {
        let mut read = Self::new(self.cells.clone(), self.genes)?;
        let elites = reader.u32()?;
        let (mut genes, mut measures) = (Population::new(1, self.genes)?, vec![0.0; self.cells.measures()]);
        for _ in 0..elites {
            let [cell, generation, individual] = [reader.u32()?, reader.u32()?, reader.u32()?];
            let objective = reader.fitness()?.get();
            reader.reals(&mut measures)?;
            reader.reals(genes.as_mut_slice())?;
            check_within(&genes, bounds)?;
            let added = read.insert(genes.as_slice(), objective, &measures, [generation, individual]);
            // Elites are saved in the order of their slots, so inserting them fills the same slots. Each must be the
            // first in the cell of its measures.
            if added != Addition::New || read.filled.last() != Some(&cell) {
                return Err(EvoError::state_content("the cell of an elite", cell.into()));
            }
        }
        Ok(read)
    }
}
