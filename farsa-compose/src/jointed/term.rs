//! What a term of the fitness measures of a robot with joints.

use farsa_body::ports::{BodyId, JointId, PairId};
use farsa_body::sensors::Point;
use farsa_lab::Error;
use farsa_num::Scalar;

use crate::check::places::Places;
use crate::document::RewardKind;
use crate::jointed::SpatialWorld;
use crate::jointed::scene::Scene;
use crate::jointed::spot::Spot;
use crate::parts::agents::Agents;

/// What is measured.
#[derive(Clone, Debug)]
enum Measure {
    /// Nearer than so far beyond the thing's surface [m].
    Near(Spot, Point, f64),
    Distance(Spot, Point),
    Approach(Spot, Point),
    Touch(Vec<PairId>),
    Displacement(Point),
    Moved(Spot),
    Speed(BodyId),
    Forward(BodyId),
    /// These two along a unit vector of the world.
    Progress(BodyId, [f64; 3]),
    Position(Point, [f64; 3]),
    Height(Point),
    Upright(BodyId),
    JointSpeed(Vec<JointId>),
    /// Channels of the network's inputs.
    Sensor([usize; 2]),
    Effort,
    Control,
    Steps,
}

/// A term's measure with what it remembers of the trial.
#[derive(Clone, Debug)]
pub(crate) struct Term {
    measure: Measure,
    /// Where what it measures was at the start, and a step before [m].
    began: [f64; 3],
    before: [f64; 3],
    /// The distance at the start [m].
    far: f64,
}

impl Term {
    /// What a kind of term that stands at a path of the document measures; `sensors` are those of the robot with their channels.
    ///
    /// # Errors
    /// [`Error::Unknown`] for a thing, body, joint or sensor that there is not, [`Error::Setting`] for what cannot be measured.
    pub(crate) fn new(
        kind: &RewardKind,
        path: &str,
        sensors: &[(String, [usize; 2])],
        scene: &Scene,
        places: &Places,
    ) -> Result<Self, Error> {
        let measure = measure(kind, path, sensors, scene, places)?;
        Ok(Self { measure, began: [0.0; 3], before: [0.0; 3], far: 0.0 })
    }

    /// Whether it measures what happened in a step.
    pub(crate) fn looks_back(&self) -> bool {
        matches!(self.measure, Measure::Forward(_) | Measure::Progress(..))
    }

    /// Looks how the trial begins.
    pub(crate) fn begin<W: SpatialWorld>(&mut self, world: &W, markers: &[[f32; 3]]) {
        self.began = self.place(world, markers);
        self.before = self.began;
        if let Measure::Approach(spot, point) = &self.measure {
            self.far = apart(spot.position(world, markers), place_of(world, point));
        }
    }

    /// Remembers where it is now, for the next step.
    pub(crate) fn remember<W: SpatialWorld>(&mut self, world: &W, markers: &[[f32; 3]]) {
        if self.looks_back() {
            self.before = self.place(world, markers);
        }
    }

    /// Where what it measures is [m].
    fn place<W: SpatialWorld>(&self, world: &W, markers: &[[f32; 3]]) -> [f64; 3] {
        match &self.measure {
            Measure::Moved(spot) => spot.position(world, markers),
            Measure::Displacement(point) => place_of(world, point),
            Measure::Forward(body) | Measure::Progress(body, _) => place_of(world, &Point::origin(*body)),
            _ => [0.0; 3],
        }
    }

    /// What it measures after a step.
    pub(crate) fn value<W: SpatialWorld>(&self, world: &W, markers: &[[f32; 3]], agents: &Agents) -> f64 {
        let distance = |spot: &Spot, point: &Point| apart(spot.position(world, markers), place_of(world, point));
        let mean = |sum: f64, count: usize| sum / count.max(1) as f64;
        match &self.measure {
            Measure::Near(spot, point, within) => {
                let distance = distance(spot, point);
                if distance.is_finite() { yes(distance < *within) } else { f64::NAN }
            }
            Measure::Distance(spot, point) => distance(spot, point),
            Measure::Approach(spot, point) => self.far - distance(spot, point),
            Measure::Touch(pairs) => yes(pairs.iter().any(|pair| world.touches(*pair))),
            Measure::Displacement(_) | Measure::Moved(_) => apart(self.place(world, markers), self.began),
            Measure::Speed(body) => length(world.velocity(*body).linear.map(f64::from)),
            Measure::Forward(body) => {
                let way = self.way(world, markers);
                world.pose(*body).cast::<f64>().rotate_back(way)[0]
            }
            Measure::Progress(_, [u, v, w]) => {
                let [x, y, z] = self.way(world, markers);
                x * u + y * v + z * w
            }
            Measure::Position(point, [u, v, w]) => {
                let [x, y, z] = place_of(world, point);
                x * u + y * v + z * w
            }
            Measure::Height(point) => place_of(world, point)[2],
            Measure::Upright(body) => f64::from(world.pose(*body).rotate([0.0, 0.0, 1.0])[2]),
            Measure::JointSpeed(joints) => {
                mean(joints.iter().map(|joint| f64::from(world.speed(*joint)).abs()).sum(), joints.len())
            }
            Measure::Sensor([first, end]) => {
                let channels = agents.x.get(*first..*end).unwrap_or_default();
                channels.iter().fold(0.0, |most, x| Scalar::max(most, f64::from(*x)))
            }
            Measure::Effort => mean(agents.y.iter().map(|y| f64::from(*y) * f64::from(*y)).sum(), agents.y.len()),
            Measure::Control => {
                let off = agents.y.iter().map(|y| 2.0 * f64::from(*y) - 1.0);
                mean(off.map(|u| u * u).sum(), agents.y.len())
            }
            Measure::Steps => 1.0,
        }
    }

    /// The way of the last step [m].
    fn way<W: SpatialWorld>(&self, world: &W, markers: &[[f32; 3]]) -> [f64; 3] {
        let now = self.place(world, markers);
        [0, 1, 2].map(|k| now[k] - self.before[k])
    }
}

fn measure(
    kind: &RewardKind,
    path: &str,
    sensors: &[(String, [usize; 2])],
    scene: &Scene,
    places: &Places,
) -> Result<Measure, Error> {
    let spot = |object: &String| scene.spot(object, &format!("{path}/object"), places);
    let point = |body: &Option<String>, at: &[f64; 3]| scene.point(body.as_ref(), *at, path, places);
    let body = |name: &Option<String>| scene.body(name.as_ref(), &format!("{path}/body"), places).map(|(body, _)| body);
    let direction = |along: &[f64; 3]| {
        let far = length(*along);
        let points = far != 0.0;
        points.then(|| along.map(|x| x / far)).ok_or_else(|| places.wrong(&format!("{path}/along"), "points nowhere"))
    };
    Ok(match kind {
        RewardKind::Near { object, within, body, point: at } => {
            let (spot, reach) = spot(object)?;
            Measure::Near(spot, point(body, at)?, reach + within)
        }
        RewardKind::Distance { object, body, point: at } => Measure::Distance(spot(object)?.0, point(body, at)?),
        RewardKind::Approach { object, body, point: at } => Measure::Approach(spot(object)?.0, point(body, at)?),
        RewardKind::Touch { bodies, with } => Measure::Touch(scene.pairs(bodies, with.as_ref(), path, places)?),
        RewardKind::Displacement { body } => Measure::Displacement(point(body, &[0.0; 3])?),
        RewardKind::Moved { object } => Measure::Moved(spot(object)?.0),
        RewardKind::Speed { body: name } => Measure::Speed(body(name)?),
        RewardKind::Forward { body: name } => Measure::Forward(body(name)?),
        RewardKind::Progress { along, body: name } => Measure::Progress(body(name)?, direction(along)?),
        RewardKind::Position { along, body, point: at } => Measure::Position(point(body, at)?, direction(along)?),
        RewardKind::Height { body, point: at } => Measure::Height(point(body, at)?),
        RewardKind::Upright { body: name } => Measure::Upright(body(name)?),
        RewardKind::JointSpeed { joints } => Measure::JointSpeed(scene.joints(joints, |_| true, path, places)?),
        RewardKind::Sensor { sensor } => {
            let found = sensors.iter().find(|(name, _)| name == sensor).map(|(_, channels)| *channels);
            let names = sensors.iter().map(|(name, _)| name.as_str());
            let place = places.of(&format!("{path}/sensor"));
            Measure::Sensor(found.ok_or_else(|| Error::unknown(&place, "sensor", sensor, names))?)
        }
        RewardKind::Effort {} => Measure::Effort,
        RewardKind::Control {} => Measure::Control,
        RewardKind::Steps {} => Measure::Steps,
        RewardKind::Angle { .. }
        | RewardKind::WheelSpeed {}
        | RewardKind::StraightOn {}
        | RewardKind::InArea { .. }
        | RewardKind::NearOthers {}
        | RewardKind::Food {}
        | RewardKind::Energy {}
        | RewardKind::Alive {}
        | RewardKind::Held {} => return Err(places.wrong(path, "is for robots on wheels; this one has joints")),
    })
}

fn place_of<W: SpatialWorld>(world: &W, point: &Point) -> [f64; 3] {
    point.position(world).map(f64::from)
}

fn yes(flag: bool) -> f64 {
    if flag { 1.0 } else { 0.0 }
}

fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    length([0, 1, 2].map(|k| a[k] - b[k]))
}

fn length([x, y, z]: [f64; 3]) -> f64 {
    Scalar::sqrt(x * x + y * y + z * z)
}
