//! Strategies that estimate a gradient.

use farsa_evo::gradient::{Ars, ArsConfig, OpenAiEs, OpenAiEsConfig, Optimizer, Pgpe, PgpeConfig, PgpeFitness};

use super::{SIGMA, STEPS, WIDTH, count_or, number_or, pairs, population_of_pairs, sigma, sizes};
use crate::experiment::settings::Setting;
use crate::strategy::settings::NORMALISE;
use crate::strategy::simple::SimpleStrategy;

const LEARNING_RATE: &str = "strategy.learning_rate";
const WEIGHT_DECAY: &str = "strategy.weight_decay";
const OPTIMIZER: &str = "strategy.optimizer";
const TOP: &str = "strategy.top_directions";
const MAX_SPEED: &str = "strategy.max_speed";
const SIGMA_RATE: &str = "strategy.sigma_learning_rate";
const SIGMA_CHANGE: &str = "strategy.sigma_max_change";
const FITNESS: &str = "strategy.fitness";

/// Setting of normalized observations.
fn normalise() -> Setting {
    Setting::flag(NORMALISE, false).doc(
        "Whether each channel of the observations is normalised by its mean and standard deviation in all generations before.",
    )
}

/// Evolution strategy of `OpenAI`, [`farsa_evo::gradient::OpenAiEs`].
pub(in crate::strategy) static OPEN_AI_ES: SimpleStrategy = SimpleStrategy {
    name: "open-ai-es",
    summary: "A gradient estimated from mirrored noise of one size, followed by Adam [Salimans2017].",
    settings: || {
        let mut table = sizes(population_of_pairs(40));
        table.extend([
            sigma(0.02, "the source's, whose weights have no range").given(),
            Setting::number(LEARNING_RATE, 0.01, 1e-9..=10.0).given().doc("Learning rate (alpha)."),
            Setting::number(WEIGHT_DECAY, 0.25, 0.0..=1e6)
                .derived()
                .doc("What is subtracted from the gradient for each unit of a gene: 0.005 / sigma of the source."),
            Setting::word(OPTIMIZER, "adam", &["adam", "momentum"]).given().doc("How the gradient becomes a step."),
            normalise(),
        ]);
        table
    },
    start: |start| {
        let settings = start.settings;
        let config = OpenAiEsConfig {
            sigma: settings.number(SIGMA)?,
            learning_rate: settings.number(LEARNING_RATE)?,
            weight_decay: settings.number(WEIGHT_DECAY)?,
            optimizer: if settings.word(OPTIMIZER)? == "adam" { Optimizer::ADAM } else { Optimizer::MOMENTUM },
            ..OpenAiEsConfig::new(vec![0.0; start.genes], pairs(settings)?)
        };
        start.reals(|seed| OpenAiEs::new(config.clone(), seed))
    },
    diagnostics: Some(STEPS),
};

/// Policy gradients with parameter-based exploration, [`farsa_evo::gradient::Pgpe`].
pub(in crate::strategy) static PGPE: SimpleStrategy = SimpleStrategy {
    name: "pgpe",
    summary: "Policy gradients with parameter-based exploration, followed by ClipUp [Toklu2020].",
    settings: || {
        let mut table = sizes(population_of_pairs(40));
        table.extend([
            sigma(0.1, "a twentieth of each range"),
            Setting::number(MAX_SPEED, 0.0, 0.0..=1e6)
                .given()
                .doc("The most that the center moves in a generation; 0 for a 15th of sigma sqrt n of n genes."),
            Setting::number(SIGMA_RATE, 0.1, 0.0..=10.0).given().doc("Learning rate of the standard deviations."),
            Setting::number(SIGMA_CHANGE, 0.2, 0.0..=0.999)
                .given()
                .doc("The most that a standard deviation changes in a generation, as a share of itself."),
            Setting::word(FITNESS, "ranks", &["ranks", "raw"]).given().doc("What stands for the reward."),
            normalise(),
        ]);
        table
    },
    start: |start| {
        let settings = start.settings;
        let plain = PgpeConfig::new(vec![0.0; start.genes], settings.number(SIGMA)?, pairs(settings)?);
        let max_speed = number_or(settings, MAX_SPEED, plain.max_speed)?;
        let raw = settings.word(FITNESS)? == "raw";
        let config = PgpeConfig {
            max_speed,
            step_size: 0.5 * max_speed,
            sigma_learning_rate: settings.number(SIGMA_RATE)?,
            sigma_max_change: settings.number(SIGMA_CHANGE)?,
            fitness: if raw { PgpeFitness::Raw } else { PgpeFitness::CenteredRanks },
            largest_step: WIDTH,
            ..plain
        };
        start.reals(|seed| Pgpe::new(config.clone(), seed))
    },
    diagnostics: None,
};

/// Augmented random search, [`farsa_evo::gradient::Ars`].
pub(in crate::strategy) static ARS: SimpleStrategy = SimpleStrategy {
    name: "ars",
    summary: "Augmented random search along the best of mirrored directions [Mania2018].",
    settings: || {
        let mut table = sizes(population_of_pairs(40));
        table.extend([
            sigma(0.03, "the source's exploration noise nu").given(),
            Setting::number(LEARNING_RATE, 0.02, 1e-9..=10.0).given().doc("Step size (alpha)."),
            Setting::whole(TOP, 0, 0..=500_000)
                .given()
                .doc("Directions that the step is made of (b), the best ones; 0 for all of them."),
            normalise(),
        ]);
        table
    },
    start: |start| {
        let settings = start.settings;
        let plain = ArsConfig::new(vec![0.0; start.genes], pairs(settings)?);
        let config = ArsConfig {
            top_directions: count_or(settings, TOP, plain.top_directions)?,
            step_size: settings.number(LEARNING_RATE)?,
            noise: settings.number(SIGMA)?,
            ..plain
        };
        start.reals(|seed| Ars::new(config.clone(), seed))
    },
    diagnostics: Some(STEPS),
};
