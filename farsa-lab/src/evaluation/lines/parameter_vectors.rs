//! Vectors of numbers as a line gives them.

use std::collections::BTreeSet;
use std::fmt;

use serde::Deserialize;
use serde::de::{DeserializeSeed, Deserializer, Error as _, MapAccess, SeqAccess, Visitor};

use crate::escaped::Quoted;

/// Vectors of numbers: `[..]` is one, `[[..], [..]]` are several, and an object has those of populations by their names.
#[derive(Debug, PartialEq)]
pub(super) enum ParameterVectors {
    /// Vectors of the only population.
    Unnamed(Vectors),
    /// Vectors of each named population, in the order of the line.
    Named(Vec<(String, Vectors)>),
}

/// Vectors in one buffer. A list for each would take twenty times the memory of a text of short vectors.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Vectors {
    numbers: Vec<f64>,
    /// Where each ends.
    ends: Vec<usize>,
}

impl Vectors {
    /// Gets the number of vectors.
    pub(super) fn len(&self) -> usize {
        self.ends.len()
    }

    /// Each, in the order of the line.
    pub(super) fn iter(&self) -> impl Iterator<Item = &[f64]> {
        let mut rest = self.numbers.as_slice();
        let lengths = self.ends.iter().scan(0, |start, &end| Some(end - std::mem::replace(start, end)));
        lengths.map(move |length| rest.split_off(..length).unwrap_or_default())
    }
}

impl<'de> Deserialize<'de> for ParameterVectors {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Whole;
        impl<'de> Visitor<'de> for Whole {
            type Value = ParameterVectors;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a list of numbers, a list of such lists, or an object of them by population")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<ParameterVectors, A::Error> {
                vectors(seq).map(ParameterVectors::Unnamed)
            }
            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<ParameterVectors, A::Error> {
                let (mut populations, mut names) = (Vec::new(), BTreeSet::new());
                while let Some((name, vectors)) = map.next_entry::<String, Vectors>()? {
                    if !names.insert(name.clone()) {
                        let name = Quoted(&name);
                        return Err(A::Error::custom(format_args!("the population {name} stands twice")));
                    }
                    populations.push((name, vectors));
                }
                Ok(ParameterVectors::Named(populations))
            }
        }
        deserializer.deserialize_any(Whole)
    }
}

impl<'de> Deserialize<'de> for Vectors {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Whole;
        impl<'de> Visitor<'de> for Whole {
            type Value = Vectors;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a list of numbers or a list of such lists")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Vectors, A::Error> {
                vectors(seq)
            }
        }
        deserializer.deserialize_seq(Whole)
    }
}

/// A list of numbers as one vector, or a list of vectors.
fn vectors<'de, A: SeqAccess<'de>>(mut seq: A) -> Result<Vectors, A::Error> {
    let (mut found, mut loose) = (Vectors::default(), false);
    while let Some(is_number) = seq.next_element_seed(Item(&mut found))? {
        loose |= is_number;
        if loose && found.len() > 0 {
            return Err(A::Error::custom("numbers and lists of numbers side by side"));
        }
    }
    if loose {
        found.ends.push(found.numbers.len());
    }
    Ok(found)
}

/// Reads an element of a list into the shared buffer. Returns whether it is a number.
struct Item<'v>(&'v mut Vectors);

impl Item<'_> {
    fn number(self, x: f64) -> bool {
        self.0.numbers.push(x);
        true
    }
}

impl<'de> DeserializeSeed<'de> for Item<'_> {
    type Value = bool;
    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<bool, D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Item<'_> {
    type Value = bool;
    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number or a list of numbers")
    }
    fn visit_f64<E>(self, x: f64) -> Result<bool, E> {
        Ok(self.number(x))
    }
    fn visit_u64<E>(self, x: u64) -> Result<bool, E> {
        Ok(self.number(x as f64))
    }
    fn visit_i64<E>(self, x: i64) -> Result<bool, E> {
        Ok(self.number(x as f64))
    }
    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<bool, A::Error> {
        while let Some(x) = seq.next_element()? {
            self.0.numbers.push(x);
        }
        self.0.ends.push(self.0.numbers.len());
        Ok(false)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vectors(all: &[&[f64]]) -> Vectors {
        let ends = (1..=all.len()).map(|count| all[..count].iter().map(|one| one.len()).sum()).collect();
        Vectors { numbers: all.concat(), ends }
    }

    #[test]
    fn one_or_several_vectors() {
        let read = |text: &str| serde_json::from_str::<ParameterVectors>(text).map_err(|error| error.to_string());
        assert_eq!(read("[1, -2, 0.5]").unwrap(), ParameterVectors::Unnamed(vectors(&[&[1.0, -2.0, 0.5]])));
        assert_eq!(read("[[1], [2e3]]").unwrap(), ParameterVectors::Unnamed(vectors(&[&[1.0], &[2000.0]])));
        assert_eq!(read("[]").unwrap(), ParameterVectors::Unnamed(vectors(&[])));
        let named = vec![("b".into(), vectors(&[&[1.0]])), ("a".into(), vectors(&[&[2.0], &[3.0]]))];
        assert_eq!(read(r#"{"b": [1], "a": [[2], [3]]}"#).unwrap(), ParameterVectors::Named(named));
        for (text, why) in [
            ("3", "expected a list of numbers, a list of such lists, or an object"),
            ("[1, [2]]", "side by side"),
            ("[[1], 2]", "side by side"),
            ("[[1, [2]]]", "expected f64"),
            ("[1, null]", "null, expected a number or a list"),
            ("[[null]]", "null, expected f64"),
            ("[1, \"2\"]", "string \"2\", expected a number"),
            ("[1e999]", "number out of range"),
            (r#"{"a": [1], "a": [2]}"#, "the population `a` stands twice"),
            (r#"{"a": {"b": [1]}}"#, "map, expected a list of numbers or"),
        ] {
            let found = read(text).unwrap_err();
            assert!(found.contains(why), "{text}: {found}");
        }
    }
    #[test]
    fn as_many_vectors_as_the_line_has() {
        let all = vectors(&[&[1.0, 2.0], &[], &[3.0]]);
        assert_eq!(all.iter().collect::<Vec<_>>(), [&[1.0, 2.0][..], &[], &[3.0]]);
        assert_eq!((all.len(), vectors(&[]).iter().count()), (3, 0));
    }
}
