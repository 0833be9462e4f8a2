//! Formulas of terms and conditions.

use farsa_lab::Error;

/// Quantities of formulas as measures of terms.
mod call;
/// Values of channels.
pub(crate) mod channels;
/// Compilation with units.
pub(crate) mod compile;
/// Parts of formulas.
mod nodes;
/// Compiled formulas.
pub(crate) mod program;
/// Syntax.
mod syntax;
#[cfg(test)]
mod tests;
/// Tokens of formulas.
mod token;
/// Units of quantities.
mod unit;

/// Describes an unknown name with the nearest valid one.
fn unknown<'n>(what: &'static str, name: &str, valid: impl IntoIterator<Item = &'n str>) -> String {
    match Error::unknown("", what, name, valid) {
        Error::Setting { why, .. } => why,
        other => other.to_string(),
    }
}
