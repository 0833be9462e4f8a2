//! The setting that selects the model of the infrared sensors. Some of the models are based on measured tables.

use std::path::PathBuf;

use farsa_lab::advanced::{Value, read_text_file};
use farsa_lab::{Error, Settings};
use toml::{Table, Value as Toml};

const MODEL: &str = "robot.infrared";
/// The key of the file that chooses the model.
const KEY: &str = "sensors.infrared.model";
const TABLES: &str = "robot.infrared_tables";

/// The measured tables in a directory. Each table of a round body has the radius at which it was measured \[m\].
const WALLS: &str = "wall.sam";
const BODIES: [(&str, f64); 2] = [("small.sam", 0.0125), ("round.sam", 0.027)];

/// The most bytes of a table.
const MAX_BYTES: u64 = 256_000_000;

/// Returns the tables that the sensors read under these settings: of walls, then of bodies.
///
/// # Errors
/// [`Error::Setting`] for measured tables without a directory.
pub(crate) fn files(settings: &Settings) -> Result<Vec<PathBuf>, Error> {
    if !settings.has(TABLES) {
        return Ok(Vec::new());
    }
    let directory = settings.text(TABLES)?;
    match (settings.word(MODEL)?, directory.is_empty()) {
        ("sampled", true) => {
            Err(Error::setting(TABLES, format!("names no directory of tables, which `{MODEL} = \"sampled\"` needs")))
        }
        ("sampled" | "auto", false) => {
            let names = std::iter::once(WALLS).chain(BODIES.map(|(name, _)| name));
            Ok(names.map(|name| PathBuf::from(directory).join(name)).collect())
        }
        _ => Ok(Vec::new()),
    }
}

/// Returns the text of an experiment with the measured tables of these settings, if there are any.
///
/// # Errors
/// The errors of [`files`], [`Error::Io`] and [`Error::File`] for a file that cannot be read.
pub(crate) fn with_tables(text: &str, settings: &Settings) -> Result<Option<String>, Error> {
    let paths = files(settings)?;
    let Some((walls, bodies)) = paths.split_first() else { return Ok(None) };
    let refused = |error: &dyn std::fmt::Display| Error::Other(error.to_string());
    let mut document: Table = toml::from_str(text).map_err(|error| refused(&error))?;
    let name = |path: &PathBuf| Toml::String(path.display().to_string());
    let body = |(path, (_, radius)): (&PathBuf, (&str, f64))| {
        Toml::Table(Table::from_iter([("file".into(), name(path)), ("radius".into(), Toml::Float(radius))]))
    };
    let bodies = bodies.iter().zip(BODIES).map(body).collect();
    let tables = Table::from_iter([("walls".into(), name(walls)), ("bodies".into(), Toml::Array(bodies))]);
    let sensors = document.get_mut("sensors").and_then(Toml::as_array_mut).into_iter().flatten();
    for sensor in sensors.filter_map(Toml::as_table_mut) {
        if sensor.get("kind").and_then(Toml::as_str) == Some("infrared") {
            sensor.insert("model".into(), Toml::String("tables".into()));
            sensor.insert("tables".into(), Toml::Table(tables.clone()));
        }
    }
    // Conditions with another model are those of robots without measured tables.
    if let Some(conditions) = document.get_mut("conditions").and_then(Toml::as_array_mut) {
        conditions.retain(|condition| condition.get("settings").is_none_or(|settings| settings.get(KEY).is_none()));
    }
    let content = |path: &PathBuf| Ok((path.display().to_string(), Toml::String(read_text_file(path, MAX_BYTES)?)));
    let contents = paths.iter().map(content).collect::<Result<Table, Error>>()?;
    document.insert("files".into(), Toml::Table(contents));
    toml::to_string(&document).map(Some).map_err(|error| refused(&error))
}

/// Chooses between the models without tables.
///
/// # Errors
/// None for the settings of an embedded experiment.
pub(crate) fn choose(settings: &Settings, values: &mut Settings) -> Result<(), Error> {
    if !settings.has(TABLES) {
        return Ok(());
    }
    let model = if settings.word(MODEL)? == "rays" { "rays" } else { "analytic" };
    values.set("", KEY, Value::Word(model.into()))
}

/// An error of a text with tables as one of the setting that names them.
pub(crate) fn blame(error: Error) -> Error {
    match error {
        Error::Setting { why, .. } => Error::setting(TABLES, why),
        error => error,
    }
}
