//! Words that experiment files may use in addition to those of their format.

use std::any::Any;
use std::fmt;
use std::sync::Arc;

use crate::strategy::definition::StrategyDefinition;

/// A part that experiment files may name, such as a sensor of your crate.
///
/// It is created by the crate that reads the files, for example by `farsa_compose::part::sensor`.
#[derive(Clone)]
pub struct Part(Arc<dyn Any + Send + Sync>);

impl Part {
    /// Creates a part from the definition of a crate that reads files.
    pub fn new(definition: impl Any + Send + Sync) -> Self {
        Self(Arc::new(definition))
    }

    /// Gets the definition. Returns `None` for a definition of another crate.
    pub fn definition<T: Any>(&self) -> Option<&T> {
        self.0.downcast_ref()
    }
}

impl fmt::Debug for Part {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("Part")
    }
}

/// Strategies and parts that an experiment file may name.
#[derive(Clone, Copy, Default)]
pub struct Vocabulary<'v> {
    /// Strategies.
    pub strategies: &'v [&'static dyn StrategyDefinition],
    /// Parts in addition to those of the format.
    pub parts: &'v [Part],
}

impl<'v, const N: usize> From<&'v [&'static dyn StrategyDefinition; N]> for Vocabulary<'v> {
    /// Creates a vocabulary without additional parts.
    fn from(strategies: &'v [&'static dyn StrategyDefinition; N]) -> Self {
        Self::from(&strategies[..])
    }
}

impl<'v> From<&'v [&'static dyn StrategyDefinition]> for Vocabulary<'v> {
    /// Creates a vocabulary without additional parts.
    fn from(strategies: &'v [&'static dyn StrategyDefinition]) -> Self {
        Self { strategies, parts: &[] }
    }
}
