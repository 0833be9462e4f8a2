//! The interface of all controllers.

/// A controller that computes motor values from sensor values once per tick. It may have a memory.
///
/// The values have no units. Their meaning is defined by the body.
///
/// # For implementors
/// - The constructor may fail, but `step` must not return errors, allocate memory or panic.
/// - Equal sequences of calls after a `reset` must produce equal bits on every machine.
/// - If a slice has the wrong length, use the shorter length. The weights of missing inputs are ignored, and missing
///   outputs are not computed. Additional values are neither read nor written. Use `debug_assert!` to report the error.
///
/// # For callers
/// Write generic functions with a type `C: Controller`, or use `&mut dyn Controller`. Note that `&mut C` is a
/// controller, too.
///
/// ```
/// use farsa_nn::{Controller, Perceptron};
///
/// fn settle<C: Controller>(mut controller: C, x: &[f32], y: &mut [f32], ticks: usize) {
///     controller.reset();
///     (0..ticks).for_each(|_| controller.step(x, y));
/// }
/// # fn main() -> Result<(), farsa_nn::Error> {
/// let mut reflex = Perceptron::new(2, 1, 1.0, [3.0, -3.0, 0.0])?;
/// let mut y = [0.0];
/// settle(&mut reflex, &[0.5, 0.5], &mut y, 10);
/// assert_eq!(y, [0.5]);
/// # Ok(())
/// # }
/// ```
pub trait Controller {
    /// Returns the number of values that `step` reads.
    fn inputs(&self) -> usize;
    /// Returns the number of values that `step` writes.
    fn outputs(&self) -> usize;
    /// Resets the controller to the state after its construction.
    fn reset(&mut self);
    /// Advances the controller by one tick. It reads the sensor values `x` and overwrites the motor values `y`. The
    /// lengths of the slices should be [`inputs`](Self::inputs) and [`outputs`](Self::outputs).
    ///
    /// # Panics
    /// Panics if a slice has a different length and debug assertions are enabled.
    fn step(&mut self, x: &[f32], y: &mut [f32]);
}

impl<C: Controller + ?Sized> Controller for &mut C {
    fn inputs(&self) -> usize {
        (**self).inputs()
    }
    fn outputs(&self) -> usize {
        (**self).outputs()
    }
    fn reset(&mut self) {
        (**self).reset();
    }
    fn step(&mut self, x: &[f32], y: &mut [f32]) {
        (**self).step(x, y);
    }
}
