//! Continuous-time networks.

use farsa_nn::bytes::{Aligned, BytesError, CtrnnBytes, Field, Table};
use farsa_nn::fault::{LayoutFault, ParameterFault};
use farsa_nn::{Activation, Controller, Ctrnn, CtrnnLayout, CtrnnParameter, Error, Integrator};
use farsa_num::{Domain, Stream, crc32};
use proptest::prelude::*;

use crate::{HEAD, after_a_head, all_damage_is_refused, at_every_place, placed_or, placement, with_hash};

const LAYOUT: CtrnnLayout = CtrnnLayout::new(3, 5, 2).with_direct_inputs(1).with_integrator(Integrator::RungeKutta4);
const TIME_STEP: f32 = 0.1;
const COUNT: usize = LAYOUT.parameter_count();
const LEN: usize = CtrnnBytes::byte_count(LAYOUT);

fn parameters(layout: CtrnnLayout, seed: u64) -> Vec<f32> {
    let mut stream = Stream::new(seed, Domain::InitialGenome, 0, 0, 0);
    let value = |kind| match kind {
        CtrnnParameter::TimeConstant => stream.range(0.5, 5.0),
        _ => stream.range(-6.0, 6.0),
    };
    layout.kinds().map(value).collect()
}

pub(crate) fn agent() -> Aligned<[u8; LEN]> {
    let mut bytes = Aligned([0; LEN]);
    CtrnnBytes::write(LAYOUT, TIME_STEP, 7, &parameters(LAYOUT, 1), &mut bytes.0).expect("valid");
    bytes
}

fn with(place: usize, new: &[u8]) -> Vec<u8> {
    crate::with(&agent().0, place, new)
}

fn refused(bytes: &[u8]) -> BytesError {
    CtrnnBytes::read(bytes).expect_err("not a continuous-time network")
}

#[test]
fn the_format_is_that_of_the_document() {
    let bytes = agent().0;
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().expect("4"));
    assert_eq!((COUNT, LEN, &bytes[..8]), (40, HEAD + 4 * 40 + 4, &b"FARSA-NN"[..]));
    assert_eq!([8, 12, 16, 20].map(word), [1, 3, 236, 160]);
    assert_eq!(core::array::from_fn::<_, 8, _>(|i| word(24 + 4 * i)), [3, 5, 2, 2, 3, 2, 0, 0.1_f32.to_bits()]);
    assert_eq!(bytes[56..64], CtrnnBytes::layout_hash(LAYOUT, TIME_STEP).to_le_bytes());
    assert_eq!(bytes[64..72], 7_u64.to_le_bytes());
    assert_eq!(bytes[72..76], parameters(LAYOUT, 1)[0].to_le_bytes());
    assert_eq!(word(LEN - 4), crc32(&bytes[..LEN - 4]));
}

/// The numbers of integrators and activations are those of the document, for any order of their declaration.
#[test]
fn methods_and_functions_have_the_numbers_of_the_document() {
    let one = |layout: CtrnnLayout| {
        let mut bytes = vec![0; CtrnnBytes::byte_count(layout)];
        CtrnnBytes::write(layout, 0.1, 0, &[1.0; 4], &mut bytes).expect("valid");
        [36, 44, 48].map(|at| bytes[at])
    };
    let layout = CtrnnLayout::new(0, 1, 1);
    assert_eq!(one(layout), [0; 3]);
    assert_eq!(one(layout.with_direct_inputs(0)), [1, 0, 0]);
    assert_eq!(one(layout.with_integrator(Integrator::ExponentialEuler)), [0, 1, 0]);
    assert_eq!(one(layout.with_integrator(Integrator::RungeKutta4)), [0, 2, 0]);
    assert_eq!(one(layout.with_activation(Activation::Tanh)), [0, 0, 1]);
    assert_eq!(one(layout.with_activation(Activation::Linear)), [0, 0, 2]);
    assert_eq!(one(layout.with_activation(Activation::Step)), [0, 0, 3]);
    assert_eq!(one(layout.with_activation(Activation::Rectified)), [0, 0, 4]);
}

#[test]
fn a_network_over_bytes_is_the_network() {
    let bytes = agent();
    let read = CtrnnBytes::read(&bytes.0).expect("a network");
    assert_eq!((read.layout(), read.time_step(), read.channels()), (LAYOUT, TIME_STEP, 7));
    read.expect(LAYOUT, TIME_STEP).expect("the layout");
    let mut copy = [0.0; COUNT];
    read.copy_parameters(&mut copy).expect("the length");
    let placed = placed_or(read.parameters(), &bytes.0, &copy);
    assert_eq!(placed, parameters(LAYOUT, 1));

    let state = || [0.0; LAYOUT.state_len()];
    let mut own = Ctrnn::new(LAYOUT, TIME_STEP, parameters(LAYOUT, 1), state()).expect("valid");
    let mut over = Ctrnn::new(read.layout(), read.time_step(), placed, state()).expect("valid");
    let mut inputs = Stream::new(1, Domain::Network, 0, 0, 0);
    let (mut x, mut y, mut z) = ([0.0; 3], [0.0; 2], [0.0; 2]);
    for _ in 0..100 {
        x.fill_with(|| inputs.range(-10.0, 10.0));
        own.step(&x, &mut y);
        over.step(&x, &mut z);
        assert_eq!((y.map(f32::to_bits), own.states()), (z.map(f32::to_bits), over.states()));
    }
}

#[test]
fn every_flipped_bit_and_every_truncation_is_refused() {
    all_damage_is_refused(&agent().0, refused);
}

#[test]
fn foreign_bytes_are_refused_by_what_is_wrong_with_them() {
    assert_eq!(refused(&with(8, &[2])), BytesError::Mismatch { field: Field::Version, expected: 1, found: 2 });
    assert!(matches!(refused(&with(24, &[4])), BytesError::Mismatch { field: Field::LayoutHash, .. }));
    let hashed = |at: usize, word: u32| refused(&with_hash(&agent().0, at, word));
    let neurons =
        |first, count| BytesError::Parameters(Error::Layout(LayoutFault::Neurons { first, count, neurons: 5 }));
    assert_eq!(hashed(24, 5), neurons(1, 5));
    assert_eq!(hashed(28, 6), BytesError::Length { expected: LEN + 4 * (11 + 3), found: LEN });
    assert!(matches!(hashed(28, u32::MAX), BytesError::Length { found: LEN, .. }));
    assert_eq!(hashed(36, u32::MAX), neurons(u32::MAX as usize - 1, 3));
    // Weighted inputs: there would be weights.
    assert_eq!(hashed(36, 0), BytesError::Length { expected: LEN + 4 * 15, found: LEN });
    assert_eq!(hashed(40, 4), neurons(4, 2));
    assert_eq!(hashed(44, 3), BytesError::Word { table: Table::Shape, word: 5, found: 3 });
    assert_eq!(hashed(48, 5), BytesError::Word { table: Table::Shape, word: 6, found: 5 });
    let step = |value: f32| BytesError::Parameters(Error::Layout(LayoutFault::TimeStep(value)));
    assert_eq!(hashed(52, 0.0_f32.to_bits()), step(0.0));
    assert_eq!(hashed(52, f32::INFINITY.to_bits()), step(f32::INFINITY));
    // Longer than the integrator bears with these time constants.
    assert!(matches!(
        hashed(52, 50_f32.to_bits()),
        BytesError::Parameters(Error::Parameter { index: 35, fault: ParameterFault::TimeConstant { .. } })
    ));
    let at = |index: usize, value: f32| refused(&with(HEAD + 4 * index, &value.to_le_bytes()));
    assert_eq!(
        at(5, f32::INFINITY),
        BytesError::Parameters(Error::Parameter { index: 5, fault: ParameterFault::NotFinite })
    );
    let least = Integrator::RungeKutta4.least_time_constant(TIME_STEP);
    assert_eq!(
        at(39, 0.01),
        BytesError::Parameters(Error::Parameter {
            index: 39,
            fault: ParameterFault::TimeConstant { value: 0.01, least }
        })
    );
}

#[test]
fn another_controller_is_told_apart() {
    let bytes = agent();
    let read = CtrnnBytes::read(&bytes.0).expect("a network");
    for (layout, time_step) in [
        (LAYOUT, 0.2),
        (LAYOUT.with_integrator(Integrator::Euler), TIME_STEP),
        (LAYOUT.with_activation(Activation::Tanh), TIME_STEP),
        (LAYOUT.with_direct_inputs(0), TIME_STEP),
        (LAYOUT.with_outputs_from(0), TIME_STEP),
        (CtrnnLayout::new(3, 5, 2).with_integrator(Integrator::RungeKutta4), TIME_STEP),
    ] {
        assert!(
            matches!(read.expect(layout, time_step), Err(BytesError::Mismatch { field: Field::Layout, .. })),
            "{layout:?}"
        );
    }
    assert_eq!(read.expect_channels(7), Ok(()));
    assert_eq!(read.expect_channels(8), Err(BytesError::Mismatch { field: Field::Channels, expected: 8, found: 7 }));
}

#[test]
fn where_bytes_lie_is_checked_and_parameters_are_copied_from_anywhere() {
    at_every_place::<{ LEN + 8 }>(&agent().0, |offset, bytes| {
        let read = CtrnnBytes::read(bytes).expect("a network");
        let placed = read.parameters().map(|placed| assert_eq!(placed, parameters(LAYOUT, 1)));
        assert_eq!(placed, placement(offset, 4));
        let mut copy = [0.0; COUNT];
        read.copy_parameters(&mut copy).expect("the length");
        assert_eq!(copy[..], parameters(LAYOUT, 1));
        assert_eq!(read.copy_parameters(&mut copy[1..]), Err(BytesError::Buffer { expected: 40, found: 39 }));
    });
}

#[test]
fn nothing_is_written_that_would_not_be_read() {
    let (mut out, mut wrong) = ([3; LEN], parameters(LAYOUT, 1));
    let short = CtrnnBytes::write(LAYOUT, TIME_STEP, 0, &wrong, &mut out[1..]);
    assert_eq!(short, Err(BytesError::Buffer { expected: LEN, found: LEN - 1 }));
    let mut write = |layout, time_step, parameters: &[f32]| {
        let error = CtrnnBytes::write(layout, time_step, 0, parameters, &mut out).expect_err("not a network");
        assert_eq!(out, [3; LEN]);
        error
    };
    let error = write(LAYOUT, -1.0, &wrong);
    assert_eq!(error, BytesError::Parameters(Error::Layout(LayoutFault::TimeStep(-1.0))));
    let error = write(LAYOUT.with_outputs_from(usize::MAX), TIME_STEP, &wrong);
    assert!(matches!(error, BytesError::Parameters(Error::Layout(LayoutFault::Neurons { first: usize::MAX, .. }))));
    wrong[2] = f32::NAN;
    assert_eq!(
        write(LAYOUT, TIME_STEP, &wrong),
        BytesError::Parameters(Error::Parameter { index: 2, fault: ParameterFault::NotFinite })
    );
}

proptest! {
    #[test]
    fn what_is_written_is_read(inputs in 0_usize..5, neurons in 5_usize..9, outputs in 0_usize..5, direct: bool,
                               integrator in 0_usize..3, activation in 0_usize..5, first in 0_usize..2, channels: u64,
                               seed: u64) {
        let mut layout = CtrnnLayout::new(inputs, neurons, outputs)
            .with_integrator(Integrator::ALL[integrator])
            .with_activation(Activation::ALL[activation])
            .with_outputs_from(first);
        if direct {
            layout = layout.with_direct_inputs(first);
        }
        let parameters = parameters(layout, seed);
        let mut bytes = vec![0; CtrnnBytes::byte_count(layout)];
        CtrnnBytes::write(layout, TIME_STEP, channels, &parameters, &mut bytes).expect("valid");
        let read = CtrnnBytes::read(&bytes).expect("a network");
        let mut copy = vec![0.0; layout.parameter_count()];
        read.copy_parameters(&mut copy).expect("the length");
        let found = (read.layout(), read.time_step(), read.channels(), copy);
        prop_assert_eq!(found, (layout, TIME_STEP, channels, parameters));
    }

    #[test]
    fn no_bytes_whatever_are_a_panic(bytes: Vec<u8>, seal: bool) {
        let _ = CtrnnBytes::read(&bytes);
        prop_assert!(CtrnnBytes::read(&after_a_head(&agent().0, &bytes, seal)).is_err());
    }
}
