//! Figures as SVG, and the statistics in them.

/// Shares as bars with their intervals.
pub(crate) mod bar_list;
/// Bootstrap intervals of a median.
pub(crate) mod bootstrap;
/// Curves over generations.
pub(crate) mod chart;
/// Results of other programs for the tests.
#[cfg(test)]
mod fixture;
/// A table of shares, darker where a share is larger.
pub(crate) mod heat_map;
/// Curves of a run's log: `fitness.svg`.
pub(crate) mod log_curves;
/// Mann-Whitney U test.
pub(crate) mod mann_whitney;
/// Standard normal distribution.
mod normal;
/// Exact interval of a median.
pub(crate) mod order_interval;
/// A plane with two axes.
mod plane;
/// First two principal components.
pub(crate) mod principal_components;
/// Intervals of shares, and Fisher's exact test.
pub(crate) mod proportion;
/// Shares over a number, as curves with their intervals.
pub(crate) mod rates;
/// Points in two dimensions, darker where a third value is larger.
pub(crate) mod scatter;
/// Values of a curve, thinned while they are added.
pub(crate) mod series;
/// Numbers with four significant digits.
pub(crate) mod significant;
/// Order statistics of a few runs.
pub(crate) mod statistics;
/// Frame, colors, legend and coordinates of all figures.
pub(crate) mod svg;
/// Curves in a plane, a panel for each case.
pub(crate) mod trajectories;
