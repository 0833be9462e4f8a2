//! Cooperative co-evolution of weights.

use farsa_evo::coevolution::{Cosyne, CosyneConfig, Permutation};

use super::{SIGMA, count_or, sizes};
use crate::experiment::settings::Setting;
use crate::strategy::settings::POPULATION;
use crate::strategy::simple::SimpleStrategy;

const PARENTS: &str = "strategy.parents";
const OFFSPRING: &str = "strategy.offspring";
const MUTATION_RATE: &str = "strategy.mutation_rate";
const PERMUTATION: &str = "strategy.permutation";

/// Cooperative Synapse Neuroevolution, [`farsa_evo::coevolution::Cosyne`].
pub(in crate::strategy) static COSYNE: SimpleStrategy = SimpleStrategy {
    name: "cosyne",
    summary: "A subpopulation for each parameter, which is tried in other individuals in every generation [Gomez2008].",
    settings: || {
        let mut table =
            sizes(Setting::whole(POPULATION, 30, 2..=1_000_000).given().doc("Individuals of a generation."));
        table.extend([
            Setting::whole(PARENTS, 0, 0..=1_000_000).given().doc("The best, which are parents; 0 for a quarter of all."),
            Setting::whole(OFFSPRING, 0, 0..=1_000_000).doc("Offspring, which replace the worst; 0 for half of all."),
            Setting::number(MUTATION_RATE, 0.3, 0.0..=1.0).given().doc("Probability that a gene of an offspring is mutated."),
            Setting::number(SIGMA, 0.03, 0.0..=10.0)
                .derived()
                .doc("Scale of the Cauchy distribution that mutation adds, in halves of each parameter's range: 0.3 of 10 in the source."),
            Setting::word(PERMUTATION, "all", &["all", "by-fitness"])
                .given()
                .doc("Which genes change places: all but those of offspring, or those of the worse more often."),
        ]);
        table
    },
    start: |start| {
        let settings = start.settings;
        let population = settings.count(POPULATION)?;
        let config = CosyneConfig {
            population,
            parents: count_or(settings, PARENTS, (population / 4).max(1))?,
            offspring: count_or(settings, OFFSPRING, population / 2)?,
            range: 1.0,
            mutation_rate: settings.number(MUTATION_RATE)?,
            mutation_scale: settings.number(SIGMA)?,
            permutation: if settings.word(PERMUTATION)? == "all" { Permutation::All } else { Permutation::ByFitness },
            ..CosyneConfig::new(start.genes)
        };
        start.reals(|seed| Cosyne::new(config.clone(), seed))
    },
    diagnostics: None,
};
