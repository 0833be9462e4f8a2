//! Functions that drive robots instead of networks.

use std::fmt;
use std::sync::Arc;

use farsa_nn::{Ablatable, Controller, Lesion};

use crate::part::PartNetwork;

/// A function that computes the motor values of a robot from its sensor values.
///
/// It replaces the network of the robot. This is useful for comparisons with controllers that did not evolve.
pub type Reflex = Arc<dyn Fn(&[f32], &mut [f32]) + Send + Sync>;

/// A function as the controller of a robot.
#[derive(Clone)]
pub(crate) struct ReflexController {
    /// Numbers of inputs and outputs.
    pub(crate) shape: [usize; 2],
    pub(crate) reflex: Reflex,
}

impl fmt::Debug for ReflexController {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("ReflexController").field("shape", &self.shape).finish_non_exhaustive()
    }
}

impl Controller for ReflexController {
    fn inputs(&self) -> usize {
        self.shape[0]
    }
    fn outputs(&self) -> usize {
        self.shape[1]
    }
    fn reset(&mut self) {}
    fn step(&mut self, x: &[f32], y: &mut [f32]) {
        (self.reflex)(x, y);
    }
}

impl Ablatable for ReflexController {
    fn neurons(&self) -> usize {
        0
    }
    fn step_ablated(&mut self, _: &[Lesion], x: &[f32], y: &mut [f32]) {
        self.step(x, y);
    }
}

impl PartNetwork for ReflexController {
    fn copy_parameters(&mut self, _: &[f32]) -> bool {
        true
    }

    fn parameters(&self) -> &[f32] {
        &[]
    }

    fn activations(&self) -> &[f32] {
        &[]
    }

    fn summary(&self) -> String {
        format!("{}-{}, wired by hand", self.shape[0], self.shape[1])
    }
}
