//! Changes of replayed trials: of the controller by a list, and of bodies by a file of a page.

use std::path::Path;

use crate::error::Error;
use crate::experiment::disturbances::Disturbances;
use crate::store::bounded::read_stream_text;

/// Most bytes of a file. A move has about 100.
const MAX_BYTES: u64 = 4 << 20;

/// Changes of trials.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TrialChanges {
    /// Changes of the controller, such as `neuron:3`.
    pub(crate) lesion: Option<String>,
    /// Bodies that are moved or pushed, with their numbers in a page.
    pub(crate) disturbances: Disturbances,
}

impl TrialChanges {
    /// Reads the changes of the command line, which are `None` without an option.
    ///
    /// # Errors
    /// [`Error::Usage`] for an unreadable or invalid file.
    pub(crate) fn read(lesion: Option<&str>, file: Option<&Path>) -> Result<Option<Self>, Error> {
        if lesion.is_none() && file.is_none() {
            return Ok(None);
        }
        let read = |path: &Path| {
            let wrong = |error| Error::Usage(format!("{}: no moves and pushes of a trial: {error}", path.display()));
            serde_json::from_str(&read_stream_text(path, MAX_BYTES)?).map_err(wrong)
        };
        let disturbances = file.map(read).transpose()?.unwrap_or_default();
        Ok(Some(Self { lesion: lesion.map(str::to_owned), disturbances }))
    }

    /// Lists the changes.
    pub(crate) fn in_words(&self) -> String {
        let all: Vec<String> = self.lesion.iter().cloned().chain(self.disturbances.remarks()).collect();
        if all.is_empty() { "no changes".into() } else { all.join(", ") }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_has_moves_and_pushes_alone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("changes.json");
        let read = |text: &str| {
            std::fs::write(&path, text).unwrap();
            TrialChanges::read(Some("neuron:3"), Some(&path))
        };
        let changes = read(
            r#"{"moves":[{"step":1,"body":2,"position":[0.1,0,1],"rotation":[0,0,0,1]}],
                "pushes":[{"steps":[1,2],"body":0,"point":[0,0,0],"force":[0,0,1]}]}"#,
        );
        let changes = changes.unwrap().unwrap();
        assert_eq!(changes.in_words(), "neuron:3, 1 moved, 1 pushed");
        assert_eq!((changes.disturbances.moves[0].position, changes.disturbances.moves[0].step), ([0.1, 0.0, 1.0], 1));
        for (wrong, why) in [
            ("", "EOF while parsing a value at line 1 column 0"),
            (r#"{"moved":[]}"#, "unknown field `moved`, expected `moves` or `pushes`"),
            (r#"{"pushes":[{"steps":[1]}]}"#, "line 1 column"),
            (r#"{"moves":[{"step":-1}]}"#, "expected u32"),
        ] {
            let error = read(wrong).unwrap_err().to_string();
            assert!(error.contains("changes.json: no moves and pushes of a trial: ") && error.contains(why), "{error}");
        }
        assert_eq!(TrialChanges::read(None, None).unwrap(), None);
        assert!(TrialChanges::read(None, Some(&folder.path().join("none"))).is_err());
    }
}
