//! Interaction of two surfaces: from MuJoCo's numbers of geoms and pairs to springs and dampers.

use farsa_body::robot::Surface;

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
    /// Impedance of a deep contact.
    impedance: f64,
    priority: f64,
    mix: f64,
}

impl Default for Contact {
    /// Creates the numbers of MuJoCo's defaults.
    fn default() -> Self {
        let (friction, solref) = ([1.0, 0.005, 0.0001], [0.02, 1.0]);
        Self { friction, dimensions: 3.0, solref, impedance: 0.95, priority: 0.0, mix: 1.0 }
    }
}

/// Numbers of MuJoCo's flag `override`, which replace those of all contacts.
pub(crate) struct Override {
    friction: [f64; 3],
    solref: [f64; 2],
    impedance: f64,
}

impl Default for Override {
    fn default() -> Self {
        let Contact { friction, solref, impedance, .. } = Contact::default();
        Self { friction, solref, impedance }
    }
}

impl Override {
    /// Reads the numbers that an `option` has.
    pub(crate) fn read(&mut self, option: Element<'_>) -> Result<(), ReadError> {
        for (to, from) in self.solref.iter_mut().zip(option.list("o_solref", 1, 2)?.unwrap_or_default()) {
            *to = from;
        }
        if let Some(list) = option.list("o_solimp", 1, 5)? {
            self.impedance = list.get(1).copied().unwrap_or(self.impedance);
        }
        spread(&mut self.friction, &option.list("o_friction", 1, 5)?.unwrap_or_default());
        for (name, numbers) in [("o_friction", &self.friction[..]), ("o_solref", &self.solref)] {
            if numbers.iter().any(|x| !x.is_finite() || (name == "o_friction" && *x < 0.0)) {
                let text = option.attribute(name).unwrap_or_default();
                return Err(option.wrong(name, text, "but must not be endless, and friction not negative"));
            }
        }
        Ok(())
    }

    /// Replaces the numbers of a contact.
    pub(crate) fn apply(&self, contact: &mut Contact) {
        (contact.friction, contact.solref, contact.impedance) = (self.friction, self.solref, self.impedance);
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
        contact.impedance = start.impedance;
    }
    contact = solver_numbers(classed, contact)?;
    if let Some(list) = friction(classed, 5)? {
        contact.friction = start.friction;
        spread(&mut contact.friction, &list);
    }
    Ok(contact)
}

/// `condim`, `solref` and `solimp` where an element gives them, else those of `contact`.
fn solver_numbers(classed: &Classed<'_, '_>, mut contact: Contact) -> Result<Contact, ReadError> {
    contact.dimensions = classed.number("condim")?.unwrap_or(contact.dimensions);
    if let Some(list) = classed.list("solref", 1, 2)? {
        contact.solref = [list[0], list.get(1).copied().unwrap_or(contact.solref[1])];
        if contact.solref.iter().any(|x| !x.is_finite()) {
            let source = classed.source("solref").unwrap_or(classed.element);
            return Err(source.wrong("solref", source.attribute("solref").unwrap_or_default(), "but must be finite"));
        }
    }
    if let Some(list) = classed.list("solimp", 1, 5)? {
        // `solimp` is dmin, dmax, width, midpoint, power: at rest a contact is deeper than the width, where d is dmax.
        contact.impedance = list.get(1).copied().unwrap_or(contact.impedance);
    }
    Ok(contact)
}

/// MuJoCo's rules for two geoms: the higher priority, else the larger friction and the weighted mean of the rest.
///
/// "Computation, Collision detection, Contact parameters" in its documentation. A negative `solref` (a stiffness and a
/// damping) and a positive one (a time constant and a damping ratio) have no mean. The smaller of each number is taken.
pub(crate) fn mixed(a: &Contact, b: &Contact) -> Contact {
    if a.priority != b.priority {
        return if a.priority > b.priority { *a } else { *b };
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
        impedance: mean(a.impedance, b.impedance),
        ..*a
    }
}

impl Contact {
    /// The spring and damper that the contact is at rest, between bodies whose inverse weights have the sum `w` [1/kg].
    ///
    /// The force is `(aref - a) d / ((1 - d) w)`, `aref = -b v - k d x`, with `k = 1 / (d tau ratio)^2` and
    /// `b = 2 / (d tau)`, or with `k = K / d^2` and `b = B / d` for the numbers -K, -B.
    pub(crate) fn surface(&self, w: f64) -> Surface {
        // mjMINIMP and mjMAXIMP.
        let d = self.impedance.clamp(0.0001, 0.9999);
        let [tau, ratio] = self.solref;
        // The factor of (1 - d) w in the force, with d in k and b canceled: x times the first, v times the second.
        let (stiffness, damping) = if tau > 0.0 && ratio > 0.0 {
            (1.0 / (tau * tau * ratio * ratio), 2.0 / tau)
        } else {
            (tau.abs().max(1e-6), ratio.abs())
        };
        // Two fixed bodies have no weight: never a pair.
        let yielding = ((1.0 - d) * w).max(1e-9);
        let [friction, _, rolling] = self.friction;
        let finite = |x: f64| x.clamp(0.0, 1e15);
        // `condim`: 1 has no friction, 3 along the surface, 4 also about the normal, 6 also against rolling.
        Surface {
            friction: if self.dimensions >= 3.0 { friction } else { 0.0 },
            rolling_friction: if self.dimensions >= 6.0 { rolling } else { 0.0 },
            stiffness: finite(stiffness / yielding).max(1e-6),
            damping: finite(damping / yielding),
        }
    }
}
