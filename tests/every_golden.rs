//! The goldens of every crate in one program, with all crates and features together.
#![allow(missing_docs, clippy::unwrap_used)]

#[path = "../farsa-body/tests/golden.rs"]
mod body;
#[cfg(feature = "alloc")]
#[path = "../farsa-evo/tests/golden.rs"]
mod evo;
#[path = "../farsa-nn/tests/golden.rs"]
mod nn;
#[path = "../farsa-num/tests/golden.rs"]
mod num;
#[path = "../farsa-physics/tests/golden.rs"]
mod physics;

/// A crate whose golden is not named above would be left out in silence.
#[test]
fn every_crate_with_goldens_is_here() {
    let here = include_str!("every_golden.rs");
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    for entry in std::fs::read_dir(root).expect("the repository") {
        let crate_dir = entry.expect("an entry").path();
        if crate_dir.join("tests/golden.rs").is_file() {
            let name = crate_dir.file_name().expect("a name").to_string_lossy().into_owned();
            assert!(here.contains(&format!("\"../{name}/tests/golden.rs\"")), "{name}/tests/golden.rs is not here");
        }
    }
}
