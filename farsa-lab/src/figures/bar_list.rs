//! A list of shares as bars with their intervals, as SVG: the success of each case of a test protocol with one column.

use maud::{Markup, html};

use crate::figures::heat_map::{OUTLINE, percent, shown, width};
use crate::figures::plot::{FONT, GRID, INK, MARGIN, PAPER};

/// Width of the picture, height of a bar's line, of the title and of what is below the bars.
const WIDTH: f64 = 640.0;
const LINE: f64 = 28.0;
const HEAD: f64 = 48.0;
const FOOT: f64 = 34.0;
/// Room for the numbers at the right.
const NUMBERS: f64 = 66.0;
/// Bars of the longest list that is drawn.
const LARGEST: usize = 100;
/// The colour of bars, which print shows as a middle grey.
const BAR: &str = "#56B4E9";

/// A list of shares.
#[derive(Debug, Default)]
pub(crate) struct BarList<'a> {
    pub(crate) title: &'a str,
    pub(crate) bars: &'a [Bar<'a>],
}

/// A line of the list.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Bar<'a> {
    pub(crate) label: &'a str,
    /// From 0 to 1; not a number where it is not known.
    pub(crate) share: f64,
    /// The ends of the interval.
    pub(crate) interval: [f64; 2],
    pub(crate) outlined: bool,
}

fn at(x: f64) -> String {
    format!("{}", (10.0 * x).round() / 10.0)
}

impl BarList<'_> {
    /// The picture; text in it is text, so that no font is needed. None of a list that is too long to be read as one.
    pub(crate) fn draw(&self) -> Option<String> {
        if !(1..=LARGEST).contains(&self.bars.len()) {
            return None;
        }
        let longest = self.bars.iter().map(|bar| width(bar.label)).fold(0.0, f64::max);
        let left = f64::from(MARGIN) + longest + 12.0;
        let room = WIDTH - left - NUMBERS;
        let low = HEAD + LINE * self.bars.len() as f64;
        let held_out = self.bars.iter().any(|bar| bar.outlined);
        let height = low + FOOT;
        let picture = html! {
            svg xmlns="http://www.w3.org/2000/svg" viewBox=(format!("0 0 {} {}", at(WIDTH), at(height)))
                width=(at(WIDTH)) height=(at(height)) font-family=(FONT.0) font-size="16" {
                rect width="100%" height="100%" fill=(PAPER) {}
                text x=(MARGIN) y="28" font-size="20" fill=(INK) { (self.title) }
                @for part in 0..=4_u8 {
                    @let x = left + room * f64::from(part) / 4.0;
                    path d=(format!("M{} {}V{}", at(x), at(HEAD - 4.0), at(low))) stroke=(GRID) {}
                    text x=(at(x)) y=(at(low + 20.0)) text-anchor="middle" font-size="14" fill=(INK) {
                        (percent(f64::from(part) / 4.0))
                    }
                }
                @for (number, bar) in self.bars.iter().enumerate() {
                    (bar.draw([left, HEAD + LINE * number as f64], room))
                }
                @if held_out {
                    text x=(MARGIN) y=(at(low + 20.0)) font-size="14" fill=(OUTLINE) { "outlined: held out" }
                }
            }
        };
        Some(picture.into_string() + "\n")
    }
}

impl Bar<'_> {
    fn draw(&self, [left, top]: [f64; 2], room: f64) -> Markup {
        let part = |share: f64| left + room * if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 };
        let [low, high] = self.interval.map(part);
        let (end, middle) = (part(self.share), top + 0.5 * LINE);
        let ticks = [low, high].map(|x| format!("M{} {}v8", at(x), at(middle - 4.0))).join("");
        html! {
            text x=(at(left - 10.0)) y=(at(middle + 5.5)) text-anchor="end" fill=(INK) {
                title { (self.label) } (shown(self.label))
            }
            rect x=(at(left)) y=(at(top + 4.0)) width=(at(end - left)) height=(at(LINE - 8.0)) fill=(BAR) {}
            @if self.outlined {
                rect x=(at(left)) y=(at(top + 4.0)) width=(at((end - left).max(4.0))) height=(at(LINE - 8.0)) fill="none"
                    stroke=(OUTLINE) stroke-width="3" stroke-dasharray="8 3" {}
            }
            @if self.share.is_finite() {
                path d=(format!("M{} {}H{}{ticks}", at(low), at(middle), at(high))) stroke=(INK) stroke-width="1.5" fill="none" {}
            }
            text x=(at(left + room + 10.0)) y=(at(middle + 5.5)) fill=(INK) { (percent(self.share)) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bar_is_as_long_as_its_share() {
        let bar = |label, share| Bar { label, share, interval: [0.25, 0.75], outlined: label == "b" };
        let bars = [bar("<a>", 0.5), bar("b", 1.0), bar("c", f64::NAN)];
        let svg = BarList { title: "lesions", bars: &bars }.draw().unwrap();
        let widths: Vec<f64> = svg
            .split("<rect ")
            .filter(|rect| rect.contains(BAR))
            .map(|rect| rect.split_once("width=\"").unwrap().1.split_once('"').unwrap().0.parse().unwrap())
            .collect();
        assert!(widths.len() == 3 && (widths[1] - 2.0 * widths[0]).abs() < 0.2 && widths[2] == 0.0, "{widths:?}");
        for piece in ["&lt;a&gt;", "50 %", "–", "held out"] {
            assert!(svg.contains(piece), "{svg}");
        }
        assert!(!svg.contains("NaN"));
        assert_eq!(BarList::default().draw(), None);
        assert_eq!(BarList { title: "", bars: &vec![bar("x", 0.0); 101] }.draw(), None);
    }
}
