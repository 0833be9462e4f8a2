//! Shares over a number, as curves with their intervals: a test protocol whose rows are times or sizes.

use maud::{Markup, html};

use crate::figures::plane::{FOOT, Limits, Plane};
use crate::figures::svg::{COLORS, HEAD, WIDTH, at, figure, legend, percent, title};

/// Height of the plane.
const HEIGHT: f64 = 260.0;
/// Least number of values, and the largest number of curves that remain distinct.
const MIN_VALUES: usize = 3;
const MAX_CURVES: usize = 4;

/// Shares over a number.
#[derive(Debug, Default)]
pub(crate) struct Rates<'a> {
    pub(crate) title: &'a str,
    /// Name of the number.
    pub(crate) axis: &'a str,
    /// Labels of the values, each a number with the same unit.
    pub(crate) labels: &'a [&'a str],
    pub(crate) curves: &'a [RateCurve<'a>],
}

/// A curve.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct RateCurve<'a> {
    pub(crate) name: &'a str,
    /// A share for each value, from 0 to 1, with the ends of its interval.
    pub(crate) shares: Vec<(f64, [f64; 2])>,
}

impl RateCurve<'_> {
    /// Computes the value at which the share first falls to half of its first value, by interpolation over missing shares.
    pub(crate) fn half(&self, values: &[f64]) -> Option<f64> {
        let points = values.iter().zip(&self.shares).map(|(x, (share, _))| [*x, *share]);
        let points: Vec<[f64; 2]> = points.filter(|[_, share]| share.is_finite()).collect();
        let half = 0.5 * points.first()?[1];
        let falls = points.windows(2).find(|pair| pair[0][1] > half && pair[1][1] <= half)?;
        let [[x, above], [next, below]] = [falls[0], falls[1]];
        Some(x + (next - x) * (above - half) / (above - below))
    }
}

/// Finds the rising numbers at the start of labels and their common unit.
pub(crate) fn values<'l>(labels: &[&'l str]) -> Option<(Vec<f64>, &'l str)> {
    let split = |label: &'l str| -> Option<(f64, &'l str)> {
        let (number, unit) = label.split_once(' ').unwrap_or((label, ""));
        Some((number.parse().ok().filter(|x: &f64| x.is_finite())?, unit))
    };
    let numbers: Vec<(f64, &str)> = labels.iter().map(|label| split(label)).collect::<Option<_>>()?;
    let (_, unit) = *numbers.first()?;
    let rises = numbers.windows(2).all(|pair| pair[0].0 < pair[1].0 && pair[1].1 == unit);
    rises.then(|| (numbers.into_iter().map(|(x, _)| x).collect(), unit))
}

impl Rates<'_> {
    /// Draws the figure, or nothing for labels that are not rising numbers, too few values or too many curves.
    pub(crate) fn draw(&self) -> Option<String> {
        let (values, _) = values(self.labels)?;
        let complete = self.curves.iter().all(|curve| curve.shares.len() == values.len());
        if values.len() < MIN_VALUES || !(1..=MAX_CURVES).contains(&self.curves.len()) || !complete {
            return None;
        }
        let names: Vec<(&str, &str)> = self.curves.iter().map(|curve| curve.name).zip(COLORS).collect();
        let (legend, top) =
            if names.iter().all(|(name, _)| name.is_empty()) { (html! {}, HEAD) } else { legend(&names) };
        let shares: Vec<(f64, String)> = [0.0, 0.25, 0.5, 0.75, 1.0].map(|share| (share, percent(share))).into();
        let across = Limits::exact([*values.first()?, *values.last()?]);
        let plane = Plane::new(top, HEIGHT, across, Limits::exact([0.0, 1.0]), &shares);
        // Labels that would overlap are left out.
        let stride = values.len().div_ceil(((plane.right - plane.left) / 62.0) as usize).max(1);
        let labels = values.iter().zip(self.labels).step_by(stride).map(|(value, label)| (*value, (*label).to_owned()));
        let content = html! {
            (title(self.title)) (legend)
            (plane.axes([&labels.collect::<Vec<_>>(), &shares], [self.axis, ""]))
            @for (curve, color) in self.curves.iter().zip(COLORS) { (curve.draw(&values, &plane, color)) }
        };
        Some(figure([WIDTH, plane.bottom + FOOT], &content))
    }
}

impl RateCurve<'_> {
    fn draw(&self, values: &[f64], plane: &Plane, color: &str) -> Markup {
        let points = || values.iter().zip(&self.shares).filter(|(_, (share, _))| share.is_finite());
        let place = |value: f64, share: f64| plane.place([value, share.clamp(0.0, 1.0)]);
        let line = points().map(|(value, (share, _))| [*value, share.clamp(0.0, 1.0)]);
        html! {
            polyline points=(plane.points(line)) fill="none" stroke=(color) stroke-width="2" {}
            @for (value, (share, interval)) in points() {
                @let [x, y] = place(*value, *share);
                @let [[_, low], [_, high]] = interval.map(|end| place(*value, end));
                path d=(format!("M{0} {1}V{2}", at(x), at(low), at(high))) stroke=(color) {}
                circle cx=(at(x)) cy=(at(y)) r="4" fill=(color) {}
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve<'a>(name: &'a str, shares: &[f64]) -> RateCurve<'a> {
        RateCurve { name, shares: shares.iter().map(|share| (*share, [share - 0.1, share + 0.1])).collect() }
    }

    #[test]
    fn labels_that_rise_with_one_unit_are_values() {
        assert_eq!(values(&["0.0 s", "2.5 s", "5.0 s"]), Some((vec![0.0, 2.5, 5.0], "s")));
        assert_eq!(values(&["0", "0.05"]), Some((vec![0.0, 0.05], "")));
        for wrong in [&["0 s", "1 m"][..], &["1 s", "1 s"], &["intact", "1"], &["nan", "1"], &[]] {
            assert_eq!(values(wrong), None, "{wrong:?}");
        }
    }

    #[test]
    fn a_share_falls_to_half_between_two_values() {
        let values = [0.0, 1.0, 2.0, 3.0];
        assert_eq!(curve("", &[0.8, 0.8, 0.2, 0.0]).half(&values), Some(1.0 + 0.4 / 0.6000000000000001));
        assert_eq!(curve("", &[0.8, f64::NAN, 0.2]).half(&values), Some(2.0 * 0.4 / 0.6000000000000001));
        assert_eq!(curve("", &[0.8, 0.7, 0.6, 0.5]).half(&values), None);
        assert_eq!(curve("", &[0.0, 0.0, 0.0, 0.0]).half(&values), None);
    }

    #[test]
    fn curves_are_at_their_shares() {
        let labels = ["0.0 s", "2.5 s", "5.0 s"];
        let curves = [curve("object <changes>", &[1.0, 0.5, 0.0]), curve("action changes", &[0.5, f64::NAN, 0.25])];
        let svg = Rates { title: "decision", axis: "time", labels: &labels, curves: &curves }.draw().unwrap();
        for piece in ["decision", "object &lt;changes&gt;", "action changes", "2.5 s", "100 %", "time"] {
            assert!(svg.contains(piece), "no {piece} in {svg}");
        }
        // The first curve falls from the upper left corner to the lower right one.
        let line = svg.split("<polyline ").nth(1).and_then(|line| line.split('"').nth(1)).unwrap();
        let places: Vec<f64> = line.split([' ', ',']).map(|x| x.parse().unwrap()).collect();
        assert!((places[0] + places[4] - 2.0 * places[2]).abs() < 0.2 && places[4] == WIDTH - 18.0, "{line}");
        assert!((places[1] + places[5] - 2.0 * places[3]).abs() < 0.2 && places[5] - places[1] == HEIGHT, "{line}");
        assert!(!svg.contains("NaN"));
        let draw =
            |labels: &[&str], curves: &[RateCurve<'_>]| Rates { labels, curves, ..Rates::default() }.draw().is_some();
        assert!(draw(&labels, &curves) && !draw(&labels[..2], &curves) && !draw(&labels, &[]));
        assert!(!draw(&["a", "b", "c"], &curves) && !draw(&labels, &vec![curves[0].clone(); 5]));
    }
}
