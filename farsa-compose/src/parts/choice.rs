//! Choices among points, of which one may follow another.

use farsa_lab::Error;

use crate::check::places::Places;
use crate::document::{Document, Placing};

/// Some points, one of which a trial takes.
#[derive(Clone, Debug)]
pub(crate) struct Choice<const N: usize> {
    pub(crate) points: Vec<[f32; N]>,
    /// The number of the rule whose choice this one follows.
    like: Option<usize>,
}

impl<const N: usize> Choice<N> {
    /// That of a document's rule of a number, which may follow an earlier one.
    ///
    /// # Errors
    /// [`Error::Setting`] if that is none, or has another number of points.
    pub(crate) fn new(
        points: Vec<[f32; N]>,
        like: Option<&String>,
        document: &Document,
        rule: usize,
        places: &Places,
    ) -> Result<Self, Error> {
        let Some(name) = like else { return Ok(Self { points, like: None }) };
        let path = format!("/start/{rule}/like");
        let earlier = document.start.iter().take(rule).enumerate().find(|(_, start)| start.place == *name);
        let Some((number, Placing::OneOf { points: others, .. })) = earlier.map(|(number, start)| (number, &start.how))
        else {
            return Err(places.wrong(&path, format!("`{name}` has to be placed before, on one of some points")));
        };
        if others.len() != points.len() {
            let why = format!("`{name}` is placed on one of {} points, and here are {}", others.len(), points.len());
            return Err(places.wrong(&path, why));
        }
        Ok(Self { points, like: Some(number) })
    }

    /// Whether it is drawn, and does not follow another.
    pub(crate) fn is_drawn(&self) -> bool {
        self.like.is_none()
    }

    /// The number of the point that is taken, of those that are free unless it follows another; `chosen` has the numbers that
    /// earlier rules have taken, and `draw` draws a number below another.
    pub(crate) fn take(
        &self,
        chosen: &[usize],
        taken: impl Fn(&[f32; N]) -> bool,
        draw: impl FnOnce(u32) -> u32,
    ) -> Option<usize> {
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
