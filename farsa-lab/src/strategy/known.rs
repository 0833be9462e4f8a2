//! Strategies that a run may be asked for by name.

use crate::error::Error;
use crate::strategy::definition::StrategyDefinition;
use crate::strategy::generalist::GENERALIST;
use crate::strategy::learning::Learning;
use crate::strategy::novelty::NOVELTY_SEARCH;
use crate::strategy::one_plus_one::OnePlusOne;
use crate::strategy::random::RANDOM;
use crate::strategy::reals;
use crate::strategy::truncation::Truncation;

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::evaluator::Evaluator;
    use crate::experiment::settings::Settings;
    use crate::limits::Limits;
    use crate::strategy::definition::StrategyStart;

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

    #[test]
    fn all_start_with_their_defaults_in_one_population_and_in_several() {
        let evaluator: &dyn Fn() -> Result<Box<dyn Evaluator>, Error> = &|| Err(Error::Other("none".into()));
        for strategy in KNOWN.iter().filter(|strategy| strategy.name() != "learning") {
            let settings = Settings::new(strategy.settings()).unwrap();
            for populations in [1, 2] {
                let start = StrategyStart {
                    populations,
                    trials: 3,
                    genes: 5,
                    gene_bits: 16,
                    objectives: 2,
                    measures: &[[0.0, 1.0], [-3.0, 5.0]],
                    settings: &settings,
                    seed: 3,
                    limits: Limits::DEFAULT,
                    evaluator,
                };
                let made = strategy.start(&start);
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
