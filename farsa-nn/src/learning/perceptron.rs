//! Back-propagation through a single layer.

use alloc::vec::Vec;

use farsa_num::{Real, logistic};

use crate::error::Error;
use crate::fault::LayoutFault;
use crate::learning::differentiable::{Demonstration, Differentiable, Domain};
use crate::learning::loss::Loss;
use crate::learning::sums::{add_products, add_rows};
use crate::perceptron::{Perceptron, PerceptronModel};

impl Differentiable for PerceptronModel {
    fn parameter_count(&self) -> usize {
        Perceptron::parameter_count(self.inputs, self.outputs)
    }

    fn check(&self, _: Loss) -> Result<(), Error> {
        LayoutFault::check_slope(self.slope)
    }

    fn domain(&self, _: usize) -> Domain {
        Domain::Any
    }

    /// The trace has the motor values of each tick.
    fn run<R: Real>(
        &self,
        loss: Loss,
        parameters: &[R],
        of @ Demonstration { x, wanted }: Demonstration<'_>,
        trace: &mut Vec<R>,
    ) -> R {
        let (n, o) = (self.inputs, self.outputs);
        let (weights, biases) = parameters.split_at(n * o);
        let slope = R::from_f64(f64::from(self.slope));
        let ticks = of.ticks(n, o);
        trace.clear();
        trace.resize(ticks * o, R::default());
        let mut cost = R::default();
        for tick in 0..ticks {
            let motors = &mut trace[tick * o..(tick + 1) * o];
            motors.copy_from_slice(biases);
            let x = x[tick * n..(tick + 1) * n].iter().map(|x| R::from_f64(f64::from(*x)));
            add_rows(motors, x, weights);
            for (motor, wanted) in motors.iter_mut().zip(&wanted[tick * o..]) {
                let (net, wanted) = (slope * *motor, R::from_f64(f64::from(*wanted)));
                *motor = logistic(net);
                cost += loss.cost(net, *motor, wanted);
            }
        }
        cost
    }

    fn follow_back<R: Real>(
        &self,
        loss: Loss,
        _: &[R],
        Demonstration { x, wanted }: Demonstration<'_>,
        trace: &[R],
        sum: &mut [R],
    ) {
        let (n, o) = (self.inputs, self.outputs);
        let slope = R::from_f64(f64::from(self.slope));
        let (weights, biases) = sum.split_at_mut(n * o);
        let motors = trace.chunks_exact(o.max(1)).zip(wanted.chunks_exact(o.max(1)));
        for (tick, (motors, wanted)) in motors.enumerate() {
            let through = motors.iter().zip(wanted);
            let through = through.map(|(motor, wanted)| slope * loss.slope(*motor, R::from_f64(f64::from(*wanted))));
            let through: Vec<R> = through.collect();
            let x = x[tick * n..(tick + 1) * n].iter().map(|x| R::from_f64(f64::from(*x)));
            add_products(weights, x, &through);
            biases.iter_mut().zip(&through).for_each(|(sum, through)| *sum += *through);
        }
    }
}
