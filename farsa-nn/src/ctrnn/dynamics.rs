//! One step of a continuous-time network, computed for the lanes of a [`Scalar`].
//!
//! Each lane is a neuron. Within a step, neurons depend on each other only through the outputs of the previous step. As
//! in the kernel of layers, the width of the vectors does not change the results.

use core::f64::consts::LN_2;

use farsa_num::{Real, Scalar, exp, tanh};

use crate::activation::Activation;
use crate::ctrnn::integrator::Integrator;
use crate::kernel::{Lanes, Layer};
use crate::lesion::Lesion;

/// The data of a step. All slices except weights and inputs are `[neurons]`.
pub(crate) struct Dynamics<'a, R = f32> {
    pub(crate) integrator: Integrator,
    pub(crate) activation: Activation,
    /// States of the neurons.
    pub(crate) y: &'a mut [R],
    /// Outputs that belong to `y`, before and after a step.
    pub(crate) o: &'a mut [R],
    /// The [`rate`] of each time constant.
    pub(crate) rates: &'a [R],
    pub(crate) biases: &'a [R],
    pub(crate) gains: &'a [R],
    /// External inputs, or empty.
    pub(crate) external: &'a [R],
    /// Inputs and their weights, source-major, or empty.
    pub(crate) inputs: (&'a [R], &'a [R]),
    /// Weights between the neurons, source-major.
    pub(crate) weights: &'a [R],
    /// Neurons whose outputs are held.
    pub(crate) lesions: &'a [Lesion],
    /// Workspace: the net inputs.
    pub(crate) net: &'a mut [R],
    /// Workspace of Runge-Kutta, else empty: the weighted sum of the slopes so far.
    pub(crate) sum: &'a mut [R],
    /// Workspace of Runge-Kutta, else empty: the states of the next slope.
    pub(crate) point: &'a mut [R],
}

/// The coefficient of an integrator for a time constant and a time step.
///
/// The exponential integrator moves the state to the net input by the fraction `1 - exp(-dt/tau)`. Above a half, the
/// fraction `exp(-dt/tau)` back from the net input is more exact. A minus sign marks this second form.
pub(crate) fn rate(integrator: Integrator, time_step: f64, time_constant: f64) -> f64 {
    let x = time_step / time_constant;
    match integrator {
        Integrator::Euler | Integrator::RungeKutta4 => x,
        // The difference of 1 and the exponential would lose its digits at small x.
        Integrator::ExponentialEuler if x < LN_2 => tanh(0.5 * x) * (1.0 + exp(-x)),
        // Not zero, because the sign is compared.
        Integrator::ExponentialEuler => -exp(-x).max(1e-30),
    }
}

impl Lanes for Dynamics<'_> {
    fn widest(&self) -> usize {
        self.y.len()
    }

    #[inline(always)]
    fn run<S: Scalar<Real = f32>>(&mut self, simd: S::Simd) {
        self.stages::<S>(simd);
    }
}

impl<R: Real> Dynamics<'_, R> {
    /// Computes the outputs of new states.
    #[inline(never)]
    pub(crate) fn refresh(&mut self) {
        for i in 0..self.y.len() {
            self.o[i] = self.output(i, self.y[i]);
        }
    }

    /// Advances by one step. Does nothing if there are fewer neurons than lanes.
    #[inline(always)]
    fn stages<S: Scalar<Real = R>>(&mut self, simd: S::Simd) {
        let neurons = self.y.len();
        let Some(last) = neurons.checked_sub(S::LANES) else { return };
        self.hold();
        let stages = if self.integrator == Integrator::RungeKutta4 { 4 } else { 1 };
        for stage in 0..stages {
            let sources = [self.inputs, (&*self.o, self.weights)];
            let layer = Layer { targets: neurons, slope: R::from_f64(1.0), biases: self.external, sources };
            layer.all_sums::<S>(simd, self.net);
            // The last vector may overlap the previous one. It is computed first, before the previous one overwrites its
            // data, and stored last, with the same values in the overlap.
            let end = self.advance::<S>(simd, stage, last);
            let mut i = 0;
            while i < last {
                let next = self.advance::<S>(simd, stage, i);
                self.keep(stage, i, next);
                i += S::LANES;
            }
            self.keep(stage, last, end);
            self.hold();
        }
    }

    fn hold(&mut self) {
        for lesion in self.lesions {
            if let Some(o) = self.o.get_mut(lesion.neuron) {
                *o = R::from_f64(f64::from(lesion.activation));
            }
        }
    }

    /// One stage of the neurons from `i` on, as many as there are lanes: the states, the sums of slopes, and the
    /// outputs.
    #[inline(always)]
    fn advance<S: Scalar<Real = R>>(&self, simd: S::Simd, stage: usize, i: usize) -> [S; 3] {
        let (y, net) = (S::load(simd, &self.y[i..]), S::load(simd, &self.net[i..]));
        let rate = S::load(simd, &self.rates[i..]);
        let (next, sum) = match self.integrator {
            Integrator::Euler => (y + rate * (net - y), y),
            Integrator::ExponentialEuler => {
                let back = rate.lt(rate.constant(0.0));
                let (from, to) = (S::select(back, net, y), S::select(back, y, net));
                (from + rate.abs() * (to - from), y)
            }
            Integrator::RungeKutta4 => {
                let at = if stage == 0 { y } else { S::load(simd, &self.point[i..]) };
                let slope = rate * (net - at);
                let sum = match stage {
                    0 => slope,
                    1 | 2 => S::load(simd, &self.sum[i..]) + (slope + slope),
                    _ => S::load(simd, &self.sum[i..]) + slope,
                };
                let next = match stage {
                    0 | 1 => y + slope * slope.constant(0.5),
                    2 => y + slope,
                    _ => y + sum * sum.constant(1.0 / 6.0),
                };
                (next, sum)
            }
        };
        [next, sum, self.output(i, next)]
    }

    /// Stores what [`advance`](Self::advance) computed.
    #[inline(always)]
    fn keep<S: Scalar<Real = R>>(&mut self, stage: usize, i: usize, [next, sum, o]: [S; 3]) {
        o.store(&mut self.o[i..]);
        if self.integrator != Integrator::RungeKutta4 {
            return next.store(&mut self.y[i..]);
        }
        sum.store(&mut self.sum[i..]);
        if stage == 3 {
            next.store(&mut self.y[i..]);
        } else {
            next.store(&mut self.point[i..]);
        }
    }

    /// The outputs of the neurons from `i` on in these states, 0 for a NaN.
    #[inline(always)]
    fn output<S: Scalar<Real = R>>(&self, i: usize, y: S) -> S {
        let (bias, gain) = (S::load(y.simd(), &self.biases[i..]), S::load(y.simd(), &self.gains[i..]));
        let o = self.activation.apply_lanes(gain * (y + bias));
        S::select(o.le(o), o, o.constant(0.0))
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use std::vec::Vec;

    use super::*;

    /// The states of a smooth net of three neurons in double precision after each of four units of time.
    fn states(integrator: Integrator, steps_per_unit: usize) -> Vec<f64> {
        let weights = [0.75, -1.0, 0.25, 1.0, 0.5, -0.5, -0.25, 0.75, 0.125];
        let (biases, gains, external) = ([-0.5, 0.25, 0.0], [1.0, 1.5, 0.75], [0.5, -0.25, 1.0]);
        let rates = [1.0, 2.0, 3.0].map(|tau| rate(integrator, 1.0 / steps_per_unit as f64, tau));
        let (mut y, mut o) = ([1.0, -1.0, 0.5], [0.0; 3]);
        let (mut net, mut sum, mut point) = ([0.0; 3], [0.0; 3], [0.0; 3]);
        let mut dynamics = Dynamics {
            integrator,
            activation: Activation::Logistic,
            y: &mut y,
            o: &mut o,
            rates: &rates,
            biases: &biases,
            gains: &gains,
            external: &external,
            inputs: (&[], &[]),
            weights: &weights,
            lesions: &[],
            net: &mut net,
            sum: &mut sum,
            point: &mut point,
        };
        dynamics.refresh();
        let mut states = Vec::new();
        for _ in 0..4 {
            (0..steps_per_unit).for_each(|_| dynamics.stages::<f64>(()));
            states.extend_from_slice(dynamics.y);
        }
        states
    }

    // In double precision, because in single precision rounding hides the fourth order.
    #[test]
    fn each_integrator_has_its_order() {
        let truth = states(Integrator::RungeKutta4, 4096);
        for (integrator, order, tolerance) in [
            (Integrator::Euler, 1.0, 0.1),
            (Integrator::ExponentialEuler, 1.0, 0.1),
            (Integrator::RungeKutta4, 4.0, 0.3),
        ] {
            let error = |steps_per_unit| -> f64 {
                let y = states(integrator, steps_per_unit);
                y.iter().zip(&truth).map(|(y, truth)| (y - truth) * (y - truth)).sum::<f64>().sqrt()
            };
            // From half of the smallest time constant to an eighth.
            let found = farsa_num::ln(error(2) / error(8)) / (2.0 * LN_2);
            std::println!("{integrator}: order {found:.3}");
            assert!((found - order).abs() <= tolerance, "{integrator}: order {found}");
        }
    }
}
