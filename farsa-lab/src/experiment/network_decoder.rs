//! From genes to a network with a bias and a leak for every neuron.

use farsa_evo::{GeneRange, decode};
use farsa_nn::{Layout, Leak, Network, ParameterKind};

use crate::error::Error;

/// A network over memory of its own.
pub type TeamNetwork = Network<Vec<f32>, Vec<f32>>;

/// From genes to the parameters of a network.
#[derive(Clone, Debug)]
pub struct NetworkDecoder {
    ranges: Vec<GeneRange>,
    /// The layout of the network.
    pub layout: Layout,
    /// The parameters of the genome that was decoded last.
    pub parameters: Vec<f32>,
}

impl NetworkDecoder {
    /// Weights and biases within plus and minus `range`, leaks within 0 and 1.
    ///
    /// # Errors
    /// [`Error::Setting`] for a range that is none.
    pub fn new(layout: Layout, range: f64) -> Result<Self, Error> {
        let range = range as f32;
        let of_kind = |kind: ParameterKind| {
            let (low, high) = if kind == ParameterKind::Leak { (0.0, 1.0) } else { (-range, range) };
            GeneRange::new(layout.range(kind).len(), low, high)
        };
        let ranges = ParameterKind::ALL.into_iter().map(of_kind).collect::<Result<_, _>>();
        let ranges = ranges.map_err(|error| Error::setting("net.weight_range", error))?;
        Ok(Self { ranges, layout, parameters: vec![0.0; layout.parameter_count()] })
    }

    /// A network at rest with the parameters at hand.
    ///
    /// # Errors
    /// [`Error::Other`] for a layout that no network has.
    pub fn network(&self) -> Result<TeamNetwork, Error> {
        let state = vec![0.0; self.layout.state_len()];
        Network::new(self.layout, Leak::Filter, self.parameters.clone(), state)
            .map_err(|error| Error::Other(format!("team: {error}")))
    }

    /// Gives all networks the same parameters; false for a genome of another length.
    pub fn decode_into(&mut self, genes: &[u16], networks: &mut [TeamNetwork]) -> bool {
        decode(genes, &self.ranges, &mut self.parameters).is_ok()
            && networks.iter_mut().all(|network| network.copy_parameters(&self.parameters).is_ok())
    }
}
