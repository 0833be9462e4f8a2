//! Errors of configurations, records, states and reported fitness.

use core::fmt;

use crate::score_shape::ScoreShape;

/// The most genes of a population, 2^28 (512 MiB).
pub(crate) const MAX_GENES: usize = 1 << 28;

/// An error of this crate, with the wrong numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum EvoError {
    /// A genome needs at least one gene.
    NoGenes,
    /// A population needs at least one individual.
    NoIndividuals,
    /// Selection needs at least one parent.
    NoParents,
    /// More parents than individuals.
    TooManyParents {
        /// Individuals asked for.
        population: usize,
        /// Parents asked for.
        parents: usize,
    },
    /// Every parent makes the same number of copies, so the population is a multiple of the parents.
    UnevenCopies {
        /// Individuals asked for.
        population: usize,
        /// Parents asked for.
        parents: usize,
    },
    /// A probability that is NaN or outside 0 to 1.
    Rate {
        /// The probability asked for.
        rate: f64,
    },
    /// A mutation rate that would end above its start.
    RisingRate {
        /// The first rate.
        first: f64,
        /// The last rate.
        last: f64,
    },
    /// A gene has 1 to 16 bits.
    GeneBits {
        /// Bits asked for.
        bits: u32,
    },
    /// Co-evolution needs at least two populations.
    FewPopulations {
        /// Populations asked for.
        populations: usize,
    },
    /// Co-evolving populations have the same number of individuals.
    UnequalPopulations {
        /// Individuals of population 0.
        first: usize,
        /// The population that differs.
        population: usize,
        /// Its individuals.
        individuals: usize,
    },
    /// A population of more genes than [`Population::MAX_GENES`](crate::Population::MAX_GENES).
    TooLarge {
        /// Individuals asked for.
        population: usize,
        /// Genes of each of them.
        genes: usize,
    },
    /// A number of a configuration that cannot be.
    Setting {
        /// Its name.
        name: &'static str,
        /// The number asked for.
        value: f64,
        /// The allowed values.
        allowed: &'static str,
    },
    /// A range of gene values that is not finite, or whose low end is above its high end.
    Range {
        /// Value of gene 0.
        low: f32,
        /// Value of the largest gene.
        high: f32,
    },
    /// Genes, ranges and decoded values differ in number.
    Lengths {
        /// Genes to decode.
        genes: usize,
        /// Genes that the ranges describe.
        ranges: usize,
        /// Room for decoded values.
        out: usize,
    },
    /// More or fewer fitness values than individuals.
    FitnessCount {
        /// Individuals of the generation.
        expected: usize,
        /// Reported fitness values.
        found: usize,
    },
    /// A fitness that is NaN.
    NanFitness,
    /// Numbers of scores that are not whole rows.
    ScoreCount {
        /// Numbers of each individual.
        width: usize,
        /// Reported numbers.
        found: usize,
    },
    /// Another number of objectives or measures than the strategy requires.
    ScoreShape {
        /// The required shape.
        expected: ScoreShape,
        /// The reported shape.
        found: ScoreShape,
    },
    /// The generation counter has reached its last value, 2^32 - 1.
    LastGeneration,
    /// A generation that has not been reached.
    NoSuchGeneration {
        /// The generation asked for.
        generation: u32,
        /// The latest one that exists.
        latest: u32,
    },
    /// An individual beyond the population.
    NoSuchIndividual {
        /// The individual asked for.
        individual: usize,
        /// Individuals of a generation.
        population: usize,
    },
    /// A recorded selection that names the same parent twice.
    SelectedTwice {
        /// The parent named twice.
        individual: usize,
    },
    /// No best individual, because no generation was evaluated, or because a saved search lacks it.
    NoBest {
        /// The generation that it waits for.
        generation: u32,
    },
    /// A strategy whose individuals are not shared evenly between its populations.
    UnevenPopulations {
        /// Its populations.
        populations: usize,
        /// Its individuals.
        individuals: usize,
    },
    /// A record of a strategy that is past generation 0.
    AlreadyTold {
        /// The generation that the strategy is at.
        generation: u32,
    },
    /// A strategy that is not at the next generation after its fitness was reported.
    Stuck {
        /// The reported generation.
        generation: u32,
        /// The generation that it is at.
        found: u32,
    },
    /// A strategy of which genomes are recorded has to save its state.
    NoSnapshot,
    /// A record of genomes, which cannot be replayed.
    GenomesOnly,
    /// A record of another strategy: of other sizes, or at another generation.
    OtherRecord {
        /// The difference.
        what: &'static str,
        /// Their number in the record.
        recorded: usize,
    },
    /// A saved state, or a record, of the wrong number of bytes.
    StateLength {
        /// Bytes that belong there, or that are a multiple of.
        expected: usize,
        /// Bytes found.
        found: usize,
    },
    /// A saved state, or a record, with a number in it that cannot be.
    StateContent {
        /// The meaning of the number.
        what: &'static str,
        /// The number.
        found: u64,
    },
}

impl fmt::Display for EvoError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NoGenes => f.write_str("a genome of zero genes"),
            Self::NoIndividuals => f.write_str("a population of zero individuals"),
            Self::NoParents => f.write_str("a selection of zero parents"),
            Self::TooManyParents { population, parents } => {
                write!(f, "{parents} parents from a population of {population}")
            }
            Self::UnevenCopies { population, parents } => {
                write!(f, "a population of {population} is not a multiple of {parents} parents")
            }
            Self::Rate { rate } => write!(f, "a mutation rate of {rate} is not a probability"),
            Self::RisingRate { first, last } => write!(f, "a mutation rate cannot fall from {first} to {last}"),
            Self::GeneBits { bits } => write!(f, "a gene of {bits} bits, where 1 to 16 are possible"),
            Self::FewPopulations { populations } => {
                write!(f, "co-evolution of {populations} populations, fewer than 2")
            }
            Self::UnequalPopulations { first, population, individuals } => {
                write!(f, "population {population} has {individuals} individuals, population 0 has {first}")
            }
            Self::TooLarge { population, genes } => {
                let limit = MAX_GENES;
                write!(f, "{population} genomes of {genes} genes are more than {limit} genes")
            }
            Self::Setting { name, value, allowed } => write!(f, "{name} is {value}, where {allowed} is possible"),
            Self::Range { low, high } => write!(f, "genes cannot range from {low} to {high}"),
            Self::Lengths { genes, ranges, out } => {
                write!(f, "{genes} genes, ranges for {ranges}, room for {out} values")
            }
            Self::FitnessCount { expected, found } => {
                write!(f, "{found} fitness values for {expected} individuals")
            }
            Self::ScoreCount { width, found } => write!(f, "{found} numbers are not {width} of each individual"),
            Self::ScoreShape { expected, found } => {
                write!(f, "{found} of each individual where {expected} are expected")
            }
            Self::NanFitness => f.write_str("a fitness that is not a number"),
            Self::LastGeneration => f.write_str("no generation after number 4294967295"),
            Self::NoSuchGeneration { generation, latest } => {
                write!(f, "generation {generation} of a history that ends with generation {latest}")
            }
            Self::NoSuchIndividual { individual, population } => {
                write!(f, "individual {individual} of a population of {population}")
            }
            Self::SelectedTwice { individual } => write!(f, "individual {individual} selected twice"),
            Self::NoBest { generation } => write!(f, "no best individual in the search up to generation {generation}"),
            Self::UnevenPopulations { populations, individuals } => {
                write!(f, "{individuals} individuals cannot be shared evenly by {populations} populations")
            }
            Self::AlreadyTold { generation } => {
                write!(f, "a record that begins at generation {generation}, not at 0")
            }
            Self::Stuck { generation, found } => {
                write!(f, "a strategy that was told generation {generation} is at generation {found}")
            }
            Self::NoSnapshot => f.write_str("a strategy whose genomes are recorded cannot save its state"),
            Self::GenomesOnly => f.write_str("the record has genomes alone, which a strategy cannot be told"),
            Self::OtherRecord { what, recorded } => {
                write!(f, "the record is of {recorded} {what}, the strategy is not")
            }
            Self::StateLength { expected, found } => {
                write!(f, "a saved state of {found} bytes where {expected} are expected")
            }
            Self::StateContent { what, found } => write!(f, "{found} is not {what} in a saved state"),
        }
    }
}

impl core::error::Error for EvoError {}

/// Returns an error for a number of a configuration unless it is `possible`.
pub(crate) fn check_setting(
    possible: bool,
    name: &'static str,
    value: f64,
    allowed: &'static str,
) -> Result<(), EvoError> {
    if possible { Ok(()) } else { Err(EvoError::Setting { name, value, allowed }) }
}

/// Returns an error for a number outside of a range, both ends of which are allowed.
pub(crate) fn check_range(
    name: &'static str,
    value: f64,
    range: [f64; 2],
    allowed: &'static str,
) -> Result<(), EvoError> {
    check_setting((range[0]..=range[1]).contains(&value), name, value, allowed)
}

/// Returns an error for a probability outside 0 to 1.
pub(crate) fn check_rate(name: &'static str, rate: f64) -> Result<(), EvoError> {
    check_range(name, rate, [0.0, 1.0], "0 to 1")
}
