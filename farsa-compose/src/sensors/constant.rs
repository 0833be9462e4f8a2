//! Constants.

use farsa_body::sensors::Signal;
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{PartScene, Quantity, SensorPart};

/// A constant, such as a label of the condition.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Constant {
    /// Value.
    #[schemars(range(min = -1e6, max = 1e6))]
    value: f64,
}

impl SensorPart for Constant {
    type Sensor = Signal<1>;

    fn sensor(&self, _: &PartScene<'_>) -> Result<Signal<1>, Error> {
        Ok(Signal::new([self.value as f32]))
    }

    fn quantity(&self, _: usize, _: &PartScene<'_>) -> Quantity {
        Quantity::new(format!("always {}", self.value), "1", [0.0, 1.0])
    }

    fn is_constant(&self) -> bool {
        true
    }
}
