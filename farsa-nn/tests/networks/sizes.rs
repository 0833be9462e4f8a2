//! Numbers of values and neurons of all kinds of networks, and the texts of errors.

use farsa_nn::block::{Architecture, BlockLayout, BlockNetwork, BlockPlan};
use farsa_nn::fault::{LayoutFault, ParameterFault, Slice};
use farsa_nn::quantized::{QuantizedNetwork, QuantizedScale};
use farsa_nn::{
    Ablatable, Controller, Ctrnn, CtrnnLayout, Error, Leak, LeakyLayout, LeakyNetwork, Lesion, Lesioned, Perceptron,
};

const PLAN: BlockPlan = Architecture::elman(2, 4, 3).plan();
const LAYOUT: BlockLayout = PLAN.layout();

/// The numbers of inputs and outputs, also through a reference.
fn sizes(mut network: impl Controller) -> [usize; 2] {
    let sizes = [network.inputs(), network.outputs()];
    let by_reference: &mut dyn Controller = &mut network;
    assert_eq!([by_reference.inputs(), by_reference.outputs()], sizes);
    sizes
}

#[test]
fn networks_say_how_large_they_are() {
    let perceptron = Perceptron::new(5, 3, 1.0, [0.5; 18]).unwrap();
    assert_eq!((sizes(&mut perceptron.clone()), perceptron.neurons()), ([5, 3], 3));

    let layout = LeakyLayout::new(5, 4, 3);
    let leaky =
        LeakyNetwork::new(layout, Leak::Filter, vec![0.5; layout.parameter_count()], vec![0.0; layout.state_len()]);
    let leaky = leaky.unwrap();
    assert_eq!((sizes(leaky.clone()), leaky.neurons()), ([5, 3], 7));
    assert_eq!(sizes(Lesioned::new(leaky, &[])), [5, 3]);

    let scale = QuantizedScale::new(9, 9, 10).unwrap();
    let state = vec![0; layout.state_len()];
    let fixed =
        QuantizedNetwork::new(layout, Leak::Filter, scale, vec![1_i16; layout.parameter_count()], state).unwrap();
    assert_eq!(sizes(fixed), [5, 3]);

    let layout = CtrnnLayout::new(2, 6, 3);
    let ctrnn = Ctrnn::new(layout, 0.1, vec![1.0; layout.parameter_count()], vec![0.0; layout.state_len()]).unwrap();
    assert_eq!((sizes(ctrnn.clone()), ctrnn.neurons()), ([2, 3], 6));

    let parameters = vec![0.5; LAYOUT.parameter_count()];
    let blocks = BlockNetwork::new(LAYOUT, Leak::Filter, parameters, vec![0.0; LAYOUT.state_len()]).unwrap();
    assert_eq!((sizes(blocks.clone()), blocks.neurons()), ([2, 3], LAYOUT.neurons()));
}

/// The last neuron can be held, and its lesion changes an output. A lesion after it changes nothing.
#[test]
fn neurons_are_counted_to_the_last() {
    fn held<N: Ablatable>(mut network: N, x: &[f32]) {
        let (neurons, outputs) = (network.neurons(), network.outputs());
        let mut run = |neuron: usize| {
            let mut y = vec![0.0; outputs];
            network.reset();
            (0..3).for_each(|_| network.step_ablated(&[Lesion { neuron, activation: 0.125 }], x, &mut y));
            y
        };
        let whole = run(usize::MAX);
        assert!((0..neurons).all(|neuron| run(neuron) != whole));
        assert_eq!(run(neurons), whole);
    }
    held(Perceptron::new(2, 3, 1.0, [0.5; 9]).unwrap(), &[0.7, 0.2]);
    let layout = LeakyLayout::new(2, 4, 3);
    let (parameters, state) = (vec![0.5; layout.parameter_count()], vec![0.0; layout.state_len()]);
    held(LeakyNetwork::new(layout, Leak::Filter, parameters, state).unwrap(), &[0.7, 0.2]);
    let layout = CtrnnLayout::new(2, 6, 3);
    let (parameters, state) = (vec![0.5; layout.parameter_count()], vec![0.0; layout.state_len()]);
    held(Ctrnn::new(layout, 0.1, parameters, state).unwrap(), &[0.7, 0.2]);
}

#[test]
fn errors_say_what_is_wrong() {
    let cases = [
        (Error::Length { slice: Slice::Parameters, expected: 7, found: 5 }, "5 parameters where the layout has 7"),
        (Error::Length { slice: Slice::State, expected: 7, found: 5 }, "a state of 5 values where the layout needs 7"),
        (Error::Parameter { index: 3, fault: ParameterFault::NotFinite }, "parameter 3 is not finite"),
        (
            Error::Parameter { index: 3, fault: ParameterFault::Leak(1.5) },
            "parameter 3, a leak, is 1.5: outside [0, 1]; give leaks another gene range than weights",
        ),
        (Error::Layout(LayoutFault::Slope(f32::NAN)), "the slope of the logistic function is NaN: not finite"),
        (
            Error::Demonstration { values: 7, sensors: 3, wanted: 4, outputs: 2 },
            "7 sensor values and 4 wanted motor values: not whole ticks of 3 and 2",
        ),
        (
            Error::Layout(LayoutFault::FractionBits { of: "sums", found: 9, least: 10, most: 20 }),
            "9 fraction bits of sums: outside [10, 20]",
        ),
        (
            Error::Parameter { index: 2, fault: ParameterFault::Weight(4e4) },
            "parameter 2 times the slope is 40000: outside [-32767, 32767]",
        ),
        (Error::Sum { target: 4, largest: 9, limit: 8 }, "the sum of target 4 can reach 9 where 8 is the most"),
        (Error::Name { of: "leak", names: "filter, two-tap, evonet" }, "unknown leak: one of filter, two-tap, evonet"),
        (Error::Layout(LayoutFault::TimeStep(0.0)), "the time step is 0: not a finite number above 0"),
        (
            Error::Parameter { index: 10, fault: ParameterFault::TimeConstant { value: 0.02, least: 0.05 } },
            "parameter 10, a time constant, is 0.02: below 0.05, where the integrator diverges at this time step",
        ),
        (
            Error::Parameter { index: 10, fault: ParameterFault::TimeConstant { value: 0.0, least: 0.05 } },
            "parameter 10, a time constant, is 0: not above 0",
        ),
        (
            Error::Parameter { index: 10, fault: ParameterFault::TimeConstant { value: -1.0, least: 0.05 } },
            "parameter 10, a time constant, is -1: not above 0",
        ),
        (
            Error::Layout(LayoutFault::Neurons { first: 4, count: 3, neurons: 6 }),
            "3 neurons from neuron 4 on where the layout has 6",
        ),
        (
            Error::Layout(LayoutFault::Block { index: 1, first: 4, count: 3, neurons: 6 }),
            "block 1 has 3 neurons from neuron 4 on where the layout has 6 neurons",
        ),
        (Error::State { index: 3 }, "the state of neuron 3 is not finite"),
        (Error::Parameter { index: 3, fault: ParameterFault::NoValue }, "parameter 3 has no value: evolution draws it"),
        (Error::Length { slice: Slice::MirrorImages, expected: 4, found: 2 }, "2 mirror images where there are 4"),
        (
            Error::Layout(LayoutFault::Mirror { index: 1, image: 5 }),
            "the mirror image of 1 is 5, which is not there or has another mirror image",
        ),
        (
            Error::Layout(LayoutFault::Alike { first: 2, count: 3 }),
            "3 alike neurons from neuron 2 on: some are alike with others, or their mirror images are not alike",
        ),
        (Error::Text { line: 4, expected: "a number" }, "line 4: expected a number"),
        (
            Error::Name { of: "integrator", names: "euler, exponential-euler, runge-kutta-4" },
            "unknown integrator: one of euler, exponential-euler, runge-kutta-4",
        ),
        (
            Error::Name { of: "activation", names: "logistic, tanh, linear, step, rectified" },
            "unknown activation: one of logistic, tanh, linear, step, rectified",
        ),
    ];
    for (error, text) in cases {
        assert_eq!(error.to_string(), text);
    }
}
