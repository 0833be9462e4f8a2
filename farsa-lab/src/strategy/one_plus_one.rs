//! One parent and one mutant.

use farsa_evo::EvoError;
use farsa_evo::words::OnePlusOneConfig;

use crate::error::Error;
use crate::experiment::settings::{Setting, Settings};
use crate::strategy::any_strategy::AnyStrategy;
use crate::strategy::definition::{StrategyDefinition, StrategyStart};
use crate::strategy::settings::{GENERATIONS, MUTATION, mutation};

const FIRST_RATE: &str = "evolution.first_rate";
const RATE_STEP: &str = "evolution.rate_step";
const LAST_RATE: &str = "evolution.last_rate";

/// A strategy with one parent, which makes one mutant in each generation. The better one survives. See
/// [`farsa_evo::words::OnePlusOne`]. Its defaults are those of the original's discrimination experiment.
///
/// In the log of such a run, you find the mean fitness of the parent over all its evaluations, and the fitness of the
/// mutant. The better of both is the survivor, which is also the champion.
#[derive(Debug, Clone, Copy)]
pub struct OnePlusOne;

impl StrategyDefinition for OnePlusOne {
    fn name(&self) -> &'static str {
        "one-plus-one"
    }

    fn summary(&self) -> &'static str {
        "One parent and one mutant a generation, with a rate that falls, as in the original FARSA."
    }

    fn settings(&self) -> Vec<Setting> {
        vec![
            Setting::whole(GENERATIONS, 500, 1..=i64::from(u32::MAX) - 1)
                .given()
                .doc("Generations of one parent and one mutant. A resumed run may change it, and nothing else."),
            Setting::word(MUTATION, "flip", &["flip", "resample"])
                .given()
                .doc("Change of a bit that mutation hits: it flips, or it is drawn again."),
            Setting::number(FIRST_RATE, 0.5, 0.0..=1.0)
                .given()
                .doc("Probability that mutation hits a bit of the first mutant."),
            Setting::number(RATE_STEP, 0.01, 0.0..=1.0)
                .given()
                .doc("What that probability falls by from generation to generation."),
            Setting::number(LAST_RATE, 0.02, 0.0..=1.0).given().doc("The probability below which it does not fall."),
        ]
    }

    fn start(&self, start: &StrategyStart<'_>) -> Result<AnyStrategy, Error> {
        if start.populations != 1 {
            return Err(Error::Other(format!("one parent and one mutant of {} populations", start.populations)));
        }
        let config = config(start.settings, start.genes, start.gene_bits)?;
        let search = farsa_evo::words::OnePlusOne::new(config, start.seed);
        Ok(AnyStrategy::from_words(search.map_err(|error| Error::Other(error.to_string()))?))
    }
}

/// Builds the configuration for the genomes of an experiment.
///
/// # Errors
/// [`Error::Setting`] when the values do not go together, [`Error::Other`] for genomes that cannot be.
fn config(settings: &Settings, genes: usize, gene_bits: u32) -> Result<OnePlusOneConfig, Error> {
    let config = OnePlusOneConfig {
        genes,
        gene_bits,
        first_rate: settings.number(FIRST_RATE)?,
        rate_step: settings.number(RATE_STEP)?,
        last_rate: settings.number(LAST_RATE)?,
        mutation: mutation(settings)?,
    };
    config.validate().map_err(|error| match error {
        EvoError::Config { field: "last_rate", .. } => Error::setting(LAST_RATE, error),
        _ => Error::Other(error.to_string()),
    })?;
    Ok(config)
}
