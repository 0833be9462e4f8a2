//! Back-propagation through the leaky recurrent network.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::{Real, logistic};

use crate::error::Error;
use crate::fault::LayoutFault;
use crate::leak::Leak;
use crate::leaky_layout::LeakyParameter;
use crate::leaky_network::LeakyModel;
use crate::learning::differentiable::{Demonstration, Differentiable, Domain};
use crate::learning::loss::Loss;
use crate::learning::sums::{add_products, add_rows, add_transposed};

impl Differentiable for LeakyModel {
    fn parameter_count(&self) -> usize {
        self.layout.parameter_count()
    }

    fn check(&self, _: Loss) -> Result<(), Error> {
        LayoutFault::check_slope(self.layout.slope())
    }

    fn domain(&self, index: usize) -> Domain {
        if self.layout.kind(index) == Some(LeakyParameter::Leak) { Domain::Share } else { Domain::Any }
    }

    fn run<R: Real>(
        &self,
        loss: Loss,
        parameters: &[R],
        of @ Demonstration { x, wanted }: Demonstration<'_>,
        trace: &mut Vec<R>,
    ) -> R {
        let Self { layout, leak } = self;
        let (n, h, o) = (layout.sensors(), layout.hidden(), layout.outputs());
        let part = |kind| &parameters[layout.range(kind)];
        let (slope, one) = (R::from_f64(f64::from(layout.slope())), R::from_f64(1.0));
        let ticks = of.ticks(n, o);
        trace.clear();
        // Per tick the responses Y, the activations H and the motor values O. The first tick is the initial rest.
        trace.resize((ticks + 1) * (2 * h + o), R::default());
        let mut cost = R::default();
        let (mut before, mut rest) = trace.split_at_mut(2 * h + o);
        for tick in 0..ticks {
            let (now, later) = rest.split_at_mut(2 * h + o);
            let (response, left) = now.split_at_mut(h);
            let (hidden, motors) = left.split_at_mut(h);
            let (response_before, hidden_before) = before[..2 * h].split_at(h);
            // N_i = beta_i + sum_j w_ji I_j + sum_k w_ki H_k(t-1), Y_i = sigma(N_i). Then the leak combines Y and the previous
            // values to H(t).
            response.copy_from_slice(part(LeakyParameter::Bias));
            let x = &x[tick * n..(tick + 1) * n];
            add_rows(response, x.iter().map(|x| R::from_f64(f64::from(*x))), part(LeakyParameter::SensorWeight));
            add_rows(response, hidden_before.iter().copied(), part(LeakyParameter::RecurrentWeight));
            for i in 0..h {
                let d = part(LeakyParameter::Leak)[i];
                let y = logistic(slope * response[i]);
                response[i] = y;
                hidden[i] = match leak {
                    Leak::Filter => d * y + (one - d) * hidden_before[i],
                    Leak::TwoTap => d * y + (one - d) * response_before[i],
                    Leak::Evonet => d * hidden_before[i] + (one - d) * y,
                };
            }
            add_rows(motors, hidden.iter().copied(), part(LeakyParameter::OutputWeight));
            for (motor, wanted) in motors.iter_mut().zip(&wanted[tick * o..(tick + 1) * o]) {
                let (net, wanted) = (slope * *motor, R::from_f64(f64::from(*wanted)));
                *motor = logistic(net);
                cost += loss.cost(net, *motor, wanted);
            }
            (before, rest) = (now, later);
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
        let Self { layout, leak } = self;
        let (n, h, o) = (layout.sensors(), layout.hidden(), layout.outputs());
        let part = |kind| &parameters[layout.range(kind)];
        let (slope, one) = (R::from_f64(f64::from(layout.slope())), R::from_f64(1.0));
        let zeros = |len| vec![R::default(); len];
        let (mut to_hidden, mut to_response, mut through) = (zeros(h), zeros(h), zeros(h.max(o)));
        let (to_hidden, to_response, through) = (&mut to_hidden[..], &mut to_response[..], &mut through[..]);
        // Back-propagation through time [Werbos1990]. `to_hidden` is dC/dH_i(t): from the current motors, and from the
        // next tick through leak and recurrent weights. `to_response` is the part of dC/dY_i(t) through the leak of the
        // next tick.
        let size = 2 * h + o;
        let ticks = trace.len().checked_div(size).unwrap_or(0).saturating_sub(1);
        for tick in (0..ticks).rev() {
            let (before, now) = trace[tick * size..(tick + 2) * size].split_at(size);
            let (response, left) = now.split_at(h);
            let (hidden, motors) = left.split_at(h);
            let (response_before, hidden_before) = before[..2 * h].split_at(h);

            // dC/dN of the motors, which have no memory: N_o = sum_i w_io H_i(t).
            for ((through, motor), wanted) in through.iter_mut().zip(motors).zip(&wanted[tick * o..]) {
                *through = slope * loss.slope(*motor, R::from_f64(f64::from(*wanted)));
            }
            add_products(&mut sum[layout.range(LeakyParameter::OutputWeight)], hidden.iter().copied(), &through[..o]);
            add_transposed(to_hidden, part(LeakyParameter::OutputWeight), &through[..o]);

            let leaks = layout.range(LeakyParameter::Leak);
            for i in 0..h {
                let (d, y, flow) = (parameters[leaks.start + i], response[i], to_hidden[i]);
                // The shares of the response, the previous activation and the previous response.
                let (share, before, stays) = match leak {
                    Leak::Filter => (d, hidden_before[i], true),
                    Leak::TwoTap => (d, response_before[i], false),
                    Leak::Evonet => (one - d, hidden_before[i], true),
                };
                // dH/dd, the derivative by the leak itself.
                let by_leak = if *leak == Leak::Evonet { before - y } else { y - before };
                sum[leaks.start + i] += flow * by_leak;
                // dC/dN_i = dC/dY_i sigma'(N_i), sigma' = slope Y (1 - Y).
                through[i] = (share * flow + to_response[i]) * slope * y * (one - y);
                // The leak keeps a share of H(t-1) or, with two taps, of Y(t-1).
                let kept = (one - share) * flow;
                (to_hidden[i], to_response[i]) = if stays { (kept, R::default()) } else { (R::default(), kept) };
            }
            let through = &through[..h];
            for (sum, through) in sum[layout.range(LeakyParameter::Bias)].iter_mut().zip(through) {
                *sum += *through;
            }
            let x = x[tick * n..(tick + 1) * n].iter().map(|x| R::from_f64(f64::from(*x)));
            add_products(&mut sum[layout.range(LeakyParameter::SensorWeight)], x, through);
            let sources = hidden_before.iter().copied();
            add_products(&mut sum[layout.range(LeakyParameter::RecurrentWeight)], sources, through);
            add_transposed(to_hidden, part(LeakyParameter::RecurrentWeight), through);
        }
    }
}
