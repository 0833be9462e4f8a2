//! What is made of files that a document names.

use std::collections::BTreeMap;
use std::sync::Arc;

use farsa_body::sensors::infrared::{InfraredTable, InfraredTables};
use farsa_lab::Error;

use crate::check::places::Places;
use crate::document::MeasuredTables;

/// The contents of files by their names, and the tables that were made of them for sensors by their paths.
pub(crate) struct Files<'f> {
    contents: &'f BTreeMap<String, String>,
    tables: BTreeMap<String, Arc<InfraredTables>>,
}

impl<'f> Files<'f> {
    /// Those of a document.
    pub(crate) fn new(contents: &'f BTreeMap<String, String>) -> Self {
        Self { contents, tables: BTreeMap::new() }
    }
}

/// The tables of a sensor that stands at a path; all robots share them.
///
/// # Errors
/// [`Error::Setting`] for a file that is no table, and for tables that do not go together.
pub(crate) fn measured(
    tables: &MeasuredTables,
    files: &mut Files<'_>,
    path: &str,
    places: &Places,
) -> Result<Arc<InfraredTables>, Error> {
    if let Some(known) = files.tables.get(path) {
        return Ok(Arc::clone(known));
    }
    let read = |name: &str, place: &str| {
        let text = files.contents.get(name).map(String::as_str).unwrap_or_default();
        let table = InfraredTable::parse(text);
        table.map_err(|error| places.wrong(&format!("{path}/tables/{place}"), format!("{name}: {error}")))
    };
    let walls = read(&tables.walls, "walls")?;
    let bodies = tables.bodies.iter().enumerate();
    let bodies = bodies.map(|(index, body)| Ok((body.radius as f32, read(&body.file, &format!("bodies/{index}"))?)));
    let made = InfraredTables::new(walls, bodies.collect::<Result<Vec<_>, Error>>()?);
    let made = Arc::new(made.map_err(|error| places.wrong(&format!("{path}/tables"), error))?);
    files.tables.insert(path.into(), Arc::clone(&made));
    Ok(made)
}
