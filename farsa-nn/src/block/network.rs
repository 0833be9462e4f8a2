//! The network of blocks.

use core::ops::Range;

use farsa_num::Instructions;
use farsa_num::fearless_simd::Level;

use crate::block::kernel::Blocks;
use crate::block::layout::{BlockLayout, BlockParameter};
use crate::controller::Controller;
use crate::error::Error;
use crate::kernel::{self, level};
use crate::leak::Leak;
use crate::lesion::{Ablatable, Lesion};

/// A network of connections, updates and gains in any order, over parameters and state that are the caller's.
///
/// In each step net inputs begin at the biases and gains at their parameters; then the blocks are worked through. With
/// activations `a`, gains `g`, weights `w`, functions `f` with slopes `s`, and the reading of the leak that [`Leak`] names:
///
/// ```text
/// connect        net_i = net_i + sum_j w_ji g_j a_j
/// update         y_i = f_i( s_i net_i ), or the input        a_i = d_i*y_i + (1-d_i)*(a_i or y_i of before), or as Evonet
/// gain           g_i = g_first
/// modulated gain g_i = a_by
/// ```
///
/// Feed-forward, Elman's, Jordan's and fully recurrent networks are orders of blocks ([`Architecture`](crate::block::Architecture)).
/// Activations are zero at the start. A NaN or infinite input is the caller's mistake, as in a
/// [`LeakyNetwork`](crate::LeakyNetwork), whose bits this one has where the blocks are the same.
///
/// Source: Evonet, the controller of `[FARSA2]`. Deviations: the order of the parameters, which
/// [`BlockLayout::read_evonet`] reads; other functions, slopes, delays and readings of the leak; leaky inputs are not
/// clamped to [0, 1].
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
#[derive(Clone, Debug)]
pub struct BlockNetwork<'a, P, S> {
    layout: BlockLayout<'a>,
    leak: Leak,
    parameters: P,
    state: S,
    level: Level,
}

impl<'a, P: AsRef<[f32]>, S: AsMut<[f32]>> BlockNetwork<'a, P, S> {
    /// A network at rest: checks the layout, the parameters [[`parameter_count`](BlockLayout::parameter_count)] and zeroes
    /// the state [[`state_len`](BlockLayout::state_len)].
    ///
    /// # Errors
    /// [`Error::Slope`], [`Error::Neurons`], [`Error::Block`], [`Error::ParameterCount`], [`Error::NotFinite`],
    /// [`Error::LeakRange`] or [`Error::StateLen`]: the first that applies, and of the parameters the first that is wrong.
    pub fn new(layout: BlockLayout<'a>, leak: Leak, parameters: P, mut state: S) -> Result<Self, Error> {
        layout.check()?;
        check(&layout, parameters.as_ref())?;
        let (expected, found) = (layout.state_len(), state.as_mut().len());
        if expected != found {
            return Err(Error::StateLen { expected, found });
        }
        state.as_mut().fill(0.0);
        Ok(Self { layout, leak, parameters, state, level: level() })
    }

    /// Points the network at other parameters [[`parameter_count`](BlockLayout::parameter_count)] and returns the old ones;
    /// the state stays as it is.
    ///
    /// # Errors
    /// [`Error::ParameterCount`], [`Error::NotFinite`] or [`Error::LeakRange`]; then the network is unchanged.
    pub fn set_parameters(&mut self, parameters: P) -> Result<P, Error> {
        check(&self.layout, parameters.as_ref())?;
        Ok(core::mem::replace(&mut self.parameters, parameters))
    }

    /// Copies other parameters [[`parameter_count`](BlockLayout::parameter_count)] over the network's own; the state stays
    /// as it is.
    ///
    /// # Errors
    /// [`Error::ParameterCount`], [`Error::NotFinite`] or [`Error::LeakRange`]; then the network is unchanged.
    pub fn copy_parameters(&mut self, parameters: &[f32]) -> Result<(), Error>
    where
        P: AsMut<[f32]>,
    {
        check(&self.layout, parameters)?;
        for (own, new) in self.parameters.as_mut().iter_mut().zip(parameters) {
            *own = *new;
        }
        Ok(())
    }

    /// The parameters [[`parameter_count`](BlockLayout::parameter_count)].
    pub fn parameters(&self) -> &[f32] {
        self.parameters.as_ref()
    }
}

impl<'a, P, S> BlockNetwork<'a, P, S> {
    /// The same network over these instructions, as
    /// [`LeakyNetwork::with_instructions`](crate::LeakyNetwork::with_instructions).
    pub fn with_instructions(self, instructions: Instructions) -> Self {
        Self { level: instructions.level(), ..self }
    }

    /// The layout.
    pub const fn layout(&self) -> BlockLayout<'a> {
        self.layout
    }

    /// The reading of the leak.
    pub const fn leak(&self) -> Leak {
        self.leak
    }

    /// Gives parameters and state back.
    pub fn into_parts(self) -> (P, S) {
        (self.parameters, self.state)
    }

    /// The activations of all neurons `[neurons]`, inputs and outputs among them.
    pub fn activations(&self) -> &[f32]
    where
        S: AsRef<[f32]>,
    {
        let state = self.state.as_ref();
        state.get(..self.layout.neurons()).unwrap_or(state)
    }
}

impl<P: AsRef<[f32]>, S: AsMut<[f32]>> Controller for BlockNetwork<'_, P, S> {
    fn inputs(&self) -> usize {
        self.layout.inputs()
    }

    fn outputs(&self) -> usize {
        self.layout.outputs()
    }

    fn reset(&mut self) {
        self.state.as_mut().fill(0.0);
    }

    fn step(&mut self, x: &[f32], y: &mut [f32]) {
        self.step_ablated(&[], x, y);
    }
}

/// Neurons have their numbers in the layout, inputs first; one is held from the beginning of a step and after its updates.
impl<P: AsRef<[f32]>, S: AsMut<[f32]>> Ablatable for BlockNetwork<'_, P, S> {
    fn neurons(&self) -> usize {
        self.layout.neurons()
    }

    fn step_ablated(&mut self, lesions: &[Lesion], x: &[f32], y: &mut [f32]) {
        debug_assert_eq!(x.len(), self.layout.inputs(), "sensor values and the layout's inputs");
        debug_assert_eq!(y.len(), self.layout.outputs(), "motor values and the layout's outputs");
        let level = self.level;
        let Some(mut blocks) = self.blocks(lesions, x) else { return };
        kernel::step(&mut blocks, level);
        let outputs = blocks.activations.len() - blocks.layout.outputs().min(blocks.activations.len());
        y.iter_mut().zip(blocks.activations.iter().skip(outputs)).for_each(|(y, a)| *y = *a);
    }
}

impl<P: AsRef<[f32]>, S: AsMut<[f32]>> BlockNetwork<'_, P, S> {
    /// Cuts parameters and state as a step wants them; `None` where one of them is too short.
    fn blocks<'b>(&'b mut self, lesions: &'b [Lesion], x: &'b [f32]) -> Option<Blocks<'b>> {
        let neurons = self.layout.neurons();
        let (activations, state) = self.state.as_mut().split_at_mut_checked(neurons)?;
        let (previous, state) = state.split_at_mut_checked(neurons)?;
        let (net, state) = state.split_at_mut_checked(neurons)?;
        let (gains, state) = state.split_at_mut_checked(neurons)?;
        let (sent, state) = state.split_at_mut_checked(neurons)?;
        let (work, delays) = state.split_at_mut_checked(neurons)?;
        let (layout, leak, parameters) = (self.layout, self.leak, self.parameters.as_ref());
        Some(Blocks { layout, leak, parameters, lesions, x, activations, previous, net, gains, sent, work, delays })
    }
}

fn check(layout: &BlockLayout<'_>, parameters: &[f32]) -> Result<(), Error> {
    check_values(layout.range(BlockParameter::Leak), parameters.iter().copied())
}

/// Whether these are the parameters of a layout whose last ones are these leaks.
pub(crate) fn check_values(
    leaks: Range<usize>,
    parameters: impl ExactSizeIterator<Item = f32> + Clone,
) -> Result<(), Error> {
    let (expected, found) = (leaks.end, parameters.len());
    if expected != found {
        return Err(Error::ParameterCount { expected, found });
    }
    if let Some(index) = parameters.clone().position(|p| !p.is_finite()) {
        return Err(Error::NotFinite { index });
    }
    match leaks.clone().zip(parameters.skip(leaks.start)).find(|(_, leak)| !(0.0..=1.0).contains(leak)) {
        Some((index, value)) => Err(Error::LeakRange { index, value }),
        None => Ok(()),
    }
}
