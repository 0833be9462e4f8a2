//! Common parts of the tests: the two programs, scratch directories, and the output of a program.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::OnceLock;

/// The command over the reference experiments.
pub(crate) fn farsa() -> &'static Path {
    Path::new(env!("CARGO_BIN_EXE_farsa"))
}

/// The command over a custom experiment, `tests/own-experiment`. `./ci guides` builds it outside the workspace.
pub(crate) fn own() -> &'static Path {
    static PROGRAM: OnceLock<PathBuf> = OnceLock::new();
    PROGRAM.get_or_init(|| {
        let here = Path::new(env!("CARGO_MANIFEST_DIR"));
        // `cargo test` has built it among the examples, unless it was asked for these tests alone.
        let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().expect("the target directory");
        let build = Command::new(env!("CARGO"))
            .args(["build", "--offline", "--quiet", "--workspace", "--example", "own-experiment"])
            .current_dir(here.parent().expect("the workspace"))
            .env("CARGO_TARGET_DIR", target)
            .stdin(Stdio::null())
            .output()
            .expect("cargo");
        assert!(build.status.success(), "{}", String::from_utf8_lossy(&build.stderr));
        target.join("debug/examples").join(format!("own-experiment{}", std::env::consts::EXE_SUFFIX))
    })
}

/// A directory of a test's own, empty.
pub(crate) fn scratch(test: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("command").join(test);
    let _ = fs::remove_dir_all(&path);
    fs::create_dir_all(&path).expect("a scratch directory");
    path
}

/// The output of a program.
#[derive(Debug)]
pub(crate) struct Said {
    pub(crate) code: Option<i32>,
    pub(crate) out: String,
    pub(crate) err: String,
}

impl From<Output> for Said {
    fn from(output: Output) -> Self {
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        Self { code: output.status.code(), out: text(&output.stdout), err: text(&output.stderr) }
    }
}

/// A command in a directory, with arguments.
pub(crate) fn command(program: &Path, directory: &Path, arguments: &[impl AsRef<OsStr>]) -> Command {
    let mut command = Command::new(program);
    command.args(arguments).current_dir(directory).stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// A program that ends by signals, also when this process ignores them, as under `nohup` or in the background of a shell.
#[cfg(unix)]
pub(crate) fn interruptible(program: &Path, directory: &Path, arguments: &[impl AsRef<OsStr>]) -> Command {
    let mut command = command(Path::new("env"), directory, &["--default-signal=INT,TERM,HUP"]);
    command.arg(program).args(arguments);
    command
}

/// Runs a program to its end.
pub(crate) fn say(program: &Path, directory: &Path, arguments: &str) -> Said {
    let arguments: Vec<&str> = arguments.split(' ').filter(|word| !word.is_empty()).collect();
    command(program, directory, &arguments).output().expect("the program").into()
}

/// Runs a program that must succeed and returns what it wrote.
pub(crate) fn ok(program: &Path, directory: &Path, arguments: &str) -> String {
    let said = say(program, directory, arguments);
    assert_eq!(said.code, Some(0), "{arguments}: {said:?}");
    said.out
}

/// Every file below a directory with its content, sorted by name.
pub(crate) fn content(directory: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut files = Vec::new();
    let mut open = vec![directory.to_path_buf()];
    while let Some(directory) = open.pop() {
        for entry in fs::read_dir(directory).expect("a directory") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                open.push(path);
            } else {
                let bytes = fs::read(&path).expect("a file");
                files.push((path, bytes));
            }
        }
    }
    files.sort();
    files
}

/// The files that must not depend on threads, interruptions or the clock.
pub(crate) fn results(directory: &Path) -> Vec<Vec<u8>> {
    let files = ["fitness.csv", "champion.bin", "record.bin", "checkpoint.bin", "config.toml", "lineage.csv"];
    files.map(|name| fs::read(directory.join(name)).expect(name)).into()
}
