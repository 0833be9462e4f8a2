//! Control of an episode from outside.

/// Sensors and motors of an episode without its controller, from
/// [`Episode::external`](crate::Episode::external).
///
/// The sequence of a trial is `start`, `observe`, and then in each step `actuate`, the step of the world, `judge` and
/// `observe`. With the actions that the controller would choose, the outcome is that of [`Episode::act`](crate::Episode::act).
pub trait ExternalControl<W: ?Sized> {
    /// Gets the numbers of observed channels and of actions.
    fn channels(&self) -> [usize; 2];

    /// Reads the sensors.
    fn observe(&mut self, world: &W);

    /// Gets the last observation, as the controller would receive it before any normalization.
    fn observation(&self) -> &[f32];

    /// Drives the motors by an action. Its range is that of the controller's outputs, 0 to 1.
    fn actuate(&mut self, action: &[f32], world: &mut W);

    /// Computes the fitness of the trial so far. It is 0 at the start, and its increase is the reward of a step.
    fn earned(&self) -> f64;

    /// Checks, after the last step, that the trial ended by the number of its steps alone.
    fn is_truncated(&self, world: &W) -> bool;
}
