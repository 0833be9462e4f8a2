//! Several objectives.

use farsa_evo::pareto::{Nsga2, Nsga2Config};

use super::{bounds, number_or, sizes};
use crate::experiment::settings::Setting;
use crate::strategy::definition::{Diagnostics, DiagnosticsChart};
use crate::strategy::settings::POPULATION;
use crate::strategy::simple::SimpleStrategy;

const CROSSOVER_RATE: &str = "strategy.crossover_rate";
const CROSSOVER_INDEX: &str = "strategy.crossover_index";
const MUTATION_RATE: &str = "strategy.mutation_rate";
const MUTATION_INDEX: &str = "strategy.mutation_index";

/// Elitist non-dominated sorting genetic algorithm, [`farsa_evo::pareto::Nsga2`].
pub(in crate::strategy) static NSGA2: SimpleStrategy = SimpleStrategy {
    name: "nsga2",
    summary: "The front of several objectives, by non-dominated sorting; wants two objectives [Deb2002].",
    settings: || {
        let mut table =
            sizes(Setting::whole(POPULATION, 100, 1..=1_000_000).given().doc("Individuals of a generation (N)."));
        table.extend([
            Setting::number(CROSSOVER_RATE, 0.9, 0.0..=1.0)
                .given()
                .doc("Probability that a child has two parents (p_c)."),
            Setting::number(CROSSOVER_INDEX, 20.0, 0.0..=1000.0)
                .given()
                .doc("Distribution index of crossover (eta_c): the larger, the nearer to the parents."),
            Setting::number(MUTATION_RATE, 0.0, 0.0..=1.0)
                .given()
                .doc("Probability that a gene is mutated (p_m); 0 for one gene in a genome."),
            Setting::number(MUTATION_INDEX, 20.0, 0.0..=1000.0)
                .given()
                .doc("Distribution index of mutation (eta_m): the larger, the smaller the steps."),
        ]);
        table
    },
    start: |start| {
        let settings = start.settings;
        let config = Nsga2Config::new(bounds(start.genes), start.wanted_objectives("nsga2")?);
        let config = Nsga2Config {
            population: settings.count(POPULATION)?,
            crossover_rate: settings.number(CROSSOVER_RATE)?,
            crossover_eta: settings.number(CROSSOVER_INDEX)?,
            mutation_rate: number_or(settings, MUTATION_RATE, config.mutation_rate)?,
            mutation_eta: settings.number(MUTATION_INDEX)?,
            ..config
        };
        start.reals(|seed| Nsga2::new(config.clone(), seed))
    },
    diagnostics: Some(Diagnostics {
        file: "strategy",
        charts: &[DiagnosticsChart { title: "front", axis: "individuals", curves: &[("front", "non-dominated")] }],
    }),
};
