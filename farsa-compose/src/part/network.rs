//! Networks.

use std::fmt;

use farsa_lab::exports::NetworkExport;
use farsa_lab::{Error, Parameter};
use farsa_nn::{Ablatable, Controller as _};

use crate::part::keys::Keys;

/// A network whose parameters are searched.
pub trait PartNetwork: Ablatable {
    /// Replaces all parameters. Returns false for another number of them or values out of range, which makes the
    /// trial fail.
    fn copy_parameters(&mut self, parameters: &[f32]) -> bool;

    /// Gets all parameters, in the order of [`copy_parameters`](Self::copy_parameters).
    fn parameters(&self) -> &[f32];

    /// Gets the activations of all [`neurons`](Ablatable::neurons), for recordings.
    fn activations(&self) -> &[f32];

    /// Describes the network for `farsa export`. By default it cannot be exported.
    fn export(&self) -> Option<NetworkExport> {
        None
    }
}

/// A custom kind of network. Its fields are the keys of the file.
pub trait NetworkPart: Keys {
    /// The network.
    type Network: PartNetwork + Clone + Send + 'static;

    /// Builds the network at rest for these numbers of inputs and outputs. Control steps last `time_step` [s].
    ///
    /// # Errors
    /// Returns an error if the network cannot have these inputs or outputs.
    fn network(&self, inputs: usize, outputs: usize, time_step: f64) -> Result<Self::Network, Error>;

    /// Lists the parameters with names and ranges, in the order of [`PartNetwork::copy_parameters`].
    fn parameters(&self, inputs: usize, outputs: usize) -> Vec<Parameter>;
}

/// A network at rest, with its parameters.
pub(crate) struct Built {
    pub(crate) network: Box<dyn AnyPartNetwork>,
    pub(crate) parameters: Vec<Parameter>,
}

/// Builds a network and checks its shape.
pub(crate) fn built<N: NetworkPart>(part: &N, [inputs, outputs]: [usize; 2], time_step: f64) -> Result<Built, Error> {
    let network = part.network(inputs, outputs, time_step)?;
    if [network.inputs(), network.outputs()] != [inputs, outputs] {
        let why = format!(
            "has {} inputs and {} outputs where {inputs} and {outputs} are wanted",
            network.inputs(),
            network.outputs()
        );
        return Err(Error::Other(why));
    }
    Ok(Built { network: Box::new(network), parameters: part.parameters(inputs, outputs) })
}

/// A network of unknown type.
pub(crate) trait AnyPartNetwork: PartNetwork + Send {
    /// Clones the network.
    fn boxed(&self) -> Box<dyn AnyPartNetwork>;
}

impl<T: PartNetwork + Clone + Send + 'static> AnyPartNetwork for T {
    fn boxed(&self) -> Box<dyn AnyPartNetwork> {
        Box::new(self.clone())
    }
}

impl Clone for Box<dyn AnyPartNetwork> {
    fn clone(&self) -> Self {
        (**self).boxed()
    }
}

impl fmt::Debug for dyn AnyPartNetwork {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("AnyPartNetwork")
    }
}
