//! A table of shares, darker where a share is larger: the success of each case of a test protocol.

use maud::{Markup, html};

use crate::figures::svg::{INK, MARGIN, MAX_CASES, OUTLINE, WIDTH, at, figure, note, percent, shown, title, width};

/// Least and largest width of a column.
const COLUMN: [f64; 2] = [54.0, 130.0];
/// Heights of a row, of the title and of the scale below the map.
const ROW: f64 = 46.0;
const TOP: f64 = 44.0;
const SCALE: f64 = 58.0;
/// Colors of the shares 0 and 1, which differ in lightness, too, for print.
const PALE: [f64; 3] = [236.0, 244.0, 250.0];
const DARK: [f64; 3] = [0.0, 46.0, 98.0];
/// Text on pale and on dark cells, which a dark page does not replace.
const LETTERS: [&str; 2] = ["#101418", "#FEFEFE"];

/// A table of shares.
#[derive(Debug, Default)]
pub(crate) struct HeatMap<'a> {
    pub(crate) title: &'a str,
    /// Names of rows and columns, may be empty.
    pub(crate) axes: [&'a str; 2],
    pub(crate) rows: &'a [&'a str],
    pub(crate) columns: &'a [&'a str],
    pub(crate) cells: &'a [HeatCell],
}

/// A cell of the table.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct HeatCell {
    /// Indices of the row and the column.
    pub(crate) place: [usize; 2],
    /// A share from 0 to 1, or NaN.
    pub(crate) share: f64,
    /// Text below the share.
    pub(crate) below: String,
    /// True for a held-out case.
    pub(crate) outlined: bool,
}

/// Formats the color of a share.
fn shade(share: f64) -> String {
    let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 };
    let [red, green, blue] = [0, 1, 2].map(|i| (PALE[i] + share * (DARK[i] - PALE[i])).round() as u8);
    format!("#{red:02X}{green:02X}{blue:02X}")
}

/// Places of the parts.
struct Places {
    left: f64,
    top: f64,
    column: f64,
    /// True if the names of the columns are wider than the columns and therefore slanted.
    slanted: bool,
    size: [f64; 2],
}

impl HeatMap<'_> {
    /// Draws the figure, or nothing for an empty table or one that is too large to be readable.
    pub(crate) fn draw(&self) -> Option<String> {
        let [rows, columns] = [self.rows.len(), self.columns.len()];
        if rows.max(columns) > MAX_CASES || rows.min(columns) == 0 {
            return None;
        }
        let places = self.places();
        let content = html! {
            (title(self.title)) (self.labels(&places))
            @for cell in self.cells { (cell.draw(&places)) }
            (self.scale(&places))
        };
        Some(figure(places.size, &content))
    }

    fn places(&self) -> Places {
        let longest = |labels: &[&str]| labels.iter().map(|label| width(label)).fold(0.0, f64::max);
        let (rows, columns) = (longest(self.rows), longest(self.columns));
        let left = MARGIN + rows.max(width(self.axes[0])) + 12.0;
        let count = self.columns.len() as f64;
        let column = ((WIDTH - left - MARGIN) / count).clamp(COLUMN[0], COLUMN[1]);
        let slanted = columns + 8.0 > column;
        // At 45 degrees the last label extends beyond the map.
        let (up, beyond) = if slanted { (0.71 * columns + 14.0, 0.71 * columns) } else { (26.0, 0.0) };
        let axis = if self.axes[1].is_empty() { 0.0 } else { 24.0 };
        let top = TOP + axis + up;
        let right = left + column * count + beyond.max(MARGIN);
        let size = [right.max(WIDTH), top + ROW * self.rows.len() as f64 + SCALE];
        Places { left, top, column, slanted, size }
    }

    /// Draws the names of rows, columns and axes.
    fn labels(&self, places: &Places) -> Markup {
        let Places { left, top, column, slanted, .. } = *places;
        let [row_axis, column_axis] = self.axes;
        html! {
            @if !column_axis.is_empty() {
                text x=(at(left)) y=(at(TOP + 14.0)) fill=(INK) font-style="italic" { (shown(column_axis)) }
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

    /// Draws the scale of the colors and the outline.
    fn scale(&self, places: &Places) -> Markup {
        const STEPS: usize = 10;
        let y = places.size[1] - SCALE + 22.0;
        let x = places.left + 42.0;
        let text = y + 13.0;
        html! {
            (note([x - 8.0, text], "end", INK, "0 %"))
            @for step in 0..=STEPS {
                rect x=(at(x + 10.0 * step as f64)) y=(at(y)) width="10.2" height="16"
                    fill=(shade(step as f64 / STEPS as f64)) {}
            }
            @let end = x + 10.0 * (STEPS + 1) as f64;
            (note([end + 8.0, text], "start", INK, "100 %"))
            @if self.cells.iter().any(|cell| cell.outlined) {
                rect x=(at(end + 76.0)) y=(at(y - 1.0)) width="24" height="18" fill="none" stroke=(OUTLINE)
                    stroke-width="3" stroke-dasharray="6 3" {}
                (note([end + 108.0, text], "start", INK, "held out"))
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
    fn a_cell_is_in_its_row_and_column_and_darker_for_a_larger_share() {
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
    fn unreadable_tables_are_not_drawn() {
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
