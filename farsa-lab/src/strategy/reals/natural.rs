//! Natural evolution strategies.

use farsa_evo::gradient::{Snes, SnesConfig, Xnes, XnesConfig};

use super::{SIGMA, WIDTH, count_or, number_or, population_of_genes, sigma, sizes};
use crate::experiment::settings::Setting;
use crate::strategy::definition::{Diagnostics, DiagnosticsChart};
use crate::strategy::settings::POPULATION;
use crate::strategy::simple::SimpleStrategy;

const MEAN_RATE: &str = "strategy.mean_learning_rate";
const SIGMA_RATE: &str = "strategy.sigma_learning_rate";
const SHAPE_RATE: &str = "strategy.shape_learning_rate";

/// Settings of learning rates. 0 is the default of table 1 of the source.
fn rate(key: &str, of: &str) -> Setting {
    let doc = format!("Learning rate of {of}; 0 for that of the source, which depends on the number of genes.");
    Setting::number(key, 0.0, 0.0..=10.0).given().doc(&doc)
}

fn mean_rate() -> Setting {
    Setting::number(MEAN_RATE, 1.0, 0.0..=10.0).given().doc("Learning rate of the mean.")
}

/// Exponential natural evolution, [`farsa_evo::gradient::Xnes`].
pub(in crate::strategy) static XNES: SimpleStrategy = SimpleStrategy {
    name: "xnes",
    summary: "Exponential natural evolution, of every scale and correlation of up to 1024 genes [Wierstra2014].",
    settings: || {
        let mut table = sizes(population_of_genes());
        table.extend([sigma(0.5, "a quarter of each range"), mean_rate()]);
        table.extend([rate(SIGMA_RATE, "the step size"), rate(SHAPE_RATE, "the shape")]);
        table
    },
    start: |start| {
        let plain = XnesConfig::new(vec![0.0; start.genes], start.settings.number(SIGMA)?);
        let config = XnesConfig {
            population: count_or(start.settings, POPULATION, plain.population)?,
            mean_learning_rate: start.settings.number(MEAN_RATE)?,
            sigma_learning_rate: number_or(start.settings, SIGMA_RATE, plain.sigma_learning_rate)?,
            shape_learning_rate: number_or(start.settings, SHAPE_RATE, plain.shape_learning_rate)?,
            largest_step: WIDTH,
            ..plain
        };
        start.reals(|seed| Xnes::new(config.clone(), seed))
    },
    diagnostics: None,
};

/// Separable natural evolution, [`farsa_evo::gradient::Snes`].
pub(in crate::strategy) static SNES: SimpleStrategy = SimpleStrategy {
    name: "snes",
    summary: "Natural evolution without correlations, for many genes [Wierstra2014].",
    settings: || {
        let mut table = sizes(population_of_genes());
        table.extend([sigma(0.5, "a quarter of each range"), mean_rate()]);
        table.push(rate(SIGMA_RATE, "the standard deviations"));
        table
    },
    start: |start| {
        let plain = SnesConfig::new(vec![0.0; start.genes], start.settings.number(SIGMA)?);
        let config = SnesConfig {
            population: count_or(start.settings, POPULATION, plain.population)?,
            mean_learning_rate: start.settings.number(MEAN_RATE)?,
            sigma_learning_rate: number_or(start.settings, SIGMA_RATE, plain.sigma_learning_rate)?,
            largest_step: WIDTH,
            ..plain
        };
        start.reals(|seed| Snes::new(config.clone(), seed))
    },
    diagnostics: Some(Diagnostics {
        file: "strategy",
        charts: &[DiagnosticsChart {
            title: "standard deviations",
            axis: "halves of a range",
            curves: &[("smallest", "the smallest"), ("largest", "the largest")],
        }],
    }),
};
