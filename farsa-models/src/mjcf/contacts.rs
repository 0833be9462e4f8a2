//! The contacts of an MJCF file: which colliders may touch, and how their surfaces act.

use std::collections::{BTreeMap, BTreeSet};

use farsa_body::{JointKind, Robot, Shape, Surface};

use crate::context::Context;
use crate::error::ReadError;
use crate::mjcf::bodies::{Bodies, Geom};
use crate::mjcf::classes::{Classed, Classes};
use crate::mjcf::inverse_weight::inverse_weights;
use crate::warnings::Warnings;
use crate::xml::tree::Element;

/// What MuJoCo knows of a contact.
#[derive(Clone, Copy)]
struct Contact {
    /// Friction along the surface, about its normal, and against rolling.
    friction: [f64; 3],
    dimensions: f64,
    solref: [f64; 2],
    /// The impedance of a deep contact.
    impedance: f64,
    priority: f64,
    mix: f64,
}

/// Adds the pairs of the `contact` section and those that MuJoCo makes of the geoms' bits.
pub(crate) fn contacts<'t>(
    model: Element<'t>,
    robot: &mut Robot,
    classes: &Classes<'t>,
    bodies: &Bodies<'t, '_>,
    context: &mut Context<'_>,
) -> Result<(), ReadError> {
    for element in classes.elements().filter(|element| element.tag() == "pair") {
        check_pair(element, &mut context.warnings)?;
    }
    let by_name: BTreeMap<&str, &Geom<'t, '_>> =
        bodies.geoms.iter().map(|geom| (robot.colliders[geom.collider].name.as_str(), geom)).collect();
    let mut pairs: Vec<([usize; 2], Contact)> = Vec::new();
    let mut known = BTreeSet::new();
    let mut excluded = BTreeSet::new();
    let mut lines = BTreeMap::new();
    for section in model.all("contact") {
        section.check(&[], &[], &mut context.warnings)?;
        section.check_children(&["pair", "exclude"], &[], &mut context.warnings)?;
        for element in section.all("exclude") {
            element.check(&["name", "body1", "body2"], &[], &mut context.warnings)?;
            let [a, b] = ["body1", "body2"].map(|end| {
                let name = element.needed(end)?;
                let known = bodies.by_name.get(name).copied();
                known.ok_or_else(|| element.unknown("body", name, bodies.by_name.keys().map(String::as_str)))
            });
            let (a, b) = (a?, b?);
            excluded.insert([a.min(b), a.max(b)]);
        }
        for element in section.all("pair") {
            check_pair(element, &mut context.warnings)?;
            let [a, b] = ["geom1", "geom2"].map(|end| {
                let name = element.needed(end)?;
                let found = by_name.get(name).copied();
                // A geom that was left out has been noted already.
                let left_out = found.is_none() && bodies.names.has("geom", name);
                if left_out {
                    Ok(None)
                } else {
                    found.map(Some).ok_or_else(|| element.unknown("geom", name, bodies.names.of("geom")))
                }
            });
            let (Some(a), Some(b)) = (a?, b?) else { continue };
            let colliders = [a.collider, b.collider];
            let key = [a.collider.min(b.collider), a.collider.max(b.collider)];
            if let Some(first) = lines.insert(key, element.place().line) {
                let name = [element.needed("geom1")?, element.needed("geom2")?].join("` and `");
                return Err(ReadError::Twice { place: element.place(), what: "pair of".into(), name, first });
            }
            let contact = explicit(&classes.with(element, 0)?, &mixed(&of_geom(a)?, &of_geom(b)?))?;
            if possible(robot, colliders) {
                pairs.push((colliders, contact));
            } else {
                context.warnings.add(element.place(), "pair", "of shapes on one body, or of two planes, left out");
            }
            known.insert(key);
        }
    }
    let mut details = Vec::new();
    for geom in &bodies.geoms {
        let bits = |name| {
            let number = geom.classed.number(name)?.unwrap_or(1.0);
            let wrong =
                || geom.classed.element.wrong(name, geom.classed.text(name).unwrap_or_default(), "but must be bits");
            if (0.0..=4_294_967_295.0).contains(&number) { Ok(number as u32) } else { Err(wrong()) }
        };
        details.push((geom, bits("contype")?, bits("conaffinity")?, of_geom(geom)?));
    }
    // Those that touch nothing are many, those that touch something are compared with each other.
    details.retain(|(_, kind, affinity, _)| *kind != 0 || *affinity != 0);
    let most = context.options.limits.contacts;
    if let Some((geom, ..)) = details.get(most) {
        let place = geom.classed.element.place();
        return Err(ReadError::TooMuch { place, what: "geoms that may touch", limit: most });
    }
    let mut count = 0_usize;
    for (i, (a, kind_a, affinity_a, contact_a)) in details.iter().enumerate() {
        for (b, kind_b, affinity_b, contact_b) in &details[i + 1..] {
            let key = [a.collider.min(b.collider), a.collider.max(b.collider)];
            let meet = kind_a & affinity_b != 0 || kind_b & affinity_a != 0;
            if !meet || !apart(bodies, a.body, b.body) || known.contains(&key) {
                continue;
            }
            if excluded.contains(&[a.body.min(b.body), a.body.max(b.body)]) || !possible(robot, key) {
                continue;
            }
            count += 1;
            if pairs.len() >= usize::from(u16::MAX) {
                let place = b.classed.element.place();
                return Err(ReadError::TooMuch { place, what: "pairs of geoms that may touch", limit: 65535 });
            }
            pairs.push((key, mixed(contact_a, contact_b)));
        }
    }
    if pairs.is_empty() {
        return Ok(());
    }
    if count > 0 {
        context.warnings.add(model.place(), "contype, conaffinity", format!("became {count} pairs"));
    }
    let freedoms = robot.segments.iter().map(|segment| match segment.joint.kind {
        JointKind::Fixed => 0,
        JointKind::Floating => 6,
        JointKind::Revolute | JointKind::Prismatic => 1,
    });
    if freedoms.sum::<usize>() > most {
        let what = "degrees of freedom of a robot with contacts";
        return Err(ReadError::TooMuch { place: model.place(), what, limit: most });
    }
    let weights = inverse_weights(robot).map_err(|error| ReadError::Robot { file: model.place().file, error })?;
    for (colliders, contact) in pairs {
        let w: f64 = colliders
            .iter()
            .map(|collider| robot.colliders[*collider].body.map_or(0.0, |body| weights[body.index()]))
            .sum();
        let surface = contact.surface(w);
        if contact.dimensions == 4.0 {
            context.warnings.add(model.place(), "condim 4", "friction about the normal alone is left out");
        }
        robot.add_pair(colliders, surface);
    }
    Ok(())
}

fn check_pair(element: Element<'_>, warnings: &mut Warnings) -> Result<(), ReadError> {
    let read = ["name", "class", "geom1", "geom2", "condim", "friction", "solref", "solimp"];
    let ignored =
        [("margin gap adhesion", "contacts begin where surfaces meet"), ("solreffriction", "how MuJoCo computes")];
    element.check(&read, &ignored, warnings)
}

/// Whether two colliders can be a pair of a description.
fn possible(robot: &Robot, [a, b]: [usize; 2]) -> bool {
    let (a, b) = (&robot.colliders[a], &robot.colliders[b]);
    a.body != b.body && (a.shape != Shape::Plane || b.shape != Shape::Plane)
}

/// Whether MuJoCo lets the geoms of two bodies touch: not if they move as one, nor if one carries the other.
fn apart(bodies: &Bodies<'_, '_>, a: usize, b: usize) -> bool {
    let carrier = |body: usize| bodies.list[body].carrier;
    let (a, b) = (carrier(a), carrier(b));
    let above = |body: usize| carrier(bodies.list[body].parent);
    a != b && (a == 0 || b == 0 || (above(a) != b && above(b) != a))
}

fn of_geom(geom: &Geom<'_, '_>) -> Result<Contact, ReadError> {
    let start = Contact {
        friction: [1.0, 0.005, 0.0001],
        dimensions: 3.0,
        solref: [0.02, 1.0],
        impedance: 0.95,
        priority: 0.0,
        mix: 1.0,
    };
    let classed = &geom.classed;
    let mut contact = explicit_solver(classed, start)?;
    if let Some(friction) = friction(classed, 3)? {
        for (to, from) in contact.friction.iter_mut().zip(friction) {
            *to = from;
        }
    }
    contact.priority = classed.number("priority")?.unwrap_or(0.0);
    contact.mix = classed.not_negative("solmix")?.unwrap_or(1.0);
    Ok(contact)
}

fn friction(classed: &Classed<'_, '_>, most: usize) -> Result<Option<Vec<f64>>, ReadError> {
    let list = classed.list("friction", 1, most)?;
    match (&list, classed.source("friction")) {
        (Some(list), Some(source)) if list.iter().any(|x| !(*x >= 0.0 && x.is_finite())) => {
            let text = source.attribute("friction").unwrap_or_default();
            Err(source.wrong("friction", text, "but must not be negative or endless"))
        }
        _ => Ok(list),
    }
}

/// A pair's own numbers where it has some, those of its geoms where not.
fn explicit(classed: &Classed<'_, '_>, geoms: &Contact) -> Result<Contact, ReadError> {
    let mut contact = explicit_solver(classed, *geoms)?;
    // Two along the surface, one about the normal, two of rolling.
    if let Some(friction) = friction(classed, 5)? {
        for (part, at) in [0, 2, 3].into_iter().enumerate() {
            contact.friction[part] = friction.get(at).copied().unwrap_or(contact.friction[part]);
        }
    }
    Ok(contact)
}

fn explicit_solver(classed: &Classed<'_, '_>, mut contact: Contact) -> Result<Contact, ReadError> {
    contact.dimensions = classed.number("condim")?.unwrap_or(contact.dimensions);
    if let Some(list) = classed.list("solref", 1, 2)? {
        contact.solref = [list[0], list.get(1).copied().unwrap_or(contact.solref[1])];
        if contact.solref.iter().any(|x| !x.is_finite()) {
            let source = classed.source("solref").unwrap_or(classed.element);
            return Err(source.wrong("solref", source.attribute("solref").unwrap_or_default(), "but must be finite"));
        }
    }
    if let Some(list) = classed.list("solimp", 1, 5)? {
        contact.impedance = list.get(1).copied().unwrap_or(contact.impedance);
    }
    Ok(contact)
}

/// MuJoCo's rules for two geoms: the higher priority, else the larger friction and the weighted mean of the rest.
fn mixed(a: &Contact, b: &Contact) -> Contact {
    if a.priority != b.priority {
        return if a.priority > b.priority { *a } else { *b };
    }
    let sum = a.mix + b.mix;
    let share = if sum > 0.0 { a.mix / sum } else { 0.5 };
    let mean = |a: f64, b: f64| share * a + (1.0 - share) * b;
    let usual = a.solref[0] > 0.0 && b.solref[0] > 0.0;
    let solref = [0, 1].map(|k| if usual { mean(a.solref[k], b.solref[k]) } else { a.solref[k].min(b.solref[k]) });
    Contact {
        friction: [0, 1, 2].map(|k| a.friction[k].max(b.friction[k])),
        dimensions: a.dimensions.max(b.dimensions),
        solref,
        impedance: mean(a.impedance, b.impedance),
        ..*a
    }
}

impl Contact {
    /// The spring and damper that the contact is at rest, between bodies whose inverse weights have the sum `w` [1/kg].
    ///
    /// The force is `(aref - a) d / ((1 - d) w)`, `aref = -b v - k d x`, with `k = 1 / (d tau ratio)^2` and
    /// `b = 2 / (d tau)`, or with `k = K / d^2` and `b = B / d` for the numbers -K, -B.
    fn surface(&self, w: f64) -> Surface {
        // MuJoCo bounds both so.
        let d = self.impedance.clamp(0.0001, 0.9999);
        let [tau, ratio] = self.solref;
        let (stiffness, damping) = if tau > 0.0 && ratio > 0.0 {
            (1.0 / (tau * tau * ratio * ratio), 2.0 / tau)
        } else {
            (tau.abs().max(1e-6), ratio.abs())
        };
        // Two fixed bodies have no weight: never a pair.
        let yielding = ((1.0 - d) * w).max(1e-9);
        let [friction, _, rolling] = self.friction;
        let finite = |x: f64| x.clamp(0.0, 1e15);
        Surface {
            friction: if self.dimensions >= 3.0 { friction } else { 0.0 },
            rolling_friction: if self.dimensions >= 6.0 { rolling } else { 0.0 },
            stiffness: finite(stiffness / yielding).max(1e-6),
            damping: finite(damping / yielding),
        }
    }
}
