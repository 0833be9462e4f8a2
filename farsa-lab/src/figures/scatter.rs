//! Points in two dimensions, darker where a third value is larger: the archive or the front of a run.

use maud::html;

use crate::figures::plane::{FOOT, LABELS, Limits, Plane, number};
use crate::figures::svg::{INK, MARGIN, WIDTH, at, figure, title};

/// Number of points above which only every k-th is drawn.
const MAX_POINTS: usize = 5000;
/// Top and height of the plane.
const TOP: f64 = 66.0;
const HEIGHT: f64 = 520.0;
/// Colors of the least and of the largest value, which differ in lightness, too.
const PALE: [f64; 3] = [176.0, 216.0, 240.0];
const DARK: [f64; 3] = [0.0, 38.0, 84.0];

/// Points with a shade.
#[derive(Debug, Default)]
pub(crate) struct Scatter<'a> {
    pub(crate) title: &'a str,
    /// Names of the lower and the vertical axis.
    pub(crate) axes: [&'a str; 2],
    /// Ranges that the axes include.
    pub(crate) ranges: [Option<[f64; 2]>; 2],
    /// Name of the third value.
    pub(crate) shade: &'a str,
    /// Place and third value of each point.
    pub(crate) points: &'a [([f64; 2], f64)],
}

impl Scatter<'_> {
    /// Draws the figure.
    pub(crate) fn draw(&self) -> String {
        let finite = || self.points.iter().map(|(_, value)| *value).filter(|x| x.is_finite());
        let ends = [finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max)];
        let [low, high] = ends.map(number);
        let shade = Limits::of(finite());
        let [across, up] = [0, 1].map(|axis| {
            let values = self.points.iter().map(|(place, _)| place[axis]);
            Limits::of(values.chain(self.ranges[axis].into_iter().flatten()))
        });
        let values = up.labels(LABELS);
        let plane = Plane::new(TOP, HEIGHT, across, up, &values);
        let stride = self.points.len().div_ceil(MAX_POINTS).max(1);
        let points = self.points.iter().step_by(stride).filter(|([x, y], _)| x.is_finite() && y.is_finite());
        let color = |value: f64| {
            let share =
                Some(shade.position(value)).filter(|share| share.is_finite()).map_or(0.0, |x| x.clamp(0.0, 1.0));
            let [red, green, blue] = [0, 1, 2].map(|i| (PALE[i] + share * (DARK[i] - PALE[i])) as u8);
            format!("#{red:02X}{green:02X}{blue:02X}")
        };
        let content = html! {
            (title(self.title))
            @if ends[0] <= ends[1] {
                text x=(MARGIN) y="54" fill=(INK) { (self.shade) ": from " (low) " (pale) to " (high) " (dark)" }
            }
            (plane.axes([&across.labels(8), &values], self.axes))
            @for (point, value) in points {
                @let [x, y] = plane.place(*point);
                circle cx=(at(x)) cy=(at(y)) r="3" fill=(color(*value)) {}
            }
        };
        figure([WIDTH, plane.bottom + FOOT], &content)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_is_at_its_values_and_darker_for_a_larger_third() {
        let points = [([0.0, 0.0], 1.0), ([1.0, 2.0], 3.0), ([0.5, 1.0], 2.0)];
        let ranges = [Some([0.0, 1.0]), None];
        let svg = Scatter { title: "t", axes: ["a", "b"], ranges, shade: "fitness", points: &points }.draw();
        let circle = |line: &str| -> Option<(f64, f64, String)> {
            let number = |key: &str| line.split_once(&format!("{key}=\"")).and_then(|(_, rest)| rest.split_once('"'));
            let [x, y] = ["cx", "cy"].map(|key| number(key).and_then(|(x, _)| x.parse().ok()));
            Some((x?, y?, number("fill")?.0.to_owned()))
        };
        let circles: Vec<_> = svg.split("<circle ").skip(1).filter_map(circle).collect();
        let [(x0, y0, pale), (x1, y1, dark), (x2, y2, _)] = &circles[..] else { panic!("{svg}") };
        assert!(x0 < x2 && x2 < x1 && y0 > y2 && y2 > y1, "{circles:?}");
        let red = |color: &str| u8::from_str_radix(&color[1..3], 16).unwrap();
        assert!(red(pale) > red(dark), "{circles:?}");
        assert!(svg.contains("fitness: from 1 (pale) to 3 (dark)"), "{svg}");
    }

    #[test]
    fn points_of_any_size_can_be_drawn() {
        for x in [f64::MAX, f64::MIN, 5e-324, 0.0, f64::NAN, f64::INFINITY] {
            let points = [([x, 1.0], x), ([-x, x], 0.0)];
            let svg = Scatter { points: &points, ..Scatter::default() }.draw();
            assert!(svg.ends_with("</svg>\n") && !svg.contains("NaN") && !svg.contains("inf"), "{x}");
        }
        assert!(Scatter::default().draw().ends_with("</svg>\n"));
        let many = vec![([0.5, 0.5], 1.0); 100_000];
        assert!(Scatter { points: &many, ..Scatter::default() }.draw().len() < 1_000_000);
    }
}
