//! Names of an MJCF file's bodies, joints and geoms.

use std::collections::BTreeMap;

use crate::error::{ReadError, repeated};
use crate::xml::tree::Element;

/// Names of bodies, joints and geoms: declared in the file, or generated from the kind and a number, with `_` appended
/// while another has them.
#[derive(Default)]
pub(crate) struct Names {
    taken: BTreeMap<(&'static str, String), usize>,
}

impl Names {
    /// Takes the name that an element declares, of which there may be no second, or `None` if it declares none.
    pub(crate) fn declare(&mut self, kind: &'static str, element: Element<'_>) -> Result<Option<String>, ReadError> {
        let Some(name) = element.attribute("name").filter(|name| !name.is_empty()) else { return Ok(None) };
        let line = element.place().line;
        match self.taken.insert((kind, name.to_owned()), line) {
            None => Ok(Some(name.to_owned())),
            Some(first) => Err(repeated(element.place(), kind, name, first)),
        }
    }

    /// A name that nothing has. All declared names must be taken already.
    pub(crate) fn generate(&mut self, kind: &'static str, wanted: String) -> String {
        let mut name = wanted;
        while self.taken.contains_key(&(kind, name.clone())) {
            name.push('_');
        }
        self.taken.insert((kind, name.clone()), 0);
        name
    }

    /// Checks whether something of the kind has the name.
    pub(crate) fn has(&self, kind: &'static str, name: &str) -> bool {
        self.taken.contains_key(&(kind, name.to_owned()))
    }

    /// All names of a kind.
    pub(crate) fn all(&self, kind: &'static str) -> impl Iterator<Item = &str> + '_ {
        self.taken.keys().filter(move |(other, _)| *other == kind).map(|(_, name)| name.as_str())
    }
}
