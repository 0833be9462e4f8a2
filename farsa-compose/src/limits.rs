//! Limits on the sizes of experiments from untrusted files.

use farsa_lab::Error;

/// Limits on the size of an experiment. Larger experiments are rejected.
///
/// Note that even a very short file can request a huge network or for many robots. Therefore, these limits bound the
/// memory and the time of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Limits {
    /// Maximum number of parameters of a network, and of values of its state. Wrappers and networks of all robots
    /// together can have ten times as many.
    pub network_values: usize,
    /// Maximum number of robots.
    pub robots: usize,
    /// Maximum number of sensors and motors of all robots.
    pub parts: usize,
    /// Maximum number of rays of all sensors in a step.
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
