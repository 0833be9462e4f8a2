//! A generic search with one population, which many strategies of this crate are built on.

use alloc::vec::Vec;
use core::fmt;

use farsa_num::{Domain, Stream};

use crate::error::EvoError;
use crate::fitness::Fitness;
use crate::gene::Gene;
use crate::population::Population;
use crate::snapshot::{Snapshot, StateReader, push_reals};
use crate::strategy::{Genealogy, RecordKind, Strategy, next_generation};

/// Configuration, seed and generation for which an algorithm makes genomes.
#[derive(Clone, Copy, Debug)]
pub struct Step<'a, C> {
    pub(crate) config: &'a C,
    pub(crate) seed: u64,
    pub(crate) generation: u32,
}

impl<C> Step<'_, C> {
    /// The stream of an individual, or of a pair.
    pub(crate) fn stream(&self, individual: usize) -> Stream {
        stream(self.seed, self.generation, individual)
    }

    /// The step that made the genomes whose fitness is reported.
    pub(crate) fn previous(&self) -> Self {
        Self { generation: self.generation.saturating_sub(1), ..*self }
    }
}

/// The stream of an individual of a generation.
pub(crate) fn stream(seed: u64, generation: u32, individual: usize) -> Stream {
    let domain = if generation == 0 { Domain::InitialGenome } else { Domain::Mutation };
    Stream::new(seed, domain, 0, individual as u32, generation)
}

/// A row of numbers that is restored, with its name in an error and its range.
pub(crate) type Row<'r> = (&'r mut [f64], &'static str, [f64; 2]);

/// An algorithm that can be run by a [`Search`]. It holds the state that changes from generation to generation, except
/// for the genomes.
pub trait Algorithm: Clone + fmt::Debug + PartialEq {
    /// Type of a gene.
    type Gene: Gene;
    /// Type of the configuration.
    type Config: Clone + fmt::Debug + PartialEq;
    /// Set this to true if individuals have parents.
    const HAS_PARENTS: bool = false;

    /// Checks the configuration and creates the first state along with its genomes. Note that [`draw`](Self::draw) may
    /// still change the genomes.
    ///
    /// # Errors
    /// The first wrong number.
    fn start(step: &Step<'_, Self::Config>) -> Result<(Self, Population<Self::Gene>), EvoError>;

    /// Takes the fitness \[individuals\] of the previous genomes and replaces them. An algorithm can also leave the
    /// genomes to [`draw`](Self::draw).
    fn advance(&mut self, step: &Step<'_, Self::Config>, fitness: &[Fitness], genomes: &mut Population<Self::Gene>);

    /// Draws the genomes, for algorithms whose genomes follow from their state. By default this leaves them unchanged.
    fn draw(&mut self, _step: &Step<'_, Self::Config>, _genomes: &mut Population<Self::Gene>) {}

    /// Numbers that make up the state, row by row. Algorithms whose state has other parts override [`save`](Self::save)
    /// and [`restore`](Self::restore) instead.
    fn rows(&self) -> Vec<&[f64]> {
        Vec::new()
    }

    /// Mutable access to the rows of [`rows`](Self::rows). This is used to restore them.
    fn rows_mut(&mut self) -> Vec<Row<'_>> {
        Vec::new()
    }

    /// Computes how many bytes a state saved at this step takes, given the number of genes of all individuals.
    fn state_length(&self, _step: &Step<'_, Self::Config>, _genes: usize) -> usize {
        self.rows().iter().map(|row| 8 * row.len()).sum()
    }

    /// Appends the state to `saved`. If the genomes do not follow from the state, they have to be saved as well.
    fn save(&self, _config: &Self::Config, _genomes: &Population<Self::Gene>, saved: &mut Vec<u8>) {
        self.rows().into_iter().for_each(|row| push_reals(saved, row));
    }

    /// Restores a saved state. If this fails, the state may be incomplete.
    ///
    /// # Errors
    /// Returns [`EvoError::State`].
    fn restore(
        &mut self,
        _step: &Step<'_, Self::Config>,
        reader: &mut StateReader<'_>,
        _genomes: &mut Population<Self::Gene>,
    ) -> Result<(), EvoError> {
        self.rows_mut().into_iter().try_for_each(|(row, what, range)| reader.row(row, what, range))
    }

    /// Determines what a record has to store so that it can rebuild a generation.
    fn record_kind(_config: &Self::Config) -> RecordKind {
        RecordKind::Values
    }

    /// Numbers that describe the latest generation. The default is an empty list.
    fn diagnostics(&self, _config: &Self::Config) -> Vec<f64> {
        Vec::new()
    }

    /// Finds the parents of an individual, as indices in the previous generation.
    fn parents_of(&self, _step: &Step<'_, Self::Config>, _individual: usize) -> Vec<usize> {
        Vec::new()
    }

    /// Largest number of generations between two states of a record.
    fn snapshot_interval(_genomes: &Population<Self::Gene>) -> u32 {
        u32::MAX
    }
}

/// A search that runs an algorithm `A` on a single population.
///
/// You usually use this through one of its aliases, such as [`RealGa`](crate::real::RealGa),
/// [`Snes`](crate::gradient::Snes) or [`TruncationGa`](crate::words::TruncationGa).
#[derive(Clone, Debug, PartialEq)]
pub struct Search<A: Algorithm> {
    pub(crate) config: A::Config,
    pub(crate) seed: u64,
    pub(crate) generation: u32,
    pub(crate) state: A,
    pub(crate) population: Population<A::Gene>,
}

impl<A: Algorithm> Search<A> {
    /// Creates a new search at its first generation.
    ///
    /// # Errors
    /// Returns [`EvoError::Config`] or [`EvoError::OutOfRange`] for the first wrong number of the configuration.
    pub fn new(config: A::Config, seed: u64) -> Result<Self, EvoError> {
        let step = Step { config: &config, seed, generation: 0 };
        let (mut state, mut population) = A::start(&step)?;
        state.draw(&step, &mut population);
        Ok(Self { config, seed, generation: 0, state, population })
    }

    /// Gets the configuration that this search was created with.
    pub fn config(&self) -> &A::Config {
        &self.config
    }

    /// Gets the seed that this search was created with.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    fn step(&self, generation: u32) -> Step<'_, A::Config> {
        Step { config: &self.config, seed: self.seed, generation }
    }

    /// Bytes of a saved state: the generation, then the state of the algorithm.
    fn state_length(&self, generation: u32) -> usize {
        4 + self.state.state_length(&self.step(generation), self.population.as_slice().len())
    }

    /// Reads a saved state. On error the search is incomplete.
    fn read(&mut self, saved: &[u8]) -> Result<(), EvoError> {
        // The length of a state may depend on its generation.
        let generation = saved.first_chunk().map_or(0, |bytes| u32::from_le_bytes(*bytes));
        let mut reader = StateReader::new(saved, self.state_length(generation))?;
        self.generation = reader.u32()?;
        let step = Step { config: &self.config, seed: self.seed, generation };
        self.state.restore(&step, &mut reader, &mut self.population)?;
        self.state.draw(&step, &mut self.population);
        Ok(())
    }
}

impl<A: Algorithm> Strategy<A::Gene> for Search<A> {
    fn generation(&self) -> u32 {
        self.generation
    }

    fn ask(&self) -> &Population<A::Gene> {
        &self.population
    }

    fn tell(&mut self, fitness: &[Fitness]) -> Result<(), EvoError> {
        // An error leaves the search unchanged. The new genomes draw from the streams of the next generation.
        self.generation = next_generation(self.generation, self.population.len(), fitness)?;
        let step = Step { config: &self.config, seed: self.seed, generation: self.generation };
        self.state.advance(&step, fitness, &mut self.population);
        self.state.draw(&step, &mut self.population);
        Ok(())
    }

    fn record_kind(&self) -> RecordKind {
        A::record_kind(&self.config)
    }

    fn snapshot(&mut self) -> Option<&mut dyn Snapshot> {
        Some(self)
    }

    fn genealogy(&self) -> Option<&dyn Genealogy> {
        if A::HAS_PARENTS { Some(self) } else { None }
    }

    fn diagnostics(&self) -> Vec<f64> {
        self.state.diagnostics(&self.config)
    }
}

impl<A: Algorithm> Genealogy for Search<A> {
    fn parents_of(&self, individual: usize) -> Vec<usize> {
        self.state.parents_of(&self.step(self.generation), individual)
    }
}

impl<A: Algorithm> Snapshot for Search<A> {
    fn snapshot_interval(&self) -> u32 {
        A::snapshot_interval(&self.population)
    }

    fn save(&self) -> Vec<u8> {
        let mut saved = Vec::with_capacity(self.state_length(self.generation));
        saved.extend(self.generation.to_le_bytes());
        self.state.save(&self.config, &self.population, &mut saved);
        saved
    }

    fn restore(&mut self, saved: &[u8]) -> Result<(), EvoError> {
        // `read` changes the search as it proceeds, so an error needs a way back.
        let before = self.save();
        let restored = self.read(saved);
        if restored.is_err() {
            self.read(&before)?;
        }
        restored
    }
}
