//! Number of lanes per thread, and their instructions.

use farsa_num::Instructions;
use farsa_physics::articulated::{Batch, LANES};
use serde::{Deserialize, Serialize};

use crate::error::Error;

/// Number of trials that each thread runs side by side, and the instructions for them. Note that results do not
/// depend on this choice.
#[derive(Clone, Copy, Debug)]
pub struct Lanes {
    count: usize,
    instructions: Instructions,
}

impl Lanes {
    /// Runs one trial after the other.
    pub fn one() -> Self {
        Self { count: 1, instructions: Instructions::baseline() }
    }

    /// Selects the number of lanes. It must be 1 or one of [`LANES`].
    ///
    /// # Errors
    /// Returns [`Error::Usage`] for any other number.
    pub fn new(count: usize, instructions: Instructions) -> Result<Self, Error> {
        let counts = [1, LANES[0], LANES[1]];
        if !counts.contains(&count) {
            let nearest = counts.into_iter().min_by_key(|candidate| candidate.abs_diff(count)).unwrap_or(1);
            return Err(Error::Usage(format!("{count} lanes; the nearest number is {nearest}")));
        }
        Ok(Self { count, instructions })
    }

    /// Selects the number of lanes and the instructions that are usually fastest on this machine.
    pub fn best() -> Self {
        let instructions = Instructions::detect();
        Self { count: usual(instructions), instructions }
    }

    /// Gets the number of trials that run side by side.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Gets the instruction set. It only matters if there is more than one lane.
    pub fn instructions(&self) -> Instructions {
        self.instructions
    }

    /// Returns the choice as the manifest stores it.
    pub(crate) fn info(&self) -> LanesInfo {
        let simd = if self.count == 1 { "none" } else { name(self.instructions) };
        LanesInfo { lanes: self.count, simd: simd.into() }
    }
}

/// Lanes by name, in a run's manifest.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub(crate) struct LanesInfo {
    pub(crate) lanes: usize,
    pub(crate) simd: String,
}

impl Default for LanesInfo {
    /// Creates the value for sessions older than lanes.
    fn default() -> Self {
        Lanes::one().info()
    }
}

/// Lanes of a command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct LaneRequest {
    /// As many as the machine's instructions or the experiment make sensible, if there is no number.
    pub(crate) count: Option<usize>,
    /// Best of the machine, if there is no name.
    pub(crate) simd: Option<&'static str>,
}

/// Names of the instruction sets that there are steps for, on some machine.
pub(crate) const SIMD: [&str; 3] = ["baseline", "avx2", "avx512"];

/// Gets the name of an instruction set.
fn name(instructions: Instructions) -> &'static str {
    match instructions {
        Instructions::Avx512 => SIMD[2],
        Instructions::Avx2 => SIMD[1],
        _ => SIMD[0],
    }
}

/// Gets the number of worlds with the least cost per world.
fn usual(instructions: Instructions) -> usize {
    if name(instructions) == SIMD[2] { LANES[1] } else { LANES[0] }
}

impl LaneRequest {
    /// One lane, the default.
    pub(crate) const ONE: Self = Self { count: Some(1), simd: None };

    /// Selects from the instructions of this machine.
    ///
    /// # Errors
    /// [`Error::Usage`] for instructions that it lacks.
    pub(crate) fn on_this_machine(self) -> Result<Lanes, Error> {
        let available: Vec<Instructions> = Batch::instructions().collect();
        let selected = match self.simd {
            None => available.last(),
            Some(wanted) => available.iter().find(|instructions| name(**instructions) == wanted),
        };
        let Some(&instructions) = selected else {
            let names: Vec<&str> = available.iter().map(|instructions| name(*instructions)).collect();
            let wanted = self.simd.unwrap_or_default();
            return Err(Error::Usage(format!("--simd {wanted}: this processor has {} only", names.join(", "))));
        };
        Ok(Lanes { count: self.count.unwrap_or_else(|| usual(instructions)), instructions })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_is_what_is_wanted_by_default() {
        let best = LaneRequest { count: None, simd: None }.on_this_machine().unwrap();
        assert_eq!(best.info(), Lanes::best().info());
        let baseline = LaneRequest { count: None, simd: Some("baseline") }.on_this_machine().unwrap();
        assert_eq!(baseline.info(), LanesInfo { lanes: 8, simd: "baseline".into() });
        assert_eq!(LaneRequest::ONE.on_this_machine().unwrap().info(), LanesInfo::default());
        let error = LaneRequest { count: None, simd: Some("neon") }.on_this_machine().unwrap_err();
        assert_eq!(error.exit_code(), 2);
        let odd = Lanes::new(13, Instructions::detect()).unwrap_err().to_string();
        assert_eq!(odd, "13 lanes; the nearest number is 16");
        assert!(error.to_string().starts_with("--simd neon: this processor has baseline"), "{error}");
    }
}
