//! A simple controller that serves as a baseline for evolved controllers.

use farsa_nn::Controller;

use crate::push_box::config::PushConfig;
use crate::push_box::episode::OUTPUTS;

/// A controller that turns toward the strongest infrared signal and drives ahead. It drives in circles as long as there
/// is no signal.
///
/// The controller has no memory. Its inputs and outputs are the same as those of
/// [`PushEpisode`](crate::push_box::PushEpisode).
#[derive(Clone, Debug)]
pub struct HomingPusher {
    /// Where the sensors look: ahead and to the left.
    eyes: Vec<[f32; 2]>,
}

/// The wheels' values while nothing is seen. The left one is half as fast as the right one, in circles of one and a
/// half times the track in radius.
const CIRCLE: [f32; OUTPUTS] = [0.75, 1.0];
/// Gain of the steering.
const GAIN: f32 = 1.5;

impl HomingPusher {
    /// Creates a controller for the robot of the given configuration.
    pub fn new(config: &PushConfig) -> Self {
        let eyes = config.robot.infrared.angles.iter().map(|angle| {
            let (sine, cosine) = farsa_num::sin_cos(*angle);
            [cosine as f32, sine as f32]
        });
        Self { eyes: eyes.collect() }
    }
}

impl Controller for HomingPusher {
    fn inputs(&self) -> usize {
        self.eyes.len()
    }
    fn outputs(&self) -> usize {
        OUTPUTS
    }
    fn reset(&mut self) {}
    fn step(&mut self, x: &[f32], y: &mut [f32]) {
        let sum = |k: usize| self.eyes.iter().zip(x).map(|(eye, x)| eye[k] * x).sum::<f32>();
        let [ahead, left, seen] = [sum(0), sum(1), x.iter().sum::<f32>()];
        let driven = if seen <= 0.0 {
            CIRCLE
        } else {
            // Backwards it goes only to turn on the spot.
            let turn = (GAIN * left / seen).clamp(-0.5, 0.5);
            let speed = if ahead > 0.0 { 0.5 - turn.abs() } else { 0.0 };
            [0.5 + speed - turn, 0.5 + speed + turn]
        };
        y.iter_mut().zip(driven).for_each(|(y, value)| *y = value);
    }
}
