//! Objectives and measures of an evaluation.

use alloc::vec::Vec;

use crate::error::EvoError;
use crate::fitness::Fitness;
use crate::score_shape::ScoreShape;

impl ScoreShape {
    /// Checks that another shape is the same as this one.
    ///
    /// # Errors
    /// Returns [`EvoError::Shape`].
    pub fn check(self, found: Self) -> Result<(), EvoError> {
        if self.objectives == found.objectives && self.measures == found.measures {
            Ok(())
        } else {
            Err(EvoError::score_shape(self, found))
        }
    }
}

/// Objectives and measures of each individual of a generation, stored row after row.
///
/// Objectives follow the rules of [`Fitness`], so they are never NaN and larger is better. They are minus infinity if
/// the evaluation failed. Measures are always finite. If an evaluation breaks one of these rules, it has failed as a
/// whole. In that case all its objectives become minus infinity and its measures become zero.
///
/// ```
/// use farsa_evo::{ScoreShape, Scores};
///
/// // Speed and minus the energy, and where the robot came to rest.
/// let shape = ScoreShape::new(2, 1);
/// let told = Scores::nan_as_failed(shape, vec![0.5, -3.0, 1.25, 0.7, f64::NAN, 2.0])?;
/// assert_eq!((told.objectives(0), told.measures(0)), (&[0.5, -3.0][..], &[1.25][..]));
/// assert!(told.is_failed(1));
/// assert_eq!(told.fitness()[0].get(), 0.5);
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
///
/// Under the feature `serde` a failed evaluation's objectives are absent numbers, as those of [`Fitness`].
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "RawScores", into = "RawScores"))]
pub struct Scores {
    shape: ScoreShape,
    /// Objectives, then measures, of each individual [individuals x width].
    values: Vec<f64>,
}

impl Scores {
    /// Creates scores of this shape from the objectives and then the measures of each individual [individuals x (m +
    /// d)]. If a row contains a NaN, an infinite measure or an objective of minus infinity, its evaluation has failed.
    ///
    /// # Errors
    /// Returns [`EvoError::OutOfRange`] for a shape without objectives, [`EvoError::Shape`] for a last row that is not
    /// whole.
    pub fn nan_as_failed(shape: ScoreShape, mut values: Vec<f64>) -> Result<Self, EvoError> {
        if shape.objectives == 0 {
            return Err(EvoError::OutOfRange { field: "the number of objectives", value: 0.0, allowed: "1 or more" });
        }
        let (width, found) = (shape.width(), values.len());
        if !found.is_multiple_of(width) {
            return Err(EvoError::score_count(width, found));
        }
        for row in values.chunks_exact_mut(width) {
            let (objectives, measures) = row.split_at_mut(shape.objectives);
            let mut failed = measures.iter().any(|x| !x.is_finite());
            for x in objectives.iter_mut() {
                let fitness = Fitness::nan_as_failed(*x);
                failed |= fitness.is_failed();
                *x = fitness.get();
            }
            // Minus zero becomes zero, so that equal values have equal bits.
            for x in measures.iter_mut() {
                *x += 0.0;
            }
            if failed {
                objectives.fill(f64::NEG_INFINITY);
                measures.fill(0.0);
            }
        }
        Ok(Self { shape, values })
    }

    /// Creates scores like [`nan_as_failed`](Self::nan_as_failed), but treats a NaN as an error. Use this if a NaN
    /// would be a bug in your evaluation.
    ///
    /// # Errors
    /// Returns [`EvoError::NanFitness`], and those of [`nan_as_failed`](Self::nan_as_failed).
    pub fn new(shape: ScoreShape, values: Vec<f64>) -> Result<Self, EvoError> {
        if values.iter().any(|x| x.is_nan()) {
            return Err(EvoError::NanFitness);
        }
        Self::nan_as_failed(shape, values)
    }

    /// Creates scores with a single objective from the fitness \[individuals\].
    pub fn from_fitness(fitness: &[Fitness]) -> Self {
        Self { shape: ScoreShape::FITNESS, values: fitness.iter().map(|fitness| fitness.get()).collect() }
    }

    /// Number of objectives and measures that each individual has.
    pub fn shape(&self) -> ScoreShape {
        self.shape
    }

    /// Number of individuals.
    pub fn len(&self) -> usize {
        self.values.len() / self.shape.width().max(1)
    }

    /// Checks whether there are no individuals.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// Gets all numbers as one slice [individuals x (m + d)].
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Gets the objectives \[m\] of an individual, which are minus infinity if its evaluation failed. If the index is
    /// out of range, the slice is empty.
    pub fn objectives(&self, individual: usize) -> &[f64] {
        self.row(individual).0
    }

    /// Gets the measures \[d\] of an individual, which are zero if its evaluation failed. If the index is out of range,
    /// the slice is empty.
    pub fn measures(&self, individual: usize) -> &[f64] {
        self.row(individual).1
    }

    /// Checks whether the evaluation of an individual failed. If the index is out of range, this returns false.
    pub fn is_failed(&self, individual: usize) -> bool {
        self.objectives(individual).first() == Some(&f64::NEG_INFINITY)
    }

    /// Collects the first objective of every individual \[individuals\]. This is the fitness that logs and champions
    /// use.
    pub fn fitness(&self) -> Vec<Fitness> {
        let rows = self.values.chunks_exact(self.shape.width().max(1));
        rows.map(|row| row.first().map_or(Fitness::WORST, |x| Fitness::nan_as_failed(*x))).collect()
    }

    /// Checks that the scores have the given shape and number of individuals.
    ///
    /// # Errors
    /// Returns [`EvoError::Shape`].
    pub fn check(&self, shape: ScoreShape, individuals: usize) -> Result<(), EvoError> {
        shape.check(self.shape)?;
        let (expected, found) = (individuals, self.len());
        if found == expected { Ok(()) } else { Err(EvoError::fitness_count(expected, found)) }
    }

    fn row(&self, individual: usize) -> (&[f64], &[f64]) {
        let width = self.shape.width();
        let start = individual.saturating_mul(width);
        let row = self.values.get(start..start.saturating_add(width)).unwrap_or_default();
        row.split_at_checked(self.shape.objectives).unwrap_or_default()
    }
}

/// Scores as they are saved.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename = "Judgements")]
struct RawScores {
    shape: ScoreShape,
    values: Vec<Option<f64>>,
}

#[cfg(feature = "serde")]
impl From<Scores> for RawScores {
    fn from(Scores { shape, values }: Scores) -> Self {
        let present = |x: f64| (x > f64::NEG_INFINITY).then_some(x);
        Self { shape, values: values.into_iter().map(present).collect() }
    }
}

#[cfg(feature = "serde")]
impl TryFrom<RawScores> for Scores {
    type Error = EvoError;

    fn try_from(RawScores { shape, values }: RawScores) -> Result<Self, EvoError> {
        Self::new(shape, values.into_iter().map(|x| x.unwrap_or(f64::NEG_INFINITY)).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec;
    use proptest::prelude::*;

    #[test]
    fn what_is_not_whole_is_refused() {
        let shape = ScoreShape::new(2, 1);
        assert_eq!(Scores::new(shape, vec![0.0; 4]), Err(EvoError::score_count(3, 4)));
        assert_eq!(Scores::new(shape, vec![0.0, 1.0, f64::NAN]), Err(EvoError::NanFitness));
        let none = Scores::new(ScoreShape::new(0, 3), Vec::new());
        assert!(matches!(none, Err(EvoError::OutOfRange { field: "the number of objectives", value: 0.0, .. })));
        let told = Scores::new(shape, vec![0.0; 6]).unwrap();
        let fewer = EvoError::score_shape(ScoreShape::FITNESS, shape);
        assert_eq!(told.check(ScoreShape::FITNESS, 2), Err(fewer));
        assert_eq!(told.check(shape, 3), Err(EvoError::fitness_count(3, 2)));
        assert_eq!((told.objectives(2), told.measures(2), told.is_failed(2)), (&[][..], &[][..], false));
    }

    proptest! {
        #[test]
        fn a_row_is_whole_or_failed(
            m in 1_usize..4,
            d in 0_usize..3,
            mut values in proptest::collection::vec(proptest::num::f64::ANY, 0..60),
        ) {
            let shape = ScoreShape::new(m, d);
            values.truncate(values.len() / shape.width() * shape.width());
            let told = Scores::nan_as_failed(shape, values.clone()).unwrap();
            prop_assert_eq!(told.len(), values.len() / shape.width());
            for (individual, row) in values.chunks(shape.width()).enumerate() {
                let good = row[..m].iter().all(|x| *x > f64::NEG_INFINITY) && row[m..].iter().all(|x| x.is_finite());
                prop_assert_eq!(told.is_failed(individual), !good);
                let (objectives, measures) = (told.objectives(individual), told.measures(individual));
                if good {
                    prop_assert!(objectives == &row[..m] && measures == &row[m..]);
                } else {
                    let worst = objectives.iter().all(|x| *x == f64::NEG_INFINITY);
                    prop_assert!(worst && measures.iter().all(|x| *x == 0.0));
                }
                prop_assert_eq!(told.fitness()[individual].get(), objectives[0]);
            }
            // Sanitized values stay the same.
            prop_assert_eq!(Scores::new(shape, told.values().to_vec()), Ok(told));
        }
    }
}
