//! The network of an agent, whole or changed by a test.

use farsa_lab::advanced::{Intervention, NormalizedController};
use farsa_lab::{EpisodeId, Error};
use farsa_nn::{Controller, Ctrnn};

use crate::compositional_instructions::network::{LAYOUT, Wiring};

/// A network that is made of genes and that tests can change.
#[derive(Clone, Debug)]
pub struct Agent {
    network: NormalizedController<Ctrnn<Vec<f32>, Vec<f32>>>,
    genes: Vec<f32>,
    parameters: Vec<f32>,
}

impl Agent {
    /// An agent whose network has the first ends of all ranges.
    ///
    /// # Errors
    /// [`Error::Other`] for values that make no network.
    pub fn new(wiring: &Wiring, time_step: f64) -> Result<Self, Error> {
        let wrong = |error: farsa_nn::Error| Error::Other(format!("compositional-instructions: {error}"));
        let first: Vec<f32> = wiring.parameters().iter().map(|parameter| parameter.ends[0] as f32).collect();
        let (mut genes, mut parameters) = (Vec::new(), vec![0.0; LAYOUT.parameter_count()]);
        wiring.expand(&first, &mut genes, &mut parameters);
        let state = vec![0.0; LAYOUT.state_len()];
        let network = Ctrnn::new(LAYOUT, time_step as f32, parameters.clone(), state).map_err(wrong)?;
        Ok(Self { network: NormalizedController::new(network), genes, parameters })
    }

    /// Sets the parameters and clears all changes. Returns false for another count of numbers, or for numbers that make no network.
    pub fn load(&mut self, wiring: &Wiring, values: &[f32]) -> bool {
        self.network.load(None)
            && wiring.expand(values, &mut self.genes, &mut self.parameters)
            && self.network.controller_mut().copy_parameters(&self.parameters).is_ok()
    }

    /// Applies the changes of a test until the next [`load`](Self::load). Returns false for changes that make no network.
    pub fn change(&mut self, intervention: &Intervention, id: EpisodeId) -> bool {
        self.network.intervene(intervention, id, 0);
        intervention.parameters.is_empty()
            || self.network.controller_mut().copy_parameters(&intervention.edited(&self.parameters)).is_ok()
    }

    /// The network.
    pub fn network(&self) -> &Ctrnn<Vec<f32>, Vec<f32>> {
        self.network.controller()
    }
}

impl Controller for Agent {
    fn inputs(&self) -> usize {
        self.network.inputs()
    }

    fn outputs(&self) -> usize {
        self.network.outputs()
    }

    fn reset(&mut self) {
        self.network.reset();
    }

    fn step(&mut self, x: &[f32], y: &mut [f32]) {
        self.network.step(x, y);
    }
}
