//! Interaction of two surfaces: from MuJoCo's numbers of geoms and pairs to springs and dampers.

use std::array;

use farsa_body::robot::{Impedance, SoftContact, Surface};

use crate::error::ReadError;
use crate::mjcf::classes::Classed;
use crate::xml::tree::Element;

/// MuJoCo's parameters of a contact.
#[derive(Clone, Copy)]
pub(crate) struct Contact {
    /// Friction along the surface, about its normal, and against rolling.
    friction: [f64; 3],
    /// `condim`.
    pub(crate) dimensions: f64,
    solref: [f64; 2],
    solimp: Solimp,
    /// Distance at which the contact begins.
    margin: f64,
    priority: f64,
    mix: f64,
}

impl Default for Contact {
    /// Creates the numbers of MuJoCo's defaults.
    fn default() -> Self {
        let (friction, solref) = ([1.0, 0.005, 0.0001], [0.02, 1.0]);
        Self { friction, dimensions: 3.0, solref, solimp: Solimp::default(), margin: 0.0, priority: 0.0, mix: 1.0 }
    }
}

/// The numbers of a `solimp`: impedance at the surface and at depth, width of the change, midpoint and power.
#[derive(Clone, Copy)]
pub(crate) struct Solimp([f64; 5]);

impl Default for Solimp {
    fn default() -> Self {
        Self([0.9, 0.95, 0.001, 0.5, 2.0])
    }
}

impl Solimp {
    /// Takes over the numbers of a list, which may be short.
    pub(crate) fn update(&mut self, list: &[f64]) {
        self.0.iter_mut().zip(list).for_each(|(to, from)| *to = *from);
    }

    /// The same impedance at each depth.
    pub(crate) const fn constant(impedance: f64) -> Self {
        Self([impedance, impedance, 0.001, 0.5, 2.0])
    }

    /// The impedance at depth, within mjMINIMP and mjMAXIMP.
    pub(crate) fn deep(&self) -> f64 {
        let [surface, deep, ..] = self.bounded();
        if self.is_constant() { 0.5 * (surface + deep) } else { deep }
    }

    fn bounded(&self) -> [f64; 5] {
        let Self([surface, deep, width, midpoint, power]) = *self;
        let bounded = |x: f64| x.clamp(0.0001, 0.9999);
        [bounded(surface), bounded(deep), width.max(0.0), bounded(midpoint), power.max(1.0)]
    }

    /// `getimpedance` of MuJoCo takes the mean without a width.
    fn is_constant(&self) -> bool {
        let [surface, deep, width, ..] = self.bounded();
        surface == deep || width <= 1e-15
    }

    /// The impedance over the depth, unless it is constant. Powers other than 1 become 2.
    pub(crate) fn law(&self) -> Option<Impedance> {
        let [surface, deep, width, midpoint, power] = self.bounded();
        let power = if power == 1.0 { 1 } else { 2 };
        (!self.is_constant()).then_some(Impedance { surface, deep, width, midpoint, power })
    }

    /// Returns true if [`law`](Self::law) has the same power.
    pub(crate) fn is_exact(&self) -> bool {
        let [.., power] = self.bounded();
        self.is_constant() || power == 1.0 || power == 2.0
    }
}

/// Friction of MuJoCo's contacts without friction, mjMINMU.
const LEAST_FRICTION: f64 = 1e-5;

/// Numbers of MuJoCo's flag `override`, which replace those of all contacts.
pub(crate) struct Override {
    friction: [f64; 3],
    solref: [f64; 2],
    solimp: Solimp,
    margin: f64,
}

impl Default for Override {
    fn default() -> Self {
        let Contact { friction, solref, solimp, margin, .. } = Contact::default();
        Self { friction, solref, solimp, margin }
    }
}

impl Override {
    /// Reads the numbers that an `option` has.
    pub(crate) fn read(&mut self, option: Element<'_>) -> Result<(), ReadError> {
        for (to, from) in self.solref.iter_mut().zip(option.list("o_solref", 1, 2)?.unwrap_or_default()) {
            *to = from;
        }
        if let Some(list) = option.list("o_solimp", 1, 5)? {
            self.solimp.update(&list);
        }
        spread(&mut self.friction, &option.list("o_friction", 1, 5)?.unwrap_or_default());
        if let Some([margin]) = option.list("o_margin", 1, 1)?.as_deref() {
            self.margin = *margin;
        }
        for (name, numbers) in
            [("o_friction", &self.friction[..]), ("o_solref", &self.solref), ("o_margin", &[self.margin])]
        {
            if numbers.iter().any(|x| !x.is_finite() || (name != "o_solref" && *x < 0.0)) {
                let text = option.attribute(name).unwrap_or_default();
                return Err(option.wrong(name, text, "but must not be endless, and friction and margin not negative"));
            }
        }
        Ok(())
    }

    /// Replaces the numbers of a contact.
    pub(crate) fn apply(&self, contact: &mut Contact) {
        (contact.friction, contact.solref) = (self.friction, self.solref);
        (contact.solimp, contact.margin) = (self.solimp, self.margin);
    }
}

/// Takes over the friction of a pair: two coefficients along the surface, one about the normal, two of rolling.
fn spread(friction: &mut [f64; 3], list: &[f64]) {
    for (to, at) in friction.iter_mut().zip([0, 2, 3]) {
        *to = list.get(at).copied().unwrap_or(*to);
    }
}

/// Returns the numbers of one geom, with MuJoCo's defaults where it has none.
pub(crate) fn contact_of(classed: &Classed<'_, '_>) -> Result<Contact, ReadError> {
    let mut contact = solver_numbers(classed, Contact::default())?;
    if let Some(friction) = friction(classed, 3)? {
        for (to, from) in contact.friction.iter_mut().zip(friction) {
            *to = from;
        }
    }
    contact.priority = classed.number("priority")?.unwrap_or(0.0);
    contact.mix = classed.not_negative("solmix")?.unwrap_or(1.0);
    Ok(contact)
}

/// Returns the list `friction`, of at most `most` numbers.
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

/// Returns a pair's own numbers where it has some, and otherwise those of its geoms. A list of a pair that is too short
/// continues with MuJoCo's defaults.
pub(crate) fn overridden(classed: &Classed<'_, '_>, geoms: &Contact) -> Result<Contact, ReadError> {
    let mut contact = *geoms;
    let start = Contact::default();
    if classed.source("solref").is_some() {
        contact.solref = start.solref;
    }
    if classed.source("solimp").is_some() {
        contact.solimp = start.solimp;
    }
    contact = solver_numbers(classed, contact)?;
    if let Some(list) = friction(classed, 5)? {
        contact.friction = start.friction;
        spread(&mut contact.friction, &list);
    }
    Ok(contact)
}

/// `condim`, `solref`, `solimp` and `margin` where an element gives them, else those of `contact`.
fn solver_numbers(classed: &Classed<'_, '_>, mut contact: Contact) -> Result<Contact, ReadError> {
    contact.dimensions = classed.number("condim")?.unwrap_or(contact.dimensions);
    contact.solref = solref(classed, "solref", contact.solref)?;
    if let Some(list) = classed.list("solimp", 1, 5)? {
        contact.solimp.update(&list);
    }
    contact.margin = classed.not_negative("margin")?.unwrap_or(contact.margin);
    Ok(contact)
}

/// The two numbers of a `solref` or `solreflimit` where an element gives them, else those of `otherwise`.
pub(crate) fn solref(
    classed: &Classed<'_, '_>,
    name: &'static str,
    otherwise: [f64; 2],
) -> Result<[f64; 2], ReadError> {
    let Some(list) = classed.list(name, 1, 2)? else { return Ok(otherwise) };
    if list.iter().any(|x| !x.is_finite()) {
        let source = classed.source(name).unwrap_or(classed.element);
        return Err(source.wrong(name, source.attribute(name).unwrap_or_default(), "but must be finite"));
    }
    Ok([list[0], list.get(1).copied().unwrap_or(otherwise[1])])
}

/// MuJoCo's rules for two geoms: the higher priority, else the larger friction and the weighted mean of the rest.
///
/// "Computation, Collision detection, Contact parameters" in its documentation. A negative `solref` (a stiffness and a
/// damping) and a positive one (a time constant and a damping ratio) have no mean. The smaller of each number is taken.
pub(crate) fn mixed(a: &Contact, b: &Contact) -> Contact {
    if a.priority != b.priority {
        return Contact { margin: a.margin + b.margin, ..if a.priority > b.priority { *a } else { *b } };
    }
    // Two weights of 0 share equally.
    let sum = a.mix + b.mix;
    let share = if sum > 0.0 { a.mix / sum } else { 0.5 };
    let mean = |a: f64, b: f64| share * a + (1.0 - share) * b;
    let usual = a.solref[0] > 0.0 && b.solref[0] > 0.0;
    let solref = [0, 1].map(|k| if usual { mean(a.solref[k], b.solref[k]) } else { a.solref[k].min(b.solref[k]) });
    Contact {
        friction: [0, 1, 2].map(|k| a.friction[k].max(b.friction[k])),
        dimensions: a.dimensions.max(b.dimensions),
        solref,
        solimp: Solimp(array::from_fn(|k| mean(a.solimp.0[k], b.solimp.0[k]))),
        margin: a.margin + b.margin,
        ..*a
    }
}

impl Contact {
    /// Returns true if contacts have the power of the `solimp`.
    pub(crate) fn is_exact(&self) -> bool {
        self.solimp.is_exact()
    }

    /// By how much the contact yields more than by its inverse weight, along its normal and across it.
    ///
    /// With elliptic cones friction is `impratio` times as stiff as the normal.
    pub(crate) fn yielding(&self, pyramidal: bool, ratio: f64) -> [f64; 2] {
        if self.dimensions < 3.0 || !pyramidal {
            return [1.0, 1.0 / ratio];
        }
        yielding_of_pyramid(self.friction[0].max(LEAST_FRICTION), self.dimensions, ratio)
    }

    /// The properties by which the contact stops motion gradually, for inverse weights along the normal and across it [1/kg].
    pub(crate) fn soft(&self, [normal, across]: [f64; 2], pyramidal: bool) -> SoftContact {
        let deep = self.solimp.deep();
        let [_, damping] = spring_and_damper(self.solref, deep, across);
        SoftContact {
            inertia: inertia_of(deep, normal),
            friction: [damping, inertia_of(deep, across)],
            margin: self.margin,
            is_pyramid: pyramidal && self.dimensions == 3.0 && self.friction[0] > 0.0,
            impedance: self.solimp.law(),
        }
    }

    /// The spring and damper that the contact is at rest, between bodies whose inverse weights have the sum `w` [1/kg].
    ///
    /// The force is `(aref - a) d / ((1 - d) w)`, `aref = -b v - k d x`, with `k = 1 / (d tau ratio)^2` and
    /// `b = 2 / (d tau)`, or with `k = K / d^2` and `b = B / d` for the numbers -K, -B.
    pub(crate) fn surface(&self, w: f64) -> Surface {
        let [stiffness, damping] = spring_and_damper(self.solref, self.solimp.deep(), w);
        let [friction, _, rolling] = self.friction;
        // `condim`: 1 has no friction, 3 along the surface, 4 also about the normal, 6 also against rolling.
        Surface {
            friction: if self.dimensions >= 3.0 { friction } else { 0.0 },
            rolling_friction: if self.dimensions >= 6.0 { rolling } else { 0.0 },
            stiffness,
            damping,
        }
    }
}

/// [`Contact::yielding`] of a pyramidal cone of friction m, with 2 (n - 1) edges for a `condim` of n.
///
/// Each edge yields 2 m^2 (1 + m^2) / impratio times as much as a contact without friction (`mj_diagApprox` and
/// `mj_makeImpedance` of MuJoCo). A direction of friction yields by 1 / (2 m^2) of that.
pub(crate) fn yielding_of_pyramid(friction: f64, dimensions: f64, ratio: f64) -> [f64; 2] {
    let square = friction * friction;
    let edge = 2.0 * square / ratio * (1.0 + square);
    [edge / (2.0 * (dimensions - 1.0)), edge / (2.0 * square)]
}

/// The inertia d / ((1 - d) w) of a constraint, the factor of the acceleration in its force.
pub(crate) fn inertia_of(impedance: f64, w: f64) -> f64 {
    let d = impedance.clamp(0.0001, 0.9999);
    d / ((1.0 - d) * w).max(1e-9)
}

/// The attributes -K, -B and d of a constraint with a stiffness K / ((1 - d) w), a damping B / ((1 - d) w) and an inertia.
/// Returns `None` if no finite number describes it.
pub(crate) fn attributes([stiffness, damping, inertia]: [f64; 3], w: f64) -> Option<([f64; 2], f64)> {
    let d = (inertia * w / (1.0 + inertia * w)).clamp(0.0001, 0.9999);
    let solref = [stiffness, damping].map(|x| -x * (1.0 - d) * w);
    solref.iter().all(|x| x.is_finite()).then_some((solref, d))
}

/// The attribute `solimp` of a constraint with an impedance at depth, which may change over the depth.
pub(crate) fn solimp(deep: f64, law: Option<Impedance>) -> [f64; 5] {
    let Some(Impedance { surface, width, midpoint, power, .. }) = law else { return Solimp::constant(deep).0 };
    [surface, deep, width, midpoint, power.into()]
}

/// The stiffness and damping of a constraint at depth, with the inverse weight `w`.
pub(crate) fn spring_and_damper([tau, ratio]: [f64; 2], impedance: f64, w: f64) -> [f64; 2] {
    // mjMINIMP and mjMAXIMP.
    let d = impedance.clamp(0.0001, 0.9999);
    // The factor of (1 - d) w in the force, with d in k and b canceled: x times the first, v times the second.
    let (stiffness, damping) = if tau > 0.0 && ratio > 0.0 {
        (1.0 / (tau * tau * ratio * ratio), 2.0 / tau)
    } else {
        (tau.abs().max(1e-6), ratio.abs())
    };
    // Two fixed bodies have no weight: never a pair.
    let yielding = ((1.0 - d) * w).max(1e-9);
    let finite = |x: f64| x.clamp(0.0, 1e15);
    [finite(stiffness / yielding).max(1e-6), finite(damping / yielding)]
}
