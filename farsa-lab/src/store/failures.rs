//! `failures.csv`: the failed evaluations, each with its first failed trial, the reason, and a command that repeats it.

use std::path::{Path, PathBuf};

use crate::error::Error;
use crate::store::append_log::{AppendLog, Mark};
use crate::store::bounded::read_regular_if_present;

const HEADER: &str = "generation,individual,trial,why,command\n";
/// Bytes of the largest file.
const MAX_BYTES: u64 = 1 << 32;

/// A failed evaluation.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct FailedEvaluation {
    pub(crate) generation: u32,
    /// Number of the individual, counted through all populations.
    pub(crate) individual: u32,
    /// First failed trial. `None` when only the fitness failed.
    pub(crate) trial: Option<u32>,
    pub(crate) why: String,
}

impl FailedEvaluation {
    /// Returns a command that repeats the trial. `directory` is the path of the run.
    pub(crate) fn command(&self, program: &str, directory: &str) -> String {
        let Self { generation, individual, trial, .. } = self;
        let which = format!("--generation {generation} --individual {individual}");
        let trial = trial.map_or_else(String::new, |trial| format!(" --trial {trial}"));
        // A trial is replayed by one process, so the command for several ranks is replaced.
        let program = program.strip_suffix("-mpi").unwrap_or(program);
        format!("{program} replay {directory} {which}{trial}")
    }

    fn line(&self, program: &str) -> String {
        let Self { generation, individual, trial, why } = self;
        let trial = trial.map_or_else(String::new, |trial| trial.to_string());
        let quoted = |text: &str| {
            let plain: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
            format!("\"{}\"", plain.replace('"', "\"\""))
        };
        format!("{generation},{individual},{trial},{},{}\n", quoted(why), quoted(&self.command(program, ".")))
    }
}

/// Creates the file with its content and the limit on its bytes.
fn growing(path: &Path, content: &[u8]) -> Result<AppendLog, Error> {
    AppendLog::new(path, content).map(|file| file.with_limit(MAX_BYTES))
}

/// Failures of a run in progress. The file is created by the first failure.
pub(crate) struct Failures {
    path: PathBuf,
    file: Option<AppendLog>,
}

impl Failures {
    /// Opens the failures of a resumed run, up to a mark.
    ///
    /// No other file has the failures, so a file changed by another program is kept as it is.
    pub(crate) fn resume(path: &Path, mark: Mark) -> Result<Self, Error> {
        let content = read_regular_if_present(path, MAX_BYTES)?.unwrap_or_default();
        let file = match mark.within(&content) {
            Some([]) if content.is_empty() || content.starts_with(HEADER.as_bytes()) => {
                AppendLog::remove(path)?;
                None
            }
            Some(kept) if !kept.is_empty() => Some(growing(path, kept)?),
            _ if content.is_empty() => Some(growing(path, HEADER.as_bytes())?),
            _ => Some(growing(path, &content)?),
        };
        Ok(Self { path: path.into(), file })
    }

    /// Appends the failures of a generation.
    pub(crate) fn append(&mut self, failed: &[FailedEvaluation], program: &str) -> Result<(), Error> {
        if failed.is_empty() {
            return Ok(());
        }
        let lines: String = failed.iter().map(|failed| failed.line(program)).collect();
        if let Some(file) = &mut self.file {
            return file.append(lines.as_bytes());
        }
        self.file = Some(growing(&self.path, format!("{HEADER}{lines}").as_bytes())?);
        Ok(())
    }

    /// Synchronizes the file with the disk and returns its mark.
    pub(crate) fn sync(&mut self) -> Result<Mark, Error> {
        self.file.as_mut().map_or(Ok(Mark::default()), AppendLog::sync)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn failed(generation: u32, trial: Option<u32>) -> FailedEvaluation {
        FailedEvaluation { generation, individual: 3, trial, why: "panicked: \"no\"\nreason (x.rs:1)".into() }
    }

    #[test]
    fn lines_name_the_trial_and_the_command() {
        let line = failed(2, Some(1)).line("farsa");
        let command = "farsa replay . --generation 2 --individual 3 --trial 1";
        assert_eq!(line, format!("2,3,1,\"panicked: \"\"no\"\" reason (x.rs:1)\",\"{command}\"\n"));
        assert!(failed(2, None).line("mine").ends_with(",\"mine replay . --generation 2 --individual 3\"\n"));
    }

    #[test]
    fn there_is_a_file_once_something_failed_and_it_is_rewound() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("failures.csv");
        let mut failures = Failures::resume(&path, Mark::default()).unwrap();
        failures.append(&[], "farsa").unwrap();
        assert!(failures.sync().unwrap().is_empty() && !path.exists());
        failures.append(&[failed(1, None), failed(1, Some(2))], "farsa").unwrap();
        let mark = failures.sync().unwrap();
        let text = fs::read_to_string(&path).unwrap();
        assert!(text.starts_with(HEADER) && text.lines().count() == 3);
        failures.append(&[failed(2, None)], "farsa").unwrap();
        drop(failures);
        let mut failures = Failures::resume(&path, mark).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), text);
        assert_eq!(failures.sync().unwrap(), mark);
        // The run was killed before its first save with a failure.
        Failures::resume(&path, Mark::default()).unwrap();
        assert!(!path.exists());
        // Remarks by the user are kept, and a missing file is created again.
        fs::write(&path, "mine\n").unwrap();
        Failures::resume(&path, mark).unwrap().append(&[failed(3, None)], "farsa").unwrap();
        assert!(fs::read_to_string(&path).unwrap().starts_with("mine\n3,3,,"));
        fs::remove_file(&path).unwrap();
        Failures::resume(&path, mark).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), HEADER);
    }
}
