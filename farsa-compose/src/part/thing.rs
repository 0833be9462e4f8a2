//! Things.

use farsa_lab::Error;

use crate::document::Object;
use crate::part::keys::Keys;

/// A custom kind of thing, composed of shapes. Its fields are the keys of the file.
pub trait ThingPart: Keys {
    /// Lists the things that replace `object`, whose name, place, heading and number are those of the file.
    ///
    /// The first thing should keep the name, since other parts of the file refer to it.
    ///
    /// # Errors
    /// Returns an error if the thing cannot be built.
    fn things(&self, object: &Object) -> Result<Vec<Object>, Error>;
}
