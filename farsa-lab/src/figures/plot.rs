//! Curves over generations as SVG: `fitness.svg` of a run and the figures of a report.

use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use crate::figures::series::{Series, thinned};

/// Small, so that its letters can be read on a telephone too.
const WIDTH: i32 = 640;
pub(crate) const SIZE: (u32, u32) = (WIDTH as u32, 350);
/// Heights of the title and of a line of names below it.
const TITLE: i32 = 36;
const NAMES: i32 = 26;
pub(crate) const MARGIN: i32 = 18;
pub(crate) const FONT: (&str, u32) = ("sans-serif", 18);
/// About so many values are written at an axis upwards.
pub(crate) const LABELS: usize = 7;

/// Three colours that a page may exchange for its own: background, letters with axes, and grid.
pub(crate) const PAPER: &str = "#FFFFFF";
pub(crate) const INK: &str = "#222222";
pub(crate) const GRID: &str = "#E4E4E4";
pub(crate) const INK_COLOR: RGBColor = RGBColor(0x22, 0x22, 0x22);
pub(crate) const GRID_COLOR: RGBColor = RGBColor(0xE4, 0xE4, 0xE4);

/// Colours that the colour-blind tell apart, by Okabe and Ito, the most different first; the yellow is too pale.
const COLORS: [RGBColor; 6] = [
    RGBColor(0x00, 0x72, 0xB2),
    RGBColor(0xD5, 0x5E, 0x00),
    RGBColor(0x00, 0x9E, 0x73),
    RGBColor(0xCC, 0x79, 0xA7),
    RGBColor(0xE6, 0x9F, 0x00),
    RGBColor(0x56, 0xB4, 0xE9),
];

/// Larger values are drawn as this part of themselves, so that neither their range nor what plotters computes from it
/// overflows: it would look for places of labels for ever. A power of two changes no digit.
const LARGE: f64 = 1e300;
const PART_OF_LARGE: f64 = 1.0 / 65536.0;

/// Curves that share a pair of axes.
#[derive(Debug, Default)]
pub(crate) struct Chart {
    pub(crate) title: String,
    /// What is upwards.
    pub(crate) axis: &'static str,
    pub(crate) across: Across,
    pub(crate) curves: Vec<Curve>,
}

/// What lies along the lower axis.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) enum Across {
    #[default]
    Generations,
    /// So many from one value of a curve to the next.
    Evaluations(u64),
}

/// A value per generation, from generation 0; one that is not finite leaves a gap.
#[derive(Debug, Default)]
pub(crate) struct Curve {
    /// What the legend says; curves without a name are drawn thin and pale, below the others.
    pub(crate) name: Option<String>,
    pub(crate) color: usize,
    pub(crate) values: Series,
    /// Lower and upper end of a band around it, a pair per generation; may be empty.
    pub(crate) band: Vec<[f64; 2]>,
}

/// Draws charts one below the other.
///
/// # Errors
/// The backend's words, should it refuse.
pub(crate) fn stack(charts: &[Chart]) -> Result<String, String> {
    let mut svg = String::new();
    pictures(&mut svg, charts).map_err(|error| error.to_string())?;
    Ok(svg)
}

fn pictures<'s>(svg: &'s mut String, charts: &[Chart]) -> Result<(), Box<dyn std::error::Error + 's>> {
    let size = (SIZE.0, charts.iter().map(Chart::height).sum());
    let all = SVGBackend::with_string(svg, size).into_drawing_area();
    all.fill(&WHITE)?;
    let mut rest = all.clone();
    for chart in charts {
        let (area, below) = rest.split_vertically(chart.height());
        chart.picture(&area)?;
        rest = below;
    }
    all.present()?;
    Ok(())
}

impl Chart {
    /// The picture; text in it is text, so that no font is needed.
    ///
    /// # Errors
    /// The backend's words, should it refuse.
    pub(crate) fn draw(&self) -> Result<String, String> {
        stack(core::slice::from_ref(self))
    }

    /// Height of title and names.
    fn head(&self) -> u32 {
        let lines = self.places().last().map_or(0, |place| place.1 + 1);
        (TITLE + NAMES * lines + 8) as u32
    }

    fn height(&self) -> u32 {
        SIZE.1 + self.head()
    }

    fn picture<'s>(&self, area: &DrawingArea<SVGBackend<'s>, Shift>) -> Result<(), Box<dyn std::error::Error + 's>> {
        let (head, body) = area.split_vertically(self.head());
        self.legend(&head)?;
        let limits = self.limits();
        let Limits { low, high, part } = limits;
        let generations = self.curves.iter().map(|curve| curve.values.len()).max().unwrap_or(0);
        let mut chart = ChartBuilder::on(&body)
            .margin_left(8)
            .margin_right(18)
            .margin_bottom(8)
            .x_label_area_size(48)
            .y_label_area_size(limits.room())
            .build_cartesian_2d(0..generations.saturating_sub(1).max(1), low..high)?;
        chart
            .configure_mesh()
            .x_desc(match self.across {
                Across::Generations => "generation",
                Across::Evaluations(_) => "evaluations",
            })
            .x_label_formatter(&|x| match self.across {
                Across::Generations => x.to_string(),
                Across::Evaluations(step) => (step * *x as u64).to_string(),
            })
            .y_desc(self.axis)
            .x_labels(8)
            .y_labels(LABELS)
            .light_line_style(TRANSPARENT)
            .bold_line_style(GRID_COLOR)
            .axis_style(INK_COLOR)
            .y_label_formatter(&|y| label(y / part))
            .label_style(FONT.into_font().color(&INK_COLOR))
            .draw()?;
        let (named, nameless): (Vec<_>, Vec<_>) = self.curves.iter().partition(|curve| curve.name.is_some());
        // The first curve comes last, on top of the others.
        for curve in named.iter().rev() {
            let color = COLORS[curve.color % COLORS.len()];
            for run in parts(thinned(&curve.band), |pair: [f64; 2]| pair.iter().all(|x| x.is_finite())) {
                let there = run.iter().map(|&(x, [low, _])| (x, low * part));
                let back = run.iter().rev().map(|&(x, [_, high])| (x, high * part));
                chart.draw_series([Polygon::new(there.chain(back).collect::<Vec<_>>(), color.mix(0.22))])?;
            }
        }
        let thin = nameless.iter().map(|curve| (curve, COLORS[curve.color % COLORS.len()].mix(0.45).stroke_width(1)));
        let thick = named.iter().rev().map(|curve| (curve, COLORS[curve.color % COLORS.len()].stroke_width(2)));
        for (curve, style) in thin.chain(thick) {
            for run in parts(curve.values.points(), f64::is_finite) {
                let points: Vec<(usize, f64)> = run.into_iter().map(|(x, y)| (x, y * part)).collect();
                // A line of one point is not seen.
                let dot =
                    if points.len() == 1 { points.first().map(|&at| Circle::new(at, 3, style.filled())) } else { None };
                chart.draw_series(dot)?;
                chart.draw_series(LineSeries::new(points, style))?;
            }
        }
        Ok(())
    }

    /// Title and names in lines of their own, so that they never lie on a curve.
    fn legend<'s>(&self, area: &DrawingArea<SVGBackend<'s>, Shift>) -> Result<(), Box<dyn std::error::Error + 's>> {
        area.draw(&Text::new(self.title.clone(), (MARGIN, 12), ("sans-serif", 20).into_font().color(&INK_COLOR)))?;
        let named = self.curves.iter().filter_map(|curve| Some((curve.name.as_ref()?, curve.color)));
        for ((name, color), (x, line)) in named.zip(self.places()) {
            let y = TITLE + NAMES * line + 14;
            let stroke = COLORS[color % COLORS.len()].stroke_width(3);
            area.draw(&PathElement::new([(x, y), (x + 22, y)], stroke))?;
            area.draw(&Text::new(name.clone(), (x + 28, y - 9), FONT.into_font().color(&INK_COLOR)))?;
        }
        Ok(())
    }

    /// Where the names stand: from the left [pixels], and in which line.
    fn places(&self) -> Vec<(i32, i32)> {
        let (mut x, mut line) = (MARGIN, 0);
        let mut places = Vec::new();
        for name in self.curves.iter().filter_map(|curve| curve.name.as_ref()) {
            // Without a font the width of a text is a guess: a little more than half its height a letter.
            let width = name.chars().fold(28 + 20, |width: i32, _| width.saturating_add(9));
            if x > MARGIN && x.saturating_add(width) > WIDTH {
                (x, line) = (MARGIN, line + 1);
            }
            places.push((x, line));
            x = x.saturating_add(width);
        }
        places
    }

    fn limits(&self) -> Limits {
        let band = |curve: &Curve| curve.band.iter().flatten().copied().collect::<Series>().ends();
        Limits::of(self.curves.iter().flat_map(|curve| [curve.values.ends(), band(curve)]).flatten())
    }
}

/// The ends of an axis, in a part of the values.
pub(crate) struct Limits {
    pub(crate) low: f64,
    pub(crate) high: f64,
    pub(crate) part: f64,
}

impl Limits {
    /// Of an axis that has room for all finite values.
    pub(crate) fn of(values: impl Iterator<Item = f64>) -> Self {
        let ends = |(low, high): (f64, f64), x: f64| (low.min(x), high.max(x));
        let (mut low, mut high) = values.filter(|x| x.is_finite()).fold((f64::INFINITY, f64::NEG_INFINITY), ends);
        if low > high {
            (low, high) = (0.0, 1.0);
        }
        let part = if low.abs().max(high.abs()) > LARGE { PART_OF_LARGE } else { 1.0 };
        (low, high) = (low * part, high * part);
        // A flat curve needs an axis too.
        let margin = (0.05 * (high - low)).max(1e-9 * high.abs()).max(f64::MIN_POSITIVE.sqrt());
        // A label beyond could not be written.
        let most = f64::MAX * part;
        Self { low: (low - margin).max(-most), high: (high + margin).min(most), part }
    }

    /// Room for the labels of an axis upwards and its name [pixels]: a label of more than five letters needs more.
    pub(crate) fn room(&self) -> u32 {
        let places = RangedCoordf64::from(self.low..self.high).key_points(LABELS);
        let longest = places.into_iter().map(|y| label(y / self.part).len()).max().unwrap_or(0);
        74 + 9 * longest.saturating_sub(5).min(15) as u32
    }
}

/// A value at the axis: six digits after the point, and no more digits than a value has.
pub(crate) fn label(y: f64) -> String {
    if y.abs() < 1e15 { ((y * 1e6).round() / 1e6 + 0.0).to_string() } else { format!("{y:e}") }
}

/// Points with their places, divided where one cannot be drawn.
fn parts<T: Copy>(points: impl Iterator<Item = (usize, T)>, drawable: impl Fn(T) -> bool) -> Vec<Vec<(usize, T)>> {
    let points: Vec<(usize, T)> = points.collect();
    points.split(|(_, value)| !drawable(*value)).filter(|part| !part.is_empty()).map(<[_]>::to_vec).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::series::MOST_POINTS;
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
        // However large, a value is at the height where it belongs.
        let curve = |scale: f64| {
            let svg = drawn(&[-1e308 * scale, 0.5e308 * scale, 1e308 * scale]);
            let line = svg.lines().find(|line| line.contains("<polyline") && line.contains("stroke-width=\"2\""));
            let points = line.unwrap().split_once("points=\"").unwrap().1;
            points.split([' ', ',']).skip(1).step_by(2).map(str::to_owned).collect::<Vec<_>>()
        };
        assert_eq!(curve(1.0), curve(1e-308));
        assert_eq!(
            [0.1 + 0.2, -1e-9, 999_999_999.5, 2e15, 1.7e308].map(label),
            ["0.3", "0", "999999999.5", "2e15", "1.7e308"]
        );
    }

    /// A chart of these values, also as a band, beside a chart of others; it must have limits, and be finite.
    fn drawn(values: &[f64]) -> String {
        let curve = |values: &[f64], band: &[f64]| Curve {
            name: Some("c".into()),
            values: values.iter().copied().collect(),
            band: band.windows(2).map(|pair| [pair[0], pair[1]]).collect(),
            ..Curve::default()
        };
        let curves = || vec![curve(values, values), curve(&[1.0, f64::NAN, 2.0], &[])];
        let charts = [(vec![curve(values, &[])]), curves()].map(|curves| Chart { curves, ..Chart::default() });
        for chart in &charts {
            let Limits { low, high, .. } = chart.limits();
            // Otherwise plotters would not end.
            assert!((high - low).is_finite() && high > low, "{values:?}: {low:e} to {high:e}");
        }
        let svg = stack(&charts).unwrap();
        assert!(svg.ends_with("</svg>\n") && svg.len() < 30_000, "{values:?}: {}", svg.len());
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{values:?}: {svg}");
        svg
    }

    proptest! {
        #[test]
        fn no_values_keep_it_from_ending(
            values in prop::collection::vec(prop_oneof![any::<f64>(), (-1.0..1.0).prop_map(|x| x * f64::MAX)], 1..5),
        ) {
            drawn(&values);
        }
    }

    #[test]
    fn gaps_divide_and_many_points_are_thinned_out() {
        let found = parts([1.0, f64::NAN, 3.0, 4.0].into_iter().enumerate(), f64::is_finite);
        assert_eq!(found, vec![vec![(0, 1.0)], vec![(2, 3.0), (3, 4.0)]]);
        let long: Series = (0..10 * MOST_POINTS + 3).map(|_| 0.0).collect();
        let found = parts(long.points(), f64::is_finite).concat();
        assert!(found.len() <= MOST_POINTS + 1 && found.last().is_some_and(|point| point.0 == 10 * MOST_POINTS + 2));
    }

    #[test]
    fn long_labels_do_not_reach_the_name_of_their_axis() {
        let edge = |values: [f64; 2]| {
            let curve = Curve { name: Some("c".into()), values: values.into_iter().collect(), ..Curve::default() };
            let svg = Chart { axis: "fitness", curves: vec![curve], ..Chart::default() }.draw().unwrap();
            // Where labels end, and how long the longest is.
            let labels = svg.split("<text ").filter(|text| text.contains("text-anchor=\"end\""));
            let of_one = |text: &str| {
                let x = text.split_once("x=\"")?.1.split_once('"')?.0.parse::<i32>().ok()?;
                Some((x, i32::try_from(text.split_once(">\n")?.1.split_once('\n')?.0.len()).ok()?))
            };
            let found: Vec<(i32, i32)> = labels.filter_map(of_one).collect();
            assert!(found.len() >= 3, "{svg}");
            found.into_iter().fold((i32::MAX, 0), |(x, longest), (end, length)| (x.min(end), longest.max(length)))
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
        let svg = Chart { title: "t".into(), axis: "fitness", curves: vec![curve], ..Chart::default() }.draw().unwrap();
        assert!(svg.contains("<polygon") && svg.contains("&lt;labels&gt; &amp; co"), "{svg}");
    }
}
