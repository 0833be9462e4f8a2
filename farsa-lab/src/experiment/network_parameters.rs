//! Parameters of a network with a bias and a leak for every neuron.

use farsa_nn::{Leak, LeakyLayout, LeakyNetwork, LeakyParameter};

use crate::error::Error;
use crate::experiment::parameter::Parameter;

/// A network that owns its memory.
pub type OwnedNetwork = LeakyNetwork<Vec<f32>, Vec<f32>>;

/// Lists the parameters of a network in their order.
///
/// Weights and biases range from `-range` to `range`, and leaks from `leaks[0]` to `leaks[1]`.
///
/// # Errors
/// Returns [`Error::Setting`] with this `key` if the range is negative, or not finite in f32. Note that networks
/// compute in f32.
pub fn network_parameters(
    layout: &LeakyLayout,
    range: f64,
    leaks: [f32; 2],
    key: &str,
) -> Result<Vec<Parameter>, Error> {
    let range = range as f32;
    if !(0.0..=f32::MAX).contains(&range) {
        return Err(Error::setting(key, format!("weights from {} to {range}: no range of numbers", -range)));
    }
    let (hidden, outputs) = (layout.hidden().max(1), layout.outputs().max(1));
    let of_kind = |kind: LeakyParameter| {
        let ends = if kind == LeakyParameter::Leak { leaks } else { [-range, range] };
        let name = move |index: usize| {
            let pair = |targets: usize| (index / targets + 1, index % targets + 1);
            match kind {
                LeakyParameter::SensorWeight => {
                    format!("weight of sensor {} on neuron {}", pair(hidden).0, pair(hidden).1)
                }
                LeakyParameter::RecurrentWeight => {
                    format!("weight of neuron {} on neuron {}", pair(hidden).0, pair(hidden).1)
                }
                LeakyParameter::OutputWeight => {
                    format!("weight of neuron {} on output {}", pair(outputs).0, pair(outputs).1)
                }
                LeakyParameter::Bias => format!("bias of neuron {}", index + 1),
                _ => format!("leak of neuron {}", index + 1),
            }
        };
        (0..layout.range(kind).len()).map(move |index| Parameter::new(name(index), ends.map(f64::from)))
    };
    Ok(LeakyParameter::ALL.into_iter().flat_map(of_kind).collect())
}

/// Creates a network at rest, in which leaks are filters and all parameters are 0.
///
/// # Errors
/// Returns [`Error::Other`] if the layout is invalid.
pub fn resting_network(layout: &LeakyLayout) -> Result<OwnedNetwork, Error> {
    let (parameters, state) = (vec![0.0; layout.parameter_count()], vec![0.0; layout.state_len()]);
    LeakyNetwork::new(*layout, Leak::Filter, parameters, state)
        .map_err(|error| Error::Other(format!("network: {error}")))
}
