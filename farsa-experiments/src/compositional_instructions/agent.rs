//! The network of an agent, whole or with lesions.

use farsa_lab::Error;
use farsa_nn::{Ablatable as _, Controller, Ctrnn, CtrnnParameter, Lesion, Span};

use crate::compositional_instructions::network::{LAYOUT, NEURONS, Wiring};

/// A network that is made of genes and can have lesions.
#[derive(Clone, Debug)]
pub struct Agent {
    network: Ctrnn<Vec<f32>, Vec<f32>>,
    lesions: Vec<Lesion>,
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
        Ok(Self { network, lesions: Vec::with_capacity(NEURONS), genes, parameters })
    }

    /// Gives it these numbers, and makes it whole; false for another count of them or for numbers that make no network.
    pub fn load(&mut self, wiring: &Wiring, values: &[f32]) -> bool {
        self.lesions.clear();
        wiring.expand(values, &mut self.genes, &mut self.parameters)
            && self.network.copy_parameters(&self.parameters).is_ok()
    }

    /// Silences a neuron until the next [`load`](Self::load).
    pub fn silence(&mut self, neuron: usize) {
        self.lesions.push(Lesion::new(neuron));
    }

    /// Cuts the links from one group of neurons to another until the next [`load`](Self::load).
    pub fn cut(&mut self, from: Span, to: Span) {
        let weights = &mut self.parameters[LAYOUT.range(CtrnnParameter::Weight)];
        for source in from.first..from.end() {
            weights[source * NEURONS + to.first..source * NEURONS + to.end()].fill(0.0);
        }
        // What was accepted is so with fewer links.
        let _ = self.network.copy_parameters(&self.parameters);
    }

    /// The network.
    pub fn network(&self) -> &Ctrnn<Vec<f32>, Vec<f32>> {
        &self.network
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
        self.network.step_ablated(&self.lesions, x, y);
    }
}
