//! Selection of parents.

use alloc::vec::Vec;

use farsa_num::Stream;

use crate::error::{EvoError, check_range, check_setting};

/// Method used to select parents. Each parent is drawn independently, so an individual may be selected twice.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Selection {
    /// The best of `size` individuals that are drawn uniformly, with replacement \[Goldberg1991\].
    Tournament {
        /// Number of individuals that compete, from 1 to the size of the population.
        size: usize,
    },
    /// Linear ranking \[Baker1985\]: of n individuals that of rank i, from 0, is chosen with probability
    /// (s - 2 (s - 1) i / (n - 1)) / n. Deviation: each parent is drawn by itself, as from a roulette wheel.
    Rank {
        /// Selection pressure s, 1 to 2. This is the expected number of children of the best individual.
        pressure: f64,
    },
    /// Any of the best `parents`, all with the same probability \[Muhlenbein1993\].
    Truncation {
        /// Number of the best individuals to choose from, from 1 to the size of the population.
        parents: usize,
    },
}

/// A selection from a population of a certain size, which answers with ranks, 0 for the best.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Selector {
    selection: Selection,
    population: usize,
    /// For [`Selection::Rank`] the cumulative probability of each rank, else empty.
    summed: Vec<f64>,
}

impl Selector {
    pub(crate) fn new(selection: Selection, population: usize) -> Result<Self, EvoError> {
        let within = |count: usize| (1..=population).contains(&count);
        let mut summed = Vec::new();
        match selection {
            Selection::Tournament { size } => {
                check_setting(within(size), "the size of a tournament", size as f64, "1 to the population")?;
            }
            Selection::Truncation { parents } => {
                check_setting(within(parents), "the number of parents", parents as f64, "1 to the population")?;
            }
            Selection::Rank { pressure } => {
                check_range("the selection pressure", pressure, [1.0, 2.0], "1 to 2")?;
                // The divisor n - 1 of one individual would be 0.
                let (size, last) = (population as f64, population.saturating_sub(1).max(1) as f64);
                let mut sum = 0.0;
                summed.extend((0..population).map(|rank| {
                    sum += (pressure - 2.0 * (pressure - 1.0) * rank as f64 / last) / size;
                    sum
                }));
            }
        }
        Ok(Self { selection, population, summed })
    }

    /// The rank of a parent.
    pub(crate) fn draw(&self, stream: &mut Stream) -> usize {
        let below = |stream: &mut Stream, count: usize| stream.below(count as u32) as usize;
        match self.selection {
            Selection::Tournament { size } => {
                // Ranks begin with the best, so the smallest one wins.
                (0..size).map(|_| below(stream, self.population)).min().unwrap_or_default()
            }
            Selection::Truncation { parents } => below(stream, parents),
            Selection::Rank { .. } => {
                let ball = stream.uniform_f64();
                // Rounding may leave the last sum below 1.
                self.summed.partition_point(|sum| *sum <= ball).min(self.population.saturating_sub(1))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The share of each of five ranks in a hundred thousand draws.
    fn shares(selection: Selection) -> [f64; 5] {
        let selector = Selector::new(selection, 5).unwrap();
        let mut stream = Stream::from_seed(3);
        let mut counts = [0_u32; 5];
        (0..100_000).for_each(|_| counts[selector.draw(&mut stream)] += 1);
        counts.map(|count| f64::from(count) / 100_000.0)
    }

    #[test]
    fn ranks_are_drawn_with_their_probabilities() {
        // A tournament of two is won by rank i with ((5 - i)^2 - (4 - i)^2) / 25.
        let want = [
            (Selection::Tournament { size: 2 }, [0.36, 0.28, 0.20, 0.12, 0.04]),
            (Selection::Tournament { size: 1 }, [0.2; 5]),
            (Selection::Rank { pressure: 2.0 }, [0.4, 0.3, 0.2, 0.1, 0.0]),
            (Selection::Rank { pressure: 1.5 }, [0.3, 0.25, 0.2, 0.15, 0.1]),
            (Selection::Truncation { parents: 2 }, [0.5, 0.5, 0.0, 0.0, 0.0]),
        ];
        for (selection, want) in want {
            let got = shares(selection);
            // Five standard deviations of a share of a half.
            assert!(got.iter().zip(want).all(|(got, want)| (got - want).abs() < 0.008), "{selection:?}: {got:?}");
        }
    }
}
