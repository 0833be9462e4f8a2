//! The `farsa` command, end to end: over the reference experiments and over those of a crate outside the workspace.

mod attack;
mod bad_input;
mod cases;
mod cluster;
mod configurations;
mod export;
mod files;
mod genotypes;
mod guide;
mod individuals;
mod keyframes;
mod lines;
mod live;
mod look;
mod manners;
mod memory;
mod merge;
mod own;
mod replications;
mod report;
mod robot;
mod same_bytes;
mod serve;
mod strangers;
mod sweep;
mod tool;
