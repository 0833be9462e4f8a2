//! Networks of integers.

use farsa_nn::bytes::{Aligned, BytesError, Field, QuantizedNetworkBytes, Table};
use farsa_nn::fault::{LayoutFault, ParameterFault, Slice};
use farsa_nn::quantized::{QuantizedNetwork, QuantizedScale};
use farsa_nn::{Error, Leak, LeakyLayout, LeakyParameter};
use farsa_num::{Domain, Stream, crc32};
use proptest::prelude::*;

use crate::{HEAD, after_a_head, all_damage_is_refused, at_every_place, placed_or, placement, with_hash};

// An odd number of parameters: the checksum lies at no multiple of four.
const LAYOUT: LeakyLayout = LeakyLayout::new(6, 5, 4);
const COUNT: usize = LAYOUT.parameter_count();
const LEN: usize = QuantizedNetworkBytes::byte_count(LAYOUT);

fn quantized(layout: LeakyLayout, seed: u64) -> (QuantizedScale, Vec<i16>) {
    let mut stream = Stream::new(seed, Domain::InitialGenome, 0, 0, 0);
    let value = |kind| if kind == LeakyParameter::Leak { stream.uniform() } else { stream.range(-6.0, 6.0) };
    let parameters: Vec<f32> = layout.kinds().map(value).collect();
    let mut fixed = vec![0; parameters.len()];
    (QuantizedScale::quantize(&layout, 9, &parameters, &mut fixed).expect("fits"), fixed)
}

pub(crate) fn champion() -> Aligned<[u8; LEN]> {
    let (mut bytes, (scale, fixed)) = (Aligned([0; LEN]), quantized(LAYOUT, 1));
    QuantizedNetworkBytes::write(LAYOUT, Leak::TwoTap, scale, 7, &fixed, &mut bytes.0).expect("valid");
    bytes
}

fn with(place: usize, new: &[u8]) -> Vec<u8> {
    crate::with(&champion().0, place, new)
}

fn refused(bytes: &[u8]) -> BytesError {
    QuantizedNetworkBytes::read(bytes).expect_err("not a network of integers")
}

#[test]
fn the_format_is_that_of_the_document() {
    let (bytes, (scale, fixed)) = (champion().0, quantized(LAYOUT, 1));
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().expect("4"));
    assert_eq!((COUNT, LEN, &bytes[..8]), (85, HEAD + 2 * 85 + 4, &b"FARSA-NN"[..]));
    assert_eq!([8, 12, 16, 20].map(word), [1, 2, 246, 170]);
    let shape = [6, 5, 4, 0, 1, 9, scale.weight_bits(), scale.sum_bits()];
    assert_eq!(core::array::from_fn::<_, 8, _>(|i| word(24 + 4 * i)), shape);
    assert_eq!(bytes[56..64], QuantizedNetworkBytes::layout_hash(LAYOUT, Leak::TwoTap, scale).to_le_bytes());
    assert_eq!(bytes[64..72], 7_u64.to_le_bytes());
    for (at, value) in fixed.iter().enumerate() {
        assert_eq!(bytes[HEAD + 2 * at..][..2], value.to_le_bytes());
    }
    assert_eq!(word(LEN - 4), crc32(&bytes[..LEN - 4]));
}

#[test]
fn a_network_over_bytes_is_the_network_and_takes_others_while_it_runs() {
    let (bytes, (scale, fixed)) = (champion(), quantized(LAYOUT, 1));
    let read = QuantizedNetworkBytes::read(&bytes.0).expect("a network");
    assert_eq!((read.leak(), read.scale(), read.channels()), (Leak::TwoTap, scale, 7));
    read.expect(LAYOUT, Leak::TwoTap, 9).expect("the layout");
    // The slope is in the weights.
    read.expect(LAYOUT.with_slope(3.0), Leak::TwoTap, 9).expect("the layout");
    let mut copy = [0; COUNT];
    read.copy_parameters(&mut copy).expect("the length");
    let placed = placed_or(read.parameters(), &bytes.0, &copy);
    assert_eq!(placed, fixed);

    // Another individual, with other binary points.
    let mut weak: Vec<f32> = vec![0.1; COUNT];
    weak[3] = -0.2;
    let mut others = vec![0; COUNT];
    let other_scale = QuantizedScale::quantize(&LAYOUT, 9, &weak, &mut others).expect("fits");
    assert_ne!(scale, other_scale);
    let mut second = Aligned([0; LEN]);
    QuantizedNetworkBytes::write(LAYOUT, Leak::TwoTap, other_scale, 7, &others, &mut second.0).expect("valid");
    let (read_later, mut copy) = (QuantizedNetworkBytes::read(&second.0).expect("a network"), [0; COUNT]);
    read_later.expect(LAYOUT, Leak::TwoTap, 9).expect("the layout");
    read_later.copy_parameters(&mut copy).expect("the length");
    let replacement = placed_or(read_later.parameters(), &second.0, &copy);

    let state = || [0; LAYOUT.state_len()];
    let mut own = QuantizedNetwork::new(LAYOUT, Leak::TwoTap, scale, fixed.clone(), state()).expect("valid");
    let mut over = QuantizedNetwork::new(LAYOUT, Leak::TwoTap, read.scale(), placed, state()).expect("valid");
    let mut inputs = Stream::new(1, Domain::Network, 0, 0, 0);
    let (mut x, mut y, mut z) = ([0; 6], [0; 4], [0; 4]);
    for step in 0..100 {
        x.fill_with(|| inputs.next_u32() as i16);
        own.step_quantized(&x, &mut y);
        over.step_quantized(&x, &mut z);
        assert_eq!((y, own.hidden()), (z, over.hidden()));
        if step == 50 {
            own.copy_parameters(other_scale, &others).expect("valid");
            assert_eq!(over.set_parameters(read_later.scale(), replacement).expect("valid"), placed);
            assert_eq!((own.scale(), own.parameters()), (over.scale(), over.parameters()));
        }
    }

    let before = (own.scale(), own.parameters().to_vec());
    let count = Error::Length { slice: Slice::Parameters, expected: COUNT, found: 1 };
    assert_eq!(own.copy_parameters(scale, &[0]), Err(count));
    assert_eq!(own.set_parameters(scale, vec![0]), Err(count));
    let wrong = Error::Parameter { index: COUNT - 1, fault: ParameterFault::QuantizedLeak(-1) };
    others[COUNT - 1] = -1;
    assert_eq!(own.copy_parameters(scale, &others), Err(wrong));
    assert_eq!(own.set_parameters(scale, others), Err(wrong));
    assert_eq!(before, (own.scale(), own.parameters().to_vec()));
}

#[test]
fn every_flipped_bit_and_every_truncation_is_refused() {
    all_damage_is_refused(&champion().0, refused);
}

#[test]
fn foreign_bytes_are_refused_by_what_is_wrong_with_them() {
    assert_eq!(refused(&with(8, &[2])), BytesError::Mismatch { field: Field::Version, expected: 1, found: 2 });
    assert!(matches!(refused(&with(24, &[7])), BytesError::Mismatch { field: Field::LayoutHash, .. }));
    let hashed = |at: usize, word: u32| refused(&with_hash(&champion().0, at, word));
    assert_eq!(hashed(24, 7), BytesError::Length { expected: LEN + 2 * 5, found: LEN });
    assert!(matches!(hashed(28, u32::MAX), BytesError::Length { found: LEN, .. }));
    assert_eq!(hashed(36, 1), BytesError::Word { table: Table::Shape, word: 3, found: 1 });
    assert_eq!(hashed(40, 3), BytesError::Word { table: Table::Shape, word: 4, found: 3 });
    let bits = |of, found, least, most| {
        BytesError::Parameters(Error::Layout(LayoutFault::FractionBits { of, found, least, most }))
    };
    assert_eq!(hashed(44, 16), bits("inputs", 16, 0, 15));
    assert_eq!(hashed(48, u32::MAX), bits("weights", u32::MAX, 0, 15));
    assert_eq!(hashed(52, 9), bits("sums", 9, 10, 20));
    assert_eq!(refused(&with(20, &[0])), BytesError::Length { expected: HEAD + 4, found: LEN });
    let leak = refused(&with(LEN - 6, &(-1_i16).to_le_bytes()));
    assert_eq!(leak, BytesError::Parameters(Error::Parameter { index: 84, fault: ParameterFault::QuantizedLeak(-1) }));
}

/// Weights whose sums could overflow are refused, so that the board's step needs no check.
#[test]
fn sums_that_could_overflow_are_refused() {
    const MANY: LeakyLayout = LeakyLayout::new(0, 70, 1);
    let fixed: Vec<i16> =
        MANY.kinds().map(|kind| if kind == LeakyParameter::OutputWeight { i16::MAX } else { 0 }).collect();
    let scale = QuantizedScale::new(15, 10, 20).expect("valid");
    let mut bytes = vec![0; QuantizedNetworkBytes::byte_count(MANY)];
    let largest = 70 * ((32_767 << 10 >> 5 << 5 << 5 >> 5) + 1);
    let error = QuantizedNetworkBytes::write(MANY, Leak::Filter, scale, 0, &fixed, &mut bytes);
    let expected = BytesError::Parameters(Error::Sum { target: 70, largest, limit: i32::MAX as u64 });
    assert_eq!(error, Err(expected));
    // Written with sums of fewer fraction bits, which fit, and forged.
    let coarse = QuantizedScale::new(15, 10, 19).expect("valid");
    QuantizedNetworkBytes::write(MANY, Leak::Filter, coarse, 0, &fixed, &mut bytes).expect("fits");
    QuantizedNetworkBytes::read(&bytes).expect("a network");
    assert_eq!(refused(&with_hash(&bytes, 52, 20)), expected);
}

#[test]
fn any_number_of_outputs_without_weights_is_read() {
    const MANY: LeakyLayout = LeakyLayout::new(3, 0, 0x7FFF_FFFF);
    // Without hidden neurons there is nothing to weight. To look at each output would take years.
    let none = LeakyLayout::new(3, 0, usize::MAX >> 4);
    assert!(QuantizedScale::quantize(&none, 9, &[], &mut []).is_ok());
    let mut bytes = Aligned([0; QuantizedNetworkBytes::byte_count(MANY)]);
    let scale = QuantizedScale::quantize(&MANY, 9, &[], &mut []).expect("fits");
    QuantizedNetworkBytes::write(MANY, Leak::TwoTap, scale, 7, &[], &mut bytes.0).expect("valid");
    assert_eq!(QuantizedNetworkBytes::read(&bytes.0).expect("a network").layout(), MANY);
}

#[test]
fn another_controller_is_told_apart() {
    let bytes = champion();
    let read = QuantizedNetworkBytes::read(&bytes.0).expect("a network");
    for (layout, leak, input_bits) in [
        (LAYOUT, Leak::Filter, 9),
        (LAYOUT, Leak::TwoTap, 8),
        (LeakyLayout::new(5, 5, 4), Leak::TwoTap, 9),
        (LeakyLayout::new(6, 5, 3), Leak::TwoTap, 9),
    ] {
        assert!(
            matches!(read.expect(layout, leak, input_bits), Err(BytesError::Mismatch { field: Field::Layout, .. })),
            "{layout:?}"
        );
    }
    assert_eq!(read.expect_channels(7), Ok(()));
    assert_eq!(read.expect_channels(8), Err(BytesError::Mismatch { field: Field::Channels, expected: 8, found: 7 }));
}

#[test]
fn where_bytes_lie_is_checked_and_parameters_are_copied_from_anywhere() {
    let (_, fixed) = quantized(LAYOUT, 1);
    at_every_place::<{ LEN + 8 }>(&champion().0, |offset, bytes| {
        let read = QuantizedNetworkBytes::read(bytes).expect("a network");
        let placed = read.parameters().map(|placed| assert_eq!(placed, fixed));
        assert_eq!(placed, placement(offset, 2));
        let mut copy = [0; COUNT];
        read.copy_parameters(&mut copy).expect("the length");
        assert_eq!(copy[..], fixed);
        assert_eq!(read.copy_parameters(&mut copy[1..]), Err(BytesError::Buffer { expected: 85, found: 84 }));
    });
}

#[test]
fn nothing_is_written_that_would_not_be_read() {
    let (scale, mut wrong) = quantized(LAYOUT, 1);
    let mut out = [3; LEN];
    let short = QuantizedNetworkBytes::write(LAYOUT, Leak::Filter, scale, 0, &wrong, &mut out[1..]);
    assert_eq!(short, Err(BytesError::Buffer { expected: LEN, found: LEN - 1 }));
    wrong[84] = 16_385;
    let error = QuantizedNetworkBytes::write(LAYOUT, Leak::Filter, scale, 0, &wrong, &mut out);
    let leak = Error::Parameter { index: 84, fault: ParameterFault::QuantizedLeak(16_385) };
    assert_eq!(error, Err(BytesError::Parameters(leak)));
    assert_eq!(out, [3; LEN]);
}

proptest! {
    #[test]
    fn what_is_written_is_read(sensors in 0_usize..9, hidden in 0_usize..9, outputs in 0_usize..9, leak in 0_usize..3,
                               channels: u64, seed: u64) {
        let layout = LeakyLayout::new(sensors, hidden, outputs);
        let (leak, (scale, fixed)) = (Leak::ALL[leak], quantized(layout, seed));
        let mut bytes = vec![0; QuantizedNetworkBytes::byte_count(layout)];
        QuantizedNetworkBytes::write(layout, leak, scale, channels, &fixed, &mut bytes).expect("valid");
        let read = QuantizedNetworkBytes::read(&bytes).expect("a network");
        let mut copy = vec![0; layout.parameter_count()];
        read.copy_parameters(&mut copy).expect("the length");
        let found = (read.layout(), read.leak(), read.scale(), read.channels(), copy);
        prop_assert_eq!(found, (layout, leak, scale, channels, fixed));
    }

    #[test]
    fn no_bytes_whatever_are_a_panic(bytes: Vec<u8>, seal: bool) {
        let _ = QuantizedNetworkBytes::read(&bytes);
        // This number of bytes may be parameters by chance.
        prop_assume!(bytes.len() != 2 * COUNT);
        prop_assert!(QuantizedNetworkBytes::read(&after_a_head(&champion().0, &bytes, seal)).is_err());
    }
}
