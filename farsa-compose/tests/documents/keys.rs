//! Generates docs/experiment-keys.csv from the schema, and checks that the file is current.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use serde_json::{Map, Value};

/// Rows of the table, with the definitions that have rows already.
struct Table {
    root: Value,
    rows: Vec<[String; 7]>,
    /// Definitions with the place of their rows.
    placed: Vec<(String, String)>,
}

/// Fields of a part over those of its definition, with the keys of both.
fn merged(mut definition: Map<String, Value>, own: Map<String, Value>) -> Map<String, Value> {
    for (name, value) in own {
        match (name.as_str(), definition.get_mut(&name), value) {
            ("properties", Some(Value::Object(keys)), Value::Object(more)) => keys.extend(more),
            ("required", Some(Value::Array(keys)), Value::Array(more)) => keys.extend(more),
            (_, _, value) => drop(definition.insert(name, value)),
        }
    }
    definition
}

/// A part of the schema without the alternative `null`, and the name of its definition.
fn resolved(root: &Value, part: &Value) -> (Map<String, Value>, Option<String>) {
    let mut own = part.as_object().cloned().expect("a schema");
    let alternatives = own.remove("anyOf");
    let given = alternatives
        .as_ref()
        .and_then(Value::as_array)
        .and_then(|parts| parts.iter().find(|part| part.get("type").is_none_or(|kind| kind != "null")));
    if let Some(given) = given {
        let (fields, name) = resolved(root, given);
        return (merged(fields, own), name);
    }
    let Some(reference) = own.remove("$ref") else { return (own, None) };
    let name = reference.as_str().and_then(|path| path.strip_prefix("#/$defs/")).expect("a definition").to_owned();
    let (fields, _) = resolved(root, &root["$defs"][&name]);
    (merged(fields, own), Some(name))
}

fn list<'v>(fields: &'v Map<String, Value>, key: &str) -> &'v [Value] {
    fields.get(key).and_then(Value::as_array).map_or(&[], Vec::as_slice)
}

/// First paragraph of a description, and its unit in brackets, unless it has several.
fn meaning(fields: &Map<String, Value>) -> [String; 2] {
    let text = fields.get("description").and_then(Value::as_str).unwrap_or_default();
    let text = text.split("\n\n").next().unwrap_or_default().replace('\n', " ");
    let unit =
        text.split_once(" [").and_then(|(_, rest)| rest.split_once(']')).filter(|(_, rest)| !rest.contains(" ["));
    let unit = unit.map_or_else(String::new, |(unit, _)| unit.to_owned());
    [text.replace(&format!(" [{unit}]"), ""), unit]
}

/// Checks if a part may also be a text.
fn has_text(part: &Value) -> bool {
    let alternatives = part.get("anyOf").and_then(Value::as_array).into_iter().flatten();
    alternatives.into_iter().any(|part| part["type"] == "string")
}

/// Words of a choice.
fn words(fields: &Map<String, Value>) -> Vec<&str> {
    list(fields, "oneOf").iter().filter_map(|branch| branch["const"].as_str()).collect()
}

/// The key and the word that select a branch.
fn tag(branch: &Value) -> Option<(&str, &str)> {
    branch["properties"].as_object()?.iter().find_map(|(key, value)| Some((key.as_str(), value["const"].as_str()?)))
}

/// A number in digits, or with an exponent if it is long.
fn number(value: f64) -> String {
    let [digits, exponent] = [value.to_string(), format!("{value:e}")];
    if digits.len() > 5 && exponent.len() < digits.len() { exponent } else { digits }
}

/// Range of a number or of a list's length.
fn range(fields: &Map<String, Value>, [low, high]: [&str; 2]) -> String {
    let number = |key: &str| fields.get(key).map(|value| number(value.as_f64().expect("a number")));
    match (number(low), number(high)) {
        (Some(low), Some(high)) if low == high => low,
        (Some(low), Some(high)) => format!("{low} to {high}"),
        (Some(low), None) => format!("{low} or more"),
        (None, Some(high)) => format!("at most {high}"),
        (None, None) => String::new(),
    }
}

fn field(text: &str) -> String {
    if text.contains([',', '"', '\n']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.into() }
}

impl Table {
    /// Describes the values of a key, and returns the definitions of the tables in it.
    fn value(&self, part: &Value) -> (String, Vec<String>) {
        let (fields, name) = resolved(&self.root, part);
        let kind = match fields.get("type") {
            Some(Value::String(kind)) => kind.as_str(),
            Some(Value::Array(kinds)) => kinds[0].as_str().expect("a type"),
            _ => "",
        };
        let choice = words(&fields);
        if !choice.is_empty() {
            return (choice.join(" or "), Vec::new());
        }
        match kind {
            "array" => {
                let (items, names) = self.value(&fields["items"]);
                let count = range(&fields, ["minItems", "maxItems"]);
                let of = if count.is_empty() { String::new() } else { format!(" of {count}") };
                let formula = if has_text(part) { "formula or " } else { "" };
                (format!("{formula}list{of}: {items}"), names)
            }
            "number" => (format!("number {}", range(&fields, ["minimum", "maximum"])), Vec::new()),
            "integer" => (format!("whole number {}", range(&fields, ["minimum", "maximum"])), Vec::new()),
            "boolean" => ("true or false".into(), Vec::new()),
            "string" => ("text".into(), Vec::new()),
            _ => ("table".into(), name.into_iter().collect()),
        }
    }

    /// Adds a row for each key of a table or kind, then the tables in them.
    fn keys(&mut self, place: &str, kind: &str, fields: &Map<String, Value>) {
        let required: BTreeSet<&str> = list(fields, "required").iter().filter_map(Value::as_str).collect();
        let mut tables = Vec::new();
        for (key, part) in fields.get("properties").and_then(Value::as_object).into_iter().flatten() {
            if part.get("const").is_some() {
                continue;
            }
            let (value, names) = self.value(part);
            let [mut text, unit] = meaning(&resolved(&self.root, part).0);
            let inner = if place.is_empty() { key.clone() } else { format!("{place}.{key}") };
            for name in names {
                if let Some((_, other)) = self.placed.iter().find(|(other, _)| *other == name) {
                    text = format!("{text} Keys: see {other}.");
                } else {
                    self.placed.push((name.clone(), inner.clone()));
                    tables.push((inner.clone(), name));
                }
            }
            let default = match part.get("default") {
                _ if required.contains(key.as_str()) => "required".into(),
                Some(Value::String(word)) => word.clone(),
                Some(value) if !value.is_null() && !value.is_object() => value.to_string(),
                _ => String::new(),
            };
            self.rows.push([place, kind, key, &value, &unit, &default, &text].map(field));
        }
        for (place, name) in tables {
            let fields = resolved(&self.root, &self.root["$defs"][&name]).0;
            self.keys(&place, "", &fields);
            for branch in list(&fields, "oneOf").to_vec() {
                let (key, word) = tag(&branch).expect("a kind");
                let own = resolved(&self.root, &branch).0;
                let [text, unit] = meaning(&own);
                self.rows.push([&place, word, key, word, &unit, "", &text].map(field));
                self.keys(&place, word, &own);
            }
        }
    }
}

fn table() -> String {
    let mut table = Table { root: farsa_compose::schema(), rows: Vec::new(), placed: Vec::new() };
    let root = table.root.as_object().cloned().expect("a schema");
    table.keys("", "", &root);
    let rows: Vec<String> = table.rows.iter().map(|row| row.join(",")).collect();
    format!("table,kind,key,value,unit,default,meaning\n{}\n", rows.join("\n"))
}

#[test]
fn the_table_of_keys_is_generated_from_the_schema() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/experiment-keys.csv");
    let text = table();
    if std::env::var_os("FARSA_WRITE_REFERENCE").is_some() {
        fs::write(&path, &text).expect("a file");
    }
    let current = fs::read_to_string(&path).expect("the table");
    assert!(current == text, "docs/experiment-keys.csv is not current: run this test with FARSA_WRITE_REFERENCE=1");
}

/// Rows by hand from the documentation of the keys, one of each kind of value.
#[test]
fn rows_have_kind_range_unit_and_default() {
    let text = table();
    for row in [
        "robot,,infrared_range,number 0.001 to 10,m,,\"Range of the infrared sensors, from the hull.\"",
        "sensors,light,kind,light,,,Light intensity at the places of the infrared sensors: 0 dark .. 1.",
        "sensors,light,reference,number 1e-4 to 100,m,0.25,Distance at which a sensor that faces a lamp of intensity 1 reads 1.",
        "network,leaky,hidden,whole number 1 to 10000,,required,Hidden neurons.",
        "fitness,,trials,mean or sum or worst,,mean,Combination of trials into one number.",
        "start,anywhere,at,anywhere,,,Uniformly in free space.",
        "sensors,camera,rays,whole number 1 to 1000,,9,Rays in each sector.",
        "motors,servo,stiffness,number 1e-9 to 1e9,N m/rad or N/m,,\"Stiffness of the servo, by default that of the model's own servo.\"",
        "network.links,,delay,whole number 0 to 1000,steps,0,Additional delay.",
    ] {
        assert!(text.lines().any(|line| line == row), "no row {row}\n{text}");
    }
    // Every kind and every key of every table has a row.
    let schema = farsa_compose::schema();
    let inlined = ["Camera", "Blocks", "Evonet"];
    for (name, part) in schema["$defs"].as_object().expect("definitions") {
        let fields = part.as_object().expect("a schema");
        let branches = list(fields, "oneOf").iter();
        for (key, word) in branches.clone().filter_map(tag) {
            assert!(text.contains(&format!(",{word},{key},{word},")), "{name}: no kind {word}");
        }
        for branch in branches.chain([part]).filter(|_| !inlined.contains(&name.as_str())) {
            let word = tag(branch).map_or("", |(_, word)| word);
            let fields = resolved(&schema, branch).0;
            let keys = fields.get("properties").and_then(Value::as_object).into_iter().flatten();
            for (key, _) in keys.filter(|(_, value)| value.get("const").is_none()) {
                assert!(text.contains(&format!(",{word},{key},")), "{name} {word}: no key {key}");
            }
        }
    }
}
