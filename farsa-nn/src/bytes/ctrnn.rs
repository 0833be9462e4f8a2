//! A trained continuous-time network as bytes.

use crate::activation::Activation;
use crate::bytes::error::BytesError;
use crate::bytes::frame::{
    Frame, Kind, SHAPE, copy, frame_len, layout_hash, placed, same_channels, same_layout, values, word,
};
use crate::ctrnn::integrator::Integrator;
use crate::ctrnn::layout::CtrnnLayout;
use crate::ctrnn::network::{check, check_layout, check_values};

/// A [`Ctrnn`](crate::Ctrnn) of given bytes, as [`LeakyNetworkBytes`](crate::bytes::LeakyNetworkBytes) are a
/// `LeakyNetwork`: checked, and used where it lies.
///
/// The time step is part of the layout: a board whose steps are longer is another.
///
/// ```
/// use farsa_nn::bytes::{Aligned, CtrnnBytes};
/// use farsa_nn::{Controller, Ctrnn, CtrnnLayout};
///
/// const LAYOUT: CtrnnLayout = CtrnnLayout::new(1, 2, 1);
/// const TIME_STEP: f32 = 0.01;
/// # fn main() -> Result<(), farsa_nn::bytes::BytesError> {
/// // A computer writes: weights, then biases, gains and time constants;
/// let parameters = [1.0, 0.0, 4.5, -1.0, 1.0, 4.5, -2.75, -1.75, 1.0, 1.0, 0.1, 0.1];
/// let mut flash = Aligned([0; CtrnnBytes::byte_count(LAYOUT)]);
/// CtrnnBytes::write(LAYOUT, TIME_STEP, 0, &parameters, &mut flash.0)?;
/// // a board reads: nothing is copied.
/// let bytes = CtrnnBytes::read(&flash.0)?;
/// bytes.expect(LAYOUT, TIME_STEP)?;
/// let mut network = Ctrnn::new(LAYOUT, TIME_STEP, bytes.parameters()?, [0.0; LAYOUT.state_len()])?;
/// let mut y = [0.0];
/// network.step(&[0.5], &mut y);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct CtrnnBytes<'a> {
    layout: CtrnnLayout,
    time_step: f32,
    channels: u64,
    parameters: &'a [u8],
}

impl CtrnnBytes<'_> {
    /// Number of bytes of a network of this layout; saturates.
    pub const fn byte_count(layout: CtrnnLayout) -> usize {
        frame_len(layout.parameter_count().saturating_mul(4))
    }

    /// Fills `out` [[`byte_count`](Self::byte_count)] with a network.
    ///
    /// `channels` says what inputs and outputs are, by [`channel_hash`](crate::bytes::channel_hash); 0 says nothing.
    ///
    /// # Errors
    /// [`BytesError::Parameters`] as [`Ctrnn::new`](crate::Ctrnn::new), [`BytesError::Buffer`]; then nothing is written.
    pub fn write(
        layout: CtrnnLayout,
        time_step: f32,
        channels: u64,
        parameters: &[f32],
        out: &mut [u8],
    ) -> Result<(), BytesError> {
        check_layout(&layout, time_step)?;
        check(&layout, time_step, parameters)?;
        let numbers = parameters.iter().map(|p| p.to_le_bytes());
        Frame::write(Kind::Ctrnn, &shape_of(layout, time_step), channels, numbers, out)
    }

    /// The layout hash: of the layout with integrator and activation, and the time step.
    pub fn layout_hash(layout: CtrnnLayout, time_step: f32) -> u64 {
        layout_hash(Kind::Ctrnn, &shape_of(layout, time_step))
    }
}

impl<'a> CtrnnBytes<'a> {
    /// Checks bytes that should be a continuous-time network, all of them: the format, the checksum, the layout, the time step
    /// and every parameter.
    ///
    /// # Errors
    /// As [`LeakyNetworkBytes::read`](crate::LeakyNetworkBytes::read).
    pub fn read(bytes: &'a [u8]) -> Result<Self, BytesError> {
        let Frame { shape, channels, parameters, .. } = Frame::open(Kind::Ctrnn, bytes)?;
        let [inputs, neurons, outputs, direct, first_output, integrator, activation, time_step] = shape;
        let Some(&method) = Integrator::ALL.get(integrator as usize) else {
            return Err(BytesError::Shape { word: 5, found: integrator });
        };
        let Some(&function) = Activation::ALL.get(activation as usize) else {
            return Err(BytesError::Shape { word: 6, found: activation });
        };
        let mut layout = CtrnnLayout::new(inputs as usize, neurons as usize, outputs as usize)
            .with_outputs_from(first_output as usize)
            .with_integrator(method)
            .with_activation(function);
        if let Some(first) = direct.checked_sub(1) {
            layout = layout.with_direct_inputs(first as usize);
        }
        let time_step = f32::from_bits(time_step);
        check_layout(&layout, time_step)?;
        let found = bytes.len();
        if found != Self::byte_count(layout) {
            return Err(BytesError::Length { expected: Self::byte_count(layout), found });
        }
        check_values(&layout, time_step, values(parameters))?;
        Ok(Self { layout, time_step, channels, parameters })
    }

    /// Nothing, if the network is of this layout and this time step [s].
    ///
    /// # Errors
    /// [`BytesError::OtherLayout`].
    pub fn expect(&self, layout: CtrnnLayout, time_step: f32) -> Result<(), BytesError> {
        same_layout(CtrnnBytes::layout_hash(layout, time_step), CtrnnBytes::layout_hash(self.layout, self.time_step))
    }

    /// Nothing, if the network is for these channels, by their [`channel_hash`](crate::bytes::channel_hash).
    ///
    /// # Errors
    /// [`BytesError::OtherChannels`].
    pub fn expect_channels(&self, expected: u64) -> Result<(), BytesError> {
        same_channels(expected, self.channels)
    }

    /// The layout.
    pub const fn layout(&self) -> CtrnnLayout {
        self.layout
    }

    /// The time step [s].
    pub const fn time_step(&self) -> f32 {
        self.time_step
    }

    /// The [`channel_hash`](crate::bytes::channel_hash) of its inputs and outputs; 0 if nothing is said.
    pub const fn channels(&self) -> u64 {
        self.channels
    }

    /// The parameters [[`parameter_count`](CtrnnLayout::parameter_count)] where they lie.
    ///
    /// # Errors
    /// [`BytesError::Misaligned`] and [`BytesError::BigEndian`]; [`copy_parameters`](Self::copy_parameters) then does.
    pub fn parameters(&self) -> Result<&'a [f32], BytesError> {
        placed(self.parameters)
    }

    /// Copies the parameters into `out` [[`parameter_count`](CtrnnLayout::parameter_count)].
    ///
    /// # Errors
    /// [`BytesError::Buffer`]; then nothing is copied.
    pub fn copy_parameters(&self, out: &mut [f32]) -> Result<(), BytesError> {
        copy(values(self.parameters), out)
    }
}

fn shape_of(layout: CtrnnLayout, time_step: f32) -> [u32; SHAPE] {
    let [inputs, neurons, outputs] = [layout.inputs(), layout.neurons(), layout.outputs()].map(word);
    let direct = layout.direct_inputs().map_or(0, |neurons| word(neurons.start).saturating_add(1));
    let first_output = word(layout.output_neurons().start);
    let (integrator, activation) = (layout.integrator() as u32, layout.activation() as u32);
    [inputs, neurons, outputs, direct, first_output, integrator, activation, time_step.to_bits()]
}
