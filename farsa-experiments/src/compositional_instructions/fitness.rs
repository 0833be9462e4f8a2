//! What a trial earns, and whether it succeeds.

use core::f64::consts::PI;

use farsa_num::atan2;

use crate::compositional_instructions::config::Judging;
use crate::compositional_instructions::instruction::{Action, Color, Instruction};

/// What is to be seen of the agent and its objects after a step.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Observation {
    /// Which colours each sector of the camera shows, the leftmost sector first.
    pub seen: [[bool; 3]; 3],
    /// Which objects the second segment is on, by colour.
    pub touched: [bool; 3],
    /// How far each object is from where the trial found it \[m\].
    pub displaced: [f64; 3],
    /// How far the tip of the second segment is from each object's surface \[m\].
    pub tip: [f64; 3],
    /// Where each object is from the camera, which looks along the first axis: ahead and to the left \[m\].
    pub ahead: [[f64; 2]; 3],
}

impl Observation {
    /// Whether any sector shows the colour.
    pub fn in_view(&self, color: Color) -> bool {
        self.seen.iter().any(|sector| sector[color.index()])
    }

    /// Whether the middle sector shows the colour.
    pub fn centred(&self, color: Color) -> bool {
        self.seen[1][color.index()]
    }

    /// Whether the second segment is on an object.
    pub fn touches(&self) -> bool {
        self.touched.contains(&true)
    }
}

/// The parts of a trial's fitness, each 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Parts {
    /// Whether the object was found, f.
    pub find: f64,
    /// Whether with it was done what was told, a.
    pub act: f64,
    /// Whether the others stayed where they were, u.
    pub undisturbed: f64,
    /// All of it, F.
    pub fitness: f64,
}

/// The ledger of a trial: what its last seconds were like.
///
/// With shares of the last seconds, `d_t` and `d_o` the displacements of the target and of the other object that moved most,
/// `near(d)` = 1 - clamp((d - still) / span, 0, 1), beside(d) the same with a span of its own, and r how far the arm ever reached
/// while the target was centred: 1 if the second segment was on it, else 1 - clamp(distance of its tip / reach, 0, 1), which counts
/// q; s(x) is the share of the last seconds in which the target was the object that had been in view last, and x held; a look past
/// the target counts p:
///
/// | | f | a | F |
/// |---|---|---|---|
/// | INDICATE | 0.5 (1 - angle / pi) + 0.5 centred | (centred and nothing touched) near(`d_t`) | near(`d_o`) (0.5 f + 0.5 f a) |
/// | TOUCH | the same | (q r + (1 - q) (on the target)) beside(`d_t`) | the same |
/// | MOVE | the same | q r + (1 - q) clamp(`d_t` / far, 0, 1) | the same |
/// | IGNORE | 0.5 (1 - angle / pi) + 0.5 s | (s(not in view) + p s(in view, not centred)) near(`d_t`), touching nothing | the same |
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Ledger {
    /// Steps of the last seconds so far.
    steps: u32,
    /// In how many of them each held.
    centred: u32,
    centred_alone: u32,
    remembered: u32,
    ignored: u32,
    aside: u32,
    on_target: u32,
    /// Which colours were in view when any was, last.
    last_seen: [bool; 3],
    /// How far the tip was from the target's surface, 0 if the second segment was on it, at best while the target was centred \[m\].
    nearest: Option<f64>,
    /// The step that passed last.
    last: Observation,
}

impl Ledger {
    /// Takes a step of a trial under an instruction, `late` if it is one of the last seconds.
    pub fn add(&mut self, instruction: Instruction, now: Observation, late: bool) {
        let seen = Color::ALL.map(|color| now.in_view(color));
        if seen.contains(&true) {
            self.last_seen = seen;
        }
        self.last = now;
        let target = instruction.color;
        if now.centred(target) {
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

    /// The step that passed last.
    pub fn last(&self) -> &Observation {
        &self.last
    }

    /// Displacement of the target, and of the other object that moved most \[m\].
    pub fn displaced(&self, target: Color) -> [f64; 2] {
        let others = Color::ALL.into_iter().filter(|color| *color != target);
        let farthest = others.map(|color| self.last.displaced[color.index()]).fold(0.0, f64::max);
        [self.last.displaced[target.index()], farthest]
    }

    fn share(&self, steps: u32) -> f64 {
        f64::from(steps) / f64::from(self.steps.max(1))
    }

    /// What the trial earns if it ends now.
    pub fn parts(&self, instruction: Instruction, judging: &Judging) -> Parts {
        let target = instruction.color;
        let [displaced, other] = self.displaced(target);
        let within = |span: f64, distance: f64| 1.0 - ((distance - judging.still) / span).clamp(0.0, 1.0);
        let near = |distance: f64| within(judging.span, distance);
        let [ahead, left] = self.last.ahead[target.index()];
        let angle = atan2(left, ahead).abs();
        let found = 0.5 * (1.0 - angle / PI) + 0.5 * self.share(self.centred);
        let undisturbed = near(other);
        let reached = self.nearest.map_or(0.0, |nearest| 1.0 - (nearest / judging.reach).clamp(0.0, 1.0));
        let with_reach = |rest: f64| judging.reach_share * reached + (1.0 - judging.reach_share) * rest;
        let (find, act) = match instruction.action {
            Action::Indicate => (found, self.share(self.centred_alone) * near(displaced)),
            Action::Touch => {
                let beside = within(judging.span_touched, displaced);
                (found, with_reach(self.share(self.on_target)) * beside)
            }
            Action::Move => (found, with_reach((displaced / judging.far).clamp(0.0, 1.0))),
            Action::Ignore => {
                let find = 0.5 * (1.0 - angle / PI) + 0.5 * self.share(self.remembered);
                // A part for a look past it: without, nothing leads from the middle of the view out of it.
                let looked_away = self.share(self.ignored) + judging.aside_share * self.share(self.aside);
                (find, looked_away * near(displaced))
            }
        };
        let fitness = undisturbed * (0.5 * find + 0.5 * find * act);
        Parts { find, act, undisturbed, fitness }
    }

    /// Whether the trial succeeds if it ends now.
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

    fn told(text: &str) -> Instruction {
        text.parse().unwrap()
    }

    /// Red straight ahead in the middle sector, nothing touched, nothing moved.
    fn centred() -> Observation {
        let ahead = [[1.3, 0.0], [0.7, 1.1], [0.7, -1.1]];
        let mut now = Observation { ahead, tip: [0.35, 0.9, 0.9], ..Observation::default() };
        now.seen[1][0] = true;
        now
    }

    /// A trial of 50 late steps of which so many are the one, the others the other.
    fn ledger(instruction: Instruction, steps: [(u32, Observation); 2]) -> Ledger {
        let mut ledger = Ledger::default();
        // What was before the last seconds counts for nothing but for what was seen last.
        (0..200).for_each(|_| ledger.add(instruction, Observation::default(), false));
        for (count, now) in steps {
            (0..count).for_each(|_| ledger.add(instruction, now, true));
        }
        ledger
    }

    fn close(parts: Parts, [find, act, undisturbed, fitness]: [f64; 4]) {
        let found = [parts.find, parts.act, parts.undisturbed, parts.fitness];
        let expected = [find, act, undisturbed, fitness];
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?} where {expected:?} is due");
    }

    #[test]
    fn indicate_by_hand() {
        let red = told("INDICATE red");
        let full = ledger(red, [(50, centred()), (0, centred())]);
        close(full.parts(red, &JUDGING), [1.0, 1.0, 1.0, 1.0]);
        assert!(full.succeeds(red, &JUDGING));
        // Ten of fifty steps touching, target 6 cm away from where it was, at a right angle at the end: f = 0.5 * 0.5 + 0.5 * 0.8,
        // a = 0.8 * (1 - 4 / 8).
        let mut aside = centred();
        (aside.touched[2], aside.displaced[0], aside.ahead[0], aside.seen[1][0]) = (true, 0.06, [0.0, 1.3], false);
        let some = ledger(red, [(40, centred()), (10, aside)]);
        close(some.parts(red, &JUDGING), [0.65, 0.4, 1.0, 0.5 * 0.65 + 0.5 * 0.65 * 0.4]);
        assert!(!some.succeeds(red, &JUDGING));
        // Another object 4 cm away: u = 1 - 2 / 8.
        let mut disturbed = centred();
        disturbed.displaced[1] = 0.04;
        let with = ledger(red, [(50, disturbed), (0, disturbed)]);
        close(with.parts(red, &JUDGING), [1.0, 1.0, 0.75, 0.75]);
        assert!(with.succeeds(red, &JUDGING));
        disturbed.displaced[1] = 0.051;
        assert!(!ledger(red, [(50, disturbed), (0, disturbed)]).succeeds(red, &JUDGING));
    }

    #[test]
    fn touch_and_move_by_hand() {
        let red = told("TOUCH red");
        let mut on = centred();
        on.touched[0] = true;
        let most = ledger(red, [(10, centred()), (40, on)]);
        // a = 0.5 + 0.5 * 0.8: it was reached.
        close(most.parts(red, &JUDGING), [1.0, 0.9, 1.0, 0.95]);
        // Not reached, the tip 35 of 100 cm away: a = 0.5 * 0.65.
        close(ledger(red, [(50, centred()), (0, on)]).parts(red, &JUDGING), [1.0, 0.325, 1.0, 0.6625]);
        assert!(most.succeeds(red, &JUDGING));
        assert!(!ledger(red, [(11, centred()), (39, on)]).succeeds(red, &JUDGING));
        // Pushed by 9.5 cm: 1 - 7.5 / 15 of it.
        on.displaced[0] = 0.095;
        close(ledger(red, [(50, on), (0, on)]).parts(red, &JUDGING), [1.0, 0.5, 1.0, 0.75]);
        assert!(!ledger(red, [(50, on), (0, on)]).succeeds(red, &JUDGING));
        // Straight behind and never seen, half as far away as it should be.
        let moved = told("MOVE blue");
        let mut now = centred();
        (now.displaced[2], now.ahead[2]) = (0.175, [-1.0, 0.0]);
        // Pushed without a look at it, so reaching counts for nothing.
        close(ledger(moved, [(50, now), (0, now)]).parts(moved, &JUDGING), [0.0, 0.25, 1.0, 0.0]);
        (now.displaced[2], now.ahead[2], now.touched[2]) = (0.5, [1.0, 0.0], true);
        close(ledger(moved, [(50, now), (0, now)]).parts(moved, &JUDGING), [0.5, 0.5, 1.0, 0.375]);
        // Centred when it was touched, and out of view then.
        let mut pushed = now;
        pushed.seen[1][2] = true;
        let far = ledger(moved, [(10, pushed), (40, now)]);
        close(far.parts(moved, &JUDGING), [0.6, 1.0, 1.0, 0.6]);
        assert!(far.succeeds(moved, &JUDGING));
        now.displaced[2] = 0.299;
        assert!(!ledger(moved, [(50, now), (0, now)]).succeeds(moved, &JUDGING));
    }

    #[test]
    fn ignore_by_hand() {
        let red = told("IGNORE red");
        let nothing = Observation { seen: [[false; 3]; 3], ..centred() };
        // Never seen: f = 0.5 as it is straight ahead, and nothing for looking at nothing.
        let unseen = ledger(red, [(50, nothing), (0, nothing)]);
        close(unseen.parts(red, &JUDGING), [0.5, 0.0, 1.0, 0.25]);
        assert!(!unseen.succeeds(red, &JUDGING));
        // Looked at all the time.
        close(ledger(red, [(50, centred()), (0, nothing)]).parts(red, &JUDGING), [1.0, 0.0, 1.0, 0.5]);
        let turned = ledger(red, [(5, centred()), (45, nothing)]);
        close(turned.parts(red, &JUDGING), [1.0, 0.9, 1.0, 0.5 + 0.5 * 0.9]);
        assert!(turned.succeeds(red, &JUDGING));
        assert!(!ledger(red, [(6, centred()), (44, nothing)]).succeeds(red, &JUDGING));
        // Red at the edge of the view for 20 of the 50 steps, in its middle for the others: a = 0.5 * 0.4.
        let mut past = centred();
        (past.seen[1][0], past.seen[2][0]) = (false, true);
        let looked_past = ledger(red, [(30, centred()), (20, past)]);
        close(looked_past.parts(red, &JUDGING), [1.0, 0.2, 1.0, 0.6]);
        assert!(!ledger(red, [(0, centred()), (50, past)]).succeeds(red, &JUDGING));
        // Turned away by a right angle: f = 0.5 * 0.5 + 0.5.
        let aside = Observation { ahead: [[0.0, 1.3]; 3], ..nothing };
        let away = ledger(red, [(5, centred()), (45, aside)]);
        close(away.parts(red, &JUDGING), [0.75, 0.9, 1.0, 0.75 * (0.5 + 0.5 * 0.9)]);
        assert!(away.succeeds(red, &JUDGING));
        // Another one is seen last, from the sixth of the last steps on.
        let mut other = nothing;
        other.seen[0][1] = true;
        let looked = ledger(red, [(5, centred()), (45, other)]);
        close(looked.parts(red, &JUDGING), [0.55, 0.0, 1.0, 0.275]);
        assert!(!looked.succeeds(red, &JUDGING));
        // Another one is looked at until the end is near: to come back at the end earns what is left.
        let late = ledger(red, [(45, other), (5, centred())]);
        close(late.parts(red, &JUDGING), [0.55, 0.0, 1.0, 0.275]);
        // Out of view for all of the last seconds but two steps, and the last one seen for those only.
        let mut late = ledger(red, [(40, other), (2, centred())]);
        (0..8).for_each(|_| late.add(red, nothing, true));
        close(late.parts(red, &JUDGING), [0.6, 0.16, 1.0, 0.3 + 0.3 * 0.16]);
        assert!(!late.succeeds(red, &JUDGING));
    }

    fn any_observation() -> impl Strategy<Value = Observation> {
        // One colour at most in view, and one object at most touched, as the places of the objects have it.
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
            let ledgers: Vec<(Instruction, Ledger)> = Instruction::all()
                .map(|instruction| {
                    let mut ledger = Ledger::default();
                    for (now, steps, late) in &course {
                        (0..*steps).for_each(|_| ledger.add(instruction, *now, *late));
                    }
                    (instruction, ledger)
                })
                .collect();
            for (instruction, ledger) in &ledgers {
                let Parts { find, act, undisturbed, fitness } = ledger.parts(*instruction, &JUDGING);
                for part in [find, act, undisturbed, fitness] {
                    prop_assert!((0.0..=1.0).contains(&part));
                }
            }
            // The same behaviour is a success of at most one action with an object, and of at most one object with an action:
            // who does not hear one of the words follows a third of the instructions.
            let succeeds = |one: &&(Instruction, Ledger)| one.1.succeeds(one.0, &JUDGING);
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
