//! Wrappers: a sensor or motor around another one, which changes its values on the way.
//!
//! | to | take |
//! |---|---|
//! | add noise | [`Noisy`] with a [`Noise`] |
//! | pass values on some ticks later | [`Delayed`] |
//! | convert units, or keep to a range | [`Scaled`], [`Saturated`] |
//! | tell only whether a value is large | [`Thresholded`] |
//! | switch channels off | [`Lesioned`] |
//! | let channels get stuck | [`Stuck`] at a [`StuckAt`] |
//! | look at the last values without disturbing the sensor | [`Recorded`] |
//!
//! A wrapper works around sensors and motors alike, and around other wrappers. The innermost acts first on a sensor's
//! values, last on a motor's.

/// Values passed on later.
pub(crate) mod delayed;
/// Channels that are off or stuck.
pub(crate) mod faulty;
/// Random numbers added to every value.
pub(crate) mod noisy;
/// Gain and offset, saturation, a threshold, and nothing but a record.
pub(crate) mod scaled;
/// Code that the wrappers share.
pub(crate) mod wrap;

pub use delayed::Delayed;
pub use faulty::{Lesioned, Stuck, StuckAt};
pub use noisy::{Noise, Noisy};
pub use scaled::{Recorded, Saturated, Scaled, Thresholded};
