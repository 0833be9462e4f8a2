//! Diagnostics of a strategy for each generation, as a table and a picture.

use std::fmt::Write as _;
use std::path::PathBuf;

use crate::error::Error;
use crate::figures::chart::{self, Chart, Curve};
use crate::figures::series::Series;
use crate::store::append_log::AppendLog;
use crate::store::directory::Directory;
use crate::store::replace::replace;
use crate::strategy::any_strategy::AnyStrategy;
use crate::strategy::definition::Diagnostics;

/// Table of diagnostics, which grows, and its curves.
pub(crate) struct DiagnosticsTable(Option<Table>);

struct Table {
    diagnostics: Diagnostics,
    file: AppendLog,
    picture: PathBuf,
    generations: usize,
    /// A curve for each column.
    curves: Vec<Series>,
}

impl DiagnosticsTable {
    /// Writes the table of a resumed run from its rows, for a strategy with diagnostics.
    pub(crate) fn resume(
        diagnostics: Option<Diagnostics>,
        directory: &Directory,
        rows: &[Vec<f64>],
    ) -> Result<Self, Error> {
        let Some(diagnostics) = diagnostics else { return Ok(Self(None)) };
        let [table, picture] = directory.diagnostics(diagnostics.file);
        let mut text = String::from("generation");
        let columns = diagnostics.charts.iter().flat_map(|chart| chart.curves);
        let mut curves = Vec::new();
        for (column, _) in columns {
            text = text + "," + column;
            curves.push(Series::default());
        }
        text.push('\n');
        for (generation, row) in rows.iter().enumerate() {
            text.push_str(&line(generation, row, &mut curves));
        }
        let file = AppendLog::new(&table, text.as_bytes())?;
        Ok(Self(Some(Table { diagnostics, file, picture, generations: rows.len(), curves })))
    }

    /// Appends the diagnostics of the last generation.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub(crate) fn append(&mut self, strategy: &AnyStrategy) -> Result<(), Error> {
        let Some(table) = &mut self.0 else { return Ok(()) };
        let line = line(table.generations, &strategy.diagnostics(), &mut table.curves);
        table.generations += 1;
        table.file.append(line.as_bytes())
    }

    /// Synchronizes the table with the disk and draws its curves.
    ///
    /// # Errors
    /// [`Error::Io`], and [`Error::File`] when another program has removed, replaced or changed the table.
    pub(crate) fn save(&mut self, title: &str) -> Result<(), Error> {
        let Some(table) = &mut self.0 else { return Ok(()) };
        table.file.check()?;
        table.file.sync()?;
        replace(&table.picture, table.plot(title).as_bytes())
    }
}

/// Formats the line of a generation and adds its numbers to the curves.
fn line(generation: usize, row: &[f64], curves: &mut [Series]) -> String {
    let mut text = generation.to_string();
    for (column, curve) in curves.iter_mut().enumerate() {
        curve.push(row.get(column).copied().unwrap_or(f64::NAN));
        if let Some(value) = row.get(column) {
            // The debug form is the shortest that reads back as the same number. Writing into a string cannot fail.
            let _ = write!(text, ",{value:?}");
        }
    }
    text + "\n"
}

impl Table {
    fn plot(&self, title: &str) -> String {
        let mut curves = self.curves.iter().enumerate();
        let charts = self.diagnostics.charts.iter().map(|chart| {
            let named = chart.curves.iter().zip(&mut curves);
            let curves = named.map(|((_, label), (color, values))| Curve {
                name: Some((*label).into()),
                color,
                values: values.clone(),
                band: Vec::new(),
            });
            let curves = curves.collect();
            Chart { title: format!("{title}: {}", chart.title), axis: chart.axis, curves, ..Chart::default() }
        });
        chart::stack(&charts.collect::<Vec<_>>())
    }
}
