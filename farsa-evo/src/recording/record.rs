//! What a strategy was told: enough to rebuild every genome of a search.

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

/// What a strategy was told in every generation, in the form that it depends on.
///
/// A strategy is a pure function of its configuration, its seed and what it was told. Telling a fresh one the same again
/// therefore makes the same genomes, bit for bit, without evaluating anything. Of a hundred individuals a generation takes
/// some hundred bytes where only their order counts, and eight hundred where values do.
///
/// So that a long search is rebuilt quickly, the record also keeps the state of a strategy that can save it
/// ([`Snapshot`](crate::Snapshot)), as often as that at most doubles the size of the record, or as the strategy asks for because
/// it takes long to be told again: half as often once such states take 256 MiB, and again for each 256 MiB more.
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
    /// Their bytes, one after the other's: an allocation for each of them, small and kept for ever, would lie between those of a
    /// generation and leave more memory unused than it takes.
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
    /// The record of a strategy that has not been told anything.
    ///
    /// # Errors
    /// [`EvoError::AlreadyTold`]; [`EvoError::UnevenPopulations`]; [`EvoError::NoSnapshot`] for a strategy of which genomes
    /// are recorded and that cannot save its state: nothing could make it go on.
    pub fn new<G: Gene>(strategy: &mut (impl Strategy<G> + ?Sized)) -> Result<Self, EvoError> {
        Progress::new(strategy).map(|progress| Self::empty(progress.shape))
    }

    fn empty(shape: Shape) -> Self {
        Self { shape, frames: Vec::new(), keyframes: Vec::new(), states: Vec::new() }
    }

    /// How far it has come.
    pub(super) fn progress(&self) -> Progress {
        let state = self.keyframes.len().checked_sub(1).and_then(|last| self.state(last)).map_or(0, <[u8]>::len);
        let saved = self.keyframes.last().map_or(0, |keyframe| keyframe.generation);
        let states = self.states.len() as u64;
        Progress { shape: self.shape, generations: self.generations(), saved, state, states }
    }

    /// Records the same search from here on, for a record that goes on elsewhere.
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

    /// Tells a strategy the fitness \[individuals\] of its generation, and records it.
    ///
    /// # Errors
    /// [`EvoError::OtherRecord`] for a strategy that is not at the end of this record, or that names another number of
    /// champions than it has populations; [`EvoError::NoSuchIndividual`] for a champion that is not of its population;
    /// [`EvoError::Stuck`]; and those of [`Strategy::tell`]. Nothing is recorded then.
    pub fn tell<G: Gene>(
        &mut self,
        strategy: &mut (impl Strategy<G> + ?Sized),
        fitness: &[Fitness],
    ) -> Result<(), EvoError> {
        let taken = self.progress().fitness(strategy, fitness)?;
        self.keep(&taken);
        Ok(())
    }

    /// Tells a strategy the scores of its generation, and records them.
    ///
    /// # Errors
    /// Those of [`tell`](Self::tell) and [`Strategy::tell_scores`]. Nothing is recorded then.
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

    /// Whether this is a record for a strategy like this one.
    ///
    /// # Errors
    /// [`EvoError::OtherRecord`].
    pub fn check<G: Gene>(&self, strategy: &(impl Strategy<G> + ?Sized)) -> Result<(), EvoError> {
        self.shape.check_strategy(strategy)
    }

    /// Number of generations that were told, which is that of the generation that waits for its fitness.
    pub fn generations(&self) -> u32 {
        (self.frames.len() / self.shape.frame().max(1)) as u32
    }

    /// Number of populations.
    pub fn populations(&self) -> usize {
        self.shape.populations
    }

    /// Number of individuals of each population.
    pub fn size(&self) -> usize {
        self.shape.individuals / self.shape.populations.max(1)
    }

    /// Bytes of what was recorded, saved states included.
    pub fn bytes(&self) -> usize {
        self.frames.len() + self.states.len()
    }

    /// The champions of a generation and what was recorded of it.
    fn frame(&self, generation: u32) -> Option<(&[u8], &[u8])> {
        let frame = self.frames.chunks_exact(self.shape.frame().max(1)).nth(generation as usize)?;
        frame.split_at_checked(self.shape.populations * self.shape.width())
    }

    /// The best individual of a population in a generation that was told, counted through all populations.
    pub fn champion(&self, population: usize, generation: u32) -> Option<usize> {
        self.shape.indices(self.frame(generation)?.0).nth(population)
    }

    /// The individuals of a generation that was told, best first, equals by index; none where genomes are recorded.
    pub fn order(&self, generation: u32) -> Option<Vec<usize>> {
        match self.shape.recorded {
            Kept::Order => Some(self.shape.indices(self.frame(generation)?.1).collect()),
            Kept::Values | Kept::Scores(_) => Some(Fitness::ranking(&self.told(generation)?.fitness())),
            Kept::Genomes => None,
        }
    }

    /// What makes a strategy of this kind do what it did: the scores, or a fitness of the same order.
    fn told(&self, generation: u32) -> Option<Scores> {
        let (_, bytes) = self.frame(generation)?;
        match self.shape.recorded {
            Kept::Order => {
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

    /// Brings a strategy, fresh or at an earlier generation of this record, to the generation with this number, as it was
    /// before it was told its fitness.
    ///
    /// # Errors
    /// [`EvoError::NoSuchGeneration`] for one that lies ahead of the record or behind the strategy, [`EvoError::OtherRecord`]
    /// for a strategy of another kind or size, [`EvoError::GenomesOnly`] where genomes are recorded,
    /// [`EvoError::StateContent`] for a saved state of another generation, [`EvoError::Stuck`], and whatever the strategy
    /// refuses.
    pub fn rebuild<G: Gene>(
        &self,
        strategy: &mut (impl Strategy<G> + ?Sized),
        generation: u32,
    ) -> Result<(), EvoError> {
        self.check(strategy)?;
        let latest = self.generations();
        if generation > latest || generation < strategy.generation() {
            return Err(EvoError::NoSuchGeneration { generation, latest });
        }
        let usable = |keyframe: &Keyframe| keyframe.generation <= generation;
        let keyframe = self.keyframes.iter().enumerate().rev().find(|(_, keyframe)| usable(keyframe));
        let keyframe = keyframe.filter(|(_, keyframe)| keyframe.generation > strategy.generation());
        let keyframe = keyframe.and_then(|(place, keyframe)| Some((keyframe, self.state(place)?)));
        if let (Some((keyframe, state)), Some(snapshot)) = (keyframe, strategy.snapshot()) {
            snapshot.restore(state)?;
            let found = strategy.generation();
            if found != keyframe.generation {
                return Err(EvoError::StateContent { what: "the generation of a saved state", found: found.into() });
            }
        }
        while strategy.generation() < generation {
            let told = self.told(strategy.generation()).ok_or(EvoError::GenomesOnly)?;
            next(strategy, |strategy| match told.shape() {
                ScoreShape::FITNESS => strategy.tell(&told.fitness()),
                _ => strategy.tell_scores(&told),
            })?;
        }
        Ok(())
    }

    /// The genomes of a generation that was told [individuals x genes], with the help of a strategy as
    /// [`rebuild`](Self::rebuild) wants it.
    ///
    /// # Errors
    /// Those of [`rebuild`](Self::rebuild).
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
        let (_, bytes) = self.frame(generation).ok_or(EvoError::NoSuchGeneration { generation, latest })?;
        let mut population = Population::new(self.shape.individuals, self.shape.genes)?;
        for (gene, bytes) in population.as_mut_slice().iter_mut().zip(bytes.chunks_exact(G::BYTES)) {
            let found = || bytes.iter().rev().fold(0, |sum, byte| sum << 8 | u64::from(*byte));
            *gene = G::from_bytes(bytes).ok_or_else(|| EvoError::StateContent { what: "a gene", found: found() })?;
        }
        Ok(population)
    }

    /// What stands for a generation that was told, for a file that grows by it; [`push`](Self::push) takes it back.
    pub fn entry(&self, generation: u32) -> Option<RecordEntry<'_>> {
        let frame = self.frames.chunks_exact(self.shape.frame().max(1)).nth(generation as usize)?;
        let place = self.keyframes.binary_search_by_key(&(generation + 1), |keyframe| keyframe.generation);
        Some(RecordEntry { frame, state: place.ok().and_then(|place| self.state(place)) })
    }

    /// Adds a generation as [`entry`](Self::entry) gave it, after those that there are; a strategy is told nothing.
    ///
    /// # Errors
    /// [`EvoError::StateLength`] for an entry of another size, [`EvoError::LastGeneration`], and those of a generation that no
    /// strategy was told: [`EvoError::NoSuchIndividual`], [`EvoError::SelectedTwice`], [`EvoError::NanFitness`]. Nothing is added then.
    pub fn push(&mut self, entry: RecordEntry<'_>) -> Result<(), EvoError> {
        let (expected, found) = (self.shape.frame(), entry.frame.len());
        if found != expected {
            return Err(EvoError::StateLength { expected, found });
        }
        self.generations().checked_add(1).ok_or(EvoError::LastGeneration)?;
        self.believe(entry.frame)?;
        self.frames.extend_from_slice(entry.frame);
        if let Some(state) = entry.state {
            self.keep_state(state);
        }
        Ok(())
    }

    /// Refuses a generation that no strategy was told.
    fn believe(&self, frame: &[u8]) -> Result<(), EvoError> {
        let Shape { recorded, populations, individuals, .. } = self.shape;
        let (champions, bytes) = frame.split_at_checked(populations * self.shape.width()).unwrap_or_default();
        for (population, champion) in self.shape.indices(champions).enumerate() {
            if !self.shape.has(population, champion) {
                return Err(EvoError::NoSuchIndividual { individual: champion, population: individuals });
            }
        }
        match recorded {
            Kept::Order => {
                let mut seen = vec![false; individuals];
                for individual in self.shape.indices(bytes) {
                    match seen.get_mut(individual) {
                        None => return Err(EvoError::NoSuchIndividual { individual, population: individuals }),
                        Some(true) => return Err(EvoError::SelectedTwice { individual }),
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

    /// Forgets all generations from this one on.
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
            return Err(EvoError::StateLength { expected: shape.frame(), found: frames.len() });
        }
        record.frames = frames;
        record.frames.chunks_exact(shape.frame()).try_for_each(|frame| record.believe(frame))?;
        let rising = record.keyframes.windows(2).all(|pair| pair[0].generation < pair[1].generation);
        let last = record.keyframes.last().map_or(0, |keyframe| keyframe.generation);
        if !rising || last > record.generations() {
            return Err(EvoError::StateContent { what: "the generation of a saved state", found: last.into() });
        }
        Ok(record)
    }
}
