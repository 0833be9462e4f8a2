//! Networks.

use std::any::Any;
use std::collections::BTreeMap;
use std::fmt;

use farsa_lab::exports::NetworkExport;
use farsa_lab::{Error, Parameter};
use farsa_nn::{Ablatable, Controller as _};
use farsa_view::{Channel, Schema};

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

    /// Loads the parameters of a search, in the order of [`NetworkPart::parameters`]. By default it is the order of
    /// [`copy_parameters`](Self::copy_parameters).
    fn load(&mut self, searched: &[f32]) -> bool {
        self.copy_parameters(searched)
    }

    /// Returns the searched values among those of all parameters, in the order of [`load`](Self::load).
    fn searched(&self, all: &[f64]) -> Vec<f64> {
        all.to_vec()
    }

    /// Counts the values of the state.
    fn memory(&self) -> usize {
        self.neurons()
    }

    /// Describes the network in one line.
    fn summary(&self) -> String {
        let [inputs, outputs] = [self.inputs(), self.outputs()];
        format!("{inputs}-{outputs}, {} neurons of a registered network", self.neurons())
    }

    /// Returns the number of the first output neuron. By default the last neurons are the outputs.
    fn first_output(&self) -> usize {
        self.neurons().saturating_sub(self.outputs())
    }

    /// Returns the number of the first neuron that is no copy of an input.
    fn first_neuron(&self) -> usize {
        0
    }

    /// Names the neurons between those and the outputs, by default with numbers.
    fn hidden_names(&self) -> Vec<String> {
        Vec::new()
    }

    /// Adds neurons and links to the schema of a recording.
    #[doc(hidden)]
    fn drawn(&self, schema: Schema) -> Schema {
        let neurons = (1..=self.activations().len()).map(|neuron| Channel::new(&neuron.to_string()).group("neuron"));
        Schema { neurons: neurons.collect(), ..schema }
    }
}

/// A custom kind of network. Its fields are the keys of the file.
pub trait NetworkPart: Keys {
    /// The network.
    type Network: PartNetwork + Clone + Send + 'static;

    /// Builds the network at rest between inputs and outputs.
    ///
    /// # Errors
    /// Returns an error if the network cannot have these inputs or outputs.
    fn network(&self, ends: &NetworkEnds<'_>) -> Result<Self::Network, Error>;

    /// Lists the searched parameters with names and ranges, in the order of [`PartNetwork::load`].
    fn parameters(&self, network: &Self::Network, ends: &NetworkEnds<'_>) -> Vec<Parameter>;

    /// Lists values that are fixed unless the file searches them, by the names of parameters.
    fn given(&self, network: &Self::Network, ends: &NetworkEnds<'_>) -> BTreeMap<String, f64> {
        let _ = (network, ends);
        BTreeMap::new()
    }

    /// Lists the files that the network reads from the experiment's folder, each with its key.
    #[doc(hidden)]
    fn files(&self) -> Vec<(String, String)> {
        Vec::new()
    }
}

/// Inputs and outputs between which a network is built.
#[derive(Clone, Copy)]
pub struct NetworkEnds<'n> {
    /// Names of the inputs.
    pub inputs: &'n [String],
    /// Names of the outputs.
    pub outputs: &'n [String],
    /// Control step \[s\].
    pub time_step: f64,
    /// Range of weights, from the smallest gene to the largest.
    pub weights: [f64; 2],
    /// Sensors, with the first channel of each and the one after the last.
    pub(crate) sensors: &'n [(String, [usize; 2])],
    /// Motors, with the first channel of each and the one after the last.
    pub(crate) motors: &'n [(String, [usize; 2])],
    /// Disabled sensors and motors.
    pub(crate) absent: &'n [String],
    /// Contents of files by name.
    pub(crate) files: &'n BTreeMap<String, String>,
    pub(crate) text: &'n dyn NetworkText,
}

impl fmt::Debug for NetworkEnds<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { inputs, outputs, .. } = self;
        formatter.debug_struct("NetworkEnds").field("inputs", inputs).field("outputs", outputs).finish_non_exhaustive()
    }
}

impl NetworkEnds<'_> {
    /// Gets the numbers of inputs and outputs.
    pub fn shape(&self) -> [usize; 2] {
        [self.inputs.len(), self.outputs.len()]
    }

    /// Returns the number of a named end. `key` names it in the file.
    pub(crate) fn position(
        &self,
        names: &[String],
        (what, name): (&'static str, &str),
        key: &str,
    ) -> Result<usize, Error> {
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let found = names.iter().position(|other| *other == name);
        found.ok_or_else(|| self.text.unknown(key, (what, name), &names))
    }

    /// Creates the error of a key.
    pub(crate) fn error_at(&self, key: &str, why: impl fmt::Display) -> Error {
        self.text.wrong(key, why.to_string())
    }
}

/// Text of a network, for errors with their place.
pub(crate) trait NetworkText {
    /// Creates the error of a key of the network.
    fn wrong(&self, key: &str, why: String) -> Error;
    /// Creates the error of an unknown name.
    fn unknown(&self, key: &str, name: (&'static str, &str), names: &[&str]) -> Error;
    /// Checks the size of a network.
    fn check_network(&self, parameters: usize, memory: usize) -> Result<(), Error>;
}

/// A network at rest, with its parameters.
pub(crate) struct Built {
    pub(crate) network: Box<dyn AnyPartNetwork>,
    pub(crate) parameters: Vec<Parameter>,
    /// Values that are fixed unless the document searches them.
    pub(crate) given: BTreeMap<String, f64>,
}

/// A kind of network of unknown type.
pub(crate) trait AnyNetworkPart {
    /// Builds a network and checks its shape.
    fn built(&self, ends: &NetworkEnds<'_>) -> Result<Built, Error>;
    fn files(&self) -> Vec<(String, String)>;
}

impl<N: NetworkPart> AnyNetworkPart for N {
    fn built(&self, ends: &NetworkEnds<'_>) -> Result<Built, Error> {
        let network = self.network(ends)?;
        let [inputs, outputs] = ends.shape();
        if [network.inputs(), network.outputs()] != [inputs, outputs] {
            let why = format!(
                "has {} inputs and {} outputs where {inputs} and {outputs} are wanted",
                network.inputs(),
                network.outputs()
            );
            return Err(Error::Other(why));
        }
        let (parameters, given) = (self.parameters(&network, ends), self.given(&network, ends));
        ends.text.check_network(network.parameters().len(), network.memory())?;
        Ok(Built { network: Box::new(network), parameters, given })
    }

    fn files(&self) -> Vec<(String, String)> {
        NetworkPart::files(self)
    }
}

/// A network of unknown type.
pub(crate) trait AnyPartNetwork: PartNetwork + Send {
    /// Clones the network.
    fn boxed(&self) -> Box<dyn AnyPartNetwork>;
    /// Gets the network with its type.
    fn as_any(&self) -> &dyn Any;
}

impl<T: PartNetwork + Clone + Send + 'static> AnyPartNetwork for T {
    fn boxed(&self) -> Box<dyn AnyPartNetwork> {
        Box::new(self.clone())
    }

    fn as_any(&self) -> &dyn Any {
        self
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
