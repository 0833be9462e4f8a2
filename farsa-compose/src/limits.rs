//! Limits on the sizes of experiments from untrusted files.

use farsa_lab::Error;

/// The largest experiment that a reader accepts.
///
/// A file of a few letters can request a large network or many robots. The limits bound the memory and the time of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Limits {
    /// Parameters of a network, and values of its state. Wrappers and networks of all robots keep at most ten times as many.
    pub network_values: usize,
    /// Robots.
    pub robots: usize,
    /// Sensors and motors of all robots.
    pub parts: usize,
    /// Rays of all sensors in a step.
    pub rays: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self { network_values: 1_000_000, robots: 1000, parts: 100_000, rays: 200_000 }
    }
}

impl Limits {
    /// Checks the size of a network.
    pub(crate) fn check_network(&self, parameters: usize, state: usize) -> Result<(), Error> {
        let most = self.network_values;
        for (what, count) in [("parameters", parameters), ("values to remember", state)] {
            if count > most {
                return Err(Error::Other(format!("has {count} {what}; at most {most} make a network")));
            }
        }
        Ok(())
    }
}
