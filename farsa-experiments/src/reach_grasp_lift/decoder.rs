//! The genotype of `reach-grasp-lift`.

use farsa_evo::{GeneRange, decode};
use farsa_lab::Error;
use farsa_nn::{Layout, Leak, ParameterKind};

use crate::reach_grasp_lift::stage::NetworkLife;

/// From genes to the network's parameters.
pub(crate) struct Decoder {
    layout: Layout,
    ranges: Vec<GeneRange>,
    /// Leaks are |p| / range of what is decoded like a weight, as in the original program.
    evonet: Option<f32>,
    pub(crate) parameters: Vec<f32>,
}

impl Decoder {
    /// Weights and biases from -`range` to `range`.
    ///
    /// # Errors
    /// [`Error::Setting`] for a range that is none.
    pub(crate) fn new(layout: Layout, leak: Leak, range: f32) -> Result<Self, Error> {
        let evonet = (leak == Leak::Evonet).then_some(range);
        let leaks = if evonet.is_some() { (-range, range) } else { (0.0, 1.0) };
        let mut ranges = Vec::new();
        for kind in ParameterKind::ALL {
            let (low, high) = if kind == ParameterKind::Leak { leaks } else { (-range, range) };
            let genes = GeneRange::new(layout.range(kind).len(), low, high);
            ranges.push(genes.map_err(|error| Error::setting("network.range", error))?);
        }
        Ok(Self { layout, ranges, evonet, parameters: vec![0.0; layout.parameter_count()] })
    }

    /// Gives a life its parameters; false for a genome of another length or a range of weights that f32 cannot hold.
    pub(crate) fn decode_into(&mut self, genes: &[u16], life: &mut NetworkLife) -> bool {
        let decoded = self.decode(genes) && life.controller_mut().copy_parameters(&self.parameters).is_ok();
        debug_assert!(decoded, "{} genes for {} parameters", genes.len(), self.parameters.len());
        decoded
    }

    /// Decodes to [`parameters`](Self::parameters); false for a genome of another length.
    pub(crate) fn decode(&mut self, genes: &[u16]) -> bool {
        let decoded = decode(genes, &self.ranges, &mut self.parameters).is_ok();
        if let Some(range) = self.evonet {
            for leak in &mut self.parameters[self.layout.range(ParameterKind::Leak)] {
                let share = leak.abs() / range;
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
        decoded
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reach_grasp_lift::config::Config;

    #[test]
    fn genes_become_parameters_of_their_kinds() {
        let layout = Config::default().layout();
        let mut decoder = Decoder::new(layout, Leak::Filter, 6.0).unwrap();
        assert!(!decoder.decode(&[0; 791]));
        let mut genes = vec![u16::MAX; 792];
        genes[791] = 0;
        assert!(decoder.decode(&genes));
        let parts = layout.split(&decoder.parameters);
        assert!(parts.sensor_weights.iter().chain(parts.biases).all(|p| *p == 6.0));
        assert_eq!(parts.leaks[..11], [1.0; 11]);
        assert_eq!(parts.leaks[11], 0.0);
        let mut decoder = Decoder::new(layout, Leak::Evonet, 6.0).unwrap();
        genes[790] = 1 << 15;
        assert!(decoder.decode(&genes));
        let leaks = layout.split(&decoder.parameters).leaks;
        assert_eq!((leaks[0], leaks[11]), (1.0, 1.0));
        assert!(leaks[10] < 1e-4);
        assert!(Decoder::new(layout, Leak::Filter, f32::NAN).is_err());
    }
}
