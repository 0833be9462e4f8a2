//! The binary format of continuous-time networks.

use crate::activation::Activation;
use crate::bytes::error::BytesError;
use crate::bytes::frame::{Kind, SHAPE, variant, word};
use crate::bytes::network::{NetworkBytes, Shape, byte_count};
use crate::ctrnn::integrator::Integrator;
use crate::ctrnn::layout::CtrnnLayout;
use crate::ctrnn::network::CtrnnModel;
use crate::error::Error;
use crate::network::Model as _;

/// A [`Ctrnn`](crate::Ctrnn) in its binary format. The bytes have been checked.
///
/// Note that the time step is part of the layout. A board with a different time step needs a different network. For an
/// example, see [`LeakyNetworkBytes`](crate::bytes::LeakyNetworkBytes).
pub type CtrnnBytes<'a> = NetworkBytes<'a, CtrnnModel>;

impl NetworkBytes<'_, CtrnnModel> {
    /// Returns the number of bytes needed for a network with the given layout. The count saturates.
    pub const fn byte_count(layout: CtrnnLayout) -> usize {
        byte_count::<f32>(layout.parameter_count())
    }

    /// Writes a network to `out`. The length of `out` must be [`byte_count`](Self::byte_count).
    ///
    /// The argument `channels` is the [`channel_hash`](crate::bytes::channel_hash) of the inputs and outputs, or 0.
    ///
    /// # Errors
    /// Returns [`BytesError::Parameters`] if [`Ctrnn::new`](crate::Ctrnn::new) would fail, or [`BytesError::Buffer`].
    /// In these cases nothing is written.
    pub fn write(
        layout: CtrnnLayout,
        time_step: f32,
        channels: u64,
        parameters: &[f32],
        out: &mut [u8],
    ) -> Result<(), BytesError> {
        Shape::write(&CtrnnModel { layout, time_step }, channels, parameters, out)
    }

    /// Computes the hash of a layout, including its integrator and activation function, and of the time step.
    pub fn layout_hash(layout: CtrnnLayout, time_step: f32) -> u64 {
        CtrnnModel { layout, time_step }.hash()
    }

    /// Checks that the layout and the time step in seconds are those of the caller.
    ///
    /// # Errors
    /// Returns [`BytesError::Mismatch`] if they differ.
    pub fn expect(&self, layout: CtrnnLayout, time_step: f32) -> Result<(), BytesError> {
        self.expect_shape(&CtrnnModel { layout, time_step })
    }

    /// Gets the layout of the network.
    pub const fn layout(&self) -> CtrnnLayout {
        self.shape.layout
    }

    /// Gets the time step in seconds.
    pub const fn time_step(&self) -> f32 {
        self.shape.time_step
    }
}

impl<'a> Shape<'a> for CtrnnModel {
    type Number = f32;

    const KIND: Kind = Kind::Ctrnn;

    fn read(words: &[u32; SHAPE], content: &'a [u8]) -> Result<(Self, &'a [u8]), BytesError> {
        let [inputs, neurons, outputs, direct, first_output, integrator, activation, time_step] = *words;
        let integrator = variant(&Integrator::ALL, 5, integrator)?;
        let activation = variant(&Activation::ALL, 6, activation)?;
        let mut layout = CtrnnLayout::new(inputs as usize, neurons as usize, outputs as usize)
            .with_outputs_from(first_output as usize)
            .with_integrator(integrator)
            .with_activation(activation);
        if let Some(first) = direct.checked_sub(1) {
            layout = layout.with_direct_inputs(first as usize);
        }
        let model = Self { layout, time_step: f32::from_bits(time_step) };
        model.check_layout()?;
        Ok((model, content))
    }

    fn words(&self) -> [u32; SHAPE] {
        let layout = self.layout;
        let [inputs, neurons, outputs] = [layout.inputs(), layout.neurons(), layout.outputs()].map(word);
        let direct = layout.direct_inputs().map_or(0, |neurons| word(neurons.start).saturating_add(1));
        let first_output = word(layout.output_neurons().start);
        let (integrator, activation) = (layout.integrator() as u32, layout.activation() as u32);
        [inputs, neurons, outputs, direct, first_output, integrator, activation, self.time_step.to_bits()]
    }

    fn byte_count(&self) -> usize {
        NetworkBytes::<Self>::byte_count(self.layout)
    }

    fn check<T: Copy>(&self, parameters: &[T], value: impl Fn(T) -> f32 + Copy) -> Result<(), Error> {
        self.check_model(parameters, value)
    }
}
