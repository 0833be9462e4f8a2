//! Archives of individuals that behave differently.

use farsa_evo::archives::{Cells, CvtCells, Emitter, GridCells, MapElites, MapElitesConfig};

use super::{SIGMA, bounds, sizes};
use crate::error::Error;
use crate::experiment::settings::Setting;
use crate::strategy::any_strategy::AnyStrategy;
use crate::strategy::definition::{Diagnostics, DiagnosticsChart, StrategyStart};
use crate::strategy::settings::POPULATION;
use crate::strategy::simple::SimpleStrategy;

const CELLS: &str = "strategy.cells";
const DIVISION: &str = "strategy.division";
const VARIATION: &str = "strategy.variation";
const LINE: &str = "strategy.line_sigma";
const EMITTERS: &str = "strategy.emitters";

/// Points that a tessellation is made of, for each cell.
const POINTS: usize = 10;

/// Division of the measures into cells.
fn division() -> [Setting; 2] {
    [
        Setting::word(DIVISION, "grid", &["grid", "cvt"]).doc(
            "Division of behaviors into cells: a grid of equal parts, or a centroidal Voronoi tessellation [Vassiliades2018].",
        ),
        Setting::whole(CELLS, 1024, 1..=1_000_000)
            .doc("Cells of the archive; of a grid the most, as many parts of each value's range as fit."),
    ]
}

/// Number of elites, and the sum of their fitness.
const ARCHIVE: Diagnostics = Diagnostics {
    file: "strategy",
    charts: &[
        DiagnosticsChart { title: "archive", axis: "cells", curves: &[("elites", "with an elite")] },
        DiagnosticsChart { title: "QD score", axis: "fitness", curves: &[("qd score", "sum over the elites")] },
    ],
};

/// MAP-Elites with the iso-line or Gaussian emitter, [`farsa_evo::archives::MapElites`].
pub(in crate::strategy) static MAP_ELITES: SimpleStrategy = SimpleStrategy {
    name: "map-elites",
    summary: "The best individual of each cell of behaviors; wants a behavior descriptor [Mouret2015] [Mouret2018].",
    settings: || {
        let mut table = sizes(Setting::whole(POPULATION, 100, 1..=1_000_000).doc("Individuals of a generation."));
        table.extend(division());
        table.extend([
            Setting::word(VARIATION, "iso-line", &["iso-line", "gaussian"])
                .doc("Whether an elite is varied alone, or along the line to another one too."),
            Setting::number(SIGMA, 0.01, 0.0..=1.0)
                .given()
                .doc("Standard deviation of the variation, as a share of each parameter's range (sigma_1)."),
            Setting::number(LINE, 0.2, 0.0..=10.0).given().doc("Standard deviation along the line (sigma_2)."),
        ]);
        table
    },
    start: |start| {
        let (settings, batch) = (start.settings, start.settings.count(POPULATION)?);
        let sigma = settings.number(SIGMA)?;
        let emitter = if settings.word(VARIATION)? == "gaussian" {
            Emitter::Gaussian { batch, sigma }
        } else {
            Emitter::IsoLine { batch, iso_sigma: sigma, line_sigma: settings.number(LINE)? }
        };
        search(start, "map-elites", &MapElitesConfig { bounds: bounds(start.genes), emitters: vec![emitter] })
    },
    diagnostics: Some(ARCHIVE),
};

/// MAP-Elites with improvement emitters, [`MapElitesConfig::cma_me`].
pub(in crate::strategy) static CMA_ME: SimpleStrategy = SimpleStrategy {
    name: "cma-me",
    summary: "MAP-Elites by covariance matrix adaptation towards what improves the archive; wants a descriptor [Fontaine2020].",
    settings: || {
        let population = Setting::whole(POPULATION, 555, 2..=1_000_000).given();
        let mut table =
            sizes(population.doc("Individuals of a generation, as many of each emitter: 37 in the source."));
        table.extend(division());
        table.extend([Setting::whole(EMITTERS, 15, 1..=100_000).given().doc("Emitters."), super::sigma(0.5, "ours")]);
        table
    },
    start: |start| {
        let (population, emitters) = (start.settings.count(POPULATION)?, start.settings.count(EMITTERS)?);
        if !population.is_multiple_of(emitters) {
            let why = format!("{population} individuals are not as many of each of {emitters} emitters");
            return Err(Error::setting(POPULATION, why));
        }
        let sigma = start.settings.number(SIGMA)?;
        search(start, "cma-me", &MapElitesConfig::cma_me(bounds(start.genes), emitters, population / emitters, sigma))
    },
    diagnostics: Some(ARCHIVE),
};

/// A search over the cells that the settings divide the experiment's descriptor into.
fn search(start: &StrategyStart<'_>, name: &str, config: &MapElitesConfig) -> Result<AnyStrategy, Error> {
    let (ranges, cells) = (start.wanted_measures(name)?, start.settings.count(CELLS)?);
    let refused = |error: farsa_evo::EvoError| Error::setting(CELLS, error);
    if start.settings.word(DIVISION)? == "cvt" {
        let cells = CvtCells::new(cells, ranges, POINTS.saturating_mul(cells), start.seed).map_err(refused)?;
        return over(start, config, &cells);
    }
    let parts = vec![parts(cells, ranges.len()); ranges.len()];
    over(start, config, &GridCells::new(ranges.to_vec(), parts).map_err(refused)?)
}

fn over<C: Cells + Clone + Send + 'static>(
    start: &StrategyStart<'_>,
    config: &MapElitesConfig,
    cells: &C,
) -> Result<AnyStrategy, Error> {
    // A run is not to find out when most cells have an elite.
    let search = MapElites::new(config.clone(), cells.clone(), start.seed);
    let full = search.map_or(0, |search| search.largest_state()).saturating_mul(start.populations);
    let limit = start.limits.state_bytes;
    if full as u64 > limit {
        let (cells, genes) = (cells.cells(), start.genes);
        return Err(Error::setting(
            CELLS,
            format!("{cells} cells of {genes} genes, when full, are {full} bytes; a checkpoint keeps at most {limit}"),
        ));
    }
    start.reals(|seed| MapElites::new(config.clone(), cells.clone(), seed))
}

/// Computes the most equal parts of each of d ranges that make no more cells than these.
fn parts(cells: usize, d: usize) -> usize {
    let fits =
        |parts: usize| (0..d).try_fold(1, |all: usize, _| all.checked_mul(parts)).is_some_and(|all| all <= cells);
    let (mut fitting, mut beyond) = (1, cells.saturating_add(1));
    while fitting + 1 < beyond {
        let middle = fitting + (beyond - fitting) / 2;
        if fits(middle) {
            fitting = middle;
        } else {
            beyond = middle;
        }
    }
    fitting
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grid_has_as_many_parts_as_fit() {
        let found = [(1024, 2), (1000, 3), (999, 3), (7, 1), (1, 5), (10, 64), (1_000_000, 2)];
        assert_eq!(found.map(|(cells, d)| parts(cells, d)), [32, 10, 9, 7, 1, 1, 1000]);
    }
}
