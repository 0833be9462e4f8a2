//! Block networks. They permit any connections between groups of neurons and any order of evaluation.

/// Common architectures as blocks.
mod architecture;
/// Groups of alike neurons, blocks and spans of neurons.
pub(crate) mod description;
/// The parameter order of the original's Evonet.
mod evonet;
/// The text format of the original's networks.
#[cfg(feature = "alloc")]
mod evonet_text;
/// One step, over the lanes of a scalar.
mod kernel;
/// The borrowed layout: the place of each parameter.
pub(crate) mod layout;
/// The owned layout, built at run time.
#[cfg(feature = "alloc")]
pub(crate) mod layout_buf;
/// The network: parameters, state, steps.
pub(crate) mod network;

pub use architecture::{Architecture, BlockPlan};
pub use description::{Block, Group, Span};
pub use evonet::EvonetRanges;
#[cfg(feature = "alloc")]
pub use evonet_text::Evonet;
pub use layout::{BlockLayout, BlockParameter};
#[cfg(feature = "alloc")]
pub use layout_buf::BlockLayoutBuf;
pub use network::BlockNetwork;
