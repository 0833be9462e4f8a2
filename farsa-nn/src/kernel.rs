//! The inner loops of dense layers and logistic functions, computed for the lanes of a [`Scalar`].
//!
//! Each lane is a target, and targets do not depend on each other. Since each target adds its sources in a fixed order,
//! the results do not depend on the width or the number of vectors. They are also identical if a target is computed
//! twice.

use farsa_num::fearless_simd::{Level, Simd, f32x8};
use farsa_num::{Real, Scalar, logistic};

/// Number of targets from which sums are faster source by source, with SSE2 and with AVX2.
pub(crate) const WIDE: usize = 128;

/// The level of [`Instructions::detect`](farsa_num::Instructions::detect).
pub(crate) fn level() -> Level {
    Level::try_detect().unwrap_or(Level::baseline())
}

/// The first expression with the token of a level's vectors, or the second where a target or a level has none.
macro_rules! by_instructions {
    ($level:ident, $simd:ident => $vectors:expr, $single:expr) => {
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        match ($level.as_avx2(), $level.as_sse2()) {
            (Some($simd), _) => $vectors,
            (_, Some($simd)) => $vectors,
            _ => $single,
        }
        #[cfg(target_arch = "aarch64")]
        match $level.as_neon() {
            Some($simd) => $vectors,
            None => $single,
        }
        #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
        match $level.as_wasm_simd128() {
            Some($simd) => $vectors,
            None => $single,
        }
        #[cfg(not(any(
            target_arch = "x86",
            target_arch = "x86_64",
            target_arch = "aarch64",
            all(target_arch = "wasm32", target_feature = "simd128")
        )))]
        {
            let _ = $level;
            $single;
        }
    };
}

/// A step over neurons in lanes.
pub(crate) trait Lanes {
    /// Number of neurons that are computed together.
    fn widest(&self) -> usize;
    /// Runs the step over this scalar, and over single lanes for the rest.
    fn run<S: Scalar<Real = f32>>(&mut self, simd: S::Simd);
}

/// Steps with the instructions of this level.
// Not inlined, so a program has each step once for each instruction set, as with layers below.
#[inline(never)]
pub(crate) fn step(work: &mut impl Lanes, level: Level) {
    by_instructions!(level, simd => in_vectors(work, simd), one_by_one(work));
}

/// Runs eight neurons in a vector with the instructions of the token, and fewer than eight one by one.
#[allow(dead_code, reason = "eight emulated lanes are larger and slower than one")]
#[inline(always)]
fn in_vectors<V: Simd>(work: &mut impl Lanes, simd: V) {
    if work.widest() < f32x8::<V>::LANES {
        return one_by_one(work);
    }
    simd.vectorize(
        #[inline(always)]
        || work.run::<f32x8<V>>(simd),
    );
}

#[inline(never)]
fn one_by_one(work: &mut impl Lanes) {
    work.run::<f32>(());
}

/// A layer of logistic units, `y_i = sigma( beta_i + sum_j w_ji x_j )` with `sigma(x) = 1/(1 + exp(-slope*x))`.
pub(crate) struct Layer<'a, R = f32> {
    /// Number of targets `i`.
    pub(crate) targets: usize,
    pub(crate) slope: R,
    /// Initial sums `[targets]`, or empty for zeros.
    pub(crate) biases: &'a [R],
    /// Two pairs of sources and weights, added in this order. Weights are source-major `[sources x targets]`, and the
    /// shorter of both lengths counts.
    pub(crate) sources: [(&'a [R], &'a [R]); 2],
}

impl Layer<'_> {
    /// Overwrites the first [`targets`](Self::targets) values of `y`, or as many as there are.
    // Not inlined and not generic, so a program has the loops once for each instruction set and not for each kind of network.
    // AVX-512 would be a third copy without a gain. These loops use nothing of SSE4.2.
    #[inline(never)]
    pub(crate) fn forward(&self, level: Level, y: &mut [f32]) {
        let y = prefix(y, self.targets);
        by_instructions!(level, simd => self.in_vectors(simd, y), self.one_by_one(y));
    }

    /// Computes eight targets in a vector with the instructions of the token, and fewer than eight one by one.
    #[allow(dead_code, reason = "eight emulated lanes are larger and slower than one")]
    #[inline(always)]
    fn in_vectors<V: Simd>(&self, simd: V, y: &mut [f32]) {
        if y.len() < f32x8::<V>::LANES {
            return self.one_by_one(y);
        }
        simd.vectorize(
            #[inline(always)]
            || self.run::<f32x8<V>>(simd, y),
        );
    }

    /// Computes targets without vectors, for other processors and for fewer targets than lanes.
    #[inline(never)]
    fn one_by_one(&self, y: &mut [f32]) {
        // Sums computed together share a source and its loop. Their number is limited by the registers.
        let mut first = 0;
        while first < y.len() {
            first = match y.len() - first {
                8.. => self.block::<8>(first, y),
                // The last block overlaps the previous one: a repeated sum costs less than a separate loop.
                5..8 if y.len() >= 8 => self.block::<8>(y.len() - 8, y),
                4..8 => self.block::<4>(first, y),
                2..4 if y.len() >= 4 => self.block::<4>(y.len() - 4, y),
                _ => self.block::<1>(first, y),
            };
        }
        for y in y {
            *y = logistic(self.slope * *y);
        }
    }

    /// Sums `G` targets from `first` on, writes them to `y` and returns the next target.
    #[inline(always)]
    fn block<const G: usize>(&self, first: usize, y: &mut [f32]) -> usize {
        let from = |values: &'_ [f32]| values.get(first..).and_then(|values| values.first_chunk::<G>()).copied();
        let mut sums = from(self.biases).unwrap_or([0.0; G]);
        for (x, weights) in self.sources {
            // Whole rows, so the loop has no bounds checks.
            for (x, row) in x.iter().zip(weights.chunks_exact(self.targets.max(1))) {
                let Some(row) = row.get(first..).and_then(|row| row.first_chunk::<G>()) else { break };
                for (sum, weight) in sums.iter_mut().zip(row) {
                    *sum += weight * x;
                }
            }
        }
        if let Some(y) = y.get_mut(first..).and_then(|y| y.first_chunk_mut()) {
            *y = sums;
        }
        first + G
    }

    #[inline(always)]
    fn run<S: Scalar<Real = f32>>(&self, simd: S::Simd, y: &mut [f32]) {
        let Some(end) = self.sums::<S>(simd, y) else { return };
        // A separate loop, so this long function is not inlined in each of the three below.
        let slope = S::splat(simd, self.slope);
        let last = y.len() - S::LANES;
        let mut whole = y.chunks_exact_mut(S::LANES);
        for values in &mut whole {
            logistic(slope * S::load(simd, values)).store(values);
        }
        if !whole.into_remainder().is_empty() {
            logistic(slope * end).store(&mut y[last..]);
        }
    }
}

impl<R: Real> Layer<'_, R> {
    /// Overwrites `y` [at most `targets`] with the sums and returns the last vector of them. A partial last vector is
    /// not written. Returns `None` for less than one vector.
    #[inline(always)]
    fn sums<S: Scalar<Real = R>>(&self, simd: S::Simd, y: &mut [R]) -> Option<S> {
        let last = y.len().checked_sub(S::LANES)?;
        // Never with one lane, so a program without vectors contains only one of the two ways.
        if S::LANES > 1 && y.len() >= WIDE {
            self.wide_sums::<S>(simd, y);
            return Some(S::load(simd, &y[last..]));
        }
        // Several at a time, because a sum waits longer for its last addition than for the next weight.
        let (mut first, mut end) = (0, S::splat(simd, R::from_f64(0.0)));
        while first < y.len() {
            let vectors = (y.len() - first).div_ceil(S::LANES);
            (end, first) = match vectors {
                1 => (self.sum::<S, 1>(simd, first, last, y), first + S::LANES),
                2 | 3 => (self.sum::<S, 2>(simd, first, last, y), first + 2 * S::LANES),
                _ => (self.sum::<S, 4>(simd, first, last, y), first + 4 * S::LANES),
            };
        }
        Some(end)
    }

    /// Overwrites `y` [at most `targets`] with the sums. Does nothing for less than one vector.
    #[inline(always)]
    pub(crate) fn all_sums<S: Scalar<Real = R>>(&self, simd: S::Simd, y: &mut [R]) {
        if let Some(end) = self.sums::<S>(simd, y) {
            // The last vector overlaps the previous one, with the same sums.
            let last = y.len() - S::LANES;
            end.store(&mut y[last..]);
        }
    }

    /// Sums `G` vectors of targets from `first` on, writes them to `y` and returns the last of them.
    ///
    /// A vector beyond the targets starts at `last` instead. It overlaps the previous one and is not written.
    #[inline(always)]
    fn sum<S: Scalar<Real = R>, const G: usize>(&self, simd: S::Simd, first: usize, last: usize, y: &mut [R]) -> S {
        let mut at = [last; G];
        let mut sums = [S::splat(simd, R::from_f64(0.0)); G];
        for k in 0..G {
            at[k] = last.min(first + k * S::LANES);
            // Never true, but it removes the bounds checks of every row below.
            if at[k] + S::LANES > self.targets {
                return sums[k];
            }
            if let Some(biases) = self.biases.get(at[k]..at[k] + S::LANES) {
                sums[k] = S::load(simd, biases);
            }
        }
        for (x, mut weights) in self.sources {
            for x in x {
                let Some((row, rest)) = weights.split_at_checked(self.targets) else { break };
                let x = S::splat(simd, *x);
                for k in 0..G {
                    sums[k] += S::load(simd, &row[at[k]..at[k] + S::LANES]) * x;
                }
                weights = rest;
            }
        }
        for k in 0..G {
            if first + k * S::LANES <= last {
                sums[k].store(&mut y[at[k]..at[k] + S::LANES]);
            }
        }
        sums[G - 1]
    }
}

/// The first `len` values, or all where there are fewer.
#[inline]
pub(crate) fn prefix<T>(values: &mut [T], len: usize) -> &mut [T] {
    let len = len.min(values.len());
    values.split_at_mut(len).0
}

#[cfg(test)]
mod tests {
    extern crate std;

    use std::vec::Vec;

    use farsa_num::{Domain, Instructions, Stream};

    use super::*;

    // On this machine only remainders are computed one by one, on others everything.
    #[test]
    fn one_by_one_equals_vectors() {
        let mut stream = Stream::new(1, Domain::Network, 0, 0, 0);
        for targets in 0..80 {
            let mut draw = |count| (0..count).map(|_| stream.range(-6.0, 6.0)).collect::<Vec<f32>>();
            let (x, weights, biases) = (draw(11), draw(11 * targets), draw(targets));
            let sources = [(&x[..4], &weights[..4 * targets]), (&x[4..], &weights[4 * targets..])];
            let layer = Layer { targets, slope: 0.2, biases: &biases, sources };
            let mut alone = std::vec![f32::NAN; targets];
            layer.one_by_one(&mut alone);
            for instructions in Instructions::available() {
                let mut together = std::vec![f32::NAN; targets];
                layer.forward(instructions.level(), &mut together);
                assert!(
                    alone.iter().zip(&together).all(|(a, b)| a.to_bits() == b.to_bits()),
                    "{targets} at {instructions}"
                );
            }
        }
    }
}
