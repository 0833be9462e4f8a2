//! The parts of the format, registered like those of a program.

use std::sync::LazyLock;

use farsa_lab::Error;
use farsa_lab::advanced::Part;
use serde_json::Value;

use crate::check::registry::Registry;
use crate::ends::ends;
use crate::motors::motors;
use crate::networks::networks;
use crate::robots::robots;
use crate::sensors::sensors;
use crate::starts::starts;
use crate::terms::terms;
use crate::things::things;
use crate::wrappers::wrappers;

fn built_in() -> Vec<Part> {
    let parts = [robots(), sensors(), motors(), wrappers(), networks(), terms(), starts(), ends(), things()];
    parts.into_iter().flatten().collect()
}

/// Registry of the format, whose schemas are built once because each takes a megabyte.
static BUILT_IN: LazyLock<Registry> = LazyLock::new(|| {
    // A test builds the same registry, so an error cannot occur later.
    Registry::empty().with(&built_in()).unwrap_or_default()
});

/// Returns the registry of the format with the parts of a program.
///
/// # Errors
/// [`Error::Usage`] for a name that is invalid or taken, and for keys that a file cannot have.
pub(crate) fn registry(parts: &[Part]) -> Result<Registry, Error> {
    BUILT_IN.with(parts)
}

/// Creates the JSON schema of the format. You can use it to check files in an editor, for example.
pub fn schema() -> Value {
    BUILT_IN.schemas[0].clone()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::schema::SCHEMA;

    /// No kind of part is in the format without its registration, and the registered ones are in the schema.
    #[test]
    fn all_parts_of_the_format_are_registered() {
        let tables = ["Sensor", "Motor", "Wrapper", "Network", "Reward", "Start", "Ending", "Object", "RobotKind"];
        let kinds = |schema: &Value, table: &str| schema["$defs"][table]["oneOf"].as_array().unwrap().len();
        assert!(tables.iter().all(|table| kinds(&SCHEMA, table) == 0));
        let schema = schema();
        let count: usize = tables.iter().map(|table| kinds(&schema, table)).sum();
        assert_eq!(count, built_in().len());
        assert!(tables.iter().all(|table| kinds(&schema, table) > 2), "{count}");
    }
}
