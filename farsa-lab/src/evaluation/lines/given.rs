//! Vectors of numbers as a line gives them.

use std::fmt;

use serde::Deserialize;
use serde::de::{Deserializer, Error as _, MapAccess, SeqAccess, Visitor};

/// Vectors of numbers: `[..]` is one, `[[..], [..]]` are several, and an object has those of populations by their names.
#[derive(Debug, PartialEq)]
pub(super) enum Given {
    /// Of the only population.
    Unnamed(Vec<Vec<f64>>),
    /// Of each population that is named, in the order of the line.
    Named(Vec<(String, Vec<Vec<f64>>)>),
}

impl<'de> Deserialize<'de> for Given {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Whole;
        impl<'de> Visitor<'de> for Whole {
            type Value = Given;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a list of numbers, a list of such lists, or an object of them by population")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Given, A::Error> {
                rows(seq).map(Given::Unnamed)
            }
            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Given, A::Error> {
                let mut all: Vec<(String, Vec<Vec<f64>>)> = Vec::new();
                while let Some((name, Rows(rows))) = map.next_entry::<String, Rows>()? {
                    if all.iter().any(|(other, _)| *other == name) {
                        return Err(A::Error::custom(format_args!("the population {name:?} stands twice")));
                    }
                    all.push((name, rows));
                }
                Ok(Given::Named(all))
            }
        }
        deserializer.deserialize_any(Whole)
    }
}

/// The vectors of a population.
struct Rows(Vec<Vec<f64>>);

impl<'de> Deserialize<'de> for Rows {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Whole;
        impl<'de> Visitor<'de> for Whole {
            type Value = Rows;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a list of numbers or a list of such lists")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Rows, A::Error> {
                rows(seq).map(Rows)
            }
        }
        deserializer.deserialize_seq(Whole)
    }
}

/// What stands in a list.
enum Item {
    Number(f64),
    Row(Vec<f64>),
}

impl<'de> Deserialize<'de> for Item {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Whole;
        impl<'de> Visitor<'de> for Whole {
            type Value = Item;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number or a list of numbers")
            }
            fn visit_f64<E>(self, x: f64) -> Result<Item, E> {
                Ok(Item::Number(x))
            }
            fn visit_u64<E>(self, x: u64) -> Result<Item, E> {
                Ok(Item::Number(x as f64))
            }
            fn visit_i64<E>(self, x: i64) -> Result<Item, E> {
                Ok(Item::Number(x as f64))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Item, A::Error> {
                let mut row = Vec::new();
                while let Some(x) = seq.next_element()? {
                    row.push(x);
                }
                Ok(Item::Row(row))
            }
        }
        deserializer.deserialize_any(Whole)
    }
}

/// A list of numbers as one vector, or a list of vectors.
fn rows<'de, A: SeqAccess<'de>>(mut seq: A) -> Result<Vec<Vec<f64>>, A::Error> {
    let (mut numbers, mut rows) = (Vec::new(), Vec::new());
    while let Some(item) = seq.next_element()? {
        match item {
            Item::Number(x) => numbers.push(x),
            Item::Row(row) => rows.push(row),
        }
        if !numbers.is_empty() && !rows.is_empty() {
            return Err(A::Error::custom("numbers and lists of numbers side by side"));
        }
    }
    Ok(if numbers.is_empty() { rows } else { vec![numbers] })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_or_several_vectors() {
        let read = |text: &str| serde_json::from_str::<Given>(text).map_err(|error| error.to_string());
        assert_eq!(read("[1, -2, 0.5]").unwrap(), Given::Unnamed(vec![vec![1.0, -2.0, 0.5]]));
        assert_eq!(read("[[1], [2e3]]").unwrap(), Given::Unnamed(vec![vec![1.0], vec![2000.0]]));
        assert_eq!(read("[]").unwrap(), Given::Unnamed(vec![]));
        let named = vec![("b".into(), vec![vec![1.0]]), ("a".into(), vec![vec![2.0], vec![3.0]])];
        assert_eq!(read(r#"{"b": [1], "a": [[2], [3]]}"#).unwrap(), Given::Named(named));
        for (text, why) in [
            ("3", "expected a list of numbers, a list of such lists, or an object"),
            ("[1, [2]]", "side by side"),
            ("[[1], 2]", "side by side"),
            ("[[1, [2]]]", "expected f64"),
            ("[1, null]", "null, expected a number or a list"),
            ("[[null]]", "null, expected f64"),
            ("[1, \"2\"]", "string \"2\", expected a number"),
            ("[1e999]", "number out of range"),
            (r#"{"a": [1], "a": [2]}"#, "the population \"a\" stands twice"),
            (r#"{"a": {"b": [1]}}"#, "map, expected a list of numbers or"),
        ] {
            let found = read(text).unwrap_err();
            assert!(found.contains(why), "{text}: {found}");
        }
    }
}
