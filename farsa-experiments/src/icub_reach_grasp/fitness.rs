//! The reward of a trial of `icub-reach-grasp`.

use farsa_num::Scalar;

use crate::icub_reach_grasp::config::Config;

/// Parts of the hand: the palm and fifteen phalanges.
pub(crate) const PARTS: usize = 16;
/// The share of the touch reward for a touch by one part alone.
const ONE_TOUCH: f64 = 0.25;

/// The judge's view of a world after a step.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Observation {
    /// The palm's center \[m\].
    pub palm: [f64; 3],
    /// The ball's center \[m\].
    pub ball: [f64; 3],
    /// From the palm's center to the ball's surface, 0 within it \[m\].
    pub distance: f64,
    /// Height of the ball's lowest point above the table \[m\].
    pub height: f64,
    /// Parts of the hand that touch the ball.
    pub touching: u32,
    /// The opposition of two touching parts, [`opposition`].
    pub opposition: f64,
    /// Something else than the hand touches the ball.
    pub supported: bool,
}

impl Observation {
    /// True if all values are finite.
    pub fn is_finite(&self) -> bool {
        let Self { palm, ball, opposition, .. } = self;
        palm.iter().chain(ball).chain([opposition]).all(|x| x.is_finite())
    }

    /// The share of the touch reward: nothing without a touch, a quarter for one side, all for two opposite ones.
    pub fn touch(&self) -> f64 {
        if self.touching == 0 { 0.0 } else { ONE_TOUCH + (1.0 - ONE_TOUCH) * self.opposition }
    }

    /// True if the hand holds the ball, and nothing else touches it.
    pub fn is_held(&self) -> bool {
        self.touching > 0 && !self.supported
    }
}

/// The largest opposition of two of these directions from a center, of any length \[n x 3\].
///
/// 0 for one direction or none, 1 for opposite ones, in general (1 - cos) / 2 of the largest angle between two.
pub fn opposition(directions: &[[f64; 3]]) -> f64 {
    let mut most = 0.0_f64;
    for (i, a) in directions.iter().enumerate() {
        for b in &directions[..i] {
            let dot = |u: &[f64; 3], v: &[f64; 3]| u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
            let lengths = Scalar::sqrt(dot(a, a) * dot(b, b));
            if lengths > 0.0 {
                most = most.max((0.5 - 0.5 * dot(a, b) / lengths).clamp(0.0, 1.0));
            }
        }
    }
    most
}

/// The sums of a trial.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Score {
    /// Steps so far.
    pub steps: u32,
    /// The last of them in which the ball was up and held.
    pub held: u32,
    /// The greatest height of the ball while it was held \[m\].
    pub highest: f64,
    /// The ball has fallen off the table.
    pub fallen: bool,
    start: f64,
    nearness: f64,
    touch: f64,
    lift: f64,
}

impl Score {
    /// A trial that starts with the hand at a distance from the ball \[m\].
    pub fn new(distance: f64) -> Self {
        Self { start: distance, ..Self::default() }
    }

    /// Counts a step.
    pub fn add(&mut self, config: &Config, seen: &Observation) {
        self.steps += 1;
        if self.start > 0.0 {
            self.nearness += (1.0 - seen.distance / self.start).clamp(0.0, 1.0);
        }
        let height = if seen.is_held() { seen.height.max(0.0) } else { 0.0 };
        self.highest = self.highest.max(height);
        self.held = if height >= config.height { self.held + 1 } else { 0 };
        if self.steps + config.window_steps() > config.steps {
            self.touch += seen.touch();
            self.lift += (height / config.height).min(1.0);
        }
        self.fallen = seen.height < -config.ball_radius;
    }

    /// The world has broken down: the nearness is no number any more.
    pub fn fail(&mut self) {
        self.nearness = f64::NAN;
    }

    /// The terms of the reward if the trial ends now, each from 0 to 1. Nearness of the hand is a mean over the trial. Touch and
    /// height are means over its last seconds. Steps lost by a fall off the table earn nothing.
    pub fn terms(&self, config: &Config) -> [f64; 3] {
        let window = f64::from(config.window_steps());
        [self.nearness / f64::from(config.steps), self.touch / window, self.lift / window]
    }

    /// True if an ended trial succeeds.
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
