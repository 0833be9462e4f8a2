//! Every error with its text, as users read it.
#![allow(dead_code)]

use farsa_evo::{EvoError, Population, ScoreShape};

const MAX_GENES: usize = Population::MAX_GENES;

pub(crate) fn no_genes() -> EvoError {
    EvoError::Config { field: "genes", why: "a genome of zero genes".into() }
}

pub(crate) fn no_individuals() -> EvoError {
    EvoError::Config { field: "population", why: "a population of zero individuals".into() }
}

pub(crate) fn no_parents() -> EvoError {
    EvoError::Config { field: "parents", why: "a selection of zero parents".into() }
}

pub(crate) fn too_many_parents(population: usize, parents: usize) -> EvoError {
    EvoError::Config { field: "population", why: format!("{parents} parents from a population of {population}") }
}

pub(crate) fn uneven_copies(population: usize, parents: usize) -> EvoError {
    EvoError::Config {
        field: "population",
        why: format!("a population of {population} is not a multiple of {parents} parents"),
    }
}

pub(crate) fn rate(rate: f64) -> EvoError {
    EvoError::Config { field: "mutation_rate", why: format!("a mutation rate of {rate} is not a probability") }
}

pub(crate) fn rising_rate(first: f64, last: f64) -> EvoError {
    EvoError::Config { field: "last_rate", why: format!("a mutation rate cannot fall from {first} to {last}") }
}

pub(crate) fn gene_bits(bits: u32) -> EvoError {
    EvoError::Config { field: "gene_bits", why: format!("a gene of {bits} bits, where 1 to 16 are possible") }
}

pub(crate) fn few_populations(populations: usize) -> EvoError {
    EvoError::Config { field: "populations", why: format!("co-evolution of {populations} populations, fewer than 2") }
}

pub(crate) fn unequal_populations(first: usize, population: usize, individuals: usize) -> EvoError {
    EvoError::Config {
        field: "population",
        why: format!("population {population} has {individuals} individuals, population 0 has {first}"),
    }
}

pub(crate) fn uneven_populations(populations: usize, individuals: usize) -> EvoError {
    EvoError::Config {
        field: "populations",
        why: format!("{individuals} individuals cannot be shared evenly by {populations} populations"),
    }
}

pub(crate) fn too_large(population: usize, genes: usize) -> EvoError {
    EvoError::Config {
        field: "population",
        why: format!("{population} genomes of {genes} genes are more than {MAX_GENES} genes"),
    }
}

pub(crate) fn range(low: f32, high: f32) -> EvoError {
    EvoError::Config { field: "range", why: format!("genes cannot range from {low} to {high}") }
}

pub(crate) fn lengths(genes: usize, ranges: usize, out: usize) -> EvoError {
    EvoError::Shape {
        expected: ranges,
        found: genes,
        why: format!("{genes} genes, ranges for {ranges}, room for {out} values"),
    }
}

pub(crate) fn fitness_count(expected: usize, found: usize) -> EvoError {
    EvoError::Shape { expected, found, why: format!("{found} fitness values for {expected} individuals") }
}

pub(crate) fn score_count(width: usize, found: usize) -> EvoError {
    EvoError::Shape { expected: width, found, why: format!("{found} numbers are not {width} of each individual") }
}

pub(crate) fn score_shape(expected: ScoreShape, found: ScoreShape) -> EvoError {
    EvoError::Shape {
        expected: expected.width(),
        found: found.width(),
        why: format!("{found} of each individual where {expected} are expected"),
    }
}

pub(crate) fn no_such_generation(generation: u32, latest: u32) -> EvoError {
    EvoError::Record { why: format!("generation {generation} of a history that ends with generation {latest}") }
}

pub(crate) fn not_at_start(generation: u32) -> EvoError {
    EvoError::Record { why: format!("a record that begins at generation {generation}, not at 0") }
}

pub(crate) fn stuck(generation: u32, found: u32) -> EvoError {
    EvoError::Record { why: format!("a strategy that was told generation {generation} is at generation {found}") }
}

pub(crate) fn no_snapshot() -> EvoError {
    EvoError::Record { why: "a strategy whose genomes are recorded cannot save its state".into() }
}

pub(crate) fn genomes_only() -> EvoError {
    EvoError::Record { why: "the record has genomes alone, which a strategy cannot be told".into() }
}

pub(crate) fn other_record(what: &'static str, recorded: usize) -> EvoError {
    EvoError::Record { why: format!("the record is of {recorded} {what}, the strategy is not") }
}

pub(crate) fn no_such_individual(individual: usize, population: usize) -> EvoError {
    EvoError::State { why: format!("individual {individual} of a population of {population}") }
}

pub(crate) fn selected_twice(individual: usize) -> EvoError {
    EvoError::State { why: format!("individual {individual} selected twice") }
}

pub(crate) fn state_length(expected: usize, found: usize) -> EvoError {
    EvoError::State { why: format!("a saved state of {found} bytes where {expected} are expected") }
}

pub(crate) fn state_content(what: &'static str, found: u64) -> EvoError {
    EvoError::State { why: format!("{found} is not {what} in a saved state") }
}
