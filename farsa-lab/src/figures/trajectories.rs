//! Curves in a plane, a panel for each case: the internal states of a test protocol.

use farsa_num::crc32;
use maud::{Markup, html};

use crate::figures::plane::{Limits, Plane};
use crate::figures::svg::{
    COLORS, GRID, HEAD, INK, MARGIN, MAX_CASES, OUTLINE, PAPER, WIDTH, at, figure, note, shown, title,
};

/// Heights of a panel's label and of the text below, and the gap between panels.
const LABEL: f64 = 24.0;
const FOOT: f64 = 40.0;
const GAP: f64 = 10.0;
/// Largest side of a panel and largest number of columns.
const MAX_SIDE: f64 = 300.0;
const MAX_COLUMNS: usize = 6;
/// Points of a curve, of which longer curves keep every k-th.
const MAX_POINTS: usize = 100;

/// A plane with curves of several cases.
#[derive(Debug, Default)]
pub(crate) struct Trajectories<'a> {
    pub(crate) title: &'a str,
    /// Names of the lower and the vertical axis.
    pub(crate) axes: [String; 2],
    /// Number of panels in a row.
    pub(crate) columns: usize,
    pub(crate) panels: &'a [Panel],
}

/// Curves of a case.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Panel {
    pub(crate) label: String,
    pub(crate) curves: Vec<Vec<[f64; 2]>>,
    /// True for a held-out case.
    pub(crate) outlined: bool,
}

/// Draws the points of a curve in a plane, thinned from its end.
fn line(plane: &Plane, curve: &[[f64; 2]]) -> String {
    let stride = curve.len().div_ceil(MAX_POINTS).max(1);
    plane.points(curve.iter().rev().step_by(stride).rev().copied())
}

impl Trajectories<'_> {
    /// Draws the figure, or nothing without curves, with too many panels and with values that are not finite.
    pub(crate) fn draw(&self) -> Option<String> {
        let points = || self.panels.iter().flat_map(|panel| panel.curves.iter().flatten());
        if !(1..=MAX_CASES).contains(&self.panels.len()) || points().next().is_none() {
            return None;
        }
        if points().flatten().any(|x| !x.is_finite()) {
            return None;
        }
        let columns = self.columns.clamp(1, MAX_COLUMNS);
        let room = WIDTH - 2.0 * MARGIN + GAP;
        let side = (room / columns as f64 - GAP).min(MAX_SIDE);
        let [across, up] = [0, 1].map(|axis| Limits::of(points().map(|point| point[axis])));
        let plane = Plane { left: 0.0, top: 0.0, right: side, bottom: side, across, up };
        let bottom = HEAD + (side + LABEL + GAP) * self.panels.len().div_ceil(columns) as f64;
        let lines: Vec<String> =
            self.panels.iter().flat_map(|panel| &panel.curves).map(|curve| line(&plane, curve)).collect();
        // Figures on one page share their names.
        let name = format!("all-{:08x}", crc32(lines.concat().as_bytes()));
        let corner = |number: usize| {
            let x = MARGIN + (side + GAP) * (number % columns) as f64;
            [x, HEAD + LABEL + (side + LABEL + GAP) * (number / columns) as f64]
        };
        let content = html! {
            defs {
                g id=(name) fill="none" stroke=(GRID) { @for line in &lines { polyline points=(line) {} } }
            }
            (title(self.title))
            @for (number, panel) in self.panels.iter().enumerate() { (panel.draw(corner(number), &plane, &name)) }
            (note([MARGIN, bottom + 6.0], "start", INK, &format!("→ {}", self.axes[0])))
            (note([MARGIN, bottom + 26.0], "start", INK, &format!("↑ {}", self.axes[1])))
            @if self.panels.iter().any(|panel| panel.outlined) {
                (note([WIDTH - MARGIN, bottom + 6.0], "end", OUTLINE, "dashed: held out"))
            }
        };
        Some(figure([WIDTH, bottom + FOOT], &content))
    }
}

impl Panel {
    fn draw(&self, [x, y]: [f64; 2], plane: &Plane, all: &str) -> Markup {
        let side = at(plane.right);
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
                    polyline points=(line(plane, curve)) fill="none" stroke=(COLORS[0]) stroke-width="1.6" stroke-opacity="0.75" {}
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
    fn every_panel_shows_its_curves_above_all_curves() {
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
        // The plane has a margin of a twentieth.
        let side = 0.5 * (640.0 - 36.0 - 10.0);
        let [low, high] = [0.05 / 1.1 * side, 1.05 / 1.1 * side].map(at);
        assert!(svg.contains(&format!("{low},{high} {high},{low}")), "no {low} {high} in {svg}");
    }

    #[test]
    fn long_curves_keep_their_ends_and_invalid_ones_are_not_drawn() {
        let long: Vec<[f64; 2]> = (0..1001).map(|i| [f64::from(i), 0.0]).collect();
        let panels = [panel("a", vec![long])];
        let draw = |panels: &[Panel]| Trajectories { columns: 1, panels, ..Trajectories::default() }.draw();
        let svg = draw(&panels).unwrap();
        let line = svg.split("<polyline ").nth(1).unwrap();
        assert!(line.matches(',').count() <= 101 && svg.contains("r=\"3.5\""), "{svg}");
        assert_eq!(draw(&[]), None);
        assert_eq!(draw(&[panel("a", vec![])]), None);
        assert_eq!(draw(&[panel("a", vec![vec![[f64::NAN, 0.0]]])]), None);
        assert_eq!(draw(&vec![panel("a", vec![vec![[0.0; 2]]]); 101]), None);
    }
}
