//! Motor values.

use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{Moment, PartScene, Term, TermPart};

/// Mean square of the motor values, each from 0 to 1.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Effort {}

/// Mean square of the motor values' distance from 1/2, as a share: 0 at rest .. 1.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Control {}

/// The number of the robot.
#[derive(Clone, Debug)]
pub(super) struct EffortTerm(usize);

impl<W: ?Sized> Term<W> for EffortTerm {
    fn value(&self, _: &W, now: &Moment<'_>) -> f64 {
        let y = now.driven(self.0);
        let squares: f64 = y.iter().map(|y| f64::from(*y) * f64::from(*y)).sum();
        squares / y.len().max(1) as f64
    }

    fn has_state(&self) -> bool {
        false
    }
}

/// The number of the robot.
#[derive(Clone, Debug)]
pub(super) struct ControlTerm(usize);

impl<W: ?Sized> Term<W> for ControlTerm {
    fn value(&self, _: &W, now: &Moment<'_>) -> f64 {
        // Mean of (2 y - 1)^2, because a motor rests at y = 1/2.
        let y = now.driven(self.0);
        let squares = y.iter().map(|y| 2.0 * f64::from(*y) - 1.0).map(|u| u * u);
        squares.sum::<f64>() / y.len().max(1) as f64
    }

    fn has_state(&self) -> bool {
        false
    }
}

impl TermPart for Effort {
    type Term = EffortTerm;

    fn term(&self, scene: &PartScene<'_>) -> Result<EffortTerm, Error> {
        Ok(EffortTerm(scene.0.robot()))
    }
}

impl TermPart for Control {
    type Term = ControlTerm;

    fn term(&self, scene: &PartScene<'_>) -> Result<ControlTerm, Error> {
        Ok(ControlTerm(scene.0.robot()))
    }
}
