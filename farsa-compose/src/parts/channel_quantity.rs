//! Quantity of a channel, for exports.

use serde_json::{Map, Value};

use crate::check::registry::Registry;
use crate::document::Wrapper;
use crate::part::Quantity;
use crate::part::definition::Build;

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
    pub(crate) fn with_wrappers<'w>(self, wrappers: impl Iterator<Item = &'w Wrapper>) -> Self {
        match changes(wrappers) {
            words if words.is_empty() => self,
            words => Self { quantity: format!("{}, with {words}", self.quantity), ..self },
        }
    }
}

/// Describes the changes of wrappers, in this order. Empty without any.
pub(crate) fn changes<'w>(wrappers: impl Iterator<Item = &'w Wrapper>) -> String {
    wrappers.map(change).collect::<Vec<_>>().join(", then ")
}

fn change(wrapper: &Wrapper) -> String {
    let within = |channels: &Option<[u32; 2]>| match channels {
        None => String::new(),
        Some([first, last]) if first == last => format!(" in channel {first}"),
        Some([first, last]) => format!(" in channels {first} to {last}"),
    };
    match wrapper {
        Wrapper::UniformNoise { amplitude } => format!("noise of at most {amplitude}"),
        Wrapper::NormalNoise { deviation } => format!("normal noise of deviation {deviation}"),
        Wrapper::Delay { steps: 1 } => "a delay of 1 step".into(),
        Wrapper::Delay { steps } => format!("a delay of {steps} steps"),
        Wrapper::Scale { gain, offset } if *offset == 0.0 => format!("a factor of {gain}"),
        Wrapper::Scale { gain, offset } => format!("a factor of {gain} and {offset} added"),
        Wrapper::Saturate { low, high } => format!("ends at {low} and {high}"),
        Wrapper::Threshold { above } => format!("1 above {above} and 0 elsewhere"),
        Wrapper::Lesion { channels } => format!("0{}", within(channels)),
        Wrapper::Registered { kind, .. } => format!("`{kind}`"),
        Wrapper::Stuck { channels, value: Some(value), after } => {
            format!("{value}{} after {after} steps", within(channels))
        }
        Wrapper::Stuck { channels, value: None, after } => format!("no change{} after {after} steps", within(channels)),
    }
}
