//! Sensors of a robot's own state.

use farsa_body::ports::{Channels, Sensor};

use crate::arena::field::Forager;

/// A quantity of a robot's own state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BodyState {
    Energy,
    Carried,
}

/// A sensor of a robot's energy, or of its food load.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BodyStateSensor {
    state: BodyState,
    value: f32,
}

impl BodyStateSensor {
    pub(crate) fn new(state: BodyState) -> Self {
        Self { state, value: 0.0 }
    }

    /// Copies the value from the robot.
    pub(crate) fn update(&mut self, forager: &Forager) {
        self.value = match self.state {
            BodyState::Energy => forager.energy as f32,
            BodyState::Carried => f32::from(u8::from(forager.carried > 0)),
        };
    }
}

impl Channels for BodyStateSensor {
    fn channels(&self) -> usize {
        1
    }
}

impl<W: ?Sized> Sensor<W> for BodyStateSensor {
    fn read(&mut self, _: &W, out: &mut [f32]) {
        if let Some(o) = out.first_mut() {
            *o = self.value;
        }
    }
}
