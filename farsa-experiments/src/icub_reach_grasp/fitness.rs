//! Computation of the reward in `icub-reach-grasp`.

use farsa_num::Scalar;

use crate::icub_reach_grasp::config::Config;

/// Parts of the hand: the palm and fifteen phalanges.
pub(crate) const PARTS: usize = 16;
/// The share of the touch reward for a touch by one part alone.
const ONE_TOUCH: f64 = 0.25;

/// A snapshot of the scene after a step, from which the reward is computed.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Observation {
    /// Center of the palm in meters.
    pub palm: [f64; 3],
    /// Center of the ball in meters.
    pub ball: [f64; 3],
    /// Distance from the center of the palm to the surface of the ball (in meters). It is zero inside the ball.
    pub distance: f64,
    /// Height of the lowest point of the ball above the table (in meters).
    pub height: f64,
    /// Number of parts of the hand that touch the ball.
    pub touching: u32,
    /// Largest opposition of two parts that touch the ball, as computed by [`opposition`].
    pub opposition: f64,
    /// True if anything except the hand touches the ball.
    pub supported: bool,
}

impl Observation {
    /// Returns true if all values are finite.
    pub fn is_finite(&self) -> bool {
        let Self { palm, ball, opposition, .. } = self;
        palm.iter().chain(ball).chain([opposition]).all(|x| x.is_finite())
    }

    /// Computes the share of the touch reward. It is zero without contact, a quarter if the ball is touched on one
    /// side, and one if it is touched on opposite sides.
    pub fn touch(&self) -> f64 {
        if self.touching == 0 { 0.0 } else { ONE_TOUCH + (1.0 - ONE_TOUCH) * self.opposition }
    }

    /// Returns true if the ball is held by the hand and touches nothing else.
    pub fn is_held(&self) -> bool {
        self.touching > 0 && !self.supported
    }
}

/// Computes the largest opposition of two directions in a list of n vectors. They may have any length.
///
/// The opposition of two vectors is (1 - cos) / 2 of the angle between them. It is 1 for opposite vectors. The result
/// is 0 for lists with fewer than two vectors.
pub fn opposition(directions: &[[f64; 3]]) -> f64 {
    let mut most = 0.0_f64;
    for (i, a) in directions.iter().enumerate() {
        for b in &directions[..i] {
            // (1 - cos) / 2 is 0 for equal and 1 for opposite directions.
            let dot = |u: &[f64; 3], v: &[f64; 3]| u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
            let lengths = Scalar::sqrt(dot(a, a) * dot(b, b));
            if lengths > 0.0 {
                most = most.max((0.5 - 0.5 * dot(a, b) / lengths).clamp(0.0, 1.0));
            }
        }
    }
    most
}

/// The sums from which the reward of a trial is computed.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Score {
    /// Number of steps that have been counted.
    pub steps: u32,
    /// Number of consecutive steps up to the last one in which the ball was lifted and held.
    pub held: u32,
    /// Largest height at which the ball was held (in meters).
    pub highest: f64,
    /// True if the ball has fallen off the table.
    pub fallen: bool,
    start: f64,
    nearness: f64,
    touch: f64,
    lift: f64,
}

impl Score {
    /// Starts a trial with the given distance between the hand and the ball (in meters).
    pub fn new(distance: f64) -> Self {
        Self { start: distance, ..Self::default() }
    }

    /// Adds the observation of a step.
    pub fn add(&mut self, config: &Config, seen: &Observation) {
        self.steps += 1;
        if self.start > 0.0 {
            // 1 - d(t) / d(0). Distances above the initial one count as 0.
            self.nearness += (1.0 - seen.distance / self.start).clamp(0.0, 1.0);
        }
        // Only the height of a held ball counts. A ball that bounces up earns nothing.
        let height = if seen.is_held() { seen.height.max(0.0) } else { 0.0 };
        self.highest = self.highest.max(height);
        self.held = if height >= config.height { self.held + 1 } else { 0 };
        // True in exactly the last `window_steps` steps, because `steps` includes this one.
        if self.steps + config.window_steps() > config.steps {
            self.touch += seen.touch();
            self.lift += (height / config.height).min(1.0);
        }
        // Height is 0 for a ball on the table, so this is a center below the table top.
        self.fallen = seen.height < -config.ball_radius;
    }

    /// Records a numerical failure of the simulation. The term for nearness becomes NaN.
    pub fn fail(&mut self) {
        self.nearness = f64::NAN;
    }

    /// Computes the terms of the reward as if the trial ended now. Each of them is between 0 and 1.
    ///
    /// The first term is the mean nearness of the hand over the whole trial. The terms for touch and height are means
    /// over its last seconds. Steps that are lost because the ball fell off the table earn nothing.
    pub fn terms(&self, config: &Config) -> [f64; 3] {
        let window = f64::from(config.window_steps());
        [self.nearness / f64::from(config.steps), self.touch / window, self.lift / window]
    }

    /// Returns true if a trial that has ended was successful.
    pub fn succeeds(&self, config: &Config) -> bool {
        self.held >= config.hold_steps() && !self.fallen
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn at(distance: f64, height: f64, touching: u32, opposition: f64, supported: bool) -> Observation {
        Observation { distance, height, touching, opposition, supported, ..Observation::default() }
    }

    /// Four steps of which the last two count for touch and height.
    fn short() -> Config {
        Config { steps: 4, window: 0.1, hold: 0.1, ..Config::default() }
    }

    #[test]
    fn terms_are_those_by_hand() {
        let config = short();
        let mut score = Score::new(0.4);
        score.add(&config, &at(0.3, 0.0, 0, 0.0, true));
        score.add(&config, &at(0.1, 0.0, 1, 0.0, true));
        score.add(&config, &at(0.0, 0.05, 3, 0.8, false));
        assert!(!score.succeeds(&config));
        score.add(&config, &at(0.0, 0.2, 2, 1.0, false));
        let [nearness, touch, lift] = score.terms(&config);
        assert!((nearness - (0.25 + 0.75 + 1.0 + 1.0) / 4.0).abs() < 1e-12);
        assert!((touch - (0.25 + 0.75 * 0.8 + 1.0) / 2.0).abs() < 1e-12);
        assert!((lift - 0.75).abs() < 1e-12);
        assert_eq!((score.held, score.highest), (1, 0.2));
        assert!(!score.succeeds(&config));
        let mut score = Score::new(0.4);
        for _ in 0..4 {
            score.add(&config, &at(0.0, 0.1, 2, 1.0, false));
        }
        assert_eq!(score.terms(&config), [1.0; 3]);
        assert!(score.succeeds(&config));
    }

    #[test]
    fn a_ball_that_something_else_carries_is_not_lifted() {
        let config = short();
        let mut score = Score::new(0.4);
        for _ in 0..4 {
            score.add(&config, &at(0.0, 0.2, 2, 1.0, true));
        }
        assert_eq!(score.terms(&config), [1.0, 1.0, 0.0]);
        // Nor is one that flies.
        let mut score = Score::new(0.4);
        for _ in 0..4 {
            score.add(&config, &at(0.1, 0.2, 0, 0.0, false));
        }
        assert_eq!((score.terms(&config)[2], score.held), (0.0, 0));
        score.add(&config, &at(0.4, -0.2, 0, 0.0, false));
        assert!(score.fallen);
    }

    #[test]
    fn opposition_is_that_of_the_widest_angle() {
        assert_eq!(opposition(&[]), 0.0);
        assert_eq!(opposition(&[[1.0, 0.0, 0.0]]), 0.0);
        let three = [[2.0, 0.0, 0.0], [0.0, 3.0, 0.0], [-1.0, 0.0, 0.0]];
        assert_eq!(opposition(&three), 1.0);
        assert!((opposition(&three[..2]) - 0.5).abs() < 1e-12);
    }

    proptest! {
        #[test]
        fn no_trial_earns_more_than_one_of_each(
            start in 0.0..1.0_f64,
            steps in prop::collection::vec((-0.1..2.0_f64, -1.0..2.0_f64, 0..17_u32, 0.0..=1.0_f64, any::<bool>()), 0..300),
        ) {
            let config = Config::default();
            let mut score = Score::new(start);
            for (distance, height, touching, opposition, supported) in steps {
                score.add(&config, &at(distance, height, touching, opposition, supported));
            }
            for term in score.terms(&config) {
                prop_assert!((0.0..=1.0 + 1e-12).contains(&term), "{term}");
            }
        }
    }
}
