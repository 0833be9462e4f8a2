//! Values that each trial draws.

use farsa_lab::Error;
use farsa_num::Stream;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{Filter, WrapperPart};

/// Replaces each value by a number that a trial draws uniformly, such as a command.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Drawn {
    /// Least number.
    #[schemars(range(min = -1e6, max = 1e6))]
    low: f64,
    /// Greatest number.
    #[schemars(range(min = -1e6, max = 1e6))]
    high: f64,
    /// Number of steps after which another is drawn. With 0 a trial draws once.
    #[serde(default)]
    #[schemars(range(min = 0, max = 1_000_000))]
    every: u32,
}

/// The numbers of a trial.
#[derive(Clone, Debug)]
pub(super) struct DrawnFilter {
    range: [f32; 2],
    every: u32,
    /// Steps since the start of the trial.
    steps: u32,
    numbers: Vec<f32>,
}

impl Filter for DrawnFilter {
    fn reset(&mut self) {
        self.steps = 0;
    }

    fn pass(&mut self, values: &mut [f32], noise: &mut Stream) {
        if self.steps == 0 || (self.every > 0 && self.steps.is_multiple_of(self.every)) {
            let [low, high] = self.range;
            self.numbers.iter_mut().for_each(|number| *number = noise.range(low, high));
        }
        self.steps = self.steps.saturating_add(1);
        values.iter_mut().zip(&self.numbers).for_each(|(value, number)| *value = *number);
    }
}

impl WrapperPart for Drawn {
    type Filter = DrawnFilter;

    fn filter(&self, channels: usize) -> Result<DrawnFilter, Error> {
        let Self { low, high, every } = *self;
        if low > high {
            return Err(Error::Other(format!("from {low} to {high} runs backwards")));
        }
        let range = [low as f32, high as f32];
        Ok(DrawnFilter { range, every, steps: 0, numbers: vec![0.0; channels] })
    }

    fn about(&self) -> Option<String> {
        let Self { low, high, every } = self;
        let again = if *every > 0 { format!(", again after {every} steps") } else { String::new() };
        Some(format!("a number drawn between {low} and {high}{again}"))
    }
}
