//! Settings that strategies share, and the table of an experiment with those of its strategy.

use farsa_evo::words::Mutation;

use crate::error::Error;
use crate::experiment::settings::{Setting, Settings};

/// Evaluated generations.
pub(crate) const GENERATIONS: &str = "evolution.generations";
/// Individuals of a generation.
pub(crate) const POPULATION: &str = "evolution.population";
/// Setting of normalized observations.
pub(crate) const NORMALISE: &str = "strategy.normalise_observations";
/// Name of a strategy that is not the experiment's own.
pub(crate) const STRATEGY: &str = "strategy.name";
/// Effect of mutation on a bit.
pub(crate) const MUTATION: &str = "evolution.mutation";

/// An experiment's table with the settings of its strategy that it does not define itself in front.
pub(crate) fn complete(mut own: Vec<Setting>, mut strategy: Vec<Setting>) -> Vec<Setting> {
    for setting in &mut strategy {
        if let Some(index) = own.iter().position(|other| other.key() == setting.key()) {
            *setting = own.remove(index);
        }
    }
    strategy.append(&mut own);
    strategy
}

/// An experiment's table with the settings of a strategy that is not its own, and that strategy's name.
///
/// The strategy has its own defaults. The experiment's `evolution` and `strategy` settings describe another strategy,
/// except the length of the search.
pub(crate) fn chosen(own: Vec<Setting>, name: &str, strategy: Vec<Setting>) -> Vec<Setting> {
    let of_strategy = |key: &str| ["evolution.", "strategy."].iter().any(|section| key.starts_with(section));
    let about_this = |setting: &Setting| !of_strategy(setting.key()) || setting.key() == GENERATIONS;
    let own = own.into_iter().filter(about_this).collect();
    let doc = "The strategy, in place of the experiment's own.";
    let mut table = vec![Setting::word(STRATEGY, name, &[name]).doc(doc)];
    table.append(&mut complete(own, strategy));
    table
}

/// Gets the mutation that [`MUTATION`] names.
pub(crate) fn mutation(settings: &Settings) -> Result<Mutation, Error> {
    Ok(if settings.word(MUTATION)? == "flip" { Mutation::Flip } else { Mutation::Resample })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::settings::Value;
    use crate::strategy::definition::StrategyDefinition as _;
    use crate::strategy::truncation::Truncation;

    #[test]
    fn an_experiment_replaces_a_default_in_its_place() {
        let own = vec![Setting::flag("world.flat", true), Setting::whole(POPULATION, 30, 1..=100)];
        let table = complete(own, Truncation.settings());
        let keys: Vec<&str> = table.iter().map(Setting::key).collect();
        let own = ["evolution.parents", MUTATION, "evolution.mutation_rate", "world.flat"];
        assert_eq!(keys, [&[GENERATIONS, POPULATION][..], &own].concat());
        assert_eq!(table[1].default_value(), &Value::Whole(30));
    }

    #[test]
    fn a_chosen_strategy_has_its_own_defaults() {
        let own = vec![
            Setting::whole(GENERATIONS, 7, 1..=100),
            Setting::whole(POPULATION, 30, 1..=100),
            Setting::number("evolution.first_rate", 0.5, 0.0..=1.0),
            Setting::number("strategy.sigma", 0.5, 0.0..=1.0),
            Setting::flag("world.flat", true),
        ];
        let table = chosen(own, "truncation", Truncation.settings());
        let keys: Vec<&str> = table.iter().map(Setting::key).collect();
        let others = [POPULATION, "evolution.parents", MUTATION, "evolution.mutation_rate", "world.flat"];
        assert_eq!(keys, [&[STRATEGY, GENERATIONS][..], &others].concat());
        let defaults = [1, 2].map(|index: usize| table[index].default_value().clone());
        assert_eq!(defaults, [Value::Whole(7), Value::Whole(100)]);
    }
}
