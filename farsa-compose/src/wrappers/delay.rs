//! Delays.

use farsa_body::wrappers::Delayed;
use farsa_lab::Error;
use farsa_num::Stream;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{Filter, WrapperPart};
use crate::wrappers::{Around, Values};

/// Delays values.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Delay {
    /// Delay [steps].
    #[schemars(range(min = 0, max = 10000))]
    steps: u32,
}

/// A filter that holds motors until the first value arrives.
#[derive(Clone, Debug)]
pub(super) struct DelayFilter {
    around: Around<Delayed<Values, Vec<f32>>>,
    steps: u32,
    /// Steps of this trial.
    count: u32,
}

impl Filter for DelayFilter {
    fn reset(&mut self) {
        self.around.reset();
        self.count = 0;
    }

    fn pass(&mut self, values: &mut [f32], noise: &mut Stream) {
        self.around.pass(values, noise);
        self.count = self.count.saturating_add(1);
    }

    fn holds(&self) -> bool {
        self.count <= self.steps
    }

    fn is_random(&self) -> bool {
        false
    }
}

impl WrapperPart for Delay {
    type Filter = DelayFilter;

    fn filter(&self, channels: usize) -> Result<DelayFilter, Error> {
        let delayed = Delayed::new(Values(channels), self.steps as usize);
        Ok(DelayFilter { around: Around::new(delayed), steps: self.steps, count: 0 })
    }

    fn memory(&self) -> usize {
        1 + self.steps as usize
    }

    fn about(&self) -> Option<String> {
        Some(match self.steps {
            1 => "a delay of 1 step".into(),
            steps => format!("a delay of {steps} steps"),
        })
    }
}
