//! Single layers in SIMD lanes. Use these together with batches of worlds.

use farsa_num::fearless_simd::{Level, Simd, f32x8};
use farsa_num::{Instructions, Scalar, logistic};

use crate::error::Error;
use crate::fault::LayoutFault;
use crate::kernel::level;
use crate::network::check_parameters;
use crate::perceptron::Perceptron;

/// Several [`Perceptron`]s that are computed together. They have the same shape and slope but different parameters.
///
/// All slices have the order `[values x lanes]`. The first value of all lanes is followed by the second value of all
/// lanes. Each lane produces the same bits as a single [`Perceptron`].
///
/// ```
/// use farsa_nn::{Controller, Perceptron, PerceptronLanes};
///
/// let mut layers = PerceptronLanes::new(1, 1, 1.0, 8, [0.0; 16])?;
/// for lane in 0..8 {
///     layers.set_lane(lane, &[lane as f32, 0.5])?;
/// }
/// let mut y = [0.0; 8];
/// layers.step(&[1.0; 8], &mut y);
/// let mut alone = [0.0];
/// Perceptron::new(1, 1, 1.0, [3.0, 0.5])?.step(&[1.0], &mut alone);
/// assert_eq!(y[3], alone[0]);
/// # Ok::<(), farsa_nn::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct PerceptronLanes<P> {
    inputs: usize,
    outputs: usize,
    slope: f32,
    lanes: usize,
    parameters: P,
    level: Level,
}

impl<P: AsRef<[f32]>> PerceptronLanes<P> {
    /// Creates layers with the given parameters. Their number must be [`parameter_count`](Perceptron::parameter_count)
    /// x lanes.
    ///
    /// # Errors
    /// Returns [`Error::Layout`] if the slope is invalid, [`Error::Length`] or [`Error::Parameter`].
    pub fn new(inputs: usize, outputs: usize, slope: f32, lanes: usize, parameters: P) -> Result<Self, Error> {
        LayoutFault::check_slope(slope)?;
        let count = Perceptron::parameter_count(inputs, outputs).saturating_mul(lanes);
        check_parameters(count, count, parameters.as_ref(), |p| p)?;
        Ok(Self { inputs, outputs, slope, lanes, parameters, level: level() })
    }

    /// Selects the instructions of the processor used. The results do not change.
    pub fn with_instructions(self, instructions: Instructions) -> Self {
        Self { level: instructions.level(), ..self }
    }

    /// Gets the number of layers.
    pub fn lanes(&self) -> usize {
        self.lanes
    }

    /// Computes the outputs `y` [outputs x lanes] of all layers from the inputs `x` [inputs x lanes]. Does nothing if
    /// one of the slices is too short.
    pub fn step(&self, x: &[f32], y: &mut [f32]) {
        let enough = x.len() >= self.inputs * self.lanes && y.len() >= self.outputs * self.lanes;
        debug_assert!(enough, "{} inputs and {} outputs of {} lanes", self.inputs, self.outputs, self.lanes);
        if !enough {
            return;
        }
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        {
            if let (Some(simd), true) = (self.level.as_avx512(), self.lanes >= 16) {
                return self.vectors::<farsa_num::fearless_simd::f32x16<_>>(simd, x, y);
            }
            if let Some(simd) = self.level.as_avx2() {
                return self.vectors::<f32x8<_>>(simd, x, y);
            }
            if let Some(simd) = self.level.as_sse2() {
                return self.vectors::<f32x8<_>>(simd, x, y);
            }
        }
        farsa_num::fearless_simd::dispatch!(self.level, simd => self.any(simd, x, y));
    }

    #[inline(always)]
    fn any<V: Simd>(&self, simd: V, x: &[f32], y: &mut [f32]) {
        self.vectors::<f32x8<V>>(simd, x, y);
    }

    fn vectors<S: Scalar<Real = f32>>(&self, simd: S::Simd, x: &[f32], y: &mut [f32]) {
        S::vectorize(
            simd,
            #[inline(always)]
            || {
                let whole = self.lanes - self.lanes % S::LANES;
                self.run::<S>(simd, 0..whole, x, y);
                self.run::<f32>((), whole..self.lanes, x, y);
            },
        );
    }

    #[inline(always)]
    fn run<S: Scalar<Real = f32>>(&self, simd: S::Simd, lanes: core::ops::Range<usize>, x: &[f32], y: &mut [f32]) {
        let parameters = self.parameters.as_ref();
        let (stride, targets) = (self.lanes, self.outputs);
        let slope = S::splat(simd, self.slope);
        let mut first = lanes.start;
        while first < lanes.end {
            for i in 0..targets {
                let mut sum = S::load(simd, &parameters[(self.inputs * targets + i) * stride + first..]);
                for j in 0..self.inputs {
                    let weight = S::load(simd, &parameters[(j * targets + i) * stride + first..]);
                    sum += weight * S::load(simd, &x[j * stride + first..]);
                }
                logistic(slope * sum).store(&mut y[i * stride + first..]);
            }
            first += S::LANES;
        }
    }
}

impl<P: AsRef<[f32]> + AsMut<[f32]>> PerceptronLanes<P> {
    /// Sets the parameters of one layer, in the order of a [`Perceptron`]. Their number must be
    /// [`parameter_count`](Perceptron::parameter_count).
    ///
    /// The lane must exist. Otherwise the call has no effect.
    ///
    /// # Errors
    /// Returns [`Error::Length`] or [`Error::Parameter`]. In this case nothing is changed.
    pub fn set_lane(&mut self, lane: usize, parameters: &[f32]) -> Result<(), Error> {
        debug_assert!(lane < self.lanes, "lane {lane} of {}", self.lanes);
        let count = Perceptron::parameter_count(self.inputs, self.outputs);
        check_parameters(count, count, parameters, |p| p)?;
        if lane < self.lanes {
            let values = self.parameters.as_mut().iter_mut().skip(lane).step_by(self.lanes);
            values.zip(parameters).for_each(|(to, x)| *to = *x);
        }
        Ok(())
    }
}
