//! Contacts of an MJCF file: which colliders may touch.

use std::collections::{BTreeMap, BTreeSet};

use farsa_body::robot::{Robot, Shape, SoftContact, Surface};

use crate::context::Context;
use crate::error::ReadError;
use crate::mjcf::bodies::{Bodies, Geom};
use crate::mjcf::classes::Classes;
use crate::mjcf::flags::Flags;
use crate::mjcf::inverse_weight::inverse_weights;
use crate::mjcf::surface::{Contact, contact_of, mixed, overridden};
use crate::warnings::Warnings;
use crate::xml::tree::Element;

/// Two colliders that may touch.
type PairContact = ([usize; 2], Contact);

/// A geom that may touch others by its bits, with them.
struct Touching<'b, 't, 'c> {
    geom: &'b Geom<'t, 'c>,
    contype: u32,
    conaffinity: u32,
    contact: Contact,
}

/// Declarations of the `contact` sections.
#[derive(Default)]
struct Declared {
    pairs: Vec<PairContact>,
    /// Line of each `pair`, by its colliders in ascending order. Pairs that cannot be described are included.
    lines: BTreeMap<[usize; 2], usize>,
    /// Bodies whose geoms do not touch, in ascending order.
    excluded: BTreeSet<[usize; 2]>,
}

/// Adds the pairs of the `contact` section and those that MuJoCo makes of the geoms' bits.
///
/// MuJoCo's documentation, "Computation, Collision detection, Selection": the pairs that a model declares, joined with
/// those that its geoms' `contype` and `conaffinity` allow. Declared pairs come first here, in the file's order.
pub(crate) fn contacts<'t>(
    model: Element<'t>,
    robot: &mut Robot,
    classes: &Classes<'t>,
    bodies: &Bodies<'t, '_>,
    flags: &Flags,
    context: &mut Context<'_>,
) -> Result<(), ReadError> {
    for element in classes.elements().filter(|element| element.tag() == "pair") {
        check_pair(element, &mut context.warnings)?;
    }
    let declared = Declared::from_model(model, robot, classes, bodies, &mut context.warnings)?;
    if !flags.contact {
        return Ok(());
    }
    let touching = touching(bodies, context.options.limits.contacts)?;
    let generated = generated(robot, bodies, &touching, &declared, flags)?;
    if declared.pairs.is_empty() && generated.is_empty() {
        return Ok(());
    }
    if !generated.is_empty() {
        let what = format!("became {} pairs", generated.len());
        context.warnings.add(model.place(), "contype, conaffinity", what);
    }
    let pairs = declared.pairs.into_iter().chain(generated);
    add_pairs(model, robot, pairs, flags, &mut context.warnings)
}

impl Declared {
    fn from_model<'t>(
        model: Element<'t>,
        robot: &Robot,
        classes: &Classes<'t>,
        bodies: &Bodies<'t, '_>,
        warnings: &mut Warnings,
    ) -> Result<Self, ReadError> {
        let by_name: BTreeMap<&str, &Geom<'t, '_>> =
            bodies.geoms.iter().map(|geom| (robot.colliders[geom.collider].name.as_str(), geom)).collect();
        let mut declared = Self::default();
        for section in model.all("contact") {
            section.check(&[], &[], warnings)?;
            section.check_children(&["pair", "exclude"], &[], warnings)?;
            for element in section.all("exclude") {
                declared.exclude(element, bodies, warnings)?;
            }
            for element in section.all("pair") {
                check_pair(element, warnings)?;
                let [a, b] = ["geom1", "geom2"].map(|end| named_geom(element, end, &by_name, bodies));
                // A pair with a geom that was left out is left out with it.
                if let (Some(a), Some(b)) = (a?, b?) {
                    declared.pair(element, [a, b], robot, classes, warnings)?;
                } else {
                    element.leave();
                }
            }
        }
        Ok(declared)
    }

    fn exclude(
        &mut self,
        element: Element<'_>,
        bodies: &Bodies<'_, '_>,
        warnings: &mut Warnings,
    ) -> Result<(), ReadError> {
        element.check(&["name", "body1", "body2"], &[], warnings)?;
        let [a, b] = ["body1", "body2"].map(|end| {
            let name = element.needed(end)?;
            let body = bodies.by_name.get(name).copied();
            body.ok_or_else(|| element.unknown("body", name, bodies.by_name.keys().map(String::as_str)))
        });
        if !self.excluded.insert(ascending([a?, b?])) {
            warnings.add(element.place(), "exclude", "declared already");
        }
        Ok(())
    }

    fn pair<'t>(
        &mut self,
        element: Element<'t>,
        [a, b]: [&Geom<'t, '_>; 2],
        robot: &Robot,
        classes: &Classes<'t>,
        warnings: &mut Warnings,
    ) -> Result<(), ReadError> {
        let colliders = [a.collider, b.collider];
        let first = self.lines.insert(ascending(colliders), element.place().line);
        if first.is_some() {
            warnings.add(element.place(), "pair", "declared already: a contact has the springs and dampers of both");
        }
        let contact = overridden(
            &classes.with(element, classes.main())?,
            &mixed(&contact_of(&a.classed)?, &contact_of(&b.classed)?),
        )?;
        if possible(robot, colliders) {
            self.pairs.push((colliders, contact));
        } else {
            warnings.add(element.place(), "pair", "of shapes on one body, or of two planes, left out");
        }
        Ok(())
    }
}

fn ascending([a, b]: [usize; 2]) -> [usize; 2] {
    [a.min(b), a.max(b)]
}

/// Gets the geom that an end of a `pair` names, or `None` if it was left out, which has been warned about already.
fn named_geom<'b, 't, 'c>(
    pair: Element<'t>,
    end: &str,
    by_name: &BTreeMap<&str, &'b Geom<'t, 'c>>,
    bodies: &Bodies<'t, '_>,
) -> Result<Option<&'b Geom<'t, 'c>>, ReadError> {
    let name = pair.needed(end)?;
    match by_name.get(name) {
        Some(geom) => Ok(Some(geom)),
        None if bodies.names.has("geom", name) => Ok(None),
        None => Err(pair.unknown("geom", name, bodies.names.all("geom"))),
    }
}

/// The geoms that touch anything by their bits, at most `most`: they are compared with each other, and those that touch
/// nothing are many.
fn touching<'b, 't, 'c>(bodies: &'b Bodies<'t, 'c>, most: usize) -> Result<Vec<Touching<'b, 't, 'c>>, ReadError> {
    let mut touching = Vec::new();
    for geom in &bodies.geoms {
        let classed = &geom.classed;
        let bits = |name| {
            let number = classed.number(name)?.unwrap_or(1.0);
            let wrong = || classed.element.wrong(name, classed.text(name).unwrap_or_default(), "but must be bits");
            if (0.0..=4_294_967_295.0).contains(&number) { Ok(number as u32) } else { Err(wrong()) }
        };
        let (contype, conaffinity) = (bits("contype")?, bits("conaffinity")?);
        touching.push(Touching { geom, contype, conaffinity, contact: contact_of(classed)? });
    }
    touching.retain(|one| one.contype != 0 || one.conaffinity != 0);
    if let Some(beyond) = touching.get(most) {
        let place = beyond.geom.classed.element.place();
        return Err(ReadError::TooMuch { place, what: "geoms that may touch", limit: most });
    }
    Ok(touching)
}

/// Lists the pairs that MuJoCo makes of the geoms' bits. Two geoms touch if the `contype` of one and the
/// `conaffinity` of the other have a common bit. Declared pairs are excepted, and bodies that are excluded, share their
/// motion, or are parent and child.
fn generated(
    robot: &Robot,
    bodies: &Bodies<'_, '_>,
    touching: &[Touching<'_, '_, '_>],
    declared: &Declared,
    flags: &Flags,
) -> Result<Vec<PairContact>, ReadError> {
    let mut pairs = Vec::new();
    for (i, a) in touching.iter().enumerate() {
        for b in &touching[i + 1..] {
            let colliders = ascending([a.geom.collider, b.geom.collider]);
            let meet = a.contype & b.conaffinity != 0 || b.contype & a.conaffinity != 0;
            if !meet || !apart(bodies, a.geom.body, b.geom.body, flags) || declared.lines.contains_key(&colliders) {
                continue;
            }
            if declared.excluded.contains(&ascending([a.geom.body, b.geom.body])) || !possible(robot, colliders) {
                continue;
            }
            // A pair's number has 16 bits.
            if declared.pairs.len() + pairs.len() >= usize::from(u16::MAX) {
                let place = b.geom.classed.element.place();
                return Err(ReadError::TooMuch { place, what: "pairs of geoms that may touch", limit: 65535 });
            }
            pairs.push((colliders, mixed(&a.contact, &b.contact)));
        }
    }
    Ok(pairs)
}

/// Adds the pairs with the springs and dampers that their bodies' inverse weights make of MuJoCo's numbers.
fn add_pairs(
    model: Element<'_>,
    robot: &mut Robot,
    pairs: impl Iterator<Item = PairContact>,
    flags: &Flags,
    warnings: &mut Warnings,
) -> Result<(), ReadError> {
    let weights = inverse_weights(robot).map_err(|error| ReadError::Robot { file: model.place().file, error })?.bodies;
    let mut surfaces: BTreeMap<[usize; 2], usize> = BTreeMap::new();
    for (colliders, mut contact) in pairs {
        let w: f64 = colliders
            .iter()
            .map(|collider| robot.colliders[*collider].body.map_or(0.0, |body| weights[body.index()]))
            .sum();
        if let Some(numbers) = &flags.contacts {
            numbers.apply(&mut contact);
        }
        if contact.dimensions == 4.0 {
            warnings.add(model.place(), "condim 4", "friction about the normal alone is left out");
        }
        if !contact.is_exact() {
            warnings.add(model.place(), "solimp", "contacts have the powers 1 and 2 only");
        }
        let [normal, across] = contact.yielding(flags.pyramids, flags.ratio);
        let (surface, soft) =
            (contact.surface(normal * w), contact.soft([normal, across].map(|factor| factor * w), flags.pyramids));
        if let Some(first) = surfaces.get(&ascending(colliders)) {
            let first = &mut robot.pairs[*first];
            first.surface = both(&first.surface, &surface);
            first.soft = first.soft.map(|first| added(first, soft));
        } else {
            surfaces.insert(ascending(colliders), robot.pairs.len());
            let pair = robot.add_pair(colliders, surface);
            robot.pairs[pair.index()].soft = Some(soft);
        }
    }
    Ok(())
}

/// Returns the surface of two contacts at the same place: their forces add up, and so does their friction.
fn both(a: &Surface, b: &Surface) -> Surface {
    let stiffness = a.stiffness + b.stiffness;
    let mean = |x: f64, y: f64| (x * a.stiffness + y * b.stiffness) / stiffness;
    Surface {
        friction: mean(a.friction, b.friction),
        rolling_friction: mean(a.rolling_friction, b.rolling_friction),
        stiffness,
        damping: a.damping + b.damping,
    }
}

fn added(a: SoftContact, b: SoftContact) -> SoftContact {
    let friction = [0, 1].map(|k: usize| a.friction[k] + b.friction[k]);
    SoftContact { inertia: a.inertia + b.inertia, friction, margin: a.margin.max(b.margin), ..a }
}

fn check_pair(element: Element<'_>, warnings: &mut Warnings) -> Result<(), ReadError> {
    let read = ["name", "class", "geom1", "geom2", "condim", "friction", "solref", "solimp", "margin"];
    let ignored =
        [("gap adhesion", "contacts begin at their margin and do not pull"), ("solreffriction", "how MuJoCo computes")];
    element.check(&read, &ignored, warnings)
}

/// Checks whether two colliders can be a pair of a description.
fn possible(robot: &Robot, [a, b]: [usize; 2]) -> bool {
    let (a, b) = (&robot.colliders[a], &robot.colliders[b]);
    a.body != b.body && (a.shape != Shape::Plane || b.shape != Shape::Plane)
}

/// Checks whether MuJoCo lets the geoms of two bodies touch: not if they move as one, nor if one carries the other.
///
/// Bodies without joints count as part of their carrier ("welded" in MuJoCo's documentation). Parent and child are kept
/// apart because their geoms overlap at the joint by design. The world as a parent is the exception, or nothing could
/// rest on the ground.
fn apart(bodies: &Bodies<'_, '_>, a: usize, b: usize, flags: &Flags) -> bool {
    let carrier = |body: usize| bodies.list[body].carrier;
    let (a, b) = (carrier(a), carrier(b));
    let above = |body: usize| carrier(bodies.list[body].parent);
    a != b && (!flags.filter_parent || a == 0 || b == 0 || (above(a) != b && above(b) != a))
}
