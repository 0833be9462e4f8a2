//! The three phases of `reach-grasp-lift`, and the observations that distinguish them.

use farsa_num::exp;
use serde::{Deserialize, Serialize};

/// A phase of a trial. The phases follow each other in this order, and a trial never returns to an earlier phase.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Phase {
    /// The hand moves toward the sphere.
    #[default]
    Reach,
    /// The hand closes around the sphere.
    Grasp,
    /// The hand lifts the sphere.
    Lift,
}

/// A snapshot of the scene after a step, from which the reward is computed.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Observation {
    /// Distance ds between the center of the palm and a point 5 cm above the center of the sphere (in centimeters).
    pub reach_distance: f64,
    /// Distance graspQ between the centroid of the fingertips and the palm and the center of the sphere (in
    /// centimeters).
    pub grasp_distance: f64,
    /// Number of phalanges that touch the sphere. The palm is not counted.
    pub contacts: u32,
    /// Mean openness fOpen of the 15 flexion joints. It is 0 for a closed hand and 1 for extended fingers.
    pub openness: f64,
    /// Cosine pRot of the angle between the direction of the palm and the vertical. It is 1 if the palm points down
    /// and -1 if it points up.
    pub palm_down: f64,
    /// True if the sphere touches the table.
    pub on_table: bool,
    /// Height of the sphere's center above the table top (in centimeters).
    pub height: f64,
    /// Position of the palm's center in the world (in meters). Only distances enter the reward.
    pub palm: [f64; 3],
    /// Centroid of the fingertips and the center of the palm in the world (in meters).
    pub grasp_centre: [f64; 3],
}

impl Observation {
    /// Returns true if at least one phalanx touches the sphere.
    pub fn on_fingers(&self) -> bool {
        self.contacts > 0
    }

    /// Returns oLifted. This is true if the sphere touches the fingers but not the table.
    pub fn lifted(&self) -> bool {
        self.on_fingers() && !self.on_table
    }

    /// Returns r = 1 - exp(-0.1 ds). This is 0 at the target of the reach phase and approaches 1 far away from it.
    pub fn r(&self) -> f64 {
        1.0 - exp(-0.1 * self.reach_distance)
    }

    /// Returns g = exp(-0.2 graspQ). This is 1 if the sphere is in the middle of the hand and approaches 0 far away
    /// from it.
    pub fn g(&self) -> f64 {
        exp(-0.2 * self.grasp_distance)
    }

    /// Returns l = 1 - exp(-0.3 contacts). This is 0 without contacts and approaches 1 if many phalanges touch the
    /// sphere.
    pub fn l(&self) -> f64 {
        1.0 - exp(-0.3 * f64::from(self.contacts))
    }

    /// Returns true if all values are finite.
    pub fn is_finite(&self) -> bool {
        [self.reach_distance, self.grasp_distance, self.openness, self.palm_down, self.height]
            .iter()
            .all(|x| x.is_finite())
    }
}

impl Phase {
    /// All phases in the order in which they occur.
    pub const ALL: [Self; 3] = [Self::Reach, Self::Grasp, Self::Lift];

    /// Returns the phase after a step with the given observation \[Ferrauto2010, 2.3.4\].
    ///
    /// Reach changes to grasp unless r > g or g < 0.5. Grasp changes to lift if g > 0.7 and l > 0.6. Deviations: the
    /// source defines the three conditions as a classification. Here a step can change the phase only once.
    #[must_use]
    pub fn next(self, seen: &Observation) -> Self {
        let is_over = match self {
            Self::Reach => {
                // g >= 0.5 means graspQ <= 5 ln 2 = 3.5 cm. The negation lets NaN pass, but the episode ends on NaN.
                let g = seen.g();
                !(g < 0.5 || seen.r() > g)
            }
            // g > 0.7 means graspQ < 1.8 cm, and l > 0.6 means at least four phalanges.
            Self::Grasp => seen.g() > 0.7 && seen.l() > 0.6,
            Self::Lift => false,
        };
        if is_over { self.following() } else { self }
    }

    /// The phase after this one, and the first after the last.
    pub(crate) fn following(self) -> Self {
        match self {
            Self::Reach => Self::Grasp,
            Self::Grasp => Self::Lift,
            Self::Lift => Self::Reach,
        }
    }

    /// Returns the index of the phase in [`Phase::ALL`].
    pub fn index(self) -> usize {
        self as usize
    }

    /// Returns the name of the phase.
    pub fn name(self) -> &'static str {
        match self {
            Self::Reach => "reach",
            Self::Grasp => "grasp",
            Self::Lift => "lift",
        }
    }

    /// Returns the bonus for a trial that ends in this phase. It is added to the rewards of its steps \[Ferrauto2010,
    /// 2.3.4\].
    pub fn bonus(self) -> f64 {
        match self {
            Self::Reach => 0.0,
            Self::Grasp => 300.0,
            Self::Lift => 600.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(ds: f64, grasp: f64, contacts: u32) -> Observation {
        Observation { reach_distance: ds, grasp_distance: grasp, contacts, ..Observation::default() }
    }

    /// Values of the three qualities worked out by hand (to 12 digits, with bc).
    #[test]
    fn qualities_at_known_points() {
        let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} {b}");
        near(seen(0.0, 0.0, 0).r(), 0.0);
        near(seen(10.0, 0.0, 0).r(), 0.632_120_558_829);
        near(seen(0.0, 5.0, 0).g(), 0.367_879_441_171);
        near(seen(0.0, 2.0, 0).g(), 0.670_320_046_036);
        near(seen(0.0, 0.0, 3).l(), 0.593_430_340_259);
        near(seen(0.0, 0.0, 4).l(), 0.698_805_788_088);
    }

    #[test]
    fn reach_is_left_when_the_sphere_is_nearer_the_grasp_than_the_goal_of_reaching() {
        // g = 0.5 at 3.4657 cm.
        assert_eq!(Phase::Reach.next(&seen(0.0, 3.465, 0)), Phase::Grasp);
        assert_eq!(Phase::Reach.next(&seen(0.0, 3.466, 0)), Phase::Reach);
        // graspQ 2: g = 0.6703, and r > g from ds = 11.096 cm.
        assert_eq!(Phase::Reach.next(&seen(11.09, 2.0, 0)), Phase::Grasp);
        assert_eq!(Phase::Reach.next(&seen(11.10, 2.0, 0)), Phase::Reach);
    }

    #[test]
    fn grasp_is_left_with_four_contacts_close_to_the_middle() {
        // g = 0.7 at 1.78337 cm.
        assert_eq!(Phase::Grasp.next(&seen(50.0, 1.783, 4)), Phase::Lift);
        assert_eq!(Phase::Grasp.next(&seen(50.0, 1.784, 4)), Phase::Grasp);
        assert_eq!(Phase::Grasp.next(&seen(50.0, 0.0, 3)), Phase::Grasp);
    }

    #[test]
    fn one_transition_a_step_and_none_back() {
        let perfect = seen(0.0, 0.0, 15);
        let lost = seen(90.0, 90.0, 0);
        assert_eq!(Phase::Reach.next(&perfect), Phase::Grasp);
        assert_eq!(Phase::Reach.next(&perfect).next(&perfect), Phase::Lift);
        for phase in Phase::ALL {
            assert_eq!(phase.next(&lost), phase);
            assert_eq!(Phase::ALL[phase.index()], phase);
        }
    }

    #[test]
    fn what_is_no_number_is_noticed() {
        assert!(seen(1.0, 1.0, 0).is_finite());
        assert!(!seen(f64::NAN, 1.0, 0).is_finite());
        assert!(!Observation { height: f64::INFINITY, ..Observation::default() }.is_finite());
    }
}
