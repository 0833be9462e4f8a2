//! A study in one file: archived, unpacked, reported, replayed and evolved again with the same bytes.

use std::fs;
use std::path::{Path, PathBuf};

use crate::tool::{content, ok, own, results, say, scratch};

const FILE: &str = r#"
experiment = "cart"
replications = 3

[evolution]
generations = 4

[trial]
steps = 60

[grid]
condition = ["rough", "smooth"]

[test]
trials = 6
every = 2
every_trials = 4
"#;

/// The runs of the study below its folder.
fn runs() -> Vec<String> {
    let run = |condition: &str, seed: u32| format!("condition={condition}/cart-{condition}-{seed}");
    ["rough", "smooth"].iter().flat_map(|condition| (1..=3).map(move |seed| run(condition, seed))).collect()
}

/// The shares of success of three champions in a kind of trial, in rising order.
fn shares(root: &Path, condition: &str, kind: usize) -> [f64; 3] {
    let mut shares = [1, 2, 3].map(|seed| {
        let test = root.join(format!("condition={condition}/cart-{condition}-{seed}/test.csv"));
        let text = fs::read_to_string(test).expect("the test");
        let fields = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
        let own = fields.filter(|fields| fields[1] == kind.to_string());
        let own: Vec<bool> = own.map(|fields| fields[3] == "true").collect();
        assert_eq!(own.len(), 2);
        own.iter().filter(|success| **success).count() as f64 / 2.0
    });
    shares.sort_by(f64::total_cmp);
    shares
}

/// Rows of a report about the success in each kind of trial.
fn rows_of_kinds(root: &Path) -> Vec<String> {
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    let cell = |[low, middle, high]: [f64; 3]| {
        let quartiles = [low, high].map(|end| percent(0.5 * end + 0.5 * middle));
        format!("{} ({} to {})", percent(middle), quartiles[0], quartiles[1])
    };
    let condition = |name: &&str| {
        let cells = [0, 1, 2].map(|kind| cell(shares(root, name, kind)));
        format!("| {name} | 3 | {} |\n", cells.join(" | "))
    };
    // Pairs in which the first is the larger, and half of the ties.
    let comparison = |kind: usize| {
        let second = shares(root, "smooth", kind);
        let pair = |a: f64, b: f64| if a > b { 1.0 } else { f64::from(u8::from(a == b)) / 2.0 };
        let u: f64 = shares(root, "rough", kind).iter().flat_map(|&a| second.map(|b| pair(a, b))).sum();
        format!("| rough | smooth | trial {kind} | {u:?} | {:.3} | ", u / 9.0)
    };
    ["rough", "smooth"].iter().map(condition).chain([0, 1, 2].map(comparison)).collect()
}

/// Visible files below a folder, named from there. Locks are hidden.
fn files(root: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let named = content(root).into_iter().map(|(path, bytes)| (path.strip_prefix(root).expect("within").into(), bytes));
    let hidden = |path: &PathBuf| path.file_name().expect("a name").to_string_lossy().starts_with('.');
    named.filter(|(path, _)| !hidden(path)).collect()
}

/// Evolves and archives the study in a new folder.
fn study(test: &str) -> PathBuf {
    let here = scratch(test);
    fs::create_dir(here.join("first")).expect("a folder");
    fs::write(here.join("first/study.toml"), FILE).expect("the file");
    let said = ok(own(), &here.join("first"), "sweep study.toml --archive study.farsa");
    let bytes = fs::metadata(here.join("first/study.farsa")).expect("the archive").len();
    assert!(said.ends_with(&format!("study.farsa: 6 runs in {bytes} bytes\n")), "{said}");
    here
}

#[test]
fn an_archive_gives_back_the_runs_of_a_study() {
    let here = study("archive-runs");
    let (first, second) = (here.join("first"), here.join("second"));
    fs::create_dir(&second).expect("a folder");
    let said = ok(own(), &second, "merge ../first/study.farsa --out runs/study");
    assert_eq!(said, "6 runs, 6 copied\n");
    let [original, copy] = [&first, &second].map(|folder| files(&folder.join("runs/study")));
    let names = |files: &[(PathBuf, Vec<u8>)]| files.iter().map(|(path, _)| path.clone()).collect::<Vec<_>>();
    assert_eq!(names(&copy), names(&original));
    for ((path, bytes), (_, expected)) in copy.iter().zip(&original) {
        assert!(bytes == expected, "{}", path.display());
    }
    // All of them again, and the table of an archive without copies.
    assert_eq!(
        ok(own(), &second, "merge ../first/study.farsa --out runs/study"),
        "6 runs, 0 copied, 6 there already\n"
    );
    let table = |folder: &Path, source: &str| ok(own(), folder, &format!("merge {source}"));
    let archived = table(&first, "study.farsa");
    assert_eq!(archived.replace("study.farsa/", "runs/study/"), table(&first, "runs/study"));
    // The report, and a trial of a champion and of an earlier individual.
    let report = format!("report runs/study/{} --html page.html --md page.md", runs().join(" runs/study/"));
    ok(own(), &first, &report);
    let said = ok(own(), &second, "sweep ../first/study.toml --list --html page.html --md page.md");
    assert!(said.contains("\n6 runs: page.html, page.md, page-fitness-1.svg, "), "{said}");
    let md = fs::read_to_string(first.join("page.md")).expect("the page");
    for row in rows_of_kinds(&first.join("runs/study")) {
        assert!(md.contains(&row), "no {row:?} in {md}");
    }
    assert!(md.contains("Fitness of the best on fresh starts, tested every 2 generations in 4 trials"), "{md}");
    let pages = fs::read_dir(&first).expect("it").map(|entry| entry.expect("an entry").file_name());
    let pages: Vec<_> = pages.filter(|name| name.to_string_lossy().starts_with("page")).collect();
    assert!(pages.len() >= 6, "{pages:?}");
    for name in pages {
        assert!(fs::read(first.join(&name)).expect("it") == fs::read(second.join(&name)).expect("it"), "{name:?}");
    }
    for which in ["--trial best", "--generation 2 --individual 5 --trial 0"] {
        let replay = |folder: &Path| ok(own(), folder, &format!("replay runs/study/{} {which}", runs()[4]));
        assert_eq!(replay(&first), replay(&second), "{which}");
    }
    // Nothing is left to evolve or to test.
    let before = content(&second.join("runs"));
    fs::write(second.join("study.toml"), FILE).expect("the file");
    let [one, two] = [&first, &second].map(|folder| ok(own(), folder, "sweep study.toml"));
    assert_eq!((one, content(&second.join("runs"))), (two, before));
}

#[test]
fn a_run_evolved_again_has_the_archived_bytes() {
    let here = study("archive-again");
    ok(own(), &here, "merge first/study.farsa --out archived");
    for run in [&runs()[0], &runs()[5]] {
        ok(own(), &here, &format!("run --config archived/{run}/config.toml --out again/{run} --threads 1 -q"));
        assert_eq!(results(&here.join("again").join(run)), results(&here.join("archived").join(run)), "{run}");
    }
    let said = ok(own(), &here, "merge first/study.farsa again --csv all.csv");
    let twins = [0, 5].map(|index| {
        let run = &runs()[index];
        format!("again/{run}: the same run as first/study.farsa/{run}\n")
    });
    assert_eq!(said, format!("6 runs\n{}", twins.concat()));
}

#[test]
fn an_archive_grows_and_replaces_nothing_else() {
    let here = scratch("archive-grows");
    fs::write(here.join("study.toml"), FILE).expect("the file");
    let said = say(own(), &here, "sweep study.toml --list --archive study.farsa");
    assert_eq!((said.code, said.out.as_str()), (Some(2), ""), "{said:?}");
    assert!(said.err.contains("study.farsa: no run is finished"), "{said:?}");
    let said = say(own(), &here, "sweep study.toml --list --md page.md");
    assert!(said.code == Some(2) && said.err.contains("there is no report, because no run is finished"), "{said:?}");
    let said = ok(own(), &here, "sweep study.toml --replication 2 --archive study.farsa -q --json");
    let json: serde_json::Value = serde_json::from_str(&said).expect("JSON");
    let bytes = fs::metadata(here.join("study.farsa")).expect("it").len();
    assert_eq!(json["archive"], serde_json::json!({ "file": "study.farsa", "runs": 2, "bytes": bytes }));
    // Fewer and other runs, before anything is evolved.
    let before = content(&here);
    for (arguments, words) in [
        ("sweep study.toml --replication 3 --archive study.farsa", "which is not among these"),
        ("sweep study.toml --md study.toml", "study.toml: there is one already"),
        ("sweep study.toml --archive study.toml", "study.toml: there is one already, which is no archive"),
    ] {
        let said = say(own(), &here, arguments);
        assert!(said.code == Some(2) && said.err.contains(words), "{said:?}");
        assert_eq!(content(&here), before, "{arguments}");
    }
    ok(own(), &here, "sweep study.toml --archive study.farsa -q");
    let whole = fs::read(here.join("study.farsa")).expect("the archive");
    ok(own(), &here, "sweep study.toml --list --archive study.farsa -q");
    assert!(fs::read(here.join("study.farsa")).expect("the archive") == whole);
    // A file of the table of tests that was lost is made again.
    let tests = here.join("runs/study").join(&runs()[1]).join("test-generations.csv");
    let text = fs::read_to_string(&tests).expect("the tests");
    let generations: Vec<&str> = text.lines().skip(1).map(|line| line.split(',').next().expect("a field")).collect();
    assert_eq!((generations, text.lines().nth(1).expect("a line").split(',').nth(2)), (vec!["0", "2"], Some("4")));
    let last: Vec<&str> = text.lines().nth(2).expect("a line").split(',').collect();
    let single = format!("test runs/study/{} --generation 2 --trials 4 --json", runs()[1]);
    let json: serde_json::Value = serde_json::from_str(&ok(own(), &here, &single)).expect("JSON");
    assert_eq!([last[1], last[4]], ["individual", "successes"].map(|key| json[key].to_string()));
    assert_eq!(last[5].parse::<f64>().expect("a number"), json["fitness"].as_f64().expect("a number"));
    fs::remove_file(&tests).expect("the tests");
    ok(own(), &here, "sweep study.toml -q");
    assert_eq!(fs::read_to_string(&tests).expect("the tests"), text);
}

#[test]
fn a_damaged_archive_is_refused_with_its_place() {
    let here = study("archive-damaged");
    let bytes = fs::read(here.join("first/study.farsa")).expect("the archive");
    let flipped = |at: usize| {
        let mut bytes = bytes.clone();
        bytes[at] ^= 1;
        bytes
    };
    for (bad, words) in [
        (flipped(0), "bad.farsa: is not a set of archived runs of FARSA"),
        (flipped(bytes.len() / 2), "bad.farsa: altered"),
        (bytes[..bytes.len() / 2].to_vec(), "bad.farsa: truncated: "),
        (Vec::new(), "bad.farsa: truncated: 0 bytes"),
    ] {
        fs::write(here.join("bad.farsa"), bad).expect("the file");
        let said = say(own(), &here, "merge bad.farsa --out out --csv all.csv");
        assert!(said.code == Some(1) && said.err.contains(words), "no {words:?} in {said:?}");
        assert!(!here.join("out").exists() && !here.join("all.csv").exists());
    }
    let said = say(own(), &here, "report first/study.farsa --md page.md");
    let words = "first/study.farsa: is an archive. `merge --out DIR` restores its runs";
    assert!(said.code == Some(2) && said.err.contains(words), "{said:?}");
}
