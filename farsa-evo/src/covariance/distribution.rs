//! A normal distribution that is adapted to what its samples are worth.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::{Scalar, Stream, exp};

use crate::covariance::coefficients::Coefficients;
use crate::covariance::config::{STEP_SIZES, Start};
use crate::covariance::linear::{add_rows, add_scaled, dot};
use crate::error::EvoError;
use crate::population::Population;
use crate::search::stream;
use crate::snapshot::{StateReader, push_reals};

/// The limits of the largest variance. Beyond them the step size takes the excess.
const VARIANCES: [f64; 2] = [1e-30, 1e30];
/// The number of tries to draw a point within bounds.
const TRIES: usize = 100;
/// The limit of all numbers of a saved state.
const STATE: f64 = 1e140;

/// A kind of covariance matrix that [`CmaEs`](crate::covariance::CmaEs) adapts: [`Full`](crate::covariance::Full),
/// [`Cholesky`](crate::covariance::Cholesky) or [`Diagonal`](crate::covariance::Diagonal).
pub trait Covariance: Clone + core::fmt::Debug + PartialEq {
    /// The configuration of a search with this kind of matrix.
    type Config: Start;

    /// The identity matrix, which learns at these rates.
    fn identity(genes: usize, coefficients: &Coefficients) -> Self;

    /// Turns standard normal rows [rows x genes] into rows of this covariance.
    fn shape(&self, normals: &[f64], steps: &mut [f64]);

    /// The vector that `shape` makes of this one, with all variances 1.
    fn turn(&self, normals: &[f64]) -> Vec<f64>;

    /// Keeps so much of the matrix and adds the squares of rows [factors x genes], each times its factor.
    fn update(&mut self, keep: f64, factors: &[f64], rows: &[f64]);

    /// The largest variance of a gene.
    fn largest_variance(&self) -> f64;

    /// The smallest and the largest variance along an axis.
    fn extremes(&self) -> [f64; 2];

    /// Multiplies all variances.
    fn scale(&mut self, factor: f64);

    /// The matrix [genes x genes].
    fn matrix(&self) -> Vec<f64>;

    /// The number of generations between two saved states.
    fn snapshot_interval(genes: usize) -> u32;

    /// Bytes of a saved state.
    fn state_length(genes: usize) -> usize;

    /// Appends the state.
    fn save(&self, state: &mut Vec<u8>);

    /// Restores a state. On error the state is incomplete.
    ///
    /// # Errors
    /// Returns [`EvoError::State`].
    fn restore(&mut self, reader: &mut StateReader<'_>) -> Result<(), EvoError>;
}

/// A normal distribution, its evolution paths and the samples that wait for their fitness.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Distribution<C> {
    pub(crate) coefficients: Coefficients,
    /// The mean m \[genes\].
    pub(crate) mean: Vec<f64>,
    /// The step size sigma.
    pub(crate) sigma: f64,
    /// The upper limit of the standard deviation of every gene.
    largest_step: f64,
    /// The covariance C.
    pub(crate) covariance: C,
    /// The path of the step size `p_sigma` \[genes\].
    step_path: Vec<f64>,
    /// The path of the covariance `p_c` \[genes\].
    pub(crate) path: Vec<f64>,
    /// Updates so far, g.
    updates: u32,
    /// The standard normal rows z [individuals x genes].
    normals: Vec<f64>,
    /// The steps y = B D z [individuals x genes].
    steps: Vec<f64>,
}

impl<C: Covariance> Distribution<C> {
    pub(crate) fn new(mean: Vec<f64>, sigma: f64, largest_step: f64, coefficients: Coefficients) -> Self {
        let n = mean.len();
        let covariance = C::identity(n, &coefficients);
        let (normals, steps) = (vec![0.0; coefficients.population() * n], vec![0.0; coefficients.population() * n]);
        let (step_path, path) = (vec![0.0; n], vec![0.0; n]);
        Self { coefficients, mean, sigma, largest_step, covariance, step_path, path, updates: 0, normals, steps }
    }

    /// Draws the individuals of a generation, each from its stream.
    pub(crate) fn sample(&mut self, seed: u64, generation: u32, points: &mut Population<f64>) {
        self.sample_from(|individual| stream(seed, generation, individual), points);
    }

    /// Draws the individuals, each from the stream that belongs to it.
    pub(crate) fn sample_from(&mut self, stream: impl Fn(usize) -> Stream, points: &mut Population<f64>) {
        let n = self.mean.len();
        for (individual, row) in self.normals.chunks_exact_mut(n).enumerate() {
            stream(individual).fill_normal(row);
        }
        self.covariance.shape(&self.normals, &mut self.steps);
        for (point, step) in points.iter_mut().zip(self.steps.chunks_exact(n)) {
            for ((x, y), mean) in point.iter_mut().zip(step).zip(&self.mean) {
                *x = mean + self.sigma * y;
            }
        }
    }

    /// Draws points [individuals x genes] within bounds, each from the stream that belongs to it: again where it is out of them,
    /// at last put at them.
    pub(crate) fn sample_within(&mut self, stream: impl Fn(usize) -> Stream, points: &mut [f64], bounds: &[[f64; 2]]) {
        let n = self.mean.len();
        let Self { mean, sigma, covariance, normals, steps, .. } = self;
        let place = |point: &mut [f64], steps: &[f64]| {
            let mut within = true;
            for (((x, y), mean), [low, high]) in point.iter_mut().zip(steps).zip(&*mean).zip(bounds) {
                *x = mean + *sigma * y;
                within &= (low..=high).contains(&&*x);
            }
            within
        };
        // Individuals have separate streams, so their draws may interleave. Shaping all rows together reads the
        // matrix less often than row by row.
        let mut streams: Vec<Stream> = (0..points.len() / n).map(stream).collect();
        for (stream, row) in streams.iter_mut().zip(normals.chunks_exact_mut(n)) {
            stream.fill_normal(row);
        }
        covariance.shape(normals, steps);
        let rows = normals.chunks_exact_mut(n).zip(steps.chunks_exact_mut(n));
        for (((normals, steps), point), stream) in rows.zip(points.chunks_exact_mut(n)).zip(&mut streams) {
            let mut within = place(point, steps);
            for _ in 0..TRIES {
                if within {
                    break;
                }
                stream.fill_normal(normals);
                covariance.shape(normals, steps);
                within = place(point, steps);
            }
            if !within {
                // The step y stays as drawn: an update uses the point before the clamp.
                point.iter_mut().zip(bounds).for_each(|(x, [low, high])| *x = x.clamp(*low, *high));
            }
        }
    }

    /// Adapts the distribution to its samples, given their numbers, best first.
    pub(crate) fn update(&mut self, ranked: &[usize]) {
        let (n, c) = (self.mean.len(), &self.coefficients);
        let mut weights = vec![0.0; ranked.len()];
        ranked.iter().zip(&c.weights).for_each(|(&individual, weight)| weights[individual] = *weight);
        // y_w and z_w, the weighted means of the parents in order of rank. [Hansen2016] eq. 41.
        let (mut step, mut normal) = (vec![0.0; n], vec![0.0; n]);
        for &individual in ranked.iter().take(c.parents) {
            let row = individual * n..(individual + 1) * n;
            add_scaled(&mut step, weights[individual], &self.steps[row.clone()]);
            add_scaled(&mut normal, weights[individual], &self.normals[row]);
        }
        // m <- m + sigma y_w. [Hansen2016] eq. 42.
        add_scaled(&mut self.mean, self.sigma, &step);
        self.updates = self.updates.saturating_add(1);

        // p_sigma <- (1 - c_sigma) p_sigma + sqrt(c_sigma (2 - c_sigma) mu_eff) C^(-1/2) y_w. [Hansen2016] eq. 43.
        let rate = c.step_path_rate;
        let gain = Scalar::sqrt(rate * (2.0 - rate) * c.effective);
        // C^(-1/2) y_w = B z_w because y = B D z, so no matrix is inverted. A Cholesky factor uses A^-1 y_w = z_w
        // instead.
        for (path, x) in self.step_path.iter_mut().zip(self.covariance.turn(&normal)) {
            *path = (1.0 - rate) * *path + gain * x;
        }
        let length = Scalar::sqrt(dot(&self.step_path, &self.step_path));
        let stalls = c.stalls(n, self.updates, length);
        // p_c <- (1 - c_c) p_c + h_sigma sqrt(c_c (2 - c_c) mu_eff) y_w. [Hansen2016] eq. 45.
        let rate = c.path_rate;
        let gain = if stalls { 0.0 } else { Scalar::sqrt(rate * (2.0 - rate) * c.effective) };
        for (path, y) in self.path.iter_mut().zip(&step) {
            *path = (1.0 - rate) * *path + gain * y;
        }

        // C <- keep C + c_1 p_c p_c^T + c_mu sum w_i y_i y_i^T. Negative weights are scaled by n / |z_i|^2, so that C stays
        // positive definite. [Hansen2016] eqs. 46 and 47.
        // A stalled path lacks variance. C keeps c_1 c_c (2 - c_c) more of itself in return.
        let lost = if stalls { c.rank_one * rate * (2.0 - rate) } else { 0.0 };
        let keep = 1.0 + lost - c.rank_one - c.rank_mu * c.weights.iter().sum::<f64>();
        // Factors are in the order of the individuals, as the rows of `steps` are.
        let mut factors: Vec<f64> = Vec::with_capacity(weights.len() + 1);
        for (&weight, normal) in weights.iter().zip(self.normals.chunks_exact(n)) {
            let square = dot(normal, normal);
            let shorter = if weight >= 0.0 {
                1.0
            } else if square > 0.0 {
                n as f64 / square
            } else {
                0.0
            };
            factors.push(c.rank_mu * weight * shorter);
        }
        factors.push(c.rank_one);
        // The path is the last row, so that one pass through C adds all squares.
        let mut rows = core::mem::take(&mut self.steps);
        rows.extend_from_slice(&self.path);
        self.covariance.update(keep, &factors, &rows);
        rows.truncate(ranked.len() * n);
        self.steps = rows;

        // sigma grows where the path is longer than that of a random walk. [Hansen2016] eq. 44.
        let growth = exp(c.step_path_rate / c.damping * (length / c.expected - 1.0));
        self.sigma = (self.sigma * growth).clamp(STEP_SIZES[0], STEP_SIZES[1]);
        self.normalize();
        self.limit();
    }

    /// Lowers the step size where the standard deviation of a gene passes its limit, as `maxstd` of pycma does.
    fn limit(&mut self) {
        let deviation = self.sigma * Scalar::sqrt(self.covariance.largest_variance());
        if deviation > self.largest_step {
            self.sigma = (self.sigma * (self.largest_step / deviation)).max(STEP_SIZES[0]);
        }
    }

    /// Moves variance from the covariance to the step size when there is very much or very little, which leaves the
    /// distribution as it is.
    fn normalize(&mut self) {
        let [_, largest] = self.covariance.extremes();
        if !(VARIANCES[0]..=VARIANCES[1]).contains(&largest) {
            // The product sigma^2 C is invariant. The path p_c scales as sqrt(C), while p_sigma has no scale.
            let root = Scalar::sqrt(largest);
            self.covariance.scale(1.0 / largest);
            for x in &mut self.path {
                *x /= root;
            }
            self.sigma = (self.sigma * root).clamp(STEP_SIZES[0], STEP_SIZES[1]);
        }
    }

    /// The standard deviation along the longest axis, in the unit of the genes.
    pub(crate) fn longest_axis(&self) -> f64 {
        self.sigma * Scalar::sqrt(self.covariance.extremes()[1])
    }

    /// The ratio of the longest to the shortest axis of the distribution.
    pub(crate) fn axis_ratio(&self) -> f64 {
        let [smallest, largest] = self.covariance.extremes();
        Scalar::sqrt(largest / smallest)
    }

    /// Bytes of a saved state.
    pub(crate) fn state_length(genes: usize) -> usize {
        4 + 8 * (1 + 3 * genes) + C::state_length(genes)
    }

    /// Appends the state, without the samples.
    pub(crate) fn save(&self, state: &mut Vec<u8>) {
        // Samples follow from the seed, the generation and these numbers.
        state.extend(self.updates.to_le_bytes());
        push_reals(state, &[self.sigma]);
        for row in [&self.mean, &self.step_path, &self.path] {
            push_reals(state, row);
        }
        self.covariance.save(state);
    }

    /// Restores a state. On error the state is incomplete.
    pub(crate) fn restore(&mut self, reader: &mut StateReader<'_>) -> Result<(), EvoError> {
        self.updates = reader.u32()?;
        let mut sigma = [0.0];
        bounded(reader, &mut sigma, STEP_SIZES)?;
        [self.sigma] = sigma;
        bounded(reader, &mut self.mean, [-STATE, STATE])?;
        bounded(reader, &mut self.step_path, [-STATE, STATE])?;
        bounded(reader, &mut self.path, [-STATE, STATE])?;
        self.covariance.restore(reader)
    }
}

/// Reads a row of numbers within limits.
pub(crate) fn bounded(reader: &mut StateReader<'_>, row: &mut [f64], limits: [f64; 2]) -> Result<(), EvoError> {
    reader.row(row, "a number within its limits", limits)
}

/// The weighted sum of rows for each of many sums [sums x n], the rows taken in blocks that stay in the cache.
#[inline(always)]
pub(crate) fn multiply(factors: &[f64], rows: &[f64], n: usize, sums: &mut [f64]) {
    const BLOCK: usize = 16;
    // Blocks of rows change the order in which sums are visited, but not the order of additions within a sum.
    sums.fill(0.0);
    for (block, rows) in rows.chunks(BLOCK * n).enumerate() {
        for (sum, factors) in sums.chunks_exact_mut(n).zip(factors.chunks_exact(n)) {
            let factors = &factors[block * BLOCK..n.min((block + 1) * BLOCK)];
            add_rows(sum, factors, rows, n);
        }
    }
}
