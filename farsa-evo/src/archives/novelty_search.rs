//! Novelty search.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::{Domain, Scalar, Stream};

use crate::error::{EvoError, check_range, check_setting, check_share};
use crate::fitness::Fitness;
use crate::gene::Gene;
use crate::population::Population;
use crate::score_shape::ScoreShape;
use crate::scores::Scores;
use crate::snapshot::{Snapshot, StateReader, push_reals};
use crate::strategy::{Genealogy, RecordKind, Strategy, next_scored};

/// Configuration of a [`NoveltySearch`](crate::archives::NoveltySearch), except for its inner strategy.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct NoveltyConfig {
    /// Number of measures d that describe a behavior, 1 to 1000.
    #[cfg_attr(feature = "serde", serde(rename = "descriptors"))]
    pub measures: usize,
    /// Number of nearest behaviors k that the novelty is averaged over. This must be at least 1, and the source uses
    /// 15.
    #[cfg_attr(feature = "serde", serde(rename = "neighbours"))]
    pub neighbors: usize,
    /// Rule that decides which behaviors enter the archive.
    pub archive: ArchiveRule,
    /// Largest number of behaviors in the archive, at least 1. The oldest leave it.
    pub capacity: usize,
}

/// Rule that decides which behaviors enter the archive of a [`NoveltySearch`](crate::archives::NoveltySearch).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum ArchiveRule {
    /// Every behavior enters with the same probability, regardless of its novelty.
    Random {
        /// Probability of an addition, 0 to 1.
        rate: f64,
    },
    /// Behaviors whose novelty is above a threshold, in the unit of the measures. The threshold is multiplied by 1.2 after
    /// a generation with more than `most` additions. It is multiplied by 0.95 after `patience` generations without
    /// additions. It stays between 1e-100 and 1e100.
    Threshold {
        /// Initial threshold, 1e-100 to 1e100.
        first: f64,
        /// Largest number of additions in a generation that does not raise the threshold. The program of the source
        /// uses 4.
        most: usize,
        /// Number of generations without additions after which the threshold is lowered. This must be at least 1, and
        /// the program of the source uses 10.
        patience: u32,
    },
}

impl NoveltyConfig {
    /// Creates a configuration with 15 neighbors as in \[Lehman2011\]. Each behavior enters the archive with a
    /// probability of 0.02, and the archive holds 10 000 of them. Both numbers are our choice.
    pub const fn new(measures: usize) -> Self {
        Self { measures, neighbors: 15, archive: ArchiveRule::Random { rate: 0.02 }, capacity: 10_000 }
    }

    /// Checks that all settings are within their allowed ranges. You usually don't need to call this, since
    /// [`NoveltySearch::new`] does it for you.
    ///
    /// # Errors
    /// Returns [`EvoError::OutOfRange`].
    pub fn validate(&self) -> Result<(), EvoError> {
        let (d, k) = (self.measures, self.neighbors);
        check_setting((1..=1000).contains(&d), "the number of descriptor values", d as f64, "1 to 1000")?;
        check_setting(k > 0, "the number of neighbours", k as f64, "1 or more")?;
        check_setting(self.capacity > 0, "the capacity of the archive", self.capacity as f64, "1 or more")?;
        match self.archive {
            ArchiveRule::Random { rate } => check_share("the rate of the archive", rate),
            ArchiveRule::Threshold { first, patience, .. } => {
                check_range("the first threshold", first, [1e-100, 1e100], "1e-100 to 1e100")?;
                check_setting(patience > 0, "the patience of the archive", f64::from(patience), "1 or more")
            }
        }
    }
}

/// The limits of a threshold.
const THRESHOLDS: [f64; 2] = [1e-100, 1e100];

/// Novelty search, which passes the novelty of each individual's behavior to an inner strategy instead of its fitness.
///
/// Novelty is the mean distance of the measures of a behavior to its k nearest neighbors. These neighbors are searched
/// for in the current generation and in an archive of earlier behaviors. Scores consist of the fitness, which is only
/// logged, and the measures. If an evaluation fails, it has no behavior, and the inner strategy receives a failed
/// fitness.
///
/// Behaviors enter the archive in `tell_scores`, in the order of their index. If they do so by chance, individual `i`
/// of generation `g` draws from the stream (seed, [`Domain::General`], trial 1, `i`, `g`).
///
/// Source: \[Lehman2011\] eq. 1, and its program for the threshold. Deviations: the inner strategy is any strategy, where
/// the source has NEAT. An archive by chance and its capacity are ours. All behaviors of a generation are compared with the archive before
/// any of them enters it.
///
/// ```
/// use farsa_evo::Strategy;
/// use farsa_evo::archives::{NoveltyConfig, NoveltySearch};
/// use farsa_evo::words::{GaConfig, TruncationGa};
///
/// let inner = TruncationGa::new(GaConfig { population: 20, parents: 5, ..GaConfig::new(2) }, 1)?;
/// let mut search = NoveltySearch::new(NoveltyConfig::new(2), inner, 1)?;
/// // Fitness is not what it searches for, but what is reported.
/// let champion = search.evolve(10, |genes, row| {
///     let [x, y] = [0, 1].map(|i| f64::from(genes[i]) / 65_535.0);
///     row.copy_from_slice(&[x + y, x, y]);
/// })?;
/// assert!(champion.fitness.get() > 1.0 && search.novelty().len() == 20);
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct NoveltySearch<S> {
    config: NoveltyConfig,
    seed: u64,
    inner: S,
    /// The divisor of each measure in distances \[d\].
    units: Vec<f64>,
    /// The archive [behaviors x d].
    archive: Vec<f64>,
    /// The threshold of the archive, of effect only where it has one.
    threshold: f64,
    /// Generations since the latest addition, or since the threshold was lowered.
    idle: u32,
    /// The novelty of the latest reported generation.
    novelty: Vec<Fitness>,
}

impl<S> NoveltySearch<S> {
    /// Creates a search around an inner strategy. The archive is empty at first.
    ///
    /// # Errors
    /// Returns the errors of [`NoveltyConfig::validate`]. [`EvoError::Record`] or [`EvoError::Shape`] for an inner
    /// strategy that is past generation 0 or requires scores.
    pub fn new<G: Gene>(config: NoveltyConfig, inner: S, seed: u64) -> Result<Self, EvoError>
    where
        S: Strategy<G> + Snapshot,
    {
        config.validate()?;
        if inner.generation() != 0 {
            return Err(EvoError::not_at_start(inner.generation()));
        }
        ScoreShape::FITNESS.check(inner.score_shape())?;
        let threshold = match config.archive {
            ArchiveRule::Threshold { first, .. } => first,
            ArchiveRule::Random { .. } => THRESHOLDS[0],
        };
        let units = vec![1.0; config.measures];
        Ok(Self { config, seed, inner, units, archive: Vec::new(), threshold, idle: 0, novelty: Vec::new() })
    }

    /// Sets a unit for each measure \[d\], such as its range. Measures are divided by their units before distances are
    /// taken, which is useful if their scales differ.
    ///
    /// # Errors
    /// Returns [`EvoError::OutOfRange`] for another number of units, or one outside 1e-100 to 1e100.
    /// [`EvoError::Record`] after generation 0.
    pub fn with_units<G: Gene>(self, units: &[f64]) -> Result<Self, EvoError>
    where
        S: Strategy<G>,
    {
        if self.inner.generation() != 0 {
            return Err(EvoError::not_at_start(self.inner.generation()));
        }
        let found = units.len();
        check_setting(found == self.units.len(), "the number of units", found as f64, "one for each descriptor value")?;
        for &unit in units {
            check_range("the unit of a descriptor value", unit, [1e-100, 1e100], "1e-100 to 1e100")?;
        }
        Ok(Self { units: units.to_vec(), ..self })
    }

    /// Gets the configuration that this search was created with.
    pub fn config(&self) -> &NoveltyConfig {
        &self.config
    }

    /// Gets the seed that this search was created with.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// Gets the inner strategy that this search drives.
    pub fn inner(&self) -> &S {
        &self.inner
    }

    /// Gets the behaviors in the archive [behaviors x d]. Note that they are divided by the units of the measures.
    pub fn archive(&self) -> &[f64] {
        &self.archive
    }

    /// Gets the current threshold of novelty, in the unit of the measures. If behaviors enter the archive by chance,
    /// this returns `None`.
    pub fn threshold(&self) -> Option<f64> {
        matches!(self.config.archive, ArchiveRule::Threshold { .. }).then_some(self.threshold)
    }

    /// Novelty \[individuals\] of the latest reported generation, in the unit of the measures. This is empty in
    /// generation 0 and after a state was restored.
    pub fn novelty(&self) -> &[Fitness] {
        &self.novelty
    }

    /// Adds behaviors of a generation to the archive.
    fn remember(&mut self, rows: &[Option<&[f64]>], novelty: &[Option<f64>], generation: u32) {
        let before = self.archive.len();
        for (individual, (row, novelty)) in rows.iter().zip(novelty).enumerate() {
            let (Some(row), Some(novelty)) = (row, novelty) else { continue };
            let enters = match self.config.archive {
                ArchiveRule::Random { rate } => {
                    let mut stream = Stream::new(self.seed, Domain::General, 1, individual as u32, generation);
                    stream.uniform_f64() < rate
                }
                ArchiveRule::Threshold { .. } => *novelty > self.threshold,
            };
            if enters {
                self.archive.extend_from_slice(row);
            }
        }
        if let ArchiveRule::Threshold { most, patience, .. } = self.config.archive {
            let added = (self.archive.len() - before) / self.config.measures;
            self.idle = if added == 0 { self.idle.saturating_add(1) } else { 0 };
            // The factors are those of Lehman's program. [Lehman2011].
            if added > most {
                self.threshold = (1.2 * self.threshold).min(THRESHOLDS[1]);
            } else if self.idle >= patience {
                (self.threshold, self.idle) = ((0.95 * self.threshold).max(THRESHOLDS[0]), 0);
            }
        }
        // The oldest behaviors are first.
        let room = self.config.capacity.saturating_mul(self.config.measures);
        self.archive.drain(..self.archive.len().saturating_sub(room));
    }
}

impl<G: Gene, S: Strategy<G> + Snapshot> Strategy<G> for NoveltySearch<S> {
    fn generation(&self) -> u32 {
        self.inner.generation()
    }

    fn ask(&self) -> &Population<G> {
        self.inner.ask()
    }

    fn score_shape(&self) -> ScoreShape {
        ScoreShape::new(1, self.config.measures)
    }

    fn tell(&mut self, fitness: &[Fitness]) -> Result<(), EvoError> {
        self.tell_scores(&Scores::from_fitness(fitness))
    }

    fn tell_scores(&mut self, scores: &Scores) -> Result<(), EvoError> {
        let (count, shape) = (self.inner.ask().len(), ScoreShape::new(1, self.config.measures));
        let generation = self.inner.generation();
        next_scored(generation, count, shape, scores)?;
        let in_units = |measures: &[f64]| measures.iter().zip(&self.units).map(|(x, unit)| x / unit).collect();
        let row = |individual| (!scores.is_failed(individual)).then(|| in_units(scores.measures(individual)));
        let scaled: Vec<Option<Vec<f64>>> = (0..count).map(row).collect();
        let rows: Vec<Option<&[f64]>> = scaled.iter().map(Option::as_deref).collect();
        let found = novelty(&rows, &self.archive, self.config.measures, self.config.neighbors);
        let told: Vec<Fitness> =
            found.iter().map(|novelty| novelty.map_or(Fitness::WORST, Fitness::nan_as_failed)).collect();
        // The archive grows last, so novelty is measured against the archive of earlier generations.
        self.inner.tell(&told)?;
        self.novelty = told;
        self.remember(&rows, &found, generation);
        Ok(())
    }

    fn populations(&self) -> usize {
        self.inner.populations()
    }

    fn record_kind(&self) -> RecordKind {
        match self.inner.record_kind() {
            RecordKind::Genomes => RecordKind::Genomes,
            _ => RecordKind::Values,
        }
    }

    fn snapshot(&mut self) -> Option<&mut dyn Snapshot> {
        Some(self)
    }

    fn genealogy(&self) -> Option<&dyn Genealogy> {
        self.inner.genealogy()
    }

    /// The best individual of all generations, because the search does not improve fitness.
    fn champion_is_best_ever(&self) -> bool {
        self.populations() == 1
    }

    /// The size of the archive, the largest novelty of the latest reported generation, then the numbers of the inner
    /// strategy.
    fn diagnostics(&self) -> Vec<f64> {
        let largest = self.novelty.iter().max().map_or(0.0, |novelty| novelty.get());
        let mut all = vec![(self.archive.len() / self.config.measures) as f64, largest];
        all.extend(self.inner.diagnostics());
        all
    }
}

/// Returns the inner state after its length, then the threshold, the number of archived behaviors and the archive.
impl<S: Snapshot> Snapshot for NoveltySearch<S> {
    fn snapshot_interval(&self) -> u32 {
        self.inner.snapshot_interval()
    }

    fn save(&self) -> Vec<u8> {
        let inner = self.inner.save();
        let mut state = Vec::with_capacity(28 + inner.len() + 8 * self.archive.len());
        state.extend((inner.len() as u64).to_le_bytes());
        state.extend(inner);
        state.extend(self.idle.to_le_bytes());
        push_reals(&mut state, &[self.threshold]);
        state.extend(((self.archive.len() / self.config.measures) as u64).to_le_bytes());
        push_reals(&mut state, &self.archive);
        state
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), EvoError> {
        let size = |bytes: u64| usize::try_from(bytes).unwrap_or(usize::MAX);
        let length = size(StateReader::new(state, state.len())?.u64()?);
        let short = || EvoError::state_length(length.saturating_add(28), state.len());
        let (inner, own) = state.get(8..).and_then(|rest| rest.split_at_checked(length)).ok_or_else(short)?;
        let mut header = StateReader::new(own, own.len())?;
        let (idle, threshold, behaviors) = (header.u32()?, header.real()?, size(header.u64()?));
        if behaviors > self.config.capacity {
            return Err(EvoError::state_content("the behaviors of an archive", behaviors as u64));
        }
        let numbers = behaviors.saturating_mul(self.config.measures);
        let mut reader = StateReader::new(own, numbers.saturating_mul(8).saturating_add(20))?;
        let _ = (reader.u32()?, reader.real()?, reader.u64()?);
        if !(THRESHOLDS[0]..=THRESHOLDS[1]).contains(&threshold) {
            return Err(EvoError::state_content("a threshold of novelty", threshold.to_bits()));
        }
        let mut archive = vec![0.0; numbers];
        reader.reals(&mut archive)?;
        // An error of the inner search leaves the numbers of this one unchanged.
        self.inner.restore(inner)?;
        (self.idle, self.threshold, self.archive) = (idle, threshold, archive);
        self.novelty.clear();
        Ok(())
    }
}

/// Returns the mean distance of each behavior of a generation to the k nearest among the others and the archive, 0 without any.
/// Failed evaluations have no behavior and are no neighbors. [rows x d]
fn novelty(rows: &[Option<&[f64]>], archive: &[f64], d: usize, k: usize) -> Vec<Option<f64>> {
    let mut nearest: Vec<f64> = Vec::with_capacity(k.min(rows.len() + archive.len() / d.max(1)));
    let mut of = |own: usize, behavior: &[f64]| {
        nearest.clear();
        let others = rows.iter().enumerate().filter(|(other, _)| *other != own).filter_map(|(_, row)| *row);
        for other in others.chain(archive.chunks_exact(d.max(1))) {
            let square = other.iter().zip(behavior).fold(0.0, |sum, (a, b)| sum + (a - b) * (a - b));
            // Squares have the order of distances, so roots are needed for the k nearest alone.
            if nearest.len() == k && nearest.last().is_some_and(|farthest| square >= *farthest) {
                continue;
            }
            nearest.truncate(k - 1);
            let place = nearest.partition_point(|near| *near <= square);
            nearest.insert(place, square);
        }
        let sum: f64 = nearest.iter().map(|square| Scalar::sqrt(*square)).sum();
        if nearest.is_empty() { 0.0 } else { sum / nearest.len() as f64 }
    };
    rows.iter().enumerate().map(|(own, row)| row.map(|behavior| of(own, behavior))).collect()
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use proptest::prelude::*;

    use super::*;

    /// By the definition: all distances, sorted.
    fn naive(rows: &[Option<&[f64]>], archive: &[f64], d: usize, k: usize) -> Vec<Option<f64>> {
        let of = |own: usize| {
            let mut all: Vec<&[f64]> = archive.chunks(d).collect();
            all.extend((0..rows.len()).filter(|other| *other != own).filter_map(|other| rows[other]));
            let distance = |other: &&[f64]| {
                other.iter().zip(rows[own].unwrap()).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
            };
            let mut distances: Vec<f64> = all.iter().map(distance).collect();
            distances.sort_by(f64::total_cmp);
            distances.truncate(k);
            distances.iter().sum::<f64>() / distances.len().max(1) as f64
        };
        (0..rows.len()).map(|own| rows[own].map(|_| of(own))).collect()
    }

    proptest! {
        #[test]
        fn novelty_is_that_of_the_definition(
            d in 1_usize..4,
            k in 1_usize..20,
            rows in proptest::collection::vec(-4_i8..5, 0..60),
            failed in proptest::collection::vec(any::<bool>(), 60),
            archive in proptest::collection::vec(-4_i8..5, 0..60),
        ) {
            let row = |values: &[i8]| values[..values.len() / d * d].iter().map(|x| f64::from(*x)).collect::<Vec<f64>>();
            let (all, archive) = (row(&rows), row(&archive));
            let rows: Vec<Option<&[f64]>> = all.chunks(d).zip(&failed).map(|(row, failed)| (!failed).then_some(row)).collect();
            prop_assert_eq!(novelty(&rows, &archive, d, k), naive(&rows, &archive, d, k));
        }
    }

    #[test]
    fn distances_by_hand() {
        let rows: Vec<Option<&[f64]>> = vec![Some(&[0.0, 0.0]), Some(&[3.0, 4.0]), None, Some(&[6.0, 8.0])];
        assert_eq!(
            novelty(&rows, &[0.0, 1.0], 2, 2),
            [Some(3.0), Some(0.5 * (5.0 + 18.0_f64.sqrt())), None, Some(0.5 * (5.0 + 85.0_f64.sqrt()))]
        );
        assert_eq!(novelty(&rows[..1], &[], 2, 5), [Some(0.0)]);
    }
}
