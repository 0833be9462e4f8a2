//! Common parts of experiments with teams of wheeled robots.

/// Settings of all experiments with many wheeled robots.
pub(crate) mod config;
/// An episode of a team: robots with a controller each, and a scenario.
pub(crate) mod episode;
/// The eyes of a robot of a team.
pub(crate) mod eyes;
/// Nests as robots of a team sense them: the ground, and what shines.
pub(crate) mod nest;
/// Robots with a controller each: what they sense, compute and do.
pub(crate) mod robots;
/// Steering away from seen objects, for controllers without evolution.
pub(crate) mod steering;
/// The task of a team: the description of a scenario, and its episodes over parameters.
pub(crate) mod task;
