//! Curves over generations: `fitness.svg` of a run and the figures of a report.

use maud::{Markup, html};

use crate::figures::plane::{FOOT, LABELS, Limits, Plane};
use crate::figures::series::{Series, thinned};
use crate::figures::svg::{COLORS, WIDTH, at, figure, legend, title};

/// Height of the plane.
const HEIGHT: f64 = 290.0;

/// Curves that share a pair of axes.
#[derive(Debug, Default)]
pub(crate) struct Chart {
    pub(crate) title: String,
    /// Name of the vertical axis.
    pub(crate) axis: &'static str,
    pub(crate) across: Across,
    pub(crate) curves: Vec<Curve>,
}

/// Quantity of the lower axis.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) enum Across {
    #[default]
    Generations,
    /// Evaluations, with their number from one value of a curve to the next.
    Evaluations(u64),
}

/// A value per generation, from generation 0. Values that are not finite leave a gap.
#[derive(Debug, Default)]
pub(crate) struct Curve {
    /// Name in the legend. Curves without a name are thin and pale, below the others.
    pub(crate) name: Option<String>,
    pub(crate) color: usize,
    pub(crate) values: Series,
    /// Lower and upper end of a band per generation, or nothing.
    pub(crate) band: Vec<[f64; 2]>,
}

impl Curve {
    fn color(&self) -> &'static str {
        COLORS[self.color % COLORS.len()]
    }

    fn draw_band(&self, plane: &Plane) -> Markup {
        let runs = parts(thinned(&self.band), |pair: [f64; 2]| pair.iter().all(|x| x.is_finite()));
        html! {
            @for run in runs {
                @let lower = run.iter().map(|&(x, [low, _])| [x as f64, low]);
                @let upper = run.iter().rev().map(|&(x, [_, high])| [x as f64, high]);
                @let points = [corners(lower), corners(upper)].concat();
                polygon points=(plane.points(points)) fill=(self.color()) fill-opacity="0.22" {}
            }
        }
    }

    fn draw(&self, plane: &Plane) -> Markup {
        let (width, opacity) = if self.name.is_some() { ("2", "1") } else { ("1", "0.45") };
        html! {
            @for run in parts(self.values.points(), f64::is_finite) {
                @let points = corners(run.iter().map(|&(x, y)| [x as f64, y]));
                @if let [(x, y)] = run.as_slice() {
                    @let [x, y] = plane.place([*x as f64, *y]);
                    circle cx=(at(x)) cy=(at(y)) r="3" fill=(self.color()) fill-opacity=(opacity) {}
                }
                polyline points=(plane.points(points)) fill="none" stroke=(self.color()) stroke-width=(width)
                    stroke-opacity=(opacity) {}
            }
        }
    }
}

/// Draws charts one below the other.
pub(crate) fn stack(charts: &[Chart]) -> String {
    let mut height = 0.0;
    let mut pictures = Vec::new();
    for chart in charts {
        let (content, bottom) = chart.content();
        pictures.push(html! { g transform=(format!("translate(0 {})", at(height))) { (content) } });
        height += bottom;
    }
    figure([WIDTH, height], &html! { @for picture in pictures { (picture) } })
}

impl Chart {
    /// Draws the chart alone.
    pub(crate) fn draw(&self) -> String {
        stack(core::slice::from_ref(self))
    }

    /// Returns the content of the chart and its height.
    fn content(&self) -> (Markup, f64) {
        let (named, nameless): (Vec<_>, Vec<_>) = self.curves.iter().partition(|curve| curve.name.is_some());
        let names: Vec<(&str, &str)> =
            named.iter().filter_map(|curve| Some((curve.name.as_deref()?, curve.color()))).collect();
        let (legend, top) = legend(&names);
        let generations = self.curves.iter().map(|curve| curve.values.len()).max().unwrap_or(0);
        let across = Limits::exact([0.0, generations.saturating_sub(1).max(1) as f64]);
        let (labels, name) = self.lower_axis(across);
        let up = self.limits();
        let values = up.labels(LABELS);
        let plane = Plane::new(top, HEIGHT, across, up, &values);
        let content = html! {
            (title(&self.title)) (legend)
            (plane.axes([&labels, &values], [name, self.axis]))
            // The first curve is on top of the others.
            @for curve in named.iter().rev() { (curve.draw_band(&plane)) }
            @for curve in &nameless { (curve.draw(&plane)) }
            @for curve in named.iter().rev() { (curve.draw(&plane)) }
        };
        (content, plane.bottom + FOOT)
    }

    /// Returns the labels and the name of the lower axis.
    fn lower_axis(&self, across: Limits) -> (Vec<(f64, String)>, &'static str) {
        let (step, name) = match self.across {
            Across::Generations => (1, "generation"),
            Across::Evaluations(step) => (step, "evaluations"),
        };
        let ticks = across.ticks(8).into_iter().filter(|tick| tick.fract() == 0.0);
        (ticks.map(|tick| (tick, (step * tick as u64).to_string())).collect(), name)
    }

    fn limits(&self) -> Limits {
        let band = |curve: &Curve| curve.band.iter().flatten().copied().collect::<Series>().ends();
        Limits::of(self.curves.iter().flat_map(|curve| [curve.values.ends(), band(curve)]).flatten())
    }
}

/// Splits numbered values where one cannot be drawn.
fn parts<T: Copy>(points: impl Iterator<Item = (usize, T)>, drawable: impl Fn(T) -> bool) -> Vec<Vec<(usize, T)>> {
    let points: Vec<(usize, T)> = points.collect();
    points.split(|(_, value)| !drawable(*value)).filter(|part| !part.is_empty()).map(<[_]>::to_vec).collect()
}

/// Returns a line without the points between two others of equal height.
fn corners(points: impl Iterator<Item = [f64; 2]>) -> Vec<[f64; 2]> {
    let mut line: Vec<[f64; 2]> = Vec::new();
    for point in points {
        let level = |[_, y]: &[f64; 2]| y.to_bits() == point[1].to_bits();
        if matches!(line.as_slice(), [.., a, b] if level(a) && level(b)) {
            line.pop();
        }
        line.push(point);
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::plane::number;
    use crate::figures::series::MAX_POINTS;
    use proptest::prelude::*;

    #[test]
    fn values_of_any_size_can_be_drawn() {
        let neighbours = |x: f64| [x, f64::from_bits(x.to_bits() + 1)];
        for values in [
            [1.7e308, -1.7e308],
            [f64::MAX, f64::MIN],
            [f64::MAX; 2],
            [f64::MIN; 2],
            [1.7e308, 0.0],
            [1e300, -1e300],
            [5e-324, 0.0],
            [5e-324; 2],
            [-5e-324, f64::MIN_POSITIVE],
            [1e300, 5e-324],
            neighbours(1.0),
            neighbours(-1e300),
            neighbours(1.7e308),
            neighbours(5e-324),
            neighbours(4.5e15),
            [1.7e308, f64::INFINITY],
            [f64::NEG_INFINITY, f64::INFINITY],
            [f64::NAN, -1.7e308],
        ] {
            drawn(&values);
        }
        // Large values are drawn at the same heights as small ones.
        let curve = |scale: f64| {
            let svg = drawn(&[-1e308 * scale, 0.5e308 * scale, 1e308 * scale]);
            let line = svg.split("<polyline ").find(|line| line.contains("stroke-width=\"2\"")).unwrap();
            line.split('"').nth(1).unwrap().split([' ', ',']).skip(1).step_by(2).map(str::to_owned).collect::<Vec<_>>()
        };
        assert_eq!(curve(1.0), curve(1e-308));
        assert_eq!(
            [0.1 + 0.2, -1e-9, 999_999_999.5, 2e15, 1.7e308].map(number),
            ["0.3", "-1e-9", "999999999.5", "2e15", "1.7e308"]
        );
    }

    /// Draws a chart of these values, also as a band, and checks that the file is finite.
    fn drawn(values: &[f64]) -> String {
        let curve = |values: &[f64], band: &[f64]| Curve {
            name: Some("c".into()),
            values: values.iter().copied().collect(),
            band: band.windows(2).map(|pair| [pair[0], pair[1]]).collect(),
            ..Curve::default()
        };
        let curves = || vec![curve(values, values), curve(&[1.0, f64::NAN, 2.0], &[])];
        let charts = [(vec![curve(values, &[])]), curves()].map(|curves| Chart { curves, ..Chart::default() });
        let svg = stack(&charts);
        assert!(svg.ends_with("</svg>\n") && svg.len() < 30_000, "{values:?}: {}", svg.len());
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{values:?}: {svg}");
        svg
    }

    proptest! {
        #[test]
        fn any_values_can_be_drawn(
            values in prop::collection::vec(prop_oneof![any::<f64>(), (-1.0..1.0).prop_map(|x| x * f64::MAX)], 1..5),
        ) {
            drawn(&values);
        }
    }

    #[test]
    fn gaps_divide_curves_and_many_points_are_thinned() {
        let runs = parts([1.0, f64::NAN, 3.0, 4.0].into_iter().enumerate(), f64::is_finite);
        assert_eq!(runs, vec![vec![(0, 1.0)], vec![(2, 3.0), (3, 4.0)]]);
        let long: Series = (0..10 * MAX_POINTS + 3).map(|_| 0.0).collect();
        let runs = parts(long.points(), f64::is_finite).concat();
        assert!(runs.len() <= MAX_POINTS + 1 && runs.last().is_some_and(|point| point.0 == 10 * MAX_POINTS + 2));
    }

    #[test]
    fn level_stretches_have_two_points() {
        let line = |heights: &[f64]| corners(heights.iter().enumerate().map(|(x, y)| [x as f64, *y]));
        assert_eq!(line(&[1.0; 5]), [[0.0, 1.0], [4.0, 1.0]]);
        assert_eq!(line(&[1.0, 1.0, 2.0, 2.0, 2.0, 1.0]), [[0.0, 1.0], [1.0, 1.0], [2.0, 2.0], [4.0, 2.0], [5.0, 1.0]]);
        assert!(line(&[]).is_empty());
    }

    #[test]
    fn long_labels_do_not_reach_the_name_of_their_axis() {
        let edge = |values: [f64; 2]| {
            let curve = Curve { name: Some("c".into()), values: values.into_iter().collect(), ..Curve::default() };
            let svg = Chart { axis: "fitness", curves: vec![curve], ..Chart::default() }.draw();
            // The right end of the labels, and the letters of the longest.
            let labels = svg.split("<text ").filter(|text| text.contains("text-anchor=\"end\""));
            let label = |text: &str| {
                let x = text.split_once("x=\"")?.1.split_once('"')?.0.parse::<i32>().ok()?;
                Some((x, i32::try_from(text.split_once('>')?.1.split_once('<')?.0.len()).ok()?))
            };
            let labels: Vec<(i32, i32)> = labels.filter_map(label).collect();
            assert!(labels.len() >= 3, "{svg}");
            labels.into_iter().fold((i32::MAX, 0), |(x, longest), (end, length)| (x.min(end), longest.max(length)))
        };
        let (short, letters) = edge([0.0, 2.0]);
        assert!(letters <= 5, "{letters}");
        for values in [[0.000_031, 0.000_046], [-1e6, 123_456.5], [1e12, 1.000_001e12]] {
            let (end, letters) = edge(values);
            assert!(letters > 5 && end == short + 9 * (letters - 5), "{values:?}: {letters} letters end at {end}");
        }
    }

    #[test]
    fn a_band_lies_around_its_curve() {
        let curve = Curve {
            name: Some("<labels> & co".into()),
            values: [1.0, 2.0, f64::NEG_INFINITY].into_iter().collect(),
            band: vec![[0.5, 1.5], [1.0, 3.0], [f64::NEG_INFINITY; 2]],
            ..Curve::default()
        };
        let svg = Chart { title: "t".into(), axis: "fitness", curves: vec![curve], ..Chart::default() }.draw();
        assert!(svg.contains("<polygon") && svg.contains("&lt;labels&gt; &amp; co"), "{svg}");
    }
}
