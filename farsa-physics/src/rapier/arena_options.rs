//! Options for a world of wheeled robots in rapier.

use crate::rapier::error::RapierError;
use crate::rapier::options::Options;

/// Options for a world of wheeled robots in rapier. Note that the control step is part of the arena instead.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct ArenaOptions {
    /// Longest step that rapier may take [s]. A control step is divided into as few equal steps as this allows.
    pub longest_step: f64,
    /// Iterations of the solver per step of rapier, which divide it further. Motors' laws are evaluated once per step.
    pub iterations: u32,
    /// Number of sweeps over the contacts in each iteration of the solver.
    pub sweeps: u32,
    /// Gravity [m/s2]. It points downwards.
    pub gravity: f64,
    /// Typical size of the simulated things [m]. The tolerances of rapier are chosen relative to this.
    pub length_unit: f64,
    /// Natural frequency of contacts [Hz].
    pub contact_frequency: f64,
    /// Damping ratio of contacts.
    pub contact_damping: f64,
}

impl Default for ArenaOptions {
    fn default() -> Self {
        let Options { length_unit, contact_frequency, contact_damping, .. } = Options::default();
        Self {
            longest_step: 0.005,
            iterations: 1,
            sweeps: 4,
            gravity: 9.81,
            length_unit,
            contact_frequency,
            contact_damping,
        }
    }
}

impl ArenaOptions {
    /// Returns the options of a world of rapier with this control step [s].
    pub(crate) fn options(&self, time_step: f64) -> Result<Options, RapierError> {
        let range = [1e-6, 1.0];
        if !(range[0]..=range[1]).contains(&self.longest_step) {
            return Err(RapierError::Option { name: "longest_step", value: self.longest_step, range });
        }
        // As few as hold it, and none more for what is only rounding.
        let substeps = 1 + (time_step / self.longest_step * (1.0 - 1e-9)) as u32;
        let options = Options {
            time_step,
            substeps,
            iterations: self.iterations,
            sweeps: self.sweeps,
            speed_sweeps: 1,
            gravity: [0.0, 0.0, -self.gravity],
            length_unit: self.length_unit,
            contact_frequency: self.contact_frequency,
            contact_damping: self.contact_damping,
        };
        options.check()?;
        Ok(options)
    }
}
