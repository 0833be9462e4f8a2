//! Formulas.

use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::term::Constants;
use crate::part::{Moment, PartScene, Term, TermPart};

/// Value of a formula of terms and channels.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Formula {
    /// Formula, such as `1 - distance(lamp) / 0.3 m`.
    #[schemars(length(max = 2000))]
    formula: String,
}

/// A formula, which the world of the experiment compiles.
#[derive(Clone, Debug)]
pub(super) struct FormulaTerm;

impl<W: ?Sized> Term<W> for FormulaTerm {
    fn value(&self, _: &W, _: &Moment<'_>) -> f64 {
        f64::NAN
    }
}

impl TermPart for Formula {
    type Term = FormulaTerm;

    fn term(&self, _: &PartScene<'_>) -> Result<FormulaTerm, Error> {
        Ok(FormulaTerm)
    }

    fn is_constant(&self, of: &dyn Constants) -> bool {
        of.is_constant_formula(&self.formula)
    }

    fn formula(&self) -> Option<&str> {
        Some(&self.formula)
    }
}
