//! Terms of the fitness for robots in an arena.

use crate::arena::ArenaWorld;
use farsa_body::Pose;
use farsa_body::ports::{BodyId, PairId};
use farsa_body::robots::MobileParts;
use farsa_lab::Error;
use farsa_num::{Scalar, atan2};

use crate::arena::field::Field;
use crate::arena::gathering::{Gathering, distance};
use crate::arena::measure::Measure;
use crate::arena::scene::Scene;
use crate::check::source::Source;
use crate::document::RewardKind;
use crate::formula::channels::ChannelNames;
use crate::formula::compile::{Formula, Quantity, Scope};

/// A measure, and the place of its thing.
#[derive(Clone, Debug)]
pub(crate) struct Term {
    measure: Measure,
    /// Thing of the measure, and its pose.
    thing: Option<BodyId>,
    place: Pose,
    /// Pose of the thing at the start.
    began: Pose,
    formula: Option<Box<Formula<Self>>>,
    /// Robots of the mean in a formula, from the first up to the one after the last, by default the measured one.
    about: Option<[usize; 2]>,
}

/// Sensor and motor values of all robots, robot by robot, with poses at the start, in the previous step and now [m].
pub(crate) struct Rows<'r> {
    pub(crate) x: &'r [f32],
    pub(crate) y: &'r [f32],
    /// Channels of a robot.
    pub(crate) inputs: usize,
    pub(crate) outputs: usize,
    pub(crate) started: &'r [Pose],
    pub(crate) before: &'r [[f64; 2]],
    pub(crate) poses: &'r [Pose],
    pub(crate) field: Option<&'r Field>,
    /// Steps so far, and of the longest trial.
    pub(crate) steps: [u32; 2],
}

impl Rows<'_> {
    fn of(values: &[f32], count: usize, robot: usize) -> &[f32] {
        values.get(robot * count..(robot + 1) * count).unwrap_or_default()
    }
}

/// Greatest wheel speed [rad/s] and radius [m] of a robot, and the control step [s].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Numbers {
    pub(crate) wheel_speed: f64,
    pub(crate) radius: f64,
    pub(crate) time_step: f64,
}

impl Term {
    /// Reads the term at a path of the document. `channels` are those of a robot.
    pub(crate) fn new(
        kind: &RewardKind,
        path: &str,
        channels: ChannelNames<'_>,
        scene: &Scene,
        source: &Source,
    ) -> Result<Self, Error> {
        if let RewardKind::Formula { formula } = kind {
            let path = format!("{path}/formula");
            let mut make = |quantity: &Quantity, path: &str| {
                Ok((Self::from_quantity(quantity, path, channels, scene, source)?, 0))
            };
            let mut formula = Scope { path: &path, channels, source }.term(formula, &mut make)?;
            if formula.program.is_one_quantity()
                && let Some(term) = formula.terms.pop_if(|term| term.about.is_none())
            {
                return Ok(term);
            }
            return Ok(Self { formula: Some(Box::new(formula)), ..Self::of(Measure::Formula, None) });
        }
        let (measure, thing) = Measure::new(kind, path, channels.sensors, scene, source)?;
        Ok(Self::of(measure, thing))
    }

    /// Reads the term of a formula's quantity.
    pub(crate) fn from_quantity(
        quantity: &Quantity,
        path: &str,
        channels: ChannelNames<'_>,
        scene: &Scene,
        source: &Source,
    ) -> Result<Self, Error> {
        match quantity {
            Quantity::Measure(kind, subject) => {
                let (mut kind, mut subject) = (kind.clone(), subject.clone());
                subject = subject.or_else(|| kind.take_body());
                let about = subject.map(|name| scene.robots_named(&name, path, source)).transpose()?;
                Ok(Self { about, ..Self::new(&kind, path, channels, scene, source)? })
            }
            Quantity::Channels(channels) => Ok(Self::of(Measure::Channels(*channels), None)),
        }
    }

    fn of(measure: Measure, thing: Option<BodyId>) -> Self {
        let nowhere = Pose::planar([0.0; 2], 0.0);
        Self { measure, thing, place: nowhere, began: nowhere, formula: None, about: None }
    }

    /// Iterates over the terms of the formula, if any.
    fn inner(&self) -> impl Iterator<Item = &Self> {
        self.formula.iter().flat_map(|formula| &formula.terms)
    }

    /// Checks if the measure depends on the previous step.
    pub(crate) fn looks_back(&self) -> bool {
        matches!(self.measure, Measure::Speed | Measure::Forward | Measure::Progress(_) | Measure::Registered(_))
            || self.inner().any(Self::looks_back)
    }

    /// Checks if the thing is a robot, which moves.
    pub(crate) fn is_about_robot(&self, scene: &Scene) -> bool {
        self.thing.is_some_and(|thing| (0..scene.robots.len()).any(|robot| scene.parts(robot).body == thing))
            || self.inner().any(|term| term.is_about_robot(scene))
    }

    /// Checks if the measure needs food or energy.
    pub(crate) fn of_foraging(&self) -> bool {
        use Measure::{Alive, CarriedFood, Deaths, Energy, Food, LostFood};
        matches!(self.measure, Food | CarriedFood | LostFood | Deaths | Energy | Alive)
            || self.inner().any(Self::of_foraging)
    }

    /// Checks if the measure has one value for the whole team.
    pub(crate) fn is_of_team(&self) -> bool {
        use Measure::{
            CarriedFood, Clusters, Deaths, Dispersion, Food, FullestArea, LargestCluster, LostFood, RobotsInArea,
        };
        match self.measure {
            Food | CarriedFood | LostFood | Deaths | FullestArea(_) | RobotsInArea(_) | Dispersion | Clusters
            | LargestCluster => true,
            Measure::Formula => self.inner().all(Self::is_of_team),
            _ => false,
        }
    }

    /// Stores the pose of the thing at the start of a trial.
    pub(crate) fn begin<W: ArenaWorld>(&mut self, world: &W) {
        self.locate(world);
        self.began = self.place;
        if let Measure::Registered(terms) = &mut self.measure {
            for term in terms {
                world.begin(&mut **term);
            }
        }
        if let Some(formula) = &mut self.formula {
            formula.terms.iter_mut().for_each(|term| term.begin(world));
        }
    }

    /// Updates registered measures after a step.
    pub(crate) fn step<W: ArenaWorld>(&mut self, world: &W) {
        if let Measure::Registered(terms) = &mut self.measure {
            for term in terms {
                world.step_term(&mut **term);
            }
        }
        if let Some(formula) = &mut self.formula {
            formula.terms.iter_mut().for_each(|term| term.step(world));
        }
    }

    /// Checks if the measure, or one of a formula, is registered.
    pub(crate) fn is_registered(&self) -> bool {
        matches!(self.measure, Measure::Registered(_)) || self.inner().any(Self::is_registered)
    }

    /// Updates the pose of the thing.
    pub(crate) fn locate<W: ArenaWorld>(&mut self, world: &W) {
        if let Some(thing) = self.thing {
            self.place = world.pose(thing);
        }
        if let Some(formula) = &mut self.formula {
            formula.terms.iter_mut().for_each(|term| term.locate(world));
        }
    }

    /// Computes the measure of a robot at `pose`, or `None` for the measures of [`value`](Self::value).
    ///
    /// Contains the measures of most experiments. The others are separate, so that a step does not prepare their
    /// inputs.
    #[inline]
    pub(crate) fn quick<W: ArenaWorld>(
        &self,
        world: &W,
        parts: &MobileParts,
        pose: &Pose,
        numbers: &Numbers,
    ) -> Option<f64> {
        Some(match &self.measure {
            Measure::Near { radius, within } => {
                let distance = length(self.way(pose)) - numbers.radius - radius;
                // NaN makes the trial fail. The comparison alone would turn a broken position into 0.
                if distance.is_finite() { yes(distance < *within) } else { f64::NAN }
            }
            Measure::Touch => yes(world.touches(PairId(parts.body.0))),
            Measure::Steps => 1.0,
            _ => return None,
        })
    }

    /// Computes the vector from a robot to the thing [m].
    fn way(&self, pose: &Pose) -> [f64; 2] {
        [0, 1].map(|k| f64::from(self.place.position[k] - pose.position[k]))
    }

    /// Returns 1 if a robot collides with the thing, or if the gap between their hulls is at most `within` [m].
    fn contact<W: ArenaWorld>(&self, world: &W, parts: &MobileParts, gap: f64, within: f64) -> f64 {
        let meets = |body: BodyId, other: Option<BodyId>| {
            let pair = PairId(body.0);
            world.touches(pair) && world.pair_bodies(pair)[1] == other
        };
        // A robot that also collides with a wall may report the wall only.
        let met = meets(parts.body, self.thing) || self.thing.is_some_and(|thing| meets(thing, Some(parts.body)));
        if gap.is_finite() { yes(met || gap <= within) } else { f64::NAN }
    }

    /// Computes the distance between the hulls of a robot and the thing, whose radii have this sum [m].
    fn gap(&self, pose: &Pose, radii: f64) -> f64 {
        f64::from(distance(pose, &self.place)) - radii
    }

    /// Computes the distance from a robot to the thing [m], with the difference formed in double precision.
    fn distance(&self, pose: &Pose) -> f64 {
        // The rotation leaves the length as it is, except for rounding.
        length(turned(pose, [0, 1].map(|k| f64::from(self.place.position[k]) - f64::from(pose.position[k]))))
    }

    /// Computes the measure of robot number `robot`.
    pub(crate) fn value<W: ArenaWorld>(
        &self,
        world: &W,
        parts: &MobileParts,
        (rows, robot): (&Rows<'_>, usize),
        numbers: &Numbers,
    ) -> f64 {
        let pose = &rows.poses[robot];
        let at = [0, 1].map(|k| f64::from(pose.position[k]));
        let from = |[u, v]: [f64; 2]| [at[0] - u, at[1] - v];
        let wheels = || parts.wheels.map(|wheel| f64::from(world.speed(wheel)) / numbers.wheel_speed);
        let forager = || rows.field.and_then(|field| field.robots().get(robot));
        match &self.measure {
            Measure::Distance => self.distance(pose),
            // d(0) - d(t)
            Measure::Approach => self.distance(&rows.started[robot]) - self.distance(pose),
            // |atan2| of the bearing in the robot's axes, in [0, pi].
            Measure::Angle => {
                let [ahead, left] = turned(pose, self.way(pose));
                atan2(left, ahead).abs()
            }
            Measure::Displacement => {
                let [x, y, _] = rows.started[robot].position.map(f64::from);
                length(from([x, y]))
            }
            Measure::Moved => {
                let [u, v] = [0, 1].map(|k| f64::from(self.place.position[k]) - f64::from(self.began.position[k]));
                length([u, v])
            }
            // |p - p'| / dt, with p' of the previous step.
            Measure::Speed => length(from(rows.before[robot])) / numbers.time_step,
            Measure::Forward => turned(pose, from(rows.before[robot]))[0],
            // n . (p - p')
            Measure::Progress([u, v]) => {
                let [x, y] = from(rows.before[robot]);
                x * u + y * v
            }
            Measure::Position([u, v]) => at[0] * u + at[1] * v,
            // (|l| + |r|) / 2, with wheel speeds as shares of the greatest.
            Measure::WheelSpeed => {
                let [left, right] = wheels();
                0.5 * (left.abs() + right.abs())
            }
            Measure::WheelDifference => {
                let [left, right] = parts.wheels.map(|wheel| f64::from(world.speed(wheel)));
                (right - left).abs()
            }
            // 1 - |l - r| / 2
            Measure::StraightOn => {
                let [left, right] = wheels();
                1.0 - 0.5 * (left - right).abs()
            }
            Measure::Sensor([first, end]) => {
                let channels = Rows::of(rows.x, rows.inputs, robot).get(*first..*end).unwrap_or_default();
                channels.iter().map(|x| f64::from(*x)).reduce(Scalar::max).unwrap_or(0.0)
            }
            Measure::InArea(areas) => yes(areas.iter().any(|area| area.contains(world, *pose))),
            // 1 - mean |p - p_j| / diagonal. The sum contains the robot itself at distance 0, the mean does not count it.
            Measure::NearOthers { diagonal } => {
                let way = |other: &Pose| f64::from(distance(pose, other));
                let others = rows.poses.len().saturating_sub(1).max(1) as f64;
                1.0 - rows.poses.iter().map(way).sum::<f64>() / others / diagonal
            }
            Measure::Energy => forager().map_or(0.0, |forager| forager.energy),
            Measure::Alive => yes(forager().is_some_and(|forager| forager.alive)),
            Measure::Held => yes(world.attached(parts.body).is_some()),
            Measure::Effort => effort(Rows::of(rows.y, rows.outputs, robot)),
            // Mean of (2 y - 1)^2, because a motor rests at y = 1/2.
            Measure::Control => {
                let y = Rows::of(rows.y, rows.outputs, robot);
                let squares = y.iter().map(|y| 2.0 * f64::from(*y) - 1.0).map(|u| u * u);
                squares.sum::<f64>() / y.len().max(1) as f64
            }
            Measure::Time => f64::from(rows.steps[0]) * numbers.time_step,
            Measure::Gap { radius } => self.gap(pose, numbers.radius + radius),
            Measure::Contact { radius, within } => {
                self.contact(world, parts, self.gap(pose, numbers.radius + radius), *within)
            }
            Measure::TimeLeft { rest } => time_left(rows.steps, *rest, robot),
            Measure::Step => f64::from(rows.steps[0]),
            Measure::Channels(channels) => {
                channels.value(Rows::of(rows.x, rows.inputs, robot), Rows::of(rows.y, rows.outputs, robot))
            }
            Measure::Registered(terms) => terms.get(robot).map_or(f64::NAN, |term| world.value(&**term)),
            Measure::Near { .. } | Measure::Touch | Measure::Steps => {
                self.quick(world, parts, pose, numbers).unwrap_or(0.0)
            }
            // Terms of formulas are no formulas, and other formulas are computed without this dispatch.
            Measure::Formula => f64::NAN,
            _ => self.team_value(world, rows, numbers.radius),
        }
    }

    /// Returns the robots that a quantity of a condition is about, by default all.
    pub(crate) fn about(&self) -> Option<[usize; 2]> {
        self.about
    }

    /// Returns true for a formula.
    #[inline]
    pub(crate) fn is_formula(&self) -> bool {
        self.formula.is_some()
    }

    /// Computes the formula for robot number `robot`. `of` returns the parts and numbers of a robot.
    #[inline(always)]
    pub(crate) fn formula_value<'r, W: ArenaWorld>(
        &self,
        world: &W,
        (rows, robot): (&Rows<'_>, usize),
        of: impl Fn(usize) -> (&'r MobileParts, &'r Numbers),
    ) -> f64 {
        let Some(formula) = &self.formula else { return f64::NAN };
        let value = |term: &Self, robot: usize| {
            let (parts, numbers) = of(robot);
            let quick = term.quick(world, parts, &rows.poses[robot], numbers);
            quick.unwrap_or_else(|| term.value(world, parts, (rows, robot), numbers))
        };
        formula.program.evaluate(|number| {
            let term = &formula.terms[number];
            let Some([first, end]) = term.about else { return value(term, robot) };
            // A smaller team lacks its last robots.
            let robots = first..end.min(rows.poses.len());
            let count = robots.len().max(1) as f64;
            robots.map(|robot| value(term, robot)).sum::<f64>() / count
        })
    }

    /// Returns a measure of the whole team, whose robots have this radius [m].
    fn team_value<W: ArenaWorld>(&self, world: &W, rows: &Rows<'_>, radius: f64) -> f64 {
        let food = |count: fn(&Field) -> f64| rows.field.map_or(0.0, count);
        let gathering = || Gathering::new(rows.poses, radius);
        let share = |robots: f64| robots / rows.poses.len().max(1) as f64;
        match &self.measure {
            Measure::Food => food(|field| f64::from(field.collected())),
            Measure::CarriedFood => food(|field| f64::from(field.carried())),
            Measure::LostFood => food(|field| f64::from(field.lost())),
            Measure::Deaths => food(|field| field.deaths() as f64),
            Measure::FullestArea(areas) => {
                let mut robots = vec![0_u32; areas.len()];
                for pose in rows.poses {
                    // A robot in two overlapping areas counts for the first one only.
                    if let Some(area) = areas.iter().position(|area| area.contains(world, *pose)) {
                        robots[area] += 1;
                    }
                }
                share(f64::from(robots.into_iter().max().unwrap_or(0)))
            }
            Measure::RobotsInArea(areas) => {
                let inside = |pose: &&Pose| areas.iter().any(|area| area.contains(world, **pose));
                rows.poses.iter().filter(inside).count() as f64
            }
            Measure::Dispersion => gathering().dispersion,
            Measure::Clusters => gathering().clusters as f64,
            Measure::LargestCluster => share(gathering().largest as f64),
            // The others are measures of a robot.
            _ => f64::NAN,
        }
    }
}

/// Rotates a vector into the axes of a pose.
fn turned(pose: &Pose, [u, v]: [f64; 2]) -> [f64; 2] {
    let [ahead, left, _] = pose.cast::<f64>().rotate_back([u, v, 0.0]);
    [ahead, left]
}

/// Computes the mean square of motor values.
fn effort(y: &[f32]) -> f64 {
    let squares: f64 = y.iter().map(|y| f64::from(*y) * f64::from(*y)).sum();
    squares / y.len().max(1) as f64
}

/// Computes 1 - t / T from the steps so far and those of the longest trial, or its rest of 1 for some robots.
fn time_left([steps, most]: [u32; 2], [first, end]: [usize; 2], robot: usize) -> f64 {
    let left = 1.0 - f64::from(steps) / f64::from(most);
    if (first..end).contains(&robot) { 1.0 - left } else { left }
}

fn yes(flag: bool) -> f64 {
    if flag { 1.0 } else { 0.0 }
}

fn length([x, y]: [f64; 2]) -> f64 {
    Scalar::sqrt(x * x + y * y)
}
