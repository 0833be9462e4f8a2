//! Abilities that a world must have for a robot with joints.

use farsa_body::Pose;
use farsa_body::ports::{
    Actuated, ActuatorId, Arrange, BodyId, Contacts, Handles, JointId, Joints, Kinematics, Vision,
};
use farsa_num::Stream;
use farsa_physics::articulated::{Lane, World};

use crate::part::object::{SpatialEnd, SpatialMotor, SpatialSensor, SpatialStart, SpatialTerm};
use crate::part::{Moment, Spot, Start};

/// A world of bodies with joints, in space.
pub(crate) trait SpatialWorld:
    Kinematics
    + Joints
    + Actuated
    + Contacts
    + Arrange
    + Vision
    + Handles<Body = BodyId, Joint = JointId, Actuator = ActuatorId>
{
    /// Reads a registered sensor.
    fn sense(&self, sensor: &mut dyn SpatialSensor, out: &mut [f32]);
    /// Drives a registered motor.
    fn drive(&mut self, motor: &mut dyn SpatialMotor, y: &[f32]);
    /// Begins a registered term.
    fn begin(&self, term: &mut dyn SpatialTerm, now: &Moment<'_>);
    /// Updates a registered term after a step.
    fn step_term(&self, term: &mut dyn SpatialTerm, now: &Moment<'_>);
    /// Computes a registered term.
    fn value(&self, term: &dyn SpatialTerm, now: &Moment<'_>) -> f64;
    /// Asks a registered end.
    fn ends(&self, end: &dyn SpatialEnd, now: &Moment<'_>, success: bool) -> bool;
    /// Draws the position of a joint by a registered placement.
    fn draw_position(&self, start: &dyn SpatialStart, stream: &mut Stream) -> Option<f32>;
    /// Draws the position and speed of a joint around a posture by a registered placement.
    fn draw_around(&self, start: &dyn SpatialStart, position: f32, stream: &mut Stream) -> Option<[f32; 2]>;
    /// Draws a pose by a registered placement.
    fn draw(&self, start: &dyn SpatialStart, spot: &mut Spot<'_>, stream: &mut Stream) -> Option<Pose>;
}

/// Implements the abilities for registered parts.
macro_rules! registered_parts {
    () => {
        fn sense(&self, sensor: &mut dyn SpatialSensor, out: &mut [f32]) {
            sensor.read(self, out);
        }
        fn drive(&mut self, motor: &mut dyn SpatialMotor, y: &[f32]) {
            motor.drive(y, self);
        }
        fn begin(&self, term: &mut dyn SpatialTerm, now: &Moment<'_>) {
            term.start(self, now);
        }
        fn step_term(&self, term: &mut dyn SpatialTerm, now: &Moment<'_>) {
            term.step(self, now);
        }
        fn value(&self, term: &dyn SpatialTerm, now: &Moment<'_>) -> f64 {
            term.value(self, now)
        }
        fn ends(&self, end: &dyn SpatialEnd, now: &Moment<'_>, success: bool) -> bool {
            end.ends(self, now, success)
        }
        fn draw_position(&self, start: &dyn SpatialStart, stream: &mut Stream) -> Option<f32> {
            Start::<Self>::position(start, stream)
        }
        fn draw_around(&self, start: &dyn SpatialStart, position: f32, stream: &mut Stream) -> Option<[f32; 2]> {
            Start::<Self>::around(start, position, stream)
        }
        fn draw(&self, start: &dyn SpatialStart, spot: &mut Spot<'_>, stream: &mut Stream) -> Option<Pose> {
            start.pose(self, spot, stream)
        }
    };
}

impl SpatialWorld for World<f32> {
    registered_parts!();
}

impl SpatialWorld for Lane<'_> {
    registered_parts!();
}

#[cfg(feature = "rapier")]
impl SpatialWorld for farsa_physics::rapier::World {
    registered_parts!();
}
