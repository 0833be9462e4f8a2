//! Tracks the alternating stance and swing of a walker's feet and detects the end of a walk.

use farsa_body::ports::{Arrange, Contacts, Handles, JointId, Joints};

use crate::walking::walker::{ASIDE, Posture, Walker, WalkerParts};

/// The reason why a walk ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The hip was too low, or a leg leaned too far.
    Fell,
    /// The stance foot slid over the ground.
    Slid,
    /// Both feet were off the ground for too long.
    Flew,
    /// The energy of the walker increased by more than gravity and the motor can explain.
    Gained,
    /// A value was not finite.
    Broken,
}

impl End {
    /// Returns the name used in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fell => "fell",
            Self::Slid => "slid",
            Self::Flew => "flew",
            Self::Gained => "gained energy",
            Self::Broken => "broken",
        }
    }
}

/// The rules that end a walk. Lengths are in units of the longer legs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rules {
    /// Smallest distance to the stance foot at which the other foot counts as ahead and can touch the ground.
    pub shortest_step: f64,
    /// Lowest permitted height of the hip, in units of the shorter legs.
    pub lowest_hip: f64,
    /// Longest permitted slide of the stance foot during a step.
    pub longest_slide: f64,
    /// Longest permitted time during which both feet are off the ground (in seconds).
    pub longest_flight: f64,
    /// Largest permitted gain of energy that is not explained by the motor, in units of weight times leg length.
    pub largest_gain: f64,
    /// Time after a footfall at which the angular velocities can be measured (in seconds).
    pub settling: f64,
}

impl Default for Rules {
    fn default() -> Self {
        Self {
            shortest_step: 0.05,
            lowest_hip: 0.7,
            longest_slide: 0.02,
            longest_flight: 0.1,
            largest_gain: 0.01,
            settling: 0.01,
        }
    }
}

/// The beginning of a new step, when the swing foot touches the ground.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Footfall {
    /// Time at which the foot touched the ground (in seconds). It is interpolated between two ticks.
    pub time: f64,
    /// Index of the foot. It is 0 for the outer and 1 for the inner foot.
    pub foot: usize,
    /// Position at which the sole touched the ground (in meters).
    pub place: f64,
    /// Backward lean of the leg from the normal of the ground at the footfall, `theta` of the walking model (in
    /// radians).
    pub angle: f64,
    /// Angular velocities (in rad/s) after the impact of this leg and of the leg that then swings, forward of the
    /// ground's normal. They correspond to `theta'` and `theta' - phi'` of the walking model at the footfall. Both are
    /// extrapolated linearly from the rates one and two times [`Rules::settling`] later, and are `None` until then.
    pub rates: Option<[f64; 2]>,
}

/// The stance foot, and the phase of the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// It swings and there is no ground under it.
    Passes,
    /// It swings above its ground.
    Falls,
    /// It is ahead on the ground, while the hind foot is still on the ground.
    Both,
}

/// Tracks the steps of a walk.
///
/// Since stiff legs would scuff as they pass, the swing leg has no ground. Its ground is removed when the foot is
/// lifted and returns when the foot is ahead of the stance foot and above the ground again. A step counts only if the
/// front foot carries weight and the rear foot has left the ground. A body that rolls, slides, hops or rests does not
/// make any steps.
#[derive(Clone, Debug)]
pub struct Gait {
    walker: Walker,
    parts: WalkerParts,
    rules: Rules,
    gravity: [f64; 3],
    time_step: f64,
    stance: usize,
    phase: Phase,
    ticks: u32,
    last: Posture,
    met: Footfall,
    started: f64,
    slid: f64,
    flown: f64,
    energy: f64,
    work: f64,
    steps: u32,
    footfalls: [Footfall; 2],
    /// Time since the last footfall and the rates of both legs once it has settled.
    settled: Option<(f64, [f64; 2])>,
    end: Option<End>,
}

impl Gait {
    /// Creates a tracker for a walker under the given gravity (in m/s2). The duration of a tick is `time_step` in
    /// seconds.
    pub fn new(walker: Walker, parts: WalkerParts, rules: Rules, gravity: [f64; 3], time_step: f64) -> Self {
        Self {
            walker,
            parts,
            rules,
            gravity,
            time_step,
            stance: 0,
            phase: Phase::Passes,
            ticks: 0,
            last: Posture::default(),
            met: Footfall::default(),
            started: 0.0,
            slid: 0.0,
            flown: 0.0,
            energy: 0.0,
            work: 0.0,
            steps: 0,
            footfalls: [Footfall::default(); 2],
            settled: None,
            end: None,
        }
    }

    /// Places the walker on its stance foot and resets the tracker.
    pub fn start<W>(&mut self, world: &mut W, stance: usize, posture: &Posture)
    where
        W: Joints + Arrange + Handles<Joint = JointId> + ?Sized,
    {
        world.clear();
        posture.place(world, &self.parts);
        let fresh = Self::new(self.walker, self.parts, self.rules, self.gravity, self.time_step);
        *self = Self { stance, ..fresh };
        // Only the stance foot has ground until the swing foot is ahead.
        self.ground(world, 1 - stance, false);
        self.last = Posture::from_world(world, &self.parts);
        self.started = self.sole(&self.last, stance)[0];
        let first = Footfall { foot: stance, place: self.started, ..Footfall::default() };
        self.footfalls = [first; 2];
        self.energy = self.walker.energy(&self.last, self.gravity);
    }

    /// Gives a foot its ground, or takes it away.
    fn ground<W>(&self, world: &mut W, foot: usize, there: bool)
    where
        W: Arrange + Handles<Joint = JointId> + ?Sized,
    {
        world.place_joint(self.parts.plates[foot], if there { 0.0 } else { ASIDE as f32 }, 0.0);
        world.finish_placement();
    }

    /// The lowest point of a sole, x and z \[m\].
    fn sole(&self, posture: &Posture, foot: usize) -> [f64; 2] {
        let [x, _, low] = self.walker.legs[foot].sole(posture.angles[foot]);
        [posture.hip[0] + x, posture.hip[1] + low]
    }

    /// Updates the tracker after a tick, in which the motor did the given work in joules. It also removes and returns
    /// the ground of the feet. Returns the reason if the walk has ended.
    pub fn judge<W>(&mut self, world: &mut W, work: f64) -> Option<End>
    where
        W: Joints + Contacts + Arrange + Handles<Joint = JointId> + ?Sized,
    {
        self.ticks += 1;
        self.work += work;
        let now = Posture::from_world(world, &self.parts);
        let touching = self.parts.soles.map(|sole| world.touches(sole));
        self.end = self.fault(&now, touching);
        if self.end.is_none() {
            self.follow(world, &now, touching);
            self.set_rate(&now);
        }
        self.last = now;
        self.end
    }

    fn fault(&mut self, now: &Posture, touching: [bool; 2]) -> Option<End> {
        let Self { walker, rules, .. } = self;
        let [a, b] = walker.legs.map(|legs| legs.length);
        let (longer, shorter) = (a.max(b), a.min(b));
        let energy = walker.energy(now, self.gravity);
        if !energy.is_finite() {
            return Some(End::Broken);
        }
        // The scale of energies is weight times leg: m g l.
        let size = walker.mass() * self.gravity[2].abs() * longer;
        // Strikes and friction only dissipate. A gain beyond the motor's work is an artifact of the simulation.
        if energy - self.energy - self.work > rules.largest_gain * size {
            return Some(End::Gained);
        }
        if now.hip[1] < rules.lowest_hip * shorter {
            return Some(End::Fell);
        }
        let stance = self.stance;
        if touching[stance] && self.phase != Phase::Both {
            let [_, _, low] = walker.legs[stance].sole(now.angles[stance]);
            // The sole's lowest point moves at v + w z, with z below the hip. A rolling foot has 0 here.
            self.slid += (now.velocity[0] + now.rates[stance] * low).abs() * self.time_step;
        }
        if self.slid > rules.longest_slide * longer {
            return Some(End::Slid);
        }
        self.flown = if touching[0] || touching[1] { 0.0 } else { self.flown + self.time_step };
        (self.flown > rules.longest_flight).then_some(End::Flew)
    }

    /// Follows the feet.
    fn follow<W>(&mut self, world: &mut W, now: &Posture, touching: [bool; 2])
    where
        W: Arrange + Handles<Joint = JointId> + ?Sized,
    {
        let (stance, swing) = (self.stance, 1 - self.stance);
        let [hind, _] = self.sole(now, stance);
        let [ahead, height] = self.sole(now, swing);
        let longer = self.walker.legs[0].length.max(self.walker.legs[1].length);
        let is_ahead = ahead - hind > self.rules.shortest_step * longer;
        match self.phase {
            // The swing foot passes through the ground next to the stance foot [Garcia1998]. Its plate is aside until the
            // foot is above the ground again, because a contact that starts in depth would throw it up.
            Phase::Passes if is_ahead && height > 0.0 => {
                self.phase = Phase::Falls;
                self.ground(world, swing, true);
            }
            Phase::Falls if touching[swing] => {
                // Where between the last tick and this one the sole met the ground.
                let [_, before] = self.sole(&self.last, swing);
                // Linear between ticks: the height is 0 at the share before / (before - height) of the step.
                let share = if before > 0.0 && height < 0.0 { before / (before - height) } else { 1.0 };
                let between = |a: f64, b: f64| a + share * (b - a);
                self.met = Footfall {
                    time: (f64::from(self.ticks - 1) + share) * self.time_step,
                    foot: swing,
                    place: ahead,
                    angle: -between(self.last.angles[swing], now.angles[swing]),
                    rates: None,
                };
                self.phase = Phase::Both;
                self.change(world, touching);
            }
            // The leg swung back before its foot landed, so the foot may pass again.
            Phase::Falls if !is_ahead => {
                self.phase = Phase::Passes;
                self.ground(world, swing, false);
            }
            Phase::Both => self.change(world, touching),
            _ => {}
        }
    }

    /// Sets the rate after the last footfall once it can be measured.
    fn set_rate(&mut self, now: &Posture) {
        let [_, fall] = &mut self.footfalls;
        if self.steps == 0 || fall.rates.is_some() || self.phase == Phase::Both {
            return;
        }
        let since = f64::from(self.ticks) * self.time_step - fall.time;
        // The walking model measures angles with the opposite sign.
        let rates = [-now.rates[self.stance], -now.rates[1 - self.stance]];
        match self.settled {
            None if since >= self.rules.settling => self.settled = Some((since, rates)),
            Some((first, early)) if since >= 2.0 * self.rules.settling => {
                // A compliant strike disturbs the rates for a moment. Two later rates r1 and r2 give the rate at the
                // strike by linear extrapolation, r(0) = r1 - (r2 - r1) / (t2 - t1) t1.
                let back = |k: usize| early[k] - (rates[k] - early[k]) / (since - first) * first;
                fall.rates = Some([back(0), back(1)]);
            }
            _ => {}
        }
    }

    /// In double support: whichever foot leaves the ground swings.
    fn change<W>(&mut self, world: &mut W, touching: [bool; 2])
    where
        W: Arrange + Handles<Joint = JointId> + ?Sized,
    {
        let (stance, swing) = (self.stance, 1 - self.stance);
        if !touching[stance] {
            // Both may be off for a moment after a hard blow: the foot that struck begins the stance.
            self.footfalls = [self.footfalls[1], self.met];
            self.settled = None;
            self.steps += 1;
            self.stance = swing;
            self.slid = 0.0;
            self.phase = Phase::Passes;
            self.ground(world, stance, false);
        } else if !touching[swing] {
            self.phase = Phase::Falls;
        }
    }

    /// Gets the number of steps that were made.
    pub fn steps(&self) -> u32 {
        self.steps
    }

    /// Returns the distance between the first position of the stance foot and the last footfall (in meters).
    pub fn distance(&self) -> f64 {
        self.footfalls[1].place - self.started
    }

    /// Gets the last two footfalls. The older one comes first.
    pub fn footfalls(&self) -> [Footfall; 2] {
        self.footfalls
    }

    /// Gets the index of the stance foot. It is 0 for the outer and 1 for the inner foot.
    pub fn stance(&self) -> usize {
        self.stance
    }

    /// Gets the posture of the walker after the last tick.
    pub fn posture(&self) -> &Posture {
        &self.last
    }

    /// Gets the number of ticks that have been judged.
    pub fn ticks(&self) -> u32 {
        self.ticks
    }

    /// Gets the reason for the end of the walk, or `None` as long as it continues.
    pub fn end(&self) -> Option<End> {
        self.end
    }

    /// Returns the work of the motor and the change of the walker's energy since the start (in joules).
    pub fn energies(&self) -> [f64; 2] {
        [self.work, self.walker.energy(&self.last, self.gravity) - self.energy]
    }

    /// Gets the walker.
    pub fn walker(&self) -> &Walker {
        &self.walker
    }

    /// Gets the identifiers of the walker's parts.
    pub fn parts(&self) -> &WalkerParts {
        &self.parts
    }
}
