//! Custom parts for experiment files.
//!
//! A part is a struct whose fields are the keys of the file. Its doc comments describe the keys in the schema, in
//! `farsa info` and in error messages. You register it under a name:
//!
//! ```
//! use farsa_body::ports::{BodyId, Channels, Handles, Kinematics, Sensor};
//! use farsa_compose::part::{self, PartScene, SensorPart};
//! use farsa_lab::{Error, Laboratory};
//! use schemars::JsonSchema;
//! use serde::{Deserialize, Serialize};
//!
//! /// Height of a body.
//! #[derive(Clone, Serialize, Deserialize, JsonSchema)]
//! struct Altitude {
//!     /// Height that reads 1 [m].
//!     #[schemars(range(min = 0.001, max = 100.0))]
//!     full: f64,
//! }
//!
//! #[derive(Clone)]
//! struct Altimeter(BodyId, f32);
//!
//! impl Channels for Altimeter {
//!     fn channels(&self) -> usize {
//!         1
//!     }
//! }
//! impl<W: Kinematics + Handles<Body = BodyId>> Sensor<W> for Altimeter {
//!     fn read(&mut self, world: &W, out: &mut [f32]) {
//!         out.iter_mut().zip([world.origin(self.0)[2] * self.1]).for_each(|(out, x)| *out = x);
//!     }
//! }
//! impl SensorPart for Altitude {
//!     type Sensor = Altimeter;
//!     fn sensor(&self, scene: &PartScene<'_>) -> Result<Altimeter, Error> {
//!         Ok(Altimeter(scene.body(None)?, 1.0 / self.full as f32))
//!     }
//! }
//!
//! let laboratory = Laboratory::new(&[]).with_files(farsa_compose::FILES);
//! let laboratory = laboratory.with_part(part::sensor::<Altitude>("altitude"));
//! # let _ = laboratory;
//! ```
//!
//! The name then works wherever a kind does, as in `sensors = [{ kind = "altitude", full = 2.0 }]`.

/// Definitions of parts by name and kind.
pub(crate) mod definition;
/// Rules that end a trial.
pub(crate) mod end;
/// Files of a document.
pub(crate) mod files;
/// Settings of a part.
mod keys;
/// Moments of a trial.
pub(crate) mod moment;
/// Motors.
pub(crate) mod motor;
/// A point of a body, or a marker.
pub(crate) mod named_point;
/// Networks.
pub(crate) mod network;
/// Parts of unknown types, in all worlds.
pub(crate) mod object;
/// Registration under names.
pub(crate) mod registration;
/// Scene in which a part is built.
pub(crate) mod scene;
/// Sensors.
pub(crate) mod sensor;
/// Bodies to be placed.
pub(crate) mod spot;
/// Placements.
pub(crate) mod start;
/// Terms of the fitness.
pub(crate) mod term;
/// Things.
pub(crate) mod thing;
/// Actuators of motors.
pub(crate) mod wiring;
/// Wrappers.
pub(crate) mod wrapper;

pub use end::{End, EndPart};
pub use keys::Keys;
pub use moment::Moment;
pub use motor::MotorPart;
pub use network::{NetworkEnds, NetworkPart, PartNetwork};
pub use object::{
    PlanarEnd, PlanarMotor, PlanarSensor, PlanarStart, PlanarTerm, SpatialEnd, SpatialMotor, SpatialSensor,
    SpatialStart, SpatialTerm,
};
pub use registration::{
    end, motor, network, planar_end, planar_motor, planar_sensor, planar_start, planar_term, robot_on_wheels,
    robot_with_joints, sensor, spatial_end, spatial_motor, spatial_sensor, spatial_start, spatial_term, start, term,
    thing, wrapper,
};
pub use scene::{Area, PartScene};
pub use sensor::{Quantity, SensorPart};
pub use spot::Spot;
pub use start::{Start, StartPart};
pub use term::{Term, TermPart};
pub use thing::ThingPart;
pub use wrapper::{Filter, WrapperPart};
