//! Files of a document.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::sync::Arc;

use farsa_body::sensors::infrared::InfraredTables;

/// Contents of files by name, and the tables already read, by the paths of their sensors.
pub(crate) struct Files<'f> {
    pub(crate) contents: &'f BTreeMap<String, String>,
    pub(crate) tables: RefCell<BTreeMap<String, Arc<InfraredTables>>>,
}

impl<'f> Files<'f> {
    pub(crate) fn new(contents: &'f BTreeMap<String, String>) -> Self {
        Self { contents, tables: RefCell::default() }
    }
}
