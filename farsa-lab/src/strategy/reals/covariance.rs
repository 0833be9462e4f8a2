//! Covariance matrix adaptation, full and separable.

use farsa_evo::covariance::{
    CholeskyCmaEs, CmaEs, CmaEsConfig, CmaEsRestarts, CmaEsRestartsConfig, RestartSchedule, SeparableCmaEs,
    SeparableCmaEsConfig,
};

use super::{SIGMA, WIDTH, count_or, population_of_genes, sigma, sizes};
use crate::error::Error;
use crate::experiment::settings::{Setting, Settings};
use crate::strategy::any_strategy::AnyStrategy;
use crate::strategy::definition::{Diagnostics, DiagnosticsChart, StrategyStart};
use crate::strategy::settings::POPULATION;
use crate::strategy::simple::SimpleStrategy;

const ACTIVE: &str = "strategy.active";
const RESTARTS: &str = "strategy.restarts";

/// First columns of both.
const SHAPE: DiagnosticsChart = DiagnosticsChart {
    title: "distribution",
    axis: "sigma, axis ratio",
    curves: &[("step size", "step size"), ("axis ratio", "longest axis by shortest")],
};

/// Covariance matrix adaptation, [`farsa_evo::covariance::CmaEs`], with or without restarts, [`farsa_evo::covariance::CmaEsRestarts`].
pub(in crate::strategy) static CMA_ES: SimpleStrategy = SimpleStrategy {
    name: "cma-es",
    summary: "Covariance matrix adaptation, a normal distribution of every scale and correlation [Hansen2016].",
    settings: || {
        let mut table = sizes(population_of_genes());
        table.extend([
            sigma(0.5, "a quarter of each range"),
            Setting::flag(ACTIVE, true).given().doc("Whether the worse half has negative weights."),
            Setting::word(RESTARTS, "none", &["none", "ipop", "bipop"]).doc(
                "What follows a run that has come to its end: nothing; one of twice the individuals [Auger2005]; such or one \
                 of few [Hansen2009].",
            ),
        ]);
        table
    },
    start: |start| {
        let StrategyStart { settings, genes, .. } = *start;
        let first = config(settings, genes)?;
        let schedule = match settings.word(RESTARTS)? {
            "ipop" => RestartSchedule::Ipop,
            "bipop" => RestartSchedule::Bipop,
            _ => return start.reals(|seed| CmaEs::new(first.clone(), seed)),
        };
        start.reals(|seed| CmaEsRestarts::new(CmaEsRestartsConfig::new(first.clone(), schedule), seed))
    },
    diagnostics: Some(Diagnostics { file: "strategy", charts: &[SHAPE] }),
};

fn config(settings: &Settings, genes: usize) -> Result<CmaEsConfig, Error> {
    let plain = CmaEsConfig::new(vec![0.0; genes], settings.number(SIGMA)?);
    let population = count_or(settings, POPULATION, plain.population)?;
    Ok(CmaEsConfig { population, active: settings.flag(ACTIVE)?, largest_step: WIDTH, ..plain })
}

/// CMA-ES with a triangular factor instead of axes, [`farsa_evo::covariance::CholeskyCmaEs`].
pub(in crate::strategy) static CHOLESKY_CMA_ES: SimpleStrategy = SimpleStrategy {
    name: "cholesky-cma-es",
    summary: "Covariance matrix adaptation by a Cholesky factor, for some hundreds of genes [Krause2016].",
    settings: || {
        let mut table = sizes(population_of_genes());
        table.extend([
            sigma(0.5, "a quarter of each range"),
            Setting::flag(ACTIVE, true).given().doc("Whether the worse half has negative weights."),
        ]);
        table
    },
    start: |start| {
        let config = config(start.settings, start.genes)?;
        start.reals(|seed| CholeskyCmaEs::with_covariance(config.clone(), seed))
    },
    diagnostics: Some(Diagnostics {
        file: "strategy",
        charts: &[DiagnosticsChart {
            title: "distribution",
            axis: "sigma, ratio",
            curves: &[("step size", "step size"), ("diagonal ratio", "of the factor's diagonal")],
        }],
    }),
};

/// The same with a scale for each gene and no correlations, [`farsa_evo::covariance::SeparableCmaEs`].
pub(in crate::strategy) static SEPARABLE_CMA_ES: SimpleStrategy = SimpleStrategy {
    name: "separable-cma-es",
    summary: "Covariance matrix adaptation without correlations, for many genes [Ros2008].",
    settings: || {
        let mut table = sizes(population_of_genes());
        table.push(sigma(0.5, "a quarter of each range"));
        table
    },
    start: separable,
    diagnostics: Some(Diagnostics { file: "strategy", charts: &[SHAPE] }),
};

fn separable(start: &StrategyStart<'_>) -> Result<AnyStrategy, Error> {
    let plain = SeparableCmaEsConfig::new(vec![0.0; start.genes], start.settings.number(SIGMA)?);
    let population = count_or(start.settings, POPULATION, plain.population)?;
    let config = SeparableCmaEsConfig { population, largest_step: WIDTH, ..plain };
    start.reals(|seed| SeparableCmaEs::with_covariance(config.clone(), seed))
}
