//! A term of the fitness.

use farsa_body::{BodyId, MobileParts, PairId, Pose};
use farsa_lab::{Error, PlanarWorld};
use farsa_num::{Scalar, atan2};

use crate::check::places::Places;
use crate::document::{Condition, Over, Reward, RewardKind};
use crate::parts::scene::{Scene, Thing};

/// What a term measures of one robot.
#[derive(Clone, Debug)]
enum Measure {
    Near {
        radius: f64,
        within: f64,
    },
    Distance,
    Approach,
    Angle,
    Touch,
    Displacement,
    Speed,
    Forward,
    WheelSpeed,
    StraightOn,
    /// Channels of the network's inputs.
    Sensor([usize; 2]),
    InArea {
        half: [f64; 2],
        disc: bool,
    },
    Held,
    Effort,
    Steps,
}

/// A term with what it has come to in this trial.
#[derive(Clone, Debug)]
pub(crate) struct Term {
    pub(crate) name: String,
    weight: f64,
    over: Over,
    during: Option<usize>,
    /// The robot that it is about, if not all.
    robot: Option<usize>,
    clip: Option<[f64; 2]>,
    measure: Measure,
    /// The thing that it is about, and where that is.
    thing: Option<BodyId>,
    place: Pose,
    /// The sum of all steps that counted, and the largest and the last value of one.
    sum: f64,
    most: f64,
    pub(crate) last: f64,
}

/// A robot as terms see it.
pub(crate) struct Seen<'r> {
    pub(crate) parts: &'r MobileParts,
    pub(crate) pose: Pose,
    /// What it sensed and did last.
    pub(crate) x: &'r [f32],
    pub(crate) y: &'r [f32],
    /// Where it started and where it was a step before [m].
    pub(crate) start: [f64; 2],
    pub(crate) before: [f64; 2],
}

/// The greatest wheel speed [rad/s] and the radius [m] of the robots, and the control step [s].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Numbers {
    pub(crate) wheel_speed: f64,
    pub(crate) radius: f64,
    pub(crate) time_step: f64,
}

impl Term {
    /// A term that stands at a path of the document; `names` are those of all terms, `sensors` those of the sensors with
    /// their channels.
    ///
    /// # Errors
    /// [`Error::Unknown`] for a thing, sensor or term that there is not, [`Error::Setting`] for what does not go together.
    pub(crate) fn new(
        reward: &Reward,
        number: usize,
        names: &[String],
        sensors: &[(String, [usize; 2])],
        scene: &Scene,
        places: &Places,
    ) -> Result<Self, Error> {
        let path = format!("/reward/{number}");
        let body = |name: &str| scene.body(name, &format!("{path}/object"), places);
        let mut about = None;
        let measure = match &reward.kind {
            RewardKind::Near { object, within } => {
                let path = format!("{path}/object");
                let Some((thing, radius)) = scene.thing(object, &path, places)?.solid() else {
                    return Err(places.wrong(&path, format!("`{object}` is no cylinder")));
                };
                about = Some(thing);
                Measure::Near { radius, within: *within }
            }
            RewardKind::Distance { object } => {
                about = Some(body(object)?);
                Measure::Distance
            }
            RewardKind::Approach { object } => {
                about = Some(body(object)?);
                Measure::Approach
            }
            RewardKind::Angle { object } => {
                about = Some(body(object)?);
                Measure::Angle
            }
            RewardKind::Touch {} => Measure::Touch,
            RewardKind::Displacement {} => Measure::Displacement,
            RewardKind::Speed {} => Measure::Speed,
            RewardKind::Forward {} => Measure::Forward,
            RewardKind::WheelSpeed {} => Measure::WheelSpeed,
            RewardKind::StraightOn {} => Measure::StraightOn,
            RewardKind::Sensor { sensor } => {
                let found = sensors.iter().find(|(name, _)| name == sensor).map(|(_, channels)| *channels);
                let names = sensors.iter().map(|(name, _)| name.as_str());
                let place = places.of(&format!("{path}/sensor"));
                Measure::Sensor(found.ok_or_else(|| Error::unknown(&place, "sensor", sensor, names))?)
            }
            RewardKind::InArea { area } => {
                let path = format!("{path}/area");
                match scene.thing(area, &path, places)? {
                    Thing::Area { body, half, disc } => {
                        about = Some(body);
                        Measure::InArea { half, disc }
                    }
                    _ => return Err(places.wrong(&path, format!("`{area}` is no disc or rectangle"))),
                }
            }
            RewardKind::Held {} => Measure::Held,
            RewardKind::Effort {} => Measure::Effort,
            RewardKind::Steps {} => Measure::Steps,
        };
        let robot = reward.robot.map(|robot| robot as usize - 1);
        if robot.is_some_and(|robot| robot >= scene.robots) {
            let why = format!("is robot {} of {}", robot.unwrap_or(0) + 1, scene.robots);
            return Err(places.wrong(&format!("{path}/robot"), why));
        }
        if reward.clip.is_some_and(|[low, high]| low > high) {
            return Err(places.wrong(&format!("{path}/clip"), "runs backwards"));
        }
        let during = reward.during.as_ref().map(|name| {
            let path = format!("{path}/during");
            let found = names.iter().position(|known| known == name);
            let found = found
                .ok_or_else(|| Error::unknown(&places.of(&path), "term", name, names.iter().map(String::as_str)))?;
            if found >= number {
                let why = format!("`{name}` has to stand before this term");
                return Err(places.wrong(&path, why));
            }
            Ok(found)
        });
        Ok(Self {
            name: names[number].clone(),
            weight: reward.weight,
            over: reward.over,
            during: during.transpose()?,
            robot,
            clip: reward.clip,
            measure,
            thing: about,
            place: Pose::planar([0.0; 2], 0.0),
            sum: 0.0,
            most: f64::NEG_INFINITY,
            last: 0.0,
        })
    }

    /// Forgets an earlier trial.
    pub(crate) fn reset(&mut self) {
        (self.sum, self.most, self.last) = (0.0, f64::NEG_INFINITY, 0.0);
    }

    /// Looks where its thing is, if it has one.
    pub(crate) fn locate<W: PlanarWorld>(&mut self, world: &W) {
        if let Some(thing) = self.thing {
            self.place = world.pose(thing);
        }
    }

    /// The share that a robot, of so many, has in it.
    #[inline]
    pub(crate) fn share(&self, robot: usize, value: f64) -> f64 {
        if self.robot.is_none_or(|own| own == robot) { value } else { 0.0 }
    }

    /// Of how many robots it is the mean, where there are so many.
    pub(crate) fn robots(&self, all: usize) -> f64 {
        if self.robot.is_some() { 1.0 } else { all as f64 }
    }

    /// What it measures of a robot after a step.
    #[inline]
    pub(crate) fn value<W: PlanarWorld>(&self, world: &W, seen: &Seen<'_>, numbers: Numbers) -> f64 {
        let (body, pose) = (seen.parts.body, seen.pose);
        let [x, y] = [pose.position[0], pose.position[1]];
        let yes = |flag: bool| if flag { 1.0 } else { 0.0 };
        let way = || [self.place.position[0] - x, self.place.position[1] - y].map(f64::from);
        let from = |[u, v]: [f64; 2]| length([f64::from(x) - u, f64::from(y) - v]);
        let wheels = || seen.parts.wheels.map(|wheel| f64::from(world.speed(wheel)) / numbers.wheel_speed);
        match self.measure {
            Measure::Near { radius, within } => {
                let distance = length(way()) - numbers.radius - radius;
                if distance.is_finite() { yes(distance < within) } else { f64::NAN }
            }
            Measure::Distance => length(way()),
            Measure::Approach => {
                let [u, v, _] = self.place.position.map(f64::from);
                length([u - seen.start[0], v - seen.start[1]]) - length(way())
            }
            Measure::Angle => {
                let [u, v] = way();
                let [ahead, left] = turned(&pose, [u, v]);
                atan2(left, ahead).abs()
            }
            Measure::Touch => yes(world.touches(PairId(body.0))),
            Measure::Displacement => from(seen.start),
            Measure::Speed => from(seen.before) / numbers.time_step,
            Measure::Forward => {
                let [u, v] = [f64::from(x) - seen.before[0], f64::from(y) - seen.before[1]];
                let [ahead, _] = turned(&pose, [u, v]);
                ahead
            }
            Measure::WheelSpeed => {
                let [left, right] = wheels();
                0.5 * (left.abs() + right.abs())
            }
            Measure::StraightOn => {
                let [left, right] = wheels();
                1.0 - 0.5 * (left - right).abs()
            }
            Measure::Sensor([first, end]) => {
                let channels = seen.x.get(first..end).unwrap_or_default();
                channels.iter().fold(0.0, |most, x| Scalar::max(most, f64::from(*x)))
            }
            Measure::InArea { half, disc } => {
                let [u, v] = way();
                let [u, v] = turned(&self.place, [-u, -v]);
                yes(if disc { length([u, v]) <= half[0] } else { u.abs() <= half[0] && v.abs() <= half[1] })
            }
            Measure::Held => yes(world.attached(body).is_some()),
            Measure::Effort => {
                let squares: f64 = seen.y.iter().map(|y| f64::from(*y) * f64::from(*y)).sum();
                squares / seen.y.len().max(1) as f64
            }
            Measure::Steps => 1.0,
        }
    }

    /// Counts a step of this value; `others` are the terms before it.
    pub(crate) fn count(&mut self, value: f64, others: &[Self]) {
        let value = self.clip.map_or(value, |[low, high]| Scalar::clamp(value, low, high));
        self.last = value;
        if self.during.is_none_or(|other| others.get(other).is_some_and(|other| other.last > 0.0)) {
            self.sum += value;
            self.most = Scalar::max(self.most, value);
        }
    }

    /// What it has earned, in a trial of at most so many steps.
    pub(crate) fn earned(&self, steps: u32) -> f64 {
        let counts = |value: f64, other: f64| if self.most == f64::NEG_INFINITY { other } else { value };
        self.weight
            * match self.over {
                Over::Mean => self.sum / f64::from(steps),
                Over::Sum => self.sum,
                Over::End => self.last,
                Over::Most => counts(self.most, 0.0),
            }
    }
}

/// A way in the axes of a pose. Not inlined, because the compiler would compute it for every measure.
#[inline(never)]
fn turned(pose: &Pose, [u, v]: [f64; 2]) -> [f64; 2] {
    let [ahead, left, _] = pose.cast::<f64>().rotate_back([u, v, 0.0]);
    [ahead, left]
}

fn length([x, y]: [f64; 2]) -> f64 {
    Scalar::sqrt(x * x + y * y)
}

/// A condition of success on a term by its number.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wanted {
    term: usize,
    above: Option<f64>,
    below: Option<f64>,
}

impl Wanted {
    /// A condition that stands at a path of the document.
    ///
    /// # Errors
    /// [`Error::Unknown`] for a term that there is not, [`Error::Setting`] for a condition that asks nothing.
    pub(crate) fn new(condition: &Condition, path: &str, names: &[String], places: &Places) -> Result<Self, Error> {
        let Condition { term, above, below } = condition;
        let names_of = names.iter().map(String::as_str);
        let place = places.of(&format!("{path}/term"));
        let found = names.iter().position(|name| name == term);
        let term = found.ok_or_else(|| Error::unknown(&place, "term", term, names_of))?;
        if above.is_none() && below.is_none() {
            return Err(places.wrong(path, "lacks `above` and `below`: one of them at least"));
        }
        Ok(Self { term, above: *above, below: *below })
    }

    /// Whether it holds after the last step.
    pub(crate) fn holds(&self, terms: &[Term]) -> bool {
        let value = terms[self.term].last;
        self.above.is_none_or(|above| value > above) && self.below.is_none_or(|below| value < below)
    }
}
