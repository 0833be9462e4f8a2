//! Outcomes of individuals against opponents, and selection based on them.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::Stream;

use crate::error::{EvoError, check_setting};
use crate::fitness::Fitness;
use crate::population::Population;

/// A newcomer that replaces a member of a population, see [`Outcomes::replacements`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Replacement {
    /// Index of the member that is replaced.
    pub member: usize,
    /// Index of the newcomer, which is a row of the outcomes.
    pub newcomer: usize,
}

/// Outcomes of each individual against each opponent. Larger is better for the individual.
///
/// It implements generalist selection. Fitness is the mean against all opponents. Training opponents are those with the
/// most different outcomes. A trained individual stays only if it is better against *all* opponents.
///
/// The caller pairs individuals and opponents, and evolves the chosen ones in between.
///
/// Source: \[Simione2020\] and its program `generalist.py`. Deviations: the matrix has one side and any range of outcomes,
/// where in the source the other side has 1 less the outcome. The lower index wins among equals, so a newcomer must be
/// better than the member that it replaces. An individual that failed against an opponent ranks last.
///
/// ```
/// use farsa_evo::coevolution::{Outcomes, Replacement};
///
/// // Three members and a newcomer, against three opponents: the second member beats one and loses against all others.
/// let outcomes = [0.5, 0.5, 0.4, 1.0, 0.0, 0.0, 0.3, 0.6, 0.5, 0.4, 0.5, 0.6];
/// let outcomes = Outcomes::new(3, outcomes.to_vec())?;
/// assert_eq!(outcomes.replacements(1)?, [Replacement { member: 1, newcomer: 3 }]);
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Outcomes {
    opponents: usize,
    /// [individuals x opponents].
    values: Vec<Fitness>,
}

impl Outcomes {
    /// Creates outcomes of individuals against the given number of opponents [individuals x opponents]. If a value is
    /// NaN, that evaluation has failed.
    ///
    /// # Errors
    /// Returns [`EvoError::Config`] for no opponents, no values or too many. [`EvoError::Shape`] if the last individual
    /// has fewer values than there are opponents.
    pub fn new(opponents: usize, values: Vec<f64>) -> Result<Self, EvoError> {
        if opponents == 0 || values.is_empty() {
            return Err(EvoError::no_individuals());
        }
        let individuals = values.len().div_ceil(opponents);
        Population::check(individuals, opponents)?;
        if individuals * opponents != values.len() {
            return Err(EvoError::fitness_count(individuals * opponents, values.len()));
        }
        Ok(Self { opponents, values: values.into_iter().map(Fitness::nan_as_failed).collect() })
    }

    /// Number of individuals.
    pub fn individuals(&self) -> usize {
        self.values.len() / self.opponents
    }

    /// Number of opponents.
    pub fn opponents(&self) -> usize {
        self.opponents
    }

    /// Gets the outcomes of an individual against each opponent \[opponents\], or `None` if there is no such
    /// individual.
    pub fn of(&self, individual: usize) -> Option<&[Fitness]> {
        self.values.chunks_exact(self.opponents).nth(individual)
    }

    /// Computes the fitness of each individual \[individuals\], which is the mean over all opponents.
    pub fn fitness(&self) -> Vec<Fitness> {
        let mean = |row: &[Fitness]| {
            let sum: f64 = row.iter().map(|fitness| fitness.get()).sum();
            Fitness::nan_as_failed(sum / self.opponents as f64)
        };
        self.values.chunks_exact(self.opponents).map(mean).collect()
    }

    /// Chooses the given number of opponents with outcomes that differ as much as possible. The first is drawn. Each of the
    /// others has the largest sum of differences, over all individuals, from those before it. Outcomes that are not finite
    /// do not count.
    ///
    /// # Errors
    /// Returns [`EvoError::OutOfRange`] for none, or more than there are.
    pub fn differing_opponents(&self, count: usize, stream: &mut Stream) -> Result<Vec<usize>, EvoError> {
        let possible = (1..=self.opponents).contains(&count);
        check_setting(possible, "the number of opponents", count as f64, "1 to all opponents")?;
        let mut chosen = vec![stream.below(self.opponents as u32) as usize];
        // For each opponent the differences from all chosen so far.
        let mut apart = vec![0.0; self.opponents];
        while let Some(&latest) = chosen.last().filter(|_| chosen.len() < count) {
            for row in self.values.chunks_exact(self.opponents) {
                let reference = row.get(latest).map_or(0.0, |outcome| outcome.get());
                for (apart, outcome) in apart.iter_mut().zip(row) {
                    let difference = (outcome.get() - reference).abs();
                    *apart += if difference.is_finite() { difference } else { 0.0 };
                }
            }
            let others = (0..self.opponents).filter(|opponent| !chosen.contains(opponent));
            // Among equals `max_by` returns the last, so indices compare in reverse.
            let next = others.max_by(|&a, &b| apart[a].total_cmp(&apart[b]).then(b.cmp(&a)));
            chosen.extend(next);
        }
        Ok(chosen)
    }

    /// Determines which members are replaced by newcomers. Members are the first individuals and newcomers the last. As
    /// many of the best individuals stay as there are members, and worse newcomers replace worse members.
    ///
    /// # Errors
    /// Returns [`EvoError::OutOfRange`] for as many newcomers as individuals, or more.
    pub fn replacements(&self, newcomers: usize) -> Result<Vec<Replacement>, EvoError> {
        let all = self.individuals();
        check_setting(newcomers < all, "the number of newcomers", newcomers as f64, "0 to all individuals but one")?;
        let members = all - newcomers;
        let fitness = self.fitness();
        let order = Fitness::ranking(&fitness);
        let (stay, go) = order.split_at(members);
        // As many members leave as newcomers stay, because `stay` has one place for each member.
        let leaving = go.iter().rev().filter(|&&individual| individual < members);
        let coming = stay.iter().rev().filter(|&&individual| individual >= members);
        Ok(leaving.zip(coming).map(|(&member, &newcomer)| Replacement { member, newcomer }).collect())
    }
}
