//! Tables of docs/results that follow a comment with a file of docs/results/data have its figures, rounded.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// The rows of a CSV file, whose cells may be in quotes.
fn rows(text: &str) -> Vec<Vec<String>> {
    let cells = |line: &str| {
        let (mut cells, mut quoted) = (vec![String::new()], false);
        for c in line.chars() {
            match c {
                '"' => quoted = !quoted,
                ',' if !quoted => cells.push(String::new()),
                _ => cells.last_mut().expect("a cell").push(c),
            }
        }
        cells
    };
    text.lines().map(cells).collect()
}

/// The numbers of a cell, each with a half of its last digit, and the words between them.
fn parts(cell: &str) -> (Vec<(f64, f64)>, String) {
    let (mut numbers, mut words, mut rest) = (Vec::new(), String::new(), cell);
    while let Some(c) = rest.chars().next() {
        let digits: String = rest.chars().take_while(|c| c.is_ascii_digit() || *c == '.').collect();
        let Some(number) = digits.parse::<f64>().ok() else {
            words.push(c);
            rest = &rest[c.len_utf8()..];
            continue;
        };
        let decimals = digits.split_once('.').map_or("", |(_, decimals)| decimals);
        numbers.push((number, decimals.chars().fold(0.5, |half, _| half / 10.0)));
        words.push('#');
        rest = &rest[digits.len()..];
    }
    (numbers, words)
}

/// Returns whether a cell has the figures of another, rounded to its own decimals.
fn shows(shown: &str, exact: &str) -> bool {
    let ((shown, words), (exact, others)) = (parts(shown), parts(exact));
    let near = |((x, half), (y, _)): (&(f64, f64), &(f64, f64))| (x - y).abs() <= 1.0001 * half;
    words == others && shown.len() == exact.len() && shown.iter().zip(&exact).all(near)
}

/// The table after a line, without the line below its header.
fn table<'a>(lines: impl Iterator<Item = &'a str>) -> Vec<Vec<String>> {
    let lines = lines.skip_while(|line| line.is_empty()).take_while(|line| line.starts_with('|'));
    let cells = |line: &str| line.trim_matches('|').split('|').map(|cell| cell.trim().replace("**", "")).collect();
    lines.filter(|line| !line.starts_with("|-")).map(cells).collect()
}

fn faults(page: &str, text: &str, data: &Path, used: &mut BTreeSet<String>) -> Vec<String> {
    let mut faults = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let Some(name) = line.strip_prefix("<!-- data/").and_then(|rest| rest.strip_suffix(" -->")) else { continue };
        let place = format!("{page}:{}", number + 1);
        used.insert(name.to_owned());
        let Ok(content) = fs::read_to_string(data.join(name)) else {
            faults.push(format!("{place}: there is no data/{name}"));
            continue;
        };
        let (shown, exact) = (table(text.lines().skip(number + 1)), rows(&content));
        if shown.len() != exact.len() {
            faults.push(format!("{place}: {} rows, {} in data/{name}", shown.len(), exact.len()));
        }
        for (shown, exact) in shown.iter().zip(&exact) {
            if shown.len() != exact.len() || !shown.iter().zip(exact).all(|(shown, exact)| shows(shown, exact)) {
                faults.push(format!("{place}: {shown:?}, {exact:?} in data/{name}"));
            }
        }
    }
    faults
}

#[test]
fn tables_have_the_figures_of_their_data() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/results");
    let (mut used, mut wrong) = (BTreeSet::new(), Vec::new());
    for entry in fs::read_dir(&folder).expect("the results") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|extension| extension == "md") {
            let text = fs::read_to_string(&path).expect("a page");
            wrong.extend(faults(&path.display().to_string(), &text, &folder.join("data"), &mut used));
            // A table of every run is behind a link.
            used.extend(
                text.split("(data/").skip(1).filter_map(|rest| rest.split_once(')')).map(|(name, _)| name.to_owned()),
            );
        }
    }
    for entry in fs::read_dir(folder.join("data")).expect("the data") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        if path.extension().is_some_and(|extension| extension == "csv") && !used.contains(&name) {
            wrong.push(format!("data/{name}: no page shows it or links to it"));
        }
    }
    assert!(!used.is_empty() && wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn other_figures_are_found() {
    assert!(shows("+0.125 (+0.078 to 1)", "+0.12549 (+0.0784 to 1.2)") && shows("12 %", "12.4 %") && shows("", ""));
    assert!(!shows("0.126", "0.12549") && !shows("-0.125", "0.125") && !shows("0.1 m", "0.1") && !shows("1", ""));
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/results");
    let page = "<!-- data/none.csv -->\n\n| a |\n|---|\n";
    assert_eq!(faults("page", page, &data, &mut BTreeSet::new()), ["page:1: there is no data/none.csv"]);
    assert_eq!(table(page.lines().skip(1)), [["a"]]);
    assert_eq!(rows("a,\"b, c\"\n"), [["a", "b, c"]]);
}
