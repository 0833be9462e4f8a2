//! The mapping from genes to the network parameters of `reach-grasp-lift`.

use farsa_nn::{Leak, LeakyLayout, LeakyParameter};

use farsa_lab::advanced::network_parameters;
use farsa_lab::{Error, Parameter};

/// Weights and biases from minus to plus the range of weights, and leaks from 0 to 1, or as the original program has
/// them.
#[derive(Clone, Debug)]
pub(crate) struct Ranges {
    layout: LeakyLayout,
    range: f32,
    /// Leaks are |p| / range of what is decoded like a weight, as in the original program.
    evonet: bool,
}

impl Ranges {
    /// The ranges of a network's parameters.
    ///
    /// # Errors
    /// [`Error::Setting`] for an empty range.
    pub(crate) fn new(layout: LeakyLayout, leak: Leak, range: f32) -> Result<Self, Error> {
        network_parameters(&layout, f64::from(range), [0.0, 1.0], "network.range")?;
        Ok(Self { layout, range, evonet: leak == Leak::Evonet })
    }

    /// The parameters of an evaluation.
    pub(crate) fn parameters(&self) -> Vec<Parameter> {
        let leaks = if self.evonet { [-self.range, self.range] } else { [0.0, 1.0] };
        network_parameters(&self.layout, f64::from(self.range), leaks, "network.range").unwrap_or_default()
    }

    /// The parameters of the network.
    pub(crate) fn to_network(&self, parameters: &[f32]) -> Vec<f32> {
        let mut parameters = parameters.to_vec();
        if self.evonet {
            for leak in parameters.get_mut(self.layout.range(LeakyParameter::Leak)).unwrap_or_default() {
                let share = leak.abs() / self.range;
                // A range of 0 gives NaN: no memory, as for p = 0.
                *leak = if share < 1.0 {
                    share
                } else if share >= 1.0 {
                    1.0
                } else {
                    0.0
                };
            }
        }
        parameters
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reach_grasp_lift::config::Config;
    use farsa_lab::advanced::Genotype;

    #[test]
    fn genes_become_parameters_of_their_kinds() {
        let layout = Config::default().layout();
        let decode = |ranges: &Ranges, genes: &[u16]| {
            Genotype::new(&ranges.parameters(), 16).decode(genes).map(|parameters| ranges.to_network(&parameters))
        };
        let ranges = Ranges::new(layout, Leak::Filter, 6.0).unwrap();
        assert!(decode(&ranges, &[0; 791]).is_none());
        let mut genes = vec![u16::MAX; 792];
        genes[791] = 0;
        let parameters = decode(&ranges, &genes).unwrap();
        let parts = layout.split(&parameters);
        assert!(parts.sensor_weights.iter().chain(parts.biases).all(|p| *p == 6.0));
        assert_eq!(parts.leaks[..11], [1.0; 11]);
        assert_eq!(parts.leaks[11], 0.0);
        let ranges = Ranges::new(layout, Leak::Evonet, 6.0).unwrap();
        genes[790] = 1 << 15;
        let parameters = decode(&ranges, &genes).unwrap();
        let leaks = layout.split(&parameters).leaks;
        assert_eq!((leaks[0], leaks[11]), (1.0, 1.0));
        assert!(leaks[10] < 1e-4);
        assert!(Ranges::new(layout, Leak::Filter, f32::NAN).is_err());
    }
}
