//! Success.

use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{End, EndPart, Moment, PartScene};

/// All conditions of success hold.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Success {}

/// The rule of success.
#[derive(Clone, Copy, Debug)]
pub(super) struct Succeeded;

impl<W: ?Sized> End<W> for Succeeded {
    fn ends(&self, _: &W, _: &Moment<'_>, success: bool) -> bool {
        success
    }
}

impl EndPart for Success {
    type End = Succeeded;

    const DEPENDS_ON_SUCCESS: bool = true;

    fn end(&self, _: &PartScene<'_>) -> Result<Succeeded, Error> {
        Ok(Succeeded)
    }
}
