//! Terms of the fitness for a robot with joints.

use farsa_body::ports::{BodyId, JointId, PairId};
use farsa_body::sensors::Point;
use farsa_lab::Error;
use farsa_num::Scalar;

use crate::check::source::Source;
use crate::document::RewardKind;
use crate::formula::channels::{ChannelNames, Channels};
use crate::formula::compile::{Formula, Quantity, Scope};
use crate::jointed::SpatialWorld;
use crate::jointed::registered::{self, PartOfSpatial};
use crate::jointed::scene::Scene;
use crate::part::named_point::NamedPoint;
use crate::part::object::SpatialTerm;
use crate::part::scene::ON_WHEELS;
use crate::parts::agents::Agents;

/// Measure of a term.
#[derive(Clone, Debug)]
enum Measure {
    /// With the greatest distance of the surfaces [m].
    Near(NamedPoint, Point, f64),
    Distance(NamedPoint, Point),
    Approach(NamedPoint, Point),
    Touch(Vec<PairId>),
    Displacement(Point),
    Moved(NamedPoint),
    Speed(Point),
    Forward(Point),
    /// With the components of a unit vector of the world.
    Progress(Point, [f64; 3]),
    Position(NamedPoint, [f64; 3]),
    Height(NamedPoint),
    Upright(BodyId),
    JointSpeed(Vec<JointId>),
    JointPosition(JointId),
    JointVelocity(JointId),
    /// Channels of the network's inputs.
    Sensor([usize; 2]),
    Effort,
    Control,
    Steps,
    Registered(Box<dyn SpatialTerm>),
    Step,
    Time,
    Channels(Channels),
    /// Value of the term's formula.
    Formula,
}

/// A measure with its state in a trial.
#[derive(Clone, Debug)]
pub(crate) struct Term {
    measure: Measure,
    /// Position at the start, and in the previous step [m].
    began: [f64; 3],
    before: [f64; 3],
    /// Distance at the start [m].
    far: f64,
    formula: Option<Box<Formula<Self>>>,
}

impl Term {
    /// Reads a term at a path of the document. `channels` are those of the robot.
    pub(crate) fn new(
        kind: &RewardKind,
        path: &str,
        channels: ChannelNames<'_>,
        scene: &Scene,
        source: &Source,
    ) -> Result<Self, Error> {
        if let RewardKind::Formula { formula } = kind {
            let path = format!("{path}/formula");
            let mut make =
                |quantity: &Quantity, path: &str| Self::from_quantity(quantity, path, channels, scene, source);
            let mut formula = Scope { path: &path, channels, source }.term(formula, &mut make)?;
            if formula.program.is_one_quantity()
                && let Some(term) = formula.terms.pop()
            {
                return Ok(term);
            }
            return Ok(Self { formula: Some(Box::new(formula)), ..Self::of(Measure::Formula) });
        }
        Ok(Self::of(measure(kind, path, channels.sensors, scene, source)?))
    }

    /// Reads the term of a formula's quantity, with the number of its unit: 0 for hinges and 1 for rails.
    pub(crate) fn from_quantity(
        quantity: &Quantity,
        path: &str,
        channels: ChannelNames<'_>,
        scene: &Scene,
        source: &Source,
    ) -> Result<(Self, usize), Error> {
        let contact;
        let kind = match quantity {
            Quantity::Measure(kind, None) => kind,
            Quantity::Measure(RewardKind::Contact { object, within }, Some(body)) if *within == 0.0 => {
                contact = RewardKind::Touch { bodies: vec![body.clone()], with: Some(object.clone()) };
                &contact
            }
            Quantity::Measure(_, Some(name)) => {
                return Err(source.wrong(path, format!("is about the whole robot; `{name}` cannot be named")));
            }
            Quantity::Channels(channels) => return Ok((Self::of(Measure::Channels(*channels)), 0)),
        };
        let term = Self::new(kind, path, channels, scene, source)?;
        let joints = match &term.measure {
            Measure::JointSpeed(joints) => &joints[..],
            Measure::JointPosition(joint) | Measure::JointVelocity(joint) => std::slice::from_ref(joint),
            _ => &[],
        };
        let rails = joints.iter().filter(|joint| scene.is_rail(**joint)).count();
        if (1..joints.len()).contains(&rails) {
            return Err(source.wrong(path, "mixes hinges and rails, whose units differ; name the joints"));
        }
        Ok((term, usize::from(rails > 0)))
    }

    fn of(measure: Measure) -> Self {
        Self { measure, began: [0.0; 3], before: [0.0; 3], far: 0.0, formula: None }
    }

    /// Checks if the measure depends on the previous step.
    pub(crate) fn looks_back(&self) -> bool {
        let inner = self.formula.iter().flat_map(|formula| &formula.terms);
        matches!(self.measure, Measure::Forward(_) | Measure::Progress(..) | Measure::Registered(_))
            || inner.into_iter().any(Self::looks_back)
    }

    /// Stores the state at the start of a trial.
    pub(crate) fn begin<W: SpatialWorld>(&mut self, world: &W, markers: &[[f32; 3]]) {
        self.began = self.place(world, markers);
        self.before = self.began;
        if let Measure::Registered(term) = &mut self.measure {
            world.begin(&mut **term);
        }
        if let Measure::Approach(point_named, point) = &self.measure {
            self.far = apart(point_named.position(world, markers), place_of(world, point));
        }
        if let Some(formula) = &mut self.formula {
            formula.terms.iter_mut().for_each(|term| term.begin(world, markers));
        }
    }

    /// Updates a registered measure after a step.
    pub(crate) fn step<W: SpatialWorld>(&mut self, world: &W) {
        if let Measure::Registered(term) = &mut self.measure {
            world.step_term(&mut **term);
        }
        if let Some(formula) = &mut self.formula {
            formula.terms.iter_mut().for_each(|term| term.step(world));
        }
    }

    /// Stores the position for the next step.
    pub(crate) fn remember<W: SpatialWorld>(&mut self, world: &W, markers: &[[f32; 3]]) {
        if let Some(formula) = &mut self.formula {
            formula.terms.iter_mut().for_each(|term| term.remember(world, markers));
        } else if self.looks_back() {
            self.before = self.place(world, markers);
        }
    }

    /// Computes the position of the measured part [m].
    fn place<W: SpatialWorld>(&self, world: &W, markers: &[[f32; 3]]) -> [f64; 3] {
        match &self.measure {
            Measure::Moved(point_named) => point_named.position(world, markers),
            Measure::Displacement(point) | Measure::Forward(point) | Measure::Progress(point, _) => {
                place_of(world, point)
            }
            _ => [0.0; 3],
        }
    }

    /// Computes the measure after a step.
    pub(crate) fn value<W: SpatialWorld>(&self, world: &W, markers: &[[f32; 3]], agents: &Agents) -> f64 {
        let distance = |point_named: &NamedPoint, point: &Point| {
            apart(point_named.position(world, markers), place_of(world, point))
        };
        let mean = |sum: f64, count: usize| sum / count.max(1) as f64;
        match &self.measure {
            Measure::Near(point_named, point, within) => {
                let distance = distance(point_named, point);
                // NaN makes the trial fail. The comparison alone would turn a broken position into 0.
                if distance.is_finite() { yes(distance < *within) } else { f64::NAN }
            }
            Measure::Distance(point_named, point) => distance(point_named, point),
            // d(0) - d(t)
            Measure::Approach(point_named, point) => self.far - distance(point_named, point),
            Measure::Touch(pairs) => yes(pairs.iter().any(|pair| world.touches(*pair))),
            Measure::Displacement(_) | Measure::Moved(_) => apart(self.place(world, markers), self.began),
            // From the dynamics, unlike in an arena, where it is the difference of two positions.
            Measure::Speed(point) => length(velocity_of(world, point)),
            // x component of R^T (p - p'), with p' of the previous step.
            Measure::Forward(point) => {
                let way = self.way(world, markers);
                world.pose(point.body).cast::<f64>().rotate_back(way)[0]
            }
            // n . (p - p')
            Measure::Progress(_, [u, v, w]) => {
                let [x, y, z] = self.way(world, markers);
                x * u + y * v + z * w
            }
            Measure::Position(point, [u, v, w]) => {
                let [x, y, z] = point.position(world, markers);
                x * u + y * v + z * w
            }
            Measure::Height(point) => point.position(world, markers)[2],
            // z component of the body's z axis in the world.
            Measure::Upright(body) => f64::from(world.pose(*body).rotate([0.0, 0.0, 1.0])[2]),
            Measure::JointSpeed(joints) => {
                mean(joints.iter().map(|joint| f64::from(world.speed(*joint)).abs()).sum(), joints.len())
            }
            Measure::JointPosition(joint) => f64::from(world.position(*joint)),
            Measure::JointVelocity(joint) => f64::from(world.speed(*joint)),
            Measure::Sensor([first, end]) => {
                let channels = agents.x.get(*first..*end).unwrap_or_default();
                channels.iter().map(|x| f64::from(*x)).reduce(Scalar::max).unwrap_or(0.0)
            }
            Measure::Effort => mean(agents.y.iter().map(|y| f64::from(*y) * f64::from(*y)).sum(), agents.y.len()),
            // Mean of (2 y - 1)^2, because a motor rests at y = 1/2.
            Measure::Control => {
                let off = agents.y.iter().map(|y| 2.0 * f64::from(*y) - 1.0);
                mean(off.map(|u| u * u).sum(), agents.y.len())
            }
            Measure::Steps => 1.0,
            Measure::Registered(term) => world.value(&**term),
            Measure::Step => f64::from(agents.ledger.steps),
            Measure::Time => f64::from(agents.ledger.steps) * agents.document.world.time_step,
            Measure::Channels(channels) => channels.value(&agents.x, &agents.y),
            Measure::Formula => self.formula.as_ref().map_or(f64::NAN, |formula| {
                formula.program.evaluate(|number| formula.terms[number].value(world, markers, agents))
            }),
        }
    }

    /// Computes the displacement of the last step [m].
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
    source: &Source,
) -> Result<Measure, Error> {
    let point_named = |object: &String| scene.point_named(object, &format!("{path}/object"), source);
    let point = |body: &Option<String>, at: &[f64; 3]| scene.point(body.as_ref(), *at, path, source);
    let part = |name: &Option<String>, at: &[f64; 3]| scene.part_or_thing(name.as_ref(), *at, path, source);
    let body = |name: &Option<String>| scene.body(name.as_ref(), &format!("{path}/body"), source).map(|(body, _)| body);
    let direction = |along: &[f64; 3]| {
        let far = length(*along);
        let points = far != 0.0;
        points.then(|| along.map(|x| x / far)).ok_or_else(|| source.wrong(&format!("{path}/along"), "points nowhere"))
    };
    Ok(match kind {
        RewardKind::Near { object, within, body, point: at } => {
            let (point_named, reach) = point_named(object)?;
            // Distances are those of centers, so the reach of the thing is a part of the limit.
            Measure::Near(point_named, point(body, at)?, reach + within)
        }
        RewardKind::Distance { object, body, point: at } => Measure::Distance(point_named(object)?.0, point(body, at)?),
        RewardKind::Approach { object, body, point: at } => Measure::Approach(point_named(object)?.0, point(body, at)?),
        RewardKind::Touch { bodies, with } => Measure::Touch(scene.pairs(bodies, with.as_ref(), path, source)?),
        RewardKind::Displacement { body } => Measure::Displacement(point(body, &[0.0; 3])?),
        RewardKind::Moved { object } => Measure::Moved(point_named(object)?.0),
        RewardKind::Contact { object, within } if *within == 0.0 => {
            Measure::Touch(scene.pairs(&[], Some(object), path, source)?)
        }
        RewardKind::Speed { body } => match part(body, &[0.0; 3])? {
            NamedPoint::Body(point) => Measure::Speed(point),
            NamedPoint::Marker(_) => return Err(source.wrong(path, "is about a marker, which has no speed")),
        },
        RewardKind::Forward { body } => Measure::Forward(point(body, &[0.0; 3])?),
        RewardKind::Progress { along, body } => Measure::Progress(point(body, &[0.0; 3])?, direction(along)?),
        RewardKind::Position { along, body, point: at } => Measure::Position(part(body, at)?, direction(along)?),
        RewardKind::Height { body, point: at } => Measure::Height(part(body, at)?),
        RewardKind::Upright { body: name } => Measure::Upright(body(name)?),
        RewardKind::JointSpeed { joints } => Measure::JointSpeed(scene.joints(joints, |_| true, path, source)?),
        RewardKind::JointPosition { joint } => Measure::JointPosition(scene.joint(joint, path, source)?),
        RewardKind::JointVelocity { joint } => Measure::JointVelocity(scene.joint(joint, path, source)?),
        RewardKind::Sensor { sensor } => {
            let names = sensors.iter().map(|(name, _)| name.as_str());
            let number = source.position(names, ("sensor", sensor), &format!("{path}/sensor"))?;
            Measure::Sensor(sensors[number].1)
        }
        RewardKind::Effort {} => Measure::Effort,
        RewardKind::Control {} => Measure::Control,
        RewardKind::Steps {} => Measure::Steps,
        RewardKind::Step {} => Measure::Step,
        RewardKind::Time {} => Measure::Time,
        RewardKind::Registered { kind, keys } => Measure::Registered(registered::term(
            kind,
            keys,
            PartOfSpatial { scene, wiring: None, rule: None, path, source },
        )?),
        _ => return Err(source.wrong(path, ON_WHEELS)),
    })
}

fn place_of<W: SpatialWorld>(world: &W, point: &Point) -> [f64; 3] {
    point.position(world).map(f64::from)
}

/// Computes the velocity of a point of a body [m/s].
fn velocity_of<W: SpatialWorld>(world: &W, point: &Point) -> [f64; 3] {
    let (twist, pose) = (world.velocity(point.body), world.pose(point.body).cast::<f64>());
    let ([x, y, z], [u, v, w]) = (pose.rotate(point.at.map(f64::from)), twist.angular.map(f64::from));
    // v + w x r
    let turning = [v * z - w * y, w * x - u * z, u * y - v * x];
    let linear = twist.linear.map(f64::from);
    [0, 1, 2].map(|k| linear[k] + turning[k])
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
