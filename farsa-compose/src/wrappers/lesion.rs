//! Channels at 0.

use farsa_body::wrappers::Lesioned;
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::WrapperPart;
use crate::wrappers::{Around, Values, range, within, wrong};

/// Passes on 0 for some channels.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Lesion {
    /// First and last channel, from 0, by default all.
    #[schemars(inner(range(min = 0, max = 65535)))]
    channels: Option<[u32; 2]>,
}

impl WrapperPart for Lesion {
    type Filter = Around<Lesioned<Values, Vec<f32>>>;

    fn filter(&self, channels: usize) -> Result<Self::Filter, Error> {
        Lesioned::new(Values(channels), range(self.channels, channels)).map(Around::new).map_err(wrong)
    }

    fn about(&self) -> Option<String> {
        Some(format!("0{}", within(self.channels)))
    }
}
