//! Infrared tables from files that a document names.

use std::sync::Arc;

use farsa_body::sensors::infrared::{InfraredTable, InfraredTables};
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::PartScene;

/// Files of measured infrared readings, in the folder of the experiment's file or below it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub(super) struct MeasuredTables {
    /// Readings near a wall.
    walls: String,
    /// Readings near round things. Each thing takes the file of the nearest radius.
    #[serde(default)]
    bodies: Vec<MeasuredBody>,
}

/// A file of readings near a round thing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
struct MeasuredBody {
    /// Name of the file.
    file: String,
    /// Radius of the thing [m].
    #[schemars(range(min = 0.0001, max = 10.0))]
    radius: f64,
}

impl MeasuredTables {
    /// Lists the files with their keys.
    pub(super) fn files(&self) -> Vec<(String, String)> {
        let bodies = self.bodies.iter().enumerate();
        let bodies = bodies.map(|(index, body)| (format!("tables/bodies/{index}/file"), body.file.clone()));
        std::iter::once(("tables/walls".into(), self.walls.clone())).chain(bodies).collect()
    }

    /// Reads the tables of a sensor. All robots share them.
    pub(super) fn read(&self, scene: &PartScene<'_>) -> Result<Arc<InfraredTables>, Error> {
        let files = scene.0.files().ok_or_else(|| scene.error("has no files"))?;
        let path = scene.0.path();
        if let Some(known) = files.tables.borrow().get(path) {
            return Ok(Arc::clone(known));
        }
        let read = |name: &str, key: &str| {
            let text = files.contents.get(name).map(String::as_str).unwrap_or_default();
            let table = InfraredTable::parse(text);
            table.map_err(|error| scene.0.error_at(&format!("tables/{key}"), format!("{name}: {error}")))
        };
        let walls = read(&self.walls, "walls")?;
        let bodies = self.bodies.iter().enumerate();
        let bodies =
            bodies.map(|(index, body)| Ok((body.radius as f32, read(&body.file, &format!("bodies/{index}"))?)));
        let made = InfraredTables::new(walls, bodies.collect::<Result<Vec<_>, Error>>()?);
        let made = Arc::new(made.map_err(|error| scene.0.error_at("tables", error.to_string()))?);
        files.tables.borrow_mut().insert(path.into(), Arc::clone(&made));
        Ok(made)
    }
}
