//! How the projects of readers are built here.

use std::fs;
use std::path::Path;

/// The settings of cargo that the readers' projects are built with: the profile of the workspace in place of their own, so that
/// they share with its tests what those have compiled of others' crates; ours, which have other paths from there, are compiled again.
/// In `./ci long` there are none, and each project has its own profile.
pub(crate) fn settings() -> String {
    if std::env::var_os("FARSA_LONG").is_some() {
        return String::new();
    }
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml");
    let manifest = fs::read_to_string(manifest).expect("the workspace");
    let profile = manifest.find("[profile.dev]").zip(manifest.find("[profile.release]"));
    let profile =
        profile.and_then(|(from, to)| manifest.get(from..to)).expect("the profile of tests, and then another");
    // The profile has the other crates.
    let crates = ["-num", "-body", "-physics", "-nn", "-evo", "-experiments", ""];
    let ours = crates.map(|name| format!("farsa{name} = {{ opt-level = 2 }}\n")).concat();
    profile.trim_end().to_owned() + "\n" + &ours
}
