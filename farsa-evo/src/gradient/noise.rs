//! The random numbers of a generation, and genomes made of them.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::Stream;

use crate::population::Population;
use crate::search::Step;
use crate::vectors::vectorized;

/// Numbers drawn at a time: few enough to stay in the fastest memory, and even, for normal numbers come in pairs.
const BLOCK: usize = 256;

/// The standard deviations of the genes: one for all, or one for each.
#[derive(Clone, Copy)]
pub(super) enum Spread<'s> {
    Same(f64),
    Each(&'s [f64]),
}

/// The noise of a generation of mirrored individuals, kept until the update. To read a row takes a fourth of the time of
/// drawing it again.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Directions {
    genes: usize,
    /// [rows x genes]
    numbers: Vec<f64>,
}

impl Directions {
    /// Allocates the given number of rows.
    pub(super) fn new(rows: usize, genes: usize) -> Self {
        Self { genes, numbers: vec![0.0; rows * genes] }
    }

    /// Draws all rows and makes two genomes of each, which mirror each other at the center: individual 2k adds row k, scaled,
    /// individual 2k + 1 subtracts it.
    pub(super) fn mirror(
        &mut self,
        stream: impl Fn(usize) -> Stream,
        population: &mut Population<f64>,
        center: &[f64],
        spread: Spread<'_>,
    ) {
        let mut scaled = [0.0; BLOCK];
        let genes = self.genes.max(1);
        let rows = self.numbers.chunks_exact_mut(genes);
        for (row, (numbers, pair)) in rows.zip(population.as_mut_slice().chunks_exact_mut(2 * genes)).enumerate() {
            let mut stream = stream(row);
            let (plus, minus) = pair.split_at_mut(genes);
            let blocks = plus.chunks_mut(BLOCK).zip(minus.chunks_mut(BLOCK)).zip(center.chunks(BLOCK));
            for (block, (((plus, minus), center), numbers)) in blocks.zip(numbers.chunks_mut(BLOCK)).enumerate() {
                stream.fill_normal(numbers);
                match spread {
                    Spread::Same(sigma) => {
                        scaled.iter_mut().zip(&*numbers).for_each(|(x, number)| *x = *number * sigma);
                    }
                    Spread::Each(sigmas) => {
                        let sigmas = sigmas.iter().skip(block * BLOCK);
                        let each = scaled.iter_mut().zip(&*numbers).zip(sigmas);
                        each.for_each(|((x, number), sigma)| *x = *number * sigma);
                    }
                }
                for (((plus, minus), center), x) in plus.iter_mut().zip(minus).zip(center).zip(&scaled) {
                    *minus = center - *x;
                    *plus = *x + center;
                }
            }
        }
    }

    fn row(&self, row: usize) -> &[f64] {
        let start = row.saturating_mul(self.genes);
        self.numbers.get(start..start.saturating_add(self.genes)).unwrap_or_default()
    }

    /// Adds a row, weighted, to a sum \[genes\].
    pub(super) fn add(&self, row: usize, weight: f64, sum: &mut [f64]) {
        let numbers = self.row(row);
        vectorized(
            #[inline(always)]
            || sum.iter_mut().zip(numbers).for_each(|(sum, number)| *sum += weight * number),
        );
    }

    /// Adds a row, weighted, to a sum \[genes\], and its squares less 1, weighted, to another.
    pub(super) fn add_moments(&self, row: usize, weights: [f64; 2], first: &mut [f64], second: &mut [f64]) {
        add_moments(self.row(row), weights, first, second);
    }
}

/// Adds numbers, weighted, to a sum, and their squares less 1, weighted, to another.
fn add_moments(numbers: &[f64], weights: [f64; 2], first: &mut [f64], second: &mut [f64]) {
    vectorized(
        #[inline(always)]
        || {
            for ((first, second), number) in first.iter_mut().zip(second).zip(numbers) {
                // For x = mu + sigma z, d ln p / d mu = z / sigma and d ln p / d sigma = (z^2 - 1) / sigma. The
                // callers apply the factors of sigma.
                *first += weights[0] * number;
                *second += weights[1] * (number * number - 1.0);
            }
        },
    );
}

/// The standard normal numbers of a generation, row after row. Each individual has a row from its stream.
impl<C> Step<'_, C> {
    /// Adds a row, weighted, to a sum \[genes\], and its squares less 1, weighted, to another.
    pub(super) fn add_moments(&self, row: usize, weights: [f64; 2], first: &mut [f64], second: &mut [f64]) {
        let mut stream = self.stream(row);
        // The row is drawn again instead of stored. Blocks are even, so the pairs of normal numbers are those of one
        // long row.
        let mut numbers = [0.0; BLOCK];
        for (first, second) in first.chunks_mut(BLOCK).zip(second.chunks_mut(BLOCK)) {
            stream.fill_normal(numbers.get_mut(..first.len()).unwrap_or_default());
            add_moments(&numbers, weights, first, second);
        }
    }

    /// Makes one genome of each row: the center and the scaled noise.
    pub(super) fn spread(&self, population: &mut Population<f64>, center: &[f64], sigmas: &[f64]) {
        for (row, genes) in population.iter_mut().enumerate() {
            self.stream(row).fill_normal(genes);
            for ((gene, center), sigma) in genes.iter_mut().zip(center).zip(sigmas) {
                *gene = center + sigma * *gene;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// More genes than are scaled at once.
    #[test]
    fn each_gene_has_its_own_deviation() {
        let genes = 2 * BLOCK + 7;
        let center: Vec<f64> = (0..genes).map(|gene| gene as f64).collect();
        let sigmas: Vec<f64> = (0..genes).map(|gene| 1.0 + 0.01 * gene as f64).collect();
        let step = Step { config: &(), seed: 5, generation: 2 };
        let made = |spread: Spread<'_>| {
            let mut population = Population::new(4, genes).unwrap();
            Directions::new(2, genes).mirror(|row| step.stream(row), &mut population, &center, spread);
            population
        };
        let (same, each) = (made(Spread::Same(1.0)), made(Spread::Each(&sigmas)));
        for individual in 0..4 {
            let (same, each) = (same.get(individual).unwrap(), each.get(individual).unwrap());
            for gene in 0..genes {
                let [unit, scaled] = [same, each].map(|genome| genome[gene] - center[gene]);
                assert!((scaled - sigmas[gene] * unit).abs() < 1e-9, "{individual} {gene}: {scaled} {unit}");
            }
        }
        assert_ne!(same.get(0), same.get(2));
    }
}
