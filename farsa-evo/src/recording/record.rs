//! A record that can rebuild every genome of a search.

use alloc::vec;
use alloc::vec::Vec;

use crate::error::EvoError;
use crate::fitness::Fitness;
use crate::gene::Gene;
use crate::population::Population;
use crate::recording::progress::{Progress, Taken, next};
use crate::recording::shape::{Kept, Shape};
use crate::recording::writer::{RecordEntry, RecordWriter};
use crate::score_shape::ScoreShape;
use crate::scores::Scores;
use crate::strategy::Strategy;

/// A record of the reported fitness of every generation, in the form that the strategy depends on.
///
/// A strategy is a pure function of its configuration, its seed and the reported fitness. Replaying the recorded fitness
/// into a new instance therefore reconstructs the same genomes, bit for bit, without evaluations. A generation of a hundred
/// individuals takes about a hundred bytes where only their order counts, and eight hundred where values do.
///
/// For a fast reconstruction, the record also stores states of a strategy with a [`Snapshot`](crate::Snapshot). It stores
/// them as often as they at most double its size, or as often as the strategy requires because it is slow to replay. The
/// required interval doubles for every 256 MiB of states.
///
/// ```
/// use farsa_evo::{Fitness, Record, Strategy};
/// use farsa_evo::words::{GaConfig, TruncationGa};
///
/// let fresh = || TruncationGa::new(GaConfig { population: 6, parents: 2, ..GaConfig::new(3) }, 5);
/// let mut evolution = fresh()?;
/// let mut record = Record::new(&mut evolution)?;
/// let first = evolution.ask().clone();
/// let fitness = [0.0, 3.0, 1.0, 9.0, 2.0, 2.0].map(Fitness::nan_as_failed);
/// record.tell(&mut evolution, &fitness)?;
/// assert_eq!(record.order(0), Some(vec![3, 1, 4, 5, 2, 0]));
/// assert_eq!(record.champion(0, 0), Some(3));
///
/// let mut again = fresh()?;
/// record.rebuild(&mut again, 1)?;
/// assert_eq!(again, evolution);
/// assert_eq!(record.genomes(&mut fresh()?, 0)?, first);
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "RawRecord", into = "RawRecord"))]
pub struct Record {
    shape: Shape,
    /// A frame of [`Shape::frame`] bytes for each generation: the champion of each population, then what was recorded.
    frames: Vec<u8>,
    /// Saved states, the earliest first.
    keyframes: Vec<Keyframe>,
    /// Their bytes, one after the other. Separate allocations would fragment the memory of the generations.
    states: Vec<u8>,
}

/// The state of a strategy at a generation.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Keyframe {
    generation: u32,
    /// Where its bytes end.
    end: usize,
}

impl Record {
    /// Creates an empty record for a strategy that is still in generation 0.
    ///
    /// # Errors
    /// Returns [`EvoError::Record`] for a strategy past generation 0, or one that requires recorded genomes and cannot
    /// save its state. [`EvoError::Config`] for populations of unequal sizes.
    pub fn new<G: Gene>(strategy: &mut (impl Strategy<G> + ?Sized)) -> Result<Self, EvoError> {
        Progress::new(strategy).map(|progress| Self::empty(progress.shape))
    }

    fn empty(shape: Shape) -> Self {
        Self { shape, frames: Vec::new(), keyframes: Vec::new(), states: Vec::new() }
    }

    /// The state of the record.
    pub(super) fn progress(&self) -> Progress {
        let state = self.keyframes.len().checked_sub(1).and_then(|last| self.state(last)).map_or(0, <[u8]>::len);
        let saved = self.keyframes.last().map_or(0, |keyframe| keyframe.generation);
        let states = self.states.len() as u64;
        Progress { shape: self.shape, generations: self.generations(), saved, state, states }
    }

    /// Creates a writer that continues this record.
    pub fn writer(&self) -> RecordWriter {
        RecordWriter::going_on(self.progress())
    }

    /// The saved state in this place among them.
    fn state(&self, place: usize) -> Option<&[u8]> {
        let start = place.checked_sub(1).map_or(Some(0), |before| Some(self.keyframes.get(before)?.end))?;
        self.states.get(start..self.keyframes.get(place)?.end)
    }

    /// Keeps the state of a strategy as it is now.
    fn keep_state(&mut self, state: &[u8]) {
        self.states.extend_from_slice(state);
        self.keyframes.push(Keyframe { generation: self.generations(), end: self.states.len() });
    }

    /// Reports the fitness \[individuals\] of a generation to a strategy and records it. Use this instead of
    /// [`Strategy::tell`] if you keep a record.
    ///
    /// # Errors
    /// Returns [`EvoError::Record`] for a strategy that is not at the end of this record, that has another number of
    /// champions than populations, or that does not advance. [`EvoError::State`] for a champion outside its population.
    /// The errors of [`Strategy::tell`]. Nothing is recorded then.
    pub fn tell<G: Gene>(
        &mut self,
        strategy: &mut (impl Strategy<G> + ?Sized),
        fitness: &[Fitness],
    ) -> Result<(), EvoError> {
        let taken = self.progress().fitness(strategy, fitness)?;
        self.keep(&taken);
        Ok(())
    }

    /// Reports the scores of a generation to a strategy and records them. This is the counterpart of
    /// [`tell`](Self::tell) for strategies that require scores.
    ///
    /// # Errors
    /// Returns the errors of [`tell`](Self::tell) and [`Strategy::tell_scores`]. Nothing is recorded then.
    pub fn tell_scores<G: Gene>(
        &mut self,
        strategy: &mut (impl Strategy<G> + ?Sized),
        scores: &Scores,
    ) -> Result<(), EvoError> {
        let taken = self.progress().scores(strategy, scores)?;
        self.keep(&taken);
        Ok(())
    }

    /// Keeps a generation.
    fn keep(&mut self, (frame, state): &Taken) {
        self.frames.extend_from_slice(frame);
        if let Some(state) = state {
            self.keep_state(state);
        }
    }

    /// Checks that this record fits a strategy.
    ///
    /// # Errors
    /// Returns [`EvoError::Record`].
    pub fn check<G: Gene>(&self, strategy: &(impl Strategy<G> + ?Sized)) -> Result<(), EvoError> {
        self.shape.check_strategy(strategy)
    }

    /// Number of generations recorded so far. Since generations are numbered from 0, this is also the number of the
    /// current one.
    pub fn generations(&self) -> u32 {
        (self.frames.len() / self.shape.frame().max(1)) as u32
    }

    /// Number of populations.
    pub fn populations(&self) -> usize {
        self.shape.populations
    }

    /// Number of individuals in each population.
    pub fn size(&self) -> usize {
        self.shape.individuals / self.shape.populations.max(1)
    }

    /// Computes how many bytes the recorded data takes, including saved states.
    pub fn bytes(&self) -> usize {
        self.frames.len() + self.states.len()
    }

    /// The champions of a generation and what was recorded of it.
    fn frame(&self, generation: u32) -> Option<(&[u8], &[u8])> {
        let frame = self.frames.chunks_exact(self.shape.frame().max(1)).nth(generation as usize)?;
        frame.split_at_checked(self.shape.populations * self.shape.width())
    }

    /// Gets the best individual of a population in a recorded generation. Its index counts through all populations.
    pub fn champion(&self, population: usize, generation: u32) -> Option<usize> {
        self.shape.indices(self.frame(generation)?.0).nth(population)
    }

    /// Sorts the individuals of a recorded generation, best first, with ties broken by index. If genomes are recorded
    /// instead of fitness, this returns `None`.
    pub fn order(&self, generation: u32) -> Option<Vec<usize>> {
        match self.shape.recorded {
            Kept::Order => Some(self.shape.indices(self.frame(generation)?.1).collect()),
            Kept::Values | Kept::Scores(_) => Some(Fitness::ranking(&self.told(generation)?.fitness())),
            Kept::Genomes => None,
        }
    }

    /// The scores of a generation, or a fitness of the same order.
    fn told(&self, generation: u32) -> Option<Scores> {
        let (_, bytes) = self.frame(generation)?;
        match self.shape.recorded {
            Kept::Order => {
                // Any values in this order lead to the same next generation.
                let mut fitness = vec![Fitness::WORST; self.shape.individuals];
                for (rank, individual) in self.shape.indices(bytes).enumerate() {
                    *fitness.get_mut(individual)? = Fitness::nan_as_failed(-(rank as f64));
                }
                Some(Scores::from_fitness(&fitness))
            }
            Kept::Values => Scores::nan_as_failed(ScoreShape::FITNESS, reals(bytes).collect()).ok(),
            Kept::Scores(shape) => Scores::nan_as_failed(shape, reals(bytes).collect()).ok(),
            Kept::Genomes => None,
        }
    }

    /// Advances a strategy to the given generation, before the fitness of that generation is reported. The strategy can
    /// be new or at an earlier generation of this record.
    ///
    /// # Errors
    /// Returns [`EvoError::Record`] for a generation beyond the record or before that of the strategy, for a strategy
    /// of another kind or size, and where genomes are recorded. [`EvoError::State`] for a saved state of another
    /// generation. The errors of the strategy.
    pub fn rebuild<G: Gene>(
        &self,
        strategy: &mut (impl Strategy<G> + ?Sized),
        generation: u32,
    ) -> Result<(), EvoError> {
        self.check(strategy)?;
        let latest = self.generations();
        if generation > latest || generation < strategy.generation() {
            return Err(EvoError::no_such_generation(generation, latest));
        }
        let usable = |keyframe: &Keyframe| keyframe.generation <= generation;
        let keyframe = self.keyframes.iter().enumerate().rev().find(|(_, keyframe)| usable(keyframe));
        // A state that is not later than the strategy saves no replay.
        let keyframe = keyframe.filter(|(_, keyframe)| keyframe.generation > strategy.generation());
        let keyframe = keyframe.and_then(|(place, keyframe)| Some((keyframe, self.state(place)?)));
        if let (Some((keyframe, state)), Some(snapshot)) = (keyframe, strategy.snapshot()) {
            snapshot.restore(state)?;
            let found = strategy.generation();
            if found != keyframe.generation {
                return Err(EvoError::state_content("the generation of a saved state", found.into()));
            }
        }
        while strategy.generation() < generation {
            let told = self.told(strategy.generation()).ok_or_else(EvoError::genomes_only)?;
            next(strategy, |strategy| match told.shape() {
                ScoreShape::FITNESS => strategy.tell(&told.fitness()),
                _ => strategy.tell_scores(&told),
            })?;
        }
        Ok(())
    }

    /// Rebuilds the genomes of a recorded generation [individuals x genes]. The strategy must satisfy the same
    /// requirements as for [`rebuild`](Self::rebuild).
    ///
    /// # Errors
    /// Returns the errors of [`rebuild`](Self::rebuild).
    pub fn genomes<G: Gene>(
        &self,
        strategy: &mut (impl Strategy<G> + ?Sized),
        generation: u32,
    ) -> Result<Population<G>, EvoError> {
        if self.shape.recorded != Kept::Genomes {
            self.rebuild(strategy, generation)?;
            return Ok(strategy.ask().clone());
        }
        let latest = self.generations();
        let (_, bytes) = self.frame(generation).ok_or_else(|| EvoError::no_such_generation(generation, latest))?;
        let mut population = Population::new(self.shape.individuals, self.shape.genes)?;
        for (gene, bytes) in population.as_mut_slice().iter_mut().zip(bytes.chunks_exact(G::BYTES)) {
            let found = || bytes.iter().rev().fold(0, |sum, byte| sum << 8 | u64::from(*byte));
            *gene = G::from_bytes(bytes).ok_or_else(|| EvoError::state_content("a gene", found()))?;
        }
        Ok(population)
    }

    /// Gets the entry of a recorded generation. You can append it to a file and read it back with [`push`](Self::push).
    pub fn entry(&self, generation: u32) -> Option<RecordEntry<'_>> {
        let frame = self.frames.chunks_exact(self.shape.frame().max(1)).nth(generation as usize)?;
        // A state is saved after its generation, so it has the next number.
        let place = self.keyframes.binary_search_by_key(&(generation + 1), |keyframe| keyframe.generation);
        Some(RecordEntry { frame, state: place.ok().and_then(|place| self.state(place)) })
    }

    /// Appends a generation from its [`entry`](Self::entry). This does not need a strategy.
    ///
    /// # Errors
    /// Returns [`EvoError::State`] for an entry of another size or an impossible generation, [`EvoError::NanFitness`],
    /// [`EvoError::LastGeneration`]. Nothing is added then.
    pub fn push(&mut self, entry: RecordEntry<'_>) -> Result<(), EvoError> {
        let (expected, found) = (self.shape.frame(), entry.frame.len());
        if found != expected {
            return Err(EvoError::state_length(expected, found));
        }
        self.generations().checked_add(1).ok_or(EvoError::LastGeneration)?;
        self.believe(entry.frame)?;
        self.frames.extend_from_slice(entry.frame);
        if let Some(state) = entry.state {
            self.keep_state(state);
        }
        Ok(())
    }

    /// Checks that a frame is a possible generation.
    fn believe(&self, frame: &[u8]) -> Result<(), EvoError> {
        let Shape { recorded, populations, individuals, .. } = self.shape;
        let (champions, bytes) = frame.split_at_checked(populations * self.shape.width()).unwrap_or_default();
        for (population, champion) in self.shape.indices(champions).enumerate() {
            if !self.shape.has(population, champion) {
                return Err(EvoError::no_such_individual(champion, individuals));
            }
        }
        match recorded {
            Kept::Order => {
                let mut seen = vec![false; individuals];
                for individual in self.shape.indices(bytes) {
                    match seen.get_mut(individual) {
                        None => return Err(EvoError::no_such_individual(individual, individuals)),
                        Some(true) => return Err(EvoError::selected_twice(individual)),
                        Some(seen) => *seen = true,
                    }
                }
            }
            Kept::Values | Kept::Scores(_) => {
                if reals(bytes).any(f64::is_nan) {
                    return Err(EvoError::NanFitness);
                }
            }
            Kept::Genomes => {}
        }
        Ok(())
    }

    /// Discards all generations from the given one on.
    pub fn truncate(&mut self, generations: u32) {
        self.frames.truncate((generations as usize).saturating_mul(self.shape.frame()));
        self.keyframes.retain(|keyframe| keyframe.generation <= generations);
        self.states.truncate(self.keyframes.last().map_or(0, |keyframe| keyframe.end));
    }
}

/// Numbers as they are saved.
fn reals(bytes: &[u8]) -> impl Iterator<Item = f64> + '_ {
    bytes.as_chunks::<8>().0.iter().map(|bytes| f64::from_le_bytes(*bytes))
}

/// A record as it is read, before anything in it is believed.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename = "Record")]
struct RawRecord {
    shape: Shape,
    frames: Vec<u8>,
    keyframes: Vec<RawKeyframe>,
}

/// The state of a strategy at a generation, with its bytes.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename = "Keyframe")]
struct RawKeyframe {
    generation: u32,
    state: Vec<u8>,
}

#[cfg(feature = "serde")]
impl From<Record> for RawRecord {
    fn from(record: Record) -> Self {
        let states = (0..).map_while(|place| record.state(place).map(Vec::from));
        let keyframes = record.keyframes.iter().zip(states);
        let keyframes = keyframes.map(|(&Keyframe { generation, .. }, state)| RawKeyframe { generation, state });
        Self { shape: record.shape, keyframes: keyframes.collect(), frames: record.frames }
    }
}

#[cfg(feature = "serde")]
impl TryFrom<RawRecord> for Record {
    type Error = EvoError;

    fn try_from(raw: RawRecord) -> Result<Self, EvoError> {
        let RawRecord { shape, frames, keyframes } = raw;
        shape.check_read()?;
        let mut record = Self::empty(shape);
        for RawKeyframe { generation, state } in keyframes {
            record.states.extend(state);
            record.keyframes.push(Keyframe { generation, end: record.states.len() });
        }
        let whole = frames.len().is_multiple_of(shape.frame());
        if !whole || u32::try_from(frames.len() / shape.frame()).is_err() {
            return Err(EvoError::state_length(shape.frame(), frames.len()));
        }
        record.frames = frames;
        record.frames.chunks_exact(shape.frame()).try_for_each(|frame| record.believe(frame))?;
        let rising = record.keyframes.windows(2).all(|pair| pair[0].generation < pair[1].generation);
        let last = record.keyframes.last().map_or(0, |keyframe| keyframe.generation);
        if !rising || last > record.generations() {
            return Err(EvoError::state_content("the generation of a saved state", last.into()));
        }
        Ok(record)
    }
}
