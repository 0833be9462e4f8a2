//! The strategy that an experiment is searched by unless another one is asked for.

use farsa_lab::{StrategyDefinition, Truncation, strategies};

/// The strategy of a name; truncation selection for a name that there is not.
pub(crate) fn strategy(name: &str) -> &'static dyn StrategyDefinition {
    let found = strategies().iter().find(|strategy| strategy.name() == name).copied();
    debug_assert!(found.is_some(), "no strategy {name}");
    found.unwrap_or(&Truncation)
}
