//! Curves of a report: those of a single run, or the median and quartiles of several.

use crate::figures::chart::{Across, Chart, Curve};
use crate::figures::log_curves::LogCurves;
use crate::figures::statistics::Quartiles;
use crate::report::moment::{Moment, generation_at, length};
use crate::report::page::Figure;
use crate::report::run::{Group, Run, whose};

/// Returns the fitness figures of an experiment's runs.
pub(crate) fn figures(groups: &[Group<'_>]) -> Vec<Figure> {
    let figure = |picture: String, caption: String| Figure { kind: "fitness", picture, caption };
    if let [Group { runs, .. }] = groups
        && let [run] = runs.as_slice()
    {
        let curves = LogCurves::from_lines(&run.lines, run.populations.len());
        let charts = curves.charts(&run.plan.name(), &run.populations);
        let figures = charts.iter().zip(run.populations()).map(|(chart, (_, name))| {
            let whose =
                if name.is_empty() { "every generation".into() } else { format!("the {name} of every generation") };
            let caption = format!("Best, mean and worst individual of {whose}; failed individuals are left out.");
            figure(chart.draw(), caption)
        });
        return figures.collect();
    }
    let several = groups.iter().any(|group| group.runs.len() > 1);
    let across = Moment::common(groups).axis(groups);
    let reach = match across {
        Across::Generations => "the generations that all of them have",
        Across::Evaluations(_) => "as many evaluations as all of them have",
    };
    let lines = if several {
        format!("Thick: median of the runs, over {reach}; band: quartiles; thin: single runs.")
    } else {
        "One run each.".to_owned()
    };
    let mut figures = Vec::new();
    for (population, name) in Group::populations(groups) {
        for (which, title) in [(0, "Best of the generation"), (1, "Mean of the generation")] {
            let title = whose(title, &name);
            let curves = curves(groups, across, &|run, generation| run.fitness(population, generation, which));
            let chart = Chart { title: title.clone(), axis: "fitness", across, curves };
            let so_far = if which == 0 { Group::best_so_far(groups) } else { String::new() };
            figures.push(figure(chart.draw(), format!("{title}.{so_far} {lines}")));
        }
    }
    figures
}

/// Returns curves of a value of each generation. A group of several runs has a median, a band and pale single curves.
pub(crate) fn curves(groups: &[Group<'_>], across: Across, value: &dyn Fn(&Run<'_>, usize) -> f64) -> Vec<Curve> {
    let at = |run: &Run<'_>, place: usize| {
        generation_at(run, across, place).map_or(f64::NAN, |generation| value(run, generation))
    };
    let mut curves = Vec::new();
    for (color, group) in groups.iter().enumerate() {
        let common = group.runs.iter().map(|run| length(run, across)).min().unwrap_or(0);
        let quartiles = |place: usize| {
            let values: Vec<f64> = group.runs.iter().map(|run| at(run, place)).collect();
            // Without a value of every run there is no median.
            let complete = !values.iter().any(|x| x.is_nan());
            let gap = Quartiles { lower: f64::NAN, median: f64::NAN, upper: f64::NAN };
            Quartiles::from_values(&values).filter(|_| complete).unwrap_or(gap)
        };
        let quartiles: Vec<Quartiles> = (0..=common).map(quartiles).collect();
        let several = group.runs.len() > 1;
        let label = &group.label;
        curves.push(Curve {
            name: Some(if several { format!("{label}, {} runs", group.runs.len()) } else { label.clone() }),
            color,
            values: quartiles.iter().map(|quartiles| quartiles.median).collect(),
            band: if several { quartiles.iter().map(|q| [q.lower, q.upper]).collect() } else { Vec::new() },
        });
        if several {
            let values = |run: &Run<'_>| (0..=length(run, across)).map(|place| at(run, place)).collect();
            curves.extend(group.runs.iter().map(|run| Curve { color, values: values(run), ..Curve::default() }));
        }
    }
    curves
}
