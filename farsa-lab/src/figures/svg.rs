//! Parts that all figures share: frame, colors, legend and short coordinates.

use maud::{Markup, html};

/// Width of a figure, small enough for its text to be readable on a phone.
pub(crate) const WIDTH: f64 = 640.0;
pub(crate) const MARGIN: f64 = 18.0;
/// Height of a title.
pub(crate) const HEAD: f64 = 40.0;
pub(crate) const FONT: &str = "sans-serif";
/// Cases in the largest figure that remains readable.
pub(crate) const MAX_CASES: usize = 100;

/// Colors that a dark page replaces: background, text with axes, and grid.
pub(crate) const PAPER: &str = "#FFFFFF";
pub(crate) const INK: &str = "#222222";
pub(crate) const GRID: &str = "#E4E4E4";
/// Outline of held-out cases.
pub(crate) const OUTLINE: &str = "#D55E00";
/// Colors of Okabe and Ito, distinct for color-blind readers. Their yellow is too pale.
pub(crate) const COLORS: [&str; 6] = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"];

/// Approximate width of a letter.
const LETTER: f64 = 8.6;
/// Visible letters of a label. Its tooltip has all of them.
const LABEL_LETTERS: usize = 28;
/// Height of a line of the legend.
const LEGEND_LINE: f64 = 26.0;

/// Writes the SVG file of a figure. Text remains text, so that no font is needed.
pub(crate) fn figure([width, height]: [f64; 2], content: &Markup) -> String {
    let picture = html! {
        svg xmlns="http://www.w3.org/2000/svg" viewBox=(format!("0 0 {} {}", at(width), at(height)))
            width=(at(width)) height=(at(height)) font-family=(FONT) font-size="16" {
            rect width="100%" height="100%" fill=(PAPER) {}
            (content)
        }
    };
    picture.into_string() + "\n"
}

/// Returns the title of a figure.
pub(crate) fn title(text: &str) -> Markup {
    html! { text x=(MARGIN) y="28" font-size="20" fill=(INK) { (text) } }
}

/// Returns a text of size 14 with its anchor.
pub(crate) fn note([x, y]: [f64; 2], anchor: &str, fill: &str, text: &str) -> Markup {
    html! { text x=(at(x)) y=(at(y)) text-anchor=(anchor) font-size="14" fill=(fill) { (text) } }
}

/// Rounds a coordinate to a tenth.
pub(crate) fn at(x: f64) -> String {
    format!("{}", (10.0 * x).round() / 10.0)
}

/// Formats a share as a whole percentage.
pub(crate) fn percent(share: f64) -> String {
    if share.is_finite() { format!("{:.0} %", 100.0 * share) } else { "–".into() }
}

/// Shortens a label.
pub(crate) fn shown(label: &str) -> String {
    match label.char_indices().nth(LABEL_LETTERS) {
        Some((end, _)) => format!("{}…", label.get(..end).unwrap_or_default()),
        None => label.into(),
    }
}

/// Computes the approximate width of a shortened label.
pub(crate) fn width(label: &str) -> f64 {
    LETTER * shown(label).chars().count() as f64
}

/// Draws names with their colors in lines below the title. Returns the height of the lower end, too.
pub(crate) fn legend(names: &[(&str, &str)]) -> (Markup, f64) {
    let (mut x, mut line) = (MARGIN, 0.0);
    let mut entries = Vec::new();
    for (name, color) in names {
        let width = 48.0 + 9.0 * name.chars().count() as f64;
        if x > MARGIN && x + width > WIDTH {
            (x, line) = (MARGIN, line + 1.0);
        }
        entries.push(([x, HEAD + LEGEND_LINE * line + 12.0], name, color));
        x += width;
    }
    let lines = if entries.is_empty() { 0.0 } else { line + 1.0 };
    let content = html! {
        @for ([x, y], name, color) in entries {
            path d=(format!("M{} {}h22", at(x), at(y))) stroke=(color) stroke-width="3" {}
            text x=(at(x + 28.0)) y=(at(y + 5.0)) fill=(INK) { (name) }
        }
    };
    (content, HEAD + LEGEND_LINE * lines + 8.0)
}
