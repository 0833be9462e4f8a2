//! Arguments of the command line.

/// `farsa export`, with the formats of files.
pub(crate) mod export;
/// `farsa new` and `farsa check`.
pub(crate) mod files;
/// `farsa evaluate` and `farsa import`.
pub(crate) mod genotypes;
/// `farsa lab`.
pub(crate) mod lab;
/// `farsa merge`.
pub(crate) mod merge;
/// `farsa robot`.
pub(crate) mod robot;
/// Arguments that several subcommands share.
pub(crate) mod shared;
/// All subcommands, with the arguments of the shorter ones.
pub(crate) mod subcommands;
/// `farsa sweep`.
pub(crate) mod sweep;
