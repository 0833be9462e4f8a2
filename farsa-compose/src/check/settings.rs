//! Values of a document as settings, for `--set`, sweeps and conditions.

use std::collections::{BTreeMap, BTreeSet};

use farsa_lab::advanced::Value as Given;
use farsa_lab::{Error, Setting, Settings};
use serde_json::{Map, Value};

use crate::check::schema::{Kind, Part};
use crate::name::is_part_of_key;

/// Tables without settings of their values.
const ELSEWHERE: [&str; 8] =
    ["conditions", "evolution", "files", "genome", "lesions", "protocols", "strategy", "summary"];

/// A setting and the path of its value.
#[derive(Clone, Debug)]
pub(crate) struct Entry {
    pub(crate) setting: Setting,
    pub(crate) path: String,
    /// True for whole numbers.
    whole: bool,
}

/// Lists the settings of a valid document, in its order.
pub(crate) fn entries(document: &Value, schema: &Value) -> Vec<Entry> {
    let mut entries_of_document = Vec::new();
    if let (Some(part), Some(table)) = (Part::root(schema), document.as_object()) {
        collect(part, table, ["", ""], &mut entries_of_document);
    }
    entries_of_document
}

fn collect(part: Part<'_>, table: &Map<String, Value>, [key, path]: [&str; 2], found: &mut Vec<Entry>) {
    let keys = part.keys(&|name| table.get(name)?.as_str());
    for (name, value) in table {
        let (top, tag) = (key.is_empty(), keys.tag.as_ref().is_some_and(|(tag, _)| tag == name));
        if tag || top && ELSEWHERE.contains(&name.as_str()) {
            continue;
        }
        let Some((_, part)) = keys.named.iter().find(|(known, _)| known == name) else { continue };
        let key = if top { name.clone() } else { format!("{key}.{name}") };
        one(*part, value, [&key, &format!("{path}/{name}")], found);
    }
}

fn one(part: Part<'_>, value: &Value, [key, path]: [&str; 2], found: &mut Vec<Entry>) {
    let [least, most] = part.range();
    let mut put = |setting: Setting, whole: bool| {
        let (text, unit) = unit(part.description());
        found.push(Entry { setting: setting.unit(unit).doc(text), path: path.into(), whole });
    };
    let numbers = least.unwrap_or(f64::MIN)..=most.unwrap_or(f64::MAX);
    match (part.kind(), value) {
        (Kind::Table, Value::Object(table)) => collect(part, table, [key, path], found),
        (Kind::Flag, Value::Bool(flag)) => put(Setting::flag(key, *flag), false),
        (Kind::Number, Value::Number(number)) => {
            put(Setting::number(key, number.as_f64().unwrap_or(0.0), numbers), false);
        }
        (Kind::Whole, Value::Number(number)) => {
            // The cast saturates, so a missing end becomes the least or the greatest i64.
            let range = *numbers.start() as i64..=*numbers.end() as i64;
            put(Setting::whole(key, number.as_i64().unwrap_or(0), range), true);
        }
        (Kind::Text, Value::String(word)) if !part.choices().is_empty() => {
            put(Setting::word(key, word, &part.choices()), false);
        }
        (Kind::List, Value::Array(items)) => list(part, items, [key, path], found),
        _ => {}
    }
}

fn list(part: Part<'_>, items: &[Value], [key, path]: [&str; 2], found: &mut Vec<Entry>) {
    let Some(item) = part.items() else { return };
    if let Kind::Number | Kind::Whole = item.kind() {
        let numbers: Vec<f64> = items.iter().filter_map(Value::as_f64).collect();
        let [least, most] = item.range();
        let range = least.unwrap_or(f64::MIN)..=most.unwrap_or(f64::MAX);
        let (text, unit) = unit(part.description());
        let setting = Setting::numbers(key, &numbers, range).unit(unit).doc(text);
        found.push(Entry { setting, path: path.into(), whole: item.kind() == Kind::Whole });
        return;
    }
    for (index, (value, name)) in items.iter().zip(names(items)).enumerate() {
        one(item, value, [&format!("{key}.{name}"), &format!("{path}/{index}")], found);
    }
}

/// Names the parts of a list by their name, or else their kind. Equal names get a number.
pub(crate) fn names(items: &[Value]) -> Vec<String> {
    let mut taken = BTreeSet::new();
    // The number that is tried next for each name. Taken names stay taken.
    let mut numbers: BTreeMap<String, usize> = BTreeMap::new();
    let unique = |(index, item): (usize, &Value)| {
        let name = ["name", "kind", "place", "term"].iter().find_map(|key| item.get(key)?.as_str());
        // A joint of a model may have a name that is no key.
        let name = name.filter(|name| is_part_of_key(name)).map_or_else(|| (index + 1).to_string(), str::to_owned);
        if taken.insert(name.clone()) {
            return name;
        }
        // The first name has no number, so the second begins with 2.
        let number = numbers.entry(name.clone()).or_insert(2);
        loop {
            let name = format!("{name}-{number}");
            *number += 1;
            if taken.insert(name.clone()) {
                return name;
            }
        }
    };
    items.iter().enumerate().map(unique).collect()
}

/// Splits a description into text and unit.
fn unit(text: &str) -> (&str, &str) {
    let cut = text.trim_end_matches('.').strip_suffix(']').and_then(|text| text.rsplit_once(" ["));
    cut.unwrap_or((text, ""))
}

/// Returns the document with the values of settings.
pub(crate) fn apply(document: &Value, entries: &[Entry], settings: &Settings) -> Result<Value, Error> {
    let mut document = document.clone();
    for Entry { setting, path, whole } in entries {
        let value = match settings.get(setting.key())? {
            Given::Flag(flag) => Value::from(*flag),
            Given::Whole(number) => Value::from(*number),
            Given::Number(number) => Value::from(*number),
            Given::Word(word) => Value::from(word.as_str()),
            Given::Numbers(numbers) if *whole => numbers.iter().map(|number| *number as i64).collect(),
            Given::Numbers(numbers) => numbers.iter().copied().collect(),
        };
        if let Some(place) = document.pointer_mut(path) {
            *place = value;
        }
    }
    Ok(document)
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    /// A direct implementation that tries one number after the other.
    fn one_by_one(items: &[Value]) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        for (index, item) in items.iter().enumerate() {
            let own = item["name"].as_str().or(item["kind"].as_str());
            let own = own.map_or_else(|| (index + 1).to_string(), str::to_owned);
            let numbered = (2..).map(|number| format!("{own}-{number}"));
            let mut all = std::iter::once(own.clone()).chain(numbered);
            names.extend(all.find(|name| !names.contains(name)));
        }
        names
    }

    #[test]
    fn parts_of_one_name_are_numbered() {
        let named = |name: &str| json!({ "name": name, "kind": "b" });
        let of_a_kind = |kind: &str| json!({ "kind": kind });
        let items = [
            named("a"),
            of_a_kind("a"),
            named("a-2"),
            named("a"),
            of_a_kind("a-2"),
            json!({}),
            named("6"),
            json!(7),
            of_a_kind("a-2-2"),
            named("a"),
            named("a-3"),
            of_a_kind("b"),
            of_a_kind("b"),
        ];
        assert_eq!(names(&items), one_by_one(&items));
        assert_eq!(names(&items)[..4], ["a", "a-2", "a-2-2", "a-3"]);
    }

    #[test]
    fn a_hundred_thousand_parts_of_one_name_are_numbered() {
        let found = names(&vec![json!({ "kind": "wall" }); 100_000]);
        assert_eq!(found.last().map(String::as_str), Some("wall-100000"));
    }
}
