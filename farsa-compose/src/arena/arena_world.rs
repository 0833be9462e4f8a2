//! Abilities that a world must have for robots on wheels.

use farsa_lab::advanced::PlanarWorld;

use farsa_body::Pose;
use farsa_num::Stream;
use farsa_physics::arena::{Lane, World};

use crate::part::object::{PlanarEnd, PlanarMotor, PlanarSensor, PlanarStart, PlanarTerm};
use crate::part::{Moment, Spot};

/// A world of robots in a plane, in which registered parts work.
pub(crate) trait ArenaWorld: PlanarWorld {
    /// Reads a registered sensor.
    fn sense(&self, sensor: &mut dyn PlanarSensor, out: &mut [f32]);
    /// Drives a registered motor.
    fn drive(&mut self, motor: &mut dyn PlanarMotor, y: &[f32]);
    /// Begins a registered term.
    fn begin(&self, term: &mut dyn PlanarTerm, now: &Moment<'_>);
    /// Updates a registered term after a step.
    fn step_term(&self, term: &mut dyn PlanarTerm, now: &Moment<'_>);
    /// Computes a registered term.
    fn value(&self, term: &dyn PlanarTerm, now: &Moment<'_>) -> f64;
    /// Asks a registered end.
    fn ends(&self, end: &dyn PlanarEnd, now: &Moment<'_>, success: bool) -> bool;
    /// Draws a pose by a registered placement.
    fn draw(&self, start: &dyn PlanarStart, spot: &mut Spot<'_>, stream: &mut Stream) -> Option<Pose>;
}

macro_rules! arena_world {
    ($world:ty) => {
        impl ArenaWorld for $world {
            fn sense(&self, sensor: &mut dyn PlanarSensor, out: &mut [f32]) {
                sensor.read(self, out);
            }
            fn drive(&mut self, motor: &mut dyn PlanarMotor, y: &[f32]) {
                motor.drive(y, self);
            }
            fn begin(&self, term: &mut dyn PlanarTerm, now: &Moment<'_>) {
                term.start(self, now);
            }
            fn step_term(&self, term: &mut dyn PlanarTerm, now: &Moment<'_>) {
                term.step(self, now);
            }
            fn value(&self, term: &dyn PlanarTerm, now: &Moment<'_>) -> f64 {
                term.value(self, now)
            }
            fn ends(&self, end: &dyn PlanarEnd, now: &Moment<'_>, success: bool) -> bool {
                end.ends(self, now, success)
            }
            fn draw(&self, start: &dyn PlanarStart, spot: &mut Spot<'_>, stream: &mut Stream) -> Option<Pose> {
                start.pose(self, spot, stream)
            }
        }
    };
}
arena_world!(World);
arena_world!(Lane<'_>);
#[cfg(feature = "rapier")]
arena_world!(farsa_physics::rapier::ArenaWorld);
