//! A forager without evolution, to compare evolved ones with.

use farsa_nn::Controller;

use crate::foraging::config::ForagingConfig;
use crate::team::config::EYES;
use crate::team::robots::OUTPUTS;
use crate::team::steering::{away, eyes};

/// Drives circles that lead back to the nest before the energy is used up, and straight on through the nest. The circles make a
/// rosette around it. It turns away from objects in its infrared sensors.
///
/// No memory, no camera, no LEDs. Inputs and outputs are those of [`crate::foraging::ForagingEpisode`].
#[derive(Clone, Debug)]
pub struct HomingForager {
    inputs: usize,
    /// Where the infrared channels look: the sine, and whether it is ahead.
    eyes: [(f32, bool); EYES],
    /// The turn of a circle that closes in time.
    turn: f32,
}

/// The part of the way that energy lasts for which a circle takes.
const CIRCLE: f64 = 0.85;

impl HomingForager {
    /// A forager for the robots and the energy of a configuration.
    pub fn new(config: &ForagingConfig) -> Self {
        let team = &config.team;
        let steps =
            if config.cost > 0.0 { (1.0 / config.cost).min(f64::from(team.steps)) } else { f64::from(team.steps) };
        let radius = CIRCLE * steps * team.time_step * team.speed / core::f64::consts::TAU;
        let turn = (team.robot.track / (2.0 * radius)).min(1.0);
        Self { inputs: config.inputs(), eyes: eyes(&team.robot), turn: (0.5 + 0.5 * turn) as f32 }
    }
}

impl Controller for HomingForager {
    fn inputs(&self) -> usize {
        self.inputs
    }
    fn outputs(&self) -> usize {
        OUTPUTS
    }
    fn reset(&mut self) {}
    fn step(&mut self, x: &[f32], y: &mut [f32]) {
        let nest = x.get(self.inputs - 2).is_some_and(|x| *x > 0.5);
        let driven = match away(&self.eyes, x) {
            Some(turn) => [0.3, turn],
            None if nest => [1.0, 0.5],
            None => [1.0, self.turn],
        };
        y.iter_mut().zip(driven.into_iter().chain([0.0, 0.0])).for_each(|(y, value)| *y = value);
    }
}
