//! Wrappers that modify the values of sensors and motors.
//!
//! | to | use |
//! |---|---|
//! | add noise | [`Noisy`] with a [`Noise`] |
//! | pass values on some ticks later | [`Delayed`] |
//! | convert units, or keep to a range | [`Scaled`], [`Saturated`] |
//! | compare a value with a threshold | [`Thresholded`] |
//! | switch channels off | [`Lesioned`] |
//! | let channels get stuck | [`Stuck`] at a [`StuckAt`] |
//! | read the last values without disturbing the sensor | [`Recorded`] |
//!
//! Wrappers can be applied to sensors, motors and other wrappers. For sensors, the innermost wrapper modifies the
//! values first. For motors, it modifies them last.

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
