//! A strategy of a name, a line, a table and a function.

use crate::error::Error;
use crate::experiment::settings::Setting;
use crate::strategy::any_strategy::AnyStrategy;
use crate::strategy::definition::{Diagnostics, StrategyDefinition, StrategyStart};

/// A simple [`StrategyDefinition`] that is given by a few constants and functions.
///
/// ```
/// use farsa_evo::gradient::{Snes, SnesConfig};
/// use farsa_lab::Setting;
/// use farsa_lab::strategy::SimpleStrategy;
///
/// static NARROW: SimpleStrategy = SimpleStrategy {
///     name: "narrow-snes",
///     summary: "A natural evolution strategy that begins near the middle of all ranges.",
///     settings: || vec![Setting::whole("evolution.generations", 200, 1..=1_000_000).doc("Generations.")],
///     start: |start| start.reals(|seed| Snes::new(SnesConfig::new(vec![0.0; start.genes], 0.01), seed)),
///     diagnostics: None,
/// };
/// ```
#[derive(Clone, Copy)]
pub struct SimpleStrategy {
    /// Name on the command line. It may contain lower-case letters, digits and hyphens.
    pub name: &'static str,
    /// Short description of the method with its source, in one line.
    pub summary: &'static str,
    /// Builds the table of all settings, with their defaults.
    pub settings: fn() -> Vec<Setting>,
    /// Creates the strategy at its first generation.
    pub start: fn(&StrategyStart<'_>) -> Result<AnyStrategy, Error>,
    /// Layout of its [`diagnostics`](farsa_evo::Strategy::diagnostics) in files and pictures. Use `None` if it has
    /// none.
    pub diagnostics: Option<Diagnostics>,
}

impl StrategyDefinition for SimpleStrategy {
    fn name(&self) -> &'static str {
        self.name
    }

    fn summary(&self) -> &'static str {
        self.summary
    }

    fn settings(&self) -> Vec<Setting> {
        (self.settings)()
    }

    fn start(&self, start: &StrategyStart<'_>) -> Result<AnyStrategy, Error> {
        (self.start)(start)
    }

    fn diagnostics(&self) -> Option<Diagnostics> {
        self.diagnostics
    }
}
