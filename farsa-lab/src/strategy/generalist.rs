//! Competitive co-evolution with generalist selection.

use farsa_evo::EvoError;
use farsa_evo::coevolution::{GeneralistCoevolution, GeneralistConfig};

use crate::error::Error;
use crate::experiment::settings::Setting;
use crate::strategy::any_strategy::AnyStrategy;
use crate::strategy::definition::{Diagnostics, DiagnosticsChart, StrategyDefinition as _};
use crate::strategy::settings::{GENERATIONS, MUTATION, POPULATION, mutation};
use crate::strategy::simple::SimpleStrategy;
use crate::strategy::truncation::{RATE, Truncation};

const NEWCOMERS: &str = "strategy.newcomers";
const OPPONENTS: &str = "strategy.opponents";
const ITERATIONS: &str = "strategy.iterations";

/// Generalist selection, [`farsa_evo::coevolution::GeneralistCoevolution`], of experiments of two populations.
pub(super) static GENERALIST: SimpleStrategy = SimpleStrategy {
    name: "generalist",
    summary: "What newcomers learned against some opponents stays if it is better against all; wants two populations [Simione2020].",
    settings: || {
        let mut table = Truncation.settings();
        table.retain(|setting| [GENERATIONS, MUTATION, RATE].contains(&setting.key()));
        table.insert(
            1,
            Setting::whole(POPULATION, 90, 2..=10_000)
                .given()
                .doc("Individuals of each population, members and newcomers; all meet all in population / opponents generations."),
        );
        table.extend([
            Setting::whole(NEWCOMERS, 10, 1..=5000)
                .given()
                .doc("Copies of members that are trained and may replace members (E); a divisor of the population."),
            Setting::whole(OPPONENTS, 0, 0..=5000).doc(
                "Opponents that each meets in a generation (m), one trial or more each; 0 for as many as there are trials, 10 in the source.",
            ),
            Setting::whole(ITERATIONS, 20, 1..=1_000_000)
                .given()
                .doc("Generations in which newcomers are trained before all meet all again."),
        ]);
        table
    },
    start: |start| {
        if start.populations != 2 {
            let (found, plural) = (start.populations, if start.populations == 1 { "" } else { "s" });
            return Err(Error::Other(format!("has {found} population{plural} where `generalist` wants 2")));
        }
        let settings = start.settings;
        let (population, newcomers) = (settings.count(POPULATION)?, settings.count(NEWCOMERS)?);
        let members = population.saturating_sub(newcomers);
        if members == 0 || !population.is_multiple_of(newcomers.max(1)) {
            let why = format!("{newcomers} newcomers are not a half, a third or so on of {population} individuals");
            return Err(Error::setting(NEWCOMERS, why));
        }
        let opponents = match settings.count(OPPONENTS)? {
            0 => start.trials.min(members),
            opponents if opponents > start.trials => {
                let why = format!("{opponents} opponents in {} trials", start.trials);
                return Err(Error::setting(OPPONENTS, why));
            }
            opponents => opponents,
        };
        let config = GeneralistConfig {
            genes: start.genes,
            gene_bits: start.gene_bits,
            members,
            newcomers,
            opponents,
            iterations: u32::try_from(settings.count(ITERATIONS)?).unwrap_or(u32::MAX),
            mutation_rate: settings.number(RATE)?,
            mutation: mutation(settings)?,
        };
        let refused = |error: EvoError| match error {
            EvoError::OutOfRange { field: "the number of opponents", .. } => Error::setting(OPPONENTS, error),
            _ => Error::setting(POPULATION, error),
        };
        Ok(AnyStrategy::from_words(GeneralistCoevolution::new(config, start.seed).map_err(refused)?))
    },
    diagnostics: Some(Diagnostics {
        file: "strategy",
        charts: &[
            DiagnosticsChart {
                title: "members replaced",
                axis: "members",
                curves: &[("replaced_1", "of the first population"), ("replaced_2", "of the second")],
            },
            DiagnosticsChart {
                title: "fitness of members against all members",
                axis: "fitness",
                curves: &[("members_1", "of the first population"), ("members_2", "of the second")],
            },
        ],
    }),
};
