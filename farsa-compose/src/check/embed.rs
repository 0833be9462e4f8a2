//! Files that a text names, put into the text: a run that keeps the text needs no others.

use std::fmt::Write as _;
use std::path::{Component, Path};

use farsa_lab::{Error, read_text_file};

use crate::check::places::Places;
use crate::document::{Document, NetworkKind, SensorKind};

/// The most bytes of a file that a text names.
const MOST_BYTES: u64 = 1_000_000;
/// The most files that a text names.
const MOST_FILES: usize = 16;

/// The names of files in a document, with the paths where they stand.
fn named(document: &Document) -> Vec<(String, &str)> {
    let scene = document.world.scene.as_deref().map(|name| ("/world/scene".to_owned(), name));
    let model =
        document.robot.as_ref().and_then(|robot| robot.file.as_deref()).map(|name| ("/robot/file".to_owned(), name));
    let network = if let NetworkKind::Evonet(evonet) = &document.network.kind { evonet.file.as_deref() } else { None };
    let network = network.map(|name| ("/network/file".to_owned(), name));
    let mut found: Vec<(String, &str)> = scene.into_iter().chain(model).chain(network).collect();
    for (index, sensor) in document.sensors.iter().enumerate() {
        let SensorKind::Infrared { tables: Some(tables), .. } = &sensor.kind else { continue };
        let path = format!("/sensors/{index}/tables");
        found.push((format!("{path}/walls"), tables.walls.as_str()));
        let bodies = tables.bodies.iter().enumerate();
        found.extend(bodies.map(|(index, body)| (format!("{path}/bodies/{index}/file"), body.file.as_str())));
    }
    found
}

/// A text with the files that its document names, where it has none of them yet; they are read from `folder`, which is that of
/// `file`.
///
/// Without a folder the text has to have them all, and no file is read: a text that a run has kept comes from anyone.
///
/// # Errors
/// [`Error::Setting`] for a name that leads out of the folder, for too many files, and for a file without a folder,
/// [`Error::Unknown`] for a file that is not among those of the text, [`Error::Io`] and [`Error::Damaged`] for what cannot be
/// read.
pub(crate) fn embedded(
    file: &str,
    text: &str,
    folder: Option<&Path>,
    document: &Document,
    places: &Places,
) -> Result<Option<String>, Error> {
    let named = named(document);
    if !document.files.is_empty() {
        for (path, name) in named {
            if !document.files.contains_key(name) {
                let known = document.files.keys().map(String::as_str);
                return Err(Error::unknown(&places.of(&path), "file", name, known));
            }
        }
        return Ok(None);
    }
    let Some(folder) = folder else {
        let first = named.first();
        return first.map_or(Ok(None), |(path, name)| {
            let why = format!("`{name}` is not in the table `files`, and a text that is no file reads no others");
            Err(places.wrong(path, why))
        });
    };
    let mut contents: Vec<(&str, String)> = Vec::new();
    for (path, name) in named {
        if contents.iter().any(|(known, _)| *known == name) {
            continue;
        }
        if contents.len() == MOST_FILES {
            return Err(places.wrong(&path, format!("is one file more than {MOST_FILES}, which are the most")));
        }
        let own = Path::new(name);
        let within = own.components().all(|part| matches!(part, Component::Normal(_)));
        if !within || name.is_empty() || name.contains('\\') {
            return Err(places.wrong(&path, format!("`{name}` is no file in the folder of {file} or below it")));
        }
        let found = folder.join(own);
        // Links may lead anywhere; what is not there is named when it is read.
        let root = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let ends = found.canonicalize().and_then(|found| Ok((found, root.canonicalize()?)));
        let inside = ends.is_ok_and(|(found, root)| found.starts_with(root)) || !found.exists();
        if !inside {
            return Err(places.wrong(&path, format!("`{name}` leads out of the folder of {file}")));
        }
        contents.push((name, read_text_file(&found, MOST_BYTES)?));
    }
    if contents.is_empty() {
        return Ok(None);
    }
    let mut text = format!("{}\n\n[files]\n", text.trim_end());
    for (name, content) in contents {
        // Writing into a string cannot fail.
        let _ = writeln!(text, "{} = {}", toml::Value::String(name.into()), toml::Value::String(content));
    }
    Ok(Some(text))
}
