//! The two loops that take the time: a dense product and the logistic function over a slice.
//!
//! Both treat targets independently, so neither the tiling below nor the vectors the compiler makes of it can change a
//! bit: what is fixed is the order in which one target adds its sources.

/// Adds `weights * x` to `y`: `y[i] += weights[j*stride + i] * x[j]`, for every target in the order of the sources `j`.
///
/// Uses the shorter of what `x` and `weights` have, and of `y` and `stride`.
#[inline]
pub(crate) fn accumulate(weights: &[f32], stride: usize, x: &[f32], y: &mut [f32]) {
    if stride == 0 {
        return;
    }
    let y = head(y, stride);
    // Sixteen, then eight, then four: the sums of a tile stay in registers over all sources.
    let (weights, y) = tiles::<16>(weights, stride, x, y);
    let (weights, y) = tiles::<8>(weights, stride, x, y);
    let (weights, y) = tiles::<4>(weights, stride, x, y);
    tiles::<1>(weights, stride, x, y);
}

/// Accumulates as many whole tiles of `T` targets as `y` holds; returns the weights and targets that remain.
#[inline]
fn tiles<'w, 'y, const T: usize>(
    mut weights: &'w [f32],
    stride: usize,
    x: &[f32],
    y: &'y mut [f32],
) -> (&'w [f32], &'y mut [f32]) {
    let (tiles, rest) = y.as_chunks_mut::<T>();
    for tile in tiles {
        let mut sums = *tile;
        // A tile's weights are the first T of every row: the rows start where the tile does.
        for (x, row) in x.iter().zip(weights.chunks(stride)) {
            if let Some(row) = row.first_chunk::<T>() {
                for (sum, w) in sums.iter_mut().zip(row) {
                    *sum += w * x;
                }
            }
        }
        *tile = sums;
        weights = weights.get(T..).unwrap_or(&[]);
    }
    (weights, rest)
}

/// Replaces every value by `1/(1 + exp(-slope*value))`.
#[inline]
pub(crate) fn logistic(slope: f32, values: &mut [f32]) {
    for value in values {
        *value = farsa_num::logistic(slope * *value);
    }
}

/// The first `len` values, or all where there are fewer.
#[inline]
pub(crate) fn head(values: &mut [f32], len: usize) -> &mut [f32] {
    let len = len.min(values.len());
    values.split_at_mut(len).0
}
