//! Strategies over real genes by name.
//!
//! A real gene is 0 in the middle of its parameter's range and -1 and 1 at the ends. So step sizes are in units of half
//! a range.

/// Cooperative coevolution of weights.
mod cosyne;
/// Covariance matrix adaptation, full and separable.
mod covariance;
/// Generational, evolution strategies, and steady state.
mod genetic;
/// Estimated gradients.
mod gradient;
/// Archives of individuals with different measures.
mod map_elites;
/// Natural evolution strategies.
mod natural;
/// Several objectives.
mod pareto;

use crate::error::Error;
use crate::experiment::settings::{Setting, Settings};
use crate::strategy::definition::{Diagnostics, DiagnosticsChart};
use crate::strategy::settings::{GENERATIONS, POPULATION};

pub(super) use cosyne::COSYNE;
pub(super) use covariance::{CHOLESKY_CMA_ES, CMA_ES, SEPARABLE_CMA_ES};
pub(super) use genetic::{EVOLUTION_STRATEGY, REAL_GA, STEADY_STATE};
pub(super) use gradient::{ARS, OPEN_AI_ES, PGPE};
pub(super) use map_elites::{CMA_ME, MAP_ELITES};
pub(super) use natural::{SNES, XNES};
pub(super) use pareto::NSGA2;

const SIGMA: &str = "strategy.sigma";

/// Width of the range of a real gene, beyond which a step size has no meaning.
const WIDTH: f64 = 2.0;

/// Gets the ranges of all genes.
fn bounds(genes: usize) -> Vec<[f64; 2]> {
    vec![[-1.0, 1.0]; genes]
}

/// Settings of the number of generations and of individuals.
fn sizes(population: Setting) -> Vec<Setting> {
    let generations = Setting::whole(GENERATIONS, 1000, 1..=i64::from(u32::MAX) - 1);
    vec![generations.doc("Generations that are evaluated. A resumed run may change it, and nothing else."), population]
}

/// The individuals of a strategy whose source has a default that depends on the number of genes.
fn population_of_genes() -> Setting {
    Setting::whole(POPULATION, 0, 0..=1_000_000)
        .given()
        .doc("Individuals of a generation (lambda); 0 for 4 + 3 ln n of n genes, rounded down.")
}

/// The individuals of a strategy of mirrored pairs.
fn population_of_pairs(default: i64) -> Setting {
    Setting::whole(POPULATION, default, 2..=1_000_000)
        .doc("Individuals of a generation, an even number: each of its directions there and back.")
}

/// Gets the pairs of a generation.
fn pairs(settings: &Settings) -> Result<usize, Error> {
    let population = settings.count(POPULATION)?;
    if population.is_multiple_of(2) {
        Ok(population / 2)
    } else {
        Err(Error::setting(POPULATION, format!("{population} individuals are no pairs")))
    }
}

/// A number that a setting gives, or the source's default where it is 0.
fn number_or(settings: &Settings, key: &str, default: f64) -> Result<f64, Error> {
    let number = settings.number(key)?;
    Ok(if number > 0.0 { number } else { default })
}

/// A count that a setting gives, or the source's default where it is 0.
fn count_or(settings: &Settings, key: &str, default: usize) -> Result<usize, Error> {
    let count = settings.count(key)?;
    Ok(if count > 0 { count } else { default })
}

/// The step size of the first generation.
fn sigma(default: f64, why: &str) -> Setting {
    let doc = format!("Step size of the first generation, in halves of each parameter's range; {why}.");
    Setting::number(SIGMA, default, 1e-9..=WIDTH).doc(&doc)
}

/// Length of the latest step and of the point.
const STEPS: Diagnostics = Diagnostics {
    file: "strategy",
    charts: &[DiagnosticsChart {
        title: "lengths",
        axis: "halves of a range",
        curves: &[("step", "of the latest step"), ("point", "of the point")],
    }],
};
