//! Lesions that set the activations of neurons to constant values.

use crate::controller::Controller;

/// A lesion that sets the activation of a neuron to a constant value.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Lesion {
    /// Index of the neuron.
    pub neuron: usize,
    /// Constant activation. A value of 0 silences the neuron.
    pub activation: f32,
}

impl Lesion {
    /// Creates a lesion that silences a neuron.
    pub const fn new(neuron: usize) -> Self {
        Self { neuron, activation: 0.0 }
    }
}

/// A network that supports lesions.
///
/// Each kind of network documents how its neurons are numbered. To cut a link instead of a neuron, set its weight to
/// zero.
pub trait Ablatable: Controller {
    /// Returns the number of neurons that can be lesioned.
    fn neurons(&self) -> usize;
    /// Advances the network like [`Controller::step`], but applies the given lesions. Lesions of neurons that do not
    /// exist are ignored.
    fn step_ablated(&mut self, lesions: &[Lesion], x: &[f32], y: &mut [f32]);
}

/// A network with lesions. This is useful for studying the role of individual neurons.
///
/// ```
/// use farsa_nn::{Controller, Ctrnn, CtrnnLayout, Lesion, Lesioned};
///
/// // The first neuron drives the second.
/// const LAYOUT: CtrnnLayout = CtrnnLayout::new(0, 2, 1);
/// let parameters = [0.0, 8.0, 0.0, 0.0, 0.0, -2.0, 1.0, 1.0, 1.0, 1.0];
/// let intact = Ctrnn::new(LAYOUT, 0.1, parameters, [0.0; LAYOUT.state_len()])?;
/// let lesions = [Lesion::new(0)];
/// let mut without = Lesioned::new(intact.clone(), &lesions);
/// let (mut intact, mut y, mut z) = (intact, [0.0], [0.0]);
/// for _ in 0..100 {
///     intact.step(&[], &mut y);
///     without.step(&[], &mut z);
/// }
/// assert!(y[0] > 0.8 && z[0] < 0.2);
/// # Ok::<(), farsa_nn::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Lesioned<'a, N> {
    network: N,
    lesions: &'a [Lesion],
}

impl<'a, N: Ablatable> Lesioned<'a, N> {
    /// Applies the given lesions to a network. They take effect in the next step.
    pub const fn new(network: N, lesions: &'a [Lesion]) -> Self {
        Self { network, lesions }
    }

    /// Replaces the lesions. The new ones take effect in the next step.
    pub const fn set_lesions(&mut self, lesions: &'a [Lesion]) {
        self.lesions = lesions;
    }

    /// Returns a reference to the network.
    pub const fn network(&self) -> &N {
        &self.network
    }

    /// Removes the lesions and returns the network.
    pub fn into_network(self) -> N {
        self.network
    }
}

impl<N: Ablatable> Controller for Lesioned<'_, N> {
    fn inputs(&self) -> usize {
        self.network.inputs()
    }

    fn outputs(&self) -> usize {
        self.network.outputs()
    }

    fn reset(&mut self) {
        self.network.reset();
    }

    fn step(&mut self, x: &[f32], y: &mut [f32]) {
        self.network.step_ablated(self.lesions, x, y);
    }
}

/// Overwrites the values of held neurons from number `first` on.
#[inline]
pub(crate) fn hold(lesions: &[Lesion], first: usize, values: &mut [f32]) {
    for lesion in lesions {
        if let Some(value) = lesion.neuron.checked_sub(first).and_then(|at| values.get_mut(at)) {
            *value = lesion.activation;
        }
    }
}
