//! A copy of a run, and the command next to it.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;

use serde_json::Value;

/// Every file below a directory with its content, without locks.
pub(crate) fn content(directory: &Path) -> BTreeMap<String, Vec<u8>> {
    let (mut files, mut open) = (BTreeMap::new(), vec![directory.to_path_buf()]);
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(folder).expect("a directory") {
            let path = entry.expect("an entry").path();
            let name = path.strip_prefix(directory).expect("below it").to_str().expect("a name").replace('\\', "/");
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_none_or(|end| end != "lock") {
                files.insert(name, fs::read(&path).expect("a file"));
            }
        }
    }
    files
}

/// The end of a file's name.
pub(crate) fn end(name: &str) -> &str {
    name.rsplit_once('.').map_or("", |(_, end)| end)
}

/// True if these bytes are in a file somewhere.
pub(crate) fn has(file: &[u8], bytes: &[u8]) -> bool {
    file.windows(bytes.len()).any(|window| window == bytes)
}

/// The output of the command.
#[derive(Debug)]
pub(crate) struct Said {
    pub(crate) code: Option<i32>,
    pub(crate) out: String,
    pub(crate) err: String,
}

impl Said {
    pub(crate) fn json(&self) -> Value {
        serde_json::from_str(&self.out).expect("JSON")
    }
}

/// A directory of a test's own with a copy of a run in it, `run`.
pub(crate) struct Place(pub(crate) PathBuf);

impl Place {
    pub(crate) fn with(test: &str, run: &Path) -> Self {
        let here = Path::new(env!("CARGO_TARGET_TMPDIR")).join("formats").join(test);
        let _ = fs::remove_dir_all(&here);
        for (name, bytes) in content(run) {
            let path = here.join("run").join(name);
            fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
            fs::write(path, bytes).expect("a copy");
        }
        Self(here)
    }

    pub(crate) fn say(&self, arguments: &str) -> Said {
        let mut command = Command::new(env!("CARGO_BIN_EXE_farsa"));
        command.args(arguments.split(' ')).current_dir(&self.0).stdin(Stdio::null());
        let output = command.output().expect("the program");
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        Said { code: output.status.code(), out: text(&output.stdout), err: text(&output.stderr) }
    }

    pub(crate) fn ok(&self, arguments: &str) -> Said {
        let said = self.say(arguments);
        assert_eq!(said.code, Some(0), "{}: {arguments}: {said:?}", self.0.display());
        said
    }

    pub(crate) fn text(&self, file: &str) -> String {
        fs::read_to_string(self.0.join(file)).expect(file)
    }

    pub(crate) fn manifest(&self, run: &str) -> Value {
        serde_json::from_str(&self.text(&format!("{run}/manifest.json"))).expect("a manifest")
    }

    /// The finished generations, and the best of the last in each population. `None` for imported genotypes.
    pub(crate) fn recorded(&self) -> Option<(usize, Vec<f64>)> {
        let log = fs::read_to_string(self.0.join("run/fitness.csv")).ok()?;
        let numbers = |column: usize| log.lines().last()?.split(',').nth(column)?.parse().ok();
        let each: Vec<f64> = (6..).step_by(3).map_while(numbers).collect();
        let best = if each.is_empty() { vec![numbers(1).expect("the best")] } else { each };
        Some((log.lines().count() - 1, best))
    }

    /// The largest of the best of all generations.
    pub(crate) fn highest(&self) -> f64 {
        let log = self.text("run/fitness.csv");
        let best = log.lines().skip(1).map(|line| line.split(',').nth(1).and_then(|best| best.parse().ok()));
        best.map(|best| best.expect("the best")).fold(f64::NEG_INFINITY, f64::max)
    }
}

/// A run that this program has made.
pub(crate) fn today() -> &'static Place {
    static TODAY: OnceLock<Place> = OnceLock::new();
    TODAY.get_or_init(|| {
        // Where each test is a separate process (cargo-nextest), each makes one.
        let name = format!("formats-today-{}", std::process::id());
        let place = Place(Path::new(env!("CARGO_TARGET_TMPDIR")).join(name));
        let _ = fs::remove_dir_all(&place.0);
        fs::create_dir_all(&place.0).expect("a scratch directory");
        place.ok("run braitenberg --set trial.count=1 --set trial.steps=1 --out run --quiet");
        place
    })
}
