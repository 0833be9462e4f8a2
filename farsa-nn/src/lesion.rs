//! Lesions: what a network does without a neuron.

use crate::controller::Controller;

/// A neuron that is held at an activation, whatever drives it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Lesion {
    /// The neuron's number.
    pub neuron: usize,
    /// What it is held at; 0 is silence.
    pub activation: f32,
}

impl Lesion {
    /// A silent neuron.
    pub const fn new(neuron: usize) -> Self {
        Self { neuron, activation: 0.0 }
    }
}

/// A network whose neurons can be held.
///
/// How neurons are numbered is said where the trait is implemented. To cut a link needs no trait: its weight is set to zero.
pub trait Ablatable: Controller {
    /// Number of neurons that can be held.
    fn neurons(&self) -> usize;
    /// Steps as [`Controller::step`] does with these neurons held; one that does not exist is passed over.
    fn step_ablated(&mut self, lesions: &[Lesion], x: &[f32], y: &mut [f32]);
}

/// A network with lesions, for studies of what its neurons are for.
///
/// ```
/// use farsa_nn::{Controller, Ctrnn, CtrnnLayout, Lesion, Lesioned};
///
/// // A neuron drives the next one.
/// const LAYOUT: CtrnnLayout = CtrnnLayout::new(0, 2, 1);
/// let parameters = [0.0, 8.0, 0.0, 0.0, 0.0, -2.0, 1.0, 1.0, 1.0, 1.0];
/// let whole = Ctrnn::new(LAYOUT, 0.1, parameters, [0.0; LAYOUT.state_len()])?;
/// let lesions = [Lesion::new(0)];
/// let mut without = Lesioned::new(whole.clone(), &lesions);
/// let (mut whole, mut y, mut z) = (whole, [0.0], [0.0]);
/// for _ in 0..100 {
///     whole.step(&[], &mut y);
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
    /// A network in which these neurons are held from the next step on.
    pub const fn new(network: N, lesions: &'a [Lesion]) -> Self {
        Self { network, lesions }
    }

    /// Other lesions from the next step on.
    pub const fn set_lesions(&mut self, lesions: &'a [Lesion]) {
        self.lesions = lesions;
    }

    /// The network.
    pub const fn network(&self) -> &N {
        &self.network
    }

    /// Gives the network back.
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

/// Overwrites the values that belong to neurons `first` and following where these are held.
pub(crate) fn hold(lesions: &[Lesion], first: usize, values: &mut [f32]) {
    for lesion in lesions {
        if let Some(value) = lesion.neuron.checked_sub(first).and_then(|at| values.get_mut(at)) {
            *value = lesion.activation;
        }
    }
}
