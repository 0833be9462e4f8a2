//! Computation of the reward of a trial, and the criterion for success.

use core::f64::consts::PI;

use farsa_num::atan2;

use crate::compositional_instructions::config::Judging;
use crate::compositional_instructions::instruction::{Action, Color, Instruction};

/// A snapshot of the scene after a step, from which the reward is computed.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Observation {
    /// Colors that are visible in each sector of the camera. The leftmost sector comes first.
    pub seen: [[bool; 3]; 3],
    /// True for each object touched by the second segment, in the order of the colors.
    pub touched: [bool; 3],
    /// Distance between each object and its initial place (in meters).
    pub displaced: [f64; 3],
    /// Distance between the tip of the second segment and the surface of each object (in meters).
    pub tip: [f64; 3],
    /// Position of each object in the frame of the camera, as the coordinates ahead and to the left (in meters).
    pub ahead: [[f64; 2]; 3],
}

impl Observation {
    /// Returns true if the color is visible in any sector.
    pub fn in_view(&self, color: Color) -> bool {
        self.seen.iter().any(|sector| sector[color.index()])
    }

    /// Returns true if the color is visible in the middle sector.
    pub fn centred(&self, color: Color) -> bool {
        self.seen[1][color.index()]
    }

    /// Returns true if the second segment touches any of the objects.
    pub fn touches(&self) -> bool {
        self.touched.contains(&true)
    }
}

/// The components of the fitness of a trial. Each of them is between 0 and 1.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Parts {
    /// Reward f for turning toward the object.
    pub find: f64,
    /// Reward a for performing the action.
    pub act: f64,
    /// Reward u for leaving the other objects in place.
    pub undisturbed: f64,
    /// Fitness F that results from the three parts.
    pub fitness: f64,
}

/// The totals collected during the final period of a trial.
///
/// All shares refer to this period. `d_t` and `d_o` are the displacements of the target and of the other object that
/// moved most. The function `near(d)` is defined as `1 - clamp((d - still) / span, 0, 1)`, and `aside(d)` uses
/// [`Judging::span_touched`] instead. The variable r denotes the best reach of the tip while the target was centered.
/// It is 1 if the second segment touched the target and `1 - clamp(distance of its tip / reach, 0, 1)` otherwise. Its
/// weight is q. The function s(x) is the share of steps in which x was true and the target was the last object in view.
/// A look past the target has the weight p:
///
/// | | f | a | F |
/// |---|---|---|---|
/// | INDICATE | 0.5 (1 - angle / pi) + 0.5 centred | (centred and nothing touched) near(`d_t`) | near(`d_o`) (0.5 f + 0.5 f a) |
/// | TOUCH | the same | (q r + (1 - q) (on the target)) aside(`d_t`) | the same |
/// | MOVE | the same | q r + (1 - q) clamp(`d_t` / far, 0, 1) | the same |
/// | IGNORE | 0.5 (1 - angle / pi) + 0.5 s | (s(not in view) + p s(in view, not centred)) near(`d_t`), touching nothing | the same |
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct RewardTotals {
    /// Steps of the last seconds so far.
    steps: u32,
    /// In how many of them each held.
    centred: u32,
    centred_alone: u32,
    remembered: u32,
    ignored: u32,
    aside: u32,
    on_target: u32,
    /// Colors in view when any was in view last.
    last_seen: [bool; 3],
    /// Least distance of the tip from the target's surface while the target was centered, 0 for a touch \[m\].
    nearest: Option<f64>,
    /// Observation of the most recent step.
    last: Observation,
}

impl RewardTotals {
    /// Adds a step of the trial. Set `late` to true if the step belongs to the final period.
    pub fn add(&mut self, instruction: Instruction, now: Observation, late: bool) {
        let seen = Color::ALL.map(|color| now.in_view(color));
        // A view without any object keeps the previous entry.
        if seen.contains(&true) {
            self.last_seen = seen;
        }
        self.last = now;
        let target = instruction.color;
        if now.centred(target) {
            // The arm may touch with its side while its tip is away. Both count as distance 0.
            let away = if now.touched[target.index()] { 0.0 } else { now.tip[target.index()] };
            self.nearest = Some(self.nearest.map_or(away, |nearest| nearest.min(away)));
        }
        if late {
            let count = |held: bool| u32::from(held);
            self.steps += 1;
            self.centred += count(now.centred(target));
            self.centred_alone += count(now.centred(target) && !now.touches());
            let remembered = self.last_seen[target.index()];
            self.remembered += count(remembered);
            let away = remembered && !now.centred(target) && !now.touches();
            self.ignored += count(away && !now.in_view(target));
            self.aside += count(away && now.in_view(target));
            self.on_target += count(now.touched[target.index()]);
        }
    }

    /// Gets the most recent observation.
    pub fn last(&self) -> &Observation {
        &self.last
    }

    /// Returns the displacement of the target, followed by the largest displacement of the other objects (in meters).
    pub fn displaced(&self, target: Color) -> [f64; 2] {
        let others = Color::ALL.into_iter().filter(|color| *color != target);
        let farthest = others.map(|color| self.last.displaced[color.index()]).fold(0.0, f64::max);
        [self.last.displaced[target.index()], farthest]
    }

    fn share(&self, steps: u32) -> f64 {
        f64::from(steps) / f64::from(self.steps.max(1))
    }

    /// Computes the reward under the assumption that the trial ends now.
    pub fn parts(&self, instruction: Instruction, judging: &Judging) -> Parts {
        let target = instruction.color;
        let [displaced, other] = self.displaced(target);
        // near(d) = 1 - clamp((d - still) / span, 0, 1).
        let within = |span: f64, distance: f64| 1.0 - ((distance - judging.still) / span).clamp(0.0, 1.0);
        let near = |distance: f64| within(judging.span, distance);
        let [ahead, left] = self.last.ahead[target.index()];
        // |bearing| / pi is in [0, 1], so half of the term pays for turning before the target is in view.
        let angle = atan2(left, ahead).abs();
        let centering = 0.5 * (1.0 - angle / PI) + 0.5 * self.share(self.centred);
        let undisturbed = near(other);
        let reached = self.nearest.map_or(0.0, |nearest| 1.0 - (nearest / judging.reach).clamp(0.0, 1.0));
        // q r + (1 - q) rest: reaching pays before the act succeeds.
        let with_reach = |rest: f64| judging.reach_share * reached + (1.0 - judging.reach_share) * rest;
        let (find, act) = match instruction.action {
            Action::Indicate => (centering, self.share(self.centred_alone) * near(displaced)),
            Action::Touch => {
                let undisplaced = within(judging.span_touched, displaced);
                (centering, with_reach(self.share(self.on_target)) * undisplaced)
            }
            Action::Move => (centering, with_reach((displaced / judging.far).clamp(0.0, 1.0))),
            Action::Ignore => {
                let find = 0.5 * (1.0 - angle / PI) + 0.5 * self.share(self.remembered);
                // A part for a look past it: without, nothing leads from the middle of the view out of it.
                let looked_away = self.share(self.ignored) + judging.aside_share * self.share(self.aside);
                (find, looked_away * near(displaced))
            }
        };
        // F = u (f / 2 + f a / 2): the act counts only for a found object.
        let fitness = undisturbed * (0.5 * find + 0.5 * find * act);
        Parts { find, act, undisturbed, fitness }
    }

    /// Returns true if the trial would count as a success if it ended now.
    pub fn succeeds(&self, instruction: Instruction, judging: &Judging) -> bool {
        let target = instruction.color;
        let [displaced, other] = self.displaced(target);
        let [least_still, least_touching] = judging.least_shares;
        let done = match instruction.action {
            Action::Indicate => self.share(self.centred_alone) >= least_still && displaced <= judging.most_still,
            Action::Touch => self.share(self.on_target) >= least_touching && displaced <= judging.most_touched,
            Action::Move => displaced >= judging.least_moved,
            Action::Ignore => self.share(self.ignored) >= least_still && displaced <= judging.most_still,
        };
        done && other <= judging.most_other
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compositional_instructions::config::Config;
    use crate::compositional_instructions::instruction::Condition;
    use proptest::prelude::*;

    const JUDGING: Judging = Config::for_condition(Condition::WithIndicate).judging;

    fn parsed(text: &str) -> Instruction {
        text.parse().unwrap()
    }

    /// Red straight ahead in the middle sector, nothing touched, nothing moved.
    fn centred() -> Observation {
        let ahead = [[1.3, 0.0], [0.7, 1.1], [0.7, -1.1]];
        let mut now = Observation { ahead, tip: [0.35, 0.9, 0.9], ..Observation::default() };
        now.seen[1][0] = true;
        now
    }

    /// A trial of 50 late steps, with the given numbers of steps of each observation.
    fn totals(instruction: Instruction, steps: [(u32, Observation); 2]) -> RewardTotals {
        let mut totals = RewardTotals::default();
        // Steps before the last seconds count only for the object last in view.
        (0..200).for_each(|_| totals.add(instruction, Observation::default(), false));
        for (count, now) in steps {
            (0..count).for_each(|_| totals.add(instruction, now, true));
        }
        totals
    }

    fn close(parts: Parts, [find, act, undisturbed, fitness]: [f64; 4]) {
        let found = [parts.find, parts.act, parts.undisturbed, parts.fitness];
        let expected = [find, act, undisturbed, fitness];
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?} where {expected:?} is due");
    }

    #[test]
    fn indicate_by_hand() {
        let red = parsed("INDICATE red");
        let full = totals(red, [(50, centred()), (0, centred())]);
        close(full.parts(red, &JUDGING), [1.0, 1.0, 1.0, 1.0]);
        assert!(full.succeeds(red, &JUDGING));
        // Ten of fifty steps touch, and the target is 6 cm away from its place, at a right angle at the end. The terms are `f = 0.5
        // * 0.5 + 0.5 * 0.8` and `a = 0.8 * (1 - 4 / 8)`.
        let mut aside = centred();
        (aside.touched[2], aside.displaced[0], aside.ahead[0], aside.seen[1][0]) = (true, 0.06, [0.0, 1.3], false);
        let some = totals(red, [(40, centred()), (10, aside)]);
        close(some.parts(red, &JUDGING), [0.65, 0.4, 1.0, 0.5 * 0.65 + 0.5 * 0.65 * 0.4]);
        assert!(!some.succeeds(red, &JUDGING));
        // Another object 4 cm away: u = 1 - 2 / 8.
        let mut disturbed = centred();
        disturbed.displaced[1] = 0.04;
        let with = totals(red, [(50, disturbed), (0, disturbed)]);
        close(with.parts(red, &JUDGING), [1.0, 1.0, 0.75, 0.75]);
        assert!(with.succeeds(red, &JUDGING));
        disturbed.displaced[1] = 0.051;
        assert!(!totals(red, [(50, disturbed), (0, disturbed)]).succeeds(red, &JUDGING));
    }

    #[test]
    fn touch_and_move_by_hand() {
        let red = parsed("TOUCH red");
        let mut on = centred();
        on.touched[0] = true;
        let most = totals(red, [(10, centred()), (40, on)]);
        // a = 0.5 + 0.5 * 0.8: it was reached.
        close(most.parts(red, &JUDGING), [1.0, 0.9, 1.0, 0.95]);
        // Not reached, the tip 35 of 100 cm away: a = 0.5 * 0.65.
        close(totals(red, [(50, centred()), (0, on)]).parts(red, &JUDGING), [1.0, 0.325, 1.0, 0.6625]);
        assert!(most.succeeds(red, &JUDGING));
        assert!(!totals(red, [(11, centred()), (39, on)]).succeeds(red, &JUDGING));
        // Pushed by 9.5 cm: 1 - 7.5 / 15 of it.
        on.displaced[0] = 0.095;
        close(totals(red, [(50, on), (0, on)]).parts(red, &JUDGING), [1.0, 0.5, 1.0, 0.75]);
        assert!(!totals(red, [(50, on), (0, on)]).succeeds(red, &JUDGING));
        // Straight behind and never seen, half as far away as it should be.
        let moved = parsed("MOVE blue");
        let mut now = centred();
        (now.displaced[2], now.ahead[2]) = (0.175, [-1.0, 0.0]);
        // Pushed without a look at it, so reaching counts for nothing.
        close(totals(moved, [(50, now), (0, now)]).parts(moved, &JUDGING), [0.0, 0.25, 1.0, 0.0]);
        (now.displaced[2], now.ahead[2], now.touched[2]) = (0.5, [1.0, 0.0], true);
        close(totals(moved, [(50, now), (0, now)]).parts(moved, &JUDGING), [0.5, 0.5, 1.0, 0.375]);
        // Centred when it was touched, and out of view then.
        let mut pushed = now;
        pushed.seen[1][2] = true;
        let far = totals(moved, [(10, pushed), (40, now)]);
        close(far.parts(moved, &JUDGING), [0.6, 1.0, 1.0, 0.6]);
        assert!(far.succeeds(moved, &JUDGING));
        now.displaced[2] = 0.299;
        assert!(!totals(moved, [(50, now), (0, now)]).succeeds(moved, &JUDGING));
    }

    #[test]
    fn ignore_by_hand() {
        let red = parsed("IGNORE red");
        let nothing = Observation { seen: [[false; 3]; 3], ..centred() };
        // Never seen: f = 0.5 as it is straight ahead, and nothing for looking at nothing.
        let unseen = totals(red, [(50, nothing), (0, nothing)]);
        close(unseen.parts(red, &JUDGING), [0.5, 0.0, 1.0, 0.25]);
        assert!(!unseen.succeeds(red, &JUDGING));
        // Looked at all the time.
        close(totals(red, [(50, centred()), (0, nothing)]).parts(red, &JUDGING), [1.0, 0.0, 1.0, 0.5]);
        let turned = totals(red, [(5, centred()), (45, nothing)]);
        close(turned.parts(red, &JUDGING), [1.0, 0.9, 1.0, 0.5 + 0.5 * 0.9]);
        assert!(turned.succeeds(red, &JUDGING));
        assert!(!totals(red, [(6, centred()), (44, nothing)]).succeeds(red, &JUDGING));
        // Red at the edge of the view for 20 of the 50 steps, in its middle for the others: a = 0.5 * 0.4.
        let mut past = centred();
        (past.seen[1][0], past.seen[2][0]) = (false, true);
        let looked_past = totals(red, [(30, centred()), (20, past)]);
        close(looked_past.parts(red, &JUDGING), [1.0, 0.2, 1.0, 0.6]);
        assert!(!totals(red, [(0, centred()), (50, past)]).succeeds(red, &JUDGING));
        // Turned away by a right angle: f = 0.5 * 0.5 + 0.5.
        let aside = Observation { ahead: [[0.0, 1.3]; 3], ..nothing };
        let away = totals(red, [(5, centred()), (45, aside)]);
        close(away.parts(red, &JUDGING), [0.75, 0.9, 1.0, 0.75 * (0.5 + 0.5 * 0.9)]);
        assert!(away.succeeds(red, &JUDGING));
        // Another one is seen last, from the sixth of the last steps on.
        let mut other = nothing;
        other.seen[0][1] = true;
        let looked = totals(red, [(5, centred()), (45, other)]);
        close(looked.parts(red, &JUDGING), [0.55, 0.0, 1.0, 0.275]);
        assert!(!looked.succeeds(red, &JUDGING));
        // Another one is looked at until the end is near: to come back at the end earns what is left.
        let late = totals(red, [(45, other), (5, centred())]);
        close(late.parts(red, &JUDGING), [0.55, 0.0, 1.0, 0.275]);
        // Out of view for all of the last seconds but two steps, and the last one seen for those only.
        let mut late = totals(red, [(40, other), (2, centred())]);
        (0..8).for_each(|_| late.add(red, nothing, true));
        close(late.parts(red, &JUDGING), [0.6, 0.16, 1.0, 0.3 + 0.3 * 0.16]);
        assert!(!late.succeeds(red, &JUDGING));
    }

    fn any_observation() -> impl Strategy<Value = Observation> {
        // At most one color in view and one object touched, as the places of the objects allow.
        let one = || prop::option::of((0..3usize, 0..3usize));
        let place = || prop::array::uniform2(-2.0..2.0);
        let lengths = || prop::array::uniform3(0.0..0.6);
        (one(), prop::option::of(0..3usize), lengths(), prop::array::uniform3(place()), lengths()).prop_map(
            |(seen, touched, displaced, ahead, tip)| {
                let mut now = Observation { displaced, tip, ahead, ..Observation::default() };
                if let Some((sector, color)) = seen {
                    now.seen[sector][color] = true;
                }
                if let Some(object) = touched {
                    now.touched[object] = true;
                }
                now
            },
        )
    }

    proptest! {
        #[test]
        fn no_part_exceeds_its_maximum_and_one_behaviour_follows_one_instruction_of_a_word(
            course in prop::collection::vec((any_observation(), 1..60u32, any::<bool>()), 1..6)
        ) {
            let ledgers: Vec<(Instruction, RewardTotals)> = Instruction::all()
                .map(|instruction| {
                    let mut totals = RewardTotals::default();
                    for (now, steps, late) in &course {
                        (0..*steps).for_each(|_| totals.add(instruction, *now, *late));
                    }
                    (instruction, totals)
                })
                .collect();
            for (instruction, totals) in &ledgers {
                let Parts { find, act, undisturbed, fitness } = totals.parts(*instruction, &JUDGING);
                for part in [find, act, undisturbed, fitness] {
                    prop_assert!((0.0..=1.0).contains(&part));
                }
            }
            // A behavior succeeds for at most one action per object, and for at most one object per action. An agent without one of
            // the words therefore follows a third of the instructions.
            let succeeds = |one: &&(Instruction, RewardTotals)| one.1.succeeds(one.0, &JUDGING);
            for condition in [Condition::WithIndicate, Condition::WithIgnore] {
                for color in Color::ALL {
                    let of_color = ledgers.iter().filter(|one| {
                        one.0.color == color && condition.actions().contains(&one.0.action)
                    });
                    prop_assert!(of_color.filter(succeeds).count() <= 1);
                }
            }
            for action in Action::ALL {
                prop_assert!(ledgers.iter().filter(|one| one.0.action == action).filter(succeeds).count() <= 1);
            }
        }
    }
}
