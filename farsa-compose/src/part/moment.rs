//! Moments of a trial.

use std::fmt;

use farsa_body::Pose;

/// A step of a trial, with the values of all robots that take part.
#[derive(Clone, Copy)]
pub struct Moment<'m> {
    /// Steps so far.
    pub steps: u32,
    /// Steps of the longest trial.
    pub longest: u32,
    /// Control step \[s\].
    pub time_step: f64,
    /// Poses of the robots on wheels.
    pub poses: &'m [Pose],
    /// Sensor and motor values, robot by robot.
    pub(crate) x: &'m [f32],
    pub(crate) y: &'m [f32],
    /// Channels of a robot.
    pub(crate) inputs: usize,
    pub(crate) outputs: usize,
    /// Positions of markers \[m\].
    pub(crate) markers: &'m [[f32; 3]],
    pub(crate) stock: Option<&'m dyn Stock>,
}

impl fmt::Debug for Moment<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Moment").field("steps", &self.steps).finish_non_exhaustive()
    }
}

impl Moment<'_> {
    /// Gets the last sensor values of a robot.
    pub fn sensed(&self, robot: usize) -> &[f32] {
        self.x.get(robot * self.inputs..(robot + 1) * self.inputs).unwrap_or_default()
    }

    /// Gets the last motor values of a robot.
    pub fn driven(&self, robot: usize) -> &[f32] {
        self.y.get(robot * self.outputs..(robot + 1) * self.outputs).unwrap_or_default()
    }
}

/// Food of a team.
pub(crate) trait Stock {
    /// Counts the pieces that the team has delivered.
    fn collected(&self) -> u32;
    /// Counts the pieces that the team carries.
    fn carried(&self) -> u32;
    /// Counts the pieces that the team lost with dead robots.
    fn lost(&self) -> u32;
    /// Counts the dead robots.
    fn deaths(&self) -> usize;
    /// Gets the energy of a robot \[0..1\], and true for one that is alive.
    fn energy(&self, robot: usize) -> Option<(f64, bool)>;
}
