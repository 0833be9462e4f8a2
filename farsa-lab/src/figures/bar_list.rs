//! Shares as bars with their intervals: the success of each case of a test protocol with one column.

use maud::{Markup, html};

use crate::figures::svg::{
    GRID, INK, MARGIN, MAX_CASES, OUTLINE, WIDTH, at, figure, note, percent, shown, title, width,
};

/// Height of the line of a bar, the top of the first and the room below the last.
const LINE: f64 = 28.0;
const TOP: f64 = 48.0;
const FOOT: f64 = 34.0;
/// Room for the numbers at the right.
const NUMBERS: f64 = 66.0;
/// Color of bars, a middle gray in print.
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
    /// A share from 0 to 1, or NaN.
    pub(crate) share: f64,
    /// Ends of the interval.
    pub(crate) interval: [f64; 2],
    /// True for a held-out case.
    pub(crate) outlined: bool,
}

impl BarList<'_> {
    /// Draws the figure, or nothing for an empty list or one that is too long to be readable.
    pub(crate) fn draw(&self) -> Option<String> {
        if !(1..=MAX_CASES).contains(&self.bars.len()) {
            return None;
        }
        let longest = self.bars.iter().map(|bar| width(bar.label)).fold(0.0, f64::max);
        let left = MARGIN + longest + 12.0;
        let room = WIDTH - left - NUMBERS;
        let bottom = TOP + LINE * self.bars.len() as f64;
        let content = html! {
            (title(self.title))
            @for share in [0.0, 0.25, 0.5, 0.75, 1.0] {
                @let x = left + room * share;
                path d=(format!("M{} {}V{}", at(x), at(TOP - 4.0), at(bottom))) stroke=(GRID) {}
                (note([x, bottom + 20.0], "middle", INK, &percent(share)))
            }
            @for (number, bar) in self.bars.iter().enumerate() { (bar.draw([left, TOP + LINE * number as f64], room)) }
            @if self.bars.iter().any(|bar| bar.outlined) {
                (note([MARGIN, bottom + 20.0], "start", OUTLINE, "outlined: held out"))
            }
        };
        Some(figure([WIDTH, bottom + FOOT], &content))
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
