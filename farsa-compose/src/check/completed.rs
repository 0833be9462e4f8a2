//! Registered parts of a document, with the defaults of their keys.

use farsa_lab::Error;
use serde_json::{Map, Value};

use crate::check::source::Source;
use crate::document::{Document, ObjectKind, RewardKind, Wrapper};
use crate::part::definition::{Build, Maker};

/// Adds the defaults of keys to those of a part.
fn complete_keys(
    what: &'static str,
    kind: &str,
    keys: &mut Map<String, Value>,
    (path, source): (&str, &Source),
) -> Result<(), Error> {
    let definition = source.registry.definition(kind, what);
    let definition = definition.ok_or_else(|| source.wrong(path, format!("`{kind}` is no {what}")))?;
    *keys = (definition.complete)(keys).map_err(|why| source.wrong(path, why))?;
    Ok(())
}

/// Adds the defaults of a registered term.
///
/// # Errors
/// [`Error::Setting`] for keys that the term refuses.
pub(crate) fn complete_term(term: &mut RewardKind, path: &str, source: &Source) -> Result<(), Error> {
    complete_keys("term", &term.kind, &mut term.keys, (path, source))
}

/// Adds the defaults of registered parts to a document.
///
/// # Errors
/// [`Error::Setting`] for keys that the part refuses.
pub(crate) fn complete(document: &mut Document, source: &Source) -> Result<(), Error> {
    let completed = |what: &'static str, kind: &str, keys: &mut Map<String, Value>, path: &str| {
        complete_keys(what, kind, keys, (path, source))
    };
    let wrapped = |wrappers: &mut [Wrapper], path: &str| {
        for (number, wrapper) in wrappers.iter_mut().enumerate() {
            completed("wrapper", &wrapper.kind, &mut wrapper.keys, &format!("{path}/wrappers/{number}"))?;
        }
        Ok::<(), Error>(())
    };
    for (index, sensor) in document.sensors.iter_mut().enumerate() {
        let path = format!("/sensors/{index}");
        wrapped(&mut sensor.wrappers, &path)?;
        completed("sensor", &sensor.kind.kind, &mut sensor.kind.keys, &path)?;
    }
    for (index, motor) in document.motors.iter_mut().enumerate() {
        let path = format!("/motors/{index}");
        wrapped(&mut motor.wrappers, &path)?;
        completed("motor", &motor.kind.kind, &mut motor.kind.keys, &path)?;
    }
    for (index, term) in document.reward.iter_mut().enumerate() {
        complete_term(&mut term.kind, &format!("/reward/{index}"), source)?;
    }
    for (index, start) in document.start.iter_mut().enumerate() {
        completed("placement", &start.how.at, &mut start.how.keys, &format!("/start/{index}"))?;
    }
    let network = &mut document.network.kind;
    completed("network", &network.kind, &mut network.keys, "/network")?;
    for (index, object) in document.objects.iter_mut().enumerate() {
        completed("thing", &object.kind.kind, &mut object.kind.keys, &format!("/objects/{index}"))?;
    }
    let groups = document.robots.iter_mut().map(|group| &mut group.robot);
    for robot in document.robot.iter_mut().chain(groups) {
        robot.kind.joints = matches!(source.registry.robot(&robot.kind), Some(Maker::Joints(_) | Maker::File));
    }
    Ok(())
}

/// Gives things their shapes, and replaces those that consist of several.
///
/// # Errors
/// [`Error::Setting`] for a thing that cannot be built.
pub(crate) fn expand(document: &mut Document, source: &Source) -> Result<(), Error> {
    // The first parts keep the numbers of the file, so messages about them have their places.
    let mut further = Vec::new();
    for (index, object) in document.objects.iter_mut().enumerate() {
        let ObjectKind { kind, keys } = &object.kind;
        let path = format!("/objects/{index}");
        let build =
            source.registry.find(kind, |build| if let Build::Thing(build) = build { Some(build) } else { None });
        let build = build.ok_or_else(|| source.wrong(&path, format!("`{kind}` is no thing")))?;
        let mut things = build(keys, object).map_err(|error| source.at(&path, error))?;
        if things.is_empty() {
            return Err(source.wrong(&path, format!("`{kind}` consists of no things")));
        }
        if things.iter().any(|thing| thing.shape.is_none()) {
            return Err(source.wrong(&path, format!("`{kind}` consists of things without a shape")));
        }
        further.extend(things.split_off(1));
        *object = things.remove(0);
    }
    document.objects.append(&mut further);
    Ok(())
}

/// Returns the function that builds a part, or an error if the part is for robots of the other kind.
pub(crate) fn builder<'r, T>(
    (kind, path, source): (&str, &str, &'r Source),
    other: &'static str,
    build: impl Fn(&'r Build) -> Option<Option<T>>,
) -> Result<T, Error> {
    source.registry.find(kind, build).flatten().ok_or_else(|| source.wrong(path, other))
}

/// Returns the first channel of a sensor and the one after the last.
pub(crate) fn channels_of(
    sensors: &[(String, [usize; 2])],
    name: &str,
    path: &str,
    source: &Source,
) -> Result<[usize; 2], Error> {
    let names = sensors.iter().map(|(name, _)| name.as_str());
    let number = source.position(names, ("sensor", name), path)?;
    Ok(sensors[number].1)
}
