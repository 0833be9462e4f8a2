//! When a trial has succeeded.

use farsa_lab::Error;

use crate::check::places::Places;
use crate::document::Condition;
use crate::parts::tally::Tally;

/// A condition of success on a term by its number.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wanted {
    pub(crate) term: usize,
    above: Option<f64>,
    below: Option<f64>,
}

impl Wanted {
    /// A condition that stands at a path of the document.
    ///
    /// # Errors
    /// [`Error::Unknown`] for a term that there is not, [`Error::Setting`] for a condition that asks nothing.
    pub(crate) fn new(condition: &Condition, path: &str, names: &[String], places: &Places) -> Result<Self, Error> {
        let Condition { term, above, below } = condition;
        let names_of = names.iter().map(String::as_str);
        let place = places.of(&format!("{path}/term"));
        let found = names.iter().position(|name| name == term);
        let term = found.ok_or_else(|| Error::unknown(&place, "term", term, names_of))?;
        if above.is_none() && below.is_none() {
            return Err(places.wrong(path, "lacks `above` and `below`: one of them at least"));
        }
        Ok(Self { term, above: *above, below: *below })
    }

    /// Whether it holds after the last step.
    pub(crate) fn holds(&self, terms: &[Tally]) -> bool {
        let value = terms[self.term].last;
        self.above.is_none_or(|above| value > above) && self.below.is_none_or(|below| value < below)
    }
}
