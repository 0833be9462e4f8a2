//! Genetic algorithms and evolution strategies.

use farsa_evo::real::{
    Crossover, EvolutionStrategy, EvolutionStrategyConfig, RealGa, RealGaConfig, RealMutation, Recombination,
    Selection, SteadyState, SteadyStateConfig, StepSizes, Survival,
};

use super::{SIGMA, WIDTH, bounds, number_or, sigma, sizes};
use crate::error::Error;
use crate::experiment::settings::{Setting, Settings};
use crate::strategy::definition::{Diagnostics, DiagnosticsChart};
use crate::strategy::settings::POPULATION;
use crate::strategy::simple::SimpleStrategy;

const PARENTS: &str = "strategy.parents";
const ELITES: &str = "strategy.elites";
const SELECTION: &str = "strategy.selection";
const TOURNAMENT: &str = "strategy.tournament";
const PRESSURE: &str = "strategy.pressure";
const CROSSOVER: &str = "strategy.crossover";
const CROSSOVER_RATE: &str = "strategy.crossover_rate";
const MUTATION: &str = "strategy.mutation";
const MUTATION_RATE: &str = "strategy.mutation_rate";
const NOISE: &str = "strategy.noise";
const SURVIVAL: &str = "strategy.survival";
const RECOMBINATION: &str = "strategy.recombination";
const STEP_SIZES: &str = "strategy.step_sizes";

/// A mutation's size as a share of the range.
fn share(default: f64) -> Setting {
    Setting::number(SIGMA, default, 0.0..=1.0)
        .doc("Standard deviation of mutation, as a share of each parameter's range.")
}

/// Mean step size.
const STEP_SIZE: Diagnostics = Diagnostics {
    file: "strategy",
    charts: &[DiagnosticsChart { title: "step size", axis: "mean", curves: &[("step size", "of the parents")] }],
};

/// A generational genetic algorithm, [`farsa_evo::real::RealGa`].
pub(in crate::strategy) static REAL_GA: SimpleStrategy = SimpleStrategy {
    name: "real-ga",
    summary: "A generational genetic algorithm: selection, crossover, mutation, elites [Goldberg1991] [Deb1995].",
    settings: || {
        let mut table = sizes(Setting::whole(POPULATION, 100, 1..=1_000_000).doc("Individuals of a generation."));
        table.extend([
            Setting::whole(ELITES, 1, 0..=999_999).doc("The best, which go on unchanged."),
            Setting::word(SELECTION, "tournament", &["tournament", "rank", "truncation"]).doc("How parents are chosen."),
            Setting::whole(TOURNAMENT, 2, 1..=1_000_000).doc("Individuals that compete in a tournament."),
            Setting::number(PRESSURE, 1.5, 1.0..=2.0).doc("Children that the best expects when parents are chosen by rank."),
            Setting::whole(PARENTS, 20, 1..=1_000_000).doc("The best, of which truncation chooses parents."),
            Setting::word(CROSSOVER, "simulated-binary", &["simulated-binary", "blend", "uniform", "none"])
                .doc("How the genes of two parents are mixed: SBX of index 2, BLX-0.5, or each gene from either."),
            Setting::number(CROSSOVER_RATE, 0.9, 0.0..=1.0).doc("Probability that a child has two parents."),
            Setting::word(MUTATION, "gaussian", &["gaussian", "self-adaptive"])
                .doc("Whether the step size of mutation is the same always, or inherited and mutated itself [Beyer2002]."),
            Setting::number(MUTATION_RATE, 0.0, 0.0..=1.0)
                .doc("Probability that a gene is mutated; 0 for one gene in a genome, or all genes where it is self-adaptive."),
            share(0.1),
        ]);
        table
    },
    start: |start| {
        let (settings, genes) = (start.settings, start.genes);
        let config = RealGaConfig {
            population: settings.count(POPULATION)?,
            elites: settings.count(ELITES)?,
            selection: match settings.word(SELECTION)? {
                "rank" => Selection::Rank { pressure: settings.number(PRESSURE)? },
                "truncation" => Selection::Truncation { parents: settings.count(PARENTS)? },
                _ => Selection::Tournament { size: settings.count(TOURNAMENT)? },
            },
            crossover: match settings.word(CROSSOVER)? {
                "blend" => Crossover::Blend { alpha: 0.5 },
                "uniform" => Crossover::Uniform { rate: 0.5 },
                "none" => Crossover::None,
                _ => Crossover::SimulatedBinary { eta: 2.0 },
            },
            crossover_rate: settings.number(CROSSOVER_RATE)?,
            mutation: mutation(settings, genes)?,
            ..RealGaConfig::new(bounds(genes))
        };
        start.reals(|seed| RealGa::new(config.clone(), seed))
    },
    diagnostics: Some(STEP_SIZE),
};

fn mutation(settings: &Settings, genes: usize) -> Result<RealMutation, Error> {
    let (n, sigma) = (genes.max(1) as f64, settings.number(SIGMA)?);
    Ok(if settings.word(MUTATION)? == "gaussian" {
        RealMutation::Gaussian { rate: number_or(settings, MUTATION_RATE, 1.0 / n)?, sigma }
    } else {
        let rate = number_or(settings, MUTATION_RATE, 1.0)?;
        RealMutation::SelfAdaptive { rate, initial: sigma.max(1e-6), tau: 1.0 / n.sqrt(), smallest: 1e-6 }
    })
}

/// Steady state strategy of evorobotpy, [`farsa_evo::real::SteadyState`].
pub(in crate::strategy) static STEADY_STATE: SimpleStrategy = SimpleStrategy {
    name: "sss",
    summary: "The steady state strategy of evorobotpy: the better half stays, each of it with one mutant [Nolfi2021].",
    settings: || {
        let population = Setting::whole(POPULATION, 20, 2..=1_000_000).given();
        let mut table = sizes(population.doc("Individuals, parents and offspring together: an even number."));
        table.extend([
            Setting::number(MUTATION_RATE, 1.0, 0.0..=1.0).given().doc("Probability that a gene is mutated."),
            share(0.02).given(),
            Setting::number(NOISE, 0.0, 0.0..=1e100)
                .doc("The most that is added to or taken from a fitness before it is ranked (stochasticity)."),
        ]);
        table
    },
    start: |start| {
        let settings = start.settings;
        let config = SteadyStateConfig {
            population: settings.count(POPULATION)?,
            rate: settings.number(MUTATION_RATE)?,
            sigma: settings.number(SIGMA)?,
            noise: settings.number(NOISE)?,
            ..SteadyStateConfig::new(bounds(start.genes))
        };
        start.reals(|seed| SteadyState::new(config.clone(), seed))
    },
    diagnostics: None,
};

/// An evolution strategy with self-adaptation, [`farsa_evo::real::EvolutionStrategy`].
pub(in crate::strategy) static EVOLUTION_STRATEGY: SimpleStrategy = SimpleStrategy {
    name: "evolution-strategy",
    summary: "(mu, lambda) and (mu + lambda) with recombination and self-adapted step sizes [Beyer2002].",
    settings: || {
        let population = Setting::whole(POPULATION, 100, 1..=1_000_000).given().doc("Offspring (lambda).");
        let mut table = sizes(population);
        table.extend([
            Setting::whole(PARENTS, 15, 1..=1_000_000).given().doc("Parents (mu), all of which are mixed."),
            Setting::word(SURVIVAL, "comma", &["comma", "plus", "plus-evaluated-again"])
                .given()
                .doc("Whether offspring alone are selected from, or parents too, which may be evaluated again."),
            Setting::word(RECOMBINATION, "intermediate", &["intermediate", "discrete", "none"])
                .given()
                .doc("How genes of parents are mixed; step sizes are averaged by their logarithms, or inherited where nothing is mixed."),
            Setting::word(STEP_SIZES, "one", &["one", "per-gene"]).doc("Step sizes of an individual."),
            sigma(0.5, "a quarter of each range"),
        ]);
        table
    },
    start: |start| {
        let (settings, genes) = (start.settings, start.genes);
        let recombination = match settings.word(RECOMBINATION)? {
            "discrete" => Recombination::Discrete,
            "none" => Recombination::None,
            _ => Recombination::Intermediate,
        };
        let alone = recombination == Recombination::None;
        let parents = settings.count(PARENTS)?;
        let config = EvolutionStrategyConfig {
            parents,
            mixing: parents,
            offspring: settings.count(POPULATION)?,
            survival: match settings.word(SURVIVAL)? {
                "plus" => Survival::Plus,
                "plus-evaluated-again" => Survival::PlusEvaluatedAgain,
                _ => Survival::Comma,
            },
            recombination,
            step_recombination: if alone { Recombination::None } else { Recombination::Intermediate },
            step_sizes: match settings.word(STEP_SIZES)? {
                "per-gene" => StepSizes::per_gene(genes),
                _ => StepSizes::one(genes),
            },
            largest_step: WIDTH,
            ..EvolutionStrategyConfig::new(vec![0.0; genes], settings.number(SIGMA)?)
        };
        start.reals(|seed| EvolutionStrategy::new(config.clone(), seed))
    },
    diagnostics: Some(STEP_SIZE),
};
