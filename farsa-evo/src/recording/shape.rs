//! The sizes and content of a record.

use alloc::vec::Vec;

use crate::error::EvoError;
use crate::gene::Gene;
#[cfg(feature = "serde")]
use crate::population::Population;
use crate::score_shape::ScoreShape;
use crate::strategy::{RecordKind, Strategy};

/// The sizes that a record was made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Shape {
    pub(crate) recorded: Kept,
    pub(crate) populations: usize,
    /// Individuals of all populations.
    pub(crate) individuals: usize,
    pub(crate) genes: usize,
    /// Bytes of a gene.
    pub(crate) gene_bytes: usize,
}

/// The content of a record, [`RecordKind`], with the shape of scores of more than one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename = "Recorded"))]
pub(crate) enum Kept {
    Order,
    Values,
    Genomes,
    #[cfg_attr(feature = "serde", serde(rename = "Judgements"))]
    Scores(ScoreShape),
}

impl Kept {
    fn from_strategy<G: Gene>(strategy: &(impl Strategy<G> + ?Sized)) -> Self {
        match (strategy.record_kind(), strategy.score_shape()) {
            (RecordKind::Genomes, _) => Self::Genomes,
            (RecordKind::Order, ScoreShape::FITNESS) => Self::Order,
            (RecordKind::Values, ScoreShape::FITNESS) => Self::Values,
            (RecordKind::Order | RecordKind::Values, shape) => Self::Scores(shape),
        }
    }
}

impl Shape {
    pub(crate) fn from_strategy<G: Gene>(strategy: &(impl Strategy<G> + ?Sized)) -> Self {
        let (recorded, populations, genomes) = (Kept::from_strategy(strategy), strategy.populations(), strategy.ask());
        Self { recorded, populations, individuals: genomes.len(), genes: genomes.genome_len(), gene_bytes: G::BYTES }
    }

    /// Checks that all populations have the same number of individuals, at least one.
    pub(crate) fn check(self) -> Result<(), EvoError> {
        let Self { populations, individuals, .. } = self;
        let even = populations > 0 && individuals.is_multiple_of(populations);
        if even { Ok(()) } else { Err(EvoError::uneven_populations(populations, individuals)) }
    }

    /// Checks the shape of a record that is read.
    #[cfg(feature = "serde")]
    pub(crate) fn check_read(self) -> Result<(), EvoError> {
        Population::check(self.individuals, self.genes)?;
        if ![u16::BYTES, f64::BYTES].contains(&self.gene_bytes) {
            return Err(EvoError::state_content("the bytes of a gene", self.gene_bytes as u64));
        }
        if let Kept::Scores(shape) = self.recorded {
            if shape.objectives == 0 || shape == ScoreShape::FITNESS {
                let found = shape.objectives as u64;
                return Err(EvoError::state_content("a number of objectives", found));
            }
            Population::check(self.individuals, shape.width())?;
        }
        self.check()
    }

    /// Checks that a record of this shape fits a strategy.
    ///
    /// # Errors
    /// Returns [`EvoError::Record`].
    pub(crate) fn check_strategy<G: Gene>(self, strategy: &(impl Strategy<G> + ?Sized)) -> Result<(), EvoError> {
        let (ours, theirs) = (self, Self::from_strategy(strategy));
        let other = |what, recorded| Err(EvoError::other_record(what, recorded));
        if ours.populations != theirs.populations {
            other("populations", ours.populations)
        } else if ours.individuals != theirs.individuals {
            other("individuals", ours.individuals)
        } else if ours.genes != theirs.genes {
            other("genes", ours.genes)
        } else if ours.gene_bytes != theirs.gene_bytes {
            other("bytes of a gene", ours.gene_bytes)
        } else if ours.recorded != theirs.recorded {
            other("bytes of another kind", ours.frame())
        } else {
            Ok(())
        }
    }

    /// Checks that this is the number of an individual of a population.
    pub(crate) fn has(self, population: usize, individual: usize) -> bool {
        individual < self.individuals && individual / (self.individuals / self.populations) == population
    }

    /// Bytes of an individual's index.
    pub(crate) fn width(self) -> usize {
        // Indices are below the number of individuals, so 256 of them fit a byte.
        match self.individuals {
            0..=0x100 => 1,
            0x101..=0x1_0000 => 2,
            _ => 4,
        }
    }

    /// Bytes of a generation.
    pub(crate) fn frame(self) -> usize {
        let each = match self.recorded {
            Kept::Order => self.width(),
            Kept::Values => 8,
            Kept::Genomes => self.gene_bytes * self.genes,
            Kept::Scores(shape) => 8 * shape.width(),
        };
        self.populations * self.width() + self.individuals * each
    }

    pub(crate) fn push_index(self, bytes: &mut Vec<u8>, index: usize) {
        bytes.extend(index.to_le_bytes().iter().take(self.width()));
    }

    pub(crate) fn indices(self, bytes: &[u8]) -> impl Iterator<Item = usize> + '_ {
        let index = |bytes: &[u8]| bytes.iter().rev().fold(0, |sum, byte| sum << 8 | usize::from(*byte));
        bytes.chunks_exact(self.width()).map(index)
    }
}
