//! The curves of a report: one run as it was, many as median and quartiles.

use std::path::Path;

use crate::error::Error;
use crate::figures::plot::{self, Chart, Curve};
use crate::figures::statistics::Quartiles;
use crate::report::page::Figure;
use crate::report::run::{Group, Run};

/// The figures of an experiment's runs.
pub(crate) fn figures(groups: &[Group<'_>]) -> Result<Vec<Figure>, Error> {
    let refused = |why: String| Error::damaged(Path::new("the figure of the fitness"), why);
    let figure = |picture: Result<String, String>, caption: String| {
        Ok(Figure { kind: "fitness", picture: picture.map_err(refused)?, caption })
    };
    if let [Group { runs, .. }] = groups
        && let [run] = runs.as_slice()
    {
        let charts = plot::charts(&run.plan.name(), &run.lines, &run.populations);
        let of_each = charts.iter().zip(run.populations()).map(|(chart, (_, name))| {
            let whose =
                if name.is_empty() { "every generation".into() } else { format!("the {name} of every generation") };
            let caption = format!("Best, mean and worst individual of {whose}; failed individuals are left out.");
            figure(chart.draw(), caption)
        });
        return of_each.collect();
    }
    let several = groups.iter().any(|group| group.runs.len() > 1);
    let lines = if several {
        "Thick: median of the runs, over the generations that all of them have; band: quartiles; thin: single runs."
    } else {
        "One run each."
    };
    let mut figures = Vec::new();
    for (population, name) in Group::populations(groups) {
        for (which, title) in [(0, "Best of the generation"), (1, "Mean of the generation")] {
            let title = if name.is_empty() { title.to_owned() } else { format!("{title}, {name}") };
            let chart = Chart { title: title.clone(), axis: "fitness", curves: curves(groups, population, which) };
            figures.push(figure(chart.draw(), format!("{title}. {lines}"))?);
        }
    }
    Ok(figures)
}

fn curves(groups: &[Group<'_>], population: Option<usize>, which: usize) -> Vec<Curve> {
    let mut curves = Vec::new();
    for (color, group) in groups.iter().enumerate() {
        let quartiles = (0..=group.common()).filter_map(|at| quartiles(group, population, at, which));
        let quartiles: Vec<Quartiles> = quartiles.collect();
        let several = group.runs.len() > 1;
        let label = &group.label;
        curves.push(Curve {
            name: Some(if several { format!("{label}, {} runs", group.runs.len()) } else { label.clone() }),
            color,
            values: quartiles.iter().map(|quartiles| quartiles.median).collect(),
            band: if several { quartiles.iter().map(|q| [q.lower, q.upper]).collect() } else { Vec::new() },
        });
        if several {
            let whole = |run: &Run<'_>| (0..run.lines.len()).map(|at| run.fitness(population, at, which)).collect();
            curves.extend(group.runs.iter().map(|run| Curve { color, values: whole(run), ..Curve::default() }));
        }
    }
    curves
}

/// Over the runs of a group that have a generation.
pub(crate) fn quartiles(
    group: &Group<'_>,
    population: Option<usize>,
    generation: usize,
    which: usize,
) -> Option<Quartiles> {
    Quartiles::from_values(&group.runs.iter().map(|run| run.fitness(population, generation, which)).collect::<Vec<_>>())
}
