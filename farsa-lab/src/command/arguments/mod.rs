//! The words of the command line.
//!
//! - `export`: those of `farsa export`, and the formats of files
//! - `files`: those of the commands about files that describe experiments
//! - `genotypes`: those of the commands about genotypes from elsewhere, `farsa evaluate` and `farsa import`
//! - `merge`: those of `farsa merge`
//! - `robot`: those of `farsa robot`
//! - `shared`: those that several commands have
//! - `subcommands`: all subcommands, and the words of those that are short
//! - `sweep`: those of `farsa sweep`

pub(crate) mod export;
pub(crate) mod files;
pub(crate) mod genotypes;
pub(crate) mod merge;
pub(crate) mod robot;
pub(crate) mod shared;
pub(crate) mod subcommands;
pub(crate) mod sweep;
