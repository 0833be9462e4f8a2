//! The network of `minimal-cognition`: layers of sensory, inner and motor neurons that are the same left and right.

use core::ops::Range;

use farsa_evo::{EvoError, GeneRange, decode};
use farsa_nn::{CtrnnLayout, CtrnnParameter};

use crate::minimal_cognition_config::Config;

/// Rays, and sensory neurons, from left to right.
pub const RAYS: usize = 7;
/// Inner neurons, from left to right.
pub const INNER: usize = 5;
/// Motor neurons: to the right, to the left.
pub const MOTORS: usize = 2;
/// All neurons: sensory, then inner, then motor.
pub const NEURONS: usize = RAYS + INNER + MOTORS;

/// The layout: each ray is the external input of a sensory neuron.
pub const LAYOUT: CtrnnLayout = CtrnnLayout::new(RAYS, NEURONS, MOTORS).with_direct_inputs(0);

pub(crate) const SENSORY: Range<usize> = 0..RAYS;
pub(crate) const INNER_ONES: Range<usize> = RAYS..RAYS + INNER;
pub(crate) const MOTOR_ONES: Range<usize> = RAYS + INNER..NEURONS;
/// The layers that are linked, each neuron of the one to each of the other.
pub(crate) const LINKED: [[Range<usize>; 2]; 3] =
    [[SENSORY, INNER_ONES], [INNER_ONES, INNER_ONES], [INNER_ONES, MOTOR_ONES]];

/// The neuron on the other side: layers are turned about their middle.
fn mirror(neuron: usize) -> usize {
    let layer = [SENSORY, INNER_ONES, MOTOR_ONES].into_iter().find(|layer| layer.contains(&neuron));
    layer.map_or(neuron, |layer| layer.start + layer.end - 1 - neuron)
}

/// Which gene each parameter of the network is decoded from.
///
/// A parameter and its mirror image share a gene, and the sensory neurons share one bias, time constant and gain. That
/// makes the 47 parameters of the source:
///
/// | what | parameters | in pairs | genes |
/// |---|---|---|---|
/// | weights sensory to inner | 35 | all but the middle ray to the middle neuron | 17 + 1 |
/// | weights inner to inner | 25 | all but the middle neuron to itself | 12 + 1 |
/// | weights inner to motor | 10 | all | 5 |
/// | biases | 14 | 1 of the sensory, 3 of the inner, 1 of the motor neurons | 5 |
/// | time constants | 14 | the same | 5 |
/// | gain of the sensory neurons | 7 | 1 | 1 |
///
/// All other weights are 0, all other gains 1. Genes stand in the order of the table, weights source by source.
#[derive(Clone, Debug)]
pub struct Wiring {
    /// The gene of each parameter, or the value that it always has.
    parameters: Vec<Result<usize, f32>>,
    /// What the genes stand for.
    ranges: Vec<GeneRange>,
    /// The decoded genes.
    values: Vec<f32>,
}

impl Wiring {
    /// The wiring, its genes decoded to the ranges of a configuration.
    ///
    /// # Errors
    /// [`EvoError::Range`] for a range that is none.
    pub fn new(config: &Config) -> Result<Self, EvoError> {
        let mut parameters = vec![Err(0.0); LAYOUT.parameter_count()];
        parameters[LAYOUT.range(CtrnnParameter::Gain)].fill(Err(1.0));
        let mut genes = 0;
        let mut share = |own: usize, other: usize| {
            let gene = parameters[other].unwrap_or_else(|_| {
                genes += 1;
                genes - 1
            });
            parameters[own] = Ok(gene);
            gene + 1
        };
        let first = |kind| LAYOUT.range(kind).start;
        let weight = |from: usize, to: usize| first(CtrnnParameter::Weight) + from * NEURONS + to;
        let mut last = 0;
        for [sources, targets] in LINKED {
            for (from, to) in sources.flat_map(|from| targets.clone().map(move |to| (from, to))) {
                last = last.max(share(weight(from, to), weight(mirror(from), mirror(to))));
            }
        }
        let weights = last;
        for kind in [CtrnnParameter::Bias, CtrnnParameter::TimeConstant] {
            for neuron in 0..NEURONS {
                let other = if SENSORY.contains(&neuron) { SENSORY.start } else { mirror(neuron) };
                last = share(first(kind) + neuron, first(kind) + other).max(last);
            }
        }
        for neuron in SENSORY {
            last = share(first(CtrnnParameter::Gain) + neuron, first(CtrnnParameter::Gain)).max(last);
        }
        let each = (last - weights - 1) / 2;
        let range = |count, [low, high]: [f64; 2]| GeneRange::new(count, low as f32, high as f32);
        let both = |range: f64| [-range, range];
        let ranges = vec![
            range(weights, both(config.weight_range))?,
            range(each, both(config.bias_range))?,
            range(each, config.time_constants)?,
            range(1, config.gains)?,
        ];
        Ok(Self { parameters, ranges, values: vec![0.0; last] })
    }

    /// Number of genes: 47.
    pub fn genes(&self) -> usize {
        self.values.len()
    }

    /// The parameters that these genes stand for, in the order of [`LAYOUT`]; `None` for another number of genes.
    pub fn decode(&mut self, genes: &[u16]) -> Option<Vec<f32>> {
        decode(genes, &self.ranges, &mut self.values).ok()?;
        Some(
            self.parameters
                .iter()
                .map(|parameter| parameter.map_or_else(|own| own, |gene| self.values[gene]))
                .collect(),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decoded(genes: &[u16]) -> Vec<f32> {
        Wiring::new(&Config::default()).unwrap().decode(genes).unwrap()
    }

    #[test]
    fn there_are_the_sources_47_genes_and_each_has_its_parameters() {
        let mut wiring = Wiring::new(&Config::default()).unwrap();
        assert_eq!(wiring.genes(), 47);
        assert!(wiring.decode(&[0; 46]).is_none());
        let plain = decoded(&[20_000; 47]);
        // How many parameters follow each gene: a pair, the middle alone, or the sensory neurons together.
        let followers: Vec<usize> = (0..47)
            .map(|gene| {
                let mut genes = [20_000; 47];
                genes[gene] = 40_000;
                decoded(&genes).iter().zip(&plain).filter(|(one, other)| one != other).count()
            })
            .collect();
        let mut expected = vec![2; 17];
        expected.extend([1]);
        expected.extend([2; 12]);
        expected.extend([1]);
        expected.extend([2; 5]);
        for _ in 0..2 {
            expected.extend([7, 2, 2, 1, 2]);
        }
        expected.push(7);
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
                let linked = LINKED.iter().any(|[sources, targets]| sources.contains(&from) && targets.contains(&to));
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
            let other = mirror(one);
            assert_eq!(mirror(other), one);
            for values in [parts.biases, parts.gains, parts.time_constants] {
                assert_eq!(values[one], values[other]);
            }
            for to in 0..NEURONS {
                assert_eq!(parts.weights[one * NEURONS + to], parts.weights[other * NEURONS + mirror(to)]);
            }
        }
    }
}
