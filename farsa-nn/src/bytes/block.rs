//! A trained network of blocks as bytes.

use farsa_num::Digest;

use crate::activation::Activation;
use crate::block::description::{Block, Group, Span};
use crate::block::layout::{BlockLayout, BlockParameter, check_description};
#[cfg(feature = "alloc")]
use crate::block::layout_buf::BlockLayoutBuf;
use crate::block::network::check_values;
use crate::bytes::error::BytesError;
use crate::bytes::frame::{
    Frame, Kind, SHAPE, copy, frame_len, layout_hash, placed, same_channels, same_layout, values, word,
};
use crate::leak::Leak;

/// Numbers of a group: neurons, slope, and in one word the activation, 256 with biases, 512 with gains, 1024 with leaks.
const GROUP: usize = 3;
/// Numbers of a block: its kind and up to five more.
const BLOCK: usize = 6;
const BIAS: u32 = 1 << 8;
const GAIN: u32 = 1 << 9;
const LEAK: u32 = 1 << 10;

/// A [`BlockNetwork`](crate::block::BlockNetwork) of given bytes, as [`LeakyNetworkBytes`](crate::bytes::LeakyNetworkBytes) are a
/// `LeakyNetwork`: checked, with the description of its groups and blocks, and parameters that are used where they lie.
///
/// A board whose layout is a constant compares it by [`expect`](Self::expect). A program that takes any network copies the
/// layout into memory of its own ([`copy_layout`](Self::copy_layout)), or onto the heap with feature `alloc` (`layout`). A short
/// description may ask for a large state, by delays or by neurons without parameters: look at
/// [`state_len`](BlockLayout::state_len) before so much is allocated for bytes of strangers.
///
/// ```
/// use farsa_nn::block::{Architecture, BlockLayout, BlockNetwork, BlockPlan};
/// use farsa_nn::bytes::{Aligned, BlockNetworkBytes};
/// use farsa_nn::{Controller, Leak};
///
/// const PLAN: BlockPlan = Architecture::elman(2, 3, 1).plan();
/// const LAYOUT: BlockLayout = PLAN.layout();
/// # fn main() -> Result<(), farsa_nn::bytes::BytesError> {
/// // A computer writes,
/// let parameters = [0.5; LAYOUT.parameter_count()];
/// let mut flash = Aligned([0; BlockNetworkBytes::byte_count(&LAYOUT)]);
/// BlockNetworkBytes::write(LAYOUT, Leak::Filter, 0, &parameters, &mut flash.0)?;
/// // a board reads: nothing is copied.
/// let bytes = BlockNetworkBytes::read(&flash.0)?;
/// bytes.expect(LAYOUT, Leak::Filter)?;
/// let mut network = BlockNetwork::new(LAYOUT, bytes.leak(), bytes.parameters()?, [0.0; LAYOUT.state_len()])?;
/// let mut y = [0.0];
/// network.step(&[1.0, -1.0], &mut y);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct BlockNetworkBytes<'a> {
    shape: [u32; SHAPE],
    leak: Leak,
    channels: u64,
    groups: &'a [[u8; 4 * GROUP]],
    blocks: &'a [[u8; 4 * BLOCK]],
    parameters: &'a [u8],
}

impl BlockNetworkBytes<'_> {
    /// Number of bytes of a network of this layout; saturates.
    pub const fn byte_count(layout: &BlockLayout<'_>) -> usize {
        let description = description_len(layout.groups().len(), layout.blocks().len());
        frame_len(layout.parameter_count().saturating_add(description).saturating_mul(4))
    }

    /// Fills `out` [[`byte_count`](Self::byte_count)] with a network.
    ///
    /// `channels` says what inputs and outputs are, by [`channel_hash`](crate::bytes::channel_hash); 0 says nothing.
    ///
    /// # Errors
    /// [`BytesError::Parameters`] as [`BlockNetwork::new`](crate::BlockNetwork::new), [`BytesError::Description`] for a count
    /// beyond 32 bits, [`BytesError::Buffer`]; then nothing is written.
    pub fn write(
        layout: BlockLayout<'_>,
        leak: Leak,
        channels: u64,
        parameters: &[f32],
        out: &mut [u8],
    ) -> Result<(), BytesError> {
        layout.check()?;
        check_values(layout.range(BlockParameter::Leak), parameters.iter().copied())?;
        // What would not be read is not written.
        for (at, group) in layout.groups().iter().enumerate() {
            group_of(words_of_group(group)).map_err(|wrong| wrong.in_description(at * GROUP))?;
        }
        for (at, block) in layout.blocks().iter().enumerate() {
            let before = layout.groups().len() * GROUP + at * BLOCK;
            block_of(words_of_block(block)).map_err(|wrong| wrong.in_description(before))?;
        }
        let count = description_len(layout.groups().len(), layout.blocks().len()).saturating_add(parameters.len());
        let numbers = description(&layout).map(u32::to_le_bytes).chain(parameters.iter().map(|p| p.to_le_bytes()));
        Frame::write_counted(Kind::BlockNetwork, &shape_of(&layout, leak), channels, count, numbers, out)
    }

    /// The layout hash: of the layout with its groups and blocks, and the reading of the leak.
    pub fn layout_hash(layout: BlockLayout<'_>, leak: Leak) -> u64 {
        layout_hash(Kind::BlockNetwork, &shape_of(&layout, leak))
    }
}

impl<'a> BlockNetworkBytes<'a> {
    /// Checks bytes that should be a network of blocks, all of them: the format, the checksum, every group and block, and
    /// every parameter.
    ///
    /// # Errors
    /// As [`LeakyNetworkBytes::read`](crate::LeakyNetworkBytes::read), and [`BytesError::Description`].
    pub fn read(bytes: &'a [u8]) -> Result<Self, BytesError> {
        let Frame { shape, channels, parameters: content, .. } = Frame::open(Kind::BlockNetwork, bytes)?;
        let [inputs, outputs, groups, blocks, leak, low, high, unused] = shape;
        let Some(&reading) = Leak::ALL.get(leak as usize) else {
            return Err(BytesError::Shape { word: 4, found: leak });
        };
        if unused != 0 {
            return Err(BytesError::Shape { word: 7, found: unused });
        }
        let (found, counts) = (bytes.len(), [groups, blocks].map(|count| count as usize));
        let wrong_length = |numbers: usize| {
            let description = description_len(counts[0], counts[1]);
            BytesError::Length { expected: frame_len(description.saturating_add(numbers).saturating_mul(4)), found }
        };
        let [groups, blocks] = counts;
        let (groups, rest) =
            content.split_at_checked(groups.saturating_mul(4 * GROUP)).ok_or_else(|| wrong_length(0))?;
        let (blocks, parameters) =
            rest.split_at_checked(blocks.saturating_mul(4 * BLOCK)).ok_or_else(|| wrong_length(0))?;
        let mut digest = Digest::new();
        digest.add_bytes(groups);
        digest.add_bytes(blocks);
        let (groups, blocks) = (groups.as_chunks().0, blocks.as_chunks().0);
        let read = Self { shape, leak: reading, channels, groups, blocks, parameters };
        for (at, group) in groups.iter().enumerate() {
            group_of(words(group)).map_err(|wrong| wrong.in_description(at * GROUP))?;
        }
        for (at, block) in blocks.iter().enumerate() {
            block_of(words(block)).map_err(|wrong| wrong.in_description(groups.len() * GROUP + at * BLOCK))?;
        }
        if let Some((at, (_, found))) = halves(digest.finish())
            .into_iter()
            .zip([low, high])
            .enumerate()
            .find(|(_, (expected, found))| expected != found)
        {
            return Err(BytesError::Shape { word: 5 + at, found });
        }
        check_description(inputs as usize, outputs as usize, read.groups(), read.blocks())?;
        let [weights, biases, gains, leaks] = read.counts();
        let first = weights.saturating_add(biases).saturating_add(gains);
        let leaks = first..first.saturating_add(leaks);
        if parameters.len() != leaks.end.saturating_mul(4) {
            return Err(wrong_length(leaks.end));
        }
        check_values(leaks, values(parameters))?;
        Ok(read)
    }

    /// Numbers of weights, biases, gains and leaks.
    fn counts(&self) -> [usize; 4] {
        let weights = self.blocks().fold(0_usize, |sum, block| sum.saturating_add(block.weights()));
        let of = |has: fn(&Group) -> bool| {
            self.groups().filter(has).fold(0_usize, |sum, group| sum.saturating_add(group.neurons))
        };
        [weights, of(|group| group.bias), of(|group| group.gain), of(|group| group.leak)]
    }

    /// Nothing, if the network is of this layout and this reading of the leak.
    ///
    /// # Errors
    /// [`BytesError::OtherLayout`].
    pub fn expect(&self, layout: BlockLayout<'_>, leak: Leak) -> Result<(), BytesError> {
        let own = layout_hash(Kind::BlockNetwork, &self.shape);
        same_layout(BlockNetworkBytes::layout_hash(layout, leak), own)
    }

    /// Nothing, if the network is for these channels, by their [`channel_hash`](crate::bytes::channel_hash).
    ///
    /// # Errors
    /// [`BytesError::OtherChannels`].
    pub fn expect_channels(&self, expected: u64) -> Result<(), BytesError> {
        same_channels(expected, self.channels)
    }

    /// Number of inputs.
    pub const fn inputs(&self) -> usize {
        self.shape[0] as usize
    }

    /// Number of outputs.
    pub const fn outputs(&self) -> usize {
        self.shape[1] as usize
    }

    /// The reading of the leak.
    pub const fn leak(&self) -> Leak {
        self.leak
    }

    /// The [`channel_hash`](crate::bytes::channel_hash) of its inputs and outputs; 0 if nothing is said.
    pub const fn channels(&self) -> u64 {
        self.channels
    }

    /// The groups in their order.
    pub fn groups(&self) -> impl Iterator<Item = Group> + Clone + use<'a> {
        // All were read before.
        self.groups.iter().filter_map(|group| group_of(words(group)).ok())
    }

    /// The blocks in their order.
    pub fn blocks(&self) -> impl Iterator<Item = Block> + Clone + use<'a> {
        self.blocks.iter().filter_map(|block| block_of(words(block)).ok())
    }

    /// Copies the groups and the blocks into memory of the caller, which must be as long, for a layout over them.
    ///
    /// # Errors
    /// [`BytesError::Buffer`] for the first that has another length; then nothing is copied.
    pub fn copy_layout<'b>(
        &self,
        groups: &'b mut [Group],
        blocks: &'b mut [Block],
    ) -> Result<BlockLayout<'b>, BytesError> {
        for (expected, found) in [(self.groups.len(), groups.len()), (self.blocks.len(), blocks.len())] {
            if expected != found {
                return Err(BytesError::Buffer { expected, found });
            }
        }
        groups.iter_mut().zip(self.groups()).for_each(|(to, group)| *to = group);
        blocks.iter_mut().zip(self.blocks()).for_each(|(to, block)| *to = block);
        Ok(BlockLayout::new(self.inputs(), self.outputs(), groups, blocks))
    }

    /// The layout on the heap; with feature `alloc`.
    #[cfg(feature = "alloc")]
    pub fn layout(&self) -> BlockLayoutBuf {
        BlockLayoutBuf {
            inputs: self.inputs(),
            outputs: self.outputs(),
            groups: self.groups().collect(),
            blocks: self.blocks().collect(),
        }
    }

    /// The parameters [[`parameter_count`](BlockLayout::parameter_count)] where they lie.
    ///
    /// # Errors
    /// [`BytesError::Misaligned`] and [`BytesError::BigEndian`]; [`copy_parameters`](Self::copy_parameters) then does.
    pub fn parameters(&self) -> Result<&'a [f32], BytesError> {
        placed(self.parameters)
    }

    /// Copies the parameters into `out` [[`parameter_count`](BlockLayout::parameter_count)].
    ///
    /// # Errors
    /// [`BytesError::Buffer`]; then nothing is copied.
    pub fn copy_parameters(&self, out: &mut [f32]) -> Result<(), BytesError> {
        copy(values(self.parameters), out)
    }
}

/// A number of a group or block that none has: its place there, and its value.
struct Wrong {
    word: usize,
    found: u32,
}

impl Wrong {
    fn in_description(self, before: usize) -> BytesError {
        BytesError::Description { word: before + self.word, found: self.found }
    }
}

/// Numbers of so many groups and blocks; saturates.
const fn description_len(groups: usize, blocks: usize) -> usize {
    groups.saturating_mul(GROUP).saturating_add(blocks.saturating_mul(BLOCK))
}

fn description(layout: &BlockLayout<'_>) -> impl Iterator<Item = u32> {
    let groups = layout.groups().iter().flat_map(words_of_group);
    groups.chain(layout.blocks().iter().flat_map(words_of_block))
}

fn shape_of(layout: &BlockLayout<'_>, leak: Leak) -> [u32; SHAPE] {
    let mut digest = Digest::new();
    description(layout).for_each(|word| digest.add_bytes(&word.to_le_bytes()));
    let [low, high] = halves(digest.finish());
    let [inputs, outputs] = [layout.inputs(), layout.outputs()].map(word);
    let [groups, blocks] = [layout.groups().len(), layout.blocks().len()].map(word);
    [inputs, outputs, groups, blocks, leak as u32, low, high, 0]
}

/// A number of 64 bits as two, the lower half first.
const fn halves(number: u64) -> [u32; 2] {
    [number as u32, (number >> 32) as u32]
}

/// Bytes as numbers; there are four for each.
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

/// Nothing, if none of these counts is the largest number, which stands for all that are larger.
fn counts<const N: usize>(words: [(usize, u32); N]) -> Result<(), Wrong> {
    match words.into_iter().find(|(_, found)| *found == u32::MAX) {
        Some((word, found)) => Err(Wrong { word, found }),
        None => Ok(()),
    }
}
