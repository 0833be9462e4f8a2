//! Tables for a terminal.

use std::fmt::Write as _;
use std::ops::Range;

/// Formats rows as lines with aligned columns, the head first. Numeric columns are aligned to the right.
pub(crate) fn text_table(rows: &[Vec<String>], right: Range<usize>) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| rows.iter().filter_map(|row| Some(row.get(column)?.chars().count())).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut text = String::new();
    for row in rows {
        let mut line = String::new();
        for (column, cell) in row.iter().enumerate() {
            let (gap, width) = (if column > 0 { "  " } else { "" }, widths[column]);
            // Writing into a string cannot fail.
            let _ = if right.contains(&column) {
                write!(line, "{gap}{cell:>width$}")
            } else {
                write!(line, "{gap}{cell:<width$}")
            };
        }
        let _ = writeln!(text, "{}", line.trim_end());
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_have_one_width() {
        let rows = [["run", "seed", "fitness"], ["a", "12", "0.5"], ["longer", "3", ""]];
        let rows = rows.map(|row| row.map(str::to_owned).to_vec());
        assert_eq!(text_table(&rows, 1..2), "run     seed  fitness\na         12  0.5\nlonger     3\n");
        assert_eq!(text_table(&[], 0..1), "");
    }
}
