//! Divisions of the space of measures into cells, and the grid.

use alloc::vec::Vec;

use crate::error::{EvoError, check_setting};
use crate::population::Population;
use crate::real::bounds::check_bounds;

/// A division of the space of measures into cells.
pub trait Cells {
    /// Number of cells.
    fn cells(&self) -> usize;

    /// Number of measures d.
    fn measures(&self) -> usize;

    /// Finds the cell that the measures \[d\] belong to. Cells are numbered from 0, and the measures must be finite.
    fn cell(&self, measures: &[f64]) -> usize;
}

/// A grid that divides the range of each measure into parts of the same width.
///
/// If a value is out of its range, it belongs to the first or last part. Cells are numbered so that the last measure
/// varies fastest. Note that a grid can have at most [`Population::MAX_GENES`] cells.
///
/// Source: \[Mouret2015\].
///
/// ```
/// use farsa_evo::archives::{Cells, GridCells};
///
/// let grid = GridCells::new(vec![[0.0, 1.0], [-1.0, 1.0]], vec![10, 4])?;
/// assert_eq!((grid.cells(), grid.cell(&[0.25, 0.0]), grid.cell(&[7.0, -9.0])), (40, 10, 36));
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "RawGrid"))]
pub struct GridCells {
    /// The range of each measure \[d\].
    bounds: Vec<[f64; 2]>,
    /// The parts of each range \[d\].
    parts: Vec<usize>,
}

impl GridCells {
    /// Creates a grid over the given ranges \[d\], from low to high. Each range is divided into the given number of
    /// parts \[d\].
    ///
    /// # Errors
    /// Returns [`EvoError::Config`] for no ranges or too many cells, [`EvoError::OutOfRange`] for other numbers.
    pub fn new(bounds: Vec<[f64; 2]>, parts: Vec<usize>) -> Result<Self, EvoError> {
        check_bounds(1, &bounds)?;
        let (found, wanted) = (parts.len(), bounds.len());
        check_setting(found == wanted, "the number of divided ranges", found as f64, "one for each descriptor value")?;
        for &[low, high] in &bounds {
            check_setting(low < high, "the high end of a descriptor value", high, "above its low end")?;
        }
        for &part in &parts {
            check_setting(part > 0, "the number of parts of a range", part as f64, "1 or more")?;
        }
        Population::check(parts.iter().fold(1, |cells: usize, part| cells.saturating_mul(*part)), 1)?;
        Ok(Self { bounds, parts })
    }

    /// Range of each measure \[d\].
    pub fn bounds(&self) -> &[[f64; 2]] {
        &self.bounds
    }

    /// Number of parts that each range is divided into \[d\].
    pub fn parts(&self) -> &[usize] {
        &self.parts
    }
}

impl Cells for GridCells {
    fn cells(&self) -> usize {
        self.parts.iter().product()
    }

    fn measures(&self) -> usize {
        self.bounds.len()
    }

    fn cell(&self, measures: &[f64]) -> usize {
        let ranges = measures.iter().zip(&self.bounds).zip(&self.parts);
        ranges.fold(0, |cell, ((x, [low, high]), parts)| {
            // The float is at most the number of parts, and the conversion makes negative numbers 0.
            let part = ((x - low) / (high - low) * *parts as f64) as usize;
            cell * parts + part.min(parts - 1)
        })
    }
}

/// A grid as it is read.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(rename = "GridCells")]
struct RawGrid {
    bounds: Vec<[f64; 2]>,
    parts: Vec<usize>,
}

#[cfg(feature = "serde")]
impl TryFrom<RawGrid> for GridCells {
    type Error = EvoError;

    fn try_from(raw: RawGrid) -> Result<Self, EvoError> {
        Self::new(raw.bounds, raw.parts)
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// The cell that is found by walking along each axis.
        #[test]
        fn a_cell_is_the_one_of_a_walk(
            x in -2.0_f64..3.0,
            y in -20_i32..20,
            parts in proptest::array::uniform2(1_usize..9),
        ) {
            let y = f64::from(y) * 0.25;
            let grid = GridCells::new(vec![[-1.0, 2.0], [0.0, 4.0]], parts.to_vec()).unwrap();
            let walk = |x: f64, low: f64, width: f64, parts: usize| {
                (1..parts).filter(|i| (x - low) / width * parts as f64 >= *i as f64).count()
            };
            let want = walk(x, -1.0, 3.0, parts[0]) * parts[1] + walk(y, 0.0, 4.0, parts[1]);
            prop_assert_eq!(grid.cell(&[x, y]), want);
            prop_assert!(want < grid.cells());
        }
    }

    #[test]
    fn impossible_grids_are_refused() {
        let refused =
            |bounds: &[[f64; 2]], parts: &[usize]| GridCells::new(bounds.to_vec(), parts.to_vec()).unwrap_err();
        assert_eq!(refused(&[], &[]), EvoError::no_genes());
        let setting = |error| match error {
            EvoError::OutOfRange { field, value, .. } => (field, value),
            other => panic!("{other}"),
        };
        assert_eq!(setting(refused(&[[0.0, 1.0]], &[3, 4])), ("the number of divided ranges", 2.0));
        assert_eq!(setting(refused(&[[1.0, 1.0]], &[3])), ("the high end of a descriptor value", 1.0));
        assert_eq!(setting(refused(&[[0.0, f64::NAN]], &[3])).0, "the high end of a gene");
        assert_eq!(setting(refused(&[[0.0, 1.0]], &[0])), ("the number of parts of a range", 0.0));
        let many = refused(&[[0.0, 1.0]; 9], &[usize::MAX; 9]);
        assert_eq!(many, EvoError::too_large(usize::MAX, 1));
    }
}
