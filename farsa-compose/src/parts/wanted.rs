//! Conditions of success and failure.

use farsa_lab::Error;

use crate::check::source::Source;
use crate::document::Condition;
use crate::parts::groups::Groups;
use crate::parts::tally::Tally;

/// A condition on a term, by number.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wanted {
    pub(crate) term: usize,
    /// Evolving robots for which the condition is, by default any.
    of: Option<[usize; 2]>,
    above: Option<f64>,
    below: Option<f64>,
}

impl Wanted {
    /// Reads the condition at a path.
    pub(crate) fn new(
        condition: &Condition,
        path: &str,
        names: &[String],
        groups: &Groups,
        source: &Source,
    ) -> Result<Self, Error> {
        let Condition { term, of, above, below } = condition;
        let term = source.position(names.iter().map(String::as_str), ("term", term), &format!("{path}/term"))?;
        if above.is_none() && below.is_none() {
            return Err(source.wrong(path, "lacks `above` and `below`: one of them at least"));
        }
        let of = of.as_ref().map(|name| groups.find(name, &format!("{path}/of"), source)).transpose()?;
        Ok(Self { term, of, above: *above, below: *below })
    }

    /// Checks if the condition is for trials in which these robots evolve.
    pub(crate) fn is_for(&self, evolving: [usize; 2]) -> bool {
        self.of.is_none_or(|of| of == evolving)
    }

    /// Checks if the condition holds after the last step.
    pub(crate) fn holds(&self, terms: &[Tally]) -> bool {
        let value = terms[self.term].last;
        self.above.is_none_or(|above| value > above) && self.below.is_none_or(|below| value < below)
    }
}
