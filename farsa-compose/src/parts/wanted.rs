//! Conditions of success and failure.

use farsa_lab::Error;

use crate::check::source::Source;
use crate::document::Condition;
use crate::parts::tally::Tally;

/// A condition on a term, by number.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wanted {
    pub(crate) term: usize,
    above: Option<f64>,
    below: Option<f64>,
}

impl Wanted {
    /// Reads the condition at a path.
    pub(crate) fn new(condition: &Condition, path: &str, names: &[String], source: &Source) -> Result<Self, Error> {
        let Condition { term, above, below } = condition;
        let names_of = names.iter().map(String::as_str);
        let place = source.of(&format!("{path}/term"));
        let number = names.iter().position(|name| name == term);
        let term = number.ok_or_else(|| Error::unknown(&place, "term", term, names_of))?;
        if above.is_none() && below.is_none() {
            return Err(source.wrong(path, "lacks `above` and `below`: one of them at least"));
        }
        Ok(Self { term, above: *above, below: *below })
    }

    /// Returns true if the condition holds after the last step.
    pub(crate) fn holds(&self, terms: &[Tally]) -> bool {
        let value = terms[self.term].last;
        self.above.is_none_or(|above| value > above) && self.below.is_none_or(|below| value < below)
    }
}
