//! Network layouts of `double-pole`. There is one for each number of inputs and hidden neurons.

use farsa_nn::Activation;
use farsa_nn::block::{Architecture, BlockLayout, BlockPlan};

/// Largest number of hidden neurons supported.
pub const MOST_HIDDEN: u32 = 8;
const PLANS: usize = MOST_HIDDEN as usize + 1;

/// Fully recurrent networks without biases, of 0 to 8 hidden neurons and one output. All neurons are hyperbolic
/// tangents.
const fn plans(inputs: usize) -> [BlockPlan; PLANS] {
    let mut plans = [plan(inputs, 0); PLANS];
    let mut hidden = 1;
    while hidden < PLANS {
        plans[hidden] = plan(inputs, hidden);
        hidden += 1;
    }
    plans
}

const fn plan(inputs: usize, hidden: usize) -> BlockPlan {
    Architecture::fully_recurrent(inputs, hidden, 1)
        .with_activations(Activation::Tanh, Activation::Tanh)
        .without_hidden_biases()
        .without_output_biases()
        .plan()
}

static WITH_VELOCITIES: [BlockPlan; PLANS] = plans(6);
static WITHOUT_VELOCITIES: [BlockPlan; PLANS] = plans(3);

/// Returns the layout of a network with at most 8 hidden neurons. The inputs include the velocities if `velocities` is
/// true.
///
/// Each neuron receives the current inputs and the previous activations of all neurons, including its last activation.
pub fn layout(velocities: bool, hidden: u32) -> BlockLayout<'static> {
    let plans = if velocities { &WITH_VELOCITIES } else { &WITHOUT_VELOCITIES };
    plans[hidden.min(MOST_HIDDEN) as usize].layout()
}

/// Returns the order of the parameters by neuron, and the number of weights of a neuron. This is useful for strategies
/// such as `CoSyNE` that keep the weights of a neuron together. Each element of the order is an index into the parameters
/// of the layout.
pub fn neuron_order(velocities: bool, hidden: u32) -> (Vec<usize>, usize) {
    let layout = layout(velocities, hidden);
    let (inputs, neurons) = (layout.inputs(), layout.neurons() - layout.inputs());
    let of_neuron = |neuron: usize| (0..inputs + neurons).map(move |source| source * neurons + neuron);
    ((0..neurons).flat_map(of_neuron).collect(), inputs + neurons)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_are_those_of_all_neurons_from_inputs_and_all_neurons() {
        for hidden in 0..=MOST_HIDDEN {
            for (velocities, inputs) in [(true, 6), (false, 3)] {
                let layout = layout(velocities, hidden);
                let neurons = hidden as usize + 1;
                assert_eq!(layout.parameter_count(), neurons * (inputs + neurons));
                let (order, of_a_neuron) = neuron_order(velocities, hidden);
                for (place, &parameter) in order.iter().enumerate() {
                    let (neuron, source) = (place / of_a_neuron, place % of_a_neuron);
                    assert!(layout.weights(source, inputs + neuron).eq([parameter]), "{place}");
                }
            }
        }
    }
}
