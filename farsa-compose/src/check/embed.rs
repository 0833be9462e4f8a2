//! Embeds the files that a text names, so that a run with this text needs no other file.

use std::fmt::Write as _;
use std::path::{Component, Path};

use farsa_lab::Error;
use farsa_lab::advanced::read_text_file;
use farsa_models::ReadOptions;

use crate::check::registry::Registry;
use crate::check::source::Source;
use crate::document::Document;
use crate::jointed::drawn_meshes;
use crate::jointed::robot_model::model_options;

/// Most bytes of a named file.
const MAX_BYTES: u64 = 1_000_000;
/// Most named files.
const MAX_FILES: usize = 16;

/// Path of the file of a robot.
const MODEL: &str = "/robot/file";

/// Returns the text of a model with the files that it includes, and with primitives for its meshes, and the text of the
/// meshes for pages.
///
/// All of its files are in the experiment's folder or below it, and so are its packages.
fn merged(target: &Path, root: &Path) -> Result<(String, Option<String>), String> {
    let options = ReadOptions { root: Some(root.into()), packages: vec![root.into()], ..model_options() };
    let text = farsa_models::self_contained(target, &options).map_err(|error| error.to_string())?.text;
    if text.len() as u64 > MAX_BYTES {
        return Err(format!("has {} bytes with its included files, more than {MAX_BYTES}", text.len()));
    }
    Ok((text, drawn_meshes::text_of(target, &options)))
}

/// Lists the names of files in a document, with their paths.
fn named(document: &Document, registry: &Registry) -> Vec<(String, String)> {
    let scene = document.world.scene.as_deref().map(|name| ("/world/scene".to_owned(), name));
    let model = document.robot.as_ref().and_then(|robot| robot.file.as_deref()).map(|name| (MODEL.to_owned(), name));
    let files = scene.into_iter().chain(model).map(|(path, name)| (path, name.to_owned()));
    let network = registry.network(&document.network.kind).and_then(Result::ok);
    let network = network.map_or_else(Vec::new, |network| network.files());
    let network = network.into_iter().map(|(key, name)| (format!("/network/{key}"), name));
    let mut files: Vec<(String, String)> = files.chain(network).collect();
    let demonstrations = document.learning.iter().flat_map(|learning| learning.demonstrations.iter().enumerate());
    files.extend(demonstrations.map(|(index, name)| (format!("/learning/demonstrations/{index}"), name.clone())));
    for (index, sensor) in document.sensors.iter().enumerate() {
        let of_part = registry.sensor(&sensor.kind).map_or_else(Vec::new, |sensor| sensor.files());
        files.extend(of_part.into_iter().map(|(key, name)| (format!("/sensors/{index}/{key}"), name)));
    }
    files
}

/// Returns a text with the contents of the files that its document names, unless it has them already. The files are
/// read from `folder`, the folder of `file`.
///
/// Without a folder the text must contain them, because the text of a run is untrusted.
pub(crate) fn embedded(
    file: &str,
    text: &str,
    folder: Option<&Path>,
    document: &Document,
    source: &Source,
) -> Result<Option<String>, Error> {
    let named = named(document, &source.registry);
    if !document.files.is_empty() {
        for (path, name) in named {
            if !document.files.contains_key(&name) {
                let names = document.files.keys().map(String::as_str);
                return Err(Error::unknown(&source.of(&path), "file", &name, names));
            }
        }
        return Ok(None);
    }
    let Some(folder) = folder else {
        let first = named.first();
        return first.map_or(Ok(None), |(path, name)| {
            let why = format!("`{name}` is not in the table `files`, and a text that is no file reads no others");
            Err(source.wrong(path, why))
        });
    };
    let mut contents: Vec<(String, String)> = Vec::new();
    let mut meshes = None;
    for (path, name) in named {
        if contents.iter().any(|(known, _)| *known == name) {
            continue;
        }
        if contents.len() == MAX_FILES {
            return Err(source.wrong(&path, format!("is one file more than {MAX_FILES}, which are the most")));
        }
        let relative = Path::new(&name);
        // No root and no parent folder. A backslash would separate folders on other systems.
        let within = relative.components().all(|part| matches!(part, Component::Normal(_)));
        if !within || name.is_empty() || name.contains('\\') {
            return Err(source.wrong(&path, format!("`{name}` is no file in the folder of {file} or below it")));
        }
        let target = folder.join(relative);
        // Links may lead anywhere. A missing file is reported when it is read.
        // The folder of a bare file name is empty, and an empty path has no canonical form.
        let root = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let ends = target.canonicalize().and_then(|target| Ok((target, root.canonicalize()?)));
        let inside = ends.is_ok_and(|(target, root)| target.starts_with(root)) || !target.exists();
        if !inside {
            return Err(source.wrong(&path, format!("`{name}` leads out of the folder of {file}")));
        }
        let mut content = read_text_file(&target, MAX_BYTES).map_err(|error| source.wrong(&path, error))?;
        if path == MODEL && ["<include", "<mesh"].iter().any(|part| content.contains(part)) {
            let merged = merged(&target, root).map_err(|why| source.wrong(&path, format!("{name}: {why}")))?;
            content = merged.0;
            meshes = merged.1.map(|text| (drawn_meshes::text_name(&name), text));
        }
        contents.push((name, content));
    }
    if contents.is_empty() {
        return Ok(None);
    }
    let mut text = format!("{}\n\n[files]\n", text.trim_end());
    // Another file may have the name of the meshes.
    let meshes = meshes.filter(|(name, _)| contents.iter().all(|(other, _)| other != name));
    for (name, content) in contents.into_iter().chain(meshes) {
        // Writing into a string cannot fail.
        let _ = writeln!(text, "{} = {}", toml::Value::String(name), toml::Value::String(content));
    }
    Ok(Some(text))
}
