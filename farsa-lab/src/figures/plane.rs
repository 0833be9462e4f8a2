//! A plane with two axes, on which marks are drawn.

use std::fmt::Write as _;

use maud::{Markup, html};

use crate::figures::svg::{GRID, INK, MARGIN, WIDTH, at, note};

/// Values above are drawn as `PART` of themselves, so that the range of an axis cannot overflow. A power of two changes no digit.
const LARGE: f64 = 1e300;
const PART: f64 = 1.0 / 65536.0;
/// Approximate number of labels of a vertical axis.
pub(crate) const LABELS: usize = 7;
/// Height of the labels and the name of the lower axis.
pub(crate) const FOOT: f64 = 60.0;

/// Range of an axis, in a part of the values.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Limits {
    low: f64,
    high: f64,
    part: f64,
}

impl Limits {
    /// Returns a range for all finite values, with a margin.
    pub(crate) fn of(values: impl Iterator<Item = f64>) -> Self {
        let ends = |(low, high): (f64, f64), x: f64| (low.min(x), high.max(x));
        let (mut low, mut high) = values.filter(|x| x.is_finite()).fold((f64::INFINITY, f64::NEG_INFINITY), ends);
        if low > high {
            (low, high) = (0.0, 1.0);
        }
        let part = if low.abs().max(high.abs()) > LARGE { PART } else { 1.0 };
        (low, high) = (low * part, high * part);
        // A flat curve needs a range with ticks that differ.
        let flat = match (low < high, high == 0.0) {
            (true, _) => 1e-9 * high.abs(),
            (false, true) => 1.0,
            (false, false) => 0.05 * high.abs(),
        };
        let margin = (0.05 * (high - low)).max(flat).max(f64::MIN_POSITIVE.sqrt());
        let largest = f64::MAX * part;
        Self { low: (low - margin).max(-largest), high: (high + margin).min(largest), part }
    }

    /// Returns a range without a margin.
    pub(crate) const fn exact([low, high]: [f64; 2]) -> Self {
        Self { low, high, part: 1.0 }
    }

    /// Computes the position of a value, from 0 at the lower to 1 at the upper end.
    pub(crate) fn position(&self, value: f64) -> f64 {
        (value * self.part - self.low) / (self.high - self.low)
    }

    /// Computes the least step between about `count` ticks, and the exponent of its power of ten.
    fn least_step(&self, count: usize) -> (f64, i32) {
        let least = (self.high - self.low) / count as f64 / self.part;
        (least, exponent(least))
    }

    /// Returns about `count` multiples of 1, 2 or 5 times a power of ten.
    pub(crate) fn ticks(&self, count: usize) -> Vec<f64> {
        let (least, exponent) = self.least_step(count);
        let power: f64 = format!("1e{exponent}").parse().unwrap_or(1.0);
        let step = [1.0, 2.0, 5.0].map(|m| m * power).into_iter().find(|step| *step >= 0.999 * least);
        let step = step.unwrap_or(10.0 * power);
        let [first, last] = [(self.low / self.part / step).ceil(), (self.high / self.part / step).floor()];
        let ticks = (0..=(last - first) as usize).map(|k| (first + k as f64) * step);
        ticks.take(2 * count).filter(|tick| tick.is_finite()).collect()
    }

    /// Returns ticks with their labels.
    pub(crate) fn labels(&self, count: usize) -> Vec<(f64, String)> {
        let (_, exponent) = self.least_step(count);
        self.ticks(count).into_iter().map(|tick| (tick, label(tick, exponent))).collect()
    }
}

/// Reads the exponent of a number from its text, because logarithms differ between platforms.
fn exponent(x: f64) -> i32 {
    format!("{x:e}").split_once('e').and_then(|(_, exponent)| exponent.parse().ok()).unwrap_or(0)
}

/// Formats a number alone with six decimals, or six digits if it is large or small.
pub(crate) fn number(x: f64) -> String {
    label(x, if (1e-4..1e15).contains(&x.abs()) { -6 } else { exponent(x) - 5 })
}

/// Formats a tick with the digits up to a power of ten, without zeros at the end.
fn label(tick: f64, least: i32) -> String {
    let places = |largest: i32| usize::try_from(largest - least).unwrap_or(0);
    let parsed = |text: String| text.parse::<f64>().map_or(tick, |rounded| rounded + 0.0);
    if tick == 0.0 || (1e-4..1e15).contains(&tick.abs()) || tick.abs() < 1e15 && least >= -6 {
        return parsed(format!("{tick:.*}", places(0))).to_string();
    }
    format!("{:e}", parsed(format!("{tick:.*e}", places(exponent(tick)))))
}

/// A rectangle of a figure with the ranges of its axes.
pub(crate) struct Plane {
    pub(crate) left: f64,
    pub(crate) top: f64,
    pub(crate) right: f64,
    pub(crate) bottom: f64,
    pub(crate) across: Limits,
    pub(crate) up: Limits,
}

impl Plane {
    /// Creates a plane of a height that leaves room for the labels of its vertical axis.
    pub(crate) fn new(top: f64, height: f64, across: Limits, up: Limits, labels: &[(f64, String)]) -> Self {
        let longest = labels.iter().map(|(_, label)| label.chars().count()).max().unwrap_or(0);
        let left = 82.0 + 9.0 * longest.saturating_sub(5).min(15) as f64;
        Self { left, top, right: WIDTH - MARGIN, bottom: top + height, across, up }
    }

    /// Computes the place of a point in the figure.
    pub(crate) fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (width, height) = (self.right - self.left, self.bottom - self.top);
        [self.left + width * self.across.position(x), self.top + height * (1.0 - self.up.position(y))]
    }

    /// Returns places as the points of a line or polygon.
    pub(crate) fn points(&self, points: impl IntoIterator<Item = [f64; 2]>) -> String {
        let mut text = String::new();
        for point in points {
            let [x, y] = self.place(point).map(at);
            // Writing to a string cannot fail.
            let _ = write!(text, "{}{x},{y}", if text.is_empty() { "" } else { " " });
        }
        text
    }

    /// Draws the axes with their grid, the labels at the given values and their names.
    pub(crate) fn axes(&self, labels: [&[(f64, String)]; 2], names: [&str; 2]) -> Markup {
        let Self { left, top, right, bottom, .. } = *self;
        let [middle, center] = [0.5 * (left + right), 0.5 * (top + bottom)];
        html! {
            @for (value, label) in labels[0] {
                @let [x, _] = self.place([*value, 0.0]);
                path d=(format!("M{} {}V{}", at(x), at(top), at(bottom))) stroke=(GRID) {}
                (note([x, bottom + 20.0], "middle", INK, label))
            }
            @for (value, label) in labels[1] {
                @let [_, y] = self.place([0.0, *value]);
                path d=(format!("M{} {}H{}", at(left), at(y), at(right))) stroke=(GRID) {}
                (note([left - 8.0, y + 5.0], "end", INK, label))
            }
            path d=(format!("M{} {}V{}H{}", at(left), at(top), at(bottom), at(right))) fill="none" stroke=(INK) {}
            text x=(at(middle)) y=(at(bottom + 46.0)) text-anchor="middle" fill=(INK) { (names[0]) }
            text transform=(format!("translate(24 {}) rotate(-90)", at(center))) text-anchor="middle" fill=(INK) { (names[1]) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_of_a_flat_curve_differ() {
        for value in [0.0, 1.0, -3.5, 1e9, 1e-7, 1.7e308, 5e-324] {
            let labels = Limits::of([value, value].into_iter()).labels(LABELS);
            assert!(labels.len() >= 3, "{value}: {labels:?}");
            let step = labels[1].0 - labels[0].0;
            for (tick, label) in &labels {
                assert!((label.parse::<f64>().unwrap() - tick).abs() <= 1e-3 * step, "{value}: {labels:?}");
                assert!(label.len() < 12, "{value}: {labels:?}");
            }
        }
        let labels = |value| {
            let labels = Limits::of([value, value].into_iter()).labels(LABELS);
            labels.into_iter().map(|(_, label)| label).collect::<Vec<_>>().join(" ")
        };
        assert_eq!(labels(1.0), "0.96 0.98 1 1.02 1.04");
        assert_eq!(labels(1e-7), "9.6e-8 9.8e-8 1e-7 1.02e-7 1.04e-7");
        let numbers = [0.0, 1.0 / 3.0, 123.4567891, -1e15, 1.23456789e-7].map(number);
        assert_eq!(numbers, ["0", "0.333333", "123.456789", "-1e15", "1.23457e-7"]);
        // A nearly flat curve needs more digits.
        let nearly = Limits::of([1.0, 1.0 + 2e-8].into_iter()).labels(LABELS);
        assert_eq!(nearly[1].1, "1.000000005");
    }
}
