//! A robot that finds a nest without evolution, to compare evolved ones with.

use farsa_nn::Controller;

use crate::aggregation::config::AggregationConfig;
use crate::team::config::EYES;
use crate::team::robots::OUTPUTS;
use crate::team::steering::{away, eyes};

/// Stays on a nest and shines red there. Off a nest it steers to red light, else drives straight on and turns away from objects in
/// its infrared sensors.
///
/// No memory. Inputs and outputs are those of [`crate::aggregation::AggregationEpisode`].
#[derive(Clone, Debug)]
pub struct BeaconSeeker {
    inputs: usize,
    sectors: usize,
    eyes: [(f32, bool); EYES],
}

impl BeaconSeeker {
    /// A seeker for the robots of a configuration.
    pub fn new(config: &AggregationConfig) -> Self {
        Self { inputs: config.inputs(), sectors: config.team.sectors, eyes: eyes(&config.team.robot) }
    }
}

impl Controller for BeaconSeeker {
    fn inputs(&self) -> usize {
        self.inputs
    }
    fn outputs(&self) -> usize {
        OUTPUTS
    }
    fn reset(&mut self) {}
    fn step(&mut self, x: &[f32], y: &mut [f32]) {
        let nest = x.get(self.inputs - 1).is_some_and(|x| *x > 0.5);
        let red = |sector: usize| x.get(EYES + 2 * sector).copied().unwrap_or(0.0);
        let half = self.sectors / 2;
        let (left, right): (f32, f32) = ((0..half).map(red).sum(), (self.sectors - half..self.sectors).map(red).sum());
        let driven = if nest {
            [0.0, 0.5, 1.0, 0.0]
        } else if let Some(turn) = away(&self.eyes, x) {
            [0.3, turn, 0.0, 0.0]
        } else if left + right > 0.0 {
            [1.0, 0.5 + 0.2 * (left - right) / (left + right), 0.0, 0.0]
        } else {
            [1.0, 0.5, 0.0, 0.0]
        };
        y.iter_mut().zip(driven).for_each(|(y, value)| *y = value);
    }
}
