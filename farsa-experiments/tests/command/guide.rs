//! Guides whose commands and programs are run.

use std::fs;
use std::path::Path;

use crate::tool::{Running, Said, command, farsa, scratch};

/// The fenced blocks of a language in a text.
fn blocks<'t>(text: &'t str, language: &str) -> Vec<&'t str> {
    let fence = format!("```{language}\n");
    let pieces = text.split(fence.as_str()).skip(1);
    pieces.filter_map(|piece| piece.split_once("```").map(|(block, _)| block)).collect()
}

/// The words of a command, as a shell divides them.
fn words(line: &str) -> Vec<&str> {
    let quoted = line.split('"').enumerate();
    let words = quoted.flat_map(|(number, piece)| {
        if number % 2 == 1 { vec![piece] } else { piece.split(' ').filter(|word| !word.is_empty()).collect() }
    });
    words.collect()
}

#[test]
fn protocols_print_what_their_guide_shows() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let guide = fs::read_to_string(root.join("docs/guide/protocols.md")).expect("the guide");
    let here = scratch("protocols-guide");
    let shown = blocks(&guide, "text").into_iter().filter(|block| block.starts_with("lesion"));
    let shown: Vec<&str> = shown.collect();
    let printed = blocks(&guide, "sh").into_iter().map(|commands| {
        let mut printed = String::new();
        for line in commands.lines() {
            let arguments = words(line.strip_prefix("farsa ").expect("a command of ours"));
            // The reader is in the clone. Files written here belong in other places.
            for file in arguments.iter().filter(|word| root.join(word).is_file()) {
                let copy = here.join(file);
                fs::create_dir_all(copy.parent().expect("a folder")).expect("a folder");
                fs::copy(root.join(file), copy).expect("a copy");
            }
            let said: Said = Running::start(&mut command(farsa(), &here, &arguments)).end();
            assert_eq!(said.code, Some(0), "{line}: {said:?}");
            printed = said.out;
        }
        printed
    });
    assert_eq!(printed.collect::<Vec<_>>(), shown);
}

fn page(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/guide").join(name);
    fs::read_to_string(path).expect("the page")
}

/// Every command of the page, with a short run. Live pages have separate tests.
#[test]
fn commands_of_the_champion_s_analysis_run() {
    let here = scratch("analysis-guide");
    let page = page("what-does-it-do.md");
    let lines: Vec<&str> = blocks(&page, "sh").into_iter().flat_map(str::lines).collect();
    assert!(lines.len() >= 10, "{lines:?}");
    for line in lines.into_iter().filter(|line| !line.starts_with("farsa live ")) {
        let mut arguments = words(line.strip_prefix("farsa ").expect("a command of ours"));
        if arguments[0] == "run" {
            arguments.extend(["--generations", "2", "--population", "8", "--set", "evolution.parents=4"]);
            arguments.extend(["--set", "episode.steps=30"]);
        }
        let said: Said = Running::start(&mut command(farsa(), &here, &arguments)).end();
        assert_eq!(said.code, Some(0), "{line}: {said:?}");
    }
    for file in ["lesion.html", "trial.csv", "end.svg", "cases.svg", "report.html"] {
        assert!(here.join(file).is_file(), "no {file}");
    }
}

/// With `FARSA_PYTHON`, any Python 3: `./ci test` brings one.
#[test]
#[ignore = "needs FARSA_PYTHON, a Python 3: ./ci test"]
fn the_guide_s_program_of_python_computes_the_network() {
    let here = scratch("python-guide");
    let python = std::env::var_os("FARSA_PYTHON").expect("FARSA_PYTHON names a Python 3");
    let page = page("python.md");
    let block = page.split("```python study.py\n").nth(1).and_then(|rest| rest.split("```").next());
    fs::write(here.join("study.py"), block.expect("the page has a program")).expect("the program");
    let folder = farsa().parent().map(Path::to_path_buf).expect("a folder");
    let before = std::env::var_os("PATH").unwrap_or_default();
    let paths = [folder].into_iter().chain(std::env::split_paths(&before));
    let mut study = command(Path::new(&python), &here, &["study.py"]);
    study.env("PATH", std::env::join_paths(paths).expect("a path"));
    let said: Said = Running::start(&mut study).end();
    assert_eq!(said.code, Some(0), "{said:?}");
    let shown = blocks(&page, "text").into_iter().find_map(|block| block.strip_prefix("$ python3 study.py\n"));
    assert_eq!(Some(said.out.as_str()), shown);
}
