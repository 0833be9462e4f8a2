//! The sums of layers with many targets. Their weights do not fit into the near caches.
//!
//! For narrow layers, the inner loops read a few columns of the weights, so each row is on a different page. For wide
//! layers, the sums are stored in `y`, and a few sources at a time are added to all of them. The weights are then read
//! sequentially and can be prefetched by the processor. Since each target adds its sources in the same order, both
//! methods produce the same bits.

use farsa_num::{Real, Scalar};

use crate::kernel::Layer;

/// Number of sources that are added together. Fewer load and store the sums more often, more exceed the registers.
const ROWS: usize = 8;

impl<R: Real> Layer<'_, R> {
    /// Overwrites `y` [at most `targets`, at least one vector's] with the sums.
    // Not inlined, so a program has it once for each instruction set, and the other way stays short.
    #[inline(never)]
    pub(crate) fn wide_sums<S: Scalar<Real = R>>(&self, simd: S::Simd, y: &mut [R]) {
        S::vectorize(
            simd,
            #[inline(always)]
            || self.add_rows::<S>(simd, y),
        );
    }

    /// Keeps the sums of the last vector separate until the end. It may overlap the previous vector, and shared sources
    /// must not be added twice.
    #[inline(always)]
    fn add_rows<S: Scalar<Real = R>>(&self, simd: S::Simd, y: &mut [R]) {
        let Some(last) = y.len().checked_sub(S::LANES) else { return };
        match self.biases.get(..y.len()) {
            Some(biases) => y.copy_from_slice(biases),
            None => y.fill(R::from_f64(0.0)),
        }
        let mut end = S::load(simd, &y[last..]);
        for (x, weights) in self.sources {
            let mut rows = weights.chunks_exact(self.targets.max(1));
            let (together, alone) = x.get(..rows.len()).unwrap_or(x).as_chunks::<ROWS>();
            for x in together {
                end = Rows::next(simd, x, &mut rows, y.len()).add(y, end);
            }
            for x in alone {
                end = Rows::next(simd, &[*x], &mut rows, y.len()).add(y, end);
            }
        }
        end.store(&mut y[last..]);
    }
}

/// A few sources and their weights.
struct Rows<'a, S: Scalar, const N: usize> {
    x: [S; N],
    /// Weights of each source to the requested targets. All slices have the same length.
    weights: [&'a [S::Real]; N],
}

impl<'a, S: Scalar, const N: usize> Rows<'a, S, N> {
    /// Takes the next sources and rows, and the first `targets` weights of each.
    #[inline(always)]
    fn next(simd: S::Simd, x: &[S::Real; N], rows: &mut impl Iterator<Item = &'a [S::Real]>, targets: usize) -> Self {
        let (mut sources, mut weights) = ([S::splat(simd, x[0]); N], [&[][..]; N]);
        for k in 0..N {
            sources[k] = S::splat(simd, x[k]);
            weights[k] = rows.next().and_then(|row| row.get(..targets)).unwrap_or(&[]);
        }
        Self { x: sources, weights }
    }

    /// Adds the sources to the sums in all vectors except the last, and to the last one, which is passed by value.
    #[inline(always)]
    fn add(&self, y: &mut [S::Real], mut end: S) -> S {
        let Some(last) = y.len().checked_sub(S::LANES) else { return end };
        // Never true, but it removes the bounds checks of every vector below.
        if self.weights.iter().any(|row| row.len() != y.len()) {
            return end;
        }
        let mut i = 0;
        // Two at a time, because a sum waits for its last addition.
        while i + S::LANES < last {
            self.add_at::<2>(i, y);
            i += 2 * S::LANES;
        }
        if i < last {
            self.add_at::<1>(i, y);
        }
        for k in 0..N {
            end += S::load(end.simd(), &self.weights[k][last..]) * self.x[k];
        }
        end
    }

    /// Adds the sources to `G` vectors of sums from `first` on.
    #[inline(always)]
    fn add_at<const G: usize>(&self, first: usize, y: &mut [S::Real]) {
        let simd = self.x[0].simd();
        let mut sums = [self.x[0]; G];
        for g in 0..G {
            sums[g] = S::load(simd, &y[first + g * S::LANES..]);
        }
        for k in 0..N {
            for g in 0..G {
                sums[g] += S::load(simd, &self.weights[k][first + g * S::LANES..]) * self.x[k];
            }
        }
        for g in 0..G {
            sums[g].store(&mut y[first + g * S::LANES..]);
        }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use std::vec::Vec;

    use farsa_num::{Domain, Instructions, Stream, logistic};

    use super::*;
    use crate::kernel::{Lanes, WIDE, step};

    /// A layer's sums as a step, so that they are made by chosen instructions.
    struct Sums<'a>(Layer<'a>, &'a mut [f32]);

    impl Lanes for Sums<'_> {
        fn widest(&self) -> usize {
            self.1.len()
        }

        fn run<S: Scalar<Real = f32>>(&mut self, simd: S::Simd) {
            self.0.all_sums::<S>(simd, self.1);
        }
    }

    fn same_bits(a: &[f32], b: &[f32]) -> bool {
        a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits())
    }

    /// Compares sums and responses of the first `wanted` targets with plain loops, by each instruction set.
    fn check(targets: usize, wanted: usize, biases: &[f32], sources: [(&[f32], &[f32]); 2]) {
        let sums: Vec<f32> = (0..wanted)
            .map(|i| {
                let mut sum = biases.get(i).copied().unwrap_or(0.0);
                for (x, weights) in sources {
                    for (x, row) in x.iter().zip(weights.chunks_exact(targets)) {
                        sum += row[i] * x;
                    }
                }
                sum
            })
            .collect();
        let responses: Vec<f32> = sums.iter().map(|sum| logistic(0.2 * sum)).collect();
        for instructions in Instructions::available() {
            let level = instructions.level();
            let case = std::format!(
                "{wanted} of {targets} targets, {} biases, {:?} sources at {instructions:?}",
                biases.len(),
                sources.map(|(x, _)| x.len()),
            );
            let layer = || Layer { targets, slope: 0.2, biases, sources };
            let mut y = std::vec![f32::NAN; wanted];
            step(&mut Sums(layer(), &mut y), level);
            assert!(same_bits(&sums, &y), "sums: {case}");
            y.fill(f32::NAN);
            layer().forward(level, &mut y);
            assert!(same_bits(&responses, &y), "responses: {case}");
        }
    }

    #[test]
    fn sums_equal_plain_loops() {
        let mut stream = Stream::new(1, Domain::Network, 0, 1, 0);
        // Around the first wide layer, each remainder of pairs of vectors, and far from it.
        for targets in (WIDE - 9..WIDE + 18).chain([255, 256, 257, 300, 519]) {
            let mut draw = |count| (0..count).map(|_| stream.range(-6.0, 6.0)).collect::<Vec<f32>>();
            let (x, weights, biases) = (draw(30), draw(30 * targets), draw(targets));
            // Each remainder of rows together, after each other and before.
            for first in 0..=9 {
                for second in [0, 1, 7, 8, 9, 20] {
                    let (near, far) = weights[..(first + second) * targets].split_at(first * targets);
                    let sources = [(&x[..first], near), (&x[first..first + second], far)];
                    check(targets, targets, if second % 2 == 0 { &biases } else { &[] }, sources);
                }
            }
        }
    }

    #[test]
    fn the_shorter_of_sources_and_weights_counts() {
        let mut stream = Stream::new(1, Domain::Network, 0, 2, 0);
        for targets in [WIDE + 3, 200] {
            let mut draw = |count| (0..count).map(|_| stream.range(-6.0, 6.0)).collect::<Vec<f32>>();
            let (x, weights, biases) = (draw(40), draw(40 * targets), draw(targets));
            for wanted in [WIDE - 1, WIDE, WIDE + 1, targets] {
                for rows in 0..18 {
                    // Weights of fewer sources, with a piece of a row left, and sources of fewer weights.
                    let sources = [(&x[..17], &weights[..rows * targets + 5]), (&x[17..17 + rows], &weights[..])];
                    check(targets, wanted, &biases, sources);
                }
            }
        }
    }
}
