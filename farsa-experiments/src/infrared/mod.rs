//! Infrared sensors.
//!
//! - `settings`: which of the three models reads a robot's infrared sensors, as settings

pub(crate) mod settings;
