//! Computation of the reward in `reach-grasp-lift`, and the criterion for success.

use serde::{Deserialize, Serialize};

use crate::reach_grasp_lift::phase::{Observation, Phase};

/// Largest possible sum of the reach terms over all trials of an individual \[Ferrauto2010, 2.3.4\].
pub const REACH_CAP: f64 = 500.0;
/// Largest possible sum of the grasp terms over all trials of an individual \[Ferrauto2010, 2.3.4\].
pub const GRASP_CAP: f64 = 720.0;
/// Largest possible sum of the lift terms over all trials of an individual \[Ferrauto2010, 2.3.4\].
pub const LIFT_CAP: f64 = 1600.0;

/// An interpretation of the contact term of the grasp reward. In the source, the typesetting reduces its fraction to
/// "0.2 1+contacts(t)4".
///
/// Fitness values with different interpretations must not be compared. Each run therefore records the name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ContactTerm {
    /// The term is 0.2 min(1, contacts/4). A grasp step then earns at most 0.6. This agrees with the cap
    /// `720 = 0.6 * 1200`.
    #[default]
    Capped,
    /// The term is 0.2/(1 + contacts/4), following the print literally. Note that it penalizes contacts.
    Literal,
    /// The term is 0.2 (1 - 1/(1 + contacts/4)).
    Saturating,
}

impl ContactTerm {
    /// All interpretations of the contact term.
    pub const ALL: [Self; 3] = [Self::Capped, Self::Literal, Self::Saturating];

    /// Computes the contact term for the given number of phalanges that touch the sphere.
    pub fn value(self, contacts: u32) -> f64 {
        let quarter = f64::from(contacts) / 4.0;
        match self {
            // The fourth phalanx completes the term. Further contacts add nothing.
            Self::Capped if contacts >= 4 => 0.2,
            Self::Capped => 0.2 * quarter,
            Self::Literal => 0.2 / (1.0 + quarter),
            Self::Saturating => 0.2 * (1.0 - 1.0 / (1.0 + quarter)),
        }
    }

    /// Returns the name of the interpretation.
    pub fn name(self) -> &'static str {
        match self {
            Self::Capped => "capped",
            Self::Literal => "literal",
            Self::Saturating => "saturating",
        }
    }
}

/// The rules for reward and success that are not fully specified by the source.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Judgement {
    /// Interpretation of the contact term.
    pub contact_term: ContactTerm,
    /// Height above the table that the center of the sphere must reach in a successful lift (in centimeters). The
    /// default is 5. Without this limit, a sphere on a hand that rests on the table would also count as lifted.
    pub success_height: f64,
    /// Least height above the table that the center of the sphere must have for the reward of a lift step (in meters).
    /// The default is 0, which rewards lifting at any height, as printed.
    pub lift_height: f64,
}

impl Default for Judgement {
    fn default() -> Self {
        Self { contact_term: ContactTerm::default(), success_height: 5.0, lift_height: 0.0 }
    }
}

impl Judgement {
    /// Returns true if a lift step with the given observation is rewarded.
    pub fn rewards_lift(&self, seen: &Observation) -> bool {
        // Without a limit, heights below the table top count, too.
        seen.lifted() && (self.lift_height == 0.0 || seen.height >= 100.0 * self.lift_height)
    }
}

/// The terms of the reward before the caps are applied.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Rewards {
    /// Term FR, the sum of 0.5/(1 + ds/4) + 0.25/(1 + ds) (fOpen + pRot) over all reach steps.
    pub reach: f64,
    /// Term FG, the sum of 0.4/(1 + graspQ) and the contact term over all grasp steps.
    pub grasp: f64,
    /// Term FL, the number of lift steps in which the fingers touched the sphere and the table did not, at a height of
    /// at least [`Judgement::lift_height`].
    pub lift: f64,
    /// Sum of the bonuses of all trials that have ended.
    pub bonus: f64,
}

impl Rewards {
    /// Computes the reward of one step in the given phase \[Ferrauto2010, 2.3.4\].
    pub fn from_step(phase: Phase, seen: &Observation, by: &Judgement) -> Self {
        let mut earned = Self::default();
        match phase {
            Phase::Reach => {
                // 0.5/(1 + ds/4) + 0.25/(1 + ds) (fOpen + pRot), with ds in centimeters [Ferrauto2010, 2.3.4]. The
                // second part falls off faster, so the posture of the hand matters only near the sphere.
                let ds = seen.reach_distance;
                earned.reach = 0.5 / (1.0 + ds / 4.0) + 0.25 / (1.0 + ds) * (seen.openness + seen.palm_down);
            }
            // graspQ is in centimeters. Every contact term is at most 0.2, so a step earns at most 0.6.
            Phase::Grasp => {
                earned.grasp = 0.4 / (1.0 + seen.grasp_distance) + by.contact_term.value(seen.contacts);
            }
            Phase::Lift => earned.lift = if by.rewards_lift(seen) { 1.0 } else { 0.0 },
        }
        earned
    }

    /// Adds the rewards of another step or trial.
    pub fn add(&mut self, other: &Self) {
        self.reach += other.reach;
        self.grasp += other.grasp;
        self.lift += other.lift;
        self.bonus += other.bonus;
    }

    /// Computes F = min(500, FR) + min(720, FG) + min(1600, FL) + bonus from the sums over all trials.
    ///
    /// The result is NaN if any term is NaN. Note that `f64::min` alone would replace NaN by the cap.
    pub fn total(&self) -> f64 {
        let sum = self.reach + self.grasp + self.lift + self.bonus;
        if sum.is_nan() {
            return f64::NAN;
        }
        // Bonuses have no cap. Four lifted trials add 2400 to the caps, whose sum is 2820.
        self.reach.min(REACH_CAP) + self.grasp.min(GRASP_CAP) + self.lift.min(LIFT_CAP) + self.bonus
    }
}

/// The state of a trial, from which its reward and its success are determined.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Trial {
    /// Phase after the last step. The next label indicates this phase.
    pub phase: Phase,
    /// Number of steps that have been judged.
    pub steps: u32,
    /// Number of consecutive steps up to the last one in which the sphere touched the fingers and did not touch the
    /// table.
    pub lifted: u32,
    /// Number of consecutive lifted steps in which the center of the sphere was at least
    /// [`Judgement::success_height`] above the table.
    pub held: u32,
    /// Largest height of the sphere's center above the table so far (in centimeters).
    pub highest: f64,
    /// True if the trial ended because the sphere fell off the table.
    pub fallen: bool,
    /// Rewards of all steps. The bonus is added at the end of the trial.
    pub rewards: Rewards,
}

impl Trial {
    /// Adds the observation of a step and returns its reward. The phase is updated first, so a step that changes the
    /// phase is already rewarded according to the new phase.
    pub fn judge(&mut self, seen: &Observation, by: &Judgement) -> Rewards {
        self.phase = self.phase.next(seen);
        let earned = Rewards::from_step(self.phase, seen, by);
        self.rewards.add(&earned);
        self.steps += 1;
        // Both counters restart at 0 in a step without lifting, so they count consecutive steps up to the last one.
        self.lifted = if seen.lifted() { self.lifted + 1 } else { 0 };
        self.held = if seen.lifted() && seen.height >= by.success_height { self.held + 1 } else { 0 };
        // The first height replaces the default of 0, which would hide heights below the table top.
        self.highest = if self.steps == 1 { seen.height } else { self.highest.max(seen.height) };
        earned
    }

    /// Ends the trial and adds the bonus for the phase that was reached.
    pub fn end(&mut self) {
        self.rewards.bonus = self.phase.bonus();
    }

    /// Returns true if the trial would count as a success if it ended now. For this the sphere must have been held up
    /// in each of the last `second` steps and must not have fallen.
    pub fn succeeds(&self, second: u32) -> bool {
        second > 0 && self.held >= second && !self.fallen
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const STEPS: u32 = 600;
    const TRIALS: u32 = 4;

    fn by(contact_term: ContactTerm) -> Judgement {
        Judgement { contact_term, ..Judgement::default() }
    }

    fn near(a: f64, b: f64) {
        assert!((a - b).abs() < 1e-9, "{a} {b}");
    }

    fn far_away() -> Observation {
        Observation {
            reach_distance: 36.0,
            grasp_distance: 40.0,
            openness: 1.0,
            palm_down: 1.0,
            on_table: true,
            height: 2.5,
            ..Observation::default()
        }
    }

    /// Perfect in every respect but that of grasping: pays 1 in reach and stays there.
    fn best_reach() -> Observation {
        Observation {
            reach_distance: 0.0,
            grasp_distance: 5.0,
            openness: 1.0,
            palm_down: 1.0,
            on_table: true,
            height: 2.5,
            ..Observation::default()
        }
    }

    fn best_grasp() -> Observation {
        Observation { contacts: 3, grasp_distance: 0.0, ..best_reach() }
    }

    fn best_lift() -> Observation {
        Observation { contacts: 4, grasp_distance: 0.0, on_table: false, height: 10.0, ..best_reach() }
    }

    fn individual(trials: &[Vec<Observation>], term: ContactTerm) -> Rewards {
        let mut sum = Rewards::default();
        for steps in trials {
            let mut trial = Trial::default();
            for seen in steps {
                trial.judge(seen, &by(term));
            }
            trial.end();
            sum.add(&trial.rewards);
        }
        sum
    }

    fn sequence(parts: &[(Observation, usize)]) -> Vec<Observation> {
        parts.iter().flat_map(|&(seen, count)| core::iter::repeat_n(seen, count)).collect()
    }

    #[test]
    fn a_reach_step_pays_for_nearness_open_hand_and_palm_down() {
        let step = |seen: &Observation| Rewards::from_step(Phase::Reach, seen, &Judgement::default()).reach;
        near(step(&best_reach()), 1.0);
        // 0.5/(1 + 9) + 0.25/37 * 2
        near(step(&far_away()), 0.05 + 0.5 / 37.0);
        // 0.5/2 + 0.25/5 * (0.5 - 1): a palm that looks up costs.
        let seen = Observation { reach_distance: 4.0, openness: 0.5, palm_down: -1.0, ..far_away() };
        near(step(&seen), 0.225);
    }

    #[test]
    fn a_grasp_step_pays_for_nearness_and_contacts() {
        let step = |term, grasp_distance, contacts| {
            Rewards::from_step(Phase::Grasp, &Observation { grasp_distance, contacts, ..far_away() }, &by(term)).grasp
        };
        near(step(ContactTerm::Capped, 0.0, 4), 0.6);
        near(step(ContactTerm::Capped, 0.0, 9), 0.6);
        near(step(ContactTerm::Capped, 1.0, 3), 0.35);
        near(step(ContactTerm::Capped, 3.0, 0), 0.1);
        near(step(ContactTerm::Literal, 0.0, 0), 0.6);
        near(step(ContactTerm::Literal, 1.0, 4), 0.3);
        near(step(ContactTerm::Saturating, 1.0, 4), 0.3);
        near(step(ContactTerm::Saturating, 1.0, 12), 0.35);
        near(step(ContactTerm::Saturating, 0.0, 0), 0.4);
    }

    #[test]
    fn a_lift_step_pays_when_the_sphere_is_on_the_fingers_and_off_the_table() {
        let step = |contacts, on_table| {
            let seen = Observation { contacts, on_table, ..far_away() };
            Rewards::from_step(Phase::Lift, &seen, &Judgement::default()).lift
        };
        assert_eq!([step(1, false), step(1, true), step(0, false), step(0, true)], [1.0, 0.0, 0.0, 0.0]);
    }

    #[test]
    fn a_lift_step_below_the_height_for_lifting_pays_nothing() {
        let step = |lift_height, height, on_table| {
            let seen = Observation { contacts: 4, on_table, height, ..far_away() };
            Rewards::from_step(Phase::Lift, &seen, &Judgement { lift_height, ..Judgement::default() }).lift
        };
        assert_eq!([4.999, 5.0, 40.0].map(|height| step(0.05, height, false)), [0.0, 1.0, 1.0]);
        assert_eq!(step(0.05, 40.0, true), 0.0);
        // As printed, also when the hand holds the sphere beyond the edge of the table and below its top.
        assert_eq!([-0.1, 0.0, 3.0].map(|height| step(0.0, height, false)), [1.0; 3]);
    }

    #[test]
    fn the_height_for_lifting_changes_no_other_term() {
        let low = Observation { height: 3.0, ..best_lift() };
        let steps = sequence(&[(far_away(), 5), (best_grasp(), 5), (low, 20), (best_lift(), 10)]);
        let [printed, high] = [0.0, 0.05].map(|lift_height| {
            let (by, mut trial) = (Judgement { lift_height, ..Judgement::default() }, Trial::default());
            for seen in &steps {
                trial.judge(seen, &by);
            }
            trial
        });
        // One low step is still in the phase grasp.
        assert_eq!([printed.rewards.lift, high.rewards.lift], [30.0, 10.0]);
        assert_eq!(Trial { rewards: Rewards { lift: 30.0, ..high.rewards }, ..high }, printed);
    }

    #[test]
    fn the_step_that_switches_is_paid_by_the_new_phase() {
        let mut trial = Trial::default();
        near(trial.judge(&best_reach(), &by(ContactTerm::Capped)).reach, 1.0);
        // Perfect for lifting, but one transition a step: paid as a grasp step with four contacts.
        let earned = trial.judge(&best_lift(), &by(ContactTerm::Capped));
        assert_eq!(trial.phase, Phase::Grasp);
        near(earned.grasp, 0.6);
        assert_eq!(earned.reach, 0.0);
        assert_eq!(trial.judge(&best_lift(), &by(ContactTerm::Capped)).lift, 1.0);
        // Irreversible: far away again, the lift phase pays, and it pays nothing.
        assert_eq!(trial.judge(&far_away(), &by(ContactTerm::Capped)), Rewards::default());
        assert_eq!(trial.phase, Phase::Lift);
    }

    #[test]
    fn bonuses_by_the_phase_reached() {
        let bonus = |parts: &[(Observation, usize)]| individual(&[sequence(parts)], ContactTerm::Capped).bonus;
        assert_eq!(bonus(&[]), 0.0);
        assert_eq!(bonus(&[(far_away(), 600)]), 0.0);
        assert_eq!(bonus(&[(far_away(), 10), (best_grasp(), 1)]), 300.0);
        assert_eq!(bonus(&[(best_lift(), 2)]), 600.0);
        assert_eq!(bonus(&[(best_lift(), 2), (far_away(), 600)]), 600.0);
    }

    #[test]
    fn each_cap_saturates_alone() {
        let all = |seen: Observation| vec![sequence(&[(seen, STEPS as usize)]); TRIALS as usize];
        let reach = individual(&all(best_reach()), ContactTerm::Capped);
        near(reach.reach, 2400.0);
        near(reach.total(), 500.0);
        let grasp = individual(&all(best_grasp()), ContactTerm::Capped);
        near(grasp.grasp, 0.55 * 2400.0);
        near(grasp.total(), 720.0 + 4.0 * 300.0);
        let lift = individual(&all(best_lift()), ContactTerm::Capped);
        near(lift.lift, 4.0 * 599.0);
        near(lift.grasp, 4.0 * 0.6);
        near(lift.total(), 2.4 + 1600.0 + 2400.0);
    }

    #[test]
    fn the_caps_are_over_the_trials_and_not_on_each() {
        // 125 perfect reach steps in each trial fill the cap exactly. With 100 in three and 200 in one the sum is the same.
        let reach = |counts: [usize; 4]| {
            individual(&counts.map(|n| sequence(&[(best_reach(), n), (far_away(), 0)])), ContactTerm::Capped).total()
        };
        near(reach([125, 125, 125, 125]), 500.0);
        near(reach([100, 100, 100, 200]), 500.0);
        near(reach([0, 0, 0, 499]), 499.0);
    }

    #[test]
    fn the_best_sequence() {
        // 500 reach + 1600 lift steps fill their caps, 300 steps are left for the grasp.
        let trial =
            |entry: Observation| sequence(&[(best_reach(), 125), (entry, 1), (best_grasp(), 74), (best_lift(), 400)]);
        let trials = |entry| vec![trial(entry); 4];
        assert_eq!(trial(best_grasp()).len(), 600);
        // With at most three contacts in every grasp step: the 4665 of the specification.
        near(individual(&trials(best_grasp()), ContactTerm::Capped).total(), 4665.0);
        // The step that enters the phase may have four, since only the next one leaves it: 0.05 more in each trial.
        near(individual(&trials(best_lift()), ContactTerm::Capped).total(), 4665.2);
        // The bound over all contact terms is reached by the literal one, which pays 0.2 without any contact.
        let untouched = Observation { contacts: 0, ..best_grasp() };
        let steps = sequence(&[(best_reach(), 125), (untouched, 75), (best_lift(), 400)]);
        near(individual(&vec![steps; 4], ContactTerm::Literal).total(), 4680.0);
    }

    #[test]
    fn success_is_a_whole_last_second_of_holding_up() {
        let mut trial = Trial::default();
        let up = best_lift();
        for _ in 0..99 {
            trial.judge(&up, &by(ContactTerm::Capped));
        }
        assert!(!trial.succeeds(100));
        trial.judge(&up, &by(ContactTerm::Capped));
        assert!(trial.succeeds(100));
        for spoilt in [
            Observation { height: 4.999, ..up },
            Observation { on_table: true, ..up },
            Observation { contacts: 0, ..up },
        ] {
            let mut trial = trial;
            trial.judge(&spoilt, &by(ContactTerm::Capped));
            assert!(!trial.succeeds(100));
            assert_eq!(trial.held, 0);
            assert_eq!(trial.lifted, if spoilt.lifted() { 101 } else { 0 });
        }
        assert!(!Trial { fallen: true, ..trial }.succeeds(100));
        let exactly = Observation { height: 5.0, ..up };
        trial.judge(&exactly, &by(ContactTerm::Capped));
        assert!(trial.succeeds(100));
        assert_eq!(trial.highest, 10.0);
    }

    #[test]
    fn no_number_earns_no_cap() {
        let rewards = Rewards { reach: f64::NAN, ..Rewards::default() };
        assert!(rewards.total().is_nan());
    }

    fn observation() -> impl Strategy<Value = Observation> {
        let distance = || prop_oneof![Just(0.0), 0.0..6.0, 0.0..80.0];
        (distance(), distance(), 0u32..=15, 0.0..=1.0, -1.0..=1.0, any::<bool>(), -1.0..40.0).prop_map(
            |(reach_distance, grasp_distance, contacts, openness, palm_down, on_table, height)| Observation {
                reach_distance,
                grasp_distance,
                contacts,
                openness,
                palm_down,
                on_table,
                height,
                ..Observation::default()
            },
        )
    }

    /// Runs of a few equal observations, so that long stays in each phase are drawn as often as short ones.
    fn trial() -> impl Strategy<Value = Vec<Observation>> {
        let good = prop_oneof![Just(best_reach()), Just(best_grasp()), Just(best_lift()), observation()];
        prop::collection::vec((prop_oneof![good, observation()], 1usize..400), 1..8).prop_map(|parts| {
            let mut steps = sequence(&parts);
            steps.truncate(STEPS as usize);
            steps
        })
    }

    proptest! {
        #[test]
        fn no_individual_exceeds_4680(trials in prop::collection::vec(trial(), 4), term in prop::sample::select(&ContactTerm::ALL[..])) {
            let rewards = individual(&trials, term);
            prop_assert!(rewards.total() <= 4680.0 + 1e-9, "{rewards:?}");
            if term == ContactTerm::Capped {
                prop_assert!(rewards.total() <= 4665.2 + 1e-9, "{rewards:?}");
            }
            prop_assert!(rewards.total() >= -0.25 * 2400.0);
        }
    }
}
