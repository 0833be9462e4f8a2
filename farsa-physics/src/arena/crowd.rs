//! A step of one planar world with many robots, found by a grid, or with robots that hold each other.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::sin_cos;

use crate::arena::description::CollisionRule;
use crate::arena::grid::Grid;
use crate::arena::model::{CONTACT, HELD, MET, Model, NOTHING, POSE_WORDS, VELOCITY};
use crate::arena::solid::{is_near, meets_solid, overlaps_solid};
use crate::arena::step::{LEFT, Met, SWEEPS, WORK_WORDS, add_push, keep_deepest, position_of, step_without_collisions};
use crate::arena::surface::{Meeting, meets_disc, meets_wall, ray_to_disc, wall_squared};

/// The working memory of a step of a crowd.
#[derive(Clone, Debug)]
pub(crate) struct Crowd {
    /// Present where the model requests it.
    pub(crate) grid: Option<Grid>,
    /// The first robot of those that hold together with each.
    group: Vec<u16>,
    /// True if any robot holds another.
    held: bool,
    back: Vec<bool>,
    /// True if those that hold together are set back, by the first of them.
    stopped: Vec<bool>,
    pushes: Vec<(u16, [f32; 2])>,
    /// Which robots are set back now, and which were in the last round.
    now: Vec<u16>,
    last: Vec<u16>,
}

fn at(words: &[f32], body: usize) -> [f32; 2] {
    position_of::<f32>((), words, body)
}

fn square(a: [f32; 2], b: [f32; 2]) -> f32 {
    let [x, y] = [a[0] - b[0], a[1] - b[1]];
    x * x + y * y
}

impl Crowd {
    pub(crate) fn new(model: &Model, size: Option<[f64; 2]>) -> Self {
        let robots = model.robots.len();
        Self {
            grid: model.grid.then(|| Grid::new(model, size)),
            group: (0..robots).map(|robot| robot as u16).collect(),
            held: false,
            back: vec![false; robots],
            stopped: vec![false; robots],
            pushes: Vec::with_capacity(robots),
            now: Vec::with_capacity(robots),
            last: Vec::with_capacity(robots),
        }
    }

    /// Finds all robots again.
    pub(crate) fn fill(&mut self, words: &[f32]) {
        if let Some(grid) = &mut self.grid {
            grid.fill(words);
        }
    }

    #[inline(always)]
    pub(crate) fn visit(&self, model: &Model, low: [f32; 2], high: [f32; 2], tell: impl FnMut(usize)) {
        match &self.grid {
            Some(grid) => grid.visit(low, high, tell),
            None => (0..model.round_bodies()).for_each(tell),
        }
    }

    /// Robots and cylinders that may touch a disc, itself included.
    #[inline]
    fn around(&self, model: &Model, [x, y]: [f32; 2], radius: f32, tell: impl FnMut(usize)) {
        // A little more than needed: rounding must not leave out one that touches.
        let reach = 1.01 * (radius + model.largest);
        self.visit(model, [x - reach, y - reach], [x + reach, y + reach], tell);
    }

    /// Returns the overlaps of a robot, and on request their sum of pushes in the order of bodies.
    #[inline]
    fn find_overlap(
        &self,
        model: &Model,
        words: &[f32],
        robot: usize,
        mut push: Option<&mut [f32; 2]>,
    ) -> Option<Met<f32>> {
        let center = at(words, robot);
        let radius = model.kind(robot).radius;
        let left = radius * LEFT;
        let mut met: Option<Met<f32>> = None;
        let mut take = |meeting: Meeting<f32>, body: f32, part: f32, push: &mut Option<&mut [f32; 2]>| {
            let first = Met { meeting: Meeting { depth: 0.0, out: [0.0; 2], point: [0.0; 2] }, body: NOTHING };
            let mut new = met.unwrap_or(first);
            keep_deepest(&mut new, true, meeting, body);
            met = Some(new);
            if let Some(push) = push {
                add_push(push, true, meeting, meeting.depth * part + left);
            }
        };
        for slab in &model.slabs {
            if wall_squared(slab, center) < radius * radius {
                take(meets_wall(slab, center, radius), NOTHING, 1.0, &mut push);
            }
        }
        for solid in &model.solids {
            if is_near(solid, center, radius) && overlaps_solid(solid, center, radius) {
                take(meets_solid(solid, center, radius), NOTHING, 1.0, &mut push);
            }
        }
        // A grid names bodies cell by cell. They are sorted, because sums of pushes have other bits in another order.
        let mut others = [0_u16; 16];
        let mut count = 0;
        let touched = |body: usize| {
            let sum = radius + model.radius(body);
            body != robot && square(center, at(words, body)) < sum * sum
        };
        self.around(model, center, radius, |body| {
            if touched(body) {
                if count < others.len() {
                    others[count] = body as u16;
                }
                count += 1;
            }
        });
        let mut visit = |body: usize| {
            let meeting = meets_disc(center, at(words, body), radius, model.radius(body));
            // Two robots give way by half each. Cylinders do not give way.
            take(meeting, body as f32, if body < model.robots.len() { 0.5 } else { 1.0 }, &mut push);
        };
        match others.get_mut(..count) {
            Some(others) => {
                others.sort_unstable();
                for body in others {
                    visit(usize::from(*body));
                }
            }
            // More than there is room for: all bodies are looked at, which are in order.
            None => (0..model.round_bodies()).filter(|body| touched(*body)).for_each(visit),
        }
        met
    }

    /// One control step. `words` and `work` as in [`step`](crate::arena::step::step).
    pub(crate) fn step(&mut self, model: &Model, words: &mut [f32], work: &mut [f32]) {
        self.hold(model, words);
        for robot in 0..model.robots.len() {
            step_without_collisions::<f32>((), model, words, work, robot);
        }
        if self.held {
            self.carry(model, words, work);
        }
        self.fill(words);
        if model.collisions == CollisionRule::Circles {
            self.push(model, words, work);
        }
        self.undo(model, words, work);
    }

    /// Lets devices take hold and let go, and finds which robots hold together.
    fn hold(&mut self, model: &Model, words: &mut [f32]) {
        self.held = false;
        if !model.attachments {
            return;
        }
        for robot in 0..model.robots.len() {
            let kind = model.kind(robot);
            let held = model.robot_word(robot, HELD);
            // Whatever was restored, only a robot is held, and only by a device.
            let Some(reach) = kind.robot.attachment else {
                words[held] = NOTHING;
                continue;
            };
            let wants = words[model.command(robot, kind.robot.actuators() - 1)] > 0.5;
            let holds = words[held] >= 0.0 && (words[held] as usize) < model.robots.len();
            if !wants {
                words[held] = NOTHING;
            } else if !holds {
                words[held] = self.ahead(model, words, robot, kind.radius + reach as f32);
            }
            self.held |= words[held] >= 0.0;
        }
        if !self.held {
            return;
        }
        for (robot, group) in self.group.iter_mut().enumerate() {
            *group = robot as u16;
        }
        // The smaller number of both groups for both, until nothing changes: groups are small.
        let mut changed = true;
        while changed {
            changed = false;
            for robot in 0..model.robots.len() {
                let held = words[model.robot_word(robot, HELD)];
                if held >= 0.0 {
                    let both = [robot, held as usize];
                    let first = self.group[both[0]].min(self.group[both[1]]);
                    for member in both {
                        changed |= self.group[member] != first;
                        self.group[member] = first;
                    }
                }
            }
        }
    }

    /// The robot whose hull is ahead within reach [m] of a robot's center, as a word.
    fn ahead(&self, model: &Model, words: &[f32], robot: usize, reach: f32) -> f32 {
        let center = at(words, robot);
        let way = [words[POSE_WORDS * robot + 3], words[POSE_WORDS * robot + 4]];
        let mut met: Option<(f32, usize)> = None;
        self.around(model, center, reach, |body| {
            let other = at(words, body);
            if body != robot
                && body < model.robots.len()
                && let Some(distance) =
                    ray_to_disc([center[0] - other[0], center[1] - other[1]], way, model.radius(body))
                && distance <= reach
                && met.is_none_or(|met| (distance, body) < met)
            {
                met = Some((distance, body));
            }
        });
        met.map_or(NOTHING, |(_, body)| body as f32)
    }

    /// Moves attached robots as one: the rigid motion that is nearest to the velocities of their wheels.
    ///
    /// Source: own (least squares of the velocities of the centers. Each chassis turns by its own wheels).
    fn carry(&mut self, model: &Model, words: &mut [f32], work: &[f32]) {
        let robots = model.robots.len();
        for first in 0..robots {
            let member = |robot: &usize| usize::from(self.group[*robot]) == first;
            let count = (first..robots).filter(member).count();
            if usize::from(self.group[first]) != first || count < 2 {
                continue;
            }
            let share = 1.0 / count as f32;
            let was = |robot: usize| [work[WORK_WORDS * robot], work[WORK_WORDS * robot + 1]];
            let velocity = |words: &[f32], robot: usize| {
                let word = model.robot_word(robot, VELOCITY);
                [words[word], words[word + 1]]
            };
            // Least squares of v_i = V + w x r_i, with r_i from the mean of the centers: V = mean of v_i, w = sum r_i x
            // v_i / sum r_i . r_i.
            let (mut centre, mut mean) = ([0.0_f32; 2], [0.0_f32; 2]);
            for robot in (first..robots).filter(member) {
                let (p, v) = (was(robot), velocity(words, robot));
                for k in 0..2 {
                    centre[k] += p[k] * share;
                    mean[k] += v[k] * share;
                }
            }
            let (mut moment, mut inertia) = (0.0, 0.0);
            for robot in (first..robots).filter(member) {
                let (p, v) = (was(robot), velocity(words, robot));
                let [x, y] = [p[0] - centre[0], p[1] - centre[1]];
                moment += x * v[1] - y * v[0];
                inertia += x * x + y * y;
            }
            let spin = if inertia > 0.0 { moment / inertia } else { 0.0 };
            // Turned by the whole angle w h, so that distances within the group stay as they are.
            let (sine, cosine) = sin_cos(spin * model.time_step);
            for robot in (first..robots).filter(member) {
                let p = was(robot);
                let [x, y] = [p[0] - centre[0], p[1] - centre[1]];
                let [x, y] = [x * cosine - y * sine, x * sine + y * cosine];
                let word = model.robot_word(robot, VELOCITY);
                words[word] = mean[0] - spin * y;
                words[word + 1] = mean[1] + spin * x;
                words[POSE_WORDS * robot] = centre[0] + mean[0] * model.time_step + x;
                words[POSE_WORDS * robot + 1] = centre[1] + mean[1] * model.time_step + y;
            }
        }
    }

    fn record_contact(model: &Model, words: &mut [f32], robot: usize, met: &Met<f32>) {
        let word = model.robot_word(robot, 0);
        if words[word + CONTACT] <= 0.0 {
            let Meeting { depth, out, point } = met.meeting;
            words[word + CONTACT..word + CONTACT + 5].copy_from_slice(&[depth, out[0], out[1], point[0], point[1]]);
            words[word + MET] = met.body;
        }
    }

    /// Returns whether a robot holds or is held.
    fn tied(&self, robot: usize) -> bool {
        let group = self.group[robot];
        self.held && self.group.iter().filter(|g| **g == group).count() > 1
    }

    fn push(&mut self, model: &Model, words: &mut [f32], work: &[f32]) {
        self.back.fill(false);
        for _ in 0..SWEEPS {
            // All pushes of a sweep are computed before any motion, so that the order of robots is irrelevant.
            let mut pushes = core::mem::take(&mut self.pushes);
            pushes.clear();
            for robot in 0..model.robots.len() {
                let mut push = [0.0; 2];
                if let Some(met) = self.find_overlap(model, words, robot, Some(&mut push)) {
                    Self::record_contact(model, words, robot, &met);
                    pushes.push((robot as u16, push));
                }
            }
            for (robot, push) in &pushes {
                let robot = usize::from(*robot);
                if !self.tied(robot) {
                    self.back[robot] = true;
                    (0..2).for_each(|k| words[POSE_WORDS * robot + k] += push[k]);
                }
            }
            let none = pushes.is_empty();
            self.pushes = pushes;
            if none {
                break;
            }
            self.fill(words);
        }
        for robot in (0..model.robots.len()).filter(|robot| self.back[*robot]) {
            for k in 0..2 {
                // A pushed robot has the velocity of its actual way.
                let way = words[POSE_WORDS * robot + k] - work[WORK_WORDS * robot + k];
                words[model.robot_word(robot, VELOCITY + k)] = way / model.time_step;
            }
        }
    }

    fn set_back(model: &Model, words: &mut [f32], work: &[f32], robot: usize) {
        let old = WORK_WORDS * robot..WORK_WORDS * robot + POSE_WORDS;
        words[POSE_WORDS * robot..POSE_WORDS * (robot + 1)].copy_from_slice(&work[old]);
        let word = model.robot_word(robot, VELOCITY);
        words[word..word + 3].fill(0.0);
    }

    fn undo(&mut self, model: &Model, words: &mut [f32], work: &[f32]) {
        let robots = model.robots.len();
        self.back.fill(false);
        self.now.clear();
        for robot in 0..robots {
            if let Some(met) = self.find_overlap(model, words, robot, None) {
                Self::record_contact(model, words, robot, &met);
                self.now.push(robot as u16);
            }
        }
        while !self.now.is_empty() {
            let mut now = core::mem::take(&mut self.now);
            for robot in &now {
                self.back[usize::from(*robot)] = true;
            }
            // A group goes back as a whole, as it moved as a whole.
            if self.held {
                self.stopped.fill(false);
                for robot in &now {
                    self.stopped[usize::from(self.group[usize::from(*robot)])] = true;
                }
                for robot in 0..robots {
                    if !self.back[robot] && self.stopped[usize::from(self.group[robot])] {
                        self.back[robot] = true;
                        now.push(robot as u16);
                    }
                }
            }
            for robot in &now {
                Self::set_back(model, words, work, usize::from(*robot));
            }
            // The grid allows for a robot's own step, and not for pushes or attachments.
            if self.held || model.collisions == CollisionRule::Circles {
                self.fill(words);
            }
            // A robot that did not overlap before can only overlap one that was set back just now.
            self.now = core::mem::take(&mut self.last);
            self.now.clear();
            let mut overlaps = core::mem::take(&mut self.now);
            for robot in &now {
                let robot = usize::from(*robot);
                let (center, radius) = (at(words, robot), model.kind(robot).radius);
                self.around(model, center, radius, |other| {
                    if other < robots && !self.back[other] {
                        let sum = radius + model.kind(other).radius;
                        if square(center, at(words, other)) < sum * sum {
                            overlaps.push(other as u16);
                        }
                    }
                });
            }
            overlaps.sort_unstable();
            overlaps.dedup();
            for robot in &overlaps {
                if let Some(met) = self.find_overlap(model, words, usize::from(*robot), None) {
                    Self::record_contact(model, words, usize::from(*robot), &met);
                }
            }
            self.last = now;
            self.now = overlaps;
        }
    }
}
