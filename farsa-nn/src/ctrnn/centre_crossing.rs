//! Center-crossing biases, for which each neuron of a continuous-time network operates where its function is steepest.

use farsa_num::Stream;

use crate::ctrnn::layout::{CtrnnLayout, CtrnnParameter};
use crate::error::Error;
use crate::fault::Slice;

impl CtrnnLayout {
    /// Sets the biases to `theta_i = - sum_j w_ji / 2`. With these values, the nullclines of all neurons intersect at
    /// the centers of their activation functions, where rich dynamics are most likely.
    ///
    /// The formula assumes the logistic function and inputs at rest. The center of the hyperbolic tangent is 0, so the
    /// biases are set to 0.
    ///
    /// Source: `[Mathayomchan2002]`. No deviation for the logistic function.
    ///
    /// ```
    /// use farsa_nn::CtrnnLayout;
    ///
    /// let layout = CtrnnLayout::new(0, 2, 1);
    /// let mut parameters = [4.0, -2.0, 6.0, 3.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0];
    /// layout.centre_crossing(&mut parameters)?;
    /// assert_eq!(layout.split(&parameters).biases, [-5.0, -0.5]);
    /// # Ok::<(), farsa_nn::Error>(())
    /// ```
    ///
    /// # Errors
    /// Returns [`Error::Length`]. In this case the parameters are unchanged.
    pub fn centre_crossing(&self, parameters: &mut [f32]) -> Result<(), Error> {
        Slice::Parameters.check(self.parameter_count(), parameters.len())?;
        let middle = self.activation().apply(0.0);
        let (weights, rest) = parameters.split_at_mut(self.range(CtrnnParameter::Bias).start);
        let weights = weights.get(self.range(CtrnnParameter::Weight)).unwrap_or(&[]);
        for (i, bias) in rest.iter_mut().take(self.neurons()).enumerate() {
            let sum: f32 = weights.iter().skip(i).step_by(self.neurons()).sum();
            // 0 instead of -0 without weights.
            *bias = 0.0 - sum * middle;
        }
        Ok(())
    }

    /// Draws a center-crossing network. All weights, including those of the inputs, are in `[-weight, weight)`, and
    /// time constants are in `[shortest, longest)`. The gains are 1, and the biases are set by
    /// [`centre_crossing`](Self::centre_crossing).
    ///
    /// One number is drawn for each weight and each time constant, in the order of the parameters.
    ///
    /// # Errors
    /// Returns [`Error::Length`]. In this case the parameters are unchanged and no number is drawn.
    pub fn draw_centre_crossing(
        &self,
        stream: &mut Stream,
        weight: f32,
        time_constants: [f32; 2],
        parameters: &mut [f32],
    ) -> Result<(), Error> {
        Slice::Parameters.check(self.parameter_count(), parameters.len())?;
        let [shortest, longest] = time_constants;
        for (p, kind) in parameters.iter_mut().zip(self.kinds()) {
            *p = match kind {
                CtrnnParameter::InputWeight | CtrnnParameter::Weight => stream.range(-weight, weight),
                CtrnnParameter::Bias => 0.0,
                CtrnnParameter::Gain => 1.0,
                CtrnnParameter::TimeConstant => stream.range(shortest, longest),
            };
        }
        self.centre_crossing(parameters)
    }
}
