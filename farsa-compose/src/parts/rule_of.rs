//! The rule of a placement.

use farsa_body::ports::BodyId;
use farsa_lab::Error;

use crate::check::source::Source;
use crate::document::Document;

/// The rule of a placement.
#[derive(Clone, Copy)]
pub(crate) struct RuleOf<'s> {
    pub(crate) document: &'s Document,
    pub(crate) number: usize,
    /// Bodies that earlier rules place.
    pub(crate) placed: &'s [BodyId],
}

impl RuleOf<'_> {
    /// Returns the number of an earlier rule with a choice among this many points.
    pub(crate) fn earlier_choice(&self, name: &str, points: usize, source: &Source) -> Result<usize, Error> {
        let path = format!("/start/{}/like", self.number);
        let mut earlier = self.document.start.iter().take(self.number).enumerate();
        let earlier = earlier.find(|(_, start)| start.place == name);
        let found = earlier.and_then(|(number, start)| Some((number, source.registry.start(&start.how)?.points()?)));
        let Some((number, others)) = found else {
            return Err(source.wrong(&path, format!("`{name}` has to be placed before, on one of some points")));
        };
        if others != points {
            let why = format!("`{name}` is placed on one of {others} points, and here are {points}");
            return Err(source.wrong(&path, why));
        }
        Ok(number)
    }
}
