//! The network that controls the iCub in `icub-reach`.

use farsa_lab::advanced::NormalizedController;
use farsa_lab::{Error, Parameter};
use farsa_nn::block::{Architecture, BlockLayout, BlockNetwork, BlockPlan, Span};
use farsa_nn::{Controller, Leak};

use crate::icub_reach::config::{INPUTS, MOTORS};
use crate::icub_reach::episode::Reacher;
use crate::icub_reach::scene::CONTROLLED;

/// Hidden neurons.
pub(crate) const HIDDEN: usize = 4;
/// The hidden neurons among all.
pub(crate) const HIDDEN_ONES: Span = Span::new(INPUTS, HIDDEN);

static PLAN: BlockPlan = Architecture::feed_forward(INPUTS, HIDDEN, MOTORS).plan();

/// Layout of a feed-forward network with 3 inputs, 4 hidden neurons and 6 outputs. The neurons are logistic and
/// have biases, so there are 46 parameters.
pub static LAYOUT: BlockLayout<'static> = PLAN.layout();

/// A network whose inputs can be disturbed and whose neurons can be silenced.
#[derive(Clone, Debug)]
pub struct Agent {
    network: NormalizedController<BlockNetwork<'static, Vec<f32>, Vec<f32>>>,
}

impl Agent {
    /// Creates an agent whose parameters are all zero.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if the layout is invalid.
    pub fn new() -> Result<Self, Error> {
        let (parameters, state) = (vec![0.0; LAYOUT.parameter_count()], vec![0.0; LAYOUT.state_len()]);
        let network = BlockNetwork::new(LAYOUT, Leak::Filter, parameters, state)
            .map_err(|error| Error::Other(format!("icub-reach: {error}")))?;
        Ok(Self { network: NormalizedController::new(network) })
    }

    /// Gets the network.
    pub fn network(&self) -> &NormalizedController<BlockNetwork<'static, Vec<f32>, Vec<f32>>> {
        &self.network
    }

    /// Returns a mutable reference to the network, for example to set its parameters.
    pub fn network_mut(&mut self) -> &mut NormalizedController<BlockNetwork<'static, Vec<f32>, Vec<f32>>> {
        &mut self.network
    }
}

impl Reacher for Agent {
    fn reset(&mut self) {
        self.network.reset();
    }

    fn step(&mut self, x: &[f32; INPUTS], _: &[f32; MOTORS], y: &mut [f32; MOTORS]) {
        self.network.step(x, y);
    }
}

/// The parameters by name, from minus to plus `range`.
pub(crate) fn parameters(range: f64) -> Vec<Parameter> {
    let hidden = (1..=HIDDEN).map(|number| format!("hidden {number}"));
    let motors = CONTROLLED.map(String::from);
    let first =
        ["x", "y", "z"].into_iter().flat_map(|axis| hidden.clone().map(move |to| format!("weight of {axis} on {to}")));
    let second = hidden.clone().flat_map(|from| motors.clone().map(move |to| format!("weight of {from} on {to}")));
    let biases = hidden.clone().chain(motors.clone()).map(|neuron| format!("bias of {neuron}"));
    first.chain(second).chain(biases).map(|name| Parameter::new(name, [-range, range])).collect()
}

/// Where the weights on a motor are among the parameters.
pub(crate) fn weights_on(motor: usize) -> impl Iterator<Item = usize> {
    (0..HIDDEN).map(move |hidden| INPUTS * HIDDEN + hidden * MOTORS + motor)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_network_is_two_layers_written_out() {
        let mut agent = Agent::new().unwrap();
        let own: Vec<f32> = (0..46_u16).map(|i| f32::from(i * 37 % 41) / 10.0 - 2.0).collect();
        assert_eq!(parameters(8.0).len(), own.len());
        agent.network.controller_mut().copy_parameters(&own).unwrap();
        let (x, mut y) = ([0.2, 0.9, 0.4], [0.0; 6]);
        agent.step(&x, &[0.0; 6], &mut y);
        let sigma = |net: f64| 1.0 / (1.0 + farsa_num::exp(-net));
        let p = |i: usize| f64::from(own[i]);
        let hidden = [0, 1, 2, 3].map(|h| sigma((0..3).fold(p(36 + h), |sum, i| sum + f64::from(x[i]) * p(4 * i + h))));
        for (motor, y) in y.iter().enumerate() {
            let net = weights_on(motor).zip(hidden).fold(p(40 + motor), |sum, (at, h)| sum + h * p(at));
            assert!((sigma(net) - f64::from(*y)).abs() < 1e-6, "{motor}");
        }
    }
}
