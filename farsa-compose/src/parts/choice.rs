//! Choices among points. A choice may follow an earlier one.

use farsa_lab::Error;

use crate::check::source::Source;
use crate::document::{Document, Placing};

/// Points, of which a trial takes one.
#[derive(Clone, Debug)]
pub(crate) struct Choice<const N: usize> {
    pub(crate) points: Vec<[f32; N]>,
    /// Number of the earlier rule that this choice follows.
    like: Option<usize>,
}

impl<const N: usize> Choice<N> {
    /// Builds the choice of a rule of a document. `like` names an earlier rule.
    pub(crate) fn new(
        points: Vec<[f32; N]>,
        like: Option<&String>,
        document: &Document,
        rule: usize,
        source: &Source,
    ) -> Result<Self, Error> {
        let Some(name) = like else { return Ok(Self { points, like: None }) };
        let path = format!("/start/{rule}/like");
        let earlier = document.start.iter().take(rule).enumerate().find(|(_, start)| start.place == *name);
        let Some((number, Placing::OneOf { points: others, .. })) = earlier.map(|(number, start)| (number, &start.how))
        else {
            return Err(source.wrong(&path, format!("`{name}` has to be placed before, on one of some points")));
        };
        if others.len() != points.len() {
            let why = format!("`{name}` is placed on one of {} points, and here are {}", others.len(), points.len());
            return Err(source.wrong(&path, why));
        }
        Ok(Self { points, like: Some(number) })
    }

    /// Returns false if the choice follows another one.
    pub(crate) fn is_drawn(&self) -> bool {
        self.like.is_none()
    }

    /// Chooses a free point, or the point of the earlier choice. `chosen` contains the choices of earlier rules, and
    /// `draw` draws a number below its argument.
    pub(crate) fn take(
        &self,
        chosen: &[usize],
        taken: impl Fn(&[f32; N]) -> bool,
        draw: impl FnOnce(u32) -> u32,
    ) -> Option<usize> {
        // A choice that follows another one leaves the stream as it is.
        if let Some(rule) = self.like {
            return chosen.get(rule).copied();
        }
        let free = || self.points.iter().enumerate().filter(|(_, point)| !taken(point)).map(|(number, _)| number);
        match free().count() {
            0 => None,
            count => free().nth(draw(count as u32) as usize),
        }
    }
}
