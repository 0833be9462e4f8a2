//! A random number generator with independent streams, addressed by their purpose.

use fearless_simd::Level;

use crate::logarithm::ln;
use crate::normal::{PAIRS, normal_pairs};
use crate::sin_cos::sin_cos;

/// The shortest row that is computed with vectors: half of a batch.
const LEAST: usize = PAIRS;

/// The purpose of a stream. Its number is part of every recorded run and never changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Domain {
    /// Starting positions and other conditions of a trial.
    Start = 0,
    /// Noise of sensors.
    Sensor = 1,
    /// Noise of motors.
    Motor = 2,
    /// Genomes of the first generation.
    InitialGenome = 3,
    /// Selection of parents, mutation and crossover.
    Mutation = 4,
    /// Initial states and the noise of networks.
    Network = 5,
    /// All other purposes. It is used by [`Stream::from_seed`].
    General = 6,
}

/// Computes four 32-bit random words from a counter and a key with the Philox4x32-10 algorithm.
///
/// Source: \[Salmon2011\] section 3.3 with the constants of its `Random123` code. No deviation (the tests contain the
/// published results).
#[inline]
pub fn philox(counter: [u32; 4], key: [u32; 2]) -> [u32; 4] {
    let [mut a, mut b, mut c, mut d] = counter;
    let [mut k0, mut k1] = key;
    for _ in 0..10 {
        let p = u64::from(a) * 0xD251_1F53;
        let q = u64::from(c) * 0xCD9E_8D57;
        (a, b, c, d) = ((q >> 32) as u32 ^ b ^ k0, q as u32, (p >> 32) as u32 ^ d ^ k1, p as u32);
        k0 = k0.wrapping_add(0x9E37_79B9);
        k1 = k1.wrapping_add(0xBB67_AE85);
    }
    [a, b, c, d]
}

/// A stream of random numbers determined by a seed and a purpose.
///
/// A stream is plain data of 44 bytes, and a copy continues at the same position. Two streams never share a block if
/// any argument of [`Stream::new`] differs. A stream repeats after 2^34 words.
///
/// The key consists of the two halves of the seed, with the lower half first. The counter is (block, domain << 24 |
/// trial, individual, generation).
///
/// ```
/// use farsa_num::{Domain, Stream};
///
/// // Sensor noise of trial 3 of individual 17 in generation 120, for any caller and in any order.
/// let mut noise = Stream::new(42, Domain::Sensor, 3, 17, 120);
/// let first = [noise.normal(), noise.normal()];
/// assert_eq!(noise.position(), 4);
/// noise.seek(0);
/// assert_eq!(first, [noise.normal(), noise.normal()]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stream {
    key: [u32; 2],
    /// Counter of the block to draw next.
    counter: [u32; 4],
    words: [u32; 4],
    /// Number of `words` already drawn.
    drawn: u8,
}

impl Stream {
    /// Creates the stream of a seed for one purpose. It starts at the first word.
    ///
    /// The largest value of `trial` is 2^24 - 1. Higher bits are ignored, and the function panics if debug assertions
    /// are enabled.
    #[inline]
    pub const fn new(seed: u64, domain: Domain, trial: u32, individual: u32, generation: u32) -> Self {
        debug_assert!(trial < 1 << 24, "a trial's number has 24 bits");
        let purpose = (domain as u32) << 24 | (trial & 0x00FF_FFFF);
        Self {
            key: [seed as u32, (seed >> 32) as u32],
            counter: [0, purpose, individual, generation],
            words: [0; 4],
            drawn: 4,
        }
    }

    /// Creates a stream for purposes outside of a run. It starts at the first word.
    ///
    /// This is equivalent to `Stream::new(seed, Domain::General, 0, 0, 0)`. The stream does not share any block with
    /// the streams of a run that uses the same seed.
    ///
    /// ```
    /// use farsa_num::Stream;
    ///
    /// let mut dice = Stream::from_seed(7);
    /// let throws = [(); 6].map(|()| 1 + dice.below(6));
    /// assert_eq!(throws, [2, 6, 4, 6, 3, 4]);
    /// ```
    #[inline]
    pub const fn from_seed(seed: u64) -> Self {
        Self::new(seed, Domain::General, 0, 0, 0)
    }

    /// Returns the number of 32-bit words that have been drawn, modulo 2^34.
    #[inline]
    pub fn position(&self) -> u64 {
        let words = 4 * u64::from(self.counter[0]) + u64::from(self.drawn);
        words.wrapping_sub(4) & 0x3_FFFF_FFFF
    }

    /// Moves the stream to a position, as if the given number of words modulo 2^34 had been drawn.
    #[inline]
    pub fn seek(&mut self, position: u64) {
        self.counter[0] = (position >> 2) as u32;
        self.drawn = 4;
        let within = (position & 3) as u8;
        if within > 0 {
            self.refill();
            self.drawn = within;
        }
    }

    #[inline]
    fn refill(&mut self) {
        self.words = philox(self.counter, self.key);
        self.counter[0] = self.counter[0].wrapping_add(1);
        self.drawn = 0;
    }

    /// Draws a 32-bit word.
    #[inline]
    pub fn next_u32(&mut self) -> u32 {
        if self.drawn > 3 {
            self.refill();
        }
        let [a, b, c, d] = self.words;
        let word = match self.drawn {
            0 => a,
            1 => b,
            2 => c,
            _ => d,
        };
        self.drawn += 1;
        word
    }

    /// Draws two words. The first one is the lower half of the result.
    #[inline]
    pub fn next_u64(&mut self) -> u64 {
        let low = u64::from(self.next_u32());
        u64::from(self.next_u32()) << 32 | low
    }

    /// Draws a uniformly distributed number in [0, 1). This is a multiple of 2^-24 and uses one word.
    #[inline]
    pub fn uniform(&mut self) -> f32 {
        (self.next_u32() >> 8) as f32 * (1.0 / 16_777_216.0)
    }

    /// Draws a uniformly distributed number in [0, 1). This is a multiple of 2^-53 and uses two words.
    #[inline]
    pub fn uniform_f64(&mut self) -> f64 {
        (self.next_u64() >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
    }

    /// Draws a uniformly distributed number in [low, high) and uses one word. The result is `low` if the interval is
    /// empty or if a bound is NaN.
    ///
    /// Note that `high - low` must not overflow. Otherwise the result is always the largest number below `high`.
    #[inline]
    pub fn range(&mut self, low: f32, high: f32) -> f32 {
        let x = low + (high - low) * self.uniform();
        // The sum can round up to `high`.
        if low < high { if x < high { x } else { high.next_down() } } else { low }
    }

    /// Draws a uniformly distributed number in [low, high), like [`Stream::range`]. It uses two words.
    #[inline]
    pub fn range_f64(&mut self, low: f64, high: f64) -> f64 {
        let x = low + (high - low) * self.uniform_f64();
        if low < high { if x < high { x } else { high.next_down() } } else { low }
    }

    /// Draws a uniformly distributed integer in 0..n without bias. The result is 0 if n is 0. In most cases it uses one
    /// word.
    ///
    /// Source: \[Lemire2019\] algorithm 5. No deviation.
    #[inline]
    pub fn below(&mut self, n: u32) -> u32 {
        let mut product = u64::from(self.next_u32()) * u64::from(n);
        if (product as u32) < n {
            // 2^32 mod n: this number of the lowest fractions has one word too many.
            let excess = n.wrapping_neg() % n;
            while (product as u32) < excess {
                product = u64::from(self.next_u32()) * u64::from(n);
            }
        }
        (product >> 32) as u32
    }

    /// Draws a standard normal number, the first result of [`Stream::normal_pair`]. It uses two words.
    #[inline]
    pub fn normal(&mut self) -> f32 {
        self.normal_pair()[0]
    }

    /// Draws two independent standard normal numbers with magnitudes below 6.67. They use two words.
    ///
    /// Source: \[Box1958\], computed in `f64` and rounded. Deviation: the radius is computed from a uniform number in
    /// (0, 1].
    #[inline]
    pub fn normal_pair(&mut self) -> [f32; 2] {
        const UNIT: f64 = 1.0 / 4_294_967_296.0;
        let u = (f64::from(self.next_u32()) + 1.0) * UNIT;
        let angle = f64::from(self.next_u32()) * (UNIT * core::f64::consts::TAU);
        let radius = crate::square_root::sqrt(-2.0 * ln(u));
        let (s, c) = sin_cos(angle);
        [(radius * c) as f32, (radius * s) as f32]
    }

    /// Draws two independent standard normal numbers in double precision with magnitudes below 8.58. They use
    /// four words.
    ///
    /// Source: \[Box1958\]. Deviation: the radius is computed from a uniform number in (0, 1] that is a multiple of
    /// 2^-53.
    #[inline]
    pub fn normal_pair_f64(&mut self) -> [f64; 2] {
        // 1 - u of a uniform in [0, 1) is exact, and above 0.
        let u = 1.0 - self.uniform_f64();
        let angle = self.uniform_f64() * core::f64::consts::TAU;
        let radius = crate::square_root::sqrt(-2.0 * ln(u));
        let (s, c) = sin_cos(angle);
        [radius * c, radius * s]
    }

    /// Fills a slice with independent standard normal numbers, drawn in pairs by
    /// [`normal_pair_f64`](Self::normal_pair_f64). If the length is odd, the last number is discarded.
    ///
    /// Long slices are computed with vector instructions. They are detected at run time if the feature `std` is
    /// enabled, and do not change the results.
    pub fn fill_normal(&mut self, row: &mut [f64]) {
        let mut rest = row;
        let level = Level::try_detect().unwrap_or(Level::baseline());
        // Without unused words of a block, a pair is a block.
        while self.drawn > 3 && rest.len() >= LEAST {
            let count = PAIRS.min(rest.len() / 2);
            let (now, later) = rest.split_at_mut(2 * count);
            let words = if let Some(all) = now.first_chunk_mut() {
                normal_pairs(level, self.counter, self.key, all)
            } else {
                let mut all = [0.0; 2 * PAIRS];
                let words = normal_pairs(level, self.counter, self.key, &mut all);
                now.iter_mut().zip(all).for_each(|(x, normal)| *x = normal);
                words
            };
            self.words = words.map(|word| word[count - 1]);
            self.counter[0] = self.counter[0].wrapping_add(count as u32);
            rest = later;
        }
        for pair in rest.chunks_mut(2) {
            pair.iter_mut().zip(self.normal_pair_f64()).for_each(|(x, normal)| *x = normal);
        }
    }

    /// Draws the number of failures before the next success, given ln(1 - p) for a success probability p. It uses two
    /// words.
    ///
    /// This is useful for skip sampling, where only mutating genes are visited. The result is `u64::MAX` if ln(1 - p)
    /// is not below 0 (p = 0 or NaN), and 0 if it is negative infinity (p = 1).
    ///
    /// Source: inversion, \[Devroye1986\] chapter X.2. The uniform number is in (0, 1] and a multiple of 2^-53.
    #[inline]
    pub fn geometric(&mut self, log_one_minus_p: f64) -> u64 {
        let u = ((self.next_u64() >> 11) + 1) as f64 * (1.0 / 9_007_199_254_740_992.0);
        if log_one_minus_p < 0.0 { (ln(u) / log_one_minus_p) as u64 } else { u64::MAX }
    }
}
