//! Back-propagation through continuous-time networks.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::{Real, exp};

use crate::activation::Activation;
use crate::ctrnn::network::CtrnnModel;
use crate::ctrnn::{CtrnnParameter, Integrator};
use crate::error::Error;
use crate::fault::LayoutFault;
use crate::learning::differentiable::{Demonstration, Differentiable, Domain};
use crate::learning::loss::Loss;
use crate::learning::sums::{activation_slope, add_products, add_rows, add_transposed};

/// Slopes of a step at which states are evaluated.
struct Scheme {
    /// Share of the previous slope in the state of each slope.
    points: &'static [f64],
    /// Share of each slope in the step.
    shares: &'static [f64],
}

/// Returns the slopes `k` of an integrator at the points `p` of a step from the states `y`:
///
/// ```text
/// p_s = y + point_s k_(s-1)          k_s = rate (net(o(p_s)) - p_s)          y' = y + sum_s share_s k_s
/// ```
fn scheme(integrator: Integrator) -> Scheme {
    match integrator {
        Integrator::Euler | Integrator::ExponentialEuler => Scheme { points: &[0.0], shares: &[1.0] },
        Integrator::RungeKutta4 => {
            Scheme { points: &[0.0, 0.5, 0.5, 1.0], shares: &[1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0] }
        }
    }
}

impl CtrnnModel {
    /// Returns the rate of a neuron and its derivative by the time constant.
    fn rate<R: Real>(&self, time_constant: R) -> [R; 2] {
        let one = R::from_f64(1.0);
        let share = R::from_f64(f64::from(self.time_step)) / time_constant;
        match self.layout.integrator() {
            Integrator::Euler | Integrator::RungeKutta4 => [share, -share / time_constant],
            Integrator::ExponentialEuler => {
                let left = exp(-share);
                [one - left, -left * share / time_constant]
            }
        }
    }

    /// Computes the external inputs of a tick.
    fn external<R: Real>(&self, parameters: &[R], x: &[f32], to: &mut [R]) {
        to.fill(R::default());
        let x = x.iter().map(|x| R::from_f64(f64::from(*x)));
        match self.layout.direct_inputs() {
            Some(neurons) => to[neurons].iter_mut().zip(x).for_each(|(to, x)| *to = x),
            None => add_rows(to, x, &parameters[self.layout.range(CtrnnParameter::InputWeight)]),
        }
    }
}

impl Differentiable for CtrnnModel {
    fn parameter_count(&self) -> usize {
        self.layout.parameter_count()
    }

    fn check(&self, loss: Loss) -> Result<(), Error> {
        if loss == Loss::CrossEntropy && self.layout.activation() != Activation::Logistic {
            return Err(LayoutFault::Loss.into());
        }
        Ok(())
    }

    fn domain(&self, index: usize) -> Domain {
        let time_constant = self.layout.kind(index) == Some(CtrnnParameter::TimeConstant);
        if time_constant { Domain::Positive } else { Domain::Any }
    }

    /// The trace has the states, the points and net inputs of all slopes of each tick, and the states after the last.
    fn run<R: Real>(
        &self,
        loss: Loss,
        parameters: &[R],
        of @ Demonstration { x, wanted }: Demonstration<'_>,
        trace: &mut Vec<R>,
    ) -> R {
        let layout = self.layout;
        let (m, n, o) = (layout.inputs(), layout.neurons(), layout.outputs());
        let part = |kind| &parameters[layout.range(kind)];
        let [weights, biases] = [CtrnnParameter::Weight, CtrnnParameter::Bias].map(part);
        let [gains, constants] = [CtrnnParameter::Gain, CtrnnParameter::TimeConstant].map(part);
        let Scheme { points, shares } = scheme(layout.integrator());
        let ticks = of.ticks(m, o);
        let (mut y, mut external) = (vec![R::default(); n], vec![R::default(); n]);
        let mut cost = R::default();
        trace.clear();
        for tick in 0..ticks {
            self.external(parameters, &x[tick * m..(tick + 1) * m], &mut external);
            let mut next = y.clone();
            let mut slope = vec![R::default(); n];
            for (point, share) in points.iter().zip(shares) {
                let state = y.iter().zip(&slope).map(|(y, k)| *y + R::from_f64(*point) * *k);
                let state: Vec<R> = state.collect();
                let output = |i: usize| layout.activation().apply_lanes(gains[i] * (state[i] + biases[i]));
                let mut net = external.clone();
                add_rows(&mut net, (0..n).map(output), weights);
                for i in 0..n {
                    slope[i] = self.rate(constants[i])[0] * (net[i] - state[i]);
                    next[i] += R::from_f64(*share) * slope[i];
                }
                trace.extend(state.into_iter().chain(net));
            }
            y = next;
            for (i, wanted) in layout.output_neurons().zip(&wanted[tick * o..]) {
                let net = gains[i] * (y[i] + biases[i]);
                let motor = layout.activation().apply_lanes(net);
                cost += loss.cost(net, motor, R::from_f64(f64::from(*wanted)));
            }
            trace.extend(&y);
        }
        cost
    }

    fn follow_back<R: Real>(
        &self,
        loss: Loss,
        parameters: &[R],
        Demonstration { x, wanted }: Demonstration<'_>,
        trace: &[R],
        sum: &mut [R],
    ) {
        let layout = self.layout;
        let (m, n, o) = (layout.inputs(), layout.neurons(), layout.outputs());
        let part = |kind| &parameters[layout.range(kind)];
        let [weights, biases] = [CtrnnParameter::Weight, CtrnnParameter::Bias].map(part);
        let [gains, constants] = [CtrnnParameter::Gain, CtrnnParameter::TimeConstant].map(part);
        let [of_biases, of_gains, of_constants] =
            [CtrnnParameter::Bias, CtrnnParameter::Gain, CtrnnParameter::TimeConstant].map(|kind| layout.range(kind));
        let Scheme { points, shares } = scheme(layout.integrator());
        let size = (2 * points.len() + 1) * n;
        let activation = layout.activation();
        // dC/dy(t), from later ticks and from the motor values of this one.
        let mut flow = vec![R::default(); n];
        for (tick, trace) in trace.chunks_exact(size.max(1)).enumerate().rev() {
            let (slopes, y) = trace.split_at(2 * points.len() * n);
            for (i, wanted) in layout.output_neurons().zip(&wanted[tick * o..]) {
                let motor = activation.apply_lanes(gains[i] * (y[i] + biases[i]));
                let by_net = loss.slope_of(activation, motor, R::from_f64(f64::from(*wanted)));
                sum[of_biases.start + i] += by_net * gains[i];
                sum[of_gains.start + i] += by_net * (y[i] + biases[i]);
                flow[i] += by_net * gains[i];
            }
            // y' = y + sum share k: dC/dy begins with dC/dy'. dC/dk of each slope also comes from the next point.
            let mut to_state = flow.clone();
            let mut through_point = vec![R::default(); n];
            let mut external = vec![R::default(); n];
            for (stage, (point, share)) in points.iter().zip(shares).enumerate().rev() {
                let (state, net) = slopes[2 * stage * n..][..2 * n].split_at(n);
                let mut to_net = vec![R::default(); n];
                let mut to_point = vec![R::default(); n];
                for i in 0..n {
                    let [rate, by_constant] = self.rate(constants[i]);
                    let to_slope = R::from_f64(*share) * flow[i] + through_point[i];
                    sum[of_constants.start + i] += to_slope * by_constant * (net[i] - state[i]);
                    to_net[i] = rate * to_slope;
                    to_point[i] = -rate * to_slope;
                    external[i] += to_net[i];
                }
                let output = |i: usize| activation.apply_lanes(gains[i] * (state[i] + biases[i]));
                add_products(&mut sum[layout.range(CtrnnParameter::Weight)], (0..n).map(output), &to_net);
                let mut to_output = vec![R::default(); n];
                add_transposed(&mut to_output, weights, &to_net);
                for i in 0..n {
                    let through = to_output[i] * activation_slope(activation, output(i));
                    sum[of_biases.start + i] += through * gains[i];
                    sum[of_gains.start + i] += through * (state[i] + biases[i]);
                    to_point[i] += through * gains[i];
                    // p = y + point k
                    to_state[i] += to_point[i];
                    through_point[i] = R::from_f64(*point) * to_point[i];
                }
            }
            let x = x[tick * m..(tick + 1) * m].iter().map(|x| R::from_f64(f64::from(*x)));
            add_products(&mut sum[layout.range(CtrnnParameter::InputWeight)], x, &external);
            flow = to_state;
        }
    }
}
