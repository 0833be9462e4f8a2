//! Back-propagation through time for the leaky recurrent network.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::{Real, logistic};

use crate::error::Error;
use crate::fault::{LayoutFault, Slice};
use crate::leak::Leak;
use crate::leaky_layout::{LeakyLayout, LeakyParameter};

/// The cost of a motor value `O` with target `T`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Loss {
    /// Squared error `(O - T)^2`.
    #[default]
    SquaredError,
    /// Cross entropy `-T ln O - (1-T) ln(1-O)`, minus its value for `O = T`. Wrong outputs near 0 and 1 are
    /// corrected faster than with squared errors.
    CrossEntropy,
}

/// An example from which a network learns. It contains sensor values and target motor values for each tick, and the
/// network starts at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Demonstration<'a> {
    /// Sensor values `[ticks x sensors]`.
    pub x: &'a [f32],
    /// Target motor values `[ticks x outputs]`, in [0, 1].
    pub wanted: &'a [f32],
}

/// The gradient of the cost with respect to the parameters of a [`LeakyNetwork`](crate::LeakyNetwork), summed over
/// demonstrations.
///
/// The network is run over each demonstration, starting at rest. Then the cost is propagated back through all ticks.
/// Demonstrations with a single tick are examples for a network without memory. In this case the recurrent weights have
/// no effect, and with leaks of 1 ([`Leak::Filter`]) the algorithm is plain back-propagation.
///
/// For learning, `f64` is recommended, although `f32` needs only half the memory. Since all sums have a fixed order,
/// the results are identical on every machine.
///
/// Source: `[Rumelhart1986]` for back-propagation, `[Werbos1990]` through time. The equations are those of
/// [`LeakyNetwork`](crate::LeakyNetwork), with the derivative of the leak.
///
/// ```
/// use farsa_nn::learning::{Demonstration, Gradient, Loss};
/// use farsa_nn::{Leak, LeakyLayout};
///
/// const LAYOUT: LeakyLayout = LeakyLayout::new(1, 1, 1);
/// let mut gradient = Gradient::<f64>::new(LAYOUT, Leak::Filter, Loss::SquaredError)?;
/// let parameters = [1.0, 0.0, 0.0, 0.0, 1.0];
/// // The output is 0.5, its target 1: larger weights of the output help.
/// let cost = gradient.add(&parameters, Demonstration { x: &[0.0], wanted: &[1.0] })?;
/// assert_eq!(cost, 0.25);
/// // 2 * (0.5 - 1) * 0.2 * 0.5 * (1 - 0.5) * H with H = 0.5.
/// assert!((gradient.sum()[2] + 0.025).abs() < 1e-8);
/// # Ok::<(), farsa_nn::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Gradient<R> {
    layout: LeakyLayout,
    leak: Leak,
    loss: Loss,
    sum: Vec<R>,
    cost: R,
    /// Ticks since the sum was cleared.
    ticks: usize,
    /// For each tick: responses `[hidden]`, activations `[hidden]`, motor values `[outputs]`.
    trace: Vec<R>,
    /// Derivatives of the cost by the activations and by the responses of a tick `[hidden]` each, and through the
    /// logistic functions of a layer `[hidden or outputs]`.
    back: [Vec<R>; 3],
}

impl<R: Real> Gradient<R> {
    /// Creates a gradient without any demonstrations.
    ///
    /// # Errors
    /// Returns [`Error::Layout`] if the slope is invalid.
    pub fn new(layout: LeakyLayout, leak: Leak, loss: Loss) -> Result<Self, Error> {
        LayoutFault::check_slope(layout.slope())?;
        let zeros = |len| vec![R::default(); len];
        let back = [zeros(layout.hidden()), zeros(layout.hidden()), zeros(layout.hidden().max(layout.outputs()))];
        let sum = zeros(layout.parameter_count());
        Ok(Self { layout, leak, loss, sum, cost: R::default(), ticks: 0, trace: Vec::new(), back })
    }

    /// Gets the layout of the network.
    pub fn layout(&self) -> LeakyLayout {
        self.layout
    }

    /// Gets the interpretation of the leaks.
    pub fn leak(&self) -> Leak {
        self.leak
    }

    /// Gets the sum of the gradients since the last call of [`clear`](Self::clear). It has one element per
    /// parameter.
    pub fn sum(&self) -> &[R] {
        &self.sum
    }

    /// Returns a mutable reference to the sum. It can be used to compute the mean, to freeze parameters or to clip the
    /// gradient.
    pub fn sum_mut(&mut self) -> &mut [R] {
        &mut self.sum
    }

    /// Returns the mean cost per motor value since the last call of [`clear`](Self::clear).
    pub fn mean_cost(&self) -> R {
        let values = self.ticks.saturating_mul(self.layout.outputs());
        if values == 0 { R::default() } else { self.cost / R::from_f64(values as f64) }
    }

    /// Gets the number of ticks since the last call of [`clear`](Self::clear).
    pub fn ticks(&self) -> usize {
        self.ticks
    }

    /// Removes all demonstrations.
    pub fn clear(&mut self) {
        self.sum.fill(R::default());
        (self.cost, self.ticks) = (R::default(), 0);
    }

    /// Computes the cost of a demonstration, summed over its ticks and motor values. The gradient is not
    /// changed. The number of parameters must be [`parameter_count`](LeakyLayout::parameter_count).
    ///
    /// # Errors
    /// Returns [`Error::Length`] or [`Error::Demonstration`].
    pub fn cost(&mut self, parameters: &[R], demonstration: Demonstration<'_>) -> Result<R, Error> {
        self.check(parameters, demonstration)?;
        Ok(self.run(parameters, demonstration))
    }

    /// Adds the gradient of a demonstration and returns its cost. The cost is the sum over ticks and motor values. The
    /// number of parameters must be [`parameter_count`](LeakyLayout::parameter_count).
    ///
    /// # Errors
    /// Returns [`Error::Length`] or [`Error::Demonstration`]. In this case nothing is added.
    pub fn add(&mut self, parameters: &[R], demonstration: Demonstration<'_>) -> Result<R, Error> {
        let ticks = self.check(parameters, demonstration)?;
        let cost = self.run(parameters, demonstration);
        self.follow_back(parameters, demonstration);
        self.cost += cost;
        self.ticks += ticks;
        Ok(cost)
    }

    /// Checks a demonstration and returns its number of ticks.
    fn check(&self, parameters: &[R], Demonstration { x, wanted }: Demonstration<'_>) -> Result<usize, Error> {
        Slice::Parameters.check(self.layout.parameter_count(), parameters.len())?;
        let (sensors, outputs) = (self.layout.sensors(), self.layout.outputs());
        // Either number may be 0, but not both.
        let ticks = x.len().checked_div(sensors).or(wanted.len().checked_div(outputs)).unwrap_or(0);
        if x.len() == ticks * sensors && wanted.len() == ticks * outputs {
            return Ok(ticks);
        }
        Err(Error::Demonstration { values: x.len(), sensors, wanted: wanted.len(), outputs })
    }

    /// Runs the network, stores its trace and returns the cost.
    fn run(&mut self, parameters: &[R], Demonstration { x, wanted }: Demonstration<'_>) -> R {
        let Self { layout, leak, loss, trace, .. } = self;
        let (n, h, o) = (layout.sensors(), layout.hidden(), layout.outputs());
        let part = |kind| &parameters[layout.range(kind)];
        let (slope, one) = (R::from_f64(f64::from(layout.slope())), R::from_f64(1.0));
        let ticks = wanted.len().checked_div(o).or(x.len().checked_div(n)).unwrap_or(0);
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

    /// Propagates the cost of the run back to the parameters.
    fn follow_back(&mut self, parameters: &[R], Demonstration { x, wanted }: Demonstration<'_>) {
        let Self { layout, leak, loss, sum, trace, back, .. } = self;
        let (n, h, o) = (layout.sensors(), layout.hidden(), layout.outputs());
        let part = |kind| &parameters[layout.range(kind)];
        let (slope, one) = (R::from_f64(f64::from(layout.slope())), R::from_f64(1.0));
        let [to_hidden, to_response, through] = back;
        // Back-propagation through time [Werbos1990]. `to_hidden` is dC/dH_i(t): from the current motors, and from the
        // next tick through leak and recurrent weights. `to_response` is the part of dC/dY_i(t) through the leak of the
        // next tick.
        to_hidden.fill(R::default());
        to_response.fill(R::default());
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

impl Loss {
    /// The cost of a motor value whose logistic function had the argument `net`.
    fn cost<R: Real>(self, net: R, motor: R, wanted: R) -> R {
        match self {
            Self::SquaredError => (motor - wanted) * (motor - wanted),
            Self::CrossEntropy => {
                // -ln O = ln(1 + exp(-net)), and ln(1 - O) = ln O - net.
                let log = |size: R| farsa_num::ln(R::from_f64(1.0) + farsa_num::exp(-size));
                let small = if net < R::default() { -net } else { R::default() };
                let log_motor = small + log(net.abs());
                let entropy = |p: R| if p > R::default() { p * farsa_num::ln(p) } else { R::default() };
                let least = entropy(wanted) + entropy(R::from_f64(1.0) - wanted);
                log_motor + (R::from_f64(1.0) - wanted) * net + least
            }
        }
    }

    /// Its derivative by that argument.
    fn slope<R: Real>(self, motor: R, wanted: R) -> R {
        match self {
            Self::SquaredError => R::from_f64(2.0) * (motor - wanted) * motor * (R::from_f64(1.0) - motor),
            Self::CrossEntropy => motor - wanted,
        }
    }
}

/// `to_i += sum_j source_j w_ji`, source-major, the sources in their order.
fn add_rows<R: Real>(to: &mut [R], sources: impl Iterator<Item = R>, weights: &[R]) {
    for (source, row) in sources.zip(weights.chunks_exact(to.len().max(1))) {
        for (to, w) in to.iter_mut().zip(row) {
            *to += source * *w;
        }
    }
}

/// `sum_ji += source_j through_i`.
fn add_products<R: Real>(sum: &mut [R], sources: impl Iterator<Item = R>, through: &[R]) {
    for (source, row) in sources.zip(sum.chunks_exact_mut(through.len().max(1))) {
        for (sum, through) in row.iter_mut().zip(through) {
            *sum += source * *through;
        }
    }
}

/// `to_j += sum_i w_ji through_i`.
fn add_transposed<R: Real>(to: &mut [R], weights: &[R], through: &[R]) {
    for (to, row) in to.iter_mut().zip(weights.chunks_exact(through.len().max(1))) {
        let mut sum = R::default();
        for (w, through) in row.iter().zip(through) {
            sum += *w * *through;
        }
        *to += sum;
    }
}
