//! Warning about a fitness that is the same for all individuals.

use crate::check::registry::Registry;
use crate::check::source::Source;
use crate::document::{Document, MotorKind, Object, SensorKind, Shape};
use crate::formula::compile::is_constant as is_constant_formula;
use crate::part::term::Constants;
use crate::parts::groups::Groups;

/// Describes the fitness of a document if it has one value for all individuals.
pub(crate) fn warning(document: &Document, groups: &Groups, source: &Source) -> Option<String> {
    let mut paid = document.reward.iter().enumerate().filter(|(_, term)| term.weight != 0.0).peekable();
    if paid.peek().is_none() {
        let place = source.of("/reward/0/weight");
        return Some(format!("{place}: no term has a weight, so the fitness of all individuals is 0"));
    }
    if paid.all(|(number, _)| is_constant(number, document, groups, source)) {
        let place = source.of("/reward/0");
        return Some(format!("{place}: no term with a weight can differ, so all individuals have the same fitness"));
    }
    None
}

/// Checks if a term has the same total in each trial.
fn is_constant(number: usize, document: &Document, groups: &Groups, source: &Source) -> bool {
    let term = &document.reward[number];
    let ends_early = !document.episode.ends.is_empty() || !document.end.is_empty() || !document.failure.is_empty();
    let differs = |other: &String| {
        let other = source.names.terms[..number].iter().position(|name| name == other);
        other.is_none_or(|other| !is_constant(other, document, groups, source))
    };
    if ends_early || term.during.as_ref().is_some_and(differs) {
        return false;
    }
    if term.clip.is_some_and(|[low, high]| low == high) {
        return true;
    }
    let facts = Facts { document, groups, source };
    source.registry.term(&term.kind).is_some_and(|term| term.is_constant(&facts))
}

/// Facts about a document.
struct Facts<'f> {
    document: &'f Document,
    groups: &'f Groups,
    source: &'f Source,
}

impl Constants for Facts<'_> {
    fn is_alone(&self) -> bool {
        self.groups.robots() == 1
    }

    fn pulls(&self) -> bool {
        pulls(self.document, &self.source.registry)
    }

    fn foraging(&self) -> [bool; 2] {
        self.document.foraging.as_ref().map_or([false; 2], |foraging| [foraging.cells == 0, foraging.cost == 0.0])
    }

    fn is_fixed(&self, thing: &str) -> bool {
        let movable = |object: &Object| matches!(object.shape, Some(Shape::Block { .. } | Shape::Ball { .. }));
        let object = self.document.objects.iter().find(|object| object.name == thing);
        object.is_some_and(|object| !movable(object) && !self.pulls())
    }

    fn is_constant(&self, sensor: &str) -> bool {
        let place = self.source.names.sensors.iter().position(|(name, _)| name == sensor);
        let sensor = place.and_then(|place| self.document.sensors.get(place));
        let constant = |kind: &SensorKind| self.source.registry.sensor(kind).is_some_and(|sensor| sensor.is_constant());
        sensor.is_some_and(|sensor| sensor.wrappers.is_empty() && constant(&sensor.kind))
    }

    fn is_constant_formula(&self, formula: &str) -> bool {
        is_constant_formula(formula)
    }
}

/// Checks if robots have attachment devices.
pub(crate) fn pulls(document: &Document, registry: &Registry) -> bool {
    let pulls = |kind: &MotorKind| registry.motor(kind).is_some_and(|motor| motor.pulls());
    document.motors.iter().any(|motor| motor.enabled && pulls(&motor.kind))
}
