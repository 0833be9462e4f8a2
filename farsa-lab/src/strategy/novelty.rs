//! Novelty search over the truncation algorithm.

use farsa_evo::archives::{ArchiveRule, NoveltyConfig, NoveltySearch};
use farsa_evo::words::TruncationGa;

use crate::experiment::settings::Setting;
use crate::strategy::definition::{Diagnostics, DiagnosticsChart, StrategyDefinition as _};
use crate::strategy::simple::SimpleStrategy;
use crate::strategy::truncation::{Truncation, config};

const NEIGHBOURS: &str = "strategy.neighbours";
const RATE: &str = "strategy.archive_rate";

/// Novelty search, [`farsa_evo::archives::NoveltySearch`].
pub(super) static NOVELTY_SEARCH: SimpleStrategy = SimpleStrategy {
    name: "novelty-search",
    summary: "The truncation algorithm for new behaviors instead of fitness; wants a behavior descriptor [Lehman2011].",
    settings: || {
        let mut table = Truncation.settings();
        table.extend([
            Setting::whole(NEIGHBOURS, 15, 1..=1_000_000)
                .given()
                .doc("Nearest behaviors (k), whose mean distance is the novelty; each value in shares of its range."),
            Setting::number(RATE, 0.02, 0.0..=1.0).doc("Probability that a behavior enters the archive."),
        ]);
        table
    },
    start: |start| {
        let ranges = start.wanted_measures("novelty-search")?;
        let units: Vec<f64> = ranges.iter().map(|[low, high]| high - low).collect();
        let novelty = NoveltyConfig {
            neighbors: start.settings.count(NEIGHBOURS)?,
            archive: ArchiveRule::Random { rate: start.settings.number(RATE)? },
            ..NoveltyConfig::new(ranges.len())
        };
        let truncation = config(start.settings, start.genes, start.gene_bits)?;
        let search =
            |seed| NoveltySearch::new(novelty, TruncationGa::new(truncation, seed)?, seed)?.with_units::<u16>(&units);
        start.words(search)
    },
    diagnostics: Some(Diagnostics {
        file: "strategy",
        charts: &[
            DiagnosticsChart { title: "archive", axis: "behaviors", curves: &[("archive", "in the archive")] },
            DiagnosticsChart { title: "novelty", axis: "distance", curves: &[("novelty", "the largest")] },
        ],
    }),
};
