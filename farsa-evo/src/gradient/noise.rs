//! The random numbers of a generation, drawn anew wherever they are needed, and genomes made of them.

use farsa_num::{Domain, Stream};

use crate::population::Population;
use crate::vectors::vectorized;

/// Numbers drawn at a time: few enough to stay in the fastest memory, and even, for normal numbers come in pairs.
const BLOCK: usize = 256;

/// The standard normal numbers of a generation: row after row, each from a stream of its own.
#[derive(Clone, Copy)]
pub(super) struct Noise {
    pub(super) seed: u64,
    pub(super) generation: u32,
}

/// The standard deviations of the genes: one for all, or one for each.
#[derive(Clone, Copy)]
pub(super) enum Spread<'s> {
    Same(f64),
    Each(&'s [f64]),
}

impl Noise {
    /// The stream of a row, which is the number of an individual or of a pair.
    fn stream(self, row: usize) -> Stream {
        let domain = if self.generation == 0 { Domain::InitialGenome } else { Domain::Mutation };
        Stream::new(self.seed, domain, 0, row as u32, self.generation)
    }

    /// Draws a whole row.
    pub(super) fn fill(self, row: usize, numbers: &mut [f64]) {
        self.stream(row).fill_normal(numbers);
    }

    /// Adds a row, weighted, to a sum \[genes\].
    pub(super) fn add(self, row: usize, weight: f64, sum: &mut [f64]) {
        let mut stream = self.stream(row);
        let mut numbers = [0.0; BLOCK];
        for sum in sum.chunks_mut(BLOCK) {
            stream.fill_normal(numbers.get_mut(..sum.len()).unwrap_or_default());
            vectorized(
                #[inline(always)]
                || sum.iter_mut().zip(&numbers).for_each(|(sum, number)| *sum += weight * number),
            );
        }
    }

    /// Adds a row, weighted, to a sum \[genes\], and its squares less 1, weighted, to another.
    pub(super) fn add_moments(self, row: usize, weights: [f64; 2], first: &mut [f64], second: &mut [f64]) {
        let mut stream = self.stream(row);
        let mut numbers = [0.0; BLOCK];
        for (first, second) in first.chunks_mut(BLOCK).zip(second.chunks_mut(BLOCK)) {
            stream.fill_normal(numbers.get_mut(..first.len()).unwrap_or_default());
            vectorized(
                #[inline(always)]
                || {
                    for ((first, second), number) in first.iter_mut().zip(second).zip(&numbers) {
                        *first += weights[0] * number;
                        *second += weights[1] * (number * number - 1.0);
                    }
                },
            );
        }
    }

    /// Makes one genome of each row: the center and the scaled noise.
    pub(super) fn spread(self, population: &mut Population<f64>, center: &[f64], sigmas: &[f64]) {
        for (row, genes) in population.iter_mut().enumerate() {
            self.fill(row, genes);
            for ((gene, center), sigma) in genes.iter_mut().zip(center).zip(sigmas) {
                *gene = center + sigma * *gene;
            }
        }
    }

    /// Makes two genomes of each row, which mirror each other at the center: individual 2k adds the noise of row k,
    /// individual 2k + 1 subtracts it.
    pub(super) fn mirror(self, population: &mut Population<f64>, center: &[f64], spread: Spread<'_>) {
        let len = population.genome_len();
        let mut numbers = [0.0; BLOCK];
        for (row, pair) in population.as_mut_slice().chunks_exact_mut(2 * len).enumerate() {
            let mut stream = self.stream(row);
            let (plus, minus) = pair.split_at_mut(len);
            let blocks = plus.chunks_mut(BLOCK).zip(minus.chunks_mut(BLOCK)).zip(center.chunks(BLOCK));
            for (block, ((plus, minus), center)) in blocks.enumerate() {
                let numbers = numbers.get_mut(..plus.len()).unwrap_or_default();
                stream.fill_normal(numbers);
                match spread {
                    Spread::Same(sigma) => numbers.iter_mut().for_each(|x| *x *= sigma),
                    Spread::Each(sigmas) => {
                        numbers.iter_mut().zip(sigmas.iter().skip(block * BLOCK)).for_each(|(x, sigma)| *x *= sigma);
                    }
                }
                for (((plus, minus), center), x) in plus.iter_mut().zip(minus).zip(center).zip(numbers) {
                    *minus = center - *x;
                    *plus = *x + center;
                }
            }
        }
    }
}
