//! Curves and the statistics in them.
//!
//! - `plot`: Curves over generations as SVG: `fitness.svg` of a run and the figures of a report
//! - `statistics`: Order statistics over a few runs, and an exact test of two groups of them

pub(crate) mod plot;
pub(crate) mod statistics;
