//! Curves in a plane, a small picture for each case, as SVG: the internal states of a test protocol.

use std::fmt::Write as _;

use farsa_num::crc32;
use maud::{Markup, html};

use crate::figures::heat_map::{OUTLINE, shown};
use crate::figures::plot::{FONT, GRID, INK, Limits, MARGIN, PAPER};

/// Width of the picture, and heights of the title, of a panel's label and of the line below.
const WIDTH: f64 = 640.0;
const HEAD: f64 = 44.0;
const LABEL: f64 = 24.0;
const FOOT: f64 = 40.0;
/// What lies between panels.
const GAP: f64 = 10.0;
/// How large a panel is at most, and how many columns there are at most.
const LARGEST: f64 = 300.0;
const COLUMNS: usize = 6;
/// More panels than these are not told apart.
const MOST_PANELS: usize = 60;
/// More points of a curve than these are not seen; every k-th is drawn then.
const MOST_POINTS: usize = 100;
/// The colour of a panel's own curves.
const CURVE: &str = "#0072B2";

/// A plane with curves of several cases.
#[derive(Debug, Default)]
pub(crate) struct Trajectories<'a> {
    pub(crate) title: &'a str,
    /// What lies to the right, and what upwards.
    pub(crate) axes: [String; 2],
    /// How many panels stand beside each other.
    pub(crate) columns: usize,
    pub(crate) panels: &'a [Panel],
}

/// The curves of a case.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Panel {
    pub(crate) label: String,
    pub(crate) curves: Vec<Vec<[f64; 2]>>,
    pub(crate) outlined: bool,
}

fn at(x: f64) -> String {
    format!("{}", (10.0 * x).round() / 10.0)
}

/// The plane in a panel.
struct Plane {
    across: Limits,
    up: Limits,
    side: f64,
}

impl Plane {
    fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let part = |x: f64, limits: &Limits| (x * limits.part - limits.low) / (limits.high - limits.low);
        [self.side * part(x, &self.across), self.side * (1.0 - part(y, &self.up))]
    }

    /// A curve as the data of a path.
    fn path(&self, curve: &[[f64; 2]]) -> String {
        let stride = curve.len().div_ceil(MOST_POINTS).max(1);
        // The last point belongs to it whatever the stride is.
        let points = curve.iter().rev().step_by(stride).rev();
        let mut data = String::new();
        for (number, point) in points.enumerate() {
            let [x, y] = self.place(*point).map(at);
            // Writing into a string cannot fail.
            let _ = write!(data, "{}{x} {y}", if number == 0 { 'M' } else { 'L' });
        }
        data
    }
}

impl Trajectories<'_> {
    /// The picture; text in it is text, so that no font is needed. None where there is no curve, or too many panels.
    pub(crate) fn draw(&self) -> Option<String> {
        let points = || self.panels.iter().flat_map(|panel| panel.curves.iter().flatten());
        if !(1..=MOST_PANELS).contains(&self.panels.len()) || points().next().is_none() {
            return None;
        }
        if points().flatten().any(|x| !x.is_finite()) {
            return None;
        }
        let columns = self.columns.clamp(1, COLUMNS);
        let room = WIDTH - 2.0 * f64::from(MARGIN) + GAP;
        let side = (room / columns as f64 - GAP).min(LARGEST);
        let [across, up] = [0, 1].map(|axis| Limits::of(points().map(|point| point[axis])));
        let plane = Plane { across, up, side };
        let rows = self.panels.len().div_ceil(columns);
        let bottom = HEAD + (side + LABEL + GAP) * rows as f64;
        let height = bottom + FOOT;
        let curves = self.panels.iter().flat_map(|panel| &panel.curves);
        let all: String = curves.map(|curve| plane.path(curve)).collect();
        // Pictures on one page share their names.
        let name = format!("all-{:08x}", crc32(all.as_bytes()));
        let corner = |number: usize| {
            let x = f64::from(MARGIN) + (side + GAP) * (number % columns) as f64;
            [x, HEAD + LABEL + (side + LABEL + GAP) * (number / columns) as f64]
        };
        let picture = html! {
            svg xmlns="http://www.w3.org/2000/svg" viewBox=(format!("0 0 {} {}", at(WIDTH), at(height)))
                width=(at(WIDTH)) height=(at(height)) font-family=(FONT.0) font-size="15" {
                rect width="100%" height="100%" fill=(PAPER) {}
                defs { path id=(name) d=(all) fill="none" stroke=(GRID) stroke-width="1" {} }
                text x=(MARGIN) y="28" font-size="20" fill=(INK) { (self.title) }
                @for (number, panel) in self.panels.iter().enumerate() { (panel.draw(corner(number), &plane, &name)) }
                text x=(MARGIN) y=(at(bottom + 6.0)) font-size="14" fill=(INK) { "→ " (self.axes[0]) }
                text x=(MARGIN) y=(at(bottom + 26.0)) font-size="14" fill=(INK) { "↑ " (self.axes[1]) }
                @if self.panels.iter().any(|panel| panel.outlined) {
                    text x=(at(WIDTH - f64::from(MARGIN))) y=(at(bottom + 6.0)) text-anchor="end" font-size="14"
                        fill=(OUTLINE) { "dashed: held out" }
                }
            }
        };
        Some(picture.into_string() + "\n")
    }
}

impl Panel {
    fn draw(&self, [x, y]: [f64; 2], plane: &Plane, all: &str) -> Markup {
        let side = at(plane.side);
        html! {
            text x=(at(x)) y=(at(y - 7.0)) fill=(INK) { title { (self.label) } (shown(&self.label)) }
            g transform=(format!("translate({} {})", at(x), at(y))) {
                @if self.outlined {
                    rect width=(side) height=(side) fill="none" stroke=(OUTLINE) stroke-width="3" stroke-dasharray="8 3" {}
                } @else {
                    rect width=(side) height=(side) fill="none" stroke=(GRID) {}
                }
                use href=(format!("#{all}")) {}
                @for curve in &self.curves {
                    path d=(plane.path(curve)) fill="none" stroke=(CURVE) stroke-width="1.6" stroke-opacity="0.75" {}
                    @if let [Some(first), Some(last)] = [curve.first(), curve.last()] {
                        @let [start, end] = [first, last].map(|point| plane.place(*point));
                        circle cx=(at(start[0])) cy=(at(start[1])) r="3" fill=(PAPER) stroke=(INK) {}
                        circle cx=(at(end[0])) cy=(at(end[1])) r="3.5" fill=(INK) {}
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn panel(label: &str, curves: Vec<Vec<[f64; 2]>>) -> Panel {
        Panel { label: label.into(), curves, outlined: false }
    }

    #[test]
    fn every_panel_has_its_own_curves_before_those_of_all() {
        let line = vec![[0.0, 0.0], [1.0, 2.0]];
        let panels = [
            panel("TOUCH <red>", vec![line.clone(), vec![[1.0, 0.0], [0.5, 0.5]]]),
            Panel { outlined: true, ..panel("MOVE red", vec![line]) },
        ];
        let axes = ["first, 60 %".to_owned(), "second, 30 %".to_owned()];
        let svg = Trajectories { title: "states", axes, columns: 2, panels: &panels }.draw().unwrap();
        for piece in ["TOUCH &lt;red&gt;", "MOVE red", "→ first, 60 %", "↑ second, 30 %", "dashed: held out"] {
            assert!(svg.contains(piece), "no {piece} in {svg}");
        }
        assert_eq!((svg.matches("<use ").count(), svg.matches("stroke-width=\"1.6\"").count()), (2, 3));
        assert_eq!(svg.matches("r=\"3.5\"").count(), 3);
        // The plane has a margin of a 20th: 0 and 1 of 1, and 0 and 2 of 2, upwards.
        let side = 0.5 * (640.0 - 36.0 - 10.0);
        let [low, high] = [0.05 / 1.1 * side, 1.05 / 1.1 * side].map(at);
        assert!(svg.contains(&format!("M{low} {high}L{high} {low}")), "no {low} {high} in {svg}");
    }

    #[test]
    fn long_curves_keep_their_ends_and_what_cannot_be_drawn_is_not() {
        let long: Vec<[f64; 2]> = (0..1001).map(|i| [f64::from(i), 0.0]).collect();
        let panels = [panel("a", vec![long])];
        let draw = |panels: &[Panel]| Trajectories { columns: 1, panels, ..Trajectories::default() }.draw();
        let svg = draw(&panels).unwrap();
        assert!(svg.matches('L').count() <= 200 && svg.contains("r=\"3.5\""), "{svg}");
        assert_eq!(draw(&[]), None);
        assert_eq!(draw(&[panel("a", vec![])]), None);
        assert_eq!(draw(&[panel("a", vec![vec![[f64::NAN, 0.0]]])]), None);
        assert_eq!(draw(&vec![panel("a", vec![vec![[0.0; 2]]]); 61]), None);
    }
}
