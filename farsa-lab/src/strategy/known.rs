//! Strategies that a run may be asked for by name.

use crate::error::Error;
use crate::escaped::Quoted;
use crate::experiment::settings::{Setting, Settings};
use crate::strategy::definition::StrategyDefinition;
use crate::strategy::generalist::GENERALIST;
use crate::strategy::learning::Learning;
use crate::strategy::novelty::NOVELTY_SEARCH;
use crate::strategy::one_plus_one::OnePlusOne;
use crate::strategy::random::RANDOM;
use crate::strategy::reals;
use crate::strategy::truncation::Truncation;

/// Most strategies that a message lists.
const MAX_LISTED: usize = 3;

/// Ours.
static KNOWN: [&dyn StrategyDefinition; 21] = [
    &Truncation,
    &OnePlusOne,
    &RANDOM,
    &Learning,
    &reals::REAL_GA,
    &reals::STEADY_STATE,
    &reals::EVOLUTION_STRATEGY,
    &reals::COSYNE,
    &reals::CMA_ES,
    &reals::CHOLESKY_CMA_ES,
    &reals::SEPARABLE_CMA_ES,
    &reals::XNES,
    &reals::SNES,
    &reals::OPEN_AI_ES,
    &reals::PGPE,
    &reals::ARS,
    &reals::NSGA2,
    &reals::MAP_ELITES,
    &reals::CMA_ME,
    &NOVELTY_SEARCH,
    &GENERALIST,
];

/// Gets all strategies of this crate, in the order in which they are listed.
pub fn strategies() -> &'static [&'static dyn StrategyDefinition] {
    &KNOWN
}

/// Gets the strategy of a name.
///
/// # Errors
/// [`Error::Setting`] with the nearest name.
pub(crate) fn find(
    strategies: &[&'static dyn StrategyDefinition],
    name: &str,
    place: &str,
) -> Result<&'static dyn StrategyDefinition, Error> {
    let strategy = strategies.iter().copied().find(|strategy| strategy.name() == name);
    strategy.ok_or_else(|| Error::unknown(place, "strategy", name, strategies.iter().map(|strategy| strategy.name())))
}

/// Checks that a key is not a setting of other strategies alone.
///
/// # Errors
/// [`Error::Setting`] with both strategies and the keys of the given one.
pub(crate) fn check_key(
    strategy: &dyn StrategyDefinition,
    settings: &Settings,
    place: &str,
    key: &str,
) -> Result<(), Error> {
    let has = |other: &&&dyn StrategyDefinition| other.settings().iter().any(|setting| setting.key() == key);
    if settings.has(key) {
        return Ok(());
    }
    let others: Vec<&str> = KNOWN.iter().filter(has).map(|other| other.name()).collect();
    if others.is_empty() || others.contains(&strategy.name()) {
        return Ok(());
    }
    let list = |names: &[&str]| names.iter().map(|name| Quoted(name).to_string()).collect::<Vec<_>>().join(", ");
    let (listed, more) = others.split_at(others.len().min(MAX_LISTED));
    let more = if more.is_empty() { String::new() } else { format!(" and {} more", more.len()) };
    let keys = list(&strategy.settings().iter().map(Setting::key).collect::<Vec<_>>());
    let (listed, name) = (list(listed), Quoted(strategy.name()));
    let why = format!("a setting of {listed}{more}, not of {name}; the settings of {name} are {keys}");
    Err(Error::Setting { place: place.into(), key: key.into(), why })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limits::Limits;
    use crate::strategy::any_strategy::AnyStrategy;
    use crate::strategy::definition::StrategyStart;
    use farsa_evo::Scores;

    #[test]
    fn names_are_words_and_of_one_strategy_each() {
        for (number, strategy) in KNOWN.iter().enumerate() {
            let name = strategy.name();
            assert!(name.chars().all(|c| c == '-' || c.is_ascii_lowercase() || c.is_ascii_digit()), "{name}");
            assert!(KNOWN[..number].iter().all(|other| other.name() != name), "{name}");
            assert!(strategy.summary().ends_with('.') && !strategy.summary().contains('\n'), "{name}");
            assert!(strategy.settings().iter().all(|setting| !setting.doc_text().is_empty()), "{name}");
        }
        let error = find(&KNOWN, "cma", "here").map(|_| ()).unwrap_err().to_string();
        assert_eq!(error, "here: unknown strategy `cma`; the nearest is `cma-es`");
    }

    /// Starts a strategy with its default settings over five genes and two measures.
    fn start(strategy: &dyn StrategyDefinition, populations: usize) -> Result<AnyStrategy, Error> {
        let settings = Settings::new(strategy.settings()).unwrap();
        strategy.start(&StrategyStart {
            populations,
            trials: 3,
            genes: 5,
            gene_bits: 16,
            objectives: 2,
            measures: &[[0.0, 1.0], [-3.0, 5.0]],
            settings: &settings,
            seed: 3,
            limits: Limits::DEFAULT,
            evaluator: &|| Err(Error::Other("none".into())),
        })
    }

    /// Reports the same fitness to all individuals of 2000 generations. Returns the largest standard deviation of a gene
    /// in the last 100 generations, as the root of the mean variance.
    fn deviation_without_selection(name: &str, search: &mut dyn farsa_evo::Strategy<f64>) -> f64 {
        let mut variances = vec![0.0; search.ask().genome_len()];
        for generation in 0..2000 {
            let (population, shape) = (search.ask(), search.score_shape());
            assert!(population.as_slice().iter().all(|gene| gene.is_finite()), "{name}, {generation}");
            let count = population.len() as f64;
            for (index, variance) in variances.iter_mut().enumerate().filter(|_| generation >= 1900) {
                let genes = || population.iter().map(|genes| genes[index]);
                let mean = genes().sum::<f64>() / count;
                *variance += genes().map(|gene| (gene - mean) * (gene - mean)).sum::<f64>() / count / 100.0;
            }
            let values = vec![1.0; population.len() * shape.width()];
            search.tell_scores(&Scores::nan_as_failed(shape, values).unwrap()).unwrap();
        }
        variances.into_iter().fold(0.0, f64::max).sqrt()
    }

    #[test]
    fn default_steps_stay_within_the_range_without_selection() {
        let mut count = 0;
        for strategy in KNOWN {
            let Ok(AnyStrategy::Reals(mut search)) = start(strategy, 1) else { continue };
            let deviation = deviation_without_selection(strategy.name(), search.as_mut());
            // Mutations of CoSyNE are Cauchy numbers, which have no deviation.
            assert!(deviation < 2.1 || strategy.name() == "cosyne", "{}: {deviation}", strategy.name());
            let state = search.snapshot().unwrap().save();
            assert!(state.len() < 1_000_000, "{}: a state of {} bytes", strategy.name(), state.len());
            count += 1;
        }
        assert_eq!(count, 15);
    }

    #[test]
    fn all_start_with_their_defaults_in_one_population_and_in_several() {
        for strategy in KNOWN.iter().filter(|strategy| strategy.name() != "learning") {
            for populations in [1, 2] {
                let made = start(*strategy, populations);
                if [("one-plus-one", 2), ("generalist", 1)].contains(&(strategy.name(), populations)) {
                    assert!(made.is_err());
                    continue;
                }
                let mut made = made.unwrap();
                assert_eq!((made.populations(), made.genes(), made.generation()), (populations, 5, 0));
                let row = made.diagnostics().len();
                let curves =
                    strategy.diagnostics().map_or(0, |all| all.charts.iter().map(|chart| chart.curves.len()).sum());
                assert!(curves <= row, "{}: {curves} columns of {row} numbers", strategy.name());
                made.record().unwrap();
            }
        }
    }
}
