//! A page of headings, texts, tables and figures, as HTML or Markdown.

use std::fmt::Write as _;

use maud::{DOCTYPE, Markup, PreEscaped, html};

use crate::figures::svg::{GRID, INK, PAPER};

/// A page.
#[derive(Debug, Default)]
pub(crate) struct Page {
    pub(crate) title: String,
    pub(crate) blocks: Vec<Block>,
}

/// A block of a page.
#[derive(Debug)]
pub(crate) enum Block {
    Heading(String),
    Subheading(String),
    Text(String),
    Table(Table),
    /// Figures, in rows where there is room.
    Figures(Vec<Figure>),
    /// Commands for a shell.
    Commands(Vec<String>),
    /// Details, closed where that is possible.
    Fold(String, Vec<Block>),
}

/// Cells in rows below a head of the same length.
#[derive(Debug, Default)]
pub(crate) struct Table {
    pub(crate) head: Vec<String>,
    pub(crate) rows: Vec<Vec<String>>,
}

/// A picture as HTML: an `svg` element, or an `img` that holds its data.
#[derive(Debug)]
pub(crate) struct Figure {
    /// Kind of the figure, for the name of its file.
    pub(crate) kind: &'static str,
    pub(crate) picture: String,
    pub(crate) caption: String,
}

impl Table {
    pub(crate) fn new(head: &[&str]) -> Self {
        Self { head: head.iter().map(|&name| name.to_owned()).collect(), rows: Vec::new() }
    }

    /// Returns true for a column of numbers, which are aligned to the right.
    fn is_numeric(&self, column: usize) -> bool {
        // Dates and units such as 1/s start with a digit, too.
        let number = |cell: &str| {
            let word = cell.split(' ').next().unwrap_or_default().trim_start_matches('-').trim_end_matches(',');
            word.starts_with(|c: char| c.is_ascii_digit()) && !word.contains([':', '/'])
        };
        let cells = || self.rows.iter().filter_map(|row| row.get(column)).map(String::as_str);
        cells().any(number) && cells().all(|cell| ["", "–"].contains(&cell) || number(cell))
    }
}

impl Page {
    /// Writes the page as one HTML document without external files.
    pub(crate) fn html(&self) -> String {
        let style = include_str!("report.css").replace("PAPER", PAPER).replace("INK", INK).replace("GRID", GRID);
        let page = html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    meta name="color-scheme" content="light dark";
                    title { (self.title) }
                    style { (PreEscaped(style)) }
                }
                body { main { h1 { (self.title) } (as_html(&self.blocks)) } }
            }
        };
        page.into_string() + "\n"
    }

    /// Returns the page as Markdown with the SVG figures for separate files.
    ///
    /// Other pictures are omitted. `stem` is the file name of the page without extension.
    pub(crate) fn markdown(&self, stem: &str) -> (String, Vec<(String, String)>) {
        let mut text = format!("# {}\n", plain(&self.title));
        let mut pictures = Vec::new();
        as_markdown(&self.blocks, stem, &mut text, &mut pictures);
        (text, pictures)
    }
}

fn as_html(blocks: &[Block]) -> Markup {
    html! {
        @for block in blocks {
            @match block {
                Block::Heading(text) => h2 { (text) },
                Block::Subheading(text) => h3 { (text) },
                Block::Text(text) => p { (text) },
                Block::Table(table) => div.scroll tabindex="0" {
                    table {
                        thead { tr { @for (column, name) in table.head.iter().enumerate() {
                            th scope="col" class=[table.is_numeric(column).then_some("number")] { (name) }
                        } } }
                        tbody { @for row in &table.rows { tr { @for (column, cell) in row.iter().enumerate() {
                            td class=[table.is_numeric(column).then_some("number")] { (cell) }
                        } } } }
                    }
                },
                Block::Figures(figures) => div.figures {
                    @for figure in figures {
                        figure { (PreEscaped(&figure.picture)) figcaption { (figure.caption) } }
                    }
                },
                Block::Commands(lines) => pre tabindex="0" { code { (lines.join("\n")) } },
                Block::Fold(title, inside) => details { summary { (title) } (as_html(inside)) },
            }
        }
    }
}

fn as_markdown(blocks: &[Block], stem: &str, text: &mut String, pictures: &mut Vec<(String, String)>) {
    for block in blocks {
        text.push('\n');
        // Writing to a string cannot fail.
        let _ = match block {
            Block::Heading(title) => writeln!(text, "## {}", plain(title)),
            Block::Subheading(title) => writeln!(text, "### {}", plain(title)),
            Block::Text(words) => writeln!(text, "{}", plain(words)),
            Block::Table(table) => {
                let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
                text.push_str(&line(table.head.iter().map(|cell| plain(cell)).collect()));
                let rules = (0..table.head.len()).map(|column| if table.is_numeric(column) { "--:" } else { "---" });
                text.push_str(&line(rules.map(str::to_owned).collect()));
                for row in &table.rows {
                    text.push_str(&line(row.iter().map(|cell| plain(cell)).collect()));
                }
                Ok(())
            }
            Block::Figures(figures) => {
                for figure in figures.iter().filter(|figure| figure.picture.trim_start().starts_with("<svg")) {
                    let start = format!("{stem}-{}-", figure.kind);
                    let number = pictures.iter().filter(|(name, _)| name.starts_with(&start)).count() + 1;
                    let name = format!("{start}{number}.svg");
                    let _ = writeln!(text, "![{}](<{name}>)\n\n{}\n", figure.kind, plain(&figure.caption));
                    pictures.push((name, figure.picture.clone()));
                }
                Ok(())
            }
            Block::Commands(lines) => writeln!(text, "```sh\n{}\n```", lines.join("\n")),
            Block::Fold(title, inside) => {
                let _ = writeln!(text, "### {}", plain(title));
                as_markdown(inside, stem, text, pictures);
                Ok(())
            }
        };
    }
}

/// Escapes text for Markdown.
fn plain(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    for letter in text.chars() {
        if "\\`*<|[]".contains(letter) {
            plain.push('\\');
        }
        plain.push(if letter == '\n' { ' ' } else { letter });
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_of_numbers_are_known() {
        let numeric = |cells: &[&str]| {
            let rows = cells.iter().map(|&cell| vec![cell.to_owned()]).collect();
            Table { head: vec!["x".into()], rows }.is_numeric(0)
        };
        assert!(numeric(&["1.5", "", "–"]) && numeric(&["-1", "50.0 %"]) && numeric(&["7m 22s"]) && numeric(&["4, 5"]));
        assert!(
            !numeric(&["1/s", ""]) && !numeric(&["2026-11-21T09:58:50Z"]) && !numeric(&["–"]) && !numeric(&["1", "a"])
        );
    }

    #[test]
    fn a_page_is_the_same_in_both_languages() {
        let mut table = Table::new(&["what", "how | much"]);
        table.rows.push(vec!["<script>".into(), "1.5".into()]);
        let figure = |kind| Figure { kind, picture: "<svg>1</svg>".into(), caption: "a * b".into() };
        let page = Page {
            title: "a & b".into(),
            blocks: vec![
                Block::Heading("first".into()),
                Block::Table(table),
                Block::Figures(vec![figure("fitness"), figure("champion"), figure("fitness")]),
                Block::Fold("more".into(), vec![Block::Commands(vec!["ls 'a b' > c".into()])]),
            ],
        };
        let html = page.html();
        for piece in [
            "<title>a &amp; b</title>",
            "<td>&lt;script&gt;</td><td class=\"number\">1.5</td>",
            "<figure><svg>1</svg><figcaption>a * b</figcaption></figure>",
            "<details><summary>more</summary>",
            "ls 'a b' &gt; c",
        ] {
            assert!(html.contains(piece), "no {piece} in {html}");
        }
        let (markdown, pictures) = page.markdown("my page");
        for piece in [
            "# a & b\n\n## first\n\n| what | how \\| much |\n| --- | --: |\n| \\<script> | 1.5 |\n",
            "![fitness](<my page-fitness-2.svg>)\n\na \\* b\n",
            "### more\n\n```sh\nls 'a b' > c\n```\n",
        ] {
            assert!(markdown.contains(piece), "no {piece} in {markdown}");
        }
        let names: Vec<&str> = pictures.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["my page-fitness-1.svg", "my page-champion-1.svg", "my page-fitness-2.svg"]);
    }
}
