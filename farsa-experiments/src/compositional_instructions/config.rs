//! The values of `compositional-instructions`.

use farsa_lab::Error;
use farsa_num::{Scalar, sin_cos};

use crate::compositional_instructions::instruction::{Action, Color, Condition, Instruction};

/// The arm: two segments, seen from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arm {
    /// Lengths of the segments \[m\].
    pub lengths: [f64; 2],
    /// Their masses \[kg\].
    pub masses: [f64; 2],
    /// Their radius \[m\].
    pub radius: f64,
    /// Largest turn of each joint to either side \[deg\].
    pub ranges: [f64; 2],
    /// Largest speed that is commanded \[rad/s\].
    pub speeds: [f64; 2],
    /// Torque for each radian per second that a joint lacks of the commanded speed \[N m s/rad\].
    pub gains: [f64; 2],
    /// Largest torque \[N m\].
    pub torques: [f64; 2],
}

/// The objects and their places.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Objects {
    /// Radius \[m\].
    pub radius: f64,
    /// Mass \[kg\].
    pub mass: f64,
    /// Coefficient of friction on the ground.
    pub ground_friction: f64,
    /// Coefficient of friction of arm and objects, and between objects.
    pub friction: f64,
    /// Distance from the base \[m\].
    pub distance: f64,
    /// By how much that differs at most \[m\].
    pub distance_spread: f64,
    /// Bearings of the three places, from the left to the right \[deg\].
    pub bearings: [f64; 3],
    /// By how much each differs at most \[deg\].
    pub bearing_spread: f64,
}

/// The camera at the base, which looks along the first segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Field of view \[deg\], in three sectors.
    pub view: f64,
    /// Rays of a sector.
    pub rays: u32,
    /// Range of view \[m\].
    pub range: f64,
}

/// The start of a trial.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// The first joint is at most so far from one of the two directions between the objects \[deg\].
    pub first_spread: f64,
    /// The second joint \[deg\].
    pub second: f64,
    /// By how much that differs at most \[deg\].
    pub second_spread: f64,
    /// Start on a drawn side, instead of always on the left.
    pub both_sides: bool,
}

/// Limits of the judge: still, touched, moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judging {
    /// The last seconds of a trial, which are looked at \[s\].
    pub window: f64,
    /// A displacement that costs nothing \[m\].
    pub still: f64,
    /// Distance beyond that at which the share falls to 0 \[m\].
    pub span: f64,
    /// The same of the target of TOUCH \[m\].
    pub span_touched: f64,
    /// The displacement that MOVE earns most for \[m\].
    pub far: f64,
    /// Distance of the tip from the surface of the centered target below which reaching earns \[m\].
    pub reach: f64,
    /// Weight of reaching in acts of TOUCH and MOVE \[0..1\].
    pub reach_share: f64,
    /// Reward of a step of IGNORE with the target in view outside the middle sector \[0..1\].
    pub aside_share: f64,
    /// Least shares of the last seconds in a success: of INDICATE and IGNORE, and of TOUCH.
    pub least_shares: [f64; 2],
    /// Most displacement of the target in a success of INDICATE and IGNORE \[m\].
    pub most_still: f64,
    /// The same of TOUCH \[m\].
    pub most_touched: f64,
    /// Least displacement of the target in a success of MOVE \[m\].
    pub least_moved: f64,
    /// Most displacement of another object in any success \[m\].
    pub most_other: f64,
}

/// The network's size and the ranges of its parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ranges {
    /// Weights are decoded to plus and minus this.
    pub weight: f64,
    /// Biases are decoded to plus and minus this.
    pub bias: f64,
    /// Least and greatest decimal logarithm of the time constants \[s\].
    pub time_constant_exponents: [f64; 2],
    /// Least and greatest gain of the sensory neurons.
    pub gains: [f64; 2],
}

/// All values of the experiment. The settings name their sources and the reasons for the others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Config {
    /// Which actions there are.
    pub condition: Condition,
    /// The two instructions that are held out.
    pub held_out: [Instruction; 2],
    /// Starts of each trained instruction.
    pub starts: u32,
    /// Steps of a trial.
    pub steps: u32,
    /// Control step \[s\].
    pub time_step: f64,
    /// Dynamics steps of a control step.
    pub substeps: u32,
    /// The arm.
    pub arm: Arm,
    /// The objects.
    pub objects: Objects,
    /// The camera.
    pub camera: Camera,
    /// Surfaces nearer than this count as touching \[m\].
    pub touch_margin: f64,
    /// The start of a trial.
    pub start: Start,
    /// Limits of the judge.
    pub judging: Judging,
    /// The network.
    pub ranges: Ranges,
}

impl Config {
    /// The defaults of a condition.
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

    /// The instructions that are trained, in the order of the condition's nine.
    pub fn trained(&self) -> impl Iterator<Item = Instruction> + use<> {
        let held_out = self.held_out;
        self.condition.instructions().into_iter().filter(move |instruction| !held_out.contains(instruction))
    }

    /// Trials of an evaluation: each trained instruction from each start.
    pub fn trials(&self) -> usize {
        self.trained().count() * self.starts as usize
    }

    /// Steps at the end of a trial that are looked at, all at most.
    pub fn window_steps(&self) -> u32 {
        let steps = self.judging.window / self.time_step + 0.5;
        (steps as u32).clamp(1, self.steps)
    }

    /// Rules between values.
    ///
    /// # Errors
    /// [`Error::Setting`] for objects that may overlap each other or the arm at the start, or that the arm does not reach, and
    /// for joints that would start beyond their range.
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
