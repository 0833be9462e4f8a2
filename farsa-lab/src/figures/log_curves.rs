//! Curves of a run's log: `fitness.svg` and the figure of a report on a single run.

use crate::figures::chart::{self, Chart, Curve};
use crate::figures::series::Series;
use crate::store::log::{Line, Row};

/// Best, mean and worst fitness per generation of each population of a run.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LogCurves(Vec<[Series; 3]>);

impl LogCurves {
    /// Creates curves without a generation.
    pub(crate) fn new(populations: usize) -> Self {
        Self(vec![<[Series; 3]>::default(); populations.max(1)])
    }

    /// Builds the curves of the given generations.
    pub(crate) fn from_lines(lines: &[Line], populations: usize) -> Self {
        let mut curves = Self::new(populations);
        for line in lines {
            curves.push(line);
        }
        curves
    }

    /// Adds a generation.
    pub(crate) fn push(&mut self, line: &Line) {
        let several = self.0.len() > 1;
        for (population, curves) in self.0.iter_mut().enumerate() {
            let population_row = || line.each.get(population).copied().unwrap_or([f64::NAN; 3]);
            let row: Row = if several { population_row() } else { line.row };
            curves.iter_mut().zip(row).for_each(|(curve, value)| curve.push(value));
        }
    }

    /// Returns a chart per population.
    pub(crate) fn charts(&self, title: &str, populations: &[String]) -> Vec<Chart> {
        let chart = |title: String, series: &[Series; 3]| {
            let curve = |(color, (name, values)): (usize, (&str, &Series))| Curve {
                name: Some(name.into()),
                color,
                values: values.clone(),
                band: Vec::new(),
            };
            let curves = ["best", "mean", "worst"].into_iter().zip(series).enumerate().map(curve).collect();
            Chart { title, axis: "fitness", curves, ..Chart::default() }
        };
        match self.0.as_slice() {
            [single] => vec![chart(title.into(), single)],
            several => {
                let named = populations.iter().zip(several);
                named.map(|(name, series)| chart(format!("{title}: {name}"), series)).collect()
            }
        }
    }

    /// Draws the charts one below the other.
    pub(crate) fn draw(&self, title: &str, populations: &[String]) -> String {
        chart::stack(&self.charts(title, populations))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::svg::{GRID, INK, PAPER};

    fn line(row: Row, each: &[Row]) -> Line {
        Line { row, each: each.into(), evaluations: 20, failed: 0 }
    }

    #[test]
    fn every_log_can_be_drawn() {
        let failed = [f64::NEG_INFINITY; 3];
        for rows in [
            vec![],
            vec![[1.0, 0.5, 0.0]],
            vec![[0.0; 3]; 3],
            vec![[1e9; 3]; 3],
            vec![failed, failed],
            vec![[3.0, 2.0, 1.0], failed, [4.0, 3.0, 2.0]],
        ] {
            let lines: Vec<Line> = rows.iter().map(|row| line(*row, &[])).collect();
            let svg = LogCurves::from_lines(&lines, 1).draw("a title", &["0".into()]);
            for label in ["a title", "generation", "fitness", "best", "mean", "worst", "</svg>", PAPER, INK, GRID] {
                assert!(svg.contains(label), "{rows:?}: no {label}");
            }
            assert!(!svg.contains("NaN") && !svg.contains("inf"), "{rows:?}");
        }
    }

    #[test]
    fn each_population_has_a_chart() {
        let lines = [line([9.0, 1.0, 0.0], &[[1.0, 0.5, 0.0], [9.0, 8.0, 7.0]]), line([8.0; 3], &[[2.0; 3], [8.0; 3]])];
        let names = ["fox", "hare"].map(String::from);
        let charts = LogCurves::from_lines(&lines, 2).charts("run", &names);
        let content = |chart: &Chart| {
            let values = |curve: &Curve| curve.values.points().map(|point| point.1).collect::<Vec<_>>();
            (chart.title.clone(), chart.curves.iter().map(values).collect::<Vec<_>>())
        };
        assert_eq!(content(&charts[0]), ("run: fox".into(), vec![vec![1.0, 2.0], vec![0.5, 2.0], vec![0.0, 2.0]]));
        assert_eq!(content(&charts[1]), ("run: hare".into(), vec![vec![9.0, 8.0], vec![8.0, 8.0], vec![7.0, 8.0]]));
        let both = LogCurves::from_lines(&lines, 2).draw("run", &names);
        for title in ["run: fox", "run: hare"] {
            assert_eq!(both.matches(title).count(), 1, "{both}");
        }
        let single = LogCurves::from_lines(&lines, 1).draw("run", &names[..1]);
        let height =
            |svg: &str| svg.split("height=\"").nth(1).unwrap().split('"').next().unwrap().parse::<f64>().unwrap();
        assert_eq!(height(&both), 2.0 * height(&single));
        assert!(single.contains(">run<") && both.matches("generation").count() == 2, "{single}");
    }
}
