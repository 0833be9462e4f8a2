//! Values that swing with time.

use farsa_lab::Error;
use farsa_num::Stream;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{Filter, WrapperPart};

/// Replaces each value by a sine of the time since the start of the trial, from -1 to 1, such as a rhythm of steps.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Wave {
    /// Number of steps of a full turn.
    #[schemars(range(min = 2.0, max = 1e6))]
    period: f64,
    /// Phase at the start [deg].
    #[serde(default)]
    #[schemars(range(min = -360.0, max = 360.0))]
    phase: f64,
}

/// The phase of the present step, in full turns.
#[derive(Clone, Debug)]
pub(super) struct WaveFilter {
    first: f64,
    period: f64,
    steps: u32,
}

impl Filter for WaveFilter {
    fn reset(&mut self) {
        self.steps = 0;
    }

    fn pass(&mut self, values: &mut [f32], _: &mut Stream) {
        let turns = self.first + f64::from(self.steps) / self.period;
        self.steps = self.steps.saturating_add(1);
        // The part of a turn, so that large numbers of steps have the same accuracy.
        let (sine, _) = farsa_num::sin_cos(std::f64::consts::TAU * (turns - turns.floor()));
        values.fill(sine as f32);
    }

    fn is_random(&self) -> bool {
        false
    }
}

impl WrapperPart for Wave {
    type Filter = WaveFilter;

    fn filter(&self, _: usize) -> Result<WaveFilter, Error> {
        Ok(WaveFilter { first: self.phase / 360.0, period: self.period, steps: 0 })
    }

    fn about(&self) -> Option<String> {
        Some(format!("a sine with a period of {} steps from {} deg", self.period, self.phase))
    }
}
