//! The continuous-time network of `compositional-instructions`, with sensory, inner and motor neurons.

use core::f64::consts::LN_10;

use farsa_lab::{Error, Parameter};
use farsa_nn::block::Span;
use farsa_nn::{CtrnnLayout, CtrnnParameter, CtrnnSymmetry, Integrator};
use farsa_num::exp;

use crate::compositional_instructions::config::Ranges;

/// Number of sensory neurons. There are 9 for the camera, 3 for touch, 2 for the joints, and 3 for each of the two
/// words.
pub const INPUTS: usize = 20;
/// Number of inner neurons.
pub const INNER: usize = 6;
/// Number of motor neurons. Each joint is driven by two of them.
pub const MOTORS: usize = 4;
/// Total number of neurons. Sensory neurons come first, followed by inner and motor neurons.
pub const NEURONS: usize = INPUTS + INNER + MOTORS;

/// Layout of the network. Each input is connected to one sensory neuron.
pub const LAYOUT: CtrnnLayout =
    CtrnnLayout::new(INPUTS, NEURONS, MOTORS).with_direct_inputs(0).with_integrator(Integrator::ExponentialEuler);

/// Kinds of sensory neurons. All neurons of a kind share a gain and a bias.
pub const KINDS: [(&str, Span); 5] = [
    ("camera", Span::new(0, 9)),
    ("touch", Span::new(9, 3)),
    ("joints", Span::new(12, 2)),
    ("action", Span::new(14, 3)),
    ("object", Span::new(17, 3)),
];
pub(crate) const SENSORY: Span = Span::new(0, INPUTS);
pub(crate) const INNER_ONES: Span = Span::new(INPUTS, INNER);
pub(crate) const MOTOR_ONES: Span = Span::new(INPUTS + INNER, MOTORS);
/// The layers that are linked, each neuron of the one to each of the other.
pub(crate) const LINKED: [(Span, Span); 3] =
    [(SENSORY, INNER_ONES), (INNER_ONES, INNER_ONES), (INNER_ONES, MOTOR_ONES)];
const ALIKE: [Span; 5] = [KINDS[0].1, KINDS[1].1, KINDS[2].1, KINDS[3].1, KINDS[4].1];
/// No neuron has a mirror image but itself.
const ITSELF: [usize; NEURONS] = {
    let mut images = [0; NEURONS];
    let mut neuron = 0;
    while neuron < NEURONS {
        images[neuron] = neuron;
        neuron += 1;
    }
    images
};

/// The number of the first gene where genes are numbered to find their places.
const FIRST: usize = 1000;

/// The time constant of the sensory neurons, in parts of a step: so small that they are what their input is.
const RELAY: f64 = 0.05;

/// Defines which parameters of the network are encoded as genes.
///
/// The genes start with the 180 weights, ordered by neuron, and 15 biases. They are followed by 5 gains of
/// the sensory neurons, one for each kind, and 10 time constants of the inner and motor neurons. Time constants are
/// encoded as decimal logarithms. Note that a sensory neuron computes sigma(gain input + bias). Since the network
/// multiplies the bias by the gain, it stores bias / gain instead.
#[derive(Clone, Debug)]
pub struct Wiring {
    /// Which number each of the network's parameters is made of, or what it always is.
    origins: Vec<Origin>,
    kinds: Vec<CtrnnParameter>,
    parameters: Vec<Parameter>,
    relay: f32,
}

#[derive(Clone, Copy, Debug)]
enum Origin {
    Gene(u16),
    Constant(f32),
}

impl Wiring {
    /// Creates the wiring for a network with the given time step in seconds. Genes are decoded to the given ranges.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if a range is empty.
    pub fn new(ranges: &Ranges, time_step: f64) -> Result<Self, Error> {
        let wrong = |error: farsa_nn::Error| Error::Other(format!("compositional-instructions: {error}"));
        let symmetry = CtrnnSymmetry::new(LAYOUT, &[], &ITSELF)
            .and_then(|symmetry| symmetry.with_links(&LINKED))
            .and_then(|symmetry| symmetry.with_alike(&ALIKE))
            .and_then(|symmetry| symmetry.with_gains(&ALIKE))
            .map_err(wrong)?;
        let kinds: Vec<CtrnnParameter> = symmetry.kinds().collect();
        // Genes with numbers beyond all constants show the place of each gene.
        let numbered: Vec<f32> = (0..kinds.len()).map(|gene| (FIRST + gene) as f32).collect();
        let mut places = vec![0.0; LAYOUT.parameter_count()];
        symmetry.expand(&numbered, &mut places).map_err(wrong)?;
        let origin = |place: f32| match (place as usize).checked_sub(FIRST) {
            Some(gene) => Origin::Gene(gene as u16),
            // Constants of the layout are smaller than every number of a gene.
            None => Origin::Constant(place),
        };
        let origins = places.into_iter().map(origin).collect();
        let mut parameters = Vec::new();
        // The time constants of the sensory neurons come first and are no genes.
        let mut relays = ALIKE.len();
        for (number, kind) in kinds.iter().enumerate() {
            let (name, ends) = match kind {
                CtrnnParameter::Bias => ("bias", [-ranges.bias, ranges.bias]),
                CtrnnParameter::Gain => ("gain", ranges.gains),
                CtrnnParameter::TimeConstant if relays > 0 => {
                    relays -= 1;
                    continue;
                }
                CtrnnParameter::TimeConstant => ("exponent of the time constant", ranges.time_constant_exponents),
                _ => ("weight", [-ranges.weight, ranges.weight]),
            };
            let ends = ends.map(|end| f64::from(end as f32));
            if !(ends[0].is_finite() && ends[1].is_finite() && ends[0] <= ends[1]) {
                let [low, high] = ends;
                return Err(Error::Other(format!("compositional-instructions: {name} from {low} to {high}: no range")));
            }
            parameters.push(Parameter::new(format!("{name} {}", number + 1), ends));
        }
        Ok(Self { origins, kinds, parameters, relay: (RELAY * time_step) as f32 })
    }

    /// Gets the encoded parameters and their ranges.
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// Computes the parameters of the network, in the order of [`LAYOUT`], from the decoded values. Returns `false` if
    /// the number of values is wrong.
    pub fn expand(&self, values: &[f32], genes: &mut Vec<f32>, parameters: &mut [f32]) -> bool {
        if values.len() != self.parameters.len() || parameters.len() != self.origins.len() {
            return false;
        }
        genes.clear();
        let mut values = values.iter();
        let mut relays = ALIKE.len();
        let mut first_gain = 0;
        for (number, kind) in self.kinds.iter().enumerate() {
            let gene = if *kind == CtrnnParameter::TimeConstant && relays > 0 {
                relays -= 1;
                self.relay
            } else {
                let Some(value) = values.next() else { return false };
                // tau = 10^gene, so that the search covers each power of ten alike.
                if *kind == CtrnnParameter::TimeConstant { exp(LN_10 * f64::from(*value)) as f32 } else { *value }
            };
            if *kind == CtrnnParameter::Gain && first_gain == 0 {
                first_gain = number;
            }
            genes.push(gene);
        }
        // Biases of the five kinds of sensory neurons lie before those of inner and motor neurons, and gains after them all.
        let first_bias = first_gain - (ALIKE.len() + INNER + MOTORS);
        for kind in 0..ALIKE.len() {
            // Neurons add the bias before the gain, g (y + b). The gene is the product g b, so b = gene / g.
            genes[first_bias + kind] /= genes[first_gain + kind];
        }
        for (parameter, origin) in parameters.iter_mut().zip(&self.origins) {
            *parameter = match origin {
                Origin::Gene(gene) => genes[usize::from(*gene)],
                Origin::Constant(value) => *value,
            };
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compositional_instructions::config::Config;
    use crate::compositional_instructions::instruction::Condition;
    use farsa_nn::{Controller as _, Ctrnn};
    use farsa_num::logistic;

    fn wiring() -> Wiring {
        Wiring::new(&Config::for_condition(Condition::WithIndicate).ranges, 0.1).unwrap()
    }

    fn expanded(wiring: &Wiring, values: &[f32]) -> Vec<f32> {
        let mut parameters = vec![0.0; LAYOUT.parameter_count()];
        assert!(wiring.expand(values, &mut Vec::new(), &mut parameters));
        parameters
    }

    #[test]
    fn there_are_210_numbers_and_each_is_where_it_belongs() {
        let wiring = wiring();
        assert_eq!(wiring.parameters().len(), 180 + 15 + 5 + 10);
        let middle: Vec<f32> = wiring.parameters().iter().map(|p| f64::midpoint(p.ends[0], p.ends[1]) as f32).collect();
        let parameters = expanded(&wiring, &middle);
        let parts = LAYOUT.split(&parameters);
        assert!(parts.gains[..INPUTS].iter().all(|gain| *gain == 7.0));
        assert!(parts.gains[INPUTS..].iter().all(|gain| *gain == 1.0));
        assert!(parts.time_constants[..INPUTS].iter().all(|tau| *tau == 0.005));
        assert!(parts.time_constants[INPUTS..].iter().all(|tau| (tau - 0.446_683_6).abs() < 1e-6));
        // The number of parameters of each gene.
        let followers: Vec<usize> = (0..middle.len())
            .map(|i| {
                let mut values = middle.clone();
                values[i] = wiring.parameters()[i].ends[1] as f32;
                expanded(&wiring, &values).iter().zip(&parameters).filter(|(a, b)| a != b).count()
            })
            .collect();
        assert!(followers[..180].iter().all(|count| *count == 1));
        assert_eq!(followers[180..185], [9, 3, 2, 3, 3]);
        assert!(followers[185..195].iter().all(|count| *count == 1));
        assert_eq!(followers[195..200], [9, 3, 2, 3, 3]);
        assert!(followers[200..].iter().all(|count| *count == 1));
        assert!(!wiring.expand(&middle[1..], &mut Vec::new(), &mut parameters.clone()));
    }

    /// The equation of the sources, written out in double precision: relays, inner and motor neurons.
    #[test]
    fn it_steps_as_the_equation_does() {
        let wiring = wiring();
        let values: Vec<f32> = wiring
            .parameters()
            .iter()
            .enumerate()
            .map(|(i, p)| (p.ends[0] + (p.ends[1] - p.ends[0]) * ((i * 37 % 101) as f64 / 100.0)) as f32)
            .collect();
        let parameters = expanded(&wiring, &values);
        let mut network = Ctrnn::new(LAYOUT, 0.1, parameters, vec![0.0; LAYOUT.state_len()]).unwrap();
        let at = |i: usize| f64::from(values[i]);
        let kind_of = |input: usize| KINDS.iter().position(|(_, span)| span.contains(input)).unwrap();
        let (mut y, mut relay_input) = ([0.0_f64; INNER + MOTORS], [0.0_f64; INPUTS]);
        let mut out = [0.0_f32; MOTORS];
        for step in 0..60 {
            let x: [f32; INPUTS] = core::array::from_fn(|i| ((step * 7 + i * 13) % 5) as f32 / 4.0);
            network.step(&x, &mut out);
            // Relays put out, from the step after on, sigma(gain input + bias).
            let relayed: Vec<f64> =
                (0..INPUTS).map(|i| logistic(at(195 + kind_of(i)) * relay_input[i] + at(180 + kind_of(i)))).collect();
            let o: Vec<f64> = (0..INNER + MOTORS).map(|i| logistic(y[i] + at(185 + i))).collect();
            let mut next = y;
            for (to, next) in next.iter_mut().enumerate() {
                let mut net = 0.0;
                if to < INNER {
                    net += (0..INPUTS).map(|from| at(from * INNER + to) * relayed[from]).sum::<f64>();
                }
                // The weights of an inner neuron to inner and to motor neurons are adjacent.
                net += (0..INNER).map(|from| at(120 + from * (INNER + MOTORS) + to) * o[from]).sum::<f64>();
                let tau = exp(LN_10 * at(200 + to));
                *next = net + (y[to] - net) * exp(-0.1 / tau);
            }
            y = next;
            relay_input = x.map(f64::from);
            for (motor, out) in out.iter().enumerate() {
                let expected = logistic(y[INNER + motor] + at(185 + INNER + motor));
                assert!((f64::from(*out) - expected).abs() < 2e-4, "step {step}: {out} where {expected} is due");
            }
        }
    }
}
