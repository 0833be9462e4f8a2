//! Access to the JSON schema of the format.

use std::sync::LazyLock;

use serde_json::{Map, Value};

use crate::document::Document;

/// Creates the schema of documents, without registered parts.
fn of_documents() -> Value {
    let settings = schemars::generate::SchemaSettings::draft2020_12();
    let mut schema = settings.into_generator().into_root_schema_for::<Document>().to_value();
    close(&mut schema);
    admit_formulas(&mut schema);
    schema
}

/// Lists of terms and conditions, whose items may be formulas.
const WITH_FORMULAS: [&str; 4] = ["reward", "success", "end", "failure"];

/// Admits a text instead of a list of terms or conditions and of each item.
fn admit_formulas(schema: &mut Value) {
    let text = serde_json::json!({ "type": "string", "maxLength": 2000, "description": "A formula." });
    for list in WITH_FORMULAS {
        let Some(part) = schema.pointer_mut(&format!("/properties/{list}")).and_then(Value::as_object_mut) else {
            continue;
        };
        let (kind, items) = (part.remove("type"), part.remove("items"));
        let items = serde_json::json!({ "anyOf": [items, text] });
        let list = serde_json::json!({ "type": kind, "items": items });
        part.insert("anyOf".into(), serde_json::json!([list, text]));
    }
}

/// Admits a term with a formula and no kind.
pub(crate) fn admit_bare_formulas(schema: &mut Value) {
    let branches = schema.pointer_mut("/$defs/Reward/oneOf").and_then(Value::as_array_mut).into_iter().flatten();
    for branch in branches.filter(|branch| branch.pointer("/properties/kind/const") == Some(&"formula".into())) {
        branch["required"] = serde_json::json!(["formula"]);
    }
}

/// Schema of documents, built once because it takes a megabyte.
pub(crate) static SCHEMA: LazyLock<Value> = LazyLock::new(of_documents);

/// Returns the schema of a file with objects only.
pub(crate) fn scene_schema(schema: &Value) -> Value {
    let objects = schema.pointer("/properties/objects").cloned().unwrap_or_default();
    serde_json::json!({
        "type": "object",
        "properties": { "objects": objects },
        "required": ["objects"],
        "unevaluatedProperties": false,
        "$defs": schema["$defs"],
    })
}

/// Calls the branches of a tagged table or of a list of words `oneOf`. With a registered kind, whose schema is absent, they
/// are `anyOf`.
fn name_branches(map: &mut Map<String, Value>) {
    let named = |branch: &Value| {
        let properties = branch.get("properties").and_then(Value::as_object);
        branch.get("const").is_some()
            || properties.is_some_and(|all| all.values().any(|value| value.get("const").is_some()))
    };
    let all_named = map.get("anyOf").and_then(Value::as_array).is_some_and(|branches| branches.iter().all(named));
    if all_named && let Some(branches) = map.remove("anyOf") {
        map.insert("oneOf".into(), branches);
    }
}

/// Forbids unnamed keys in every table.
pub(crate) fn close(schema: &mut Value) {
    match schema {
        Value::Object(map) => {
            map.values_mut().for_each(close);
            name_branches(map);
            let table = map.contains_key("properties") && map.get("type").is_some_and(|kind| kind == "object");
            if table && !map.contains_key("additionalProperties") {
                map.insert("unevaluatedProperties".into(), false.into());
            }
            // Branches are closed by the table around them.
            for branches in ["oneOf", "anyOf", "allOf"] {
                let branches = map.get_mut(branches).and_then(Value::as_array_mut).into_iter().flatten();
                branches.filter_map(Value::as_object_mut).for_each(|branch| {
                    branch.remove("unevaluatedProperties");
                });
            }
        }
        Value::Array(items) => items.iter_mut().for_each(close),
        _ => {}
    }
}

/// A part of a schema, with its root for references.
#[derive(Clone, Copy)]
pub(crate) struct Part<'s> {
    root: &'s Value,
    own: &'s Map<String, Value>,
}

/// Type of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Table,
    List,
    Number,
    Whole,
    Flag,
    Text,
    /// A flag, number, text or list of numbers.
    Any,
}

impl<'s> Part<'s> {
    /// Finds the root of a schema.
    pub(crate) fn root(root: &'s Value) -> Option<Self> {
        Some(Self { root, own: root.as_object()? })
    }

    fn at(self, value: &'s Value) -> Option<Self> {
        Some(Self { root: self.root, own: value.as_object()? })
    }

    /// Resolves a reference.
    fn referred(self) -> Option<Self> {
        let name = self.own.get("$ref")?.as_str()?.strip_prefix("#/$defs/")?;
        self.at(self.root.get("$defs")?.get(name)?)
    }

    /// Returns a keyword of the part or of its reference.
    fn word(self, name: &str) -> Option<&'s Value> {
        self.own.get(name).or_else(|| self.referred()?.word(name))
    }

    fn branches(self, name: &str) -> impl Iterator<Item = Self> + use<'s> {
        let branches = self.word(name).and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
        branches.iter().filter_map(move |value| self.at(value))
    }

    /// Gets the part without the alternative `null`.
    fn given(self) -> Self {
        let null = |part: &Self| part.own.get("type").is_some_and(|kind| kind == "null");
        self.branches("anyOf").find(|part| !null(part)).unwrap_or(self)
    }

    /// Returns true for a list, term or condition that may also be a formula.
    pub(crate) fn admits_formula(self) -> bool {
        self.branches("anyOf").any(|part| part.own.get("type").is_some_and(|kind| kind == "string"))
    }

    /// Returns the type of the value.
    pub(crate) fn kind(self) -> Kind {
        let part = self.given();
        let words: Vec<&str> = match part.word("type") {
            Some(Value::String(word)) => vec![word],
            Some(Value::Array(words)) => words.iter().filter_map(Value::as_str).collect(),
            _ => Vec::new(),
        };
        let is = |word| words.contains(&word);
        match () {
            () if is("object") || part.word("properties").is_some() => Kind::Table,
            () if part.branches("oneOf").any(|branch| branch.tag().is_some()) => Kind::Table,
            () if is("array") => Kind::List,
            () if is("integer") => Kind::Whole,
            () if is("number") => Kind::Number,
            () if is("boolean") => Kind::Flag,
            () if is("string") || !part.choices().is_empty() => Kind::Text,
            () => Kind::Any,
        }
    }

    /// Returns the allowed words of a text, empty for free text.
    pub(crate) fn choices(self) -> Vec<&'s str> {
        let part = self.given();
        let own = |part: Self| {
            let one = part.word("const").into_iter();
            let several = part.word("enum").and_then(Value::as_array).into_iter().flatten();
            one.chain(several).filter_map(Value::as_str).collect::<Vec<_>>()
        };
        part.branches("oneOf").chain([part]).flat_map(own).collect()
    }

    /// Returns the least and the greatest number.
    pub(crate) fn range(self) -> [Option<f64>; 2] {
        let part = self.given();
        ["minimum", "maximum"].map(|name| part.word(name).and_then(Value::as_f64))
    }

    /// Returns the least and the greatest length of a list.
    pub(crate) fn lengths(self) -> [Option<u64>; 2] {
        let part = self.given();
        ["minItems", "maxItems"].map(|name| part.word(name).and_then(Value::as_u64))
    }

    /// Gets the greatest number of characters of a text, if any.
    pub(crate) fn most_characters(self) -> Option<usize> {
        self.given().word("maxLength")?.as_u64()?.try_into().ok()
    }

    /// Gets the pattern of a text, if any.
    pub(crate) fn pattern(self) -> Option<&'s str> {
        self.given().word("pattern")?.as_str()
    }

    /// Returns the first paragraph of the description.
    pub(crate) fn description(self) -> &'s str {
        let text = self.word("description").and_then(Value::as_str).unwrap_or_default();
        text.split("\n\n").next().unwrap_or_default()
    }

    /// Gets the schema of a list's items.
    pub(crate) fn items(self) -> Option<Self> {
        let part = self.given();
        part.at(part.word("items")?)
    }

    /// Gets the schema of the values in a table with free keys.
    pub(crate) fn any_key(self) -> Option<Self> {
        let part = self.given();
        match part.word("additionalProperties")? {
            Value::Bool(true) => Some(Self { root: self.root, own: empty() }),
            other => part.at(other),
        }
    }

    /// Finds the keys of a table. `tag` returns the value of the key that selects a branch.
    pub(crate) fn keys<'t>(self, tag: &dyn Fn(&str) -> Option<&'t str>) -> Keys<'s> {
        let mut keys = Keys::default();
        self.given().collect(tag, &mut keys);
        keys
    }

    fn collect<'t>(self, tag: &dyn Fn(&str) -> Option<&'t str>, keys: &mut Keys<'s>) {
        if let Some(part) = self.referred() {
            part.collect(tag, keys);
        }
        if let Some(found) = self.own.get("properties").and_then(Value::as_object) {
            for (name, value) in found {
                keys.named.extend(self.at(value).map(|part| (name.as_str(), part)));
            }
        }
        let required = self.own.get("required").and_then(Value::as_array).into_iter().flatten();
        keys.required.extend(required.filter_map(Value::as_str));
        let parts = self.own.get("allOf").and_then(Value::as_array).into_iter().flatten();
        parts.filter_map(|value| self.at(value)).for_each(|part| part.collect(tag, keys));
        let branches = self.own.get("oneOf").and_then(Value::as_array).into_iter().flatten();
        let branches: Vec<Self> = branches.filter_map(|value| self.at(value)).collect();
        let Some((name, _)) = branches.first().and_then(|branch| branch.tag()) else { return };
        let wanted = tag(name);
        keys.tag = Some((name, branches.iter().filter_map(|branch| Some(branch.tag()?.1)).collect()));
        if let Some(branch) = branches.iter().find(|branch| branch.tag().is_some_and(|(_, word)| Some(word) == wanted))
        {
            branch.collect(tag, keys);
        }
    }

    /// Returns the first paragraph of the branch that a word selects among the items of a list.
    pub(crate) fn about(self, list: &str, word: &str) -> &'s str {
        let keys = self.keys(&|_| None);
        let items = keys.named.iter().find(|(name, _)| *name == list).and_then(|(_, part)| part.items());
        items.and_then(|items| items.branch(word)).map_or("", Self::description)
    }

    /// Returns the branch that a word selects.
    pub(crate) fn branch(self, word: &str) -> Option<Self> {
        self.given().branches("oneOf").find(|branch| branch.tag().is_some_and(|(_, own)| own == word))
    }

    /// Returns the key and the word that select a branch.
    fn tag(self) -> Option<(&'s str, &'s str)> {
        let properties = self.word("properties")?.as_object()?;
        properties.iter().find_map(|(name, value)| Some((name.as_str(), value.get("const")?.as_str()?)))
    }
}

/// Keys of a table.
#[derive(Default)]
pub(crate) struct Keys<'s> {
    pub(crate) named: Vec<(&'s str, Part<'s>)>,
    pub(crate) required: Vec<&'s str>,
    /// Key that selects a branch, and its words.
    pub(crate) tag: Option<(&'s str, Vec<&'s str>)>,
}

fn empty() -> &'static Map<String, Value> {
    static EMPTY: std::sync::OnceLock<Map<String, Value>> = std::sync::OnceLock::new();
    EMPTY.get_or_init(Map::new)
}
