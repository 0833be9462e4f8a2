//! The curves of a report: one run as it was, many as median and quartiles.

use std::path::Path;

use crate::error::Error;
use crate::plot::{self, Chart, Curve};
use crate::report_page::Figure;
use crate::report_run::{Group, Run};
use crate::statistics::Quartiles;

/// The figures of an experiment's runs.
pub(crate) fn figures(groups: &[Group<'_>]) -> Result<Vec<Figure>, Error> {
    let refused = |why: String| Error::damaged(Path::new("the figure of the fitness"), why);
    let figure = |picture: Result<String, String>, caption: String| {
        Ok(Figure { kind: "fitness", picture: picture.map_err(refused)?, caption })
    };
    if let [Group { runs, .. }] = groups
        && let [run] = runs.as_slice()
    {
        let rows: Vec<_> = run.lines.iter().map(|line| line.row).collect();
        let caption = "Best, mean and worst individual of every generation; failed lives are left out.";
        return Ok(vec![figure(plot::draw(&run.plan.name(), &rows), caption.into())?]);
    }
    let several = groups.iter().any(|group| group.runs.len() > 1);
    let lines = if several {
        "Thick: median of the runs, over the generations that all of them have; band: quartiles; thin: single runs."
    } else {
        "One run each."
    };
    let mut figures = Vec::new();
    for (which, title) in [(0, "Best of the generation"), (1, "Mean of the generation")] {
        let chart = Chart { title: title.into(), curves: curves(groups, which) };
        figures.push(figure(chart.draw(), format!("{title}. {lines}"))?);
    }
    Ok(figures)
}

fn curves(groups: &[Group<'_>], which: usize) -> Vec<Curve> {
    let mut curves = Vec::new();
    for (color, group) in groups.iter().enumerate() {
        let quartiles: Vec<Quartiles> = (0..=group.common()).filter_map(|at| quartiles(group, at, which)).collect();
        let several = group.runs.len() > 1;
        let label = &group.label;
        curves.push(Curve {
            name: Some(if several { format!("{label}, {} runs", group.runs.len()) } else { label.clone() }),
            color,
            values: quartiles.iter().map(|quartiles| quartiles.median).collect(),
            band: if several { quartiles.iter().map(|q| [q.lower, q.upper]).collect() } else { Vec::new() },
        });
        if several {
            curves.extend(group.runs.iter().map(|run| Curve { color, values: whole(run, which), ..Curve::default() }));
        }
    }
    curves
}

/// Over the runs of a group that have a generation.
pub(crate) fn quartiles(group: &Group<'_>, generation: usize, which: usize) -> Option<Quartiles> {
    Quartiles::of(&group.runs.iter().map(|run| run.fitness(generation, which)).collect::<Vec<_>>())
}

fn whole(run: &Run<'_>, which: usize) -> Vec<f64> {
    run.lines.iter().map(|line| line.row[which]).collect()
}
