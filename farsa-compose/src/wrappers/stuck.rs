//! Channels that are held.

use farsa_body::wrappers::{self, StuckAt};
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::WrapperPart;
use crate::wrappers::{Around, Values, range, within, wrong};

/// Holds some channels at a value after some steps.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Stuck {
    /// First and last channel, from 0, by default all.
    #[schemars(inner(range(min = 0, max = 65535)))]
    channels: Option<[u32; 2]>,
    /// The held value, by default the last one.
    #[schemars(range(min = -1e6, max = 1e6))]
    value: Option<f64>,
    /// Number of steps before.
    #[serde(default)]
    #[schemars(range(min = 0, max = 4_294_967_295_u32))]
    after: u32,
}

impl WrapperPart for Stuck {
    type Filter = Around<wrappers::Stuck<Values, Vec<f32>>>;

    fn filter(&self, channels: usize) -> Result<Self::Filter, Error> {
        let at = self.value.map_or(StuckAt::Last, |value| StuckAt::Value(value as f32));
        let stuck = wrappers::Stuck::new(Values(channels), range(self.channels, channels), at, self.after);
        stuck.map(Around::new).map_err(wrong)
    }

    fn about(&self) -> Option<String> {
        let (within, after) = (within(self.channels), self.after);
        Some(match self.value {
            Some(value) => format!("{value}{within} after {after} steps"),
            None => format!("no change{within} after {after} steps"),
        })
    }
}
