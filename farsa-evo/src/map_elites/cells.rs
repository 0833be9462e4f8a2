//! How the space of descriptors is divided.

/// A division of the space of behaviour descriptors into cells.
pub trait Cells {
    /// Number of cells.
    fn cells(&self) -> usize;

    /// Number of values d of a descriptor.
    fn descriptors(&self) -> usize;

    /// The number of the cell, from 0, of a finite descriptor \[d\].
    fn cell(&self, descriptor: &[f64]) -> usize;
}
