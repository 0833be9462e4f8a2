//! The single layer against its equation, and through the trait.

use farsa_nn::fault::{LayoutFault, ParameterFault, Slice};
use farsa_nn::{Ablatable, Controller, Error, Lesion, Perceptron, PerceptronLanes};
use farsa_num::Instructions;
use proptest::prelude::*;

proptest! {
    #[test]
    fn equals_its_equation_bit_for_bit(
        (inputs, outputs, parameters, x) in (0..12_usize, 0..40_usize).prop_flat_map(|(n, o)| (
            Just(n),
            Just(o),
            prop::collection::vec(-6.0_f32..6.0, Perceptron::parameter_count(n, o)),
            prop::collection::vec(-50.0_f32..50.0, n),
        )),
        slope in 0.1_f32..2.0,
    ) {
        for instructions in Instructions::available() {
            let mut layer = Perceptron::new(inputs, outputs, slope, &parameters[..])?.with_instructions(instructions);
            let mut y = vec![f32::NAN; outputs];
            layer.step(&x, &mut y);
            for i in 0..outputs {
                let mut net = parameters[inputs * outputs + i];
                for j in 0..inputs {
                    net += parameters[j * outputs + i] * x[j];
                }
                prop_assert_eq!(y[i].to_bits(), farsa_num::logistic(slope * net).to_bits(), "{:?}", instructions);
            }
        }
    }
}

proptest! {
    #[test]
    fn a_lane_has_the_bits_of_the_layer_alone(
        lanes in 1..40_usize, (inputs, outputs) in (0..9_usize, 0..4_usize), seed in any::<u64>(),
    ) {
        let mut stream = farsa_num::Stream::new(seed, farsa_num::Domain::Network, 0, 0, 0);
        let count = Perceptron::parameter_count(inputs, outputs);
        let mut draw = |len: usize| (0..len).map(|_| stream.range(-6.0, 6.0)).collect::<Vec<f32>>();
        let genomes: Vec<Vec<f32>> = (0..lanes).map(|_| draw(count)).collect();
        let x = draw(inputs * lanes);
        for instructions in Instructions::available() {
            let mut together = PerceptronLanes::new(inputs, outputs, 0.7, lanes, vec![0.0; count * lanes])?.with_instructions(instructions);
            for (lane, genome) in genomes.iter().enumerate() {
                together.set_lane(lane, genome)?;
            }
            let mut y = vec![f32::NAN; outputs * lanes];
            together.step(&x, &mut y);
            for (lane, genome) in genomes.iter().enumerate() {
                let own: Vec<f32> = x.iter().skip(lane).step_by(lanes).copied().collect();
                let mut alone = vec![f32::NAN; outputs];
                Perceptron::new(inputs, outputs, 0.7, genome)?.step(&own, &mut alone);
                for (i, y_alone) in alone.iter().enumerate() {
                    prop_assert_eq!(y[i * lanes + lane].to_bits(), y_alone.to_bits(), "{:?}", instructions);
                }
            }
        }
    }
}

#[test]
fn lanes_are_checked_like_the_layer_alone() {
    let build = |slope, parameters: &[f32]| PerceptronLanes::new(6, 2, slope, 2, parameters).err();
    assert_eq!(build(1.0, &[0.0; 28]), None);
    assert_eq!(build(1.0, &[0.0; 14]), Some(Error::Length { slice: Slice::Parameters, expected: 28, found: 14 }));
    assert_eq!(build(f32::INFINITY, &[0.0; 28]), Some(Error::Layout(LayoutFault::Slope(f32::INFINITY))));
    let mut layers = PerceptronLanes::new(1, 1, 1.0, 2, [1.0; 4]).expect("valid");
    assert_eq!(layers.set_lane(0, &[0.0]), Err(Error::Length { slice: Slice::Parameters, expected: 2, found: 1 }));
    assert_eq!(
        layers.set_lane(0, &[0.0, f32::NAN]),
        Err(Error::Parameter { index: 1, fault: ParameterFault::NotFinite })
    );
    assert_eq!(layers.lanes(), 2);
}

#[test]
fn construction_names_the_mistake() {
    let build = |slope, parameters: &[f32]| Perceptron::new(6, 2, slope, parameters).err();
    assert_eq!(build(1.0, &[0.0; 14]), None);
    assert_eq!(build(1.0, &[0.0; 12]), Some(Error::Length { slice: Slice::Parameters, expected: 14, found: 12 }));
    assert_eq!(build(f32::NEG_INFINITY, &[0.0; 14]), Some(Error::Layout(LayoutFault::Slope(f32::NEG_INFINITY))));
    let mut parameters = [0.0; 14];
    parameters[13] = f32::NAN;
    assert_eq!(build(1.0, &parameters), Some(Error::Parameter { index: 13, fault: ParameterFault::NotFinite }));
}

#[test]
fn is_a_controller_behind_a_reference_and_an_object() -> Result<(), Error> {
    fn at_rest(mut controller: impl Controller) -> (usize, usize, f32) {
        let mut y = [f32::NAN];
        controller.reset();
        controller.step(&[0.0, 0.0], &mut y);
        (controller.inputs(), controller.outputs(), y[0])
    }
    let mut layer = Perceptron::new(2, 1, 1.0, [1.0, 1.0, 0.0])?;
    assert_eq!(at_rest(&mut layer), (2, 1, 0.5));
    let object: &mut dyn Controller = &mut layer;
    assert_eq!(at_rest(object), (2, 1, 0.5));
    Ok(())
}

#[test]
#[cfg_attr(debug_assertions, should_panic = "motor values")]
fn wrong_lengths_use_the_shorter() {
    let mut layer = Perceptron::new(2, 2, 1.0, [1.0, 2.0, 3.0, 4.0, 0.0, 0.0]).expect("valid");
    let (mut whole, mut long, mut short) = ([0.0; 2], [-1.0; 3], [0.0; 1]);
    layer.step(&[1.0, 0.0], &mut whole);
    layer.step(&[1.0, 0.0], &mut long);
    assert_eq!(long, [whole[0], whole[1], -1.0]);
    layer.step(&[1.0], &mut short);
    assert_eq!(short[0], whole[0]);
}

#[test]
fn outputs_are_held() {
    let mut layer = Perceptron::new(1, 3, 1.0, [1.0, 2.0, 3.0, 0.1, 0.2, 0.3]).unwrap();
    assert_eq!(layer.neurons(), 3);
    let (mut y, mut whole) = ([f32::NAN; 3], [f32::NAN; 3]);
    layer.step(&[0.5], &mut whole);
    layer.step_ablated(&[Lesion::new(2), Lesion { neuron: 0, activation: 0.25 }, Lesion::new(3)], &[0.5], &mut y);
    assert_eq!(y, [0.25, whole[1], 0.0]);
    layer.step_ablated(&[], &[0.5], &mut y);
    assert_eq!(y, whole);
}
