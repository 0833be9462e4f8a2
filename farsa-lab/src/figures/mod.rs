//! Curves and the statistics in them.
//!
//! - `bootstrap`: how far a median would move with other runs
//! - `fixture`: the numbers of another program that the tests here compare with
//! - `mann_whitney`: an exact test of two groups of values, and a normal one where they are many
//! - `normal`: the standard normal distribution
//! - `plot`: Curves over generations as SVG: `fitness.svg` of a run and the figures of a report
//! - `proportion`: shares of successes: their intervals, and whether two of them differ
//! - `scatter`: points in two dimensions as SVG, darker where a third value is larger
//! - `statistics`: Order statistics over a few runs

pub(crate) mod bootstrap;
#[cfg(test)]
mod fixture;
pub(crate) mod mann_whitney;
mod normal;
pub(crate) mod plot;
pub(crate) mod proportion;
pub(crate) mod scatter;
pub(crate) mod statistics;
