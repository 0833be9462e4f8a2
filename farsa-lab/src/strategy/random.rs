//! Search without selection, as the null model.

use farsa_evo::words::RandomSearch;

use crate::experiment::settings::Setting;
use crate::strategy::settings::{GENERATIONS, POPULATION};
use crate::strategy::simple::SimpleStrategy;

/// Genomes drawn at random in every generation, [`farsa_evo::words::RandomSearch`].
pub(super) static RANDOM: SimpleStrategy = SimpleStrategy {
    name: "random-search",
    summary: "Every genome is drawn again at random. Better results of other strategies come from selection.",
    settings: || {
        vec![
            Setting::whole(GENERATIONS, 1000, 1..=i64::from(u32::MAX) - 1)
                .doc("Generations that are evaluated. A resumed run may change it, and nothing else."),
            Setting::whole(POPULATION, 100, 1..=1_000_000).doc("Individuals of a generation."),
        ]
    },
    start: |start| {
        let population = start.settings.count(POPULATION)?;
        start.words(|seed| RandomSearch::new(start.genes, population, seed))
    },
    diagnostics: None,
};
