//! The settings of evolution that all experiments share.

use farsa_evo::{EvoError, GaConfig, Mutation, OnePlusOneConfig};

use crate::error::Error;
use crate::experiment::search_kind::Search;
use crate::experiment::settings::{Setting, Settings};

/// Evaluated generations.
pub(crate) const GENERATIONS: &str = "evolution.generations";
/// Individuals of a generation.
pub(crate) const POPULATION: &str = "evolution.population";
const PARENTS: &str = "evolution.parents";
const MUTATION: &str = "evolution.mutation";
const RATE: &str = "evolution.mutation_rate";
const FIRST_RATE: &str = "evolution.first_rate";
const RATE_STEP: &str = "evolution.rate_step";
const LAST_RATE: &str = "evolution.last_rate";

/// The settings of the truncation algorithm, with the defaults of \[Ferrauto2010\].
pub fn settings() -> Vec<Setting> {
    vec![
        Setting::whole(GENERATIONS, 1000, 1..=i64::from(u32::MAX) - 1)
            .given()
            .doc("Generations that are evaluated; the one thing that a resumed run may change."),
        Setting::whole(POPULATION, 100, 1..=1_000_000).given().doc(
            "Individuals of a generation, a multiple of the parents; with no more than them nothing is ever mutated.",
        ),
        Setting::whole(PARENTS, 20, 1..=1_000_000)
            .given()
            .doc("The best individuals, which make population / parents copies each, the first of them unchanged."),
        Setting::word(MUTATION, "resample", &["resample", "flip"])
            .given()
            .doc("What happens to a bit that mutation hits: it is drawn anew, or it flips."),
        Setting::number(RATE, 0.015, 0.0..=1.0).given().doc("Probability that mutation hits a bit."),
    ]
}

/// The settings of the steady-state search, with the defaults of the original's discrimination experiment.
pub fn one_plus_one_settings() -> Vec<Setting> {
    vec![
        Setting::whole(GENERATIONS, 500, 1..=i64::from(u32::MAX) - 1)
            .given()
            .doc("Generations of one parent and one mutant; the one thing that a resumed run may change."),
        Setting::word(MUTATION, "flip", &["flip", "resample"])
            .given()
            .doc("What happens to a bit that mutation hits: it flips, or it is drawn anew."),
        Setting::number(FIRST_RATE, 0.5, 0.0..=1.0)
            .given()
            .doc("Probability that mutation hits a bit of the first mutant."),
        Setting::number(RATE_STEP, 0.01, 0.0..=1.0)
            .given()
            .doc("What that probability falls by from generation to generation."),
        Setting::number(LAST_RATE, 0.02, 0.0..=1.0).given().doc("The probability below which it does not fall."),
    ]
}

/// The settings of a run that learns.
pub fn learning_settings() -> Vec<Setting> {
    vec![Setting::whole(GENERATIONS, 300, 1..=i64::from(u32::MAX) - 1).doc(
        "Lessons, each after a life that shows what is known so far; the one thing that a resumed run may change.",
    )]
}

/// The experiment's table with the settings of evolution that it does not define itself in front.
pub(crate) fn complete(mut own: Vec<Setting>, search: Search) -> Vec<Setting> {
    let mut table = match search {
        Search::Truncation => settings(),
        Search::OnePlusOne => one_plus_one_settings(),
        Search::Learning => learning_settings(),
    };
    for setting in &mut table {
        if let Some(index) = own.iter().position(|other| other.key() == setting.key()) {
            *setting = own.remove(index);
        }
    }
    table.append(&mut own);
    table
}

fn mutation(settings: &Settings) -> Result<Mutation, Error> {
    Ok(if settings.word(MUTATION)? == "flip" { Mutation::Flip } else { Mutation::Resample })
}

/// The steady-state search's configuration for the genomes of an experiment.
///
/// # Errors
/// [`Error::Setting`] when the values do not go together, [`Error::Other`] for genomes that cannot be.
pub(crate) fn one_plus_one(settings: &Settings, genes: usize, gene_bits: u32) -> Result<OnePlusOneConfig, Error> {
    let config = OnePlusOneConfig {
        genes,
        gene_bits,
        first_rate: settings.number(FIRST_RATE)?,
        rate_step: settings.number(RATE_STEP)?,
        last_rate: settings.number(LAST_RATE)?,
        mutation: mutation(settings)?,
    };
    config.validate().map_err(|error| match error {
        EvoError::RisingRate { .. } => Error::setting(LAST_RATE, error),
        _ => Error::Other(error.to_string()),
    })?;
    Ok(config)
}

/// The truncation algorithm's configuration for the genomes of an experiment.
///
/// # Errors
/// [`Error::Setting`] when the values do not go together.
pub(crate) fn config(settings: &Settings, genes: usize, gene_bits: u32) -> Result<GaConfig, Error> {
    let config = GaConfig {
        genes,
        gene_bits,
        population: settings.count(POPULATION)?,
        parents: settings.count(PARENTS)?,
        mutation_rate: settings.number(RATE)?,
        mutation: mutation(settings)?,
    };
    config.validate().map_err(|error| {
        let key = match error {
            EvoError::NoParents => PARENTS,
            EvoError::Rate { .. } => RATE,
            _ => POPULATION,
        };
        Error::setting(key, error)
    })?;
    Ok(config)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::settings::Value;

    #[test]
    fn the_defaults_are_those_of_the_library() {
        let settings = Settings::new(settings()).unwrap();
        assert_eq!(config(&settings, 792, 16).unwrap(), GaConfig::new(792));
    }

    #[test]
    fn an_experiment_replaces_a_default_in_its_place() {
        let own = vec![Setting::flag("world.flat", true), Setting::whole(POPULATION, 30, 1..=100)];
        let table = complete(own, Search::Truncation);
        let keys: Vec<&str> = table.iter().map(Setting::key).collect();
        assert_eq!(keys, [GENERATIONS, POPULATION, PARENTS, MUTATION, RATE, "world.flat"]);
        assert_eq!(table[1].default_value(), &Value::Whole(30));
    }

    #[test]
    fn fewer_individuals_than_parents_are_refused_by_name() {
        let mut settings = Settings::new(settings()).unwrap();
        settings.set("", POPULATION, Value::Whole(10)).unwrap();
        let error = config(&settings, 3, 16).unwrap_err().to_string();
        assert_eq!(error, "`evolution.population`: 20 parents from a population of 10");
    }
}
