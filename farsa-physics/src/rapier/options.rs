//! Options for a world of rapier.

use rapier3d::dynamics::{FrictionModel, SpringCoefficients};
use rapier3d::pipeline::PhysicsWorld;

use crate::rapier::convert::vector;
use crate::rapier::error::RapierError;

/// Options for the simulation of a world in rapier.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct Options {
    /// Duration of a control step [s].
    pub time_step: f64,
    /// Steps of rapier per control step: how often contacts are looked for and actuators' laws evaluated.
    pub substeps: u32,
    /// Iterations of the solver per step of rapier, which divide it further: how often positions and joints advance.
    pub iterations: u32,
    /// Sweeps of the solver over contacts and stops in each iteration, with a push against overlap: from these follow places.
    pub sweeps: u32,
    /// Sweeps after those, without that push: from these follow speeds. Friction acts in them alone if there is one, else in all. A leg that
    /// leans on a light foot needs many.
    pub speed_sweeps: u32,
    /// Gravity [m/s2].
    pub gravity: [f64; 3],
    /// Typical size of the simulated things [m]. The tolerances of rapier are chosen relative to this.
    pub length_unit: f64,
    /// Natural frequency of contacts [Hz].
    pub contact_frequency: f64,
    /// Damping ratio of contacts.
    pub contact_damping: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            time_step: 0.01,
            substeps: 4,
            iterations: 1,
            sweeps: 1,
            speed_sweeps: 1,
            gravity: [0.0, 0.0, -9.81],
            length_unit: 0.1,
            contact_frequency: 120.0,
            contact_damping: 5.0,
        }
    }
}

impl Options {
    pub(crate) fn check(&self) -> Result<(), RapierError> {
        for (name, value, low, high) in [
            ("time_step", self.time_step, 1e-6, 1.0),
            ("substeps", f64::from(self.substeps), 1.0, 1e6),
            ("iterations", f64::from(self.iterations), 1.0, 1e4),
            ("sweeps", f64::from(self.sweeps), 1.0, 1e4),
            ("speed_sweeps", f64::from(self.speed_sweeps), 1.0, 1e4),
            ("gravity x", self.gravity[0], -1e4, 1e4),
            ("gravity y", self.gravity[1], -1e4, 1e4),
            ("gravity z", self.gravity[2], -1e4, 1e4),
            ("length_unit", self.length_unit, 1e-6, 1e6),
            ("contact_frequency", self.contact_frequency, 1e-3, 1e6),
            ("contact_damping", self.contact_damping, 1e-3, 1e3),
        ] {
            if !(low..=high).contains(&value) {
                return Err(RapierError::Option { name, value, range: [low, high] });
            }
        }
        Ok(())
    }

    pub(crate) fn world(&self) -> PhysicsWorld {
        let mut physics = PhysicsWorld::new();
        physics.gravity = vector(self.gravity);
        let softness = SpringCoefficients::new(self.contact_frequency as f32, self.contact_damping as f32);
        let parameters = &mut physics.integration_parameters;
        parameters.dt = (self.time_step / f64::from(self.substeps)) as f32;
        parameters.num_solver_iterations = self.iterations as usize;
        parameters.num_internal_pgs_iterations = self.sweeps as usize;
        // One sweep each step, begun with the last step's impulses, acts as a spring where normal force and friction
        // act on each other, so that a leg on a light foot bounces.
        parameters.num_internal_stabilization_iterations = self.speed_sweeps as usize;
        parameters.friction_in_bias_pass = self.speed_sweeps > 1;
        parameters.length_unit = self.length_unit as f32;
        parameters.contact_softness = softness;
        parameters.static_contact_softness = softness;
        // At each point of a box by itself friction works against itself and is a tenth too weak.
        parameters.friction_model = FrictionModel::Simplified;
        // Readers of a contact need that of this step, at the points of the solver.
        parameters.contact_recycling = false;
        parameters.contact_clustering = false;
        physics
    }
}
