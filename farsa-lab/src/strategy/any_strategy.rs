//! A strategy, whatever its genes are.

use std::fmt;

use farsa_evo::{
    Collection, EvoError, Fitness, Genealogy, Opponents, Population, Record, RecordWriter, ScoreShape, Scores,
    Snapshot, Strategy,
};

use crate::experiment::genotype::Genotype;

/// A strategy over integer or real genes, as created by
/// [`StrategyDefinition::start`](crate::strategy::StrategyDefinition::start).
///
/// Both are decoded by a [`Genotype`]. Integer genes are linear over the range of their parameter. Real genes map -1
/// to the first end, 0 to the middle and 1 to the other end, and are reflected beyond.
#[non_exhaustive]
pub enum AnyStrategy {
    /// Over 16-bit words.
    Words(Box<dyn Strategy + Send>),
    /// Over reals.
    Reals(Box<dyn Strategy<f64> + Send>),
}

/// The same of both kinds.
macro_rules! each {
    ($search:expr, $strategy:ident => $done:expr) => {
        match $search {
            AnyStrategy::Words($strategy) => $done,
            AnyStrategy::Reals($strategy) => $done,
        }
    };
}

impl AnyStrategy {
    /// Wraps a strategy over integer genes.
    pub fn from_words(strategy: impl Strategy + Send + 'static) -> Self {
        Self::Words(Box::new(strategy))
    }

    /// Wraps a strategy over real genes.
    pub fn from_reals(strategy: impl Strategy<f64> + Send + 'static) -> Self {
        Self::Reals(Box::new(strategy))
    }

    /// Gets the number of the generation that is evaluated next, from 0.
    pub fn generation(&self) -> u32 {
        each!(self, strategy => strategy.generation())
    }

    /// Gets the number of populations.
    pub fn populations(&self) -> usize {
        each!(self, strategy => strategy.populations())
    }

    /// Gets the number of individuals in a generation. This includes all populations.
    pub fn individuals(&self) -> usize {
        each!(self, strategy => strategy.ask().len())
    }

    /// Gets the number of genes of an individual.
    pub fn genes(&self) -> usize {
        each!(self, strategy => strategy.ask().genome_len())
    }

    /// Decodes the current generation. Returns none for genomes of another length.
    pub(crate) fn parameters(&self, genotype: &Genotype) -> Option<Vec<Vec<f32>>> {
        match self {
            Self::Words(strategy) => genotype.decode_all(strategy.ask()),
            Self::Reals(strategy) => strategy.ask().iter().map(|genes| genotype.decode_reals(genes)).collect(),
        }
    }

    /// Finds the genome of an individual of the current generation.
    pub(crate) fn genome(&self, individual: usize) -> Option<Genome> {
        match self {
            Self::Words(strategy) => strategy.ask().get(individual).map(|genes| Genome::Words(genes.to_vec())),
            Self::Reals(strategy) => strategy.ask().get(individual).map(|genes| Genome::Reals(genes.to_vec())),
        }
    }

    pub(crate) fn ranked_by(&self, fitness: &[Fitness]) -> Vec<Fitness> {
        each!(self, strategy => strategy.ranked_by(fitness))
    }

    pub(crate) fn champions(&self, ranked_by: &[Fitness]) -> Vec<usize> {
        each!(self, strategy => strategy.champions(ranked_by))
    }

    pub(crate) fn genealogy(&self) -> Option<&dyn Genealogy> {
        each!(self, strategy => strategy.genealogy())
    }

    pub(crate) fn diagnostics(&self) -> Vec<f64> {
        each!(self, strategy => strategy.diagnostics())
    }

    pub(crate) fn snapshot(&mut self) -> Option<&mut dyn Snapshot> {
        each!(self, strategy => strategy.snapshot())
    }

    /// Returns the record of a strategy before its first fitness.
    pub(crate) fn record(&mut self) -> Result<Record, EvoError> {
        each!(self, strategy => Record::new(strategy.as_mut()))
    }

    /// Gets the number of objectives and measures of an individual.
    pub fn score_shape(&self) -> ScoreShape {
        each!(self, strategy => strategy.score_shape())
    }

    /// Gets the number of opponents per individual, if the strategy chooses them.
    pub(crate) fn opponents(&self) -> Option<usize> {
        each!(self, strategy => strategy.opponents().map(Opponents::count))
    }

    /// Finds the genomes of the opponents that the strategy chose for a trial, one of each other population.
    pub(crate) fn opponents_of(&self, individual: usize, trial: u32) -> Option<Vec<Genome>> {
        let number = |count: usize| trial as usize % count.max(1);
        Some(match self {
            Self::Words(strategy) => {
                let meetings = strategy.opponents()?;
                let met = meetings.opponents_of(individual, number(meetings.count()));
                met.into_iter().map(|genes| Genome::Words(genes.to_vec())).collect()
            }
            Self::Reals(strategy) => {
                let meetings = strategy.opponents()?;
                let met = meetings.opponents_of(individual, number(meetings.count()));
                met.into_iter().map(|genes| Genome::Reals(genes.to_vec())).collect()
            }
        })
    }

    /// Gets the archive or front, if there is one.
    pub(crate) fn collection(&self) -> Option<&dyn Collection> {
        each!(self, strategy => strategy.collection())
    }

    /// Checks whether the champion is the best of all generations instead of the last.
    pub(crate) fn champion_is_best_ever(&self) -> bool {
        each!(self, strategy => strategy.champion_is_best_ever())
    }

    /// Reports the scores of the current generation and records them.
    pub(crate) fn tell(&mut self, record: &mut RecordWriter, judgements: &Scores) -> Result<(), EvoError> {
        each!(self, strategy => match judgements.shape() {
            ScoreShape::FITNESS => record.tell(strategy.as_mut(), &judgements.fitness()),
            _ => record.tell_scores(strategy.as_mut(), judgements),
        })
    }

    /// Does the same without a record.
    pub(crate) fn tell_unrecorded(&mut self, judgements: &Scores) -> Result<(), EvoError> {
        each!(self, strategy => match judgements.shape() {
            ScoreShape::FITNESS => strategy.tell(&judgements.fitness()),
            _ => strategy.tell_scores(judgements),
        })
    }

    /// Brings the strategy to a generation of a record.
    pub(crate) fn rebuild(&mut self, record: &Record, generation: u32) -> Result<(), EvoError> {
        each!(self, strategy => record.rebuild(strategy.as_mut(), generation))
    }

    /// Rebuilds the genomes of a generation of a record.
    pub(crate) fn genomes(&mut self, record: &Record, generation: u32) -> Result<Genomes, EvoError> {
        Ok(match self {
            Self::Words(strategy) => Genomes::Words(record.genomes(strategy.as_mut(), generation)?),
            Self::Reals(strategy) => Genomes::Reals(record.genomes(strategy.as_mut(), generation)?),
        })
    }
}

impl fmt::Debug for AnyStrategy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = if matches!(self, Self::Words(_)) { "Words" } else { "Reals" };
        f.debug_struct(kind).field("generation", &self.generation()).finish_non_exhaustive()
    }
}

/// Genes of an individual.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Genome {
    Words(Vec<u16>),
    Reals(Vec<f64>),
}

impl Genome {
    /// Number of genes.
    pub(crate) fn len(&self) -> usize {
        match self {
            Self::Words(genes) => genes.len(),
            Self::Reals(genes) => genes.len(),
        }
    }

    /// Gets integer genes.
    pub(crate) fn words(&self) -> Option<&[u16]> {
        match self {
            Self::Words(genes) => Some(genes),
            Self::Reals(_) => None,
        }
    }

    /// Decodes the genome. Returns none for another number of genes.
    pub(crate) fn decode(&self, genotype: &Genotype) -> Option<Vec<f32>> {
        match self {
            Self::Words(genes) => genotype.decode(genes),
            Self::Reals(genes) => genotype.decode_reals(genes),
        }
    }
}

/// Genomes of a generation.
pub(crate) enum Genomes {
    Words(Population),
    Reals(Population<f64>),
}

impl Genomes {
    /// Finds the genome of an individual.
    pub(crate) fn get(&self, individual: usize) -> Option<Genome> {
        match self {
            Self::Words(all) => all.get(individual).map(|genes| Genome::Words(genes.to_vec())),
            Self::Reals(all) => all.get(individual).map(|genes| Genome::Reals(genes.to_vec())),
        }
    }

    /// Decodes all individuals. Returns none for genomes of another length.
    pub(crate) fn decode_all(&self, genotype: &Genotype) -> Option<Vec<Vec<f32>>> {
        match self {
            Self::Words(all) => genotype.decode_all(all),
            Self::Reals(all) => all.iter().map(|genes| genotype.decode_reals(genes)).collect(),
        }
    }
}
