//! The controller of an agent, with the changes that the test protocols make to it.

use farsa_lab::advanced::{Intervention, NormalizedController};
use farsa_lab::{EpisodeId, Error};
use farsa_nn::{Controller, Ctrnn};

use crate::compositional_instructions::network::{LAYOUT, Wiring};

/// A network whose parameters are decoded from genes, and which the test protocols can modify.
#[derive(Clone, Debug)]
pub struct Agent {
    network: NormalizedController<Ctrnn<Vec<f32>, Vec<f32>>>,
    genes: Vec<f32>,
    parameters: Vec<f32>,
}

impl Agent {
    /// Creates an agent whose parameters are the lower ends of their ranges.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if no network can be built from these values.
    pub fn new(wiring: &Wiring, time_step: f64) -> Result<Self, Error> {
        let wrong = |error: farsa_nn::Error| Error::Other(format!("compositional-instructions: {error}"));
        let first: Vec<f32> = wiring.parameters().iter().map(|parameter| parameter.ends[0] as f32).collect();
        let (mut genes, mut parameters) = (Vec::new(), vec![0.0; LAYOUT.parameter_count()]);
        wiring.expand(&first, &mut genes, &mut parameters);
        let state = vec![0.0; LAYOUT.state_len()];
        let network = Ctrnn::new(LAYOUT, time_step as f32, parameters.clone(), state).map_err(wrong)?;
        Ok(Self { network: NormalizedController::new(network), genes, parameters })
    }

    /// Sets the parameters and removes all changes. Returns `false` if the number of values is wrong, or if they do not
    /// form a valid network.
    pub fn load(&mut self, wiring: &Wiring, values: &[f32]) -> bool {
        self.network.load(None)
            && wiring.expand(values, &mut self.genes, &mut self.parameters)
            && self.network.controller_mut().copy_parameters(&self.parameters).is_ok()
    }

    /// Applies the changes of a test. They remain until the next call of [`load`](Self::load). Returns `false` if the
    /// changed parameters do not form a valid network.
    pub fn change(&mut self, intervention: &Intervention, id: EpisodeId) -> bool {
        self.network.intervene(intervention, id, 0);
        intervention.parameters.is_empty()
            || self.network.controller_mut().copy_parameters(&intervention.edited(&self.parameters)).is_ok()
    }

    /// Returns the network.
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
