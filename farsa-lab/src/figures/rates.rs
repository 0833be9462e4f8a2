//! Shares over a number, as curves with their intervals, as SVG: a test protocol whose rows are times or sizes.

use std::fmt::Write as _;

use maud::{Markup, html};

use crate::figures::heat_map::percent;
use crate::figures::plot::{FONT, GRID, INK, MARGIN, PAPER};

/// Width of the picture, height of the plot, of the title, of a line of names and of what is below.
const WIDTH: f64 = 640.0;
const PLOT: f64 = 260.0;
const HEAD: f64 = 40.0;
const NAME: f64 = 24.0;
const FOOT: f64 = 58.0;
const LEFT: f64 = 66.0;
/// Room that a label of the lower axis takes.
const LABEL: f64 = 62.0;
/// Values of the shortest and the longest curve, and curves that are told apart.
const VALUES: [usize; 2] = [3, 1000];
const CURVES: usize = 4;
const COLORS: [&str; CURVES] = ["#0072B2", "#D55E00", "#009E73", "#CC79A7"];

/// Shares over a number.
#[derive(Debug, Default)]
pub(crate) struct Rates<'a> {
    pub(crate) title: &'a str,
    /// What the number is.
    pub(crate) axis: &'a str,
    /// The labels of the values, each a number with the same unit.
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
    /// Where the share first falls to half of what it is at the first value, between values along a straight line; none where it
    /// never does, or is nothing at first.
    pub(crate) fn half(&self, values: &[f64]) -> Option<f64> {
        let half = 0.5 * self.shares.first()?.0;
        let points: Vec<[f64; 2]> = values.iter().zip(&self.shares).map(|(x, (share, _))| [*x, *share]).collect();
        let falls = points.windows(2).find(|pair| pair[0][1] > half && pair[1][1] <= half)?;
        let [[x, above], [next, below]] = [falls[0], falls[1]];
        Some(x + (next - x) * (above - half) / (above - below))
    }
}

/// The numbers that labels begin with, if they rise and all have the same unit behind them, and that unit.
pub(crate) fn values<'l>(labels: &[&'l str]) -> Option<(Vec<f64>, &'l str)> {
    let split = |label: &'l str| -> Option<(f64, &'l str)> {
        let (number, unit) = label.split_once(' ').unwrap_or((label, ""));
        Some((number.parse().ok().filter(|x: &f64| x.is_finite())?, unit))
    };
    let all: Vec<(f64, &str)> = labels.iter().map(|label| split(label)).collect::<Option<_>>()?;
    let (_, unit) = *all.first()?;
    let rises = all.windows(2).all(|pair| pair[0].0 < pair[1].0 && pair[1].1 == unit);
    rises.then(|| (all.into_iter().map(|(x, _)| x).collect(), unit))
}

fn at(x: f64) -> String {
    format!("{}", (10.0 * x).round() / 10.0)
}

impl Rates<'_> {
    /// The picture; text in it is text, so that no font is needed. None where labels are no numbers that rise, of too few or too
    /// many values, and of more curves than are told apart.
    pub(crate) fn draw(&self) -> Option<String> {
        let (values, _) = values(self.labels)?;
        let [fewest, most] = VALUES;
        let complete = self.curves.iter().all(|curve| curve.shares.len() == values.len());
        if !(fewest..=most).contains(&values.len()) || !(1..=CURVES).contains(&self.curves.len()) || !complete {
            return None;
        }
        let [first, last] = [*values.first()?, *values.last()?];
        let right = WIDTH - f64::from(MARGIN);
        let top = HEAD + NAME * self.curves.len() as f64;
        let x = |value: f64| LEFT + (right - LEFT) * (value - first) / (last - first);
        let y = |share: f64| top + PLOT * (1.0 - share.clamp(0.0, 1.0));
        let stride = values.len().div_ceil(((right - LEFT) / LABEL) as usize).max(1);
        let size = [WIDTH, top + PLOT + FOOT].map(at);
        let low = top + PLOT;
        let picture = html! {
            svg xmlns="http://www.w3.org/2000/svg" viewBox=(format!("0 0 {} {}", size[0], size[1]))
                width=(size[0]) height=(size[1]) font-family=(FONT.0) font-size="16" {
                rect width="100%" height="100%" fill=(PAPER) {}
                text x=(MARGIN) y="28" font-size="20" fill=(INK) { (self.title) }
                @for part in 0..=4_u8 {
                    @let share = f64::from(part) / 4.0;
                    path d=(format!("M{} {}H{}", at(LEFT), at(y(share)), at(right))) stroke=(GRID) {}
                    text x=(at(LEFT - 8.0)) y=(at(y(share) + 5.0)) text-anchor="end" font-size="14" fill=(INK) {
                        (percent(share))
                    }
                }
                @for (label, value) in self.labels.iter().zip(&values).step_by(stride) {
                    path d=(format!("M{} {}v5", at(x(*value)), at(low))) stroke=(INK) {}
                    text x=(at(x(*value))) y=(at(low + 21.0)) text-anchor="middle" font-size="14" fill=(INK) { (label) }
                }
                text x=(at(0.5 * (LEFT + right))) y=(at(low + 46.0)) text-anchor="middle" fill=(INK) { (self.axis) }
                @for ((number, curve), color) in self.curves.iter().enumerate().zip(COLORS) {
                    @let line = HEAD + NAME * number as f64 + 14.0;
                    path d=(format!("M{} {}h26", at(LEFT), at(line))) stroke=(color) stroke-width="3" {}
                    text x=(at(LEFT + 34.0)) y=(at(line + 5.0)) fill=(INK) { (curve.name) }
                    (curve.draw(&values, x, y, color))
                }
            }
        };
        Some(picture.into_string() + "\n")
    }
}

impl RateCurve<'_> {
    fn draw(&self, values: &[f64], x: impl Fn(f64) -> f64, y: impl Fn(f64) -> f64, color: &str) -> Markup {
        let points = || values.iter().zip(&self.shares).filter(|(_, (share, _))| share.is_finite());
        let mut line = String::new();
        for (number, (value, (share, _))) in points().enumerate() {
            // Writing into a string cannot fail.
            let _ = write!(line, "{}{} {}", if number == 0 { 'M' } else { 'L' }, at(x(*value)), at(y(*share)));
        }
        html! {
            path d=(line) fill="none" stroke=(color) stroke-width="2" {}
            @for (value, (share, [low, high])) in points() {
                path d=(format!("M{0} {1}V{2}", at(x(*value)), at(y(*low)), at(y(*high)))) stroke=(color) {}
                circle cx=(at(x(*value))) cy=(at(y(*share))) r="4" fill=(color) {}
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
        assert_eq!(curve("", &[0.8, 0.7, 0.6, 0.5]).half(&values), None);
        assert_eq!(curve("", &[0.0, 0.0, 0.0, 0.0]).half(&values), None);
    }

    #[test]
    fn curves_lie_where_their_shares_are() {
        let labels = ["0.0 s", "2.5 s", "5.0 s"];
        let curves = [curve("object <changes>", &[1.0, 0.5, 0.0]), curve("action changes", &[0.5, f64::NAN, 0.25])];
        let svg = Rates { title: "decision", axis: "time", labels: &labels, curves: &curves }.draw().unwrap();
        for piece in ["decision", "object &lt;changes&gt;", "action changes", "2.5 s", "100 %", "time"] {
            assert!(svg.contains(piece), "no {piece} in {svg}");
        }
        let [top, low] = [HEAD + 2.0 * NAME, HEAD + 2.0 * NAME + PLOT];
        let middle = 0.5 * (LEFT + WIDTH - f64::from(MARGIN));
        let [end, half] = [WIDTH - f64::from(MARGIN), 0.5 * (top + low)];
        assert!(svg.contains(&format!("M66 {top}L{middle} {half}L{end} {low}")), "{svg}");
        assert!(!svg.contains("NaN"));
        let draw =
            |labels: &[&str], curves: &[RateCurve<'_>]| Rates { labels, curves, ..Rates::default() }.draw().is_some();
        assert!(draw(&labels, &curves) && !draw(&labels[..2], &curves) && !draw(&labels, &[]));
        assert!(!draw(&["a", "b", "c"], &curves) && !draw(&labels, &vec![curves[0].clone(); 5]));
    }
}
