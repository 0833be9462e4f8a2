//! Random genes: a genome's first draw, and the bits that change from parent to child.

use farsa_num::{Stream, ln};

use crate::error::EvoError;

/// Checks the number of bits of a gene.
///
/// # Errors
/// Returns [`EvoError::Config`] for bits outside 1 to 16.
pub(crate) fn check_gene_bits(bits: u32) -> Result<(), EvoError> {
    if (1..=u16::BITS).contains(&bits) { Ok(()) } else { Err(EvoError::gene_bits(bits)) }
}

/// Determines what happens to a bit that is hit by mutation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Mutation {
    /// Replaces the bit by a newly drawn one, as in \[Ferrauto2010\]. It therefore flips with half of the mutation
    /// rate.
    #[default]
    Resample,
    /// Always flips the bit.
    Flip,
}

/// A mutation that hits every bit of a genome independently and with the same probability.
///
/// Each bit is hit as in \[Ferrauto2010\], but only the bits that flip draw random numbers. The gap to the next flip is
/// geometrically distributed (skip sampling). Deviation: [`Mutation::Resample`] at rate p is drawn as flips at rate p / 2,
/// which has the same distribution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BitMutation {
    /// ln(1 - p) of the probability p that a bit flips.
    log_keep: f64,
    /// Bits of a gene.
    gene_bits: u64,
}

impl BitMutation {
    /// Creates a mutation that hits each bit with probability `rate`, 0 to 1.
    ///
    /// # Errors
    /// Returns [`EvoError::Config`] when `rate` is NaN or outside 0 to 1.
    pub fn new(mutation: Mutation, rate: f64) -> Result<Self, EvoError> {
        if !(0.0..=1.0).contains(&rate) {
            return Err(EvoError::rate(rate));
        }
        let p = match mutation {
            Mutation::Resample => 0.5 * rate,
            Mutation::Flip => rate,
        };
        // 1 - p loses the digits of a small p, the series does not.
        let log_keep = if p < 1e-8 { -p - 0.5 * p * p } else { ln(1.0 - p) };
        Ok(Self { log_keep, gene_bits: u64::from(u16::BITS) })
    }

    /// Sets the number of bits of the genes, 1 to 16. All other bits remain unchanged.
    ///
    /// # Errors
    /// Returns [`EvoError::Config`].
    pub fn with_gene_bits(self, bits: u32) -> Result<Self, EvoError> {
        check_gene_bits(bits)?;
        Ok(Self { gene_bits: u64::from(bits), ..self })
    }

    /// Mutates `genes` \[genes\] in place. This draws one gap for each bit that flips and another for the end of the
    /// genome.
    ///
    /// Bits are counted from the first gene on, and from the least significant bit within a gene.
    pub fn apply(self, genes: &mut [u16], stream: &mut Stream) {
        let bits = genes.len() as u64 * self.gene_bits;
        // Bits are independent, so gaps between flips are geometric. Some n p + 1 draws replace n for n bits.
        let mut bit = stream.geometric(self.log_keep);
        while bit < bits {
            if let Some(gene) = genes.get_mut((bit / self.gene_bits) as usize) {
                *gene ^= 1 << (bit % self.gene_bits);
            }
            // At rate 0 a gap is `u64::MAX`, and the sum must not wrap.
            bit = bit.saturating_add(1).saturating_add(stream.geometric(self.log_keep));
        }
    }
}

/// Draws every bit of `genes` \[genes\] at random. Two genes are taken from each number, the lower half first.
pub fn randomize(genes: &mut [u16], stream: &mut Stream) {
    for pair in genes.chunks_mut(2) {
        let word = stream.next_u32();
        for (gene, half) in pair.iter_mut().zip([word as u16, (word >> 16) as u16]) {
            *gene = half;
        }
    }
}

/// Draws genes as [`randomize`] does and keeps the upper `bits` bits of each, 1 to 16.
pub(crate) fn randomize_bits(genes: &mut [u16], bits: u32, stream: &mut Stream) {
    randomize(genes, stream);
    let spare = u16::BITS.saturating_sub(bits);
    for gene in genes {
        *gene = gene.checked_shr(spare).unwrap_or(0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec;
    use alloc::vec::Vec;
    use farsa_num::Domain;
    use proptest::prelude::*;

    /// The distribution in one line: a draw for every bit.
    fn bit_by_bit(genes: &mut [u16], mutation: Mutation, rate: f64, stream: &mut Stream) {
        for gene in genes {
            for bit in 0..u16::BITS {
                if stream.uniform_f64() < rate {
                    let flip = mutation == Mutation::Flip || stream.next_u32() & 1 == 1;
                    *gene ^= u16::from(flip) << bit;
                }
            }
        }
    }

    fn stream(individual: u32) -> Stream {
        Stream::new(11, Domain::Mutation, 0, individual, 1)
    }

    /// Flips of each bit position, and of neighboring pairs together, over `runs` genomes of three genes.
    fn flips(runs: u32, mut mutate: impl FnMut(&mut [u16], &mut Stream)) -> (Vec<f64>, f64) {
        let mut counts = vec![0.0; 48];
        let mut pairs = 0.0;
        for run in 0..runs {
            let mut genes = [0_u16; 3];
            mutate(&mut genes, &mut stream(run));
            let bits: Vec<bool> = (0..48).map(|bit| genes[bit / 16] >> (bit % 16) & 1 == 1).collect();
            for (count, &bit) in counts.iter_mut().zip(&bits) {
                *count += f64::from(u8::from(bit));
            }
            pairs += bits.windows(2).filter(|pair| pair[0] && pair[1]).count() as f64;
        }
        (counts, pairs)
    }

    #[test]
    fn skip_sampling_flips_like_a_draw_for_every_bit() {
        const RUNS: u32 = 20_000;
        let n = f64::from(RUNS);
        let within =
            |observed: f64, trials: f64, p: f64| (observed - trials * p).abs() <= 5.0 * (trials * p * (1.0 - p)).sqrt();
        for mutation in [Mutation::Resample, Mutation::Flip] {
            for rate in [0.001, 0.015, 0.3, 0.5, 0.97, 1.0] {
                let p = if mutation == Mutation::Flip { rate } else { 0.5 * rate };
                let fast = BitMutation::new(mutation, rate).unwrap();
                let (skipped, skipped_pairs) = flips(RUNS, |genes, stream| fast.apply(genes, stream));
                let (naive, naive_pairs) = flips(RUNS, |genes, stream| bit_by_bit(genes, mutation, rate, stream));
                for bit in 0..48 {
                    assert!(within(skipped[bit], n, p), "{mutation:?} {rate} bit {bit}: {}", skipped[bit] / n);
                    assert!(within(naive[bit], n, p), "oracle, {mutation:?} {rate} bit {bit}: {}", naive[bit] / n);
                }
                for total in [skipped.iter().sum::<f64>(), naive.iter().sum()] {
                    assert!(within(total, 48.0 * n, p), "{mutation:?} {rate}: {total}");
                }
                // Neighbors are independent. Overlapping pairs vary up to three times as much as separate ones.
                for pairs in [skipped_pairs, naive_pairs] {
                    let sigma = (3.0 * 47.0 * n * p * p * (1.0 - p * p)).sqrt();
                    assert!((pairs - 47.0 * n * p * p).abs() <= 5.0 * sigma, "{mutation:?} {rate}: {pairs} pairs");
                }
            }
        }
    }

    #[test]
    fn tiny_rates_are_not_lost() {
        let mutation = BitMutation::new(Mutation::Flip, 1e-12).unwrap();
        assert_eq!(mutation.log_keep, -1e-12 - 0.5e-24);
        // The two formulas agree at the boundary.
        let [series, log] =
            [0.999_999e-8, 1.000_001e-8].map(|rate| BitMutation::new(Mutation::Flip, rate).unwrap().log_keep);
        assert!((series / log - 0.999_998).abs() < 1e-7, "{series} {log}");
        for rate in [f64::MIN_POSITIVE, 5e-324] {
            let mut genes = [0; 1000];
            BitMutation::new(Mutation::Flip, rate).unwrap().apply(&mut genes, &mut stream(0));
            assert_eq!(genes, [0; 1000]);
        }
    }

    #[test]
    fn a_rate_of_one_flips_or_redraws_everything() {
        let mut genes = [0b1010, 0xffff, 0];
        BitMutation::new(Mutation::Flip, 1.0).unwrap().apply(&mut genes, &mut stream(0));
        assert_eq!(genes, [!0b1010, 0, 0xffff]);
    }

    #[test]
    fn narrow_genes_stay_narrow_and_flip_as_often() {
        const RUNS: u32 = 20_000;
        let (n, p) = (f64::from(RUNS), 0.3);
        for bits in [1, 5, 8, 15] {
            let mutation = BitMutation::new(Mutation::Flip, p).unwrap().with_gene_bits(bits).unwrap();
            let mut counts = vec![0.0; 3 * bits as usize];
            for run in 0..RUNS {
                let mut genes = [0_u16; 3];
                mutation.apply(&mut genes, &mut stream(run));
                for (index, count) in counts.iter_mut().enumerate() {
                    let gene = &mut genes[index / bits as usize];
                    *count += f64::from(*gene & 1);
                    *gene >>= 1;
                }
                assert_eq!(genes, [0; 3], "{bits} bits");
            }
            for (bit, count) in counts.into_iter().enumerate() {
                assert!((count - n * p).abs() <= 5.0 * (n * p * (1.0 - p)).sqrt(), "{bits} bits, bit {bit}: {count}");
            }
            let (mut wide, mut narrow) = (vec![0; 999], vec![0; 999]);
            randomize(&mut wide, &mut stream(1));
            randomize_bits(&mut narrow, bits, &mut stream(1));
            assert!(wide.iter().zip(&narrow).all(|(wide, narrow)| wide >> (16 - bits) == *narrow));
        }
        let mutation = BitMutation::new(Mutation::Flip, p).unwrap();
        assert_eq!(mutation.with_gene_bits(16).unwrap(), mutation);
        for bits in [0, 17, u32::MAX] {
            assert_eq!(mutation.with_gene_bits(bits), Err(EvoError::gene_bits(bits)));
        }
    }

    #[test]
    fn what_is_no_probability_is_refused() {
        for rate in [-0.1, 1.1, f64::INFINITY] {
            assert_eq!(BitMutation::new(Mutation::Flip, rate), Err(EvoError::rate(rate)));
        }
        assert!(matches!(
            BitMutation::new(Mutation::Resample, f64::NAN),
            Err(EvoError::Config { field: "mutation_rate", .. })
        ));
    }

    #[test]
    fn initial_bits_are_even() {
        let mut genes = vec![0; 10_001];
        randomize(&mut genes, &mut Stream::new(3, Domain::InitialGenome, 0, 0, 0));
        for bit in 0..16 {
            let ones = genes.iter().filter(|&gene| gene >> bit & 1 == 1).count() as f64;
            assert!((ones - 5000.5).abs() < 5.0 * 50.0, "bit {bit}: {ones}");
        }
    }

    proptest! {
        #[test]
        fn rate_zero_changes_nothing(mut genes in proptest::collection::vec(any::<u16>(), 0..20)) {
            let before = genes.clone();
            for mutation in [Mutation::Resample, Mutation::Flip] {
                BitMutation::new(mutation, 0.0).unwrap().apply(&mut genes, &mut stream(0));
            }
            prop_assert_eq!(genes, before);
        }

        #[test]
        fn any_probability_ends(rate in 0.0..=1.0_f64, len in 0..50_usize) {
            let mut genes = vec![0; len];
            BitMutation::new(Mutation::Flip, rate).unwrap().apply(&mut genes, &mut stream(5));
            randomize(&mut genes, &mut stream(6));
        }
    }
}
