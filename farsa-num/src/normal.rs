//! Efficient generation of many standard normal numbers.

use core::f64::consts::TAU;

use fearless_simd::{Level, Simd, SimdBase, SimdFloat, dispatch, f64x4};

use crate::logarithm::ln_of_unit;
use crate::sin_cos::sin_cos;

/// Pairs in a batch. Each takes a block of the generator.
pub(crate) const PAIRS: usize = 32;

/// Pairs of standard normal numbers from as many blocks of the generator, the first of this counter, in the bits of
/// [`Stream::normal_pair_f64`](crate::Stream::normal_pair_f64), and the words of those blocks.
// Not inlined, so a program has the loops once for each instruction set.
#[inline(never)]
pub(crate) fn normal_pairs(
    level: Level,
    counter: [u32; 4],
    key: [u32; 2],
    row: &mut [f64; 2 * PAIRS],
) -> [[u32; PAIRS]; 4] {
    dispatch!(level, simd => simd.vectorize(
        #[inline(always)]
        || in_vectors(simd, counter, key, row),
    ))
}

/// Loops over pairs. The compiler vectorizes the loop with the instructions of the token.
#[inline(always)]
fn in_vectors<V: Simd>(simd: V, counter: [u32; 4], key: [u32; 2], row: &mut [f64; 2 * PAIRS]) -> [[u32; PAIRS]; 4] {
    let words = philox_of_many(counter, key);
    let [a, b, c, d] = &words;
    let (mut radii, mut angles) = ([0.0; PAIRS], [0.0; PAIRS]);
    for i in 0..PAIRS {
        radii[i] = -2.0 * ln_of_unit(1.0 - uniform(a[i], b[i]));
        angles[i] = uniform(c[i], d[i]) * TAU;
    }
    // The compiler does not vectorize a loop over `sqrt` of libm.
    for radii in radii.chunks_exact_mut(4) {
        SimdFloat::sqrt(f64x4::<V>::from_slice(simd, radii)).store_slice(radii);
    }
    let (mut sines, mut cosines) = ([0.0; PAIRS], [0.0; PAIRS]);
    for i in 0..PAIRS {
        (sines[i], cosines[i]) = sin_cos(angles[i]);
    }
    for (i, pair) in row.as_chunks_mut::<2>().0.iter_mut().enumerate() {
        *pair = [radii[i] * cosines[i], radii[i] * sines[i]];
    }
    words
}

/// The words of as many blocks of [`philox`](crate::philox) with rising counters: of block `i` word `w` at `[w][i]`.
#[inline(always)]
fn philox_of_many<const N: usize>(counter: [u32; 4], key: [u32; 2]) -> [[u32; N]; 4] {
    let mut words = counter.map(|word| [word; N]);
    for (i, first) in words[0].iter_mut().enumerate() {
        *first = first.wrapping_add(i as u32);
    }
    let [mut k0, mut k1] = key;
    let [a, b, c, d] = &mut words;
    for _ in 0..10 {
        for i in 0..N {
            let p = u64::from(a[i]) * 0xD251_1F53;
            let q = u64::from(c[i]) * 0xCD9E_8D57;
            (a[i], b[i], c[i], d[i]) = ((q >> 32) as u32 ^ b[i] ^ k0, q as u32, (p >> 32) as u32 ^ d[i] ^ k1, p as u32);
        }
        k0 = k0.wrapping_add(0x9E37_79B9);
        k1 = k1.wrapping_add(0xBB67_AE85);
    }
    words
}

/// The number in [0, 1) of two words, the lower one first: the same as of their 53 highest bits, without a conversion
/// of 64.
#[inline(always)]
fn uniform(low: u32, high: u32) -> f64 {
    (f64::from(high) * 2_097_152.0 + f64::from(low >> 11)) * (1.0 / 9_007_199_254_740_992.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Domain, Instructions, Stream};

    #[test]
    fn pairs_are_those_of_the_stream_with_any_instructions() {
        let mut state = Stream::from_seed(5);
        for instructions in Instructions::available() {
            for _ in 0..200 {
                let (counter, key) = ([state.next_u32(), 0x0400_0001, 7, state.next_u32()], [3, 9]);
                let mut stream = Stream::new(9 << 32 | 3, Domain::Mutation, 1, 7, counter[3]);
                stream.seek(4 * u64::from(counter[0]));
                let mut row = [0.0; 2 * PAIRS];
                normal_pairs(instructions.level(), counter, key, &mut row);
                for pair in row.as_chunks::<2>().0 {
                    assert_eq!(pair.map(f64::to_bits), stream.normal_pair_f64().map(f64::to_bits), "{instructions}");
                }
            }
        }
    }

    #[test]
    fn rows_and_what_follows_are_those_of_pairs() {
        for skipped in 0..6 {
            for length in (0..150).chain([792, 1001]) {
                let mut stream = Stream::from_seed(11);
                (0..skipped).for_each(|_| _ = stream.next_u32());
                let mut pairs = stream;
                let mut row = std::vec![0.0_f64; length];
                stream.fill_normal(&mut row);
                for numbers in row.chunks(2) {
                    let pair = pairs.normal_pair_f64();
                    assert!(numbers.iter().zip(pair).all(|(a, b)| a.to_bits() == b.to_bits()), "{skipped} {length}");
                }
                assert_eq!(stream, pairs, "{skipped} {length}");
            }
        }
    }
}
