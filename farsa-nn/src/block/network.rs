//! The block network.

use crate::block::kernel::Blocks;
use crate::block::layout::{BlockLayout, BlockParameter};
use crate::error::Error;
use crate::kernel;
use crate::leak::Leak;
use crate::lesion::Lesion;
use crate::network::{Data, Model, Network, check_parameters};

/// A network of connections and updates evaluated in a configurable order.
///
/// At the beginning of each step, the net inputs are set to the biases and the gains to their parameters. Then the
/// blocks are evaluated in order. With activations `a`, gains `g`, weights `w`, functions `f` with slopes `s`, and the
/// selected [`Leak`]:
///
/// ```text
/// connect        net_i = net_i + sum_j w_ji g_j a_j
/// update         y_i = f_i( s_i net_i ), or the input        a_i = d_i*y_i + (1-d_i)*(previous a_i or y_i), or as Evonet
/// gain           g_i = g_first
/// modulated gain g_i = a_by
/// ```
///
/// Feed-forward, Elman, Jordan and fully recurrent networks are special cases. You can create them with
/// [`Architecture`](crate::block::Architecture). All activations are initially zero. As in a
/// [`LeakyNetwork`](crate::LeakyNetwork), inputs must not be NaN or infinite. Networks with equal blocks produce equal
/// bits.
///
/// For lesions, neurons are numbered as in the layout, starting with the inputs. The activation of a lesioned neuron is
/// set at the beginning of a step and after each of its updates.
///
/// Source: Evonet, the controller of `[FARSA2]`. Deviations: the order of the parameters (see
/// [`BlockLayout::read_evonet`]), the additional functions, slopes, delays and variants of the leak, and leaky inputs,
/// which are not clamped to [0, 1].
///
/// ```
/// use farsa_nn::block::{Architecture, BlockLayout, BlockNetwork, BlockPlan};
/// use farsa_nn::{Controller, Leak};
///
/// const PLAN: BlockPlan = Architecture::elman(2, 3, 1).plan();
/// const LAYOUT: BlockLayout = PLAN.layout();
/// let parameters = [0.5; LAYOUT.parameter_count()];
/// let mut network = BlockNetwork::new(LAYOUT, Leak::Filter, parameters, [0.0; LAYOUT.state_len()])?;
/// let mut y = [0.0];
/// network.step(&[1.0, -1.0], &mut y);
/// let first = y;
/// network.step(&[1.0, -1.0], &mut y);
/// assert!(y > first);
/// # Ok::<(), farsa_nn::Error>(())
/// ```
pub type BlockNetwork<'a, P, S> = Network<BlockModel<'a>, P, S>;

/// The layout of a [`BlockNetwork`], together with the interpretation of its leaks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlockModel<'a> {
    pub(crate) layout: BlockLayout<'a>,
    pub(crate) leak: Leak,
}

impl<'a, P: AsRef<[f32]>, S: AsMut<[f32]>> Network<BlockModel<'a>, P, S> {
    /// Creates a network with the given parameters and resets its state to zero. The slices must have the lengths
    /// [`parameter_count`](BlockLayout::parameter_count) and [`state_len`](BlockLayout::state_len).
    ///
    /// # Errors
    /// Returns [`Error::Layout`], [`Error::Length`] or [`Error::Parameter`].
    pub fn new(layout: BlockLayout<'a>, leak: Leak, parameters: P, state: S) -> Result<Self, Error> {
        Self::at_rest(BlockModel { layout, leak }, parameters, state)
    }
}

impl<'a, P, S> Network<BlockModel<'a>, P, S> {
    /// Gets the layout of the network.
    pub const fn layout(&self) -> BlockLayout<'a> {
        self.model.layout
    }

    /// Gets the interpretation of the leaks.
    pub const fn leak(&self) -> Leak {
        self.model.leak
    }

    /// Returns the activations of all neurons, including inputs and outputs.
    pub fn activations(&self) -> &[f32]
    where
        S: AsRef<[f32]>,
    {
        let state = self.state.as_ref();
        state.get(..self.model.layout.neurons()).unwrap_or(state)
    }
}

impl Model for BlockModel<'_> {
    fn inputs(&self) -> usize {
        self.layout.inputs()
    }

    fn outputs(&self) -> usize {
        self.layout.outputs()
    }

    fn neurons(&self) -> usize {
        self.layout.neurons()
    }

    fn state_len(&self) -> usize {
        self.layout.state_len()
    }

    fn check_model<T: Copy>(&self, parameters: &[T], value: impl Fn(T) -> f32 + Copy) -> Result<(), Error> {
        self.layout.check()?;
        let leaks = self.layout.range(BlockParameter::Leak);
        check_parameters(leaks.end, leaks.start, parameters, value)
    }

    fn step(&self, data: Data<'_>, lesions: &[Lesion], x: &[f32], y: &mut [f32]) {
        let level = data.level;
        let Some(mut blocks) = self.blocks(data.parameters, data.state, lesions, x) else { return };
        kernel::step(&mut blocks, level);
        let outputs = blocks.activations.len() - self.layout.outputs().min(blocks.activations.len());
        y.iter_mut().zip(blocks.activations.iter().skip(outputs)).for_each(|(y, a)| *y = *a);
    }
}

impl BlockModel<'_> {
    /// Splits the state for a step. Returns `None` if it is too short.
    fn blocks<'b>(
        &'b self,
        parameters: &'b [f32],
        state: &'b mut [f32],
        lesions: &'b [Lesion],
        x: &'b [f32],
    ) -> Option<Blocks<'b>> {
        let neurons = self.layout.neurons();
        let (activations, state) = state.split_at_mut_checked(neurons)?;
        let (previous, state) = state.split_at_mut_checked(neurons)?;
        let (net, state) = state.split_at_mut_checked(neurons)?;
        let (gains, state) = state.split_at_mut_checked(neurons)?;
        let (sent, state) = state.split_at_mut_checked(neurons)?;
        let (work, delays) = state.split_at_mut_checked(neurons)?;
        let (layout, leak) = (self.layout, self.leak);
        Some(Blocks { layout, leak, parameters, lesions, x, activations, previous, net, gains, sent, work, delays })
    }
}
