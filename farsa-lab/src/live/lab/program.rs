//! Processes of this program, which do all that needs the command.

use std::fs::{self, File};
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use crate::error::Error;
use crate::live::lab::folder::Folder;
use crate::live::lab::names::Refusal;

/// Facts about this program for its page.
#[derive(Debug, Clone)]
pub(crate) struct ProgramFacts {
    /// Name of the program.
    pub(crate) name: String,
    /// Built-in experiments, as JSON.
    pub(crate) experiments: serde_json::Value,
    /// Names and summaries of the templates of files.
    pub(crate) templates: Vec<(&'static str, &'static str)>,
}

/// This program in the folder of the laboratory.
#[derive(Debug, Clone)]
pub(super) struct Program {
    path: PathBuf,
    folder: PathBuf,
    /// Module of interactive pages, instead of the program's.
    module: Option<PathBuf>,
}

impl Program {
    /// Finds the program of this process.
    ///
    /// # Errors
    /// [`Error::Usage`] for a missing module, and [`Error::Other`] where the system does not name the program.
    pub(super) fn here(folder: &Folder, module: Option<&Path>) -> Result<Self, Error> {
        let path = std::env::current_exe();
        let path = path.map_err(|error| Error::Other(format!("the program of this process: {error}")))?;
        let absolute = |module: &Path| {
            fs::canonicalize(module).map_err(|error| Error::Usage(format!("{}: {error}", module.display())))
        };
        Ok(Self { path, folder: folder.path().into(), module: module.map(absolute).transpose()? })
    }

    /// Adds the module to the words of a command that makes an interactive page.
    pub(super) fn with_module(&self, mut words: Vec<String>) -> Vec<String> {
        words.extend(self.module.iter().flat_map(|module| ["--module".to_owned(), module.display().to_string()]));
        words
    }

    fn command(&self, words: &[String]) -> Command {
        let mut command = Command::new(&self.path);
        command.args(words).current_dir(&self.folder).stdin(Stdio::null());
        command
    }

    /// Runs a command to its end, and returns its output.
    ///
    /// # Errors
    /// [`Refusal`] with the errors that the command prints.
    pub(super) fn output(&self, words: &[String], input: Option<&str>) -> Result<Vec<u8>, Refusal> {
        let failed = |error| Refusal::new(500, format!("cannot start {}: {error}", self.path.display()));
        let mut command = self.command(words);
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        if input.is_some() {
            command.stdin(Stdio::piped());
        }
        let mut child = command.spawn().map_err(failed)?;
        // The command reads all of its input before it writes. If it ends early, its error has the reason.
        if let (Some(text), Some(mut stdin)) = (input, child.stdin.take()) {
            let _ = stdin.write_all(text.as_bytes());
        }
        let output = child.wait_with_output().map_err(failed)?;
        if output.status.success() {
            return Ok(output.stdout);
        }
        let text = String::from_utf8_lossy(&output.stderr);
        let lines: Vec<&str> = text.lines().map(|line| line.strip_prefix("error: ").unwrap_or(line)).collect();
        Err(Refusal::new(422, lines.join("\n")))
    }

    /// Starts a command in its own group, so that it continues without this process.
    pub(super) fn start(&self, words: &[String], out: File, log: File) -> std::io::Result<Child> {
        let mut command = self.command(words);
        command.stdout(out).stderr(log);
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        command.spawn()
    }
}
