//! Rows of inputs and outputs of the network in Rust, as a self-test of the network in C.

use farsa_nn::block::BlockNetwork;
use farsa_nn::{Controller, Ctrnn, LeakyNetwork, Perceptron};
use farsa_num::{Domain, Stream};

use crate::error::Error;
use crate::experiment::network_export::NetworkExport;
use crate::export::c::code::{Rows, literals, real};

/// Number of rows, which are consecutive steps.
pub(super) const ROWS: usize = 16;

/// Returns inputs in \[0, 1) of all rows.
pub(super) fn inputs(count: usize) -> Vec<f32> {
    let mut stream = Stream::new(1, Domain::Network, 0, 0, 0);
    (0..ROWS * count).map(|_| stream.range(0.0, 1.0)).collect()
}

/// Steps a network in single precision over the rows.
///
/// # Errors
/// [`Error::Usage`] for outputs without a literal in C.
pub(super) fn reals(network: &NetworkExport) -> Result<Rows, Error> {
    let [inputs_len, outputs_len] = network.shape();
    let mut controller = controller(network).map_err(|error| Error::Other(error.to_string()))?;
    let x = inputs(inputs_len);
    let mut outputs = Vec::new();
    for row in 0..ROWS {
        let mut y = vec![0.0; outputs_len];
        controller.step(&x[row * inputs_len..(row + 1) * inputs_len], &mut y);
        if let Some((output, value)) = y.iter().enumerate().find(|(_, value)| !value.is_finite()) {
            return Err(Error::Usage(format!(
                "output {output} of the network is {value} in step {} of inputs from 0 to 1, which has no form in C",
                row + 1
            )));
        }
        outputs.extend(y);
    }
    Ok(Rows { inputs: literals(x, real), outputs: literals(outputs, real) })
}

/// Builds the network in Rust.
fn controller(network: &NetworkExport) -> Result<Box<dyn Controller + '_>, farsa_nn::Error> {
    Ok(match network {
        NetworkExport::Leaky { layout, leak, parameters } => {
            Box::new(LeakyNetwork::new(*layout, *leak, parameters, vec![0.0; layout.state_len()])?)
        }
        NetworkExport::Perceptron { inputs, outputs, slope, parameters } => {
            Box::new(Perceptron::new(*inputs, *outputs, *slope, parameters)?)
        }
        NetworkExport::Ctrnn { layout, time_step, parameters } => {
            Box::new(Ctrnn::new(*layout, *time_step, parameters, vec![0.0; layout.state_len()])?)
        }
        NetworkExport::Blocks { layout, leak, parameters } => {
            let layout = layout.layout();
            Box::new(BlockNetwork::new(layout, *leak, parameters, vec![0.0; layout.state_len()])?)
        }
    })
}
