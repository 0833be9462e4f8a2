//! Rules of the whole repository: named sources, no machine names, and the commands of README in CI.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(name: &str) -> String {
    fs::read_to_string(root().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Every text file of the repository with its path from the root, without what git does not keep.
fn files() -> Vec<(PathBuf, String)> {
    let mut found = Vec::new();
    let mut folders = vec![root().to_path_buf()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            let name = path.file_name().expect("a name").to_string_lossy().into_owned();
            if path.is_dir() {
                if ![".git", "target", "runs"].contains(&name.as_str()) {
                    folders.push(path);
                }
            } else if let Ok(text) = fs::read_to_string(&path) {
                found.push((path.strip_prefix(root()).expect("within").to_path_buf(), text));
            }
        }
    }
    found.sort();
    assert!(found.len() > 100, "only {} files", found.len());
    found
}

/// A source's key: a name with a capital letter and a year, as in the entries of REFERENCES.md, or a program that has none.
fn is_key(word: &str) -> bool {
    if word == "FARSA2" {
        return true;
    }
    let Some((name, year)) = word.len().checked_sub(4).and_then(|at| word.split_at_checked(at)) else { return false };
    name.len() > 1
        && name.starts_with(|c: char| c.is_ascii_uppercase())
        && name.chars().all(|c| c.is_ascii_alphabetic())
        && ["18", "19", "20"].iter().any(|century| year.starts_with(century))
        && year.chars().all(|c| c.is_ascii_digit())
}

fn keys(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| is_key(word))
}

#[test]
fn every_source_is_listed_and_every_listed_source_is_used() {
    assert!(is_key("Featherstone2008") && !is_key("J2008") && !is_key("Random1234") && !is_key("u2008"));
    let mut used: BTreeMap<String, PathBuf> = BTreeMap::new();
    for (path, text) in files() {
        let extension = path.extension().unwrap_or_default();
        if (extension == "rs" || extension == "md") && path != Path::new("REFERENCES.md") && !path.starts_with("tests")
        {
            assert!(!text.contains("[Thesis]"), "{}: [Thesis] is [Ferrauto2010]", path.display());
            for key in keys(&text) {
                used.entry(key.into()).or_insert_with(|| path.clone());
            }
        }
    }
    let references = read("REFERENCES.md");
    let entries = references.lines().filter_map(|line| line.strip_prefix("- **")?.split_once("**"));
    let listed: Vec<&str> = entries.map(|(key, _)| key).collect();
    let mut sorted = listed.clone();
    sorted.sort_unstable();
    sorted.dedup();
    assert_eq!(listed, sorted, "REFERENCES.md is in alphabetical order, each key once");
    let listed: BTreeSet<&str> = listed.into_iter().collect();
    for (key, path) in &used {
        assert!(listed.contains(key.as_str()), "{}: [{key}] is not in REFERENCES.md", path.display());
    }
    for key in listed {
        assert!(used.contains_key(key), "REFERENCES.md: nothing uses {key}");
    }
}

#[test]
fn no_file_names_a_machine_or_a_registry() {
    // Put together here, so that this file does not hold them.
    let folders = ["work", "tmp", "root", "home"].map(|name| format!("/{name}/"));
    let hosts = [["crates", "io"], ["pypi", "org"], ["npmjs", "org"], ["debian", "org"]].map(|parts| parts.join("."));
    for (path, text) in files() {
        // Cargo itself writes the registry's name there.
        if path.file_name().is_some_and(|name| name == "Cargo.lock") {
            continue;
        }
        for (number, line) in text.lines().enumerate() {
            let absolute = folders.iter().find(|folder| {
                line.match_indices(folder.as_str()).any(|(at, _)| {
                    let before = line[..at].chars().next_back();
                    !before.is_some_and(|c| c.is_alphanumeric() || "_.-".contains(c))
                })
            });
            let host = hosts.iter().find(|host| line.contains(host.as_str()));
            if let Some(name) = absolute.or(host) {
                panic!("{}:{}: names {name}", path.display(), number + 1);
            }
        }
    }
}

#[test]
fn ci_runs_the_commands_of_the_readme() {
    let (readme, ci) = (read("README.md"), read("ci") + &read("tests/smoke/run"));
    let mut commands = Vec::new();
    let mut within = false;
    for line in readme.lines() {
        if let Some(language) = line.strip_prefix("```") {
            within = language == "sh";
        } else if within && line.starts_with("cargo ") {
            commands.push(line.split('#').next().unwrap_or(line).trim());
        }
    }
    assert!(commands.len() >= 2, "{commands:?}");
    for command in commands {
        // CI keeps its runs in a temporary folder.
        let command = command.split(" runs/").next().unwrap_or(command);
        assert!(ci.contains(command), "README.md says `{command}`, ci does not");
    }
}

#[test]
fn every_crate_has_what_a_reader_expects() {
    let manifest = read("Cargo.toml");
    let members = manifest.lines().find_map(|line| line.strip_prefix("members = [")).expect("the members in one line");
    for name in members.split('"').filter(|name| name.starts_with("farsa-")) {
        assert!(read(&format!("{name}/README.md")).lines().count() > 20, "{name}/README.md says too little");
        assert!(read("README.md").contains(&format!("`{name}`")), "README.md does not name {name}");
    }
}

#[test]
fn no_dependency_compiles_c_or_looks_for_a_system_library() {
    let lock = read("Cargo.lock");
    for name in ["cc", "cmake", "bindgen", "pkg-config", "vcpkg"] {
        assert!(!lock.contains(&format!("name = \"{name}\"\n")), "Cargo.lock: {name}");
    }
}

/// The dependencies of a manifest that are not optional.
fn needed(manifest: &str) -> BTreeSet<&str> {
    let (_, section) = manifest.split_once("\n[dependencies]\n").unwrap_or_default();
    let lines = section.lines().take_while(|line| !line.starts_with('['));
    let named = lines.filter(|line| !line.starts_with('#') && !line.contains("optional = true"));
    named
        .filter_map(|line| line.split_once([' ', '.', '=']).map(|(name, _)| name))
        .filter(|name| !name.is_empty())
        .collect()
}

#[test]
fn lock_files_of_what_is_no_member_know_what_our_crates_need() {
    let mut checked = 0;
    for lock in ["farsa-lab-mpi", "farsa-live", "farsa-python", "benches/bbob", "firmware", "ci-nostd"]
        .map(|folder| format!("{folder}/Cargo.lock"))
    {
        let text = read(&lock);
        for package in text.split("[[package]]\n") {
            let line = |key: &str| package.lines().find_map(|line| line.strip_prefix(key)?.strip_suffix('"'));
            let Some(name) = line("name = \"").filter(|name| root().join(name).join("Cargo.toml").exists()) else {
                continue;
            };
            for other in needed(&read(&format!("{name}/Cargo.toml"))) {
                let listed =
                    package.contains(&format!("\n \"{other}\"")) || package.contains(&format!("\n \"{other} "));
                assert!(
                    listed,
                    "{lock}: {name} needs {other}: run `cargo metadata` beside it and commit what it writes"
                );
                checked += 1;
            }
        }
    }
    assert!(checked > 30, "only {checked} dependencies");
}

/// Packages that decode input: runs, documents, command lines, tables, pictures, pages.
const DECODERS: [&str; 26] = [
    "base64",
    "clap",
    "clap_builder",
    "clap_derive",
    "clap_lex",
    "cobs",
    "crc32fast",
    "csv",
    "csv-core",
    "fdeflate",
    "flate2",
    "miniz_oxide",
    "png",
    "postcard",
    "roxmltree",
    "safetensors",
    "serde",
    "serde_core",
    "serde_derive",
    "serde_json",
    "serde_spanned",
    "toml",
    "toml_datetime",
    "toml_parser",
    "toml_writer",
    "winnow",
];

/// The versions of each decoder in a lock file.
fn decoders(lock: &str) -> BTreeMap<String, BTreeSet<String>> {
    let mut versions = BTreeMap::<_, BTreeSet<_>>::new();
    for package in read(lock).split("[[package]]\n") {
        let field = |key: &str| package.lines().find_map(|line| line.strip_prefix(key)?.strip_suffix('"'));
        if let (Some(name), Some(version)) = (field("name = \""), field("version = \""))
            && DECODERS.contains(&name)
        {
            versions.entry(name.to_string()).or_default().insert(version.to_string());
        }
    }
    versions
}

#[test]
fn all_lock_files_decode_with_the_same_versions() {
    let workspace = decoders("Cargo.lock");
    for name in DECODERS {
        assert!(workspace.contains_key(name), "Cargo.lock has no {name}");
    }
    let mut checked = 0;
    for folder in ["farsa-lab-mpi", "farsa-live", "farsa-python", "fuzz", "firmware", "ci-nostd"] {
        let lock = format!("{folder}/Cargo.lock");
        for (name, versions) in decoders(&lock) {
            assert!(
                versions.is_subset(&workspace[&name]),
                "{lock}: {name} {versions:?}, Cargo.lock: {:?}: run `cargo update --precise` for it",
                workspace[&name]
            );
            checked += 1;
        }
    }
    assert!(checked > 60, "only {checked} packages");
}

/// The compiled crates and features for a crate of the workspace, or for all.
fn features(which: &[&str]) -> BTreeSet<String> {
    let tree = ["tree", "--offline", "--prefix", "none", "--no-dedupe", "--format", "{p} [{f}]"];
    let output = Command::new(env!("CARGO")).args(tree).args(which).current_dir(root()).output().expect("cargo");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8_lossy(&output.stdout).lines().map(str::to_owned).collect()
}

#[test]
fn the_command_the_experiments_and_all_tests_share_one_build() {
    let tests = features(&["--workspace", "--edges", "normal,dev"]);
    for which in [&["--workspace", "--edges", "normal"][..], &["-p", "farsa-experiments", "--edges", "normal,dev"]] {
        // A crate that is asked for one feature less has all that is above it compiled twice.
        let part = features(which);
        let other: Vec<&String> = part.difference(&tests).collect();
        assert!(part.len() > 100 && other.is_empty(), "{which:?}: tests have these with other features: {other:?}");
    }
}

#[test]
fn a_library_that_evaluates_or_draws_has_no_command_line() {
    for which in [&["-p", "farsa-view"][..], &["-p", "farsa-lab", "--no-default-features"]] {
        let found = features(&[which, &["--edges", "normal"]].concat());
        let known = |name: &str| found.iter().any(|line| line.starts_with(name));
        assert!(known("farsa-body ") && !known("clap") && !known("farsa-experiments "), "{which:?}: {found:?}");
    }
}

#[test]
fn every_fuzz_target_has_seeds_a_row_and_a_result() {
    let (manifest, table, results) = (read("fuzz/Cargo.toml"), read("quality/README.md"), read("quality/campaign.md"));
    let rows: String = table.lines().filter(|line| line.starts_with("| `")).collect();
    let mut targets = vec!["page".to_owned()];
    for entry in fs::read_dir(root().join("fuzz/fuzz_targets")).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
        assert!(manifest.contains(&format!("path = \"fuzz_targets/{name}.rs\"")), "{name} is not built");
        targets.push(name);
    }
    assert!(targets.len() > 15, "{targets:?}");
    for name in targets {
        let seeds = fs::read_dir(root().join("fuzz/corpus").join(&name)).map(Iterator::count);
        assert!(seeds.is_ok_and(|seeds| seeds > 0), "{name} has no seeds");
        let quoted = format!("`{name}`");
        assert!(rows.contains(&quoted), "quality/README.md does not list {name}");
        assert!(results.contains(&quoted), "quality/campaign.md does not say how often {name} was run");
    }
}

/// The name of the function that begins in a line of Rust or JavaScript. A method of a class has no keyword.
fn function_of(line: &str) -> Option<&str> {
    let head = line.trim_start();
    let head = head.strip_prefix("pub(crate) ").or(head.strip_prefix("pub(super) ")).unwrap_or(head);
    let (words, _) = head.split_once(['(', '<'])?;
    let mut before: Vec<&str> = words.split_whitespace().collect();
    let name = before.pop()?;
    let keyword = ["if", "for", "while", "switch", "catch"].contains(&name);
    let method = before.is_empty() && line.ends_with(") {") && !keyword;
    let named = ["fn", "function", "get"].iter().any(|word| before.last() == Some(word));
    let known = before.iter().all(|word| ["pub", "const", "async", "static", "fn", "function", "get"].contains(word));
    (known && (named || method) && name.chars().all(|c| c.is_alphanumeric() || c == '_')).then_some(name)
}

/// The functions of a source, each with its first line and how many lines it has. The code is formatted, so a body ends at
/// a brace below the function's first column.
fn functions(text: &str) -> Vec<(&str, usize, usize)> {
    let lines: Vec<&str> = text.lines().collect();
    let indent = |line: &str| line.len() - line.trim_start().len();
    let mut found = Vec::new();
    for (first, line) in lines.iter().enumerate() {
        let Some(name) = function_of(line) else { continue };
        // A declaration ends with a semicolon.
        let last = lines[first..].iter().position(|other| {
            indent(other) == indent(line) && (other.trim_start().starts_with('}') || other.ends_with([';', '}']))
        });
        if let Some(last) = last.filter(|last| lines[first + last].trim_start() == "}") {
            found.push((name, first + 1, last + 1));
        }
    }
    found
}

#[test]
fn functions_and_files_are_short() {
    let sample = "fn one() { 1 }\n\nimpl A {\n    pub(crate) fn two<T>(\n        a: T,\n    ) -> A {\n        a\n    }\n    fn three();\n}\n\
                  class B {\n\tget four() {\n\t}\n\tfive(a) {\n\t\tif (a) {\n\t\t}\n\t}\n}\n";
    assert_eq!(functions(sample), [("two", 4, 5), ("four", 12, 2), ("five", 14, 4)]);
    let (mut wrong, mut seen) = (Vec::new(), 0);
    for (path, text) in files() {
        let code = path.extension().is_some_and(|extension| extension == "rs" || extension == "js");
        if !code || !path.components().any(|part| part.as_os_str() == "src") {
            continue;
        }
        let length = text.lines().count();
        if length > 500 {
            wrong.push(format!("{} has {length} lines, at most 500", path.display()));
        }
        for (name, first, length) in functions(&text) {
            seen += 1;
            if length > 100 {
                wrong.push(format!("{}:{first}: {name} has {length} lines, at most 100", path.display()));
            }
        }
    }
    assert!(seen > 2000, "only {seen} functions");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
