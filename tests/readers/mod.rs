//! Builds of the readers' projects.

use std::path::Path;
use std::process::{Command, Stdio};

/// Returns true in `./ci long`, which builds and runs them with their own profiles. Otherwise the compiler only checks them, and the
/// examples of the workspace test the same programs.
pub(crate) fn whole() -> bool {
    std::env::var_os("FARSA_LONG").is_some()
}

/// Has the compiler check the project in a folder.
pub(crate) fn check(project: &Path) {
    let output = Command::new(env!("CARGO"))
        .args(["check", "--quiet", "--offline"])
        .current_dir(project)
        .env("CARGO_TARGET_DIR", Path::new(env!("CARGO_TARGET_TMPDIR")).join("readers"))
        .stdin(Stdio::null())
        .output()
        .expect("cargo");
    assert!(output.status.success(), "{}: {}", project.display(), String::from_utf8_lossy(&output.stderr));
}
