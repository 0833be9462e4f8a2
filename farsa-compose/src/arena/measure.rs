//! Measures of robots for terms.

use farsa_body::ports::BodyId;
use farsa_lab::Error;
use farsa_num::Scalar;

use crate::arena::registered::{self, PartOfPlanar};
use crate::arena::scene::{Scene, Thing, one_body};
use crate::check::source::Source;
use crate::document::RewardKind;
use crate::formula::channels::Channels;
use crate::part::Area;
use crate::part::object::PlanarTerm;

/// The measure of a term for one robot.
#[derive(Clone, Debug)]
// The tag is a separate byte. In the capacity of `areas` it takes eight instructions to read, for each term and step.
#[repr(u8)]
pub(crate) enum Measure {
    Near {
        radius: f64,
        within: f64,
    },
    Distance,
    Approach,
    Angle,
    Touch,
    Displacement,
    Moved,
    Speed,
    Forward,
    /// Components of a unit vector of the plane.
    Progress([f64; 2]),
    Position([f64; 2]),
    WheelSpeed,
    WheelDifference,
    StraightOn,
    /// Channels of the network's inputs.
    Sensor([usize; 2]),
    InArea(Vec<Area>),
    FullestArea(Vec<Area>),
    Dispersion,
    Clusters,
    LargestCluster,
    /// In units of the arena's diagonal [m].
    NearOthers {
        diagonal: f64,
    },
    Food,
    CarriedFood,
    LostFood,
    Deaths,
    Energy,
    Alive,
    Held,
    Effort,
    Control,
    Steps,
    Time,
    /// With the radius of the thing [m].
    Gap {
        radius: f64,
    },
    Contact {
        radius: f64,
        within: f64,
    },
    /// With the robots for which it is the rest of 1.
    TimeLeft {
        rest: [usize; 2],
    },
    /// For each robot.
    Registered(Vec<Box<dyn PlanarTerm>>),
    Step,
    RobotsInArea(Vec<Area>),
    Channels(Channels),
    /// Value of the term's formula.
    Formula,
}

impl Measure {
    /// Reads the measure of a term at a path of the document, and its thing, if any. `sensors` are the channels of a
    /// robot.
    pub(crate) fn new(
        kind: &RewardKind,
        path: &str,
        sensors: &[(String, [usize; 2])],
        scene: &Scene,
        source: &Source,
    ) -> Result<(Self, Option<BodyId>), Error> {
        check(kind, path, source)?;
        let thing = |object: &String, measure: Self| {
            Ok((measure, Some(scene.body(object, &format!("{path}/object"), source)?)))
        };
        let cylinder = |object: &String, measure: fn(f64, f64) -> Self, within: f64| {
            let path = format!("{path}/object");
            let thing = scene.thing(object, &path, source)?;
            let hint = if thing == Thing::Wall { "; the term `touch` counts walls" } else { "" };
            let lacks = || source.wrong(&path, format!("`{object}` is no cylinder{hint}"));
            let (body, radius) = thing.solid().ok_or_else(lacks)?;
            Ok((measure(radius, within), Some(body)))
        };
        if let RewardKind::Registered { kind, keys } = kind {
            let term = |robot| {
                registered::term(kind, keys, PartOfPlanar { scene, robot, files: None, rule: None, path, source })
            };
            let terms = (0..scene.robots.len()).map(term).collect::<Result<_, _>>()?;
            return Ok((Self::Registered(terms), None));
        }
        let measure = match kind {
            RewardKind::Near { object, within, .. } => {
                return cylinder(object, |radius, within| Measure::Near { radius, within }, *within);
            }
            RewardKind::Gap { object } => return cylinder(object, |radius, _| Measure::Gap { radius }, 0.0),
            RewardKind::Contact { object, within } => {
                return cylinder(object, |radius, within| Measure::Contact { radius, within }, *within);
            }
            RewardKind::Distance { object, .. } => return thing(object, Measure::Distance),
            RewardKind::Approach { object, .. } => return thing(object, Measure::Approach),
            RewardKind::Angle { object } => return thing(object, Measure::Angle),
            RewardKind::Moved { object } => return thing(object, Measure::Moved),
            RewardKind::Touch { .. } => Measure::Touch,
            RewardKind::Displacement { .. } => Measure::Displacement,
            RewardKind::Speed { .. } => Measure::Speed,
            RewardKind::Forward { .. } => Measure::Forward,
            RewardKind::Progress { along, .. } => Measure::Progress(direction(along, path, source)?),
            RewardKind::Position { along, .. } => Measure::Position(direction(along, path, source)?),
            RewardKind::Height { .. }
            | RewardKind::Upright { .. }
            | RewardKind::JointSpeed { .. }
            | RewardKind::JointPosition { .. }
            | RewardKind::JointVelocity { .. }
            | RewardKind::Registered { .. } => {
                return Err(source.wrong(path, "is for robots with joints; this one is on wheels"));
            }
            RewardKind::WheelSpeed {} => Measure::WheelSpeed,
            RewardKind::WheelDifference {} => Measure::WheelDifference,
            RewardKind::StraightOn {} => Measure::StraightOn,
            RewardKind::Sensor { sensor } => {
                let names = sensors.iter().map(|(name, _)| name.as_str());
                let number = source.position(names, ("sensor", sensor), &format!("{path}/sensor"))?;
                Measure::Sensor(sensors[number].1)
            }
            RewardKind::InArea { area, or } => {
                let mut all = areas(area, &format!("{path}/area"), scene, source)?;
                for (index, area) in or.iter().enumerate() {
                    all.extend(areas(area, &format!("{path}/or/{index}"), scene, source)?);
                }
                Measure::InArea(all)
            }
            RewardKind::FullestArea { area } => {
                Measure::FullestArea(areas(area, &format!("{path}/area"), scene, source)?)
            }
            RewardKind::RobotsInArea { area } => {
                Measure::RobotsInArea(areas(area, &format!("{path}/area"), scene, source)?)
            }
            RewardKind::Dispersion {} => Measure::Dispersion,
            RewardKind::Clusters {} => Measure::Clusters,
            RewardKind::LargestCluster {} => Measure::LargestCluster,
            RewardKind::NearOthers {} => {
                let [width, depth] = scene.size;
                Measure::NearOthers { diagonal: Scalar::sqrt(width * width + depth * depth) }
            }
            RewardKind::Food {} => Measure::Food,
            RewardKind::CarriedFood {} => Measure::CarriedFood,
            RewardKind::LostFood {} => Measure::LostFood,
            RewardKind::Deaths {} => Measure::Deaths,
            RewardKind::Energy {} => Measure::Energy,
            RewardKind::Alive {} => Measure::Alive,
            RewardKind::Held {} => Measure::Held,
            RewardKind::Effort {} => Measure::Effort,
            RewardKind::Control {} => Measure::Control,
            RewardKind::Steps {} => Measure::Steps,
            RewardKind::Step {} => Measure::Step,
            // The term holds the formula.
            RewardKind::Formula { .. } => Measure::Formula,
            RewardKind::Time {} => Measure::Time,
            RewardKind::TimeLeft { rest } => {
                Measure::TimeLeft { rest: scene.groups.find(rest, &format!("{path}/rest"), source)? }
            }
        };
        Ok((measure, None))
    }
}

/// Returns all areas of a name.
fn areas(name: &str, path: &str, scene: &Scene, source: &Source) -> Result<Vec<Area>, Error> {
    let area = |thing: Thing| match thing {
        Thing::Area(area) => Ok(area),
        _ => Err(source.wrong(path, format!("`{name}` is no disc or rectangle"))),
    };
    scene.things(name, path, source)?.into_iter().map(area).collect()
}

/// Returns a direction of the world as a unit vector of the plane.
fn direction([x, y, _]: &[f64; 3], path: &str, source: &Source) -> Result<[f64; 2], Error> {
    let length = Scalar::sqrt(x * x + y * y);
    if length == 0.0 {
        return Err(source.wrong(&format!("{path}/along"), "points nowhere in the plane"));
    }
    Ok([x / length, y / length])
}

/// Rejects measures of robots with joints.
fn check(kind: &RewardKind, path: &str, source: &Source) -> Result<(), Error> {
    let (body, bodies, point) = match kind {
        RewardKind::Near { body, point, .. }
        | RewardKind::Distance { body, point, .. }
        | RewardKind::Approach { body, point, .. }
        | RewardKind::Position { body, point, .. } => (body, &[][..], point),
        RewardKind::Displacement { body }
        | RewardKind::Speed { body }
        | RewardKind::Forward { body }
        | RewardKind::Progress { body, .. } => (body, &[][..], &[0.0; 3]),
        RewardKind::Touch { bodies, with } => (with, &bodies[..], &[0.0; 3]),
        _ => return Ok(()),
    };
    one_body(body.as_ref(), bodies, point, path, source)
}
