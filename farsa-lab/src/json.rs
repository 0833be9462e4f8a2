//! JSON for reading.

use serde::Serialize;

use crate::error::Error;

/// Anything as JSON for reading, with the end of the last line.
pub(crate) fn pretty(what: &impl Serialize) -> Result<String, Error> {
    serde_json::to_string_pretty(what).map(|text| text + "\n").map_err(|error| Error::Other(error.to_string()))
}
