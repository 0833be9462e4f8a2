//! Stops of joints: from MuJoCo's numbers of limits to springs and dampers, and back.

use farsa_body::robot::Stop;

use crate::error::ReadError;
use crate::mjcf::classes::Classed;
use crate::mjcf::surface::{Solimp, attributes, inertia_of, solimp, solref, spring_and_damper};
use crate::xml::write::numbers;

/// MuJoCo's parameters of a joint's limits.
#[derive(Clone, Copy)]
pub(crate) struct Limits {
    solref: [f64; 2],
    solimp: Solimp,
}

impl Limits {
    /// Reads the numbers of a joint, with MuJoCo's defaults where it has none.
    pub(crate) fn from_joint(classed: &Classed<'_, '_>) -> Result<Self, ReadError> {
        let solref = solref(classed, "solreflimit", [0.02, 1.0])?;
        let mut solimp = Solimp::default();
        solimp.update(&classed.list("solimplimit", 1, 5)?.unwrap_or_default());
        Ok(Self { solref, solimp })
    }

    /// Returns true if stops have the power of the `solimplimit`.
    pub(crate) fn is_exact(&self) -> bool {
        self.solimp.is_exact()
    }

    /// The stop of a joint with this inverse weight.
    pub(crate) fn stop(&self, weight: f64) -> Stop {
        let deep = self.solimp.deep();
        let [stiffness, damping] = spring_and_damper(self.solref, deep, weight);
        Stop { stiffness, damping, inertia: inertia_of(deep, weight), impedance: self.solimp.law() }
    }
}

/// Impedance of the limits of a written file.
pub(crate) const STIFF: f64 = 0.99;

/// Formats the attributes of a stop of a joint with this inverse weight, none for the limits of a file written for a step
/// of `h` \[s\], whose time constant is twice the step.
pub(crate) fn limit_attributes(stop: Stop, weight: f64, h: f64) -> String {
    let numbers_of = |Stop { stiffness, damping, inertia, .. }: Stop| [stiffness, damping, inertia];
    let usual = Limits { solref: [2.0 * h, 1.0], solimp: Solimp::constant(STIFF) }.stop(weight);
    if stop.impedance.is_none()
        && numbers_of(stop).iter().zip(numbers_of(usual)).all(|(a, b)| (a - b).abs() <= 1e-9 * b)
    {
        return String::new();
    }
    let Some((solref, d)) = attributes(numbers_of(stop), weight) else { return String::new() };
    format!(" solreflimit=\"{}\" solimplimit=\"{}\"", numbers(&solref), numbers(&solimp(d, stop.impedance)))
}
