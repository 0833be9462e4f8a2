//! What a strategy says of each generation beside the fitness, as a table and a picture.

use std::fmt::Write as _;

use crate::error::Error;
use crate::figures::plot;
use crate::figures::plot::{Chart, Curve};
use crate::store::directory::Directory;
use crate::store::replace::replace;
use crate::strategy::definition::Diagnostics;
use crate::strategy::search::Search;

/// The rows of a run's strategy so far.
pub(crate) struct DiagnosticsTable {
    diagnostics: Option<Diagnostics>,
    rows: Vec<Vec<f64>>,
}

impl DiagnosticsTable {
    /// The table with the rows of the generations before.
    pub(crate) fn new(diagnostics: Option<Diagnostics>, rows: Vec<Vec<f64>>) -> Self {
        Self { diagnostics, rows }
    }

    /// Adds what the strategy says of the generation that it has just been told.
    pub(crate) fn push(&mut self, strategy: &Search) {
        if self.diagnostics.is_some() {
            self.rows.push(strategy.diagnostics());
        }
    }

    /// Writes both files, where there is something to write.
    pub(crate) fn write(&self, directory: &Directory, title: &str) -> Result<(), Error> {
        let Some(diagnostics) = &self.diagnostics else { return Ok(()) };
        let [csv, svg] = directory.diagnostics(diagnostics.file);
        replace(&csv, self.csv(diagnostics).as_bytes())?;
        let plot = self.plot(diagnostics, title).map_err(|why| Error::damaged(&svg, why))?;
        replace(&svg, plot.as_bytes())
    }

    fn csv(&self, diagnostics: &Diagnostics) -> String {
        let mut text = String::from("generation");
        for (column, _) in diagnostics.charts.iter().flat_map(|chart| chart.curves) {
            // Writing into a string cannot fail.
            let _ = write!(text, ",{column}");
        }
        text.push('\n');
        let columns = diagnostics.charts.iter().map(|chart| chart.curves.len()).sum();
        for (generation, row) in self.rows.iter().enumerate() {
            let _ = write!(text, "{generation}");
            for value in row.iter().take(columns) {
                // The debug form is the shortest that reads back as the same number.
                let _ = write!(text, ",{value:?}");
            }
            text.push('\n');
        }
        text
    }

    fn plot(&self, diagnostics: &Diagnostics, title: &str) -> Result<String, String> {
        let mut column = 0;
        let charts = diagnostics.charts.iter().map(|chart| {
            let curves = chart.curves.iter().map(|(_, label)| {
                let color = column;
                column += 1;
                let value = |row: &Vec<f64>| row.get(color).copied().unwrap_or(f64::NAN);
                let values = self.rows.iter().map(value).collect();
                Curve { name: Some((*label).into()), color, values, band: Vec::new() }
            });
            let curves = curves.collect();
            Chart { title: format!("{title}: {}", chart.title), axis: chart.axis, curves, ..Chart::default() }
        });
        plot::stack(&charts.collect::<Vec<_>>())
    }
}
