//! Curves and the statistics in them.
//!
//! - `bar_list`: shares as bars with their intervals
//! - `bootstrap`: how far a median would move with other runs
//! - `fixture`: the numbers of another program that the tests here compare with
//! - `heat_map`: a table of shares as SVG, darker where a share is larger
//! - `log_curves`: the log of a run as curves: `fitness.svg`
//! - `mann_whitney`: an exact test of two groups of values, and a normal one where they are many
//! - `normal`: the standard normal distribution
//! - `plot`: Curves over generations as SVG
//! - `principal_components`: the two directions in which points differ most
//! - `proportion`: shares of successes: their intervals, and whether two of them differ
//! - `rates`: shares over a number, as curves with their intervals, as SVG
//! - `scatter`: points in two dimensions as SVG, darker where a third value is larger
//! - `series`: the values of a curve, thinned out as they come
//! - `significant`: Numbers for people, with four significant digits
//! - `statistics`: Order statistics over a few runs
//! - `trajectories`: curves in a plane, a small picture for each case, as SVG

pub(crate) mod bar_list;
pub(crate) mod bootstrap;
#[cfg(test)]
mod fixture;
pub(crate) mod heat_map;
pub(crate) mod log_curves;
pub(crate) mod mann_whitney;
mod normal;
pub(crate) mod plot;
pub(crate) mod principal_components;
pub(crate) mod proportion;
pub(crate) mod rates;
pub(crate) mod scatter;
pub(crate) mod series;
pub(crate) mod significant;
pub(crate) mod statistics;
pub(crate) mod trajectories;
