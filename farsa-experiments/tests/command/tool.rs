//! Common parts of the tests: the two programs, scratch directories, and the output of a program.

use std::ffi::OsStr;
use std::fs;
use std::io::{BufRead as _, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdout, Command, Output, Stdio};
use std::sync::OnceLock;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::{JoinHandle, sleep};
use std::time::{Duration, Instant};

/// The command over the reference experiments.
pub(crate) fn farsa() -> &'static Path {
    Path::new(env!("CARGO_BIN_EXE_farsa"))
}

/// The command over a custom experiment, `tests/own-experiment`. `./ci guides` builds it outside the workspace.
///
/// Cargo names no path of an example. `cargo test` builds it next to the tests, and it is used as long as no source is newer.
/// After `cargo test --test command` alone it may be missing or old. Then cargo builds it once for all tests.
pub(crate) fn own() -> &'static Path {
    static PROGRAM: OnceLock<PathBuf> = OnceLock::new();
    PROGRAM.get_or_init(|| {
        let name = format!("own-experiment{}", std::env::consts::EXE_SUFFIX);
        let built = farsa().with_file_name("examples").join(&name);
        if is_fresh(&built) {
            return built;
        }
        let here = Path::new(env!("CARGO_MANIFEST_DIR"));
        let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().expect("the target directory");
        let mut build = Command::new(env!("CARGO"));
        build.args(["build", "--offline", "--quiet", "--workspace", "--example", "own-experiment"]);
        build.current_dir(here.parent().expect("the workspace")).env("CARGO_TARGET_DIR", target);
        let built = target.join("debug/examples").join(name);
        let said = Running::start(build.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped())).end();
        assert!(said.code == Some(0), "cannot build {}: {said:?}", built.display());
        built
    })
}

/// True if a program is newer than all of its sources, by the list that cargo writes next to it.
fn is_fresh(program: &Path) -> bool {
    let time = |path: &Path| fs::metadata(path).and_then(|metadata| metadata.modified()).ok();
    let (Some(built), Ok(list)) = (time(program), fs::read_to_string(program.with_extension("d"))) else {
        return false;
    };
    // Blanks within names are escaped.
    let list = list.replace("\\ ", "\0");
    let mut sources = list.split_whitespace().skip(1).map(|name| name.replace('\0', " "));
    sources.all(|source| time(source.as_ref()).is_some_and(|changed| changed <= built))
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

/// Reads the JSON that a program printed.
pub(crate) fn json(text: &str) -> serde_json::Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

/// Longest wait of a test for a program. The slowest of them take a minute on a machine with other work.
const PATIENCE: Duration = Duration::from_secs(600);

/// Variables by which schedulers name their jobs. Tests that run in such a job would end with other exit codes.
const SCHEDULERS: [&str; 7] =
    ["SLURM_JOB_ID", "PBS_JOBID", "LSB_JOBID", "SGE_TASK_ID", "OAR_JOB_ID", "FLUX_JOB_ID", "_CONDOR_JOB_AD"];

/// A command in a directory, with arguments, outside any scheduler.
pub(crate) fn command(program: &Path, directory: &Path, arguments: &[impl AsRef<OsStr>]) -> Command {
    let mut command = Command::new(program);
    command.args(arguments).current_dir(directory).stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    for name in SCHEDULERS {
        command.env_remove(name);
    }
    command
}

/// A program that ends by signals, also when this process ignores them, as under `nohup` or in the background of a shell.
#[cfg(unix)]
pub(crate) fn interruptible(program: &Path, directory: &Path, arguments: &[impl AsRef<OsStr>]) -> Command {
    let mut command = command(Path::new("env"), directory, &["--default-signal=INT,TERM,HUP"]);
    command.arg(program).args(arguments);
    command
}

/// A program that runs. Its output is read at all times, so that a full pipe cannot stop it, and it ends with the test.
pub(crate) struct Running {
    child: Child,
    texts: [Option<JoinHandle<String>>; 2],
}

impl Running {
    pub(crate) fn start(command: &mut Command) -> Self {
        let mut child = command.spawn().expect("the program");
        let texts = [child.stdout.take().map(read), child.stderr.take().map(read)];
        Self { child, texts }
    }

    /// Waits until something is done, while the program runs.
    pub(crate) fn until(&mut self, what: &str, mut done: impl FnMut() -> bool) {
        let end = Instant::now() + PATIENCE;
        while !done() {
            assert!(Instant::now() < end, "no {what} in {PATIENCE:?}");
            assert_eq!(self.child.try_wait().expect("the program"), None, "it ended before {what}");
            sleep(Duration::from_millis(2));
        }
    }

    /// Sends a signal by its name.
    #[cfg(unix)]
    pub(crate) fn signal(&self, name: &str) {
        let sent = Command::new("kill").args([format!("-{name}"), self.child.id().to_string()]).status().expect("kill");
        assert!(sent.success());
    }

    /// Waits for the end of the program.
    pub(crate) fn end(mut self) -> Said {
        let end = Instant::now() + PATIENCE;
        let status = loop {
            match self.child.try_wait().expect("the program") {
                Some(status) => break status,
                None => assert!(Instant::now() < end, "it did not end in {PATIENCE:?}"),
            }
            sleep(Duration::from_millis(2));
        };
        let [out, err] = &mut self.texts;
        let text = |reader: &mut Option<JoinHandle<String>>| {
            reader.take().map(|reader| reader.join().expect("its output")).unwrap_or_default()
        };
        Said { code: status.code(), out: text(out), err: text(err) }
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Kills a process whose output a test reads by itself, if the test takes too long.
#[derive(Debug)]
pub(crate) struct Deadline {
    _held: Sender<()>,
}

impl Deadline {
    pub(crate) fn new(process: u32) -> Self {
        let (held, ended) = channel();
        std::thread::spawn(move || {
            // Dropping the value ends the wait.
            if ended.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
                let _ = Command::new("kill").args(["-KILL", &process.to_string()]).status();
            }
        });
        Self { _held: held }
    }
}

/// A server that prints its address as JSON, and ends with the test.
pub(crate) struct Announced {
    process: Child,
    pub(crate) address: String,
    _said: BufReader<ChildStdout>,
    _deadline: Deadline,
}

impl Drop for Announced {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

impl Announced {
    /// Starts a server and waits for its address.
    pub(crate) fn start(start: &mut Command) -> Self {
        let mut process = start.stderr(Stdio::inherit()).spawn().expect("a server");
        let deadline = Deadline::new(process.id());
        let mut said = BufReader::new(process.stdout.take().expect("its output"));
        let mut text = String::new();
        while !text.ends_with("}\n") {
            assert!(said.read_line(&mut text).expect("a line") > 0, "it ended: {text}");
        }
        let address = json(&text)["address"].as_str().expect("an address").to_owned();
        Self { process, address, _said: said, _deadline: deadline }
    }

    #[cfg(target_os = "linux")]
    pub(crate) fn id(&self) -> u32 {
        self.process.id()
    }
}

/// Reads all of an output, until its end or an error.
pub(crate) fn read(mut output: impl Read + Send + 'static) -> JoinHandle<String> {
    std::thread::spawn(move || {
        let mut bytes = Vec::new();
        let _ = output.read_to_end(&mut bytes);
        String::from_utf8_lossy(&bytes).into_owned()
    })
}

/// Runs a program to its end.
pub(crate) fn say(program: &Path, directory: &Path, arguments: &str) -> Said {
    let arguments: Vec<&str> = arguments.split(' ').filter(|word| !word.is_empty()).collect();
    Running::start(&mut command(program, directory, &arguments)).end()
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
