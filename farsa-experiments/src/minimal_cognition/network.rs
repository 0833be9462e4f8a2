//! The network of `minimal-cognition`. Its layers of sensory, inner and motor neurons are symmetric.

use farsa_lab::{Error, Parameter};
use farsa_nn::block::Span;
use farsa_nn::{CtrnnLayout, CtrnnParameter, CtrnnSymmetry};

use crate::minimal_cognition::config::Config;

/// Number of rays and of sensory neurons. They are ordered from left to right.
pub const RAYS: usize = 7;
/// Number of inner neurons. They are ordered from left to right.
pub const INNER: usize = 5;
/// Number of motor neurons. The first one moves the agent to the right and the second one to the left.
pub const MOTORS: usize = 2;
/// Total number of neurons. Sensory neurons come first, followed by inner and motor neurons.
pub const NEURONS: usize = RAYS + INNER + MOTORS;

/// Layout of the network. Each ray is connected to one sensory neuron.
pub const LAYOUT: CtrnnLayout = CtrnnLayout::new(RAYS, NEURONS, MOTORS).with_direct_inputs(0);

const SENSORY: Span = Span::new(0, RAYS);
const INNER_ONES: Span = Span::new(RAYS, INNER);
pub(crate) const MOTOR_ONES: Span = Span::new(RAYS + INNER, MOTORS);
/// The layers that are linked, each neuron of the one to each of the other.
pub(crate) const LINKED: [(Span, Span); 3] =
    [(SENSORY, INNER_ONES), (INNER_ONES, INNER_ONES), (INNER_ONES, MOTOR_ONES)];
/// The neuron on the other side: layers are turned about their middle.
const MIRROR: [usize; NEURONS] = [6, 5, 4, 3, 2, 1, 0, 11, 10, 9, 8, 7, 13, 12];

/// Defines from which gene each parameter of the network is decoded.
///
/// A parameter and its mirror image share a gene, and all sensory neurons share one bias, time constant and gain. This
/// results in the 47 parameters of the source:
///
/// | what | parameters | in pairs | genes |
/// |---|---|---|---|
/// | weights sensory to inner | 35 | all but the middle ray to the middle neuron | 17 + 1 |
/// | weights inner to inner | 25 | all but the middle neuron to itself | 12 + 1 |
/// | weights inner to motor | 10 | all | 5 |
/// | biases | 14 | 1 of the sensory, 3 of the inner, 1 of the motor neurons | 5 |
/// | gain of the sensory neurons | 7 | 1 | 1 |
/// | time constants | 14 | as the biases | 5 |
///
/// All other weights are 0, and all other gains are 1. Genes are ordered by the first parameter that they determine, as
/// in [`CtrnnSymmetry`]. For an inner neuron, the weights to the inner neurons come first, followed by the weights to
/// the motor neurons.
#[derive(Clone, Debug)]
pub struct Wiring {
    symmetry: CtrnnSymmetry<'static>,
    /// One for each gene.
    parameters: Vec<Parameter>,
}

impl Wiring {
    /// Creates the wiring. Genes are decoded to the ranges of the configuration.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if a range is empty.
    pub fn new(config: &Config) -> Result<Self, Error> {
        let symmetry = CtrnnSymmetry::new(LAYOUT, &[], &MIRROR)?
            .with_links(&LINKED)?
            .with_alike(&[SENSORY])?
            .with_gains(&[SENSORY])?;
        let both = |range: f64| [-range, range];
        let range = |kind| match kind {
            CtrnnParameter::Bias => both(config.bias_range),
            CtrnnParameter::Gain => config.gains,
            CtrnnParameter::TimeConstant => config.time_constants,
            _ => both(config.weight_range),
        };
        let mut parameters = Vec::new();
        for (number, kind) in symmetry.kinds().enumerate() {
            // Networks compute in f32.
            let [low, high] = range(kind).map(|end| f64::from(end as f32));
            if !(low.is_finite() && high.is_finite() && low <= high) {
                return Err(Error::Other(format!(
                    "minimal-cognition: {kind:?} from {low} to {high}: no range of numbers"
                )));
            }
            parameters.push(Parameter::new(format!("{kind:?} {}", number + 1), [low, high]));
        }
        Ok(Self { symmetry, parameters })
    }

    /// Gets the number of genes. It is always 47.
    pub fn genes(&self) -> usize {
        self.parameters.len()
    }

    /// Gets the encoded parameters and their ranges. They are ordered by the first parameter of the network that
    /// they determine.
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// Computes the parameters of the network, in the order of [`LAYOUT`]. Returns `None` if the number of values is
    /// wrong.
    pub fn expand(&self, values: &[f32]) -> Option<Vec<f32>> {
        let mut parameters = vec![0.0; LAYOUT.parameter_count()];
        self.symmetry.expand(values, &mut parameters).ok()?;
        Some(parameters)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use farsa_lab::advanced::Genotype;

    fn decoded(genes: &[u16]) -> Vec<f32> {
        let wiring = Wiring::new(&Config::default()).unwrap();
        let values = Genotype::new(wiring.parameters(), 16).decode(genes).unwrap();
        wiring.expand(&values).unwrap()
    }

    #[test]
    fn there_are_the_sources_47_genes_and_each_has_its_parameters() {
        let wiring = Wiring::new(&Config::default()).unwrap();
        assert_eq!(wiring.genes(), 47);
        assert!(wiring.expand(&[0.0; 46]).is_none());
        let plain = decoded(&[20_000; 47]);
        // The number of parameters of each gene: a pair, the middle alone, or the sensory neurons together.
        let followers: Vec<usize> = (0..47)
            .map(|gene| {
                let mut genes = [20_000; 47];
                genes[gene] = 40_000;
                decoded(&genes).iter().zip(&plain).filter(|(one, other)| one != other).count()
            })
            .collect();
        let mut expected = vec![2; 17];
        expected.push(1);
        // Two inner neurons to five and to the two motors, and the middle one to two pairs, to itself and to the motors.
        expected.extend([2; 2 * (5 + 2) + 2]);
        expected.extend([1, 2]);
        let biases = [7, 2, 2, 1, 2];
        expected.extend(biases);
        expected.push(7);
        expected.extend(biases);
        assert_eq!(followers, expected);
        assert_eq!(followers.iter().sum::<usize>(), 35 + 25 + 10 + 14 + 14 + 7);
    }

    #[test]
    fn parameters_are_in_their_ranges_and_only_layers_are_linked() {
        let Config { weight_range, bias_range, time_constants, gains, .. } = Config::default();
        for (gene, end) in [(0, 0), (u16::MAX, 1)] {
            let parameters = decoded(&[gene; 47]);
            let parts = LAYOUT.split(&parameters);
            let sign = [-1.0, 1.0][end];
            assert!(parts.biases.iter().all(|bias| f64::from(*bias) == sign * bias_range));
            assert!(parts.time_constants.iter().all(|tau| f64::from(*tau) == time_constants[end]));
            assert!(parts.gains[..RAYS].iter().all(|gain| f64::from(*gain) == gains[end]));
            assert_eq!(parts.gains[RAYS..], [1.0; INNER + MOTORS]);
            for (from, to) in (0..NEURONS).flat_map(|from| (0..NEURONS).map(move |to| (from, to))) {
                let linked = LINKED.iter().any(|(sources, targets)| sources.contains(from) && targets.contains(to));
                let expected = if linked { sign * weight_range } else { 0.0 };
                assert_eq!(f64::from(parts.weights[from * NEURONS + to]), expected, "{from} to {to}");
            }
        }
    }

    #[test]
    fn the_other_side_is_the_same() {
        let genes: Vec<u16> = (0..47).map(|gene| gene * 1311).collect();
        let parameters = decoded(&genes);
        let parts = LAYOUT.split(&parameters);
        for one in 0..NEURONS {
            let other = MIRROR[one];
            assert_eq!(MIRROR[other], one);
            for values in [parts.biases, parts.gains, parts.time_constants] {
                assert_eq!(values[one], values[other]);
            }
            for to in 0..NEURONS {
                assert_eq!(parts.weights[one * NEURONS + to], parts.weights[other * NEURONS + MIRROR[to]]);
            }
        }
    }
}
