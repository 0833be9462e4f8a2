//! Truncation algorithm, in one population or several.

use farsa_evo::EvoError;
use farsa_evo::coevolution::Populations;
use farsa_evo::words::{GaConfig, TruncationGa};

use crate::error::Error;
use crate::experiment::settings::{Setting, Settings};
use crate::strategy::any_strategy::AnyStrategy;
use crate::strategy::definition::{StrategyDefinition, StrategyStart};
use crate::strategy::settings::{GENERATIONS, MUTATION, POPULATION, mutation};

const PARENTS: &str = "evolution.parents";
pub(super) const RATE: &str = "evolution.mutation_rate";

/// A strategy in which the best individuals of a generation produce mutated copies. See
/// [`farsa_evo::words::TruncationGa`].
///
/// If there are several populations, they evolve separately, as in [`farsa_evo::coevolution::Populations`]. Defaults
/// are those of \[Ferrauto2010\].
#[derive(Debug, Clone, Copy)]
pub struct Truncation;

impl StrategyDefinition for Truncation {
    fn name(&self) -> &'static str {
        "truncation"
    }

    fn summary(&self) -> &'static str {
        "The best of a generation make mutated copies [Ferrauto2010]."
    }

    fn settings(&self) -> Vec<Setting> {
        vec![
            Setting::whole(GENERATIONS, 1000, 1..=i64::from(u32::MAX) - 1)
                .given()
                .doc("Generations that are evaluated. A resumed run may change it, and nothing else."),
            Setting::whole(POPULATION, 100, 1..=1_000_000).given().doc(
                "Individuals of a generation, a multiple of the parents. With no more than them nothing is ever mutated.",
            ),
            Setting::whole(PARENTS, 20, 1..=1_000_000)
                .given()
                .doc("The best individuals, which make population / parents copies each. The first copy is unchanged."),
            Setting::word(MUTATION, "resample", &["resample", "flip"])
                .given()
                .doc("Change of a bit that mutation hits: it is drawn again, or it flips."),
            Setting::number(RATE, 0.015, 0.0..=1.0).given().doc("Probability that mutation hits a bit."),
        ]
    }

    fn start(&self, start: &StrategyStart<'_>) -> Result<AnyStrategy, Error> {
        let config = config(start.settings, start.genes, start.gene_bits)?;
        let refused = |error: EvoError| Error::Other(error.to_string());
        Ok(if start.populations == 1 {
            AnyStrategy::from_words(TruncationGa::new(config, start.seed).map_err(refused)?)
        } else {
            AnyStrategy::from_words(
                Populations::truncation(&vec![config; start.populations], start.seed).map_err(refused)?,
            )
        })
    }
}

/// Builds the truncation algorithm's configuration for the genomes of an experiment.
///
/// # Errors
/// [`Error::Setting`] when the values do not go together.
pub(super) fn config(settings: &Settings, genes: usize, gene_bits: u32) -> Result<GaConfig, Error> {
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
            EvoError::Config { field: "parents", .. } => PARENTS,
            EvoError::Config { field: "mutation_rate", .. } => RATE,
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
        let settings = Settings::new(Truncation.settings()).unwrap();
        assert_eq!(config(&settings, 792, 16).unwrap(), GaConfig::new(792));
    }

    #[test]
    fn fewer_individuals_than_parents_are_refused_by_name() {
        let mut settings = Settings::new(Truncation.settings()).unwrap();
        settings.set("", POPULATION, Value::Whole(10)).unwrap();
        let error = config(&settings, 3, 16).unwrap_err().to_string();
        assert_eq!(error, "`evolution.population`: 20 parents from a population of 10");
    }
}
