//! The three phases of `reach-grasp-lift` and what is observed of a step to distinguish them.

use farsa_num::exp;
use serde::{Deserialize, Serialize};

/// A phase of a trial. A trial passes through them in this order and never back.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Phase {
    /// The hand approaches the sphere.
    #[default]
    Reach,
    /// The hand closes around the sphere.
    Grasp,
    /// The hand raises the sphere.
    Lift,
}

/// The reward's view of the world after one step.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Observation {
    /// ds: distance from the palm's center to the point 5 cm above the sphere's center \[cm\].
    pub reach_distance: f64,
    /// graspQ: distance from the centroid of fingertips and palm center to the sphere's center \[cm\].
    pub grasp_distance: f64,
    /// Number of phalanges that touch the sphere. The palm does not count.
    pub contacts: u32,
    /// fOpen: mean openness of the 15 flexion joints, 0 closed, 1 extended.
    pub openness: f64,
    /// pRot: cosine between the palm's direction and straight down, 1 for palm down, -1 for palm up.
    pub palm_down: f64,
    /// The sphere touches the table.
    pub on_table: bool,
    /// Height of the sphere's center above the table's top \[cm\].
    pub height: f64,
    /// The palm's center in the world \[m\]. The reward uses the distances only.
    pub palm: [f64; 3],
    /// The centroid of fingertips and palm center in the world \[m\].
    pub grasp_centre: [f64; 3],
}

impl Observation {
    /// True if a phalanx touches the sphere.
    pub fn on_fingers(&self) -> bool {
        self.contacts > 0
    }

    /// oLifted: the sphere touches the fingers and not the table.
    pub fn lifted(&self) -> bool {
        self.on_fingers() && !self.on_table
    }

    /// r = 1 - exp(-0.1 ds): 0 at the goal of reaching, towards 1 far from it.
    pub fn r(&self) -> f64 {
        1.0 - exp(-0.1 * self.reach_distance)
    }

    /// g = exp(-0.2 graspQ): 1 with the sphere in the middle of the hand, towards 0 far from it.
    pub fn g(&self) -> f64 {
        exp(-0.2 * self.grasp_distance)
    }

    /// l = 1 - exp(-0.3 contacts): 0 untouched, towards 1 with many phalanges on the sphere.
    pub fn l(&self) -> f64 {
        1.0 - exp(-0.3 * f64::from(self.contacts))
    }

    /// True if every number is finite.
    pub fn is_finite(&self) -> bool {
        [self.reach_distance, self.grasp_distance, self.openness, self.palm_down, self.height]
            .iter()
            .all(|x| x.is_finite())
    }
}

impl Phase {
    /// All phases in their order.
    pub const ALL: [Self; 3] = [Self::Reach, Self::Grasp, Self::Lift];

    /// The phase after a step that ended as `seen` \[Ferrauto2010, 2.3.4\].
    ///
    /// Reach changes to grasp when not (r > g or g < 0.5), grasp to lift when g > 0.7 and l > 0.6, and never back. Deviations: the
    /// source gives the three conditions as a classification. At most one transition a step is ours.
    #[must_use]
    pub fn next(self, seen: &Observation) -> Self {
        let g = seen.g();
        match self {
            Self::Reach if !(seen.r() > g || g < 0.5) => Self::Grasp,
            Self::Grasp if g > 0.7 && seen.l() > 0.6 => Self::Lift,
            stays => stays,
        }
    }

    /// The phase after this one, and the first after the last.
    pub(crate) fn following(self) -> Self {
        match self {
            Self::Reach => Self::Grasp,
            Self::Grasp => Self::Lift,
            Self::Lift => Self::Reach,
        }
    }

    /// The phase's position in [`Phase::ALL`].
    pub fn index(self) -> usize {
        self as usize
    }

    /// The phase's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Reach => "reach",
            Self::Grasp => "grasp",
            Self::Lift => "lift",
        }
    }

    /// The bonus of a trial that ends in this phase, on top of its steps \[Ferrauto2010, 2.3.4\].
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
