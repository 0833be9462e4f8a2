//! Leaky networks.

use farsa_nn::bytes::{Aligned, BytesError, Field, LeakyNetworkBytes, Table, channel_hash};
use farsa_nn::fault::{LayoutFault, ParameterFault};
use farsa_nn::{Controller, Error, Leak, LeakyLayout, LeakyNetwork, LeakyParameter};
use farsa_num::{Domain, Stream, crc32};
use proptest::prelude::*;

use crate::{HEAD, after_a_head, all_damage_is_refused, at_every_place, placed_or, placement, with_hash};

const LAYOUT: LeakyLayout = LeakyLayout::new(29, 12, 23);
const LEN: usize = LeakyNetworkBytes::byte_count(LAYOUT);

fn parameters(layout: LeakyLayout, seed: u64) -> Vec<f32> {
    let mut stream = Stream::new(seed, Domain::InitialGenome, 0, 0, 0);
    let value = |kind| if kind == LeakyParameter::Leak { stream.uniform() } else { stream.range(-6.0, 6.0) };
    layout.kinds().map(value).collect()
}

pub(crate) fn champion() -> Aligned<[u8; LEN]> {
    let mut bytes = Aligned([0; LEN]);
    LeakyNetworkBytes::write(LAYOUT, Leak::Evonet, 7, &parameters(LAYOUT, 1), &mut bytes.0).expect("valid");
    bytes
}

fn with(place: usize, new: &[u8]) -> Vec<u8> {
    crate::with(&champion().0, place, new)
}

fn refused(bytes: &[u8]) -> BytesError {
    LeakyNetworkBytes::read(bytes).expect_err("not a network")
}

#[test]
fn the_format_is_that_of_the_document() {
    let bytes = champion().0;
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().expect("4"));
    assert_eq!((LEN, &bytes[..8]), (HEAD + 4 * 792 + 4, &b"FARSA-NN"[..]));
    assert_eq!([8, 12, 16, 20].map(word), [1, 1, 3244, 3168]);
    assert_eq!(core::array::from_fn::<_, 8, _>(|i| word(24 + 4 * i)), [29, 12, 23, 0.2_f32.to_bits(), 2, 0, 0, 0]);
    assert_eq!(bytes[56..64], LeakyNetworkBytes::layout_hash(LAYOUT, Leak::Evonet).to_le_bytes());
    assert_eq!(bytes[64..72], 7_u64.to_le_bytes());
    assert_eq!(bytes[72..76], parameters(LAYOUT, 1)[0].to_le_bytes());
    assert_eq!(word(LEN - 4), crc32(&bytes[..LEN - 4]));
}

#[test]
fn a_network_over_bytes_is_the_network() {
    let bytes = champion();
    let read = LeakyNetworkBytes::read(&bytes.0).expect("a network");
    assert_eq!((read.layout(), read.leak(), read.channels()), (LAYOUT, Leak::Evonet, 7));
    read.expect(LAYOUT, Leak::Evonet).expect("the layout");
    let mut copy = [0.0; LAYOUT.parameter_count()];
    read.copy_parameters(&mut copy).expect("the length");
    let placed = placed_or(read.parameters(), &bytes.0, &copy);
    assert_eq!(placed, parameters(LAYOUT, 1));

    let state = || [0.0; LAYOUT.state_len()];
    let mut own = LeakyNetwork::new(LAYOUT, Leak::Evonet, parameters(LAYOUT, 1), state()).expect("valid");
    let mut over = LeakyNetwork::new(read.layout(), read.leak(), placed, state()).expect("valid");
    let mut inputs = Stream::new(1, Domain::Network, 0, 0, 0);
    let (mut x, mut y, mut z) = ([0.0; 29], [0.0; 23], [0.0; 23]);
    for _ in 0..100 {
        x.fill_with(|| inputs.range(-10.0, 10.0));
        own.step(&x, &mut y);
        over.step(&x, &mut z);
        assert_eq!(y.map(f32::to_bits), z.map(f32::to_bits));
    }
}

#[test]
fn every_flipped_bit_and_every_truncation_is_refused() {
    all_damage_is_refused(&champion().0, refused);
}

#[test]
fn foreign_bytes_are_refused_by_what_is_wrong_with_them() {
    assert_eq!(refused(b"\x7fELF\x01\x01\x01\0 and so on"), BytesError::Magic { found: *b"\x7fELF\x01\x01\x01\0" });
    assert_eq!(refused(&with(8, &[2])), BytesError::Mismatch { field: Field::Version, expected: 1, found: 2 });
    assert_eq!(refused(&with(12, &[9])), BytesError::Mismatch { field: Field::Kind, expected: 1, found: 9 });
    assert!(matches!(refused(&with(24, &[30])), BytesError::Mismatch { field: Field::LayoutHash, .. }));
    // A forged hash is caught by what the numbers mean.
    let hashed = |at: usize, word: u32| refused(&with_hash(&champion().0, at, word));
    assert_eq!(hashed(24, 30), BytesError::Length { expected: LEN + 4 * 12, found: LEN });
    assert!(matches!(hashed(28, u32::MAX), BytesError::Length { found: LEN, .. }));
    assert_eq!(
        hashed(36, f32::NAN.to_bits()),
        BytesError::Word { table: Table::Shape, word: 3, found: f32::NAN.to_bits() }
    );
    assert_eq!(hashed(40, 3), BytesError::Word { table: Table::Shape, word: 4, found: 3 });
    assert_eq!(hashed(48, 1), BytesError::Word { table: Table::Shape, word: 6, found: 1 });
    assert_eq!(refused(&with(20, &[0])), BytesError::Length { expected: HEAD + 4 + (3168 - 96), found: LEN });
    let at = |index: usize, value: f32| refused(&with(HEAD + 4 * index, &value.to_le_bytes()));
    assert_eq!(
        at(5, f32::INFINITY),
        BytesError::Parameters(Error::Parameter { index: 5, fault: ParameterFault::NotFinite })
    );
    assert_eq!(at(791, 1.5), BytesError::Parameters(Error::Parameter { index: 791, fault: ParameterFault::Leak(1.5) }));
}

#[test]
fn another_controller_is_told_apart() {
    let bytes = champion();
    let read = LeakyNetworkBytes::read(&bytes.0).expect("a network");
    for (layout, leak) in [
        (LAYOUT, Leak::Filter),
        (LAYOUT.with_slope(0.3), Leak::Evonet),
        (LeakyLayout::new(26, 12, 23), Leak::Evonet),
        (LeakyLayout::new(29, 12, 22), Leak::Evonet),
    ] {
        assert!(
            matches!(read.expect(layout, leak), Err(BytesError::Mismatch { field: Field::Layout, .. })),
            "{layout:?}"
        );
    }
    assert_eq!(read.expect_channels(7), Ok(()));
    assert_eq!(read.expect_channels(8), Err(BytesError::Mismatch { field: Field::Channels, expected: 8, found: 7 }));
    let hashes = [
        channel_hash(["ab", "c"], ["d"]),
        channel_hash(["a", "bc"], ["d"]),
        channel_hash(["ab"], ["c", "d"]),
        channel_hash(["ab", "c", "d"], [""; 0]),
    ];
    assert!((0..4).all(|i| (0..i).all(|k| hashes[i] != hashes[k])), "{hashes:x?}");
}

#[test]
fn where_bytes_lie_is_checked_and_parameters_are_copied_from_anywhere() {
    at_every_place::<{ LEN + 8 }>(&champion().0, |offset, bytes| {
        let read = LeakyNetworkBytes::read(bytes).expect("a network");
        let placed = read.parameters().map(|placed| assert_eq!(placed, parameters(LAYOUT, 1)));
        assert_eq!(placed, placement(offset, 4));
        let mut copy = [0.0; LAYOUT.parameter_count()];
        read.copy_parameters(&mut copy).expect("the length");
        assert_eq!(copy[..], parameters(LAYOUT, 1));
        assert_eq!(read.copy_parameters(&mut copy[1..]), Err(BytesError::Buffer { expected: 792, found: 791 }));
    });
}

#[test]
fn nothing_is_written_that_would_not_be_read() {
    let mut out = [3; LEN];
    let mut wrong = parameters(LAYOUT, 1);
    assert_eq!(
        LeakyNetworkBytes::write(LAYOUT, Leak::Filter, 0, &wrong, &mut out[1..]),
        Err(BytesError::Buffer { expected: LEN, found: LEN - 1 })
    );
    wrong[2] = f32::NAN;
    let error = LeakyNetworkBytes::write(LAYOUT, Leak::Filter, 0, &wrong, &mut out);
    assert_eq!(error, Err(BytesError::Parameters(Error::Parameter { index: 2, fault: ParameterFault::NotFinite })));
    let nan = LAYOUT.with_slope(f32::NAN);
    let error = LeakyNetworkBytes::write(nan, Leak::Filter, 0, &parameters(LAYOUT, 1), &mut out);
    assert!(matches!(error, Err(BytesError::Parameters(Error::Layout(LayoutFault::Slope(_))))));
    assert_eq!(out, [3; LEN]);
}

proptest! {
    #[test]
    fn what_is_written_is_read(sensors in 0_usize..9, hidden in 0_usize..9, outputs in 0_usize..9, slope in -9.0_f32..9.0,
                               leak in 0_usize..3, channels: u64, seed: u64) {
        let layout = LeakyLayout::new(sensors, hidden, outputs).with_slope(slope);
        let (leak, parameters) = (Leak::ALL[leak], parameters(layout, seed));
        let mut bytes = vec![0; LeakyNetworkBytes::byte_count(layout)];
        LeakyNetworkBytes::write(layout, leak, channels, &parameters, &mut bytes).expect("valid");
        let read = LeakyNetworkBytes::read(&bytes).expect("a network");
        let mut copy = vec![0.0; layout.parameter_count()];
        read.copy_parameters(&mut copy).expect("the length");
        prop_assert_eq!((read.layout(), read.leak(), read.channels(), copy), (layout, leak, channels, parameters));
    }

    #[test]
    fn no_bytes_whatever_are_a_panic(bytes: Vec<u8>, seal: bool) {
        let _ = LeakyNetworkBytes::read(&bytes);
        prop_assert!(LeakyNetworkBytes::read(&after_a_head(&champion().0, &bytes, seal)).is_err());
    }
}
