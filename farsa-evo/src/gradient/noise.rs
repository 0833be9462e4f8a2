//! The random numbers of a generation, drawn anew wherever they are needed, and genomes made of them.

use alloc::vec;
use alloc::vec::Vec;

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

/// The noise of a generation whose individuals mirror each other, kept from when they are made until they are judged: a row of
/// numbers is read in a fourth of the time in which it is drawn again.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Directions {
    genes: usize,
    /// [rows x genes]
    numbers: Vec<f64>,
}

impl Directions {
    /// Room for so many rows.
    pub(super) fn new(rows: usize, genes: usize) -> Self {
        Self { genes, numbers: vec![0.0; rows * genes] }
    }

    /// Draws all rows and makes two genomes of each, which mirror each other at the center: individual 2k adds row k, times sigma,
    /// individual 2k + 1 subtracts it.
    pub(super) fn mirror(&mut self, noise: Noise, population: &mut Population<f64>, center: &[f64], sigma: f64) {
        let genes = self.genes.max(1);
        let rows = self.numbers.chunks_exact_mut(genes);
        for (row, (numbers, pair)) in rows.zip(population.as_mut_slice().chunks_exact_mut(2 * genes)).enumerate() {
            let mut stream = noise.stream(row);
            let (plus, minus) = pair.split_at_mut(genes);
            let blocks = plus.chunks_mut(BLOCK).zip(minus.chunks_mut(BLOCK)).zip(center.chunks(BLOCK));
            for (((plus, minus), center), numbers) in blocks.zip(numbers.chunks_mut(BLOCK)) {
                stream.fill_normal(numbers);
                for (((plus, minus), center), number) in plus.iter_mut().zip(minus).zip(center).zip(numbers) {
                    let x = *number * sigma;
                    *minus = center - x;
                    *plus = x + center;
                }
            }
        }
    }

    /// Adds a row, weighted, to a sum \[genes\].
    pub(super) fn add(&self, row: usize, weight: f64, sum: &mut [f64]) {
        let start = row.saturating_mul(self.genes);
        let numbers = self.numbers.get(start..start.saturating_add(self.genes)).unwrap_or_default();
        vectorized(
            #[inline(always)]
            || sum.iter_mut().zip(numbers).for_each(|(sum, number)| *sum += weight * number),
        );
    }
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

    /// Makes two genomes of each row, which mirror each other at the center: individual 2k adds the noise of row k, times the sigma
    /// of each gene, individual 2k + 1 subtracts it.
    pub(super) fn mirror(self, population: &mut Population<f64>, center: &[f64], sigmas: &[f64]) {
        let len = population.genome_len();
        let mut numbers = [0.0; BLOCK];
        for (row, pair) in population.as_mut_slice().chunks_exact_mut(2 * len).enumerate() {
            let mut stream = self.stream(row);
            let (plus, minus) = pair.split_at_mut(len);
            let blocks = plus.chunks_mut(BLOCK).zip(minus.chunks_mut(BLOCK)).zip(center.chunks(BLOCK));
            for (((plus, minus), center), sigmas) in blocks.zip(sigmas.chunks(BLOCK)) {
                let numbers = numbers.get_mut(..plus.len()).unwrap_or_default();
                stream.fill_normal(numbers);
                numbers.iter_mut().zip(sigmas).for_each(|(x, sigma)| *x *= sigma);
                for (((plus, minus), center), x) in plus.iter_mut().zip(minus).zip(center).zip(numbers) {
                    *minus = center - *x;
                    *plus = *x + center;
                }
            }
        }
    }
}
