//! The binary format of block networks.

use farsa_num::Digest;

use crate::activation::Activation;
use crate::block::description::{Block, Group, Span};
use crate::block::layout::{BlockLayout, check_description};
#[cfg(feature = "alloc")]
use crate::block::layout_buf::BlockLayoutBuf;
use crate::block::network::BlockModel;
use crate::bytes::error::{BytesError, Field, Table};
use crate::bytes::frame::{Frame, Kind, SHAPE, check_unused, frame_len, layout_hash, variant, word};
use crate::bytes::network::{NetworkBytes, Shape};
use crate::error::Error;
use crate::leak::Leak;
use crate::network::{Model as _, check_parameters};

/// Words of a group: neurons, slope, and the activation plus 256 with biases, 512 with gains, 1024 with leaks.
const GROUP: usize = 3;
/// Words of a block: its kind and up to five more.
const BLOCK: usize = 6;
const BIAS: u32 = 1 << 8;
const GAIN: u32 = 1 << 9;
const LEAK: u32 = 1 << 10;

/// A [`BlockNetwork`](crate::block::BlockNetwork) in its binary format, including the description of its groups and
/// blocks. The bytes have been checked.
///
/// A board with a constant layout compares it by calling [`expect`](Self::expect). A program that supports any network
/// copies the layout to its memory with [`copy_layout`](Self::copy_layout), or to the heap with `layout` if the feature
/// `alloc` is enabled. Note that a short description can require a large state because of delays or neurons without
/// parameters. If the bytes are untrusted, check [`state_len`](BlockLayout::state_len) before you allocate memory.
///
/// ```
/// use farsa_nn::block::{Architecture, BlockLayout, BlockNetwork, BlockPlan};
/// use farsa_nn::bytes::{Aligned, BlockNetworkBytes};
/// use farsa_nn::{Controller, Leak};
///
/// const PLAN: BlockPlan = Architecture::elman(2, 3, 1).plan();
/// const LAYOUT: BlockLayout = PLAN.layout();
/// # fn main() -> Result<(), farsa_nn::bytes::BytesError> {
/// // A computer writes.
/// let parameters = [0.5; LAYOUT.parameter_count()];
/// let mut flash = Aligned([0; BlockNetworkBytes::byte_count(&LAYOUT)]);
/// BlockNetworkBytes::write(LAYOUT, Leak::Filter, 0, &parameters, &mut flash.0)?;
/// // A board reads and copies nothing.
/// let bytes = BlockNetworkBytes::read(&flash.0)?;
/// bytes.expect(LAYOUT, Leak::Filter)?;
/// let mut network = BlockNetwork::new(LAYOUT, bytes.leak(), bytes.parameters()?, [0.0; LAYOUT.state_len()])?;
/// let mut y = [0.0];
/// network.step(&[1.0, -1.0], &mut y);
/// # Ok(())
/// # }
/// ```
pub type BlockNetworkBytes<'a> = NetworkBytes<'a, BlockShape<'a>>;

/// The shape of a [`BlockNetwork`](crate::block::BlockNetwork) in its binary format, including the encoded groups and
/// blocks.
#[derive(Clone, Copy, Debug)]
pub struct BlockShape<'a> {
    words: [u32; SHAPE],
    leak: Leak,
    groups: &'a [[u8; 4 * GROUP]],
    blocks: &'a [[u8; 4 * BLOCK]],
}

impl<'a> NetworkBytes<'a, BlockShape<'a>> {
    /// Returns the number of bytes needed for a network with the given layout. The count saturates.
    pub const fn byte_count(layout: &BlockLayout<'_>) -> usize {
        let description = description_len(layout.groups().len(), layout.blocks().len());
        frame_len(layout.parameter_count().saturating_add(description).saturating_mul(4))
    }

    /// Writes a network to `out`. The length of `out` must be [`byte_count`](Self::byte_count).
    ///
    /// The argument `channels` is the [`channel_hash`](crate::bytes::channel_hash) of the inputs and outputs, or 0.
    ///
    /// # Errors
    /// Returns [`BytesError::Parameters`] if [`BlockNetwork::new`](crate::block::BlockNetwork::new) would fail,
    /// [`BytesError::Word`] if a count exceeds 32 bits, or [`BytesError::Buffer`]. In these cases nothing is written.
    pub fn write(
        layout: BlockLayout<'_>,
        leak: Leak,
        channels: u64,
        parameters: &[f32],
        out: &mut [u8],
    ) -> Result<(), BytesError> {
        BlockModel { layout, leak }.check_model(parameters, |p| p)?;
        // A description that cannot be read is not written.
        for (at, group) in layout.groups().iter().enumerate() {
            group_of(words_of_group(group)).map_err(|wrong| wrong.in_description(at * GROUP))?;
        }
        for (at, block) in layout.blocks().iter().enumerate() {
            let before = layout.groups().len() * GROUP + at * BLOCK;
            block_of(words_of_block(block)).map_err(|wrong| wrong.in_description(before))?;
        }
        let count = description_len(layout.groups().len(), layout.blocks().len()).saturating_add(parameters.len());
        let numbers = description(&layout).map(u32::to_le_bytes).chain(parameters.iter().map(|p| p.to_le_bytes()));
        let words = words_of_layout(&layout, leak);
        Frame::write(Kind::BlockNetwork, &words, channels, count.saturating_mul(4), numbers.flatten(), out)
    }

    /// Computes the hash of a layout, including its groups and blocks, and of the interpretation of the leaks.
    pub fn layout_hash(layout: BlockLayout<'_>, leak: Leak) -> u64 {
        layout_hash(Kind::BlockNetwork, &words_of_layout(&layout, leak))
    }

    /// Checks that the layout and the interpretation of the leaks are those of the caller.
    ///
    /// # Errors
    /// Returns [`BytesError::Mismatch`] if they differ.
    pub fn expect(&self, layout: BlockLayout<'_>, leak: Leak) -> Result<(), BytesError> {
        Field::Layout.check(BlockNetworkBytes::layout_hash(layout, leak), self.shape.hash())
    }

    /// Returns the number of inputs.
    pub const fn inputs(&self) -> usize {
        self.shape.words[0] as usize
    }

    /// Returns the number of outputs.
    pub const fn outputs(&self) -> usize {
        self.shape.words[1] as usize
    }

    /// Gets the interpretation of the leaks.
    pub const fn leak(&self) -> Leak {
        self.shape.leak
    }

    /// Returns an iterator over the groups of neurons.
    pub fn groups(&self) -> impl Iterator<Item = Group> + Clone + use<'a> {
        self.shape.groups()
    }

    /// Returns an iterator over the blocks.
    pub fn blocks(&self) -> impl Iterator<Item = Block> + Clone + use<'a> {
        self.shape.blocks()
    }

    /// Copies the groups and blocks to the given buffers. They must have the right lengths. Returns a layout that
    /// borrows the buffers.
    ///
    /// # Errors
    /// Returns [`BytesError::Buffer`] if a buffer has a different length. In this case nothing is copied.
    pub fn copy_layout<'b>(
        &self,
        groups: &'b mut [Group],
        blocks: &'b mut [Block],
    ) -> Result<BlockLayout<'b>, BytesError> {
        for (expected, found) in [(self.shape.groups.len(), groups.len()), (self.shape.blocks.len(), blocks.len())] {
            if expected != found {
                return Err(BytesError::Buffer { expected, found });
            }
        }
        groups.iter_mut().zip(self.groups()).for_each(|(to, group)| *to = group);
        blocks.iter_mut().zip(self.blocks()).for_each(|(to, block)| *to = block);
        Ok(BlockLayout::new(self.inputs(), self.outputs(), groups, blocks))
    }

    /// Copies the layout to the heap. Requires the feature `alloc`.
    #[cfg(feature = "alloc")]
    pub fn layout(&self) -> BlockLayoutBuf {
        BlockLayoutBuf {
            inputs: self.inputs(),
            outputs: self.outputs(),
            groups: self.groups().collect(),
            blocks: self.blocks().collect(),
        }
    }
}

impl<'a> BlockShape<'a> {
    fn groups(&self) -> impl Iterator<Item = Group> + Clone + use<'a> {
        // `read` has checked all of them.
        self.groups.iter().filter_map(|group| group_of(words(group)).ok())
    }

    fn blocks(&self) -> impl Iterator<Item = Block> + Clone + use<'a> {
        self.blocks.iter().filter_map(|block| block_of(words(block)).ok())
    }

    /// Indices of the first leak and of the end of the parameters.
    fn leaks(&self) -> [usize; 2] {
        let sum = |sum: usize, count: usize| sum.saturating_add(count);
        let weights = self.blocks().map(|block| block.weights()).fold(0, sum);
        let count = |has: fn(&Group) -> bool| self.groups().filter(has).map(|group| group.neurons).fold(0, sum);
        let first = [weights, count(|group| group.bias), count(|group| group.gain)].into_iter().fold(0, sum);
        [first, first.saturating_add(count(|group| group.leak))]
    }
}

impl<'a> Shape<'a> for BlockShape<'a> {
    type Number = f32;

    const KIND: Kind = Kind::BlockNetwork;

    fn read(shape: &[u32; SHAPE], content: &'a [u8]) -> Result<(Self, &'a [u8]), BytesError> {
        let [inputs, outputs, groups, blocks, leak, low, high, _] = *shape;
        let leak = variant(&Leak::ALL, 4, leak)?;
        check_unused(shape, 7)?;
        let [groups, blocks] = [groups, blocks].map(|count| count as usize);
        let expected = frame_len(description_len(groups, blocks).saturating_mul(4));
        let short = BytesError::Length { expected, found: frame_len(content.len()) };
        let (groups, rest) = content.split_at_checked(groups.saturating_mul(4 * GROUP)).ok_or(short)?;
        let (blocks, parameters) = rest.split_at_checked(blocks.saturating_mul(4 * BLOCK)).ok_or(short)?;
        let mut digest = Digest::new();
        digest.add_bytes(groups);
        digest.add_bytes(blocks);
        let (groups, blocks) = (groups.as_chunks().0, blocks.as_chunks().0);
        for (at, group) in groups.iter().enumerate() {
            group_of(words(group)).map_err(|wrong| wrong.in_description(at * GROUP))?;
        }
        for (at, block) in blocks.iter().enumerate() {
            block_of(words(block)).map_err(|wrong| wrong.in_description(groups.len() * GROUP + at * BLOCK))?;
        }
        for ((at, expected), found) in halves(digest.finish()).into_iter().enumerate().zip([low, high]) {
            if expected != found {
                return Err(BytesError::shape(5 + at, found));
            }
        }
        let read = Self { words: *shape, leak, groups, blocks };
        check_description(inputs as usize, outputs as usize, read.groups(), read.blocks())?;
        Ok((read, parameters))
    }

    fn words(&self) -> [u32; SHAPE] {
        self.words
    }

    fn byte_count(&self) -> usize {
        let [_, count] = self.leaks();
        frame_len(description_len(self.groups.len(), self.blocks.len()).saturating_add(count).saturating_mul(4))
    }

    fn check<T: Copy>(&self, parameters: &[T], value: impl Fn(T) -> f32 + Copy) -> Result<(), Error> {
        let [leaks, count] = self.leaks();
        check_parameters(count, leaks, parameters, value)
    }
}

/// An invalid word of a group or block: its index there, and its value.
struct Wrong {
    word: usize,
    found: u32,
}

impl Wrong {
    fn in_description(self, before: usize) -> BytesError {
        BytesError::Word { table: Table::Description, word: before + self.word, found: self.found }
    }
}

/// Number of words of a description. Saturates.
const fn description_len(groups: usize, blocks: usize) -> usize {
    groups.saturating_mul(GROUP).saturating_add(blocks.saturating_mul(BLOCK))
}

fn description(layout: &BlockLayout<'_>) -> impl Iterator<Item = u32> {
    let groups = layout.groups().iter().flat_map(words_of_group);
    groups.chain(layout.blocks().iter().flat_map(words_of_block))
}

/// The words of the shape of a network of this layout.
fn words_of_layout(layout: &BlockLayout<'_>, leak: Leak) -> [u32; SHAPE] {
    let mut digest = Digest::new();
    description(layout).for_each(|word| digest.add_bytes(&word.to_le_bytes()));
    let [low, high] = halves(digest.finish());
    let [inputs, outputs] = [layout.inputs(), layout.outputs()].map(word);
    let [groups, blocks] = [layout.groups().len(), layout.blocks().len()].map(word);
    [inputs, outputs, groups, blocks, leak as u32, low, high, 0]
}

/// The halves of a number of 64 bits, the lower one first.
const fn halves(number: u64) -> [u32; 2] {
    [number as u32, (number >> 32) as u32]
}

/// Decodes words of four bytes each.
fn words<const BYTES: usize, const WORDS: usize>(bytes: &[u8; BYTES]) -> [u32; WORDS] {
    let mut words = [0; WORDS];
    for (word, bytes) in words.iter_mut().zip(bytes.as_chunks().0) {
        *word = u32::from_le_bytes(*bytes);
    }
    words
}

fn words_of_group(group: &Group) -> [u32; GROUP] {
    let flag = |has: bool, bit: u32| if has { bit } else { 0 };
    let what = group.activation as u32 | flag(group.bias, BIAS) | flag(group.gain, GAIN) | flag(group.leak, LEAK);
    [word(group.neurons), group.slope.to_bits(), what]
}

fn group_of([neurons, slope, what]: [u32; GROUP]) -> Result<Group, Wrong> {
    counts([(0, neurons)])?;
    let [bias, gain, leak] = [BIAS, GAIN, LEAK].map(|bit| what & bit != 0);
    let Some(&activation) = Activation::ALL.get((what & !(BIAS | GAIN | LEAK)) as usize) else {
        return Err(Wrong { word: 2, found: what });
    };
    Ok(Group { neurons: neurons as usize, activation, slope: f32::from_bits(slope), bias, gain, leak })
}

fn words_of_block(block: &Block) -> [u32; BLOCK] {
    match *block {
        Block::Connect { from, to, delay } => {
            [0, word(from.first), word(from.count), word(to.first), word(to.count), word(delay)]
        }
        Block::Update(span) => [1, word(span.first), word(span.count), 0, 0, 0],
        Block::Gain(span) => [2, word(span.first), word(span.count), 0, 0, 0],
        Block::ModulatedGain { neurons, by } => [3, word(neurons.first), word(neurons.count), word(by), 0, 0],
    }
}

fn block_of([kind, first, count, third, fourth, fifth]: [u32; BLOCK]) -> Result<Block, Wrong> {
    counts([(1, first), (2, count), (3, third), (4, fourth), (5, fifth)])?;
    let span = Span::new(first as usize, count as usize);
    let unused = match kind {
        0 => &[][..],
        1 | 2 => &[(3, third), (4, fourth), (5, fifth)],
        3 => &[(4, fourth), (5, fifth)],
        _ => return Err(Wrong { word: 0, found: kind }),
    };
    if let Some(&(word, found)) = unused.iter().find(|(_, found)| *found != 0) {
        return Err(Wrong { word, found });
    }
    Ok(match kind {
        0 => Block::Connect { from: span, to: Span::new(third as usize, fourth as usize), delay: fifth as usize },
        1 => Block::Update(span),
        2 => Block::Gain(span),
        _ => Block::ModulatedGain { neurons: span, by: third as usize },
    })
}

/// Rejects the largest word, to which larger counts saturate.
fn counts<const N: usize>(words: [(usize, u32); N]) -> Result<(), Wrong> {
    match words.into_iter().find(|(_, found)| *found == u32::MAX) {
        Some((word, found)) => Err(Wrong { word, found }),
        None => Ok(()),
    }
}
