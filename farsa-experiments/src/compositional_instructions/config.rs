//! Configuration of the experiment `compositional-instructions`.

use farsa_lab::Error;
use farsa_num::{Scalar, sin_cos};

use crate::compositional_instructions::instruction::{Action, Color, Condition, Instruction};

/// The arm. It consists of two segments and is seen from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arm {
    /// Lengths of the segments in meters.
    pub lengths: [f64; 2],
    /// Masses of the segments in kilograms.
    pub masses: [f64; 2],
    /// Radius of both segments (in meters).
    pub radius: f64,
    /// Largest rotation of each joint to either side (in degrees).
    pub ranges: [f64; 2],
    /// Largest speed that the network can command for each joint, in radians per second.
    pub speeds: [f64; 2],
    /// Torque per unit of difference between the commanded and the actual speed (in N m s/rad).
    pub gains: [f64; 2],
    /// Largest torque of each motor in newton meters.
    pub torques: [f64; 2],
}

/// The three objects and the places where a trial puts them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Objects {
    /// Radius of an object in meters.
    pub radius: f64,
    /// Mass of an object (in kilograms).
    pub mass: f64,
    /// Coefficient of friction between an object and the ground.
    pub ground_friction: f64,
    /// Coefficient of friction between the arm and an object, and between two objects.
    pub friction: f64,
    /// Mean distance of the objects from the base of the arm (in meters).
    pub distance: f64,
    /// Largest deviation from that distance (in meters).
    pub distance_spread: f64,
    /// Bearings of the three places, from left to right (in degrees).
    pub bearings: [f64; 3],
    /// Largest deviation from each bearing (in degrees).
    pub bearing_spread: f64,
}

/// The camera at the base of the arm. It looks along the first segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Field of view (in degrees). It is divided into three sectors of equal width.
    pub view: f64,
    /// Number of rays that are cast in each sector.
    pub rays: u32,
    /// Largest distance at which an object is visible (in meters).
    pub range: f64,
}

/// The posture of the arm at the start of a trial.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// Largest deviation of the first joint from the direction between two neighboring objects (in degrees).
    pub first_spread: f64,
    /// Angle of the second joint in degrees.
    pub second: f64,
    /// Largest deviation from that angle (in degrees).
    pub second_spread: f64,
    /// If true, the side on which the arm starts is drawn at random. Otherwise it always starts on the left.
    pub both_sides: bool,
}

/// The thresholds used to compute the reward and to decide if a trial was successful.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judging {
    /// Length of the period at the end of a trial that is taken into account (in seconds).
    pub window: f64,
    /// Displacement of an object that has no effect on the reward (in meters).
    pub still: f64,
    /// Additional displacement at which the reward falls to zero (in meters).
    pub span: f64,
    /// Like `span`, but for the target of TOUCH (in meters).
    pub span_touched: f64,
    /// Displacement that earns the maximum reward for MOVE (in meters).
    pub far: f64,
    /// Distance from the surface of the centered target below which the tip earns a reward for reaching (in
    /// meters).
    pub reach: f64,
    /// Weight of reaching in the reward for TOUCH and MOVE, between 0 and 1.
    pub reach_share: f64,
    /// Reward for a step of IGNORE in which the target is visible but not in the middle sector, between 0 and 1.
    pub aside_share: f64,
    /// Minimum shares of the final period that count as a success. The first applies to INDICATE and IGNORE, the
    /// second to TOUCH.
    pub least_shares: [f64; 2],
    /// Largest displacement of the target allowed in a successful trial of INDICATE or IGNORE (in meters).
    pub most_still: f64,
    /// Largest displacement of the target allowed in a successful trial of TOUCH (in meters).
    pub most_touched: f64,
    /// Smallest displacement of the target required in a successful trial of MOVE (in meters).
    pub least_moved: f64,
    /// Largest displacement of any other object allowed in a successful trial (in meters).
    pub most_other: f64,
}

/// The ranges to which the genes of the network are decoded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ranges {
    /// Largest absolute value of a weight.
    pub weight: f64,
    /// Largest absolute value of a bias.
    pub bias: f64,
    /// Range of the time constants, as decimal logarithms of their values in seconds.
    pub time_constant_exponents: [f64; 2],
    /// Smallest and largest gain of a sensory neuron.
    pub gains: [f64; 2],
}

/// The complete configuration of the experiment. The table of settings gives the source of each value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Config {
    /// Selects the three actions of the agent.
    pub condition: Condition,
    /// The two instructions that are not used during evolution. They test generalization.
    pub held_out: [Instruction; 2],
    /// The number of trials with different starts for each trained instruction.
    pub starts: u32,
    /// Number of steps of a trial.
    pub steps: u32,
    /// Duration of a control step (in seconds).
    pub time_step: f64,
    /// Number of dynamics steps in each control step.
    pub substeps: u32,
    /// Arm and its motors.
    pub arm: Arm,
    /// Objects and their places.
    pub objects: Objects,
    /// Camera at the base.
    pub camera: Camera,
    /// Distance between two surfaces below which they count as touching (in meters).
    pub touch_margin: f64,
    /// Posture of the arm at the start.
    pub start: Start,
    /// Thresholds of the reward.
    pub judging: Judging,
    /// Ranges of the network's parameters.
    pub ranges: Ranges,
}

impl Config {
    /// Returns the default configuration of a condition.
    pub const fn for_condition(condition: Condition) -> Self {
        Self {
            condition,
            held_out: [
                Instruction { action: Action::Touch, color: Color::Green },
                Instruction { action: Action::Move, color: Color::Red },
            ],
            starts: 3,
            steps: 150,
            time_step: 0.1,
            substeps: 5,
            arm: Arm {
                lengths: [1.0, 0.5],
                masses: [1.5, 0.75],
                radius: 0.03,
                ranges: [170.0, 135.0],
                speeds: [1.0, 1.0],
                gains: [40.0, 20.0],
                torques: [20.0, 10.0],
            },
            objects: Objects {
                radius: 0.06,
                mass: 0.3,
                ground_friction: 0.5,
                friction: 0.3,
                distance: 1.35,
                distance_spread: 0.08,
                bearings: [60.0, 0.0, -60.0],
                bearing_spread: 10.0,
            },
            camera: Camera { view: 30.0, rays: 5, range: 2.0 },
            touch_margin: 0.002,
            start: Start { first_spread: 30.0, second: 110.0, second_spread: 5.0, both_sides: false },
            judging: Judging {
                window: 5.0,
                still: 0.02,
                span: 0.08,
                span_touched: 0.15,
                far: 0.35,
                reach: 1.0,
                reach_share: 0.5,
                aside_share: 0.5,
                least_shares: [0.9, 0.8],
                most_still: 0.03,
                most_touched: 0.05,
                least_moved: 0.30,
                most_other: 0.05,
            },
            ranges: Ranges { weight: 8.0, bias: 8.0, time_constant_exponents: [-1.0, 0.3], gains: [1.0, 13.0] },
        }
    }

    /// Returns an iterator over the trained instructions, in the same order as [`Condition::instructions`].
    pub fn trained(&self) -> impl Iterator<Item = Instruction> + use<> {
        let held_out = self.held_out;
        self.condition.instructions().into_iter().filter(move |instruction| !held_out.contains(instruction))
    }

    /// Returns the number of trials in an evaluation. Every trained instruction is given once from each start.
    pub fn trials(&self) -> usize {
        self.trained().count() * self.starts as usize
    }

    /// Returns the number of steps in the final period. It never exceeds the length of the trial.
    pub fn window_steps(&self) -> u32 {
        let steps = self.judging.window / self.time_step + 0.5;
        (steps as u32).clamp(1, self.steps)
    }

    /// Checks that the values are compatible with each other.
    ///
    /// # Errors
    /// Returns [`Error::Setting`] if objects may overlap each other or the arm at the start, if the arm cannot reach
    /// them, or if a joint would start outside its range.
    pub fn check(&self) -> Result<(), Error> {
        let Self { arm, objects, start, .. } = self;
        let [left, middle, right] = objects.bearings;
        let gap = (left - middle).min(middle - right) - 2.0 * objects.bearing_spread;
        let [near, far] = [-1.0, 1.0].map(|sign| objects.distance + sign * objects.distance_spread);
        let apart = least_distance(near, far, gap.to_radians());
        if gap <= 0.0 || apart < 2.0 * objects.radius {
            let why =
                format!("objects would overlap: {gap} deg and {apart:.3} m apart, each of {} m radius", objects.radius);
            return Err(Error::setting("object.bearing_spread", why));
        }
        let reach = arm.lengths[0] + arm.lengths[1] + arm.radius;
        if far - objects.radius >= reach {
            let why = format!("up to {:.3} m away, out of reach of an arm of {reach:.3} m", far - objects.radius);
            return Err(Error::setting("object.distance", why));
        }
        let widest = left.abs().max(right.abs()) + objects.bearing_spread;
        if widest > arm.ranges[0] {
            let why = format!("objects at up to {widest} deg, where the first joint turns to {}", arm.ranges[0]);
            return Err(Error::setting("object.bearings", why));
        }
        let folded = [start.second - start.second_spread, start.second + start.second_spread];
        if folded[0] < 0.0 || folded[1] > arm.ranges[1] {
            let why = format!("{} to {} deg, where the second joint turns to {}", folded[0], folded[1], arm.ranges[1]);
            return Err(Error::setting("start.second", why));
        }
        let [one, other] = arm.lengths;
        let tip = Scalar::sqrt(one * one + other * other + 2.0 * one * other * sin_cos(folded[0].to_radians()).1);
        let clear = one.max(tip) + arm.radius;
        if clear >= near - objects.radius {
            let why = format!("the folded arm reaches {clear:.3} m, objects are {:.3} m away", near - objects.radius);
            return Err(Error::setting("object.distance", why));
        }
        let turned = (0.5 * (left + middle)).abs().max((0.5 * (middle + right)).abs()) + start.first_spread;
        if turned > arm.ranges[0] {
            let why = format!("up to {turned} deg, where the first joint turns to {}", arm.ranges[0]);
            return Err(Error::setting("start.first_spread", why));
        }
        Ok(())
    }
}

/// The least distance of two points at distances from `near` to `far` \[m\] whose bearings differ by `angle` \[rad\].
fn least_distance(near: f64, far: f64, angle: f64) -> f64 {
    let cosine = sin_cos(angle).1;
    let between = |a: f64, b: f64| Scalar::sqrt((a * a + b * b - 2.0 * a * b * cosine).max(0.0));
    // Both near, or one as far as there is and the other at the foot of its perpendicular.
    between(near, near).min(between(far, (far * cosine).clamp(near, far)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_the_least() {
        for (near, far, degrees) in [(1.27, 1.43, 40.0), (0.5, 2.0, 20.0), (1.0, 1.0, 90.0), (0.2, 3.0, 150.0)] {
            let angle = f64::to_radians(degrees);
            let (sine, cosine) = sin_cos(angle);
            let mut least = f64::INFINITY;
            for i in 0..=200 {
                for j in 0..=200 {
                    let [a, b] = [i, j].map(|k| near + (far - near) * f64::from(k) / 200.0);
                    let (x, y) = (a - b * cosine, b * sine);
                    least = least.min(Scalar::sqrt(x * x + y * y));
                }
            }
            let found = least_distance(near, far, angle);
            assert!(found <= least + 1e-12 && found > least - 0.02, "{found} where the grid has {least}");
        }
    }

    #[test]
    fn what_does_not_go_together_is_refused() {
        let plain = Config::for_condition(Condition::WithIgnore);
        plain.check().unwrap();
        assert_eq!(plain.trained().count(), 7);
        assert_eq!((plain.trials(), plain.window_steps()), (21, 50));
        assert_eq!(Config { steps: 10, ..plain }.window_steps(), 10, "of a shorter trial, all of it");
        let refused = |change: fn(&mut Config), text: &str| {
            let mut config = plain;
            change(&mut config);
            let error = config.check().unwrap_err().to_string();
            assert!(error.contains(text), "{error}");
        };
        refused(|c| c.objects.bearing_spread = 31.0, "`object.bearing_spread`: objects would overlap");
        refused(|c| c.objects.bearing_spread = 28.5, "m apart, each of 0.06 m radius");
        refused(|c| (c.objects.distance, c.camera.range) = (1.7, 3.0), "out of reach of an arm of 1.530 m");
        refused(|c| c.objects.distance = 1.1, "the folded arm reaches");
        refused(|c| c.start.second = 30.0, "the folded arm reaches");
        refused(|c| c.start.second = 133.0, "`start.second`: 128 to 138 deg");
        refused(|c| c.arm.ranges[0] = 65.0, "`object.bearings`: objects at up to 70 deg");
        refused(|c| (c.arm.ranges[0], c.start.first_spread) = (80.0, 60.0), "`start.first_spread`: up to 90 deg");
    }
}
