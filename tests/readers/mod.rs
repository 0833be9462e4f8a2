//! How the projects of readers are built here.

use std::path::Path;
use std::process::{Command, Stdio};

/// Whether they are built and run as their readers would, each with its own profile: `./ci long`. Else the compiler only checks them,
/// with the crates and features that they ask for; what they do is tested on the same programs among the workspace's examples.
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
