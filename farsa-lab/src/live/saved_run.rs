//! Run that a page has continued, as a small file. `farsa run --from` evolves it again, with the same bits.

use std::path::Path;

use serde::Deserialize;

use crate::error::Error;
use crate::live::run_state::StateMark;
use crate::store::bounded;

/// Value of the key `format`.
const FORMAT: &str = "farsa-saved-run";
/// Most bytes of a file. A configuration has most of them.
const MAX_BYTES: u64 = 4 << 20;

/// Content of the file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    format: String,
    version: u32,
    generation: u32,
    state_crc32: u32,
    config: String,
}

/// A configuration, with the state after the generations of the page.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct SavedRun {
    /// Content of `config.toml`.
    pub(crate) config: String,
    pub(crate) mark: StateMark,
}

impl SavedRun {
    /// Reads a file that a page has saved.
    ///
    /// # Errors
    /// [`Error::File`] for an unreadable file, and [`Error::Usage`] for another one.
    pub(crate) fn read(path: &Path) -> Result<Self, Error> {
        Self::parse(&bounded::read_regular_text(path, MAX_BYTES)?)
            .map_err(|why| Error::Usage(format!("{}: no run that a page has saved: {why}", path.display())))
    }

    fn parse(text: &str) -> Result<Self, String> {
        let File { format, version, generation, state_crc32, config } =
            serde_json::from_str(text).map_err(|error| error.to_string())?;
        if format != FORMAT {
            return Err(format!("its format is {format:?} instead of {FORMAT:?}"));
        }
        if version != 1 {
            return Err(format!("its version is {version}, and this program reads version 1"));
        }
        Ok(Self { config, mark: StateMark { generation, state_crc32 } })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_file_is_refused_with_its_fault() {
        let text = r#"{"format":"farsa-saved-run","version":1,"generation":3,"state_crc32":7,"config":"x"}"#;
        let mark = StateMark { generation: 3, state_crc32: 7 };
        assert_eq!(SavedRun::parse(text).unwrap(), SavedRun { config: "x".into(), mark });
        for (part, other, why) in [
            ("saved-run", "replay", "its format is \"farsa-replay\" instead of"),
            (":1,", ":2,", "its version is 2"),
            ("\"config\"", "\"out\"", "unknown field `out`"),
            (":3,", ":-3,", "expected u32"),
            ("}", "", "EOF"),
        ] {
            let error = SavedRun::parse(&text.replace(part, other)).unwrap_err();
            assert!(error.contains(why), "{error}");
        }
    }
}
