//! Errors, grouped by how the caller can react to them.

use alloc::format;
use alloc::string::String;
use core::fmt;

use crate::score_shape::ScoreShape;

/// The largest number of genes of a population, 2^28 (512 MiB).
pub(crate) const MAX_GENES: usize = 1 << 28;

/// An error of this crate. Variants are grouped by how you can react to them.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum EvoError {
    /// A number in a configuration is out of its allowed range.
    OutOfRange {
        /// Name of the number.
        field: &'static str,
        /// Value that was given.
        value: f64,
        /// Values that are allowed.
        allowed: &'static str,
    },
    /// Some values of a configuration are impossible or do not fit together.
    Config {
        /// Name of the first value that you should change.
        field: &'static str,
        /// Message that explains the problem.
        why: String,
    },
    /// The caller has passed a wrong number of values.
    Shape {
        /// Number of values that are required.
        expected: usize,
        /// Number of values that were passed.
        found: usize,
        /// Message that explains the problem.
        why: String,
    },
    /// A fitness is NaN.
    NanFitness,
    /// The generation counter has reached its last value, 2^32 - 1.
    LastGeneration,
    /// There is no best individual, since no generation was evaluated or a saved search lacks it.
    NoBest {
        /// Number of the current generation.
        generation: u32,
    },
    /// A saved state or an entry of a record is damaged, or it belongs to another configuration.
    State {
        /// Message that explains the problem.
        why: String,
    },
    /// A record and a strategy do not fit together.
    Record {
        /// Message that explains the problem.
        why: String,
    },
}

impl fmt::Display for EvoError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OutOfRange { field, value, allowed } => write!(f, "{field} is {value}, where {allowed} is possible"),
            Self::Config { why, .. } | Self::Shape { why, .. } | Self::State { why } | Self::Record { why } => {
                f.write_str(why)
            }
            Self::NanFitness => f.write_str("a fitness that is not a number"),
            Self::LastGeneration => f.write_str("no generation after number 4294967295"),
            Self::NoBest { generation } => write!(f, "no best individual in the search up to generation {generation}"),
        }
    }
}

impl core::error::Error for EvoError {}

impl EvoError {
    pub(crate) fn no_genes() -> Self {
        Self::Config { field: "genes", why: "a genome of zero genes".into() }
    }

    pub(crate) fn no_individuals() -> Self {
        Self::Config { field: "population", why: "a population of zero individuals".into() }
    }

    pub(crate) fn no_parents() -> Self {
        Self::Config { field: "parents", why: "a selection of zero parents".into() }
    }

    pub(crate) fn too_many_parents(population: usize, parents: usize) -> Self {
        Self::Config { field: "population", why: format!("{parents} parents from a population of {population}") }
    }

    pub(crate) fn uneven_copies(population: usize, parents: usize) -> Self {
        Self::Config {
            field: "population",
            why: format!("a population of {population} is not a multiple of {parents} parents"),
        }
    }

    pub(crate) fn rate(rate: f64) -> Self {
        Self::Config { field: "mutation_rate", why: format!("a mutation rate of {rate} is not a probability") }
    }

    pub(crate) fn rising_rate(first: f64, last: f64) -> Self {
        Self::Config { field: "last_rate", why: format!("a mutation rate cannot fall from {first} to {last}") }
    }

    pub(crate) fn gene_bits(bits: u32) -> Self {
        Self::Config { field: "gene_bits", why: format!("a gene of {bits} bits, where 1 to 16 are possible") }
    }

    pub(crate) fn few_populations(populations: usize) -> Self {
        Self::Config { field: "populations", why: format!("co-evolution of {populations} populations, fewer than 2") }
    }

    pub(crate) fn unequal_populations(first: usize, population: usize, individuals: usize) -> Self {
        Self::Config {
            field: "population",
            why: format!("population {population} has {individuals} individuals, population 0 has {first}"),
        }
    }

    pub(crate) fn uneven_populations(populations: usize, individuals: usize) -> Self {
        Self::Config {
            field: "populations",
            why: format!("{individuals} individuals cannot be shared evenly by {populations} populations"),
        }
    }

    pub(crate) fn too_large(population: usize, genes: usize) -> Self {
        Self::Config {
            field: "population",
            why: format!("{population} genomes of {genes} genes are more than {MAX_GENES} genes"),
        }
    }

    pub(crate) fn range(low: f32, high: f32) -> Self {
        Self::Config { field: "range", why: format!("genes cannot range from {low} to {high}") }
    }

    /// Creates the error for genes, ranges and output values that differ in number.
    pub fn lengths(genes: usize, ranges: usize, out: usize) -> Self {
        Self::Shape {
            expected: ranges,
            found: genes,
            why: format!("{genes} genes, ranges for {ranges}, room for {out} values"),
        }
    }

    /// Creates the error for a wrong number of fitness values. Use this in custom strategies.
    pub fn fitness_count(expected: usize, found: usize) -> Self {
        Self::Shape { expected, found, why: format!("{found} fitness values for {expected} individuals") }
    }

    pub(crate) fn score_count(width: usize, found: usize) -> Self {
        Self::Shape { expected: width, found, why: format!("{found} numbers are not {width} of each individual") }
    }

    pub(crate) fn score_shape(expected: ScoreShape, found: ScoreShape) -> Self {
        Self::Shape {
            expected: expected.width(),
            found: found.width(),
            why: format!("{found} of each individual where {expected} are expected"),
        }
    }

    pub(crate) fn no_such_generation(generation: u32, latest: u32) -> Self {
        Self::Record { why: format!("generation {generation} of a history that ends with generation {latest}") }
    }

    pub(crate) fn not_at_start(generation: u32) -> Self {
        Self::Record { why: format!("a record that begins at generation {generation}, not at 0") }
    }

    pub(crate) fn stuck(generation: u32, found: u32) -> Self {
        Self::Record { why: format!("a strategy that was told generation {generation} is at generation {found}") }
    }

    pub(crate) fn no_snapshot() -> Self {
        Self::Record { why: "a strategy whose genomes are recorded cannot save its state".into() }
    }

    pub(crate) fn genomes_only() -> Self {
        Self::Record { why: "the record has genomes alone, which a strategy cannot be told".into() }
    }

    pub(crate) fn other_record(what: &'static str, recorded: usize) -> Self {
        Self::Record { why: format!("the record is of {recorded} {what}, the strategy is not") }
    }

    pub(crate) fn no_such_individual(individual: usize, population: usize) -> Self {
        Self::State { why: format!("individual {individual} of a population of {population}") }
    }

    pub(crate) fn selected_twice(individual: usize) -> Self {
        Self::State { why: format!("individual {individual} selected twice") }
    }

    /// Creates the error for a saved state with a wrong number of bytes. Use this in custom strategies.
    pub fn state_length(expected: usize, found: usize) -> Self {
        Self::State { why: format!("a saved state of {found} bytes where {expected} are expected") }
    }

    /// Creates the error for a saved state with an impossible number. Use this in custom strategies.
    pub fn state_content(what: &'static str, found: u64) -> Self {
        Self::State { why: format!("{found} is not {what} in a saved state") }
    }
}

/// Returns an error for a number of a configuration unless it is `possible`.
pub(crate) fn check_setting(
    possible: bool,
    field: &'static str,
    value: f64,
    allowed: &'static str,
) -> Result<(), EvoError> {
    if possible { Ok(()) } else { Err(EvoError::OutOfRange { field, value, allowed }) }
}

/// Returns an error for a number outside of a range, both ends of which are allowed.
pub(crate) fn check_range(
    field: &'static str,
    value: f64,
    range: [f64; 2],
    allowed: &'static str,
) -> Result<(), EvoError> {
    check_setting((range[0]..=range[1]).contains(&value), field, value, allowed)
}

/// Returns an error for a probability or a share outside 0 to 1.
pub(crate) fn check_share(field: &'static str, share: f64) -> Result<(), EvoError> {
    check_range(field, share, [0.0, 1.0], "0 to 1")
}
