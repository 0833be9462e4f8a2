//! Settings of a part.

use schemars::JsonSchema;
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Settings of a part, which are keys of the file. A struct with derived traits implements it.
///
/// Give each optional key a default by `#[serde(default)]`, and numbers a range by `#[schemars(range(..))]`.
pub trait Keys: Clone + Serialize + DeserializeOwned + JsonSchema + 'static {}

impl<T: Clone + Serialize + DeserializeOwned + JsonSchema + 'static> Keys for T {}
