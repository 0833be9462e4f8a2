//! A table of shares as SVG, darker where a share is larger: the success of each case of a test protocol.

use maud::{Markup, html};

use crate::figures::plot::{FONT, INK, MARGIN, PAPER};

/// Width that the picture has at least, and what a column may have.
const WIDTH: f64 = 640.0;
const COLUMN: [f64; 2] = [54.0, 130.0];
/// Height of a row, with the second line of its cells and without.
const ROW: f64 = 46.0;
/// Height of the title, and of the scale below the map.
const HEAD: f64 = 44.0;
const SCALE: f64 = 58.0;
/// A letter of the labels is about so wide.
const LETTER: f64 = 8.6;
/// Letters of a label that are shown; all of them are in its tip.
const LONGEST: usize = 28;
/// Rows and columns of the largest map that is drawn.
const LARGEST: usize = 100;
/// The colours of the shares 0 and 1, which differ in lightness too, so that print shows the difference.
const PALE: [f64; 3] = [236.0, 244.0, 250.0];
const DARK: [f64; 3] = [0.0, 46.0, 98.0];
/// Letters on pale and on dark cells, which a dark page does not exchange.
const LETTERS: [&str; 2] = ["#101418", "#FEFEFE"];
/// What surrounds cases that were held out.
pub(crate) const OUTLINE: &str = "#D55E00";

/// A table of shares.
#[derive(Debug, Default)]
pub(crate) struct HeatMap<'a> {
    pub(crate) title: &'a str,
    /// What rows and columns are; may be empty.
    pub(crate) axes: [&'a str; 2],
    pub(crate) rows: &'a [&'a str],
    pub(crate) columns: &'a [&'a str],
    pub(crate) cells: &'a [HeatCell],
}

/// A cell of the table.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct HeatCell {
    /// Numbers of the row and the column.
    pub(crate) place: [usize; 2],
    /// From 0 to 1; not a number where it is not known.
    pub(crate) share: f64,
    /// What stands below it.
    pub(crate) below: String,
    pub(crate) outlined: bool,
}

/// The colour of a share.
pub(crate) fn shade(share: f64) -> String {
    let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 };
    let [red, green, blue] = [0, 1, 2].map(|i| (PALE[i] + share * (DARK[i] - PALE[i])).round() as u8);
    format!("#{red:02X}{green:02X}{blue:02X}")
}

/// A share in percent, with as many digits as it needs to stand in a cell.
pub(crate) fn percent(share: f64) -> String {
    if share.is_finite() { format!("{:.0} %", 100.0 * share) } else { "–".into() }
}

/// The beginning of a label that fits.
pub(crate) fn shown(label: &str) -> String {
    match label.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", label.get(..end).unwrap_or_default()),
        None => label.into(),
    }
}

/// About how wide a label is.
pub(crate) fn width(label: &str) -> f64 {
    LETTER * shown(label).chars().count() as f64
}

/// Coordinates are short in the file.
fn at(x: f64) -> String {
    format!("{}", (10.0 * x).round() / 10.0)
}

/// Where everything stands.
struct Places {
    left: f64,
    top: f64,
    column: f64,
    /// Whether the names of the columns lie at an angle, because they are wider than the columns.
    slanted: bool,
    size: [f64; 2],
}

impl HeatMap<'_> {
    /// The picture; text in it is text, so that no font is needed. None of a table that is too large to be read as one.
    pub(crate) fn draw(&self) -> Option<String> {
        let [rows, columns] = [self.rows.len(), self.columns.len()];
        if rows.max(columns) > LARGEST || rows.min(columns) == 0 {
            return None;
        }
        let places = self.places();
        let [width, height] = places.size;
        let picture = html! {
            svg xmlns="http://www.w3.org/2000/svg" viewBox=(format!("0 0 {} {}", at(width), at(height)))
                width=(at(width)) height=(at(height)) font-family=(FONT.0) font-size="16" {
                rect width="100%" height="100%" fill=(PAPER) {}
                text x=(MARGIN) y="28" font-size="20" fill=(INK) { (self.title) }
                (self.labels(&places))
                @for cell in self.cells { (cell.draw(&places)) }
                (self.scale(&places))
            }
        };
        Some(picture.into_string() + "\n")
    }

    fn places(&self) -> Places {
        let longest = |labels: &[&str]| labels.iter().map(|label| width(label)).fold(0.0, f64::max);
        let (rows, columns) = (longest(self.rows), longest(self.columns));
        let left = f64::from(MARGIN) + rows.max(width(self.axes[0])) + 12.0;
        let count = self.columns.len() as f64;
        let column = ((WIDTH - left - f64::from(MARGIN)) / count).clamp(COLUMN[0], COLUMN[1]);
        let slanted = columns + 8.0 > column;
        // At 45 degrees the last label reaches beyond the map.
        let (up, beyond) = if slanted { (0.71 * columns + 14.0, 0.71 * columns) } else { (26.0, 0.0) };
        let axis = if self.axes[1].is_empty() { 0.0 } else { 24.0 };
        let top = HEAD + axis + up;
        let right = left + column * count + beyond.max(f64::from(MARGIN));
        let size = [right.max(WIDTH), top + ROW * self.rows.len() as f64 + SCALE];
        Places { left, top, column, slanted, size }
    }

    /// The names of rows, columns and axes.
    fn labels(&self, places: &Places) -> Markup {
        let Places { left, top, column, slanted, .. } = *places;
        let [row_axis, column_axis] = self.axes;
        html! {
            @if !column_axis.is_empty() {
                text x=(at(left)) y=(at(HEAD + 14.0)) fill=(INK) font-style="italic" { (shown(column_axis)) }
            }
            @if !row_axis.is_empty() {
                text x=(MARGIN) y=(at(top - 10.0)) fill=(INK) font-style="italic" { (shown(row_axis)) }
            }
            @for (number, label) in self.columns.iter().enumerate() {
                @let x = left + column * (number as f64 + 0.5);
                @if slanted {
                    text transform=(format!("translate({} {}) rotate(-45)", at(x), at(top - 8.0))) fill=(INK) {
                        title { (label) } (shown(label))
                    }
                } @else {
                    text x=(at(x)) y=(at(top - 10.0)) text-anchor="middle" fill=(INK) { title { (label) } (shown(label)) }
                }
            }
            @for (number, label) in self.rows.iter().enumerate() {
                text x=(at(left - 10.0)) y=(at(top + ROW * (number as f64 + 0.5) + 5.5)) text-anchor="end" fill=(INK) {
                    title { (label) } (shown(label))
                }
            }
        }
    }

    /// What the colours mean, and the outline.
    fn scale(&self, places: &Places) -> Markup {
        const STEPS: usize = 10;
        let y = places.size[1] - SCALE + 22.0;
        let x = places.left + 42.0;
        let text = y + 13.0;
        html! {
            text x=(at(x - 8.0)) y=(at(text)) text-anchor="end" fill=(INK) font-size="14" { "0 %" }
            @for step in 0..=STEPS {
                rect x=(at(x + 10.0 * step as f64)) y=(at(y)) width="10.2" height="16"
                    fill=(shade(step as f64 / STEPS as f64)) {}
            }
            @let end = x + 10.0 * (STEPS + 1) as f64;
            text x=(at(end + 8.0)) y=(at(text)) fill=(INK) font-size="14" { "100 %" }
            @if self.cells.iter().any(|cell| cell.outlined) {
                rect x=(at(end + 76.0)) y=(at(y - 1.0)) width="24" height="18" fill="none" stroke=(OUTLINE)
                    stroke-width="3" stroke-dasharray="6 3" {}
                text x=(at(end + 108.0)) y=(at(text)) fill=(INK) font-size="14" { "held out" }
            }
        }
    }
}

impl HeatCell {
    fn draw(&self, places: &Places) -> Markup {
        let Places { left, top, column, .. } = *places;
        let [row, place] = self.place.map(|place| place as f64);
        let (x, y, middle) = (left + column * place, top + ROW * row, left + column * (place + 0.5));
        let letters = LETTERS[usize::from(self.share > 0.5)];
        html! {
            rect x=(at(x + 1.0)) y=(at(y + 1.0)) width=(at(column - 2.0)) height=(at(ROW - 2.0)) fill=(shade(self.share)) {}
            @if self.outlined {
                rect x=(at(x + 3.0)) y=(at(y + 3.0)) width=(at(column - 6.0)) height=(at(ROW - 6.0)) fill="none"
                    stroke=(OUTLINE) stroke-width="3.5" stroke-dasharray="8 3" {}
            }
            @let above = if self.below.is_empty() { 28.5 } else { 22.0 };
            text x=(at(middle)) y=(at(y + above)) text-anchor="middle" fill=(letters) { (percent(self.share)) }
            text x=(at(middle)) y=(at(y + 37.0)) text-anchor="middle" font-size="11" fill=(letters) { (self.below) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cell(place: [usize; 2], share: f64, outlined: bool) -> HeatCell {
        HeatCell { place, share, below: "4 of 8".into(), outlined }
    }

    #[test]
    fn a_cell_stands_in_its_row_and_column_and_is_darker_where_its_share_is_larger() {
        let cells = [cell([0, 0], 0.0, false), cell([0, 1], 0.5, false), cell([1, 1], 1.0, true)];
        let axes = ["action", "object"];
        let map =
            HeatMap { title: "a < b", axes, rows: &["TOUCH", "<MOVE>"], columns: &["red", "green"], cells: &cells };
        let svg = map.draw().unwrap();
        for piece in ["a &lt; b", "&lt;MOVE&gt;", "action", "object", "0 %", "50 %", "100 %", "4 of 8", "held out"] {
            assert!(svg.contains(piece), "no {piece} in {svg}");
        }
        assert!(!svg.contains("<MOVE>") && svg.contains("viewBox=\"0 0 640 "), "{svg}");
        let place = |color: &str| {
            let rect =
                svg.split("<rect ").find(|rect| rect.contains(&format!("fill=\"{color}\"")) && !rect.contains("10.2"));
            let number = |key: &str| -> f64 {
                let (_, rest) = rect.unwrap().split_once(&format!("{key}=\"")).unwrap();
                rest.split_once('"').unwrap().0.parse().unwrap()
            };
            [number("x"), number("y")]
        };
        let [none, half, all] = [0.0, 0.5, 1.0].map(|share| place(&shade(share)));
        assert!(none[0] < half[0] && none[1] == half[1] && half[0] == all[0] && half[1] < all[1]);
        assert_eq!(svg.matches("stroke-dasharray=\"8 3\"").count(), 1);
        let light = |share| u8::from_str_radix(&shade(share)[3..5], 16).unwrap();
        assert!((0..10).all(|step| light(f64::from(step) / 10.0) > light(f64::from(step + 1) / 10.0)));
    }

    #[test]
    fn what_cannot_be_read_is_not_drawn() {
        let many: Vec<String> = (0..101).map(|row| row.to_string()).collect();
        let many: Vec<&str> = many.iter().map(String::as_str).collect();
        assert_eq!(HeatMap { rows: &many, columns: &["a"], ..HeatMap::default() }.draw(), None);
        assert_eq!(HeatMap { rows: &["a"], ..HeatMap::default() }.draw(), None);
        let cells = [cell([0, 0], f64::NAN, false)];
        let (rows, columns) = (&many[..100], ["a label of more letters than are ever shown"; 40]);
        let svg = HeatMap { rows, columns: &columns, cells: &cells, ..HeatMap::default() }.draw().unwrap();
        assert!(
            svg.contains("–") && svg.contains("rotate(-45)") && svg.contains("a label of more letters than…"),
            "{svg}"
        );
        assert!(!svg.contains("held out") && !svg.contains("NaN"));
    }
}
