//! The simplest walking model, consisting of two massless legs, a point mass at the hip and very light feet on a
//! slope.

use std::fmt;

use farsa_num::{Scalar, sin_cos};

/// Time between two steps of the integration \[sqrt(leg length / gravity)\].
const STEP: f64 = 5e-3;
/// A step of the walker that takes longer than this has not come \[sqrt(leg length / gravity)\].
const LONGEST: f64 = 20.0;
/// By how much a state is moved for the derivatives of the return map.
const PROBE: f64 = 1e-5;

/// Smallest and largest slope for which a long-period gait was found (in radians).
pub const SLOPES: [f64; 2] = [1e-5, 0.06];

/// The simplest walking model on a given slope \[Garcia1998\].
///
/// Lengths are in units of the leg length, and times in units of sqrt(leg length / gravity). The angle `theta` of the
/// stance leg is measured from the normal of the slope and is positive while it leans back. The angle between the legs
/// is `phi`:
///
/// ```text
/// theta'' = sin(theta - gamma)
/// phi''   = theta'' + theta'^2 sin(phi) - cos(theta - gamma) sin(phi)
/// ```
///
/// The swing foot passes through the slope next to the stance foot. It strikes the ground when `phi = 2 theta` is
/// reached from below while `theta < 0`. Then the legs are exchanged, with `theta -> -theta`, `theta' -> cos(2 theta)
/// theta'`, and `phi' -> cos(2 theta) (1 - cos(2 theta)) theta'`. Deviations: none in the equations. They are
/// integrated with the classical fourth-order Runge-Kutta method in steps of 0.005, and the strike is found by
/// bisection.
///
/// ```
/// use farsa_experiments::walking::WalkingModel;
///
/// let gait = WalkingModel::new(0.009)?.gait().unwrap();
/// assert!((gait.angle - 0.200311).abs() < 1e-6);
/// assert!(gait.largest_multiplier() < 1.0);
/// # Ok::<(), farsa_experiments::walking::SlopeError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WalkingModel {
    slope: f64,
}

/// The error returned for a slope without a gait.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlopeError {
    /// Slope (in radians).
    pub slope: f64,
}

impl fmt::Display for SlopeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [low, high] = SLOPES;
        write!(f, "a slope of {} rad: the walking model's gaits are looked for from {low} to {high}", self.slope)
    }
}

impl std::error::Error for SlopeError {}

/// The result of one step of the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelStep {
    /// Angle and angular velocity of the new stance leg just after the strike.
    pub end: [f64; 2],
    /// Time since the last strike, in units of sqrt(leg length / gravity).
    pub period: f64,
}

/// A periodic gait, in which every step is the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelGait {
    /// Angle `theta*` of the stance leg just after a strike (in radians).
    pub angle: f64,
    /// Angular velocity `theta'*` of the stance leg (in rad sqrt(gravity / leg length)).
    pub rate: f64,
    /// Rate of change `phi'*` of the angle between the legs.
    pub swing_rate: f64,
    /// Duration of a step, in units of sqrt(leg length / gravity).
    pub period: f64,
    /// Eigenvalues of the derivative of the return map, as real and imaginary parts.
    pub multipliers: [[f64; 2]; 2],
}

impl ModelGait {
    /// Computes the larger absolute value of the two multipliers. If it is below 1, small disturbances decay.
    pub fn largest_multiplier(&self) -> f64 {
        let size = |[re, im]: [f64; 2]| Scalar::sqrt(re * re + im * im);
        size(self.multipliers[0]).max(size(self.multipliers[1]))
    }
}

/// Angle, rate, angle between the legs and its rate.
type State = [f64; 4];

fn moved(state: &State, by: f64, rate: &State) -> State {
    [0, 1, 2, 3].map(|k| state[k] + by * rate[k])
}

impl WalkingModel {
    /// Creates the model for a slope in radians.
    ///
    /// # Errors
    /// Returns [`SlopeError`] if the slope is outside [`SLOPES`].
    pub fn new(slope: f64) -> Result<Self, SlopeError> {
        let [low, high] = SLOPES;
        if (low..=high).contains(&slope) { Ok(Self { slope }) } else { Err(SlopeError { slope }) }
    }

    fn rates(self, &[theta, rate, phi, swing]: &State) -> State {
        // theta'' = sin(theta - gamma), the stance leg as an inverted pendulum, and phi'' = theta'' + theta'^2 sin phi - cos(theta - gamma)
        // sin phi, the swing leg as a pendulum on the moving hip [Garcia1998].
        let (lean, upright) = sin_cos(theta - self.slope);
        let (sine, _) = sin_cos(phi);
        [rate, lean, swing, lean + rate * rate * sine - upright * sine]
    }

    fn advanced(self, state: &State, h: f64) -> State {
        // Runge-Kutta of fourth order: s + h/6 (a + 2 b + 2 c + d).
        let a = self.rates(state);
        let b = self.rates(&moved(state, 0.5 * h, &a));
        let c = self.rates(&moved(state, 0.5 * h, &b));
        let d = self.rates(&moved(state, h, &c));
        [0, 1, 2, 3].map(|k| state[k] + h / 6.0 * (a[k] + 2.0 * (b[k] + c[k]) + d[k]))
    }

    /// Computes the end of a step that starts with the given angle and angular velocity of the stance leg just after a
    /// strike. Returns `None` if the walker falls.
    ///
    /// The swing leg starts where the strike left it, at `2 theta` with the rate `(1 - cos(2 theta)) theta'`.
    pub fn step(self, [angle, rate]: [f64; 2]) -> Option<ModelStep> {
        // The feet are level where phi = 2 theta. A strike is the crossing from below with the stance leg behind the normal, theta < 0.
        let below = |state: &State| state[2] - 2.0 * state[0] < 0.0;
        let (_, cosine) = sin_cos(2.0 * angle);
        let mut state = [angle, rate, 2.0 * angle, (1.0 - cosine) * rate];
        let mut time = 0.0;
        while time < LONGEST && state[0].abs() < 1.5 {
            let next = self.advanced(&state, STEP);
            if next[0] < 0.0 && below(&state) && !below(&next) {
                let (mut early, mut late) = (0.0, STEP);
                // Halved until no number lies between.
                for _ in 0..60 {
                    let middle = f64::midpoint(early, late);
                    let between = self.advanced(&state, middle);
                    *(if below(&between) { &mut early } else { &mut late }) = middle;
                }
                let [theta, rate, ..] = self.advanced(&state, late);
                let (_, cosine) = sin_cos(2.0 * theta);
                return Some(ModelStep { end: [-theta, cosine * rate], period: time + late });
            }
            state = next;
            time += STEP;
        }
        None
    }

    /// The derivative of the return map at a state, by central differences.
    fn derivative(self, at: [f64; 2]) -> Option<[[f64; 2]; 2]> {
        let mut columns = [[0.0; 2]; 2];
        for (k, column) in columns.iter_mut().enumerate() {
            let probe = |sign: f64| {
                let mut state = at;
                state[k] += sign * PROBE;
                self.step(state).map(|step| step.end)
            };
            let (ahead, back) = (probe(1.0)?, probe(-1.0)?);
            *column = [0, 1].map(|i| (ahead[i] - back[i]) / (2.0 * PROBE));
        }
        // From columns to rows.
        let [[a, c], [b, d]] = columns;
        Some([[a, b], [c, d]])
    }

    /// Computes the long-period gait with Newton's method. This gait is a fixed point of the return map. Returns `None`
    /// if the iteration does not converge.
    ///
    /// The iteration starts with `theta* = (0.971 - 0.18 s^2) s` and `theta'* = (1.25 s^2 - 1.015) s` where `s =
    /// slope^(1/3)`. These values approximate the gaits on small slopes. Note that there is also an
    /// unstable gait with a shorter period.
    pub fn gait(self) -> Option<ModelGait> {
        let size = farsa_num::exp(farsa_num::ln(self.slope) / 3.0);
        let square = size * size;
        let mut at = [(0.971 - 0.18 * square) * size, (1.25 * square - 1.015) * size];
        for _ in 0..40 {
            let [[a, b], [c, d]] = self.derivative(at)?;
            let step = self.step(at)?;
            let [u, v] = [step.end[0] - at[0], step.end[1] - at[1]];
            // (1 - P') change = P - at.
            let determinant = (1.0 - a) * (1.0 - d) - b * c;
            let change = [((1.0 - d) * u + b * v) / determinant, (c * u + (1.0 - a) * v) / determinant];
            at = [at[0] + change[0], at[1] + change[1]];
            if change[0].abs() + change[1].abs() < 1e-12 {
                let [[a, b], [c, d]] = self.derivative(at)?;
                let (_, cosine) = sin_cos(2.0 * at[0]);
                return Some(ModelGait {
                    angle: at[0],
                    rate: at[1],
                    swing_rate: (1.0 - cosine) * at[1],
                    period: self.step(at)?.period,
                    multipliers: eigenvalues(a, b, c, d),
                });
            }
        }
        None
    }
}

/// The eigenvalues of `[[a, b], [c, d]]`, each real and imaginary part.
fn eigenvalues(a: f64, b: f64, c: f64, d: f64) -> [[f64; 2]; 2] {
    // lambda = tr/2 +- sqrt((tr/2)^2 - det).
    let middle = f64::midpoint(a, d);
    let square = middle * middle - (a * d - b * c);
    let root = Scalar::sqrt(square.abs());
    if square < 0.0 { [[middle, root], [middle, -root]] } else { [[middle + root, 0.0], [middle - root, 0.0]] }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Slope, theta*, theta'*, phi'*, period, largest multiplier of the long-period gaits, as
    /// `tests/fixtures/walking_model.py` prints them.
    const GAITS: [[f64; 6]; 3] = [
        [0.004, 0.153_389_564_9, -0.156_080_146_7, -0.007_287_197_1, 3.852_613_462, 0.633_920],
        [0.009, 0.200_310_900_5, -0.199_832_473_0, -0.015_822_999_9, 3.882_463_753, 0.589_113],
        [0.014, 0.231_449_137_1, -0.227_099_692_8, -0.023_899_505_5, 3.907_370_566, 0.702_792],
    ];

    #[test]
    fn gaits_are_the_published_ones() {
        for [slope, angle, rate, swing_rate, period, multiplier] in GAITS {
            let gait = WalkingModel::new(slope).unwrap().gait().unwrap();
            for (found, known) in [(gait.angle, angle), (gait.rate, rate), (gait.swing_rate, swing_rate)] {
                assert!((found - known).abs() < 1e-9, "{slope}: {found} where {known} is known");
            }
            assert!((gait.period - period).abs() < 2e-9, "{slope}: {gait:?}");
            assert!((gait.largest_multiplier() - multiplier).abs() < 5e-6, "{slope}: {gait:?}");
        }
    }

    #[test]
    fn iterating_comes_to_the_fixed_point_at_the_rate_of_the_multiplier() {
        let model = WalkingModel::new(0.009).unwrap();
        let gait = model.gait().unwrap();
        let mut at = [gait.angle + 2e-3, gait.rate];
        let off = |at: [f64; 2]| (at[0] - gait.angle).abs().max((at[1] - gait.rate).abs());
        let mut distances = Vec::new();
        for _ in 0..40 {
            distances.push(off(at));
            at = model.step(at).unwrap().end;
        }
        assert!(distances[39] < 1e-9, "{distances:?}");
        // Two multipliers: over ten steps the larger one bounds what is left, up to a factor of the directions.
        let over_ten = distances[30] / distances[20];
        let bound = (0..10).fold(1.0, |x, _| x * gait.largest_multiplier());
        assert!(over_ten < 3.0 * bound && over_ten > bound / 30.0, "{over_ten} {bound}");
    }

    #[test]
    fn between_strikes_energy_is_kept() {
        // The hip's energy alone: the feet weigh nothing.
        let model = WalkingModel::new(0.009).unwrap();
        let energy = |s: &State| 0.5 * s[1] * s[1] + sin_cos(s[0] - 0.009).1;
        let mut state = [0.2, -0.2, 0.4, -0.016];
        let before = energy(&state);
        for _ in 0..600 {
            state = model.advanced(&state, STEP);
        }
        assert!((energy(&state) - before).abs() < 1e-11);
    }

    #[test]
    fn a_walker_without_push_falls_back_and_slopes_have_a_range() {
        let model = WalkingModel::new(0.009).unwrap();
        assert_eq!(model.step([0.3, 0.0]), None);
        for slope in [0.0, -0.1, 0.2, f64::NAN] {
            assert!(WalkingModel::new(slope).is_err(), "{slope}");
        }
        assert!(WalkingModel::new(0.2).unwrap_err().to_string().starts_with("a slope of 0.2 rad"));
    }
}
