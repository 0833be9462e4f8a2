//! Forces from outside that act during one control step.

use alloc::vec::Vec;

use rapier3d::dynamics::RigidBodyHandle;
use rapier3d::pipeline::PhysicsWorld;

/// The forces that wait for the next control step.
///
/// rapier keeps forces on a body until they are changed, so they are applied at the beginning of the step and removed
/// at its end.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pushes {
    all: Vec<Push>,
}

/// A force [N] at a point [m] of a body, in the world's axes.
#[derive(Clone, Copy, Debug)]
struct Push {
    body: RigidBodyHandle,
    point: [f32; 3],
    force: [f32; 3],
}

impl Pushes {
    /// One more. None that is zero, which would wake the body.
    pub(crate) fn add(&mut self, body: RigidBodyHandle, point: [f32; 3], force: [f32; 3]) {
        if force != [0.0; 3] {
            self.all.push(Push { body, point, force });
        }
    }

    /// Hands them over.
    pub(crate) fn begin(&self, physics: &mut PhysicsWorld) {
        for Push { body, point, force } in &self.all {
            if let Some(rigid) = physics.bodies.get_mut(*body) {
                rigid.add_force_at_point((*force).into(), (*point).into(), true);
            }
        }
    }

    /// Removes and discards them.
    pub(crate) fn end(&mut self, physics: &mut PhysicsWorld) {
        for Push { body, .. } in self.all.drain(..) {
            if let Some(rigid) = physics.bodies.get_mut(body) {
                rigid.reset_forces(false);
                rigid.reset_torques(false);
            }
        }
    }

    /// Discards them.
    pub(crate) fn clear(&mut self) {
        self.all.clear();
    }
}
