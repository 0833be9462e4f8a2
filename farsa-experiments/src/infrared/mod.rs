//! Infrared sensors: their settings, and their rays to be drawn.
//!
//! - `sensor_rays`: Infrared sensors as rays to be drawn
//! - `settings`: which of the three models reads a robot's infrared sensors, as settings

pub(crate) mod sensor_rays;
pub(crate) mod settings;
