//! A trained network as bytes: in flash, in a file, over a wire.

use crate::bytes::error::BytesError;
use crate::bytes::frame::{
    Frame, Kind, SHAPE, copy, frame_len, layout_hash, placed, same_channels, same_layout, values, word,
};
use crate::error::Error;
use crate::leak::Leak;
use crate::leaky_layout::LeakyLayout;
use crate::leaky_network::{check, check_values};

/// A [`LeakyNetwork`](crate::LeakyNetwork) of given bytes: checked, and used where it lies.
///
/// The format is written out in `docs/controller-format.md`: a head with a version, the layout and hashes, the parameters in
/// the order of the [`LeakyLayout`], a CRC-32. All of it is little-endian.
///
/// ```
/// use farsa_nn::bytes::{Aligned, LeakyNetworkBytes};
/// use farsa_nn::{Controller, Leak, LeakyLayout, LeakyNetwork};
///
/// const LAYOUT: LeakyLayout = LeakyLayout::new(2, 1, 1);
/// # fn main() -> Result<(), farsa_nn::bytes::BytesError> {
/// // A computer writes,
/// let mut flash = Aligned([0; LeakyNetworkBytes::byte_count(LAYOUT)]);
/// LeakyNetworkBytes::write(LAYOUT, Leak::Filter, 0, &[1.0, -1.0, 0.5, 3.0, 0.0, 0.5], &mut flash.0)?;
/// // a board reads: nothing is copied.
/// let bytes = LeakyNetworkBytes::read(&flash.0)?;
/// bytes.expect(LAYOUT, Leak::Filter)?;
/// let mut network = LeakyNetwork::new(LAYOUT, Leak::Filter, bytes.parameters()?, [0.0; LAYOUT.state_len()])?;
/// let mut y = [0.0];
/// network.step(&[0.5, 0.2], &mut y);
/// // Others may come later, as those of another individual.
/// network.set_parameters(LeakyNetworkBytes::read(&flash.0)?.parameters()?)?;
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct LeakyNetworkBytes<'a> {
    layout: LeakyLayout,
    leak: Leak,
    channels: u64,
    parameters: &'a [u8],
}

impl LeakyNetworkBytes<'_> {
    /// Number of bytes of a network of this layout; saturates.
    pub const fn byte_count(layout: LeakyLayout) -> usize {
        frame_len(layout.parameter_count().saturating_mul(4))
    }

    /// Fills `out` [[`byte_count`](Self::byte_count)] with a network.
    ///
    /// `channels` says what inputs and outputs are, by [`channel_hash`]; 0 says nothing.
    ///
    /// # Errors
    /// [`BytesError::Parameters`] as [`LeakyNetwork::new`](crate::LeakyNetwork::new), [`BytesError::Buffer`]; then
    /// nothing is written.
    pub fn write(
        layout: LeakyLayout,
        leak: Leak,
        channels: u64,
        parameters: &[f32],
        out: &mut [u8],
    ) -> Result<(), BytesError> {
        if !layout.slope().is_finite() {
            return Err(Error::Slope { value: layout.slope() }.into());
        }
        check(&layout, parameters)?;
        let words = parameters.iter().map(|p| p.to_le_bytes());
        Frame::write(Kind::LeakyNetwork, &shape_of(layout, leak), channels, words, out)
    }

    /// The layout hash: of the layout, its slope and the reading of the leak.
    pub fn layout_hash(layout: LeakyLayout, leak: Leak) -> u64 {
        layout_hash(Kind::LeakyNetwork, &shape_of(layout, leak))
    }
}

impl<'a> LeakyNetworkBytes<'a> {
    /// Checks bytes that should be a network, all of them: the format, the checksum, the layout and every parameter.
    ///
    /// # Errors
    /// What is wrong first: [`BytesError::Magic`], [`BytesError::Version`], [`BytesError::Length`],
    /// [`BytesError::Checksum`], [`BytesError::Kind`], [`BytesError::LayoutHash`], [`BytesError::Shape`],
    /// [`BytesError::Parameters`].
    pub fn read(bytes: &'a [u8]) -> Result<Self, BytesError> {
        let Frame { shape, channels, parameters, .. } = Frame::open(Kind::LeakyNetwork, bytes)?;
        let [sensors, hidden, outputs, slope, leak, unused @ ..] = shape;
        let Some(&reading) = Leak::ALL.get(leak as usize) else {
            return Err(BytesError::Shape { word: 4, found: leak });
        };
        if let Some(at) = unused.iter().position(|word| *word != 0) {
            return Err(BytesError::Shape { word: SHAPE - unused.len() + at, found: unused[at] });
        }
        let (slope, bits) = (f32::from_bits(slope), slope);
        if !slope.is_finite() {
            return Err(BytesError::Shape { word: 3, found: bits });
        }
        let layout = LeakyLayout::new(sensors as usize, hidden as usize, outputs as usize).with_slope(slope);
        let found = bytes.len();
        if found != Self::byte_count(layout) {
            return Err(BytesError::Length { expected: Self::byte_count(layout), found });
        }
        check_values(&layout, values(parameters))?;
        Ok(Self { layout, leak: reading, channels, parameters })
    }

    /// Nothing, if the network is of this layout and this reading of the leak.
    ///
    /// # Errors
    /// [`BytesError::OtherLayout`].
    pub fn expect(&self, layout: LeakyLayout, leak: Leak) -> Result<(), BytesError> {
        same_layout(
            LeakyNetworkBytes::layout_hash(layout, leak),
            LeakyNetworkBytes::layout_hash(self.layout, self.leak),
        )
    }

    /// Nothing, if the network is for these channels, by their [`channel_hash`].
    ///
    /// # Errors
    /// [`BytesError::OtherChannels`].
    pub fn expect_channels(&self, expected: u64) -> Result<(), BytesError> {
        same_channels(expected, self.channels)
    }

    /// The layout.
    pub const fn layout(&self) -> LeakyLayout {
        self.layout
    }

    /// The reading of the leak.
    pub const fn leak(&self) -> Leak {
        self.leak
    }

    /// The [`channel_hash`] of its inputs and outputs; 0 if nothing is said.
    pub const fn channels(&self) -> u64 {
        self.channels
    }

    /// The parameters [[`parameter_count`](LeakyLayout::parameter_count)] where they lie.
    ///
    /// # Errors
    /// [`BytesError::Misaligned`] and [`BytesError::BigEndian`]; [`copy_parameters`](Self::copy_parameters) then does.
    pub fn parameters(&self) -> Result<&'a [f32], BytesError> {
        placed(self.parameters)
    }

    /// Copies the parameters into `out` [[`parameter_count`](LeakyLayout::parameter_count)].
    ///
    /// # Errors
    /// [`BytesError::Buffer`]; then nothing is copied.
    pub fn copy_parameters(&self, out: &mut [f32]) -> Result<(), BytesError> {
        copy(values(self.parameters), out)
    }
}

fn shape_of(layout: LeakyLayout, leak: Leak) -> [u32; SHAPE] {
    let [sensors, hidden, outputs] = [layout.sensors(), layout.hidden(), layout.outputs()].map(word);
    [sensors, hidden, outputs, layout.slope().to_bits(), leak as u32, 0, 0, 0]
}
