//! The layout of a block network. It also defines the order of the parameters.

use core::ops::Range;

use crate::block::description::{Block, Group, Span};
use crate::error::Error;
use crate::fault::LayoutFault;

/// The kind of a parameter in a [`BlockLayout`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum BlockParameter {
    /// Weight of a connection.
    Weight,
    /// Bias of a neuron.
    Bias,
    /// Gain of a neuron.
    Gain,
    /// Leak of a neuron [0..1].
    Leak,
}

impl BlockParameter {
    /// All kinds in the order of the parameters.
    pub const ALL: [Self; 4] = [Self::Weight, Self::Bias, Self::Gain, Self::Leak];
}

/// The groups of neurons and the blocks of a [`BlockNetwork`](crate::block::BlockNetwork).
///
/// The inputs are the first neurons and the outputs are the last ones. Groups and blocks are borrowed, so they can be
/// constants in flash memory or part of a layout that was created at run time.
///
/// All parameters are stored in one slice. Biases, gains and leaks that do not exist are omitted.
///
/// | kind | order |
/// |---|---|
/// | [`Weight`](BlockParameter::Weight) | connections in the order of the blocks, in each `j*targets + i`, source `j` to target `i` |
/// | [`Bias`](BlockParameter::Bias) | neurons in their order |
/// | [`Gain`](BlockParameter::Gain) | neurons in their order |
/// | [`Leak`](BlockParameter::Leak) | neurons in their order |
///
/// If a [`LeakyLayout`](crate::LeakyLayout) is expressed with blocks, the order of the parameters is the same. Use
/// [`evonet_order`](BlockLayout::evonet_order) for the order of the original program. All counts saturate.
///
/// ```
/// use farsa_nn::block::{Block, BlockLayout, Group, Span};
/// use farsa_nn::Activation;
///
/// // Three inputs, two recurrent neurons with a delay, one output with connections from all of them.
/// const X: Span = Span::new(0, 3);
/// const H: Span = Span::new(3, 2);
/// const O: Span = Span::new(5, 1);
/// const GROUPS: [Group; 3] = [
///     Group::new(3, Activation::Linear),
///     Group::new(2, Activation::Tanh).with_biases(),
///     Group::new(1, Activation::Logistic).with_biases(),
/// ];
/// const BLOCKS: [Block; 6] = [
///     Block::Update(X),
///     Block::connect(X, H),
///     Block::connect(H, H).delayed(1),
///     Block::Update(H),
///     Block::connect(Span::new(0, 5), O),
///     Block::Update(O),
/// ];
/// const LAYOUT: BlockLayout = BlockLayout::new(3, 1, &GROUPS, &BLOCKS);
/// assert_eq!(LAYOUT.parameter_count(), 3 * 2 + 2 * 2 + 5 * 1 + 3);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlockLayout<'a> {
    inputs: usize,
    outputs: usize,
    groups: &'a [Group],
    blocks: &'a [Block],
}

impl<'a> BlockLayout<'a> {
    /// Creates a layout.
    ///
    /// The neurons are checked by [`BlockNetwork::new`](crate::block::BlockNetwork::new).
    pub const fn new(inputs: usize, outputs: usize, groups: &'a [Group], blocks: &'a [Block]) -> Self {
        Self { inputs, outputs, groups, blocks }
    }

    /// Gets the number of inputs.
    pub const fn inputs(&self) -> usize {
        self.inputs
    }

    /// Gets the number of outputs.
    pub const fn outputs(&self) -> usize {
        self.outputs
    }

    /// Gets the groups of neurons.
    pub const fn groups(&self) -> &'a [Group] {
        self.groups
    }

    /// Gets the blocks in the order of their evaluation.
    pub const fn blocks(&self) -> &'a [Block] {
        self.blocks
    }

    /// Returns the number of neurons, including inputs and outputs.
    pub const fn neurons(&self) -> usize {
        self.count(None)
    }

    /// Returns the number of parameters.
    pub const fn parameter_count(&self) -> usize {
        self.range(BlockParameter::Leak).end
    }

    /// Returns the length of the state. There are six values per neuron. Each delayed connection adds one value, and
    /// one for each source and step of delay.
    ///
    /// The state contains the activations `[neurons]`, the stored responses of [`Leak::TwoTap`](crate::Leak::TwoTap)
    /// `[neurons]` and four workspaces `[neurons]`. They are followed by the index of the oldest value and the delayed
    /// values `[delay x sources]` of each delayed block.
    pub const fn state_len(&self) -> usize {
        let (mut len, mut b) = (self.neurons().saturating_mul(6), 0);
        while b < self.blocks.len() {
            len = len.saturating_add(self.blocks[b].memory());
            b += 1;
        }
        len
    }

    /// Returns the indices of all parameters of a kind.
    pub const fn range(&self, kind: BlockParameter) -> Range<usize> {
        let (mut weights, mut b) = (0_usize, 0);
        while b < self.blocks.len() {
            weights = weights.saturating_add(self.blocks[b].weights());
            b += 1;
        }
        let biases = weights.saturating_add(self.count(Some(BlockParameter::Bias)));
        let gains = biases.saturating_add(self.count(Some(BlockParameter::Gain)));
        let leaks = gains.saturating_add(self.count(Some(BlockParameter::Leak)));
        match kind {
            BlockParameter::Weight => 0..weights,
            BlockParameter::Bias => weights..biases,
            BlockParameter::Gain => biases..gains,
            BlockParameter::Leak => gains..leaks,
        }
    }

    /// Returns the kind of the parameter at the given index, or `None` if there is no such parameter.
    pub fn kind(&self, index: usize) -> Option<BlockParameter> {
        BlockParameter::ALL.into_iter().find(|&kind| self.range(kind).contains(&index))
    }

    /// Returns an iterator over the kinds of all parameters. This is useful for decoding a genome.
    pub fn kinds(&self) -> impl Iterator<Item = BlockParameter> + use<'a> {
        let layout = *self;
        BlockParameter::ALL.into_iter().flat_map(move |kind| core::iter::repeat_n(kind, layout.range(kind).len()))
    }

    /// Returns the indices of the weights from one neuron to another. There is one index for each connection that
    /// contains both neurons.
    ///
    /// To cut the link between the two neurons, set these weights to zero.
    pub fn weights(&self, from: usize, to: usize) -> impl Iterator<Item = usize> + use<'a> {
        self.connections().filter_map(move |(at, sources, targets)| {
            let both = sources.contains(from) && targets.contains(to);
            both.then(|| at + (from - sources.first) * targets.count + (to - targets.first))
        })
    }

    /// Every connection: its first weight, its sources, its targets.
    pub(crate) fn connections(&self) -> impl Iterator<Item = (usize, Span, Span)> + use<'a> {
        let mut next = 0_usize;
        self.blocks.iter().filter_map(move |block| {
            let at = next;
            next = next.saturating_add(block.weights());
            if let Block::Connect { from, to, .. } = *block { Some((at, from, to)) } else { None }
        })
    }

    /// The neurons that have a parameter of this kind, with its index.
    pub(crate) fn neurons_with(&self, kind: BlockParameter) -> impl Iterator<Item = (usize, usize)> + use<'a> {
        let mut first = 0_usize;
        let groups = self.groups.iter().flat_map(move |group| {
            let neurons = first..first.saturating_add(group.neurons);
            first = neurons.end;
            if has(group, kind) { neurons } else { 0..0 }
        });
        groups.zip(self.range(kind))
    }

    /// Lists the groups with their neurons, and the index of the first bias, gain and leak among those of their kind.
    pub fn places(&self) -> impl Iterator<Item = (&'a Group, Span, [usize; 3])> + use<'a> {
        let (mut first, mut places) = (0_usize, [0_usize; 3]);
        self.groups.iter().map(move |group| {
            let at = (group, Span::new(first, group.neurons), places);
            first = at.1.end();
            for (place, has) in places.iter_mut().zip([group.bias, group.gain, group.leak]) {
                *place = place.saturating_add(if has { group.neurons } else { 0 });
            }
            at
        })
    }

    /// Number of all neurons, or of neurons with a parameter of this kind.
    const fn count(&self, kind: Option<BlockParameter>) -> usize {
        let (mut count, mut g) = (0_usize, 0);
        while g < self.groups.len() {
            let counts = match kind {
                Some(kind) => has(&self.groups[g], kind),
                None => true,
            };
            if counts {
                count = count.saturating_add(self.groups[g].neurons);
            }
            g += 1;
        }
        count
    }

    /// Checks that all neurons of the description exist.
    pub(crate) fn check(&self) -> Result<(), Error> {
        check_description(self.inputs, self.outputs, self.groups.iter().copied(), self.blocks.iter().copied())
    }
}

/// Checks that all neurons of a description exist.
pub(crate) fn check_description(
    inputs: usize,
    outputs: usize,
    mut groups: impl Iterator<Item = Group> + Clone,
    blocks: impl Iterator<Item = Block>,
) -> Result<(), Error> {
    let neurons = groups.clone().fold(0_usize, |sum, group| sum.saturating_add(group.neurons));
    if let Some(group) = groups.find(|group| !group.slope.is_finite()) {
        return Err(LayoutFault::Slope(group.slope).into());
    }
    let ends = inputs.saturating_add(outputs);
    if ends > neurons {
        return Err(LayoutFault::Neurons { first: 0, count: ends, neurons }.into());
    }
    for (index, block) in blocks.enumerate() {
        if let Some(span) = block.spans().into_iter().find(|span| span.end() > neurons) {
            return Err(LayoutFault::Block { index, first: span.first, count: span.count, neurons }.into());
        }
    }
    Ok(())
}

/// Returns true if the neurons of a group have a parameter of this kind.
const fn has(group: &Group, kind: BlockParameter) -> bool {
    match kind {
        BlockParameter::Weight => false,
        BlockParameter::Bias => group.bias,
        BlockParameter::Gain => group.gain,
        BlockParameter::Leak => group.leak,
    }
}
