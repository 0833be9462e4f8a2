//! A predator and a prey without evolution, to compare evolved ones with.

use farsa_nn::Controller;

use crate::predator_prey::config::{OUTPUTS, PredatorPreyConfig};
use crate::team::config::EYES;
use crate::team::steering::{away, eyes};

/// The reaction to the other robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Aim {
    To,
    From,
}

/// Steers to the other robot, or away from it, at full speed.
///
/// The bearing of the other is the mean of the camera's sectors by how much of it each sees. A prey that has the other
/// ahead turns on the spot first, and keeps from walls. No memory. Inputs and outputs are those of
/// [`crate::predator_prey::PredatorPreyEpisode`].
#[derive(Clone, Debug)]
pub struct Chaser {
    inputs: usize,
    /// Where the sectors of the camera look \[rad\].
    sectors: Vec<f32>,
    eyes: [(f32, bool); EYES],
    aim: Aim,
}

impl Chaser {
    /// A predator: it steers to the other robot.
    pub fn predator(config: &PredatorPreyConfig) -> Self {
        Self::new(config, Aim::To)
    }

    /// A prey: it steers away from the other robot.
    pub fn prey(config: &PredatorPreyConfig) -> Self {
        Self::new(config, Aim::From)
    }

    fn new(config: &PredatorPreyConfig, aim: Aim) -> Self {
        let (count, view) = (config.team.sectors, config.team.field_of_view);
        let middle = |sector: usize| (view * (0.5 - (sector as f64 + 0.5) / count as f64)) as f32;
        Self { inputs: config.inputs(), sectors: (0..count).map(middle).collect(), eyes: eyes(&config.team.robot), aim }
    }

    /// The bearing of the other robot, counter-clockwise from ahead \[rad\], or `None` if it is not seen.
    fn bearing(&self, x: &[f32]) -> Option<f32> {
        let seen = x.get(EYES..)?;
        let mut sum = [0.0_f32; 2];
        for (angle, share) in self.sectors.iter().zip(seen) {
            let (sine, cosine) = farsa_num::sin_cos(*angle);
            sum = [sum[0] + share * cosine, sum[1] + share * sine];
        }
        (sum != [0.0; 2]).then(|| farsa_num::atan2(sum[1], sum[0]))
    }
}

impl Controller for Chaser {
    fn inputs(&self) -> usize {
        self.inputs
    }
    fn outputs(&self) -> usize {
        OUTPUTS
    }
    fn reset(&mut self) {}
    fn step(&mut self, x: &[f32], y: &mut [f32]) {
        const QUARTER: f32 = core::f32::consts::FRAC_PI_2;
        let driven = match (self.bearing(x), self.aim) {
            (Some(angle), Aim::To) => [1.0, 0.5 + 0.5 * (angle / QUARTER).clamp(-1.0, 1.0)],
            (Some(angle), Aim::From) => match away(&self.eyes, x) {
                Some(turn) => [0.3, turn],
                // From the other it lies half a turn away.
                None if angle.abs() < QUARTER => [0.5, if angle > 0.0 { 0.0 } else { 1.0 }],
                None => [1.0, 0.5 - 0.2 * angle.signum() * (2.0 - angle.abs() / QUARTER)],
            },
            (None, _) => [1.0, away(&self.eyes, x).unwrap_or(0.6)],
        };
        y.iter_mut().zip(driven).for_each(|(y, value)| *y = value);
    }
}
