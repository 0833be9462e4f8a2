//! Networks of blocks: any connections between groups of neurons, worked through in a given order.

/// What such a network is described by: groups of alike neurons, blocks, spans of neurons.
pub(crate) mod description;
/// One step, over the lanes of a scalar.
mod kernel;
/// The layout: where each parameter lies, borrowed and `const`.
pub(crate) mod layout;
/// The same, owned and made at run time.
#[cfg(feature = "alloc")]
pub(crate) mod layout_buf;
/// The network: parameters, state, steps.
pub(crate) mod network;

pub use description::{Block, Group, Span};
pub use layout::{BlockLayout, BlockParameter};
#[cfg(feature = "alloc")]
pub use layout_buf::BlockLayoutBuf;
pub use network::BlockNetwork;
