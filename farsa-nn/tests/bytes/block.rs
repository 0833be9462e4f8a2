//! Networks of blocks.

use farsa_nn::block::{Block, BlockLayout, BlockNetwork, BlockParameter, Group, Span};
use farsa_nn::bytes::{Aligned, BlockNetworkBytes, BytesError, Field, Table};
use farsa_nn::fault::{LayoutFault, ParameterFault};
use farsa_nn::{Activation, Controller, Error, Leak};
use farsa_num::{Digest, Domain, Stream, crc32};
use proptest::prelude::*;

use crate::{HEAD, after_a_head, all_damage_is_refused, at_every_place, placed_or, placement, sealed, with_hash};

const X: Span = Span::new(0, 3);
const H: Span = Span::new(3, 2);
const GROUPS: [Group; 3] = [
    Group::new(3, Activation::Linear).with_gains(),
    Group::new(2, Activation::Tanh).with_biases().with_leaks().with_slope(0.5),
    Group::new(1, Activation::Logistic).with_biases(),
];
const BLOCKS: [Block; 8] = [
    Block::Gain(X),
    Block::Update(X),
    Block::connect(X, H),
    Block::connect(H, H).delayed(2),
    Block::Update(H),
    Block::ModulatedGain { neurons: H, by: 4 },
    Block::connect(Span::new(0, 5), Span::new(5, 1)),
    Block::Update(Span::new(5, 1)),
];
const LAYOUT: BlockLayout = BlockLayout::new(3, 1, &GROUPS, &BLOCKS);
const COUNT: usize = LAYOUT.parameter_count();
const LEN: usize = BlockNetworkBytes::byte_count(&LAYOUT);
/// Numbers of the description.
const WORDS: usize = 3 * 3 + 8 * 6;

fn parameters(layout: BlockLayout, seed: u64) -> Vec<f32> {
    let mut stream = Stream::new(seed, Domain::InitialGenome, 0, 0, 0);
    let value = |kind| if kind == BlockParameter::Leak { stream.uniform() } else { stream.range(-6.0, 6.0) };
    layout.kinds().map(value).collect()
}

pub(crate) fn modulated() -> Aligned<[u8; LEN]> {
    let mut bytes = Aligned([0; LEN]);
    BlockNetworkBytes::write(LAYOUT, Leak::TwoTap, 7, &parameters(LAYOUT, 1), &mut bytes.0).expect("valid");
    bytes
}

fn refused(bytes: &[u8]) -> BytesError {
    BlockNetworkBytes::read(bytes).expect_err("not a network of blocks")
}

/// The bytes with another number in the description, whose hashes are forged.
fn described(number: usize, value: u32) -> Vec<u8> {
    let mut bytes = modulated().0.to_vec();
    bytes[HEAD + 4 * number..][..4].copy_from_slice(&value.to_le_bytes());
    let mut digest = Digest::new();
    digest.add_bytes(&bytes[HEAD..HEAD + 4 * WORDS]);
    let hash = digest.finish();
    let low = with_hash(&bytes, 24 + 4 * 5, hash as u32);
    with_hash(&low, 24 + 4 * 6, (hash >> 32) as u32)
}

#[test]
fn the_format_is_that_of_the_document() {
    let bytes = modulated().0;
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().expect("4"));
    assert_eq!((COUNT, LEN), (6 + 4 + 5 + 3 + 3 + 2, HEAD + 4 * (WORDS + 23) + 4));
    assert_eq!([8, 12, 16, 20].map(word), [1, 5, LEN as u32, 4 * (WORDS as u32 + 23)]);
    assert_eq!([24, 28, 32, 36, 40, 52].map(word), [3, 1, 3, 8, 1, 0]);
    let mut digest = Digest::new();
    digest.add_bytes(&bytes[HEAD..HEAD + 4 * WORDS]);
    assert_eq!(bytes[44..52], digest.finish().to_le_bytes());
    let half = 0.5_f32.to_bits();
    let groups = [3, 1_f32.to_bits(), 2 + 512, 2, half, 1 + 256 + 1024, 1, 1_f32.to_bits(), 256];
    let blocks = [
        [2, 0, 3, 0, 0, 0],
        [1, 0, 3, 0, 0, 0],
        [0, 0, 3, 3, 2, 0],
        [0, 3, 2, 3, 2, 2],
        [1, 3, 2, 0, 0, 0],
        [3, 3, 2, 4, 0, 0],
        [0, 0, 5, 5, 1, 0],
        [1, 5, 1, 0, 0, 0],
    ];
    let expected: Vec<u32> = groups.into_iter().chain(blocks.into_iter().flatten()).collect();
    assert_eq!((0..WORDS).map(|i| word(HEAD + 4 * i)).collect::<Vec<_>>(), expected);
    assert_eq!(word(HEAD + 4 * WORDS), parameters(LAYOUT, 1)[0].to_bits());
    assert_eq!(bytes[56..64], BlockNetworkBytes::layout_hash(LAYOUT, Leak::TwoTap).to_le_bytes());
    assert_eq!(bytes[64..72], 7_u64.to_le_bytes());
    assert_eq!(word(LEN - 4), crc32(&bytes[..LEN - 4]));
}

#[test]
fn a_network_over_bytes_is_the_network() {
    let bytes = modulated();
    let read = BlockNetworkBytes::read(&bytes.0).expect("a network");
    assert_eq!((read.inputs(), read.outputs(), read.leak(), read.channels()), (3, 1, Leak::TwoTap, 7));
    read.expect(LAYOUT, Leak::TwoTap).expect("the layout");
    // Without a heap, into buffers on the stack.
    let (mut groups, mut blocks) = ([Group::new(0, Activation::Step); 3], [Block::Gain(X); 8]);
    assert_eq!(
        read.copy_layout(&mut groups[1..], &mut blocks).expect_err("too short"),
        BytesError::Buffer { expected: 3, found: 2 }
    );
    let layout = read.copy_layout(&mut groups, &mut blocks).expect("the lengths");
    assert_eq!(layout, LAYOUT);
    let mut copy = [0.0; COUNT];
    read.copy_parameters(&mut copy).expect("the length");
    let placed = match read.parameters() {
        Ok(placed) => {
            assert_eq!(placed.as_ptr().addr(), bytes.0.as_ptr().addr() + HEAD + 4 * WORDS, "nothing is copied");
            placed
        }
        error => placed_or(error, &bytes.0, &copy),
    };
    let state = || vec![0.0; LAYOUT.state_len()];
    let mut own = BlockNetwork::new(LAYOUT, Leak::TwoTap, parameters(LAYOUT, 1), state()).expect("valid");
    let mut over = BlockNetwork::new(layout, read.leak(), placed, state()).expect("valid");
    let mut inputs = Stream::new(1, Domain::Network, 0, 0, 0);
    let (mut x, mut y, mut z) = ([0.0; 3], [0.0; 1], [0.0; 1]);
    for _ in 0..100 {
        x.fill_with(|| inputs.range(-3.0, 3.0));
        own.step(&x, &mut y);
        over.step(&x, &mut z);
        let bits = |activations: &[f32]| activations.iter().map(|a| a.to_bits()).collect::<Vec<_>>();
        assert_eq!((y.map(f32::to_bits), bits(own.activations())), (z.map(f32::to_bits), bits(over.activations())));
    }
}

#[cfg(feature = "alloc")]
#[test]
fn the_layout_on_the_heap_is_the_layout() {
    let bytes = modulated();
    assert_eq!(BlockNetworkBytes::read(&bytes.0).expect("a network").layout().layout(), LAYOUT);
}

#[test]
fn every_flipped_bit_and_every_truncation_is_refused() {
    all_damage_is_refused(&modulated().0, refused);
}

#[test]
fn foreign_bytes_are_refused_by_what_is_wrong_with_them() {
    let hashed = |at: usize, word: u32| refused(&with_hash(&modulated().0, at, word));
    assert!(matches!(
        hashed(32, 4),
        BytesError::Word { table: Table::Shape, .. } | BytesError::Word { table: Table::Description, .. }
    ));
    assert!(matches!(hashed(32, u32::MAX), BytesError::Length { found: LEN, .. }));
    assert!(matches!(hashed(36, u32::MAX), BytesError::Length { found: LEN, .. }));
    assert_eq!(hashed(40, 3), BytesError::Word { table: Table::Shape, word: 4, found: 3 });
    assert_eq!(hashed(44, 3), BytesError::Word { table: Table::Shape, word: 5, found: 3 });
    assert_eq!(hashed(48, 3), BytesError::Word { table: Table::Shape, word: 6, found: 3 });
    assert_eq!(hashed(52, 3), BytesError::Word { table: Table::Shape, word: 7, found: 3 });
    assert_eq!(
        hashed(24, 6),
        BytesError::Parameters(Error::Layout(LayoutFault::Neurons { first: 0, count: 7, neurons: 6 }))
    );

    let wrong = |word: usize, found: u32| {
        assert_eq!(refused(&described(word, found)), BytesError::Word { table: Table::Description, word, found });
    };
    wrong(0, u32::MAX);
    wrong(2, 5);
    wrong(2, 2048);
    let first = |block: usize| 9 + 6 * block;
    wrong(first(0), 4);
    wrong(first(0) + 3, 1);
    wrong(first(1) + 5, 1);
    wrong(first(5) + 4, 1);
    wrong(first(3) + 5, u32::MAX);
    let nan = refused(&described(1, f32::NAN.to_bits()));
    assert!(matches!(nan, BytesError::Parameters(Error::Layout(LayoutFault::Slope(_)))), "{nan}");
    let beyond = Error::Layout(LayoutFault::Block { index: 4, first: 3, count: 4, neurons: 6 });
    assert_eq!(refused(&described(first(4) + 2, 4)), BytesError::Parameters(beyond));
    let beyond = Error::Layout(LayoutFault::Block { index: 5, first: 6, count: 1, neurons: 6 });
    assert_eq!(refused(&described(first(5) + 3, 6)), BytesError::Parameters(beyond));
    // The source of the error is the network's error. Other errors have no source.
    let source = |error: BytesError| core::error::Error::source(&error).map(ToString::to_string);
    assert_eq!(source(BytesError::Parameters(beyond)), Some(beyond.to_string()));
    assert_eq!(source(BytesError::BigEndian), None);
    // A layout of other parameters than there are.
    assert_eq!(refused(&described(8, 0)), BytesError::Length { expected: LEN - 4, found: LEN });
    assert!(matches!(refused(&described(0, u32::MAX - 1)), BytesError::Length { found: LEN, .. }));

    let at = |index: usize, value: f32| {
        let mut bytes = modulated().0.to_vec();
        bytes[HEAD + 4 * (WORDS + index)..][..4].copy_from_slice(&value.to_le_bytes());
        refused(&sealed(bytes))
    };
    assert_eq!(
        at(5, f32::INFINITY),
        BytesError::Parameters(Error::Parameter { index: 5, fault: ParameterFault::NotFinite })
    );
    assert_eq!(
        at(COUNT - 1, 1.5),
        BytesError::Parameters(Error::Parameter { index: COUNT - 1, fault: ParameterFault::Leak(1.5) })
    );
}

#[test]
fn another_network_is_told_apart() {
    let bytes = modulated();
    let read = BlockNetworkBytes::read(&bytes.0).expect("a network");
    let mut blocks = BLOCKS;
    blocks[3] = blocks[3].delayed(1);
    let mut groups = GROUPS;
    groups[0].slope = 2.0;
    for (layout, leak) in [
        (LAYOUT, Leak::Filter),
        (BlockLayout::new(2, 1, &GROUPS, &BLOCKS), Leak::TwoTap),
        (BlockLayout::new(3, 1, &groups, &BLOCKS), Leak::TwoTap),
        (BlockLayout::new(3, 1, &GROUPS, &blocks), Leak::TwoTap),
        (BlockLayout::new(3, 1, &GROUPS, &BLOCKS[..7]), Leak::TwoTap),
    ] {
        assert!(
            matches!(read.expect(layout, leak), Err(BytesError::Mismatch { field: Field::Layout, .. })),
            "{layout:?}"
        );
    }
    assert_eq!(read.expect_channels(7), Ok(()));
    assert_eq!(read.expect_channels(8), Err(BytesError::Mismatch { field: Field::Channels, expected: 8, found: 7 }));
}

#[test]
fn where_bytes_lie_is_checked_and_parameters_are_copied_from_anywhere() {
    at_every_place::<{ LEN + 8 }>(&modulated().0, |offset, bytes| {
        let read = BlockNetworkBytes::read(bytes).expect("a network");
        let placed = read.parameters().map(|placed| assert_eq!(placed, parameters(LAYOUT, 1)));
        assert_eq!(placed, placement(offset, 4));
        let mut copy = [0.0; COUNT];
        read.copy_parameters(&mut copy).expect("the length");
        assert_eq!(copy[..], parameters(LAYOUT, 1));
        assert_eq!(read.copy_parameters(&mut copy[1..]), Err(BytesError::Buffer { expected: 23, found: 22 }));
    });
}

#[test]
fn nothing_is_written_that_would_not_be_read() {
    let (mut out, mut wrong) = ([3; LEN], parameters(LAYOUT, 1));
    let short = BlockNetworkBytes::write(LAYOUT, Leak::Filter, 0, &wrong, &mut out[1..]);
    assert_eq!(short, Err(BytesError::Buffer { expected: LEN, found: LEN - 1 }));
    let mut write = |layout, parameters: &[f32]| {
        let error = BlockNetworkBytes::write(layout, Leak::Filter, 0, parameters, &mut out).expect_err("no network");
        assert_eq!(out, [3; LEN]);
        error
    };
    let few = BlockLayout::new(9, 1, &GROUPS, &BLOCKS);
    assert_eq!(
        write(few, &wrong),
        BytesError::Parameters(Error::Layout(LayoutFault::Neurons { first: 0, count: 10, neurons: 6 }))
    );
    let mut blocks = BLOCKS;
    blocks[3] = Block::connect(H, H).delayed(usize::MAX);
    let delayed = BlockLayout::new(3, 1, &GROUPS, &blocks);
    assert_eq!(
        write(delayed, &wrong),
        BytesError::Word { table: Table::Description, word: 9 + 6 * 3 + 5, found: u32::MAX }
    );
    let huge = Group { neurons: 1 << 40, bias: false, gain: false, leak: false, ..GROUPS[0] };
    let groups = [&GROUPS[..], &[huge]].concat();
    let larger = BlockLayout::new(3, 1, &groups, &BLOCKS);
    assert_eq!(
        write(larger, &wrong),
        BytesError::Word { table: Table::Description, word: 3 * GROUPS.len(), found: u32::MAX }
    );
    wrong[2] = f32::NAN;
    assert_eq!(
        write(LAYOUT, &wrong),
        BytesError::Parameters(Error::Parameter { index: 2, fault: ParameterFault::NotFinite })
    );
}

/// Any layout of a few groups and blocks, with spans within the neurons.
fn layouts() -> impl Strategy<Value = (usize, usize, Vec<Group>, Vec<Block>)> {
    let group = (1_usize..4, 0_usize..5, -2_f32..2.0, any::<[bool; 3]>()).prop_map(
        |(neurons, activation, slope, [bias, gain, leak])| Group {
            neurons,
            activation: Activation::ALL[activation],
            slope,
            bias,
            gain,
            leak,
        },
    );
    let block = (0_usize..4, any::<[u16; 5]>());
    (prop::collection::vec(group, 1..5), prop::collection::vec(block, 0..7), any::<[u16; 2]>()).prop_map(
        |(groups, drawn, ends)| {
            let neurons: usize = groups.iter().map(|group| group.neurons).sum();
            let span = |[first, count]: [u16; 2]| {
                let first = usize::from(first) % neurons;
                Span::new(first, usize::from(count) % (neurons - first + 1))
            };
            let block = |(kind, [a, b, c, d, e]): (usize, [u16; 5])| match kind {
                0 => Block::Connect { from: span([a, b]), to: span([c, d]), delay: usize::from(e % 4) },
                1 => Block::Update(span([a, b])),
                2 => Block::Gain(span([a, b])),
                _ => Block::ModulatedGain { neurons: span([a, b]), by: usize::from(c) % neurons },
            };
            let inputs = usize::from(ends[0]) % (neurons + 1);
            let outputs = usize::from(ends[1]) % (neurons - inputs + 1);
            (inputs, outputs, groups, drawn.into_iter().map(block).collect())
        },
    )
}

proptest! {
    #[test]
    fn what_is_written_is_read((inputs, outputs, groups, blocks) in layouts(), leak in 0_usize..3, channels: u64,
                               seed: u64) {
        let (layout, leak) = (BlockLayout::new(inputs, outputs, &groups, &blocks), Leak::ALL[leak]);
        let parameters = parameters(layout, seed);
        let mut bytes = vec![0; BlockNetworkBytes::byte_count(&layout)];
        BlockNetworkBytes::write(layout, leak, channels, &parameters, &mut bytes).expect("valid");
        let read = BlockNetworkBytes::read(&bytes).expect("a network");
        let mut copy = vec![0.0; parameters.len()];
        read.copy_parameters(&mut copy).expect("the length");
        prop_assert_eq!((read.inputs(), read.outputs(), read.leak(), read.channels()), (inputs, outputs, leak, channels));
        prop_assert!(read.groups().eq(groups.iter().copied()) && read.blocks().eq(blocks.iter().copied()));
        prop_assert_eq!(copy, parameters);
    }

    #[test]
    fn no_bytes_whatever_are_a_panic(bytes: Vec<u8>, seal: bool) {
        let _ = BlockNetworkBytes::read(&bytes);
        prop_assert!(BlockNetworkBytes::read(&after_a_head(&modulated().0, &bytes, seal)).is_err());
    }

    #[test]
    fn no_description_whatever_is_a_panic(number in 0..WORDS, value: u32, small in 0_u32..8, use_small: bool) {
        let value = if use_small { small } else { value };
        if let Ok(read) = BlockNetworkBytes::read(&described(number, value)) {
            let layout: Vec<Block> = read.blocks().collect();
            prop_assert_eq!((layout.len(), read.groups().count()), (8, 3));
        }
    }
}
