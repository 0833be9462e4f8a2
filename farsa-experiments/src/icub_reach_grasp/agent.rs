//! The network that controls the iCub in `icub-reach-grasp`.

use farsa_lab::Error;
use farsa_lab::advanced::{NormalizedController, OwnedNetwork};
use farsa_nn::{Controller as _, Leak, LeakyNetwork};

use crate::icub_reach_grasp::config::{Config, MOTORS, SENSORS};
use crate::icub_reach_grasp::episode::Grasper;
use crate::icub_reach_grasp::scene::wrong;

/// A network whose inputs can be disturbed and whose neurons can be silenced. The hidden neurons are leaky and
/// connected to each other, and the motor neurons are leaky, too.
#[derive(Clone, Debug)]
pub struct Agent {
    network: NormalizedController<OwnedNetwork>,
}

impl Agent {
    /// Creates an agent whose parameters are all zero.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if the layout is invalid.
    pub fn new(config: &Config) -> Result<Self, Error> {
        let layout = config.layout();
        let (parameters, state) = (vec![0.0; layout.parameter_count()], vec![0.0; layout.state_len()]);
        let network = LeakyNetwork::new(layout, Leak::Filter, parameters, state).map_err(|error| wrong(&error))?;
        Ok(Self { network: NormalizedController::new(network) })
    }

    /// Gets the network.
    pub fn network(&self) -> &NormalizedController<OwnedNetwork> {
        &self.network
    }

    /// Returns a mutable reference to the network, for example to set its parameters.
    pub fn network_mut(&mut self) -> &mut NormalizedController<OwnedNetwork> {
        &mut self.network
    }
}

impl Grasper for Agent {
    fn start(&mut self, _: [f64; 3]) {
        self.network.reset();
    }

    fn step(&mut self, x: &[f32; SENSORS], y: &mut [f32; MOTORS]) {
        self.network.step(x, y);
    }
}
