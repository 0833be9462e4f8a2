//! Tables of docs/results that follow a comment with a file of docs/results/data have its figures, rounded.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;
use std::io::Read as _;
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

/// The runs of an archive, and its files with their names and runs.
type Content = (Vec<String>, Vec<(String, usize, Vec<u8>)>);

/// The condition, the seed and the table of trials of each tested run in an archive.
fn tests_of(archive: &Path) -> Vec<(String, u32, Vec<Vec<String>>)> {
    let bytes = fs::read(archive).expect("an archive");
    // Kind, version and length before the content, a checksum after it: docs/formats.md.
    let packed: Vec<u8> = postcard::from_bytes(&bytes[20..bytes.len() - 4]).expect("compressed bytes");
    let mut content = Vec::new();
    flate2::read::DeflateDecoder::new(packed.as_slice()).read_to_end(&mut content).expect("files");
    let (runs, files): Content = postcard::from_bytes(&content).expect("runs");
    let mut tests = Vec::new();
    for (_, run, bytes) in files.iter().filter(|(name, ..)| name == "test.csv") {
        let (folder, name) = runs[*run].split_once('/').expect("a condition and a run");
        let condition = folder.trim_start_matches("condition=").to_owned();
        let seed = name.rsplit('-').next().and_then(|seed| seed.parse().ok()).expect("a seed");
        tests.push((condition, seed, rows(str::from_utf8(bytes).expect("a table"))));
    }
    tests.sort();
    tests
}

/// The columns of a table with these names.
fn columns<const N: usize>(table: &[Vec<String>], names: [&str; N]) -> [Vec<String>; N] {
    names.map(|name| {
        let column = table[0].iter().position(|other| other == name).unwrap_or_else(|| panic!("no column {name}"));
        table[1..].iter().map(|row| row[column].clone()).collect()
    })
}

const FAILURES: [&str; 4] = ["no reach", "no grasp", "clamped", "dropped"];

/// The row of a run in data/labels.csv without the fitness of its generations, as benches/failures.py counts it.
fn counted(condition: &str, seed: u32, test: &[Vec<String>]) -> String {
    let names = ["trial", "success", "phase", "lifted for 1 s", "height [cm]", "highest [cm]", "fitness"];
    let [trial, success, phase, lifted, height, highest, fitness] = columns(test, names);
    let number = |cell: &String| cell.parse::<f64>().expect("a number");
    let (mut failures, mut starts) = ([0; 4], [0; 4]);
    for k in 0..trial.len() {
        if success[k] == "true" {
            starts[trial[k].parse::<usize>().expect("a trial")] += 1;
        } else if number(&highest[k]) >= 5.0 {
            failures[3] += 1;
        } else if phase[k] == "reach" {
            failures[0] += 1;
        } else {
            failures[if lifted[k] == "true" || number(&height[k]) > 2.55 { 2 } else { 1 }] += 1;
        }
    }
    let most = failures.iter().copied().max().filter(|most| *most > 0);
    let most = most.and_then(|most| failures.iter().position(|n| *n == most)).map_or("", |k| FAILURES[k]);
    let listed = |counts: [u32; 4]| counts.map(|n| n.to_string()).join(",");
    let held = lifted.iter().filter(|lifted| *lifted == "true").count();
    let mean = fitness.iter().map(number).sum::<f64>() / fitness.len() as f64;
    let successes: u32 = starts.iter().sum();
    format!("{condition},{seed},{successes},{},{most},{},{held},{mean:.3},", listed(failures), listed(starts))
}

/// The exact two-sided Mann-Whitney test, with ties, over all divisions of the values.
fn mann_whitney(first: &[f64], second: &[f64]) -> f64 {
    let values = [first, second].concat();
    // Twice the mean ranks are whole.
    let rank = |x: &f64| values.iter().map(|y| usize::from(y < x) + usize::from(y <= x)).sum::<usize>() + 1;
    let ranks: Vec<usize> = values.iter().map(rank).collect();
    let (n, most) = (first.len(), ranks.iter().sum::<usize>());
    let mut ways = vec![vec![0.0_f64; most + 1]; n + 1];
    ways[0][0] = 1.0;
    for rank in &ranks {
        for taken in (0..n).rev() {
            for sum in *rank..=most {
                ways[taken + 1][sum] += ways[taken][sum - rank];
            }
        }
    }
    let center = n * (values.len() + 1);
    let least = ranks[..n].iter().sum::<usize>().abs_diff(center);
    let extreme = ways[n].iter().enumerate().filter(|(sum, _)| sum.abs_diff(center) >= least);
    extreme.map(|(_, ways)| ways).sum::<f64>() / ways[n].iter().sum::<f64>()
}

/// Fisher's exact two-sided test of two numbers out of the same n.
fn fisher([a, b]: [usize; 2], n: usize) -> f64 {
    let choose = |k: usize| (0..k).map(|j| (n - j) as f64 / (k - j) as f64).product::<f64>();
    let sum = a + b;
    let tables: Vec<f64> = (sum.saturating_sub(n)..=n.min(sum)).map(|k| choose(k) * choose(sum - k)).collect();
    let own = choose(a) * choose(b) * (1.0 + 1e-9);
    tables.iter().filter(|table| **table <= own).sum::<f64>() / tables.iter().sum::<f64>()
}

/// Median and quartiles, by linear interpolation.
fn quartiles(values: &[f64]) -> String {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let [low, middle, high] = [0.25, 0.5, 0.75].map(|share| {
        let place = share * (sorted.len() - 1) as f64;
        let (below, weight) = (sorted[place.floor() as usize], place.fract());
        below + weight * (sorted[place.ceil() as usize] - below)
    });
    format!("{middle:.4} ({low:.4} to {high:.4})")
}

/// A number out of n with Wilson's 95 % interval of its share.
fn wilson(k: usize, n: usize) -> String {
    let (p, n, z) = (k as f64 / n as f64, n as f64, 1.959_963_985_f64);
    let (middle, scale) = (p + z * z / (2.0 * n), 1.0 + z * z / n);
    let half = z * (p * (1.0 - p) / n + z * z / (4.0 * n * n)).sqrt();
    format!("{k} ({:.4} to {:.4})", (middle - half) / scale, (middle + half) / scale)
}

/// The comparisons of studies/labels.toml from data/labels.csv.
fn comparisons(table: &[Vec<String>]) -> String {
    let [condition] = columns(table, ["condition"]);
    let of = |name: &str, wanted: &str| -> Vec<f64> {
        let [cells] = columns(table, [name]);
        let cells = cells.iter().zip(&condition).filter(|(_, condition)| *condition == wanted);
        cells.map(|(cell, _)| cell.parse().expect("a number")).collect()
    };
    let [first, second] = ["labels", "no-labels"].map(|condition| of("success", condition));
    let successful = [&first, &second].map(|runs| runs.iter().filter(|successes| **successes >= 100.0).count());
    let [labels, none] = successful.map(|k| wilson(k, first.len()));
    let mut text = format!("of {} runs,labels,no-labels,p\n", first.len());
    let _ = writeln!(text, "successful runs (95 % interval),{labels},{none},{:.5}", fisher(successful, first.len()));
    for (row, name, scale) in [
        ("share of successful trials", "success", 200.0),
        ("start 1", "start 1", 50.0),
        ("start 2", "start 2", 50.0),
        ("start 3", "start 3", 50.0),
        ("start 4", "start 4", 50.0),
        ("best fitness", "best", 1.0),
        ("mean fitness", "mean", 1.0),
        ("unplanned: share lifted for 1 s", "lifted for 1 s", 200.0),
        ("unplanned: fitness of fresh trials", "fitness", 1.0),
    ] {
        let scaled = |wanted| of(name, wanted).iter().map(|x| x / scale).collect::<Vec<f64>>();
        let [first, second] = ["labels", "no-labels"].map(scaled);
        let p = mann_whitney(&first, &second);
        let _ = writeln!(text, "{row},{},{},{p:.5}", quartiles(&first), quartiles(&second));
    }
    text
}

/// The failed trials of both conditions, and the champions by their most frequent failure.
fn failures(table: &[Vec<String>]) -> String {
    let mut text = format!("case,{}\n", FAILURES.join(","));
    for wanted in ["labels", "no-labels"] {
        let chosen = |row: &&Vec<String>| row[0] == wanted;
        let rows = [table[..1].to_vec(), table[1..].iter().filter(chosen).cloned().collect()].concat();
        let trials = columns(&rows, FAILURES).map(|cells| cells.iter().map(|n| n.parse().unwrap_or(0)).sum::<u32>());
        let [most] = columns(&rows, ["most frequent failure"]);
        let champions = FAILURES.map(|name| most.iter().filter(|other| *other == name).count());
        let _ = writeln!(text, "{wanted}: trials,{}", trials.map(|n| n.to_string()).join(","));
        let _ = writeln!(text, "{wanted}: champions,{}", champions.map(|n| n.to_string()).join(","));
    }
    text
}

#[test]
fn figures_of_labels_follow_from_the_archive() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/results/data");
    let read = |name: &str| fs::read_to_string(data.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
    let runs = read("labels.csv");
    let tests = tests_of(&data.join("labels.farsa"));
    assert_eq!((tests.len(), runs.lines().count()), (40, 41));
    for ((condition, seed, test), row) in tests.iter().zip(runs.lines().skip(1)) {
        assert_eq!(test.len(), 201);
        let counts = counted(condition, *seed, test);
        assert!(row.starts_with(&counts), "{counts}\n{row}");
    }
    let table = rows(&runs);
    for (name, text) in [("labels-summary.csv", comparisons(&table)), ("labels-failures.csv", failures(&table))] {
        assert!(read(name) == text, "{name} should be\n{text}");
    }
}

#[test]
fn statistics_are_those_of_scipy() {
    assert!((fisher([18, 8], 20) - 0.002_199_64).abs() < 1e-8 && (fisher([6, 0], 20) - 0.020_2).abs() < 1e-4);
    assert!((mann_whitney(&[1.0, 2.0, 3.0], &[4.0, 5.0, 6.0]) - 0.1).abs() < 1e-12);
    // Three of 20 divisions at either end, because three values are equal.
    assert!((mann_whitney(&[1.0, 2.0, 2.0], &[2.0, 5.0, 6.0]) - 0.3).abs() < 1e-12);
    assert_eq!(quartiles(&[4.0, 1.0, 2.0, 3.0]), "2.5000 (1.7500 to 3.2500)");
    assert_eq!(wilson(8, 20), "8 (0.2188 to 0.6134)");
}
