//! Initial placements of joints and things.

use farsa_body::ports::{BodyId, JointId};
use farsa_body::robot::JointKind;
use farsa_body::{Pose, Twist};
use farsa_lab::Error;
use farsa_models::mjcf::Keyframe;
use farsa_num::Stream;

use crate::check::source::Source;
use crate::document::Document;
use crate::jointed::SpatialWorld;
use crate::jointed::registered::{self, PartOfSpatial};
use crate::jointed::scene::{ROBOT, Scene};
use crate::jointed::things::What;
use crate::part::object::SpatialStart;
use crate::part::spot::Spot;
use crate::parts::rule_of::RuleOf;

/// A placement with its part.
#[derive(Clone, Debug)]
struct Rule {
    what: Placed,
    /// Greatest distance of the surface from the center [m].
    reach: f64,
    start: Box<dyn SpatialStart>,
}

/// A part that a trial places.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Placed {
    Joint(JointId),
    Body(BodyId),
    Marker(usize),
    /// The whole robot, in one of the postures by its number.
    Posture(usize),
}

/// Placements of a trial.
#[derive(Clone, Debug)]
pub(crate) struct Starting {
    rules: Vec<Rule>,
    /// The configuration of the model's file, if there is one, and the postures of the rules.
    postures: Vec<Keyframe>,
    /// Joints of the robot, in the order of a posture.
    joints: Vec<JointId>,
    /// Positions of markers without a rule.
    markers: Vec<[f32; 3]>,
    /// Positions placed earlier, with their reach [m].
    before: Vec<([f32; 3], f64)>,
    /// Numbers of the chosen points, by rule.
    chosen: Vec<usize>,
}

impl Starting {
    /// Reads the placements of a document.
    pub(crate) fn new(document: &Document, scene: &Scene, source: &Source) -> Result<Self, Error> {
        let mut rules: Vec<Rule> = Vec::new();
        let mut postures: Vec<Keyframe> = scene.postures.iter().take(1).cloned().collect();
        for (index, start) in document.start.iter().enumerate() {
            let path = format!("/start/{index}");
            let registered_start = source.registry.start(&start.how);
            let posture = registered_start.as_deref().and_then(|start| start.posture());
            let (what, reach) = match posture {
                Some(posture) => {
                    postures.push(postured(posture, &start.place, scene, &path, source)?);
                    (Placed::Posture(postures.len() - 1), 0.0)
                }
                None => named(&start.place, scene, &path, source)?,
            };
            let is_joint = matches!(what, Placed::Joint(_));
            let is_of_joints = registered_start.is_some_and(|start| start.is_of_joints());
            if is_of_joints != is_joint {
                let why = if is_joint { "is for things; a joint is `turned`" } else { "is for joints; this is none" };
                return Err(source.wrong(&format!("{path}/at"), why));
            }
            let rule = Some(RuleOf { document, number: index, placed: &[] });
            let part = PartOfSpatial { scene, wiring: None, rule, sensors: &[], path: &path, source };
            let made = registered::start(&start.how, part)?;
            let is_posture = |what: Placed| matches!(what, Placed::Posture(_));
            if rules.iter().any(|other| other.what == what || is_posture(other.what) && is_posture(what)) {
                return Err(source.wrong(&format!("{path}/place"), format!("`{}` is placed twice", start.place)));
            }
            rules.push(Rule { what, reach, start: made });
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
        let joints = scene.robot.joints().filter(|joint| joint.index() < scene.own_bodies()).collect();
        Ok(Self { rules, postures, joints, markers, before, chosen })
    }

    /// Places all parts, by draws in the order of the rules. Returns false if one finds no place.
    pub(crate) fn arrange<W: SpatialWorld>(
        &mut self,
        world: &mut W,
        markers: &mut [[f32; 3]],
        stream: &mut Stream,
    ) -> bool {
        let Self { rules, postures, joints, markers: resting, before, chosen } = self;
        world.clear();
        // A cleared world has all joints at 0, which some models reach only far from the configuration of their file.
        let initial = postures.first().map_or(&[][..], |posture| &posture.joints);
        for (joint, position) in joints.iter().zip(initial).filter(|(_, position)| **position != 0.0) {
            world.place_joint(*joint, *position as f32, 0.0);
        }
        markers.copy_from_slice(resting);
        before.clear();
        for (number, Rule { what, reach, start }) in rules.iter().enumerate() {
            if let Placed::Joint(joint) = what {
                let Some(position) = world.draw_position(&**start, stream) else { return false };
                // A joint takes no room, so no later rule keeps a distance from it.
                world.place_joint(*joint, position, 0.0);
                continue;
            }
            if let Placed::Posture(number) = what {
                let posture = &postures[*number];
                for (joint, position) in joints.iter().zip(&posture.joints) {
                    let Some([q, speed]) = world.draw_around(&**start, *position as f32, stream) else { return false };
                    world.place_joint(*joint, q, speed);
                }
                for (body, pose) in &posture.bodies {
                    let Pose { position, rotation } = pose.cast::<f32>();
                    let mut drawn = [[0.0; 2]; 7];
                    for (to, x) in drawn.iter_mut().zip(position.into_iter().chain(rotation)) {
                        let Some(moved) = world.draw_around(&**start, x, stream) else { return false };
                        *to = moved;
                    }
                    let [x, y, z, i, j, k, w] = drawn;
                    let rotation = [i, j, k, w].map(|[part, _]| part);
                    let length = rotation.iter().map(|part| part * part).sum::<f32>().sqrt();
                    let pose =
                        Pose { position: [x, y, z].map(|[q, _]| q), rotation: rotation.map(|part| part / length) };
                    let twist = Twist { linear: [x, y, z].map(|[_, v]| v), angular: [i, j, k].map(|[_, v]| v) };
                    world.place_body(*body, pose, twist);
                }
                continue;
            }
            // A placement may depend on everything placed earlier.
            world.finish_placement();
            let mut spot = Spot {
                number: 0,
                radius: *reach,
                edge: *reach,
                solid: true,
                turns: false,
                size: [0.0; 2],
                others: &mut [],
                areas: &[],
                earlier: before,
                chosen,
                choice: None,
                lacks: None,
            };
            let Some(pose) = world.draw(&**start, &mut spot, stream) else { return false };
            if let Some(choice) = spot.choice {
                chosen[number] = choice;
            }
            match what {
                Placed::Body(body) => world.place_body(*body, pose, Twist::default()),
                Placed::Marker(number) => markers[*number] = pose.position,
                Placed::Joint(_) | Placed::Posture(_) => {}
            }
            before.push((pose.position, *reach));
        }
        world.finish_placement();
        true
    }
}

/// Returns a posture of the robot by its name, which is empty for the configuration of the file, and raises it [m].
fn postured(
    (name, raised): (&str, f64),
    place: &str,
    scene: &Scene,
    path: &str,
    source: &Source,
) -> Result<Keyframe, Error> {
    if place != ROBOT {
        return Err(source.wrong(&format!("{path}/at"), "is for the whole `robot`"));
    }
    let mut posture = scene.postures[scene.posture(name, &format!("{path}/keyframe"), source)?].clone();
    posture.bodies.iter_mut().for_each(|(_, pose)| pose.position[2] += raised);
    Ok(posture)
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
