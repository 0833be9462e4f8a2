//! Noise.

use farsa_body::wrappers::{Noise, Noisy};
use farsa_lab::Error;
use farsa_num::Stream;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{Filter, WrapperPart};
use crate::wrappers::{Around, Values, wrong};

/// Adds to each value a number drawn uniformly between minus and plus this.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct UniformNoise {
    /// Largest added value.
    #[schemars(range(min = 0.0, max = 1e6))]
    amplitude: f64,
}

/// Adds to each value a number drawn from a normal distribution.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct NormalNoise {
    /// Its standard deviation.
    #[schemars(range(min = 0.0, max = 1e6))]
    deviation: f64,
}

/// A filter whose noise begins with each trial.
#[derive(Clone, Debug)]
pub(super) struct NoiseFilter {
    around: Around<Noisy<Values, Vec<f32>>>,
    is_started: bool,
}

impl NoiseFilter {
    fn new(noise: Noise, channels: usize) -> Result<Self, Error> {
        let noisy = Noisy::new(Values(channels), noise, Stream::from_seed(0)).map_err(wrong)?;
        Ok(Self { around: Around::new(noisy), is_started: false })
    }
}

impl Filter for NoiseFilter {
    fn reset(&mut self) {
        self.is_started = false;
    }

    fn pass(&mut self, values: &mut [f32], noise: &mut Stream) {
        if !self.is_started {
            self.around.wrapper.reseed(*noise);
            self.is_started = true;
        }
        self.around.pass(values, noise);
    }
}

impl WrapperPart for UniformNoise {
    type Filter = NoiseFilter;

    fn filter(&self, channels: usize) -> Result<NoiseFilter, Error> {
        NoiseFilter::new(Noise::Uniform(self.amplitude as f32), channels)
    }

    fn about(&self) -> Option<String> {
        Some(format!("noise of at most {}", self.amplitude))
    }
}

impl WrapperPart for NormalNoise {
    type Filter = NoiseFilter;

    fn filter(&self, channels: usize) -> Result<NoiseFilter, Error> {
        NoiseFilter::new(Noise::Normal(self.deviation as f32), channels)
    }

    fn about(&self) -> Option<String> {
        Some(format!("normal noise of deviation {}", self.deviation))
    }
}
