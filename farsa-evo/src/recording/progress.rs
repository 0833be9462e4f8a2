//! The state of a record, and the encoding of the next generation.

use alloc::vec::Vec;

use crate::error::EvoError;
use crate::fitness::Fitness;
use crate::gene::Gene;
use crate::recording::shape::{Kept, Shape};
use crate::score_shape::ScoreShape;
use crate::scores::Scores;
use crate::snapshot::Snapshot;
use crate::strategy::Strategy;

/// The bytes of a generation, and the state to be saved after it, if one is due.
pub(crate) type Taken = (Vec<u8>, Option<Vec<u8>>);

/// Bytes of saved states after which the interval doubles, and again for every such amount. The record of a long search of
/// many genes is therefore limited to a few times this size.
const ROOM: u64 = 1 << 28;

/// The state of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Progress {
    pub(crate) shape: Shape,
    pub(crate) generations: u32,
    /// The generation of the last saved state, 0 without one.
    pub(crate) saved: u32,
    /// The bytes of that state.
    pub(crate) state: usize,
    /// The bytes of all saved states.
    pub(crate) states: u64,
}

impl Progress {
    /// Starts with a strategy at generation 0.
    ///
    /// # Errors
    /// Returns the errors of [`Record::new`](crate::Record::new).
    pub(crate) fn new<G: Gene>(strategy: &mut (impl Strategy<G> + ?Sized)) -> Result<Self, EvoError> {
        if strategy.generation() != 0 {
            return Err(EvoError::not_at_start(strategy.generation()));
        }
        let shape = Shape::from_strategy(strategy);
        shape.check()?;
        if shape.recorded == Kept::Genomes && strategy.snapshot().is_none() {
            return Err(EvoError::no_snapshot());
        }
        Ok(Self { shape, generations: 0, saved: 0, state: 0, states: 0 })
    }

    /// Counts a generation, and the state that was saved after it.
    pub(crate) fn count(&mut self, state: Option<usize>) {
        self.generations += 1;
        if let Some(state) = state {
            (self.saved, self.state) = (self.generations, state);
            self.states += state as u64;
        }
    }

    /// Reports fitness to a strategy and encodes it.
    ///
    /// # Errors
    /// Returns the errors of [`Record::tell`](crate::Record::tell).
    pub(crate) fn fitness<G: Gene>(
        self,
        strategy: &mut (impl Strategy<G> + ?Sized),
        fitness: &[Fitness],
    ) -> Result<Taken, EvoError> {
        strategy.score_shape().check(ScoreShape::FITNESS)?;
        self.take(strategy, fitness, fitness.iter().map(|fitness| fitness.get()), |strategy| strategy.tell(fitness))
    }

    /// Reports scores to a strategy and encodes them.
    ///
    /// # Errors
    /// Returns the errors of [`Record::tell_scores`](crate::Record::tell_scores).
    pub(crate) fn scores<G: Gene>(
        self,
        strategy: &mut (impl Strategy<G> + ?Sized),
        scores: &Scores,
    ) -> Result<Taken, EvoError> {
        strategy.score_shape().check(scores.shape())?;
        let (fitness, values) = (scores.fitness(), scores.values().iter().copied());
        self.take(strategy, &fitness, values, |strategy| strategy.tell_scores(scores))
    }

    fn take<G: Gene, S: Strategy<G> + ?Sized>(
        self,
        strategy: &mut S,
        fitness: &[Fitness],
        values: impl Iterator<Item = f64>,
        told: impl FnOnce(&mut S) -> Result<(), EvoError>,
    ) -> Result<Taken, EvoError> {
        let Self { shape, generations, .. } = self;
        shape.check_strategy(strategy)?;
        if strategy.generation() != generations {
            return Err(EvoError::other_record("generations", generations as usize));
        }
        let (expected, found) = (shape.individuals, fitness.len());
        if found != expected {
            return Err(EvoError::fitness_count(expected, found));
        }
        let mut frame = Vec::with_capacity(shape.frame());
        // Champions and genomes are those before `tell` replaces the generation.
        let champions = strategy.champions(&strategy.ranked_by(fitness));
        if champions.len() != shape.populations {
            return Err(EvoError::other_record("champions", shape.populations));
        }
        for (population, champion) in champions.into_iter().enumerate() {
            if !shape.has(population, champion) {
                return Err(EvoError::no_such_individual(champion, shape.individuals));
            }
            shape.push_index(&mut frame, champion);
        }
        match shape.recorded {
            Kept::Order => Fitness::ranking(fitness).into_iter().for_each(|index| shape.push_index(&mut frame, index)),
            Kept::Values | Kept::Scores(_) => frame.extend(values.flat_map(f64::to_le_bytes)),
            Kept::Genomes => strategy.ask().as_slice().iter().for_each(|gene| gene.push_bytes(&mut frame)),
        }
        next(strategy, told)?;
        let due = self.due();
        let since = generations + 1 - self.saved;
        let asked = |strategy: &&mut dyn Snapshot| self.spacing(strategy.snapshot_interval());
        let due = |strategy: &&mut dyn Snapshot| due || u64::from(since) >= asked(strategy);
        // Frames of genomes need no states to replay from.
        let kept = shape.recorded != Kept::Genomes;
        Ok((frame, strategy.snapshot().filter(|strategy| kept && due(strategy)).map(|strategy| strategy.save())))
    }

    /// The interval of states for a strategy with a [`Snapshot::snapshot_interval`](crate::Snapshot::snapshot_interval).
    fn spacing(self, asked: u32) -> u64 {
        // A shift of 31 keeps every `u32` within a `u64`.
        u64::from(asked.max(1)) << (self.states / ROOM).min(31)
    }

    /// Returns true if the frames since the last state, with the next, are as long as a state is likely to be.
    fn due(self) -> bool {
        let Self { shape, generations, saved, state, .. } = self;
        // By this rule alone, states take about as many bytes as frames.
        let since = (generations - saved) as usize + 1;
        since.saturating_mul(shape.frame()) >= (shape.gene_bytes * shape.individuals * shape.genes).max(state)
    }
}

/// Checks that a strategy is at the next generation, so that replaying terminates.
pub(crate) fn next<G: Gene, S: Strategy<G> + ?Sized>(
    strategy: &mut S,
    told: impl FnOnce(&mut S) -> Result<(), EvoError>,
) -> Result<(), EvoError> {
    let generation = strategy.generation();
    told(strategy)?;
    let found = strategy.generation();
    if generation.checked_add(1) == Some(found) { Ok(()) } else { Err(EvoError::stuck(generation, found)) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::record::Record;
    use crate::recording::writer::RecordWriter;
    use crate::words::GaConfig;
    use crate::words::TruncationGa;

    #[test]
    fn a_record_and_its_writer_have_kept_as_many_bytes_of_states() {
        let search = || TruncationGa::new(GaConfig { population: 4, parents: 2, ..GaConfig::new(20) }, 1).unwrap();
        let (mut one, mut other) = (search(), search());
        let (mut record, mut writer) = (Record::new(&mut one).unwrap(), RecordWriter::new(&mut other).unwrap());
        for _ in 0..200 {
            record.tell(&mut one, &[Fitness::WORST; 4]).unwrap();
            writer.tell(&mut other, &[Fitness::WORST; 4]).unwrap();
        }
        let progress = writer.progress;
        assert_eq!(record.progress(), progress);
        assert_eq!(progress.states, 5 * progress.state as u64, "{progress:?}");
        record.truncate(100);
        assert_eq!(record.progress().states, 2 * progress.state as u64);
    }

    #[test]
    fn states_that_have_taken_much_are_kept_half_as_often() {
        let mut search = TruncationGa::new(GaConfig::new(1), 1).unwrap();
        let progress = Progress::new(&mut search).unwrap();
        let spacing = |states, asked| Progress { states, ..progress }.spacing(asked);
        let most = [0, ROOM - 1, ROOM, 2 * ROOM - 1, 2 * ROOM, 15 * ROOM, u64::MAX];
        assert_eq!(most.map(|states| spacing(states, 3)), [3, 3, 6, 6, 12, 3 << 15, 3 << 31]);
        assert_eq!((spacing(u64::MAX, u32::MAX), spacing(ROOM, 0)), (u64::from(u32::MAX) << 31, 2));
    }
}
