//! Reads and checks a text value by value.

use farsa_lab::Error;
use serde_json::{Map, Value};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::check::schema::{Kind, Part};
use crate::check::source::{Lines, Source, key};
use crate::name::{NAME, is_name};

/// Most parts of a list.
const MAX_PARTS: usize = 1000;
/// Most characters of a text without its own limit.
const MAX_CHARACTERS: usize = 1000;
/// Kind of a term with a formula, and the key of the formula.
const FORMULA: &str = "formula";
/// Most errors of one text.
const MAX_ERRORS: usize = 20;

/// Reads the values of a text that match a schema, with their places.
pub(crate) fn read(file: &str, text: &str, schema: &Value) -> Result<(Value, Source), Error> {
    let lines = Lines::new(text);
    let mut source = Source::new(file);
    let table = DeTable::parse(text).map_err(|error| {
        let line = error.span().map_or_else(|| last_line(text, error.message()), |span| lines.of(span.start));
        Error::Usage(format!("{}: {}", source.of_line(line), error.message()))
    })?;
    let part = Part::root(schema).ok_or_else(|| Error::Other("the schema is no table".into()))?;
    let mut walk = Walk { lines: &lines, source: &mut source, errors: Vec::new() };
    let value = walk.table(part, table.get_ref(), "", table.span().start);
    let mut errors = walk.errors;
    // Messages follow the lines of the file, whatever the order of the keys is.
    errors.sort_by_key(|(offset, _)| *offset);
    let mut errors: Vec<Error> = errors.into_iter().map(|(_, error)| error).collect();
    match value {
        Ok(value) if errors.is_empty() => return Ok((value, source)),
        Ok(_) => {}
        Err(last) => errors.push(last),
    }
    Err(Error::several(errors))
}

/// Finds the line of an error without a place: the last one of the shortest beginning of the text with this error.
fn last_line(text: &str, message: &str) -> usize {
    let lines: Vec<&str> = text.split_inclusive('\n').collect();
    let fails = |count: usize| {
        let length: usize = lines[..count].iter().map(|line| line.len()).sum();
        DeTable::parse(&text[..length]).is_err_and(|error| error.span().is_none() && error.message() == message)
    };
    let (mut passes, mut fails_from) = (0, lines.len());
    while fails_from - passes > 1 {
        let middle = passes.midpoint(fails_from);
        *if fails(middle) { &mut fails_from } else { &mut passes } = middle;
    }
    fails_from.max(1)
}

struct Walk<'w> {
    lines: &'w Lines,
    source: &'w mut Source,
    /// Errors so far, with their offsets.
    errors: Vec<(usize, Error)>,
}

impl Walk<'_> {
    /// Stores the error of a value, so that the next value is checked, until there are enough errors.
    fn kept(&mut self, offset: usize, value: Result<Value, Error>) -> Result<Value, Error> {
        match value {
            Err(error) if self.errors.len() + 1 < MAX_ERRORS => {
                self.errors.push((offset, error));
                Ok(Value::Null)
            }
            value => value,
        }
    }

    fn value(&mut self, part: Part<'_>, value: &Spanned<DeValue<'_>>, path: &str) -> Result<Value, Error> {
        let offset = value.span().start;
        self.source.put(path, self.lines.of(offset));
        let wrong = |why: String| self.source.wrong(path, why);
        match (part.kind(), value.get_ref()) {
            (Kind::Table, DeValue::Table(table)) => self.table(part, table, path, offset),
            (Kind::List, DeValue::String(_)) if part.admits_formula() => {
                let item = part.items().unwrap_or(part);
                Ok(Value::Array(vec![self.value(item, value, &format!("{path}/0"))?]))
            }
            (Kind::Table, DeValue::String(text)) if part.admits_formula() => self.formula(part, text, path),
            (Kind::List, DeValue::Array(items)) => self.list(part, items, path),
            (Kind::Flag | Kind::Any, DeValue::Boolean(flag)) => Ok(Value::Bool(*flag)),
            (Kind::Text | Kind::Any, DeValue::String(text)) => self.text(part, text, path),
            (Kind::Whole | Kind::Number | Kind::Any, DeValue::Integer(number)) => {
                let number = i64::from_str_radix(number.as_str(), number.radix());
                let number = number.map_err(|_| wrong("is too large a number".into()))?;
                // Integers above 2^53 are rounded here, which matters only next to the end of a range.
                within(part, number as f64).map_err(wrong)?;
                Ok(Value::from(number))
            }
            (Kind::Number | Kind::Any, DeValue::Float(number)) => {
                let number: f64 = number.as_str().parse().map_err(|_| wrong("is not a number".into()))?;
                within(part, number).map_err(wrong)?;
                Ok(Value::from(number))
            }
            (Kind::Any, DeValue::Array(items)) => {
                let items = items.iter().enumerate();
                items.map(|(index, item)| self.value(part, item, &format!("{path}/{index}"))).collect()
            }
            (wanted, _) => Err(wrong(format!("is not {}", words(wanted)))),
        }
    }

    fn table(&mut self, part: Part<'_>, table: &DeTable<'_>, path: &str, offset: usize) -> Result<Value, Error> {
        self.source.put(path, self.lines.of(offset));
        if table.len() > MAX_PARTS {
            return Err(self.source.wrong(path, format!("has {} keys; at most {MAX_PARTS}", table.len())));
        }
        let tag = |name: &str| {
            let (_, value) = table.iter().find(|(key, _)| key.get_ref() == name)?;
            value.get_ref().as_str()
        };
        let mut keys = part.keys(&tag);
        // A term with a formula needs no kind.
        let is_formula = keys
            .tag
            .as_ref()
            .is_some_and(|(tag, words)| !has(table, tag) && has(table, FORMULA) && words.contains(&FORMULA));
        if is_formula {
            keys = part.keys(&|name| (name == "kind").then_some(FORMULA));
            keys.tag = None;
        }
        if let Some((tag, words)) = keys.tag.as_ref().filter(|(name, _)| tag(name).is_none() && !has(table, name)) {
            // The tag may be misspelled.
            let mut valid = vec![*tag];
            for &word in words {
                valid.extend(part.keys(&|_| Some(word)).named.into_iter().map(|(name, _)| name));
            }
            if let Some((name, _)) = table.iter().find(|(name, _)| !valid.contains(&name.get_ref().as_ref())) {
                let place = self.source.of_line(self.lines.of(name.span().start));
                return Err(Error::unknown(&place, "key", name.get_ref(), valid));
            }
            return Err(self.source.wrong(path, format!("lacks the key `{tag}`: one of {}", words.join(", "))));
        }
        // The tag comes first, because the other keys depend on it.
        if let Some((tag, words)) = &keys.tag
            && let Some((name, value)) = table.iter().find(|(name, _)| name.get_ref() == tag)
            && value.get_ref().as_str().is_none_or(|word| !words.contains(&word))
        {
            let line = self.lines.of(name.span().start);
            let text = value.get_ref().as_str().ok_or_else(|| Error::Setting {
                place: self.source.of_line(line),
                key: key(&format!("{path}/{tag}")),
                why: "is not a text".into(),
            })?;
            let what = if *tag == "at" { "way to place something" } else { "kind" };
            return Err(Error::unknown(&self.source.of_line(line), what, text, words.iter().copied()));
        }
        let (mut found, mut misnamed) = (Map::new(), false);
        for (name, value) in table {
            let (offset, name) = (name.span().start, name.get_ref().as_ref());
            let line = self.lines.of(offset);
            // An unknown key may have any length, and its path is part of a message.
            let path = format!("{path}/{}", name.chars().take(60).collect::<String>());
            let known = keys.named.iter().find(|(key, _)| *key == name).map(|(_, part)| *part);
            let Some(part) = known.or_else(|| part.any_key()) else {
                let valid = keys.named.iter().map(|(name, _)| *name).chain(keys.tag.as_ref().map(|(tag, _)| *tag));
                let error = Error::unknown(&self.source.of_line(line), "key", name, valid);
                self.kept(offset, Err(error))?;
                misnamed = true;
                continue;
            };
            let value = self.value(part, value, &path);
            let value = self.kept(offset, value)?;
            self.source.put(&path, line);
            found.insert(name.into(), value);
        }
        if is_formula {
            found.insert("kind".into(), FORMULA.into());
        }
        // The key may be misspelled.
        if let Some(missing) = keys.required.iter().find(|name| !misnamed && !found.contains_key(**name)) {
            return Err(self.source.wrong(path, format!("lacks the key `{missing}`")));
        }
        Ok(Value::Object(found))
    }

    /// Reads a text as a term or condition with this formula.
    fn formula(&self, part: Part<'_>, text: &str, path: &str) -> Result<Value, Error> {
        let keys = part.keys(&|name| (name == "kind").then_some(FORMULA));
        let key = keys.named.iter().find(|(name, _)| *name == FORMULA).map_or(part, |(_, key)| *key);
        let mut table = Map::new();
        table.insert(FORMULA.into(), self.text(key, text, path)?);
        if keys.tag.is_some() {
            table.insert("kind".into(), FORMULA.into());
        }
        Ok(Value::Object(table))
    }

    fn list(&mut self, part: Part<'_>, items: &[Spanned<DeValue<'_>>], path: &str) -> Result<Value, Error> {
        let count = items.len();
        let [least, most] = part.lengths().map(|length| length.and_then(|length| usize::try_from(length).ok()));
        let (least, most) = (least.unwrap_or(0), most.unwrap_or(MAX_PARTS));
        if !(least..=most).contains(&count) {
            let wanted = if least == most { format!("{least}") } else { format!("{least} to {most}") };
            return Err(self.source.wrong(path, format!("has {count} values where {wanted} are wanted")));
        }
        let of_items = part.items();
        let item = |(index, item): (usize, &Spanned<DeValue<'_>>)| {
            let value = self.value(of_items.unwrap_or(part), item, &format!("{path}/{index}"));
            self.kept(item.span().start, value)
        };
        items.iter().enumerate().map(item).collect()
    }

    fn text(&self, part: Part<'_>, text: &str, path: &str) -> Result<Value, Error> {
        let choices = part.choices();
        if !choices.is_empty() && !choices.contains(&text) {
            return Err(Error::unknown(&self.source.of(path), "choice", text, choices));
        }
        if part.pattern() == Some(NAME) && !is_name(text) {
            let why = "is not a name: 1 to 40 lower-case letters, digits, - and _, the first a letter or digit";
            return Err(self.source.wrong(path, why));
        }
        // Contents of files may be long.
        if path.starts_with("/files/") {
            return Ok(Value::from(text));
        }
        let most = part.most_characters().unwrap_or(MAX_CHARACTERS);
        if text.chars().count() > most || text.chars().any(char::is_control) {
            let why = format!("is longer than {most} characters or has control characters");
            return Err(self.source.wrong(path, why));
        }
        Ok(Value::from(text))
    }
}

/// Checks if a table has a key.
fn has(table: &DeTable<'_>, name: &str) -> bool {
    table.iter().any(|(key, _)| key.get_ref() == name)
}

/// Checks a number against its range.
fn within(part: Part<'_>, number: f64) -> Result<(), String> {
    let [least, most] = part.range();
    let (least, most) = (least.unwrap_or(f64::MIN), most.unwrap_or(f64::MAX));
    if number.is_nan() {
        return Err("NaN is not a number".into());
    }
    if (least..=most).contains(&number) { Ok(()) } else { Err(format!("{number} is outside {least} to {most}")) }
}

fn words(kind: Kind) -> &'static str {
    match kind {
        Kind::Table => "a table",
        Kind::List => "a list",
        Kind::Number => "a number",
        Kind::Whole => "a whole number",
        Kind::Flag => "true or false",
        Kind::Text => "a text in quotes",
        Kind::Any => "a flag, number, text or list of these",
    }
}
