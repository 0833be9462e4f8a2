//! A handwritten controller. It demonstrates that the sensors and the two words are sufficient to solve the task.

use farsa_nn::Controller;

use crate::compositional_instructions::config::Config;
use crate::compositional_instructions::instruction::{Action, Color, Condition, Instruction};
use crate::compositional_instructions::network::{INPUTS, MOTORS};

/// Selects the part of the instruction that a [`Script`] ignores.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Deaf {
    /// The script uses both words.
    #[default]
    To,
    /// The script ignores the action word and always performs this action.
    ToAction(Action),
    /// The script ignores the object word and always turns toward this object.
    ToColor(Color),
}

/// A stage of the script.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Stage {
    /// Turns to one side until the target is in view.
    Search { left: bool },
    /// Turns until the target is in the middle.
    Centre,
    /// Stretches until it touches.
    Stretch,
    /// Stays as it is, on the target.
    Hold,
    /// Pushes through an angle that is left \[rad\].
    Push { left: f64, before: f64 },
    /// Moves away for the given number of steps.
    Release { steps: u32 },
    /// Turns away until nothing is in view.
    Leave { left: bool },
    /// Nothing remains to be done.
    Rest,
}

/// A controller that finds the object by its color and then performs the action. It uses only the 20 sensor values and
/// the 4 motors of the evolved agents.
#[derive(Clone, Debug)]
pub struct Script {
    condition: Condition,
    ranges: [f64; 2],
    speeds: [f64; 2],
    deaf: Deaf,
    stage: Stage,
    /// Side to which the second segment was folded at the start.
    folded_left: Option<bool>,
}

/// Where the outermost object must be in view the search turns back \[rad\].
const TURN_BACK: f64 = 1.0;
/// Through which angle the second joint pushes: 0.35 m at the distance of the objects from the elbow, and some more
/// \[rad\].
const PUSH: f64 = 1.8;

impl Script {
    /// Creates a script that controls the agent of an experiment.
    pub fn new(config: &Config, deaf: Deaf) -> Self {
        Self {
            condition: config.condition,
            ranges: config.arm.ranges.map(f64::to_radians),
            speeds: config.arm.speeds,
            deaf,
            stage: Stage::Search { left: true },
            folded_left: None,
        }
    }

    /// The instruction as it is taken.
    fn heard(&self, x: &[f32]) -> Instruction {
        let word = |words: &[f32]| words.iter().position(|value| *value > 0.5).unwrap_or(0);
        let action = self.condition.actions()[word(&x[14..17])];
        let color = Color::ALL[word(&x[17..20])];
        match self.deaf {
            Deaf::To => Instruction { action, color },
            Deaf::ToAction(action) => Instruction { action, color },
            Deaf::ToColor(color) => Instruction { action, color },
        }
    }

    /// The target speeds of the joints \[rad/s\], after an update of the stage.
    fn speeds(&mut self, x: &[f32]) -> [f64; 2] {
        let Instruction { action, color } = self.heard(x);
        let seen = [0, 1, 2].map(|sector| x[3 * sector + color.index()] > 0.0);
        let touching = x[9..12].iter().any(|value| *value > 0.0);
        // The inverse of the reading (q + r) / (2 r), in rad.
        let joint = |i: usize| f64::from(x[12 + i]) * 2.0 * self.ranges[i] - self.ranges[i];
        let [first, second] = [joint(0), joint(1)];
        // The side of the second joint at the first step holds for the trial, although the joint may pass 0 later.
        let folded_left = *self.folded_left.get_or_insert(second > 0.0);
        let inwards = if folded_left { -1.0 } else { 1.0 };
        let aim = match seen {
            [true, false, _] => 0.25,
            [_, false, true] => -0.25,
            [true, true, false] => 0.05,
            [false, true, true] => -0.05,
            _ => 0.0,
        };
        self.stage = match self.stage {
            Stage::Search { .. } if seen.contains(&true) => Stage::Centre,
            // The search sweeps between both turning points until the color is in view.
            Stage::Search { left } if left && first > TURN_BACK => Stage::Search { left: false },
            Stage::Search { left } if !left && first < -TURN_BACK => Stage::Search { left: true },
            Stage::Centre if !seen.contains(&true) => Stage::Search { left: first < 0.0 },
            Stage::Centre if seen[1] => match action {
                Action::Indicate => Stage::Centre,
                Action::Touch | Action::Move => Stage::Stretch,
                Action::Ignore => Stage::Leave { left: first > 0.0 },
            },
            Stage::Stretch if touching => match action {
                Action::Move => Stage::Push { left: PUSH, before: second },
                _ => Stage::Hold,
            },
            Stage::Hold if !touching => Stage::Stretch,
            // `left` is the turn of the second joint that remains (in rad), in either direction.
            Stage::Push { left, before } => {
                let left = left - (second - before).abs();
                if left > 0.0 { Stage::Push { left, before: second } } else { Stage::Release { steps: 12 } }
            }
            Stage::Release { steps: 0 } => Stage::Rest,
            Stage::Release { steps } => Stage::Release { steps: steps - 1 },
            Stage::Leave { .. } if !x[..9].iter().any(|value| *value > 0.0) => Stage::Rest,
            stage => stage,
        };
        match self.stage {
            Stage::Search { left } => [if left { 1.0 } else { -1.0 }, 0.0],
            Stage::Centre => [aim, 0.0],
            Stage::Stretch => {
                // Slow where it may touch: from 43 degrees from straight on.
                let slow = inwards * second > -0.75;
                [0.0, inwards * if slow { 0.3 } else { 1.0 }]
            }
            Stage::Push { .. } => [0.0, inwards * 0.7],
            Stage::Release { .. } => [0.0, -inwards],
            Stage::Leave { left } => [if left { 0.3 } else { -0.3 }, 0.0],
            // The pushed object stays in the middle.
            Stage::Rest if action == Action::Move => [if seen.contains(&true) { aim } else { 0.5 * inwards }, 0.0],
            Stage::Hold | Stage::Rest => [0.0, 0.0],
        }
    }
}

impl Controller for Script {
    fn inputs(&self) -> usize {
        INPUTS
    }

    fn outputs(&self) -> usize {
        MOTORS
    }

    fn reset(&mut self) {
        self.stage = Stage::Search { left: true };
        self.folded_left = None;
    }

    fn step(&mut self, x: &[f32], y: &mut [f32]) {
        let wanted = if x.len() < INPUTS { [0.0; 2] } else { self.speeds(x) };
        for ((motors, wanted), largest) in y.chunks_mut(2).zip(wanted).zip(self.speeds) {
            // Two motor neurons differ by the share of the largest speed.
            let part = if largest > 0.0 { (wanted / largest).clamp(-1.0, 1.0) } else { 0.0 };
            for (motor, sign) in motors.iter_mut().zip([0.5, -0.5]) {
                // Outputs 1/2 + s/2 and 1/2 - s/2 differ by the share s and stay in [0, 1].
                *motor = (0.5 + sign * part) as f32;
            }
        }
    }
}
