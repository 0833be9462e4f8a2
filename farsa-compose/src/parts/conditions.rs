//! Conditions that are formulas.

use farsa_lab::Error;

use crate::check::source::Source;
use crate::document::{Condition, Document};
use crate::formula::channels::ChannelNames;
use crate::formula::compile::{Make, Scope};
use crate::formula::program::Program;

/// Conditions with formulas, and the terms that they measure in addition to those of the document.
#[derive(Clone, Debug, Default)]
pub(crate) struct FormulaConditions {
    /// Conditions with their paths.
    conditions: Vec<(String, FormulaCondition)>,
    /// Number of terms of the document.
    shown: usize,
    /// Paths of the additional terms.
    pub(crate) paths: Vec<String>,
}

/// A formula over the values of additional terms.
#[derive(Clone, Debug)]
pub(crate) struct FormulaCondition {
    pub(crate) program: Program,
    /// First term of the formula, and the one after the last.
    pub(crate) terms: [usize; 2],
    /// Time for which it must hold [s].
    pub(crate) duration: Option<f64>,
}

impl FormulaConditions {
    /// Compiles the formulas of success, failure and end, and appends their quantities to the terms of the document.
    pub(crate) fn new<T>(
        document: &Document,
        channels: ChannelNames<'_>,
        terms: &mut Vec<T>,
        make: Make<'_, T>,
        source: &Source,
    ) -> Result<Self, Error> {
        let mut made = Self { shown: terms.len(), ..Self::default() };
        let lists = [("success", &document.success), ("failure", &document.failure), ("end", &document.end)];
        for (list, conditions) in lists {
            for (index, condition) in conditions.iter().enumerate() {
                let Condition { formula: Some(text), .. } = condition else { continue };
                let path = format!("/{list}/{index}");
                let scope = Scope { path: &format!("{path}/formula"), channels, source };
                let compiled = scope.condition(text, &mut *make)?;
                let first = terms.len();
                terms.extend(compiled.formula.terms);
                made.paths.resize(terms.len() - made.shown, path.clone());
                let terms = [first, terms.len()];
                let condition =
                    FormulaCondition { program: compiled.formula.program, terms, duration: compiled.duration };
                made.conditions.push((path, condition));
            }
        }
        Ok(made)
    }

    /// Returns the formula of the condition at a path.
    pub(crate) fn take(&mut self, path: &str) -> Option<FormulaCondition> {
        let place = self.conditions.iter().position(|(known, _)| known == path)?;
        Some(self.conditions.swap_remove(place).1)
    }
}
