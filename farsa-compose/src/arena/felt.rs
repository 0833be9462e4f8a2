//! What a robot feels of itself.

use farsa_body::ports::{Channels, Sensor};

use crate::arena::field::Forager;

/// What is felt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Feeling {
    Energy,
    Carried,
}

/// A sensor of the robot's own energy, or of whether it carries food.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Felt {
    feeling: Feeling,
    value: f32,
}

impl Felt {
    /// Of a robot that has not begun.
    pub(crate) fn new(feeling: Feeling) -> Self {
        Self { feeling, value: 0.0 }
    }

    /// Takes what there is to feel.
    pub(crate) fn feel(&mut self, forager: &Forager) {
        self.value = match self.feeling {
            Feeling::Energy => forager.energy as f32,
            Feeling::Carried => f32::from(u8::from(forager.carried > 0)),
        };
    }
}

impl Channels for Felt {
    fn channels(&self) -> usize {
        1
    }
}

impl<W: ?Sized> Sensor<W> for Felt {
    fn read(&mut self, _: &W, out: &mut [f32]) {
        if let Some(o) = out.first_mut() {
            *o = self.value;
        }
    }
}
