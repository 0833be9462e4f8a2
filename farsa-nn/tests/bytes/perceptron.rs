//! The layer of logistic units.

use farsa_nn::bytes::{Aligned, BytesError, Field, PerceptronBytes, Table};
use farsa_nn::fault::{LayoutFault, ParameterFault, Slice};
use farsa_nn::{Controller, Error, Perceptron};
use farsa_num::{Domain, Stream, crc32};
use proptest::prelude::*;

use crate::{HEAD, after_a_head, all_damage_is_refused, at_every_place, placed_or, placement, with_hash};

const COUNT: usize = Perceptron::parameter_count(6, 2);
const LEN: usize = PerceptronBytes::byte_count(6, 2);

fn parameters(count: usize, seed: u64) -> Vec<f32> {
    let mut stream = Stream::new(seed, Domain::InitialGenome, 0, 0, 0);
    (0..count).map(|_| stream.range(-6.0, 6.0)).collect()
}

pub(crate) fn reflex() -> Aligned<[u8; LEN]> {
    let mut bytes = Aligned([0; LEN]);
    PerceptronBytes::write(6, 2, 1.5, 7, &parameters(COUNT, 1), &mut bytes.0).expect("valid");
    bytes
}

fn with(place: usize, new: &[u8]) -> Vec<u8> {
    crate::with(&reflex().0, place, new)
}

fn refused(bytes: &[u8]) -> BytesError {
    PerceptronBytes::read(bytes).expect_err("not a layer")
}

#[test]
fn the_format_is_that_of_the_document() {
    let bytes = reflex().0;
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().expect("4"));
    assert_eq!((COUNT, LEN, &bytes[..8]), (14, HEAD + 4 * 14 + 4, &b"FARSA-NN"[..]));
    assert_eq!([8, 12, 16, 20].map(word), [1, 4, 132, 56]);
    assert_eq!(core::array::from_fn::<_, 8, _>(|i| word(24 + 4 * i)), [6, 2, 1.5_f32.to_bits(), 0, 0, 0, 0, 0]);
    assert_eq!(bytes[56..64], PerceptronBytes::layout_hash(6, 2, 1.5).to_le_bytes());
    assert_eq!(bytes[64..72], 7_u64.to_le_bytes());
    assert_eq!(bytes[72..76], parameters(COUNT, 1)[0].to_le_bytes());
    assert_eq!(word(LEN - 4), crc32(&bytes[..LEN - 4]));
}

#[test]
fn a_layer_over_bytes_is_the_layer() {
    let bytes = reflex();
    let read = PerceptronBytes::read(&bytes.0).expect("a layer");
    assert_eq!((read.inputs(), read.outputs(), read.slope(), read.channels()), (6, 2, 1.5, 7));
    read.expect(6, 2, 1.5).expect("the shape");
    let mut copy = [0.0; COUNT];
    read.copy_parameters(&mut copy).expect("the length");
    let placed = placed_or(read.parameters(), &bytes.0, &copy);
    assert_eq!(placed, parameters(COUNT, 1));
    let mut own = Perceptron::new(6, 2, 1.5, parameters(COUNT, 1)).expect("valid");
    let mut over = Perceptron::new(read.inputs(), read.outputs(), read.slope(), placed).expect("valid");
    let mut inputs = Stream::new(1, Domain::Network, 0, 0, 0);
    let (mut x, mut y, mut z) = ([0.0; 6], [0.0; 2], [0.0; 2]);
    for _ in 0..100 {
        x.fill_with(|| inputs.range(-10.0, 10.0));
        own.step(&x, &mut y);
        over.step(&x, &mut z);
        assert_eq!(y.map(f32::to_bits), z.map(f32::to_bits));
    }
}

#[test]
fn every_flipped_bit_and_every_truncation_is_refused() {
    all_damage_is_refused(&reflex().0, refused);
}

#[test]
fn foreign_bytes_are_refused_by_what_is_wrong_with_them() {
    assert_eq!(refused(&with(8, &[2])), BytesError::Mismatch { field: Field::Version, expected: 1, found: 2 });
    assert!(matches!(refused(&with(24, &[4])), BytesError::Mismatch { field: Field::LayoutHash, .. }));
    let hashed = |at: usize, word: u32| refused(&with_hash(&reflex().0, at, word));
    assert_eq!(hashed(24, 5), BytesError::Length { expected: LEN - 8, found: LEN });
    assert!(matches!(hashed(28, u32::MAX), BytesError::Length { found: LEN, .. }));
    let bits = f32::NAN.to_bits();
    assert_eq!(hashed(32, bits), BytesError::Word { table: Table::Shape, word: 2, found: bits });
    for word in 3..8 {
        assert_eq!(hashed(24 + 4 * word, 1), BytesError::Word { table: Table::Shape, word, found: 1 });
    }
    let at = |index: usize, value: f32| refused(&with(HEAD + 4 * index, &value.to_le_bytes()));
    assert_eq!(
        at(5, f32::INFINITY),
        BytesError::Parameters(Error::Parameter { index: 5, fault: ParameterFault::NotFinite })
    );
}

#[test]
fn another_layer_is_told_apart() {
    let bytes = reflex();
    let read = PerceptronBytes::read(&bytes.0).expect("a layer");
    for (inputs, outputs, slope) in [(5, 2, 1.5), (6, 3, 1.5), (2, 6, 1.5), (6, 2, 1.0)] {
        assert!(matches!(read.expect(inputs, outputs, slope), Err(BytesError::Mismatch { field: Field::Layout, .. })));
    }
    assert_eq!(read.expect_channels(7), Ok(()));
    assert_eq!(read.expect_channels(8), Err(BytesError::Mismatch { field: Field::Channels, expected: 8, found: 7 }));
}

#[test]
fn where_bytes_lie_is_checked_and_parameters_are_copied_from_anywhere() {
    at_every_place::<{ LEN + 8 }>(&reflex().0, |offset, bytes| {
        let read = PerceptronBytes::read(bytes).expect("a layer");
        let placed = read.parameters().map(|placed| assert_eq!(placed, parameters(COUNT, 1)));
        assert_eq!(placed, placement(offset, 4));
        let mut copy = [0.0; COUNT];
        read.copy_parameters(&mut copy).expect("the length");
        assert_eq!(copy[..], parameters(COUNT, 1));
        assert_eq!(read.copy_parameters(&mut copy[1..]), Err(BytesError::Buffer { expected: 14, found: 13 }));
    });
}

#[test]
fn nothing_is_written_that_would_not_be_read() {
    let (mut out, mut wrong) = ([3; LEN], parameters(COUNT, 1));
    let mut write = |inputs, slope, parameters: &[f32], from: usize| {
        let error = PerceptronBytes::write(inputs, 2, slope, 0, parameters, &mut out[from..]).expect_err("not a layer");
        assert_eq!(out, [3; LEN]);
        error
    };
    assert_eq!(write(6, 1.0, &wrong, 1), BytesError::Buffer { expected: LEN, found: LEN - 1 });
    let slope = f32::NEG_INFINITY;
    assert_eq!(write(6, slope, &wrong, 0), BytesError::Parameters(Error::Layout(LayoutFault::Slope(slope))));
    let count = Error::Length { slice: Slice::Parameters, expected: 16, found: 14 };
    assert_eq!(write(7, 1.0, &wrong, 0), BytesError::Parameters(count));
    wrong[2] = f32::NAN;
    assert_eq!(
        write(6, 1.0, &wrong, 0),
        BytesError::Parameters(Error::Parameter { index: 2, fault: ParameterFault::NotFinite })
    );
}

proptest! {
    #[test]
    fn what_is_written_is_read(inputs in 0_usize..9, outputs in 0_usize..9, slope in -10_f32..10.0, channels: u64,
                               seed: u64) {
        let parameters = parameters(Perceptron::parameter_count(inputs, outputs), seed);
        let mut bytes = vec![0; PerceptronBytes::byte_count(inputs, outputs)];
        PerceptronBytes::write(inputs, outputs, slope, channels, &parameters, &mut bytes).expect("valid");
        let read = PerceptronBytes::read(&bytes).expect("a layer");
        let mut copy = vec![0.0; parameters.len()];
        read.copy_parameters(&mut copy).expect("the length");
        let found = (read.inputs(), read.outputs(), read.slope(), read.channels(), copy);
        prop_assert_eq!(found, (inputs, outputs, slope, channels, parameters));
    }

    #[test]
    fn no_bytes_whatever_are_a_panic(bytes: Vec<u8>, seal: bool) {
        let _ = PerceptronBytes::read(&bytes);
        // Zeros of the right number are a layer.
        let read = PerceptronBytes::read(&after_a_head(&reflex().0, &bytes, seal)).is_ok();
        prop_assert!(!read || bytes.len() == 4 * COUNT);
    }
}
