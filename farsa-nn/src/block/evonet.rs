//! Conversion of the parameters of Evonet, the network of the original program.

use crate::block::description::Block;
use crate::block::layout::{BlockLayout, BlockParameter};
use crate::error::Error;
use crate::fault::Slice;

/// The ranges of the parameters in Evonet. Each parameter is stored as a number `p` in [-weight, weight].
///
/// Source: `[FARSA2]`, where the names are `weightRange`, `biasRange` and `gainRange`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct EvonetRanges {
    /// Largest absolute value of a weight.
    pub weight: f32,
    /// Largest absolute value of a bias.
    pub bias: f32,
    /// Largest gain of a neuron.
    pub gain: f32,
}

impl Default for EvonetRanges {
    /// Returns a range of 5 for all parameters, as in the source.
    fn default() -> Self {
        Self { weight: 5.0, bias: 5.0, gain: 5.0 }
    }
}

impl EvonetRanges {
    /// Converts a gene [0..255] to the number `p` by `weight - 2*weight*gene/255`. Gene 0 results in the largest
    /// number.
    ///
    /// ```
    /// use farsa_nn::block::EvonetRanges;
    ///
    /// assert_eq!([0, 51, 255].map(|gene| EvonetRanges::default().read_gene(gene)), [5.0, 3.0, -5.0]);
    /// ```
    pub fn read_gene(self, gene: u8) -> f32 {
        self.weight - f32::from(gene) / 255.0 * self.weight * 2.0
    }

    /// Converts a number `p` to a parameter. A weight is `p`, a bias is `p/weight*bias`, a gain is `|p|/weight*gain`,
    /// and a leak is `|p|/weight` clamped to [0, 1].
    ///
    /// Deviation: the source does not clamp the leak, but the activations that result from a leak larger than 1.
    pub fn decode(self, kind: BlockParameter, p: f32) -> f32 {
        match kind {
            BlockParameter::Weight => p,
            BlockParameter::Bias => p / self.weight * self.bias,
            BlockParameter::Gain => p.abs() / self.weight * self.gain,
            BlockParameter::Leak => (p.abs() / self.weight).clamp(0.0, 1.0),
        }
    }
}

impl<'a> BlockLayout<'a> {
    /// Returns the indices of the parameters in the order of the original program.
    ///
    /// Gains come first, followed by biases. After them, each block contributes the weights of a connection, ordered by
    /// target, or the leaks of an update. If each leaky neuron is updated once per step, every parameter occurs exactly
    /// once.
    ///
    /// Source: Evonet of `[FARSA2]`.
    ///
    /// ```
    /// use farsa_nn::block::{Architecture, BlockPlan};
    ///
    /// // Discrimination: six sensors, two outputs. The biases are first, then the weights of each output.
    /// const PLAN: BlockPlan = Architecture::feed_forward(6, 0, 2).plan();
    /// assert!(PLAN.layout().evonet_order().eq([12, 13, 0, 2, 4, 6, 8, 10, 1, 3, 5, 7, 9, 11]));
    /// ```
    pub fn evonet_order(&self) -> impl Iterator<Item = usize> + use<'a> {
        let layout = *self;
        let flags = self.range(BlockParameter::Gain).chain(self.range(BlockParameter::Bias));
        let mut next = 0;
        let blocks = self.blocks().iter().flat_map(move |block| {
            let at = next;
            next += block.weights();
            let (weights, targets) = match block {
                Block::Connect { to, .. } => (block.weights(), to.count),
                _ => (0, 1),
            };
            // The k-th is that of target k / sources from source k % sources.
            let sources = weights.checked_div(targets).unwrap_or(0).max(1);
            let weights = (0..weights).map(move |k| at + (k % sources) * targets + k / sources);
            let updated =
                move |(neuron, _): &(usize, usize)| matches!(block, Block::Update(span) if span.contains(*neuron));
            let leaks = layout.neurons_with(BlockParameter::Leak).filter(updated).map(|(_, index)| index);
            weights.chain(leaks)
        });
        flags.chain(blocks)
    }

    /// Converts numbers in the order of the original program to parameters. They are written to a slice of length
    /// [`parameter_count`](Self::parameter_count).
    ///
    /// # Errors
    /// Returns [`Error::Length`] if one of the slices has the wrong length. In this case some parameters may have been
    /// written.
    pub fn read_evonet(
        &self,
        ranges: EvonetRanges,
        numbers: impl IntoIterator<Item = f32>,
        parameters: &mut [f32],
    ) -> Result<(), Error> {
        let expected = self.parameter_count();
        Slice::Parameters.check(expected, parameters.len())?;
        let (mut numbers, mut found) = (numbers.into_iter(), 0);
        for (index, p) in self.evonet_order().zip(&mut numbers) {
            if let (Some(to), Some(kind)) = (parameters.get_mut(index), self.kind(index)) {
                *to = ranges.decode(kind, p);
            }
            found += 1;
        }
        found += numbers.count();
        Slice::Parameters.check(expected, found)
    }
}
