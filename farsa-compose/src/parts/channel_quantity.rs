//! Quantity of a channel, for exports.

use serde_json::{Map, Value};

use crate::check::registry::Registry;
use crate::document::Wrapper;
use crate::part::Quantity;
use crate::part::definition::Build;
use crate::parts::wrapping::changes;

/// A quantity with its unit, the values at 0 and 1, and a flag for a linear scale between them.
pub(crate) struct ChannelQuantity {
    pub(crate) quantity: String,
    pub(crate) unit: &'static str,
    pub(crate) ends: [f64; 2],
    pub(crate) linear: bool,
}

impl ChannelQuantity {
    pub(crate) fn new(quantity: impl Into<String>, unit: &'static str, ends: [f64; 2]) -> Self {
        Self { quantity: quantity.into(), unit, ends, linear: true }
    }

    /// Returns the quantity of a channel of a registered sensor or motor.
    pub(crate) fn registered(registry: &Registry, kind: &str, keys: &Map<String, Value>, channel: usize) -> Self {
        let quantity = registry.find(kind, |build| match build {
            Build::Sensor(_, quantity) | Build::Motor(_, quantity) => Some(quantity(keys, channel)),
            _ => None,
        });
        let Quantity { text, unit, ends } = quantity.unwrap_or_default();
        Self::new(text, unit, ends)
    }

    /// Appends the changes of wrappers, in this order.
    pub(crate) fn with_wrappers<'w>(self, wrappers: impl Iterator<Item = &'w Wrapper>, registry: &Registry) -> Self {
        match changes(wrappers, registry) {
            words if words.is_empty() => self,
            words => Self { quantity: format!("{}, with {words}", self.quantity), ..self },
        }
    }
}
