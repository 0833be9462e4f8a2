//! The settings that strategies share, and the table of an experiment with those of its strategy.

use farsa_evo::Mutation;

use crate::error::Error;
use crate::experiment::settings::{Setting, Settings};

/// Evaluated generations.
pub(crate) const GENERATIONS: &str = "evolution.generations";
/// Individuals of a generation.
pub(crate) const POPULATION: &str = "evolution.population";
/// What happens to a bit that mutation hits.
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

/// The mutation that [`MUTATION`] names.
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
}
