//! Each library crate serves a project that has nothing else, by its path, in ten lines, with its features and without.

#![allow(clippy::unwrap_used)]

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

mod readers;

/// Crate, default features, program, output.
const PROJECTS: [[&str; 4]; 11] = [
    ["num", "with", "num.rs", "[0.254, 0.538, 0.769]"],
    ["num", "without", "num.rs", "[0.254, 0.538, 0.769]"],
    ["nn", "with", "nn.rs", "[0.521]"],
    ["nn", "without", "nn.rs", "[0.521]"],
    ["evo", "with", "evo.rs", "Some([64861, 65225, 65404, 65382, 65440, 65506, 65032, 65167])"],
    ["evo", "without", "evo.rs", "Some([64861, 65225, 65404, 65382, 65440, 65506, 65032, 65167])"],
    ["body", "with", "body.rs", "3.064 N m hold the shoulder"],
    ["body", "without", "body_without_features.rs", "-2.567 N m"],
    ["models", "with", "models.rs", "1 joint, 24 lines of URDF"],
    ["physics", "with", "physics.rs", "[0.551, 0.500, 0.000]"],
    ["physics", "without", "physics_without_features.rs", "[0.0, 0.6, 0.0] m/s, 3.000 W"],
];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn program(file: &str) -> String {
    fs::read_to_string(root().join("tests/empty_project").join(file)).unwrap()
}

#[test]
fn ten_lines_are_enough() {
    for [_, _, file, _] in PROJECTS {
        let text = program(file);
        let lines = text.lines().filter(|line| !line.trim().is_empty()).count();
        assert!(lines <= 10, "{file} has {lines}");
        let widest = text.lines().map(str::len).max().unwrap();
        assert!(widest <= 130, "{file}: {widest} columns");
    }
}

/// Crates of this repository in a text, by the names that follow a mark.
fn crates(text: &str, marks: [&str; 2]) -> BTreeSet<String> {
    let names = text.lines().flat_map(|line| marks.map(|mark| line.trim_start().strip_prefix(mark)));
    let names = names.flatten().map(|rest| {
        rest.chars().take_while(|letter| letter.is_ascii_lowercase() || "-_".contains(*letter)).collect::<String>()
    });
    names.map(|name| name.replace('_', "-")).collect()
}

#[test]
fn readmes_list_the_crates_of_their_programs() {
    for entry in fs::read_dir(root()).unwrap() {
        let path = entry.unwrap().path().join("README.md");
        let name = path.parent().unwrap().file_name().unwrap().to_string_lossy().into_owned();
        let Ok(text) = fs::read_to_string(&path) else { continue };
        // A package of Python has no dependents in Rust.
        if !name.starts_with("farsa-") || name == "farsa-python" {
            continue;
        }
        let (_, rest) = text.split_once("[dependencies]\n").unwrap_or_else(|| panic!("{name} has no [dependencies]"));
        let listed = crates(rest.split("```").next().unwrap(), ["farsa-", "# farsa-"]);
        assert!(listed.contains(name.trim_start_matches("farsa-")), "{name} does not list itself: {listed:?}");
        let programs: String = text.split("```").skip(1).step_by(2).filter(|block| !block.starts_with('t')).collect();
        let used = crates(&programs, ["use farsa_", "# use farsa_"]);
        assert!(!used.is_empty() && used.is_subset(&listed), "{name} uses {used:?} and lists {listed:?}");
    }
}

#[test]
#[ignore = "builds eleven projects, a minute: ./ci guides"]
fn whoever_has_nothing_else_can_use_it() {
    // Outside the target directory, which most often is within the workspace: there cargo would look for a member of it.
    let place = std::env::temp_dir().join(format!("farsa-empty-{}", std::process::id()));
    for [name, features, file, says] in PROJECTS {
        let project = place.join(format!("{name}-{features}"));
        fs::create_dir_all(project.join("src")).unwrap();
        // The descriptions for physics are in farsa-body.
        let crates: &[&str] = if [name, features] == ["physics", "with"] { &["physics", "body"] } else { &[name] };
        let dependency = |name: &&str| {
            let path = root().join(format!("farsa-{name}"));
            format!("farsa-{name} = {{ path = {path:?}, default-features = {} }}", features == "with")
        };
        let dependencies: Vec<String> = crates.iter().map(dependency).collect();
        let manifest = "[package]\nname = \"mine\"\nedition = \"2024\"\n\n[dependencies]\n".to_string();
        let manifest = manifest + &dependencies.join("\n") + "\n";
        fs::write(project.join("Cargo.toml"), manifest).unwrap();
        fs::write(project.join("src/main.rs"), program(file)).unwrap();
        // Pins what is on this machine already.
        fs::copy(root().join("Cargo.lock"), project.join("Cargo.lock")).unwrap();
        let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("empty-projects");
        let output = Command::new(env!("CARGO"))
            .args(["run", "--quiet", "--offline"])
            .current_dir(&project)
            .env("CARGO_TARGET_DIR", target)
            // Nothing reads them.
            .env("CARGO_PROFILE_DEV_DEBUG", "false")
            .stdin(Stdio::null())
            .output()
            .unwrap();
        let (said, went_wrong) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        assert!(output.status.success(), "farsa-{name} {features} its features: {went_wrong}");
        assert_eq!(said.trim_end(), says, "farsa-{name} {features} its features");
    }
    fs::remove_dir_all(&place).unwrap();
}

#[test]
#[ignore = "checks or builds a crate with the laboratory, a minute: ./ci guides"]
fn an_experiment_outside_the_workspace_has_the_command() {
    let source = root().join("farsa-experiments/tests/own-experiment");
    let place = std::env::temp_dir().join(format!("farsa-own-{}", std::process::id()));
    fs::create_dir_all(place.join("src")).unwrap();
    let manifest = fs::read_to_string(source.join("Cargo.toml")).unwrap();
    let manifest = manifest.replace("../../..", &root().display().to_string());
    fs::write(place.join("Cargo.toml"), manifest).unwrap();
    let main = fs::read_to_string(source.join("src/main.rs")).unwrap();
    assert!(main.lines().count() <= 80, "a whole experiment is to fit in 80 lines");
    fs::write(place.join("src/main.rs"), main).unwrap();
    fs::copy(root().join("Cargo.lock"), place.join("Cargo.lock")).unwrap();
    if !readers::whole() {
        readers::check(&place);
        fs::remove_dir_all(&place).unwrap();
        return;
    }
    let output = Command::new(env!("CARGO"))
        .args(["run", "--quiet", "--offline", "--", "run", "cart", "--generations", "2", "--out", "first"])
        .current_dir(&place)
        .env("CARGO_TARGET_DIR", Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap())
        .stdin(Stdio::null())
        .output()
        .unwrap();
    let (said, went_wrong) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success() && said.contains("first: 2 generations; champion"), "{said} {went_wrong}");
    assert!(place.join("first/fitness.csv").is_file());
    fs::remove_dir_all(&place).unwrap();
}
