//! Infrared tables from files that a document names.

use std::collections::BTreeMap;
use std::sync::Arc;

use farsa_body::sensors::infrared::{InfraredTable, InfraredTables};
use farsa_lab::Error;

use crate::check::source::Source;
use crate::document::MeasuredTables;

/// Contents of files by name, and the tables already read, by the paths of their sensors.
pub(crate) struct Files<'f> {
    contents: &'f BTreeMap<String, String>,
    tables: BTreeMap<String, Arc<InfraredTables>>,
}

impl<'f> Files<'f> {
    pub(crate) fn new(contents: &'f BTreeMap<String, String>) -> Self {
        Self { contents, tables: BTreeMap::new() }
    }
}

/// Returns the tables of the sensor at a path. All robots share them.
pub(crate) fn measured(
    tables: &MeasuredTables,
    files: &mut Files<'_>,
    path: &str,
    source: &Source,
) -> Result<Arc<InfraredTables>, Error> {
    if let Some(known) = files.tables.get(path) {
        return Ok(Arc::clone(known));
    }
    let read = |name: &str, place: &str| {
        let text = files.contents.get(name).map(String::as_str).unwrap_or_default();
        let table = InfraredTable::parse(text);
        table.map_err(|error| source.wrong(&format!("{path}/tables/{place}"), format!("{name}: {error}")))
    };
    let walls = read(&tables.walls, "walls")?;
    let bodies = tables.bodies.iter().enumerate();
    let bodies = bodies.map(|(index, body)| Ok((body.radius as f32, read(&body.file, &format!("bodies/{index}"))?)));
    let made = InfraredTables::new(walls, bodies.collect::<Result<Vec<_>, Error>>()?);
    let made = Arc::new(made.map_err(|error| source.wrong(&format!("{path}/tables"), error))?);
    files.tables.insert(path.into(), Arc::clone(&made));
    Ok(made)
}
