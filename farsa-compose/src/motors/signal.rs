//! Signals.

use farsa_body::motors::SignalMotor;
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{MotorPart, PartScene, Quantity};

/// Signal strength, 0 to 1.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Signal {}

impl MotorPart for Signal {
    type Motor = SignalMotor;

    fn motor(&self, scene: &PartScene<'_>) -> Result<SignalMotor, Error> {
        let place = scene.planar()?;
        place.parts.signal.map(SignalMotor::new).ok_or_else(|| place.lacks("a signal"))
    }

    fn quantity(&self, _: usize, _: &PartScene<'_>) -> Quantity {
        Quantity::new("what is signalled", "1", [0.0, 1.0])
    }
}
