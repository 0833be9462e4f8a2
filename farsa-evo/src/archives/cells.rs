//! How the space of measures is divided.

/// A division of the space of measures into cells.
pub trait Cells {
    /// Number of cells.
    fn cells(&self) -> usize;

    /// Number of values d of a measures.
    fn measures(&self) -> usize;

    /// The number of the cell, from 0, of a finite measures \[d\].
    fn cell(&self, measures: &[f64]) -> usize;
}
