//! Block layouts created at run time.

use alloc::vec::Vec;

use crate::activation::Activation;
use crate::block::architecture::BlockPlan;
use crate::block::description::{Block, Group, Span};
use crate::block::layout::BlockLayout;

/// An owned version of [`BlockLayout`]. Requires the feature `alloc`.
///
/// ```
/// use farsa_nn::block::{BlockLayoutBuf, BlockNetwork};
/// use farsa_nn::{Controller, Leak};
///
/// let deep = BlockLayoutBuf::feed_forward(&[29, 20, 12, 23]);
/// let layout = deep.layout();
/// let parameters = vec![0.1; layout.parameter_count()];
/// let mut network = BlockNetwork::new(layout, Leak::Filter, parameters, vec![0.0; layout.state_len()])?;
/// let mut y = [0.0; 23];
/// network.step(&[0.5; 29], &mut y);
/// assert!(y[0] > 0.5);
/// # Ok::<(), farsa_nn::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BlockLayoutBuf {
    /// Number of inputs.
    pub inputs: usize,
    /// Number of outputs.
    pub outputs: usize,
    /// Groups of neurons.
    pub groups: Vec<Group>,
    /// Blocks in the order of their evaluation.
    pub blocks: Vec<Block>,
}

impl BlockLayoutBuf {
    /// Creates a feed-forward network with the given numbers of neurons per layer, from inputs to outputs. All layers
    /// except the inputs are logistic with a slope of 1 and have biases.
    pub fn feed_forward(layers: &[usize]) -> Self {
        let mut layout = Self {
            inputs: layers.first().copied().unwrap_or(0),
            outputs: layers.last().copied().unwrap_or(0),
            ..Self::default()
        };
        let mut last = Span::new(0, 0);
        for (index, &neurons) in layers.iter().enumerate() {
            let span = Span::new(last.end(), neurons);
            let group = match index {
                0 => Group::new(neurons, Activation::Linear),
                _ => Group::new(neurons, Activation::Logistic).with_biases(),
            };
            layout.groups.push(group);
            if index > 0 {
                layout.blocks.push(Block::connect(last, span));
            }
            layout.blocks.push(Block::Update(span));
            last = span;
        }
        layout
    }

    /// Returns a layout that borrows the groups and blocks.
    pub fn layout(&self) -> BlockLayout<'_> {
        BlockLayout::new(self.inputs, self.outputs, &self.groups, &self.blocks)
    }
}

impl From<BlockLayout<'_>> for BlockLayoutBuf {
    fn from(layout: BlockLayout<'_>) -> Self {
        Self {
            inputs: layout.inputs(),
            outputs: layout.outputs(),
            groups: layout.groups().to_vec(),
            blocks: layout.blocks().to_vec(),
        }
    }
}

impl From<BlockPlan> for BlockLayoutBuf {
    fn from(plan: BlockPlan) -> Self {
        plan.layout().into()
    }
}
