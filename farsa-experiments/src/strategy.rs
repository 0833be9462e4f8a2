//! The strategies that the experiments use by default.

use farsa_lab::strategy::{StrategyDefinition, Truncation, strategies};

/// The strategy of a name, or truncation selection for an unknown one.
pub(crate) fn strategy(name: &str) -> &'static dyn StrategyDefinition {
    let strategy = strategies().iter().find(|strategy| strategy.name() == name).copied();
    debug_assert!(strategy.is_some(), "no strategy {name}");
    strategy.unwrap_or(&Truncation)
}
