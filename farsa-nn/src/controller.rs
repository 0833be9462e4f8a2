//! The interface of the loop to controllers.

/// A map from sensor values to motor values, with or without memory, updated once per tick.
///
/// The numbers have no units. The body defines their meaning.
///
/// # For implementors
/// - Construction may fail, `step` may not. It returns no error, does not allocate, and panics on no input.
/// - The same calls since the last `reset` give the same bits on every machine.
/// - Use the shorter of two lengths. The weights of a missing input do not count, and a missing output is not computed. Extra
///   values are neither read nor written. `debug_assert!` reports the fault.
///
/// # For callers
/// Be generic over `C: Controller`, or take `&mut dyn Controller`. `&mut C` is a controller too.
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
    /// Number of values that `step` reads.
    fn inputs(&self) -> usize;
    /// Number of values that `step` writes.
    fn outputs(&self) -> usize;
    /// Restores the state after construction.
    fn reset(&mut self);
    /// Advances by one tick from the sensor values `x` [`inputs`](Self::inputs) and overwrites the motor values `y`
    /// [`outputs`](Self::outputs).
    ///
    /// # Panics
    /// With debug assertions, when `x` or `y` has another length.
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
