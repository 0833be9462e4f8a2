//! Registered parts, and the schema with their keys.

use std::sync::Arc;

use farsa_lab::Error;
use farsa_lab::advanced::Part;
use serde_json::{Value, json};

use crate::check::schema::{SCHEMA, admit_bare_formulas, close, scene_schema};
use crate::document::{Document, Ending, MotorKind, NetworkKind, Placing, RewardKind, RobotKind, SensorKind};
use crate::name::is_name;
use crate::part::definition::{Build, Definition, Maker};
use crate::part::motor::AnyMotor;
use crate::part::network::AnyNetworkPart;
use crate::part::sensor::AnySensor;
use crate::part::start::AnyStart;
use crate::part::term::AnyTerm;

/// Registered parts.
#[derive(Clone, Debug, Default)]
pub(crate) struct Registry {
    definitions: Arc<Vec<Definition>>,
    /// Schema of a file, and of a file with objects only.
    pub(crate) schemas: Arc<[Value; 2]>,
}

/// Name in the schema of the kinds of a definition, the key that selects one, and the name in messages.
fn place(build: &Build) -> (&'static str, &'static str, &'static str) {
    match build {
        Build::Sensor(..) => ("Sensor", "kind", "sensor"),
        Build::Motor(..) => ("Motor", "kind", "motor"),
        Build::Term(..) => ("Reward", "kind", "term"),
        Build::Start(..) => ("Start", "at", "placement"),
        Build::End(..) => ("Ending", "", "end"),
        Build::Wrapper(_) => ("Wrapper", "kind", "wrapper"),
        Build::Network(_) => ("Network", "kind", "network"),
        Build::Thing(_) => ("Object", "kind", "thing"),
        Build::Robot(_) => ("RobotKind", "", "robot"),
    }
}

impl Registry {
    /// Creates a registry without parts.
    pub(crate) fn empty() -> Self {
        Self { definitions: Arc::default(), schemas: Arc::new([SCHEMA.clone(), Value::Null]) }
    }

    /// Adds parts, of which those of other crates are ignored.
    ///
    /// # Errors
    /// [`Error::Usage`] for a name that is invalid or taken, and for keys that a file cannot have.
    pub(crate) fn with(&self, parts: &[Part]) -> Result<Self, Error> {
        let definitions = parts.iter().filter_map(Part::definition::<Definition>).cloned();
        let definitions: Vec<Definition> = definitions.collect();
        if definitions.is_empty() {
            return Ok(self.clone());
        }
        let mut schema = self.schemas[0].clone();
        for definition in &definitions {
            let (kinds, tag, what) = place(&definition.build);
            let wrong = |why: &str| Error::Usage(format!("the {what} `{}` of this program {why}", definition.name));
            if !is_name(definition.name) {
                return Err(wrong("has no valid name: 1 to 40 lower-case letters, digits, - and _"));
            }
            if tag.is_empty() {
                add_word(&mut schema, definition, kinds).map_err(wrong)?;
            } else {
                add_branch(&mut schema, definition, [kinds, tag]).map_err(|why| wrong(&why))?;
            }
        }
        admit_bare_formulas(&mut schema);
        let scene = scene_schema(&schema);
        let definitions = self.definitions.iter().cloned().chain(definitions).collect();
        Ok(Self { definitions: Arc::new(definitions), schemas: Arc::new([schema, scene]) })
    }

    /// Finds the definition of a kind of part.
    pub(crate) fn definition(&self, name: &str, what: &str) -> Option<&Definition> {
        self.definitions.iter().find(|definition| definition.name == name && place(&definition.build).2 == what)
    }

    /// Returns the first value that `build` gives for a definition of this name.
    pub(crate) fn find<'r, T>(&'r self, name: &str, build: impl Fn(&'r Build) -> Option<T>) -> Option<T> {
        let named = self.definitions.iter().filter(|definition| definition.name == name);
        named.map(|definition| &definition.build).find_map(build)
    }

    /// Reads the facts of a sensor.
    pub(crate) fn sensor(&self, sensor: &SensorKind) -> Option<Box<dyn AnySensor>> {
        let read = self.find(&sensor.kind, |build| if let Build::Sensor(_, read) = build { Some(*read) } else { None });
        read?(&sensor.keys).ok()
    }

    /// Reads the facts of a motor.
    pub(crate) fn motor(&self, motor: &MotorKind) -> Option<Box<dyn AnyMotor>> {
        let read = self.find(&motor.kind, |build| if let Build::Motor(_, read) = build { Some(*read) } else { None });
        read?(&motor.keys).ok()
    }

    /// Reads a network.
    pub(crate) fn network(&self, network: &NetworkKind) -> Option<Result<Box<dyn AnyNetworkPart>, Error>> {
        let read = self.find(&network.kind, |build| if let Build::Network(read) = build { Some(*read) } else { None });
        read.map(|read| read(&network.keys))
    }

    /// Reads the facts of a term.
    pub(crate) fn term(&self, term: &RewardKind) -> Option<Box<dyn AnyTerm>> {
        let read = self.find(&term.kind, |build| if let Build::Term(_, read) = build { Some(*read) } else { None });
        read?(&term.keys).ok()
    }

    /// Reads the facts of a placement.
    pub(crate) fn start(&self, start: &Placing) -> Option<Box<dyn AnyStart>> {
        let read = self.find(&start.at, |build| if let Build::Start(_, read) = build { Some(*read) } else { None });
        read?(&start.keys).ok()
    }

    /// Returns true if an end of the document depends on success.
    pub(crate) fn ends_with_success(&self, document: &Document) -> bool {
        let asks = |build: &Build| if let Build::End(_, asks) = build { Some(*asks) } else { None };
        document.episode.ends.iter().any(|Ending(name)| self.find(name, asks) == Some(true))
    }

    /// Finds where a robot comes from.
    pub(crate) fn robot(&self, kind: &RobotKind) -> Option<&Maker> {
        self.find(&kind.name, |build| if let Build::Robot(maker) = build { Some(maker) } else { None })
    }
}

/// Adds a word to the kinds of robots or ends.
fn add_word(schema: &mut Value, definition: &Definition, kinds: &str) -> Result<(), &'static str> {
    let Definition { name, about, .. } = definition;
    let own = (definition.schema)().to_value();
    if own["properties"].as_object().is_some_and(|keys| !keys.is_empty()) {
        return Err("has keys, for which a word has no place");
    }
    let about = own["description"].as_str().unwrap_or(about);
    let kinds = schema.pointer_mut(&format!("/$defs/{kinds}/oneOf")).and_then(Value::as_array_mut);
    let kinds = kinds.ok_or("has no place in the schema")?;
    if kinds.iter().any(|kind| kind["const"] == *name) {
        return Err("has the name of another one");
    }
    kinds.push(json!({ "const": name, "type": "string", "description": about }));
    Ok(())
}

/// Adds the keys of a part to the kinds of a table.
fn add_branch(schema: &mut Value, definition: &Definition, [kinds, tag]: [&str; 2]) -> Result<(), String> {
    let name = definition.name;
    let mut own = (definition.schema)().to_value();
    close(&mut own);
    let shared = own.get_mut("$defs").map(Value::take).unwrap_or_default();
    // Equal types of several parts are one. Others get the name of the part.
    let known = &schema["$defs"];
    let types = shared.as_object().into_iter().flatten();
    let other = types.filter(|(key, value)| known.get(key).is_some_and(|known| known != *value));
    let other: Vec<String> = other.map(|(key, _)| key.clone()).collect();
    let rename = |key: &str| if other.iter().any(|other| other == key) { format!("{name}.{key}") } else { key.into() };
    refer(&mut own, &rename);
    let table = schema.pointer(&format!("/$defs/{kinds}")).ok_or("has no place in the schema")?;
    let common: Vec<String> =
        table["properties"].as_object().into_iter().flatten().map(|(key, _)| key.clone()).collect();
    let branches = table["oneOf"].as_array().map_or(&[][..], Vec::as_slice);
    if branches.iter().any(|branch| branch["properties"][tag]["const"] == name) {
        return Err("has the name of another one".into());
    }
    let mut properties = own.get_mut("properties").map_or_else(|| json!({}), Value::take);
    let keys = properties.as_object_mut().ok_or("has settings that are no struct with named fields")?;
    if let Some(key) = keys.keys().find(|key| *key == tag || common.contains(key)) {
        return Err(format!("has the key `{key}`, which each {} has already", kinds.to_lowercase()));
    }
    keys.insert(tag.into(), json!({ "type": "string", "const": name }));
    let mut required = vec![Value::from(tag)];
    required.extend(own["required"].as_array().cloned().unwrap_or_default());
    let about = own["description"].as_str().unwrap_or_default();
    let branch = json!({ "type": "object", "description": about, "properties": properties, "required": required });
    let list = schema.pointer_mut(&format!("/$defs/{kinds}/oneOf")).and_then(Value::as_array_mut);
    list.ok_or("has no place in the schema")?.push(branch);
    let Value::Object(shared) = shared else { return Ok(()) };
    let definitions = schema.get_mut("$defs").and_then(Value::as_object_mut).ok_or("has no place in the schema")?;
    for (key, mut value) in shared {
        refer(&mut value, &rename);
        definitions.insert(rename(&key), value);
    }
    Ok(())
}

/// Renames references, so that types of two parts may have the same name.
fn refer(value: &mut Value, rename: &dyn Fn(&str) -> String) {
    match value {
        Value::Object(map) => {
            for (key, value) in map {
                let target = value.as_str().and_then(|target| target.strip_prefix("#/$defs/"));
                match target.map(|target| format!("#/$defs/{}", rename(target))).filter(|_| key == "$ref") {
                    Some(target) => *value = target.into(),
                    None => refer(value, rename),
                }
            }
        }
        Value::Array(items) => items.iter_mut().for_each(|item| refer(item, rename)),
        _ => {}
    }
}
