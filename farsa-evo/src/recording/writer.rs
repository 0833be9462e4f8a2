//! A record that is written generation by generation.

use alloc::vec::Vec;

use crate::error::EvoError;
use crate::fitness::Fitness;
use crate::gene::Gene;
use crate::recording::progress::{Progress, Taken};
use crate::scores::Scores;
use crate::strategy::Strategy;

/// An entry of a [`Record`](crate::Record), which holds one generation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RecordEntry<'r> {
    /// Champion of each population, followed by the recorded data.
    pub frame: &'r [u8],
    /// State of the strategy after this generation, if it was saved.
    pub state: Option<&'r [u8]>,
}

/// A record whose generations are written one by one, such as to a file. Its memory does not depend on the number of
/// generations, so it is suitable for very long searches.
///
/// Its entries are those of a [`Record`](crate::Record) of the same search. [`Record::push`](crate::Record::push) reads
/// them, and [`Record::writer`](crate::Record::writer) continues a record.
///
/// ```
/// use farsa_evo::{Fitness, Record, RecordWriter, Strategy};
/// use farsa_evo::words::{GaConfig, TruncationGa};
///
/// let mut evolution = TruncationGa::new(GaConfig { population: 6, parents: 2, ..GaConfig::new(3) }, 5)?;
/// let mut record = Record::new(&mut evolution)?;
/// let mut writer = RecordWriter::new(&mut evolution)?;
/// let fitness = [0.0, 3.0, 1.0, 9.0, 2.0, 2.0].map(Fitness::nan_as_failed);
/// writer.tell(&mut evolution, &fitness)?;
/// record.push(writer.entry().ok_or("nothing was told")?)?;
/// assert_eq!(record.order(0), Some(vec![3, 1, 4, 5, 2, 0]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RecordWriter {
    pub(super) progress: Progress,
    last: Option<Taken>,
}

impl RecordWriter {
    /// Creates a writer for a strategy that is still in generation 0.
    ///
    /// # Errors
    /// Returns the errors of [`Record::new`](crate::Record::new).
    pub fn new<G: Gene>(strategy: &mut (impl Strategy<G> + ?Sized)) -> Result<Self, EvoError> {
        Progress::new(strategy).map(Self::going_on)
    }

    /// For a strategy that has come so far.
    pub(crate) fn going_on(progress: Progress) -> Self {
        Self { progress, last: None }
    }

    /// Reports the fitness \[individuals\] of a generation to a strategy and records it.
    ///
    /// # Errors
    /// Returns the errors of [`Record::tell`](crate::Record::tell). Nothing is recorded then.
    pub fn tell<G: Gene>(
        &mut self,
        strategy: &mut (impl Strategy<G> + ?Sized),
        fitness: &[Fitness],
    ) -> Result<(), EvoError> {
        let taken = self.progress.fitness(strategy, fitness)?;
        self.keep(taken);
        Ok(())
    }

    /// Reports the scores of a generation to a strategy and records them.
    ///
    /// # Errors
    /// Returns the errors of [`Record::tell_scores`](crate::Record::tell_scores). Nothing is recorded then.
    pub fn tell_scores<G: Gene>(
        &mut self,
        strategy: &mut (impl Strategy<G> + ?Sized),
        scores: &Scores,
    ) -> Result<(), EvoError> {
        let taken = self.progress.scores(strategy, scores)?;
        self.keep(taken);
        Ok(())
    }

    fn keep(&mut self, taken: Taken) {
        self.progress.count(taken.1.as_ref().map(Vec::len));
        self.last = Some(taken);
    }

    /// Gets the generation that was recorded last, or `None` before the first.
    pub fn entry(&self) -> Option<RecordEntry<'_>> {
        let (frame, state) = self.last.as_ref()?;
        Some(RecordEntry { frame, state: state.as_deref() })
    }

    /// Number of generations recorded so far. This includes the ones before this writer was created.
    pub fn generations(&self) -> u32 {
        self.progress.generations
    }

    /// Number of populations.
    pub fn populations(&self) -> usize {
        self.progress.shape.populations
    }
}
