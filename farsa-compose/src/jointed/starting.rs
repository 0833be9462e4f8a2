//! Initial placements of joints and things.

use farsa_body::ports::{BodyId, JointId};
use farsa_body::robot::JointKind;
use farsa_body::{Pose, Twist};
use farsa_lab::Error;
use farsa_num::{Scalar, Stream, sin_cos};

use crate::check::source::Source;
use crate::document::{Document, Placing};
use crate::jointed::SpatialWorld;
use crate::jointed::registered::{self, PartOfSpatial};
use crate::jointed::scene::{ROBOT, Scene};
use crate::jointed::things::What;
use crate::part::object::SpatialStart;
use crate::parts::choice::Choice;

/// A placement with its part.
#[derive(Clone, Debug)]
struct Rule {
    what: Placed,
    /// Greatest distance of the surface from the center [m].
    reach: f64,
    how: How,
}

/// A part that a trial places.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Placed {
    Joint(JointId),
    Body(BodyId),
    Marker(usize),
}

#[derive(Clone, Debug)]
enum How {
    Within { low: [f64; 3], high: [f64; 3], apart: f64 },
    OneOf(Choice<3>),
    Turned { low: f64, high: f64 },
    Fixed(Pose),
    Registered(Box<dyn SpatialStart>),
}

/// Placements of a trial.
#[derive(Clone, Debug)]
pub(crate) struct Starting {
    rules: Vec<Rule>,
    /// Positions of markers without a rule.
    markers: Vec<[f32; 3]>,
    /// Positions placed earlier, with their reach [m].
    before: Vec<([f32; 3], f64)>,
    /// Numbers of the chosen points, by rule.
    chosen: Vec<usize>,
}

/// Most attempts to find a place.
const TRIES: u32 = 1000;

impl Starting {
    /// Reads the placements of a document.
    pub(crate) fn new(document: &Document, scene: &Scene, source: &Source) -> Result<Self, Error> {
        let mut rules: Vec<Rule> = Vec::new();
        for (index, start) in document.start.iter().enumerate() {
            let path = format!("/start/{index}");
            let (what, reach) = named(&start.place, scene, &path, source)?;
            let how = how(document, index, what, scene, &path, source)?;
            if rules.iter().any(|other| other.what == what) {
                return Err(source.wrong(&format!("{path}/place"), format!("`{}` is placed twice", start.place)));
            }
            rules.push(Rule { what, reach, how });
        }
        for (index, (object, thing)) in document.objects.iter().zip(&scene.things).enumerate() {
            let what = match thing.what {
                What::Body(body) => Some(Placed::Body(body)),
                What::Marker(number) => Some(Placed::Marker(number)),
                What::Wall => None,
            };
            let path = format!("/objects/{index}");
            if object.at.is_none() && what.is_none() {
                return Err(source.wrong(&path, "lacks the key `at`: no trial places walls"));
            }
            if object.at.is_none() && !rules.iter().any(|rule| Some(rule.what) == what) {
                return Err(source.wrong(&path, "lacks the key `at`, and no `[[start]]` places it"));
            }
        }
        let markers = scene.markers.iter().map(|marker| marker.at.map(|x| x as f32)).collect();
        let (before, chosen) = (Vec::with_capacity(rules.len()), vec![0; rules.len()]);
        Ok(Self { rules, markers, before, chosen })
    }

    /// Places all parts, by draws in the order of the rules. Returns false if one finds no place.
    pub(crate) fn arrange<W: SpatialWorld>(
        &mut self,
        world: &mut W,
        markers: &mut [[f32; 3]],
        stream: &mut Stream,
    ) -> bool {
        let Self { rules, markers: resting, before, chosen } = self;
        world.clear();
        markers.copy_from_slice(resting);
        before.clear();
        for (number, Rule { what, reach, how }) in rules.iter().enumerate() {
            // Only positions placed earlier in this loop limit a draw. The world is finished once, after all of them.
            let pose = match how {
                How::Turned { low, high } => {
                    if let Placed::Joint(joint) = what {
                        // A joint takes no room, so no later rule keeps a distance from it.
                        world.place_joint(*joint, stream.range(*low as f32, *high as f32), 0.0);
                    }
                    continue;
                }
                How::Fixed(pose) => *pose,
                How::Registered(start) => {
                    // A placement may depend on everything placed earlier.
                    world.finish_placement();
                    let Some(pose) = world.draw(&**start, 0, stream) else { return false };
                    pose
                }
                How::OneOf(choice) => {
                    let taken = |point: &[f32; 3]| before.iter().any(|(other, _)| other == point);
                    let Some(point) = choice.take(chosen, taken, |count| stream.below(count)) else { return false };
                    chosen[number] = point;
                    Pose::at(choice.points[point])
                }
                How::Within { low, high, apart } => {
                    let Some(at) = within(low, high, *reach + *apart, before, stream) else { return false };
                    Pose::at(at)
                }
            };
            match what {
                Placed::Body(body) => world.place_body(*body, pose, Twist::default()),
                Placed::Marker(number) => markers[*number] = pose.position,
                Placed::Joint(_) => {}
            }
            before.push((pose.position, *reach));
        }
        world.finish_placement();
        true
    }
}

/// Draws a place in a box at the given distance from earlier ones.
fn within(
    low: &[f64; 3],
    high: &[f64; 3],
    far: f64,
    before: &[([f32; 3], f64)],
    stream: &mut Stream,
) -> Option<[f32; 3]> {
    let mut tries = 0..TRIES;
    tries.find_map(|_| {
        let at = [0, 1, 2].map(|k| stream.range(low[k] as f32, high[k] as f32));
        let clear = |(other, reach): &([f32; 3], f64)| {
            let [x, y, z] = [0, 1, 2].map(|k| f64::from(at[k] - other[k]));
            Scalar::sqrt(x * x + y * y + z * z) >= reach + far
        };
        before.iter().all(clear).then_some(at)
    })
}

/// Returns a named part and its reach.
fn named(name: &String, scene: &Scene, path: &str, source: &Source) -> Result<(Placed, f64), Error> {
    let path = format!("{path}/place");
    if name == ROBOT {
        let root = scene.robot.segments.first().filter(|root| root.joint.kind == JointKind::Floating);
        let why = "`robot` stands in the world; only one whose first body floats is placed, and others have `base`";
        return root.map(|_| (Placed::Body(BodyId(0)), 0.0)).ok_or_else(|| source.wrong(&path, why));
    }
    if let Some(thing) = scene.things.iter().find(|thing| thing.name == *name) {
        return match thing.what {
            What::Body(body) => Ok((Placed::Body(body), thing.reach)),
            What::Marker(number) => Ok((Placed::Marker(number), 0.0)),
            What::Wall => Err(source.wrong(&path, format!("`{name}` is a wall, which stands where `at` says"))),
        };
    }
    let joints = || scene.robot.joints().filter(|joint| joint.index() < scene.own_bodies());
    let joint = joints().find(|joint| scene.joint_name(*joint) == name);
    let names = joints().map(|joint| scene.joint_name(joint)).chain([ROBOT]);
    let names = names.chain(scene.things.iter().map(|thing| thing.name.as_str()));
    let joint = joint.ok_or_else(|| Error::unknown(&source.of(&path), "joint or object", name, names))?;
    Ok((Placed::Joint(joint), 0.0))
}

/// Reads the placement of a rule.
fn how(
    document: &Document,
    rule: usize,
    what: Placed,
    scene: &Scene,
    path: &str,
    source: &Source,
) -> Result<How, Error> {
    let joint = matches!(what, Placed::Joint(_));
    match &document.start[rule].how {
        Placing::Turned { low, high } if joint => {
            if low > high {
                return Err(source.wrong(path, format!("from {low} to {high} runs backwards")));
            }
            Ok(How::Turned { low: *low, high: *high })
        }
        Placing::Turned { .. } => Err(source.wrong(&format!("{path}/at"), "is for joints; this is none")),
        _ if joint => Err(source.wrong(&format!("{path}/at"), "is for things; a joint is `turned`")),
        Placing::Registered { at, keys } => {
            Ok(How::Registered(registered::start(at, keys, PartOfSpatial { scene, wiring: None, path, source })?))
        }
        Placing::InBox { low, high, apart } => {
            if (0..3).any(|k| low[k] > high[k]) {
                return Err(source.wrong(path, "has a `low` above its `high`"));
            }
            Ok(How::Within { low: *low, high: *high, apart: *apart })
        }
        Placing::OneOf { points, like } => {
            let point = |(index, point): (usize, &Vec<f64>)| {
                let why = || format!("has {} values where 3 are wanted: x, y and z", point.len());
                let at = <[f64; 3]>::try_from(point.as_slice());
                at.map(|point| point.map(|x| x as f32))
                    .map_err(|_| source.wrong(&format!("{path}/points/{index}"), why()))
            };
            let points = points.iter().enumerate().map(point).collect::<Result<_, _>>()?;
            Ok(How::OneOf(Choice::new(points, like.as_ref(), document, rule, source)?))
        }
        Placing::Fixed { drawn_heading: true, .. } => {
            Err(source.wrong(&format!("{path}/drawn_heading"), "is for robots on wheels"))
        }
        Placing::Fixed { point, heading, .. } => {
            let Ok(point) = <[f64; 3]>::try_from(point.as_slice()) else {
                return Err(source.wrong(&format!("{path}/point"), "has 2 values where 3 are wanted: x, y and z"));
            };
            // A turn by h about z is the quaternion (0, 0, sin(h/2), cos(h/2)). The document has degrees.
            let (sine, cosine) = sin_cos(0.5 * heading.to_radians());
            let pose = Pose { position: point, rotation: [0.0, 0.0, sine, cosine] };
            Ok(How::Fixed(pose.cast()))
        }
        Placing::Anywhere { .. } | Placing::Near { .. } | Placing::Around { .. } => Err(source.wrong(
            &format!("{path}/at"),
            "is for robots on wheels; next to one with joints it is `in-box` or `fixed`",
        )),
    }
}
